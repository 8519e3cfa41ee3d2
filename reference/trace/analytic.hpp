// reference/trace/analytic.hpp: rays against exact spheres and discs, in double precision.
#pragma once

#include <optional>

#include "reference/scene/primitive.hpp"
#include "reference/trace/surface_point.hpp"

namespace plumbline::trace {

/// Where a ray crosses a primitive.
struct Crossing {
  double distance = 0.0;   // in units of the direction's length
  Vec2 coordinates{0.0F};  // of the point on the surface, for Hit::barycentrics
};

/// First crossing with a distance in (0, max_distance]. Both sides count. `direction` need not be unit, not
/// zero. A point strictly outside a sphere from which the ray leads away from the centre never crosses it, a
/// point strictly inside crosses exactly once, whatever the rounding.
[[nodiscard]] std::optional<Crossing> crossing(const scene::Sphere& sphere, const Vec3d& origin,
                                               const Vec3d& direction, double max_distance);
[[nodiscard]] std::optional<Crossing> crossing(const scene::Disc& disc, const Vec3d& origin,
                                               const Vec3d& direction, double max_distance);

/// A point of a surface by its coordinates, both normals on the front side. The position is the exact point of
/// the surface that has these coordinates, rounded to float.
[[nodiscard]] SurfacePoint point_on(const scene::Sphere& sphere, Vec2 coordinates);
[[nodiscard]] SurfacePoint point_on(const scene::Disc& disc, Vec2 coordinates);

/// Coordinates of the point of a sphere in the direction n (unit) from its centre; any n, cut off or not.
[[nodiscard]] Vec2 sphere_coordinates(const Vec3d& n);

/// point_on for a surface number of the scene that is no triangle.
[[nodiscard]] SurfacePoint point_on_primitive(const scene::Scene& scene, std::uint32_t surface,
                                              Vec2 coordinates);

}  // namespace plumbline::trace
