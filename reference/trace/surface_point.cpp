#include "reference/trace/surface_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "reference/trace/analytic.hpp"

namespace plumbline::trace {
namespace {

// How far a computed point may lie from its triangle, and a computed hit distance from the true one.
// A convex combination of three vertices carries at most 7 roundings (Pharr, Jakob & Humphreys, "Physically
// Based Rendering", 4th ed., section 6.8): |error| <= gamma_7 (|b0 p0| + |b1 p1| + |b2 p2|) in each
// component. The query rounds again, by a similar amount in the vertices' differences to the origin. Sixteen
// units of relative error cover both; the bound scales with the coordinates alone, so a scene scaled by any
// factor behaves the same.
constexpr float kRelativeError = 8.0F * std::numeric_limits<float>::epsilon();

constexpr float kVertexInset = 1e-3F;

// The largest component, not the one along the normal: on a plane through the origin that would be 0, while the query's
// rounding is that of the other coordinates.
float clearance(const Vec3& magnitude) {
  return kRelativeError * max_component(magnitude) + std::numeric_limits<float>::min();
}

SurfacePoint point_on_triangle(const scene::Scene& scene, std::uint32_t triangle, const Vec3& weights) {
  const glm::uvec3 corners = scene.triangles[triangle];
  const Vec3 positions[3] = {scene.positions[corners.x], scene.positions[corners.y],
                             scene.positions[corners.z]};
  SurfacePoint point = point_on_plane(positions, weights, scene::geometric_normal(scene, triangle));
  point.shading_normal = shading_normal(scene, corners, weights, point.geometric_normal);
  return point;
}

}  // namespace

SurfacePoint point_on_plane(const Vec3 (&corners)[3], const Vec3& weights, const Vec3& normal) {
  const Vec3 a = weights.x * corners[0];
  const Vec3 b = weights.y * corners[1];
  const Vec3 c = weights.z * corners[2];
  return {a + b + c, normal, normal, clearance(glm::abs(a) + glm::abs(b) + glm::abs(c))};
}

Vec3 shading_normal(const scene::Scene& scene, const glm::uvec3& corners, const Vec3& weights,
                    const Vec3& geometric) {
  const Vec3 sum = weights.x * scene.normals[corners.x] + weights.y * scene.normals[corners.y] +
                   weights.z * scene.normals[corners.z];
  const float length = glm::length(sum);
  // Opposite vertex normals can cancel; the plane's own normal is then the only one there is.
  return length > 1e-6F ? sum / length : geometric;
}

void turn_around(SurfaceHit& hit) {
  hit.is_front = false;
  hit.point.geometric_normal = -hit.point.geometric_normal;
  hit.point.shading_normal = -hit.point.shading_normal;
}

Vec3 ray_origin(const SurfacePoint& point, const Vec3& direction) {
  const float side = glm::dot(direction, point.geometric_normal) >= 0.0F ? 1.0F : -1.0F;
  return point.position + side * point.clearance * point.geometric_normal;
}

SurfaceHit surface_hit(const scene::Scene& scene, const Hit& hit, const Vec3& ray_direction) {
  const Vec3 weights(1.0F - hit.barycentrics.x - hit.barycentrics.y, hit.barycentrics.x, hit.barycentrics.y);
  SurfaceHit result{hit.triangle < scene.triangles.size()
                        ? point_on_triangle(scene, hit.triangle, weights)
                        : point_on_primitive(scene, hit.triangle, hit.barycentrics),
                    true};
  if (glm::dot(result.point.geometric_normal, ray_direction) > 0.0F) turn_around(result);
  return result;
}

SurfacePoint free_point(const Vec3& position, const Vec3& normal) {
  return {position, normal, normal, clearance(glm::abs(position))};
}

std::vector<SurfacePoint> vertex_points(const scene::Scene& scene) {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  struct Largest {
    std::uint32_t triangle = kNone;
    int corner = 0;
    float area = -1.0F;
  };
  std::vector<Largest> largest(scene.positions.size());
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const glm::uvec3 corners = scene.triangles[t];
    const Vec3 origin = scene.positions[corners.x];
    const float area =
        glm::length(glm::cross(scene.positions[corners.y] - origin, scene.positions[corners.z] - origin));
    for (int k = 0; k < 3; ++k) {
      Largest& best = largest[corners[k]];
      if (area > best.area) best = {t, k, area};
    }
  }
  std::vector<SurfacePoint> points(scene.positions.size());
  for (std::size_t v = 0; v < points.size(); ++v) {
    const Largest& best = largest[v];
    if (best.triangle == kNone) {
      points[v] = free_point(scene.positions[v], scene.normals[v]);
      continue;
    }
    Vec3 weights(kVertexInset / 3.0F);
    weights[best.corner] += 1.0F - kVertexInset;
    points[v] = point_on_triangle(scene, best.triangle, weights);
    points[v].shading_normal = glm::normalize(scene.normals[v]);
    if (glm::dot(points[v].geometric_normal, scene.normals[v]) < 0.0F) {
      points[v].geometric_normal = -points[v].geometric_normal;
    }
  }
  return points;
}

}  // namespace plumbline::trace
