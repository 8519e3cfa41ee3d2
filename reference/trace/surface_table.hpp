// reference/trace/surface_table.hpp: what shading needs of each triangle, in one cache line.
#pragma once

#include <cstdint>
#include <vector>

#include "reference/scene/scene.hpp"
#include "reference/trace/surface_point.hpp"

namespace plumbline::trace {

/// Corners, plane and material of every triangle of a scene, laid out for the tracer: a hit touches one record of 64 bytes
/// instead of indices, positions, normals and materials at seven places. The same results as surface_hit() of a scene. Spheres
/// and discs, numbered after the triangles, are left to that.
class SurfaceTable {
 public:
  explicit SurfaceTable(const scene::Scene& scene);

  /// The point of a hit, turned to the side that `ray_direction` comes from.
  [[nodiscard]] SurfaceHit hit(const Hit& hit, const Vec3& ray_direction) const;

  /// What a surface of one material is made of.
  struct Surface {
    Rgb albedo{0.0F};  // the factor; times texture and vertex colour unless is_uniform
    Rgb emission{0.0F};
    bool is_double_sided = false;
    bool is_uniform = true;
  };
  [[nodiscard]] const Surface& surface(std::uint32_t surface) const {
    return surfaces_[surface < records_.size() ? records_[surface].material
                                               : primitive_materials_[surface - records_.size()]];
  }
  /// Albedo at a hit.
  [[nodiscard]] Rgb albedo(const Hit& hit) const {
    const Surface& here = surface(hit.triangle);
    return here.is_uniform ? here.albedo : scene::albedo_at(*scene_, hit.triangle, hit.barycentrics);
  }

 private:
  struct alignas(64) Record {
    Vec3 corners[3];
    Vec3 normal{0.0F};  // geometric, unit
    std::uint32_t material = 0;
    bool is_flat =
        true;  // the vertex normals are the geometric one, to float rounding, and no map bends them
  };
  const scene::Scene* scene_;
  std::vector<Record> records_;
  std::vector<std::uint32_t> primitive_materials_;  // of spheres and discs
  std::vector<Surface> surfaces_;
};

}  // namespace plumbline::trace
