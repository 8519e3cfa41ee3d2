// reference/trace/surface_point.hpp: where light meets a surface, and where the next ray starts.
#pragma once

#include <cstdint>
#include <vector>

#include "reference/trace/ray_caster.hpp"

namespace plumbline::trace {

/// A point on a surface with the side it is seen from: both normals point to that side.
struct SurfacePoint {
  Vec3 position{0.0F};
  Vec3 geometric_normal{0.0F, 1.0F, 0.0F};  // unit
  Vec3 shading_normal{0.0F, 1.0F, 0.0F};    // unit
  float clearance = 0.0F;                   // distance along the normal that clears all rounding error
};

/// Start of a ray that leaves the surface in `direction`, on that side of it.
[[nodiscard]] Vec3 ray_origin(const SurfacePoint& point, const Vec3& direction);

/// The point of a hit, on the surface's front (is_front) or turned to its back.
struct SurfaceHit {
  SurfacePoint point;
  bool is_front = true;
};
[[nodiscard]] SurfaceHit surface_hit(const scene::Scene& scene, const Hit& hit, const Vec3& ray_direction);

/// Parts of surface_hit, for tables that hold the corners ready. `weights` are the barycentric ones, their sum is 1.
/// Both normals of the point are `normal`.
[[nodiscard]] SurfacePoint point_on_plane(const Vec3 (&corners)[3], const Vec3& weights, const Vec3& normal);
/// Interpolated vertex normal, unit; `geometric` where opposite normals cancel.
[[nodiscard]] Vec3 shading_normal(const scene::Scene& scene, const glm::uvec3& corners, const Vec3& weights,
                                  const Vec3& geometric);
/// The same point seen from behind.
void turn_around(SurfaceHit& hit);

/// A point given by hand: no triangle is known, both normals are `normal` (unit).
[[nodiscard]] SurfacePoint free_point(const Vec3& position, const Vec3& normal);

/// One point for each vertex of the scene. A vertex lies on the very edge of its triangles, often in the
/// plane of a neighbouring wall, where visibility is ambiguous: the point is moved by 1/1000 towards the
/// middle of the largest triangle that uses the vertex, and that triangle's plane is its geometric normal. A
/// vertex no triangle uses is a free point.
[[nodiscard]] std::vector<SurfacePoint> vertex_points(const scene::Scene& scene);

}  // namespace plumbline::trace
