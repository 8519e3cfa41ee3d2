#include "reference/scene/tangents.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

namespace plumbline::scene {
namespace {

// Direction of growing u of a triangle, and whether cross(normal, tangent) points to smaller v ("up" in the image): +1, else -1.
struct Direction {
  Vec3d tangent{0.0};
  float sign = 1.0F;
};

// With edges e1, e2 and their texture coordinates d1, d2: P(u, v) linear gives dP/du = (e1 d2.v - e2 d1.v) / (d1 x d2). The
// triangle is counter-clockwise seen from the front; v grows downwards, so that d1 x d2 < 0 where the texture is not mirrored.
std::optional<Direction> direction_of(const Scene& scene, const glm::uvec3& corners) {
  const auto edge = [&](std::uint32_t to) {
    return Vec3d(scene.positions[to]) - Vec3d(scene.positions[corners.x]);
  };
  const auto step = [&](std::uint32_t to) {
    return glm::dvec2(scene.texcoords[to]) - glm::dvec2(scene.texcoords[corners.x]);
  };
  const glm::dvec2 d1 = step(corners.y);
  const glm::dvec2 d2 = step(corners.z);
  const double area = d1.x * d2.y - d1.y * d2.x;
  const Vec3d along = (edge(corners.y) * d2.y - edge(corners.z) * d1.y) * (area < 0.0 ? -1.0 : 1.0);
  const double length = glm::length(along);
  if (area == 0.0 || !std::isfinite(area) || !(length > 0.0)) return std::nullopt;
  return Direction{along / length, area < 0.0 ? 1.0F : -1.0F};
}

Vec3d in_plane(const Vec3d& v, const Vec3d& normal) {
  const Vec3d rest = v - glm::dot(v, normal) * normal;
  const double length = glm::length(rest);
  return length > 1e-9 * glm::length(v) ? rest / length : Vec3d(0.0);
}

Vec3 any_tangent(const Vec3& normal) {
  const Vec3d n(normal);
  const Vec3d helper = std::abs(n.x) < 0.5 ? Vec3d(1.0, 0.0, 0.0) : Vec3d(0.0, 1.0, 0.0);
  return Vec3(in_plane(helper, n));
}

// Angle at corner k between the two edges, both projected into the plane of the vertex normal.
double corner_angle(const Scene& scene, const glm::uvec3& corners, int k, const Vec3d& normal) {
  const Vec3d here(scene.positions[corners[k]]);
  const Vec3d a = in_plane(Vec3d(scene.positions[corners[(k + 1) % 3]]) - here, normal);
  const Vec3d b = in_plane(Vec3d(scene.positions[corners[(k + 2) % 3]]) - here, normal);
  return std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
}

using Key = std::array<float, 9>;  // position, normal, texture coordinate, sign

Key key_of(const Scene& scene, std::uint32_t v, float sign) {
  const Vec3 p = scene.positions[v];
  const Vec3 n = scene.normals[v];
  const Vec2 t = scene.texcoords[v];
  return {p.x, p.y, p.z, n.x, n.y, n.z, t.x, t.y, sign};
}

bool is_mapped(const Scene& scene, std::size_t triangle) {
  return scene.materials[scene.triangle_materials[triangle]].normal_texture >= 0;
}

std::map<Key, Vec3d> sums_of(const Scene& scene) {
  std::map<Key, Vec3d> sums;
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    if (!is_mapped(scene, t)) continue;
    const glm::uvec3 corners = scene.triangles[t];
    const std::optional<Direction> direction = direction_of(scene, corners);
    if (!direction) continue;
    for (int k = 0; k < 3; ++k) {
      const Vec3d normal(scene.normals[corners[k]]);
      sums.try_emplace(key_of(scene, corners[k], direction->sign), Vec3d(0.0)).first->second +=
          corner_angle(scene, corners, k, normal) * in_plane(direction->tangent, normal);
    }
  }
  return sums;
}

glm::vec4 tangent_from(const std::map<Key, Vec3d>& sums, const Scene& scene, std::uint32_t v, float sign) {
  const auto found = sums.find(key_of(scene, v, sign));
  const bool is_usable = found != sums.end() && glm::length(found->second) > 1e-9;
  return {is_usable ? Vec3(glm::normalize(found->second)) : any_tangent(scene.normals[v]), sign};
}

std::uint32_t append_copy(Scene& scene, std::uint32_t vertex) {
  const auto copy = [vertex](auto& values) {
    if (!values.empty())
      values.push_back(typename std::decay_t<decltype(values)>::value_type(values[vertex]));
  };
  copy(scene.positions);
  copy(scene.normals);
  copy(scene.texcoords);
  copy(scene.vertex_colors);
  copy(scene.tangents);
  return static_cast<std::uint32_t>(scene.positions.size() - 1);
}

}  // namespace

Scene with_computed_tangents(Scene scene) {
  std::vector<std::uint8_t> is_missing;
  for (const glm::vec4& tangent : scene.tangents) is_missing.push_back(tangent == glm::vec4(0.0F) ? 1 : 0);
  if (std::find(is_missing.begin(), is_missing.end(), std::uint8_t{1}) == is_missing.end()) return scene;
  const std::map<Key, Vec3d> sums = sums_of(scene);
  for (std::uint32_t v = 0; v < is_missing.size(); ++v) {
    if (is_missing[v] != 0) scene.tangents[v] = {any_tangent(scene.normals[v]), 1.0F};
  }
  std::vector<float> first_sign(is_missing.size(),
                                0.0F);              // 0: no triangle with area in the texture has used it yet
  std::map<std::uint32_t, std::uint32_t> mirrored;  // copies with the other sign
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    const std::optional<Direction> direction =
        is_mapped(scene, t) ? direction_of(scene, scene.triangles[t]) : std::nullopt;
    if (!direction) continue;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t vertex = scene.triangles[t][k];
      if (is_missing[vertex] == 0) continue;
      std::uint32_t target = vertex;
      if (first_sign[vertex] == -direction->sign) {
        const auto [copy, is_new] = mirrored.try_emplace(vertex, 0U);
        if (is_new) copy->second = append_copy(scene, vertex);
        target = copy->second;
      } else {
        first_sign[vertex] = direction->sign;
      }
      scene.tangents[target] = tangent_from(sums, scene, target, direction->sign);
      scene.triangles[t][k] = target;
    }
  }
  return scene;
}

}  // namespace plumbline::scene
