#include "reference/integrate/hemisphere.hpp"

#include <cmath>

namespace plumbline::integrate {
namespace {

Vec2 concentric_disc(const Vec2& u) {
  const Vec2 p = 2.0F * u - 1.0F;
  if (p.x == 0.0F && p.y == 0.0F) return Vec2(0.0F);
  constexpr float kQuarter = static_cast<float>(kPi / 4.0);
  const bool is_wide = std::abs(p.x) > std::abs(p.y);
  const float r = is_wide ? p.x : p.y;
  const float angle = is_wide ? kQuarter * (p.y / p.x) : 2.0F * kQuarter - kQuarter * (p.x / p.y);
  return r * Vec2(std::cos(angle), std::sin(angle));
}

struct Frame {
  Vec3 tangent;
  Vec3 bitangent;
};

// Duff et al., "Building an orthonormal basis, revisited", JCGT 6(1), 2017: no branch, no loss near n.z = -1.
Frame frame_about(const Vec3& n) {
  const float sign = std::copysign(1.0F, n.z);
  const float a = -1.0F / (sign + n.z);
  const float b = n.x * n.y * a;
  return {Vec3(1.0F + sign * n.x * n.x * a, sign * b, -sign * n.x), Vec3(b, sign + n.y * n.y * a, -n.y)};
}

}  // namespace

Vec3 sample_cosine_hemisphere(const Vec3& normal, const Vec2& u) {
  const Vec2 disc = concentric_disc(u);
  const float height = std::sqrt(std::fmax(0.0F, 1.0F - glm::dot(disc, disc)));
  const Frame frame = frame_about(normal);
  return glm::normalize(disc.x * frame.tangent + disc.y * frame.bitangent + height * normal);
}

}  // namespace plumbline::integrate
