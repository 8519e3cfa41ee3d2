#include "reference/trace/surface_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "reference/scene/normal_map.hpp"
#include "reference/trace/analytic.hpp"

namespace plumbline::trace {
namespace {

constexpr float kVertexInset = 1e-3F;

SurfacePoint point_on_triangle(const scene::Scene& scene, std::uint32_t triangle, const Vec3& weights) {
  const glm::uvec3 corners = scene.triangles[triangle];
  const Vec3 positions[3] = {scene.positions[corners.x], scene.positions[corners.y],
                             scene.positions[corners.z]};
  SurfacePoint point = point_on_plane(positions, weights, scene::geometric_normal(scene, triangle));
  point.shading_normal = shading_normal(scene, triangle, weights, point.geometric_normal);
  return point;
}

}  // namespace

Vec3 shading_normal(const scene::Scene& scene, std::uint32_t triangle, const Vec3& weights,
                    const Vec3& geometric) {
  const glm::uvec3 corners = scene.triangles[triangle];
  const Vec3 sum = weights.x * scene.normals[corners.x] + weights.y * scene.normals[corners.y] +
                   weights.z * scene.normals[corners.z];
  const float length = glm::length(sum);
  // Opposite vertex normals can cancel; the plane's own normal is then the only one there is.
  const Vec3 normal = length > 1e-6F ? sum / length : geometric;
  if (scene.tangents.empty() || scene.materials[scene.triangle_materials[triangle]].normal_texture < 0)
    return normal;
  return scene::mapped_normal(scene, triangle, weights, normal);
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
