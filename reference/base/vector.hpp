// reference/base/vector.hpp: the small value types every folder shares.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

namespace plumbline {

inline constexpr double kPi = std::numbers::pi;

using Vec2 = glm::vec2;
using Vec3 = glm::vec3;
using Vec3d = glm::dvec3;

/// Linear Rec. 709 colour. What it measures (radiance, irradiance, albedo) is said by the name that holds it.
using Rgb = glm::vec3;
/// The same in double, for sums.
using RgbD = glm::dvec3;

[[nodiscard]] inline bool is_finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
[[nodiscard]] inline bool is_black(const Rgb& c) {
  return c.x == 0.0F && c.y == 0.0F && c.z == 0.0F;
}
[[nodiscard]] inline float max_component(const Vec3& v) {
  return glm::max(v.x, glm::max(v.y, v.z));
}
[[nodiscard]] inline float max_magnitude(const Vec3& v) {
  return max_component(glm::abs(v));
}
/// Rec. 709 luminance, the photometric weight of linear red, green and blue.
[[nodiscard]] inline float luminance(const Rgb& c) {
  return 0.2126F * c.x + 0.7152F * c.y + 0.0722F * c.z;
}

}  // namespace plumbline
