#include "reference/trace/surface_table.hpp"

#include <limits>

namespace plumbline::trace {
namespace {

// Computed normals of flat faces differ from the plane's own in their last bits.
constexpr float kRounding = 4.0F * std::numeric_limits<float>::epsilon();

bool has_flat_normals(const scene::Scene& scene, const glm::uvec3& corners, const Vec3& geometric) {
  for (int k = 0; k < 3; ++k) {
    if (!(max_magnitude(scene.normals[corners[k]] - geometric) <= kRounding)) return false;
  }
  return true;
}

}  // namespace

SurfaceTable::SurfaceTable(const scene::Scene& scene) : scene_(&scene) {
  records_.resize(scene.triangles.size());
  for (std::uint32_t t = 0; t < records_.size(); ++t) {
    const glm::uvec3 corners = scene.triangles[t];
    Record& record = records_[t];
    for (int k = 0; k < 3; ++k) record.corners[k] = scene.positions[corners[k]];
    record.normal = scene::geometric_normal(scene, t);
    record.material = scene.triangle_materials[t];
    record.is_flat = scene.materials[record.material].normal_texture < 0 &&
                     has_flat_normals(scene, corners, record.normal);
  }
  for (std::size_t i = 0; i < scene::primitive_count(scene); ++i) {
    const scene::Material& material =
        scene::material_of(scene, static_cast<std::uint32_t>(records_.size() + i));
    primitive_materials_.push_back(static_cast<std::uint32_t>(&material - scene.materials.data()));
  }
  for (const scene::Material& material : scene.materials) {
    surfaces_.push_back({material.albedo, material.emission, material.is_double_sided,
                         material.albedo_texture < 0 && scene.vertex_colors.empty()});
  }
}

SurfaceHit SurfaceTable::hit(const Hit& hit, const Vec3& ray_direction) const {
  if (hit.triangle >= records_.size()) return surface_hit(*scene_, hit, ray_direction);
  const Record& record = records_[hit.triangle];
  const Vec3 weights(1.0F - hit.barycentrics.x - hit.barycentrics.y, hit.barycentrics.x, hit.barycentrics.y);
  SurfaceHit result{point_on_plane(record.corners, weights, record.normal), true};
  if (!record.is_flat) {
    result.point.shading_normal = shading_normal(*scene_, hit.triangle, weights, record.normal);
  }
  if (glm::dot(record.normal, ray_direction) > 0.0F) turn_around(result);
  return result;
}

}  // namespace plumbline::trace
