#include "reference/scene/texture.hpp"

#include <algorithm>
#include <cmath>

namespace plumbline::scene {
namespace {

int wrapped(int texel, int size, Wrap wrap) {
  if (wrap == Wrap::kClamp) return std::clamp(texel, 0, size - 1);
  const int period = wrap == Wrap::kMirror ? 2 * size : size;
  int inside = texel % period;
  if (inside < 0) inside += period;
  return inside < size ? inside : period - 1 - inside;
}

struct Footprint {
  int low;
  int high;
  float weight_high;
};

// The two texels whose centres surround a coordinate. It is brought near zero first, so that large
// coordinates neither overflow an int nor leave the texture.
Footprint footprint(float coordinate, int size, Wrap wrap) {
  const float period = wrap == Wrap::kMirror ? 2.0F : 1.0F;
  const float near_zero = wrap == Wrap::kClamp ? std::clamp(coordinate, 0.0F, 1.0F)
                                               : coordinate - period * std::floor(coordinate / period);
  const float position = near_zero * static_cast<float>(size) - 0.5F;
  const float floor = std::floor(position);
  const int low = static_cast<int>(floor);
  return {wrapped(low, size, wrap), wrapped(low + 1, size, wrap), position - floor};
}

}  // namespace

Rgb value_at(const Texture& texture, Vec2 texcoord) {
  const Footprint x = footprint(texcoord.x, texture.image.width, texture.wrap_u);
  const Footprint y = footprint(texcoord.y, texture.image.height, texture.wrap_v);
  const auto row = [&](int v) {
    return glm::mix(texture.image.at(x.low, v), texture.image.at(x.high, v), x.weight_high);
  };
  return glm::mix(row(y.low), row(y.high), y.weight_high);
}

}  // namespace plumbline::scene
