// reference/scene/texture.hpp: an image on a surface.
#pragma once

#include <cstdint>

#include "reference/base/vector.hpp"
#include "reference/image/image.hpp"

namespace plumbline::scene {

/// What lies outside the unit square of a texture.
enum class Wrap : std::uint8_t { kRepeat, kMirror, kClamp };

/// Image with values in [0, 1], looked up bilinearly (texel centres at half texels), repeated unless told otherwise: linear albedo,
/// or a normal map as the file stores it (see normal_map.hpp). Texture coordinate (0, 0) is the top left corner.
struct Texture {
  image::Image image;
  Wrap wrap_u = Wrap::kRepeat;
  Wrap wrap_v = Wrap::kRepeat;
};

/// The interpolated value at a texture coordinate (finite).
[[nodiscard]] Rgb value_at(const Texture& texture, Vec2 texcoord);

}  // namespace plumbline::scene
