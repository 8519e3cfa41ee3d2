// reference/integrate/hemisphere.hpp: directions about a normal.
#pragma once

#include <cmath>

#include "reference/base/vector.hpp"

namespace plumbline::integrate {

/// Direction with density max(0, n.w) / pi about the unit normal; u in [0, 1)^2.
/// A uniform disc lifted to the hemisphere (Malley), with Shirley & Chiu's concentric map, which keeps strata
/// together. Unit to float rounding, as the normal is.
[[nodiscard]] Vec3 sample_cosine_hemisphere(const Vec3& normal, const Vec2& u);

// ---------------------------------------------------------------- bodies
namespace hemisphere_detail {

// Sine and cosine of |a| <= pi / 4 by their series: what is left out is below a^9 / 9! = 3.2e-7 and a^10 / 10! = 2.5e-8.
// Inline, the same bits on every machine, and a third of the time of std::sin and std::cos.
inline float small_sine(float a) {
  const float s = a * a;
  return a * (1.0F + s * (-1.0F / 6.0F + s * (1.0F / 120.0F - s * (1.0F / 5040.0F))));
}
inline float small_cosine(float a) {
  const float s = a * a;
  return 1.0F + s * (-0.5F + s * (1.0F / 24.0F + s * (-1.0F / 720.0F + s * (1.0F / 40320.0F))));
}

inline Vec2 concentric_disc(const Vec2& u) {
  const Vec2 p = 2.0F * u - 1.0F;
  if (p.x == 0.0F && p.y == 0.0F) return Vec2(0.0F);
  constexpr float kQuarter = static_cast<float>(kPi / 4.0);
  if (std::abs(p.x) > std::abs(p.y)) {
    const float angle = kQuarter * (p.y / p.x);
    return {p.x * small_cosine(angle), p.x * small_sine(angle)};
  }
  const float angle = kQuarter * (p.x / p.y);  // from the other axis
  return {p.y * small_sine(angle), p.y * small_cosine(angle)};
}

struct Frame {
  Vec3 tangent;
  Vec3 bitangent;
};

// Duff et al., "Building an orthonormal basis, revisited", JCGT 6(1), 2017: no branch, no loss near n.z = -1.
inline Frame frame_about(const Vec3& n) {
  const float sign = std::copysign(1.0F, n.z);
  const float a = -1.0F / (sign + n.z);
  const float b = n.x * n.y * a;
  return {Vec3(1.0F + sign * n.x * n.x * a, sign * b, -sign * n.x), Vec3(b, sign + n.y * n.y * a, -n.y)};
}

}  // namespace hemisphere_detail

inline Vec3 sample_cosine_hemisphere(const Vec3& normal, const Vec2& u) {
  const Vec2 disc = hemisphere_detail::concentric_disc(u);
  const float height = std::sqrt(std::fmax(0.0F, 1.0F - glm::dot(disc, disc)));
  const hemisphere_detail::Frame frame = hemisphere_detail::frame_about(normal);
  return disc.x * frame.tangent + disc.y * frame.bitangent + height * normal;
}

}  // namespace plumbline::integrate
