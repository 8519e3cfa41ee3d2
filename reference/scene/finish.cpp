#include "reference/scene/finish.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "reference/base/error.hpp"
#include "reference/scene/normal_map.hpp"
#include "reference/scene/normals.hpp"
#include "reference/scene/tangents.hpp"

namespace plumbline::scene {
namespace {

void require_finite(const Scene& scene, const std::vector<std::uint8_t>& has_normal,
                    const std::string& where) {
  for (std::size_t i = 0; i < scene.positions.size(); ++i) {
    const Vec3 p = scene.positions[i];
    if (!is_finite(p) || max_magnitude(p) > kLargestCoordinate) {
      throw InputError(fmt::format("{}: position of vertex {} is not finite and within {}: ({}, {}, {})",
                                   where, i, kLargestCoordinate, p.x, p.y, p.z));
    }
    const Vec3 n = scene.normals[i];
    if (has_normal[i] != 0 && !is_finite(n)) {
      throw InputError(
          fmt::format("{}: normal of vertex {} is not finite: ({}, {}, {})", where, i, n.x, n.y, n.z));
    }
  }
}

void drop_degenerate(Scene& scene, const std::string& where) {
  if (scene.triangles.empty()) throw InputError(where + ": has no triangles");
  std::size_t kept = 0;
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    const glm::uvec3 corners = scene.triangles[t];
    if (is_degenerate(scene.positions[corners.x], scene.positions[corners.y], scene.positions[corners.z])) {
      continue;
    }
    scene.triangles[kept] = corners;
    scene.triangle_materials[kept] = scene.triangle_materials[t];
    ++kept;
  }
  scene.dropped_degenerate += scene.triangles.size() - kept;
  if (kept == 0) {
    throw InputError(
        fmt::format("{}: no triangle has any area ({} triangles)", where, scene.triangles.size()));
  }
  scene.triangles.resize(kept);
  scene.triangle_materials.resize(kept);
}

void normalize_normals(Scene& scene, std::vector<std::uint8_t>& has_normal) {
  for (std::size_t i = 0; i < scene.normals.size(); ++i) {
    if (has_normal[i] == 0) continue;
    if (scene.normals[i] == Vec3(0.0F)) {
      has_normal[i] = 0;
    } else {
      scene.normals[i] = normalized_once(scene.normals[i]);
    }
  }
}

// Tangents are kept, made unit length or computed where a normal map needs them, and dropped elsewhere. One that belongs to a normal
// which had to be computed is computed too, as glTF asks.
Scene with_finished_tangents(Scene scene, const std::vector<std::uint8_t>& has_normal,
                             const std::string& where) {
  if (!has_normal_map(scene)) {
    scene.tangents.clear();
    return scene;
  }
  for (std::size_t i = 0; i < scene.texcoords.size(); ++i) {
    const Vec2 uv = scene.texcoords[i];
    if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) {
      throw InputError(
          fmt::format("{}: texture coordinate of vertex {} is not finite: ({}, {})", where, i, uv.x, uv.y));
    }
  }
  scene.tangents.resize(scene.positions.size(), glm::vec4(0.0F));
  for (std::size_t v = 0; v < scene.tangents.size(); ++v) {
    glm::vec4& tangent = scene.tangents[v];
    const Vec3 along(tangent);
    if (v >= has_normal.size() || has_normal[v] == 0 || along == Vec3(0.0F)) {
      tangent = glm::vec4(0.0F);
    } else {
      tangent = glm::vec4(normalized_once(along), tangent.w);
    }
  }
  return with_computed_tangents(std::move(scene));
}

}  // namespace

Vec3 normalized_once(Vec3 v) {
  // Rounding a unit vector to float changes its squared length by at most 2 sqrt(3) 2^-25 = 1e-7.
  const Vec3d exact(v);
  if (std::abs(glm::dot(exact, exact) - 1.0) <= 5e-7) return v;
  return Vec3(glm::normalize(exact));
}

Scene finish_loading(Scene scene, std::vector<std::uint8_t> has_normal, const LoadOptions& options,
                     const std::string& where) {
  require_finite(scene, has_normal, where);
  drop_degenerate(scene, where);
  normalize_normals(scene, has_normal);
  const bool has_texture = std::any_of(
      scene.materials.begin(), scene.materials.end(),
      [](const Material& material) { return material.albedo_texture >= 0 || material.normal_texture >= 0; });
  if (has_texture && scene.texcoords.empty()) scene.texcoords.resize(scene.positions.size(), Vec2(0.0F));
  try {
    scene = with_computed_normals(std::move(scene), has_normal, options.crease_deg);
  } catch (const InputError& error) {
    throw InputError(where + ": " + error.what());
  }
  scene = with_finished_tangents(std::move(scene), has_normal, where);
  if (scene.cameras.empty()) scene.cameras.push_back(frame_camera(scene));
  validate(scene, where);
  return scene;
}

}  // namespace plumbline::scene
