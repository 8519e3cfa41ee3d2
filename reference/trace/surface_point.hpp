// reference/trace/surface_point.hpp: where light meets a surface, and where the next ray starts.
#pragma once

#include <cstdint>
#include <limits>
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
/// Interpolated vertex normal, unit (`geometric` where opposite normals cancel), turned by the material's normal map.
[[nodiscard]] Vec3 shading_normal(const scene::Scene& scene, std::uint32_t triangle, const Vec3& weights,
                                  const Vec3& geometric);
/// The same point seen from behind.
void turn_around(SurfaceHit& hit);

/// A point given by hand: no triangle is known, both normals are `normal` (unit).
[[nodiscard]] SurfacePoint free_point(const Vec3& position, const Vec3& normal);

/// One point for each vertex of the scene. A vertex lies on the very edge of its triangles, often in the
/// plane of a neighbouring wall, where visibility is ambiguous: the point is moved by 1/1000 towards the
/// middle of the largest triangle that uses the vertex, and that triangle's plane is its geometric normal. A
/// vertex no triangle uses is a free point. The shading normal is the vertex' own, without any normal map: a map holds what is finer than
/// vertices.
[[nodiscard]] std::vector<SurfacePoint> vertex_points(const scene::Scene& scene);

// ---------------------------------------------------------------- bodies of what every ray needs
// How far a computed point may lie from its triangle, and a computed hit distance from the true one.
// A convex combination of three vertices carries at most 7 roundings (Pharr, Jakob & Humphreys, "Physically
// Based Rendering", 4th ed., section 6.8): |error| <= gamma_7 (|b0 p0| + |b1 p1| + |b2 p2|) in each
// component. The query rounds again, by a similar amount in the vertices' differences to the origin. Sixteen
// units of relative error cover both; the bound scales with the coordinates alone, so a scene scaled by any
// factor behaves the same.
inline constexpr float kRelativeError = 8.0F * std::numeric_limits<float>::epsilon();

// The largest component, not the one along the normal: on a plane through the origin that would be 0, while the query's
// rounding is that of the other coordinates.
inline float clearance(const Vec3& magnitude) {
  return kRelativeError * max_component(magnitude) + std::numeric_limits<float>::min();
}

inline SurfacePoint point_on_plane(const Vec3 (&corners)[3], const Vec3& weights, const Vec3& normal) {
  const Vec3 a = weights.x * corners[0];
  const Vec3 b = weights.y * corners[1];
  const Vec3 c = weights.z * corners[2];
  return {a + b + c, normal, normal, clearance(glm::abs(a) + glm::abs(b) + glm::abs(c))};
}

inline void turn_around(SurfaceHit& hit) {
  hit.is_front = false;
  hit.point.geometric_normal = -hit.point.geometric_normal;
  hit.point.shading_normal = -hit.point.shading_normal;
}

inline Vec3 ray_origin(const SurfacePoint& point, const Vec3& direction) {
  const float side = glm::dot(direction, point.geometric_normal) >= 0.0F ? 1.0F : -1.0F;
  return point.position + side * point.clearance * point.geometric_normal;
}

}  // namespace plumbline::trace
