#include "reference/scene/primitive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace plumbline::scene {
namespace {

constexpr float kUnitTolerance = 1e-3F;
constexpr float kLargest = 1e18F;  // as for vertices: beyond 1.8e18 Embree drops a surface without a word
// Far from the origin a float cannot place the surface any more: at this ratio its rounding is a thousandth of
// the radius.
constexpr float kSmallestRelativeRadius = 1e-4F;

std::string text(const Vec3& v) {
  return fmt::format("({}, {}, {})", v.x, v.y, v.z);
}

bool is_unit(const Vec3& v) {
  return std::abs(glm::length(v) - 1.0F) <= kUnitTolerance;  // false for NaN
}

std::string fault_of_place(const Vec3& centre, float radius) {
  if (!is_finite(centre)) return "centre is not finite: " + text(centre);
  if (!(radius > 0.0F)) return fmt::format("radius is not above 0: {}", radius);
  if (!(max_magnitude(centre) + radius <= kLargest)) {
    return fmt::format("does not lie within 1e18: centre {}, radius {}", text(centre), radius);
  }
  if (!(radius >= kSmallestRelativeRadius * max_magnitude(centre))) {
    return fmt::format("radius is below 1e-4 of the centre's distance from the origin: centre {}, radius {}",
                       text(centre), radius);
  }
  return {};
}

// The highest point of the cap {n.a >= m} along a unit axis e: the pole e itself where the cap holds it, else
// the point of the rim nearest to it, cos(angle(e, a) - acos m).
double reach(double cos_to_axis, double min_cosine) {
  if (cos_to_axis >= min_cosine) return 1.0;
  const auto sine = [](double cosine) { return std::sqrt(std::max(0.0, 1.0 - cosine * cosine)); };
  return cos_to_axis * min_cosine + sine(cos_to_axis) * sine(min_cosine);
}

}  // namespace

double area(const Sphere& sphere) {
  const double radius = sphere.radius;
  return 2.0 * kPi * radius * radius * (1.0 - std::max(-1.0, static_cast<double>(sphere.keep_min_cosine)));
}

double area(const Disc& disc) {
  const double radius = disc.radius;
  return kPi * radius * radius;
}

Extent extent(const Sphere& sphere) {
  const Vec3d axis = glm::normalize(Vec3d(sphere.keep_axis));
  const double radius = sphere.radius;
  const double min_cosine = sphere.keep_min_cosine;
  Extent result{Vec3d(sphere.centre), Vec3d(sphere.centre)};
  for (int k = 0; k < 3; ++k) {
    result.high[k] += radius * reach(axis[k], min_cosine);
    result.low[k] -= radius * reach(-axis[k], min_cosine);
  }
  return result;
}

Extent extent(const Disc& disc) {
  const Vec3d n = glm::normalize(Vec3d(disc.normal));
  const Vec3d half = static_cast<double>(disc.radius) * glm::sqrt(glm::max(Vec3d(0.0), 1.0 - n * n));
  return {Vec3d(disc.centre) - half, Vec3d(disc.centre) + half};
}

std::string fault_of(const Sphere& sphere) {
  const std::string place = fault_of_place(sphere.centre, sphere.radius);
  if (!place.empty()) return place;
  if (!is_unit(sphere.keep_axis)) return "keep_axis is not unit length: " + text(sphere.keep_axis);
  if (!(sphere.keep_min_cosine >= -1.0F && sphere.keep_min_cosine < 1.0F)) {
    return fmt::format("keep_min_cosine is outside [-1, 1): {}", sphere.keep_min_cosine);
  }
  return {};
}

std::string fault_of(const Disc& disc) {
  const std::string place = fault_of_place(disc.centre, disc.radius);
  if (!place.empty()) return place;
  if (!is_unit(disc.normal)) return "normal is not unit length: " + text(disc.normal);
  return {};
}

}  // namespace plumbline::scene
