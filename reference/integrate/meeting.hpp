// reference/integrate/meeting.hpp: what a ray meets, and what two points see of each other.
#pragma once

#include <cstdint>
#include <optional>

#include "reference/integrate/world.hpp"
#include "reference/trace/surface_point.hpp"

namespace plumbline::integrate {

/// A surface met by a ray. A single-sided surface met from behind is met, but dark.
struct Meeting {
  trace::SurfacePoint point;
  Rgb albedo{0.0F};
  Rgb emission{0.0F};          // radiance
  std::uint32_t triangle = 0;  // or another surface's number (scene.hpp)
  float distance = 0.0F;
};
/// None for a miss.
[[nodiscard]] std::optional<Meeting> meet(const World& world, const trace::Ray& ray);

/// Whether nothing is in the way from a point along `direction` (unit) up to `distance`.
[[nodiscard]] bool is_visible(const World& world, const trace::SurfacePoint& point, const Vec3& direction,
                              float distance);
/// Whether nothing is between two points; both ends are lifted off their surfaces, so that neither blocks.
[[nodiscard]] bool is_mutually_visible(const World& world, const trace::SurfacePoint& a,
                                       const trace::SurfacePoint& b);

/// Density with which EmitterTable::sample would have drawn for the receiver what its ray along `direction` met.
[[nodiscard]] double emitter_pdf(const World& world, const Receiver& receiver, const Meeting& meeting,
                                 const Vec3& direction);

/// Weight of a sample drawn with density `own` when it could also have been drawn with density `other`
/// (Veach & Guibas 1995, beta = 2).
[[nodiscard]] inline double power_heuristic(double own, double other) {
  const double a = own * own;
  const double b = other * other;
  return a / (a + b);
}

}  // namespace plumbline::integrate
