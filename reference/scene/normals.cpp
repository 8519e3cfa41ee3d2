#include "reference/scene/normals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "reference/base/error.hpp"

namespace plumbline::scene {
namespace {

// A corner is a triangle's vertex: 3 * triangle + k.
using Corner = std::size_t;

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
constexpr double kCoplanarDeg = 0.01;
constexpr std::size_t kMostTrianglesOnAnEdge = 16;

std::uint32_t vertex_of(const Scene& scene, Corner corner) {
  return scene.triangles[corner / 3][static_cast<int>(corner % 3)];
}

Corner next_corner(Corner corner) {
  return corner % 3 == 2 ? corner - 2 : corner + 1;
}

// One number for each different position: the smallest index of a vertex that lies there. Vertices that have
// a normal stay alone.
std::vector<std::uint32_t> weld(const Scene& scene, const std::vector<std::uint8_t>& has_normal) {
  std::vector<std::uint32_t> point(scene.positions.size());
  std::iota(point.begin(), point.end(), 0U);
  std::vector<std::uint32_t> sorted;
  for (std::uint32_t v = 0; v < point.size(); ++v) {
    if (has_normal[v] == 0) sorted.push_back(v);
  }
  const auto place = [&](std::uint32_t v) {
    const Vec3& p = scene.positions[v];
    return std::tuple(p.x, p.y, p.z);
  };
  std::sort(sorted.begin(), sorted.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::tuple(place(a), a) < std::tuple(place(b), b);
  });
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (place(sorted[i]) == place(sorted[i - 1])) point[sorted[i]] = point[sorted[i - 1]];
  }
  return point;
}

std::vector<Vec3d> face_normals(const Scene& scene) {
  std::vector<Vec3d> normals;
  normals.reserve(scene.triangles.size());
  for (const glm::uvec3& corners : scene.triangles) {
    const Vec3d a(scene.positions[corners.x]);
    const Vec3d ab = Vec3d(scene.positions[corners.y]) - a;
    normals.push_back(glm::normalize(glm::cross(ab, Vec3d(scene.positions[corners.z]) - a)));
  }
  return normals;
}

/// Disjoint sets of corners; a set's name is its smallest corner.
class CornerGroups {
 public:
  explicit CornerGroups(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }

  [[nodiscard]] Corner find(Corner corner) {
    while (parent_[corner] != corner) {
      parent_[corner] = parent_[parent_[corner]];
      corner = parent_[corner];
    }
    return corner;
  }
  void join(Corner a, Corner b) {
    const Corner root_a = find(a);
    const Corner root_b = find(b);
    parent_[std::max(root_a, root_b)] = std::min(root_a, root_b);
  }

 private:
  std::vector<Corner> parent_;
};

struct HalfEdge {
  std::uint32_t low;  // the two points, smaller first
  std::uint32_t high;
  Corner from;  // the edge runs from this corner to the next one
};

std::vector<HalfEdge> sorted_half_edges(const Scene& scene, const std::vector<std::uint32_t>& point) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * scene.triangles.size());
  for (Corner corner = 0; corner < 3 * scene.triangles.size(); ++corner) {
    const std::uint32_t a = point[vertex_of(scene, corner)];
    const std::uint32_t b = point[vertex_of(scene, next_corner(corner))];
    edges.push_back({std::min(a, b), std::max(a, b), corner});
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::tie(a.low, a.high, a.from) < std::tie(b.low, b.high, b.from);
  });
  return edges;
}

double angle_between(const Vec3d& a, const Vec3d& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));  // accurate near 0 and near pi
}

CornerGroups group_corners(const Scene& scene, const std::vector<std::uint32_t>& point,
                           const std::vector<Vec3d>& normals, double crease_deg) {
  const double limit_rad = std::max(crease_deg, kCoplanarDeg) * kPi / 180.0;
  const std::vector<HalfEdge> edges = sorted_half_edges(scene, point);
  CornerGroups groups(edges.size());
  const auto join_across = [&](const HalfEdge& a, const HalfEdge& b) {
    if (angle_between(normals[a.from / 3], normals[b.from / 3]) > limit_rad) return;
    const bool is_same_way = point[vertex_of(scene, a.from)] == point[vertex_of(scene, b.from)];
    groups.join(a.from, is_same_way ? b.from : next_corner(b.from));
    groups.join(next_corner(a.from), is_same_way ? next_corner(b.from) : b.from);
  };
  for (std::size_t begin = 0; begin < edges.size();) {
    std::size_t end = begin + 1;
    while (end < edges.size() && edges[end].low == edges[begin].low && edges[end].high == edges[begin].high) {
      ++end;
    }
    if (end - begin <= kMostTrianglesOnAnEdge) {
      for (std::size_t i = begin; i < end; ++i) {
        for (std::size_t j = i + 1; j < end; ++j) join_across(edges[i], edges[j]);
      }
    }
    begin = end;
  }
  return groups;
}

double corner_angle(const Scene& scene, Corner corner) {
  const Vec3d here(scene.positions[vertex_of(scene, corner)]);
  const Corner next = next_corner(corner);
  const Vec3d to_next = Vec3d(scene.positions[vertex_of(scene, next)]) - here;
  return angle_between(to_next, Vec3d(scene.positions[vertex_of(scene, next_corner(next))]) - here);
}

// At the index of each group's name: its normal. Opposite triangles may cancel; the first one's normal
// remains.
std::vector<Vec3> group_normals(const Scene& scene, CornerGroups& groups, const std::vector<Vec3d>& normals) {
  std::vector<Vec3d> sums(3 * scene.triangles.size(), Vec3d(0.0));
  for (Corner corner = 0; corner < sums.size(); ++corner) {
    sums[groups.find(corner)] += corner_angle(scene, corner) * normals[corner / 3];
  }
  std::vector<Vec3> result(sums.size());
  for (Corner corner = 0; corner < sums.size(); ++corner) {
    const double length = glm::length(sums[corner]);
    result[corner] = Vec3(length > 1e-9 ? sums[corner] / length : normals[corner / 3]);
  }
  return result;
}

std::uint32_t append_copy(Scene& scene, std::uint32_t vertex) {
  if (scene.positions.size() >= kNone) throw InputError("too many vertices after splitting at creases");
  scene.positions.push_back(Vec3(scene.positions[vertex]));
  scene.normals.emplace_back(0.0F);
  if (!scene.texcoords.empty()) scene.texcoords.push_back(Vec2(scene.texcoords[vertex]));
  if (!scene.vertex_colors.empty()) scene.vertex_colors.push_back(Rgb(scene.vertex_colors[vertex]));
  if (!scene.tangents.empty()) scene.tangents.push_back(glm::vec4(scene.tangents[vertex]));
  return static_cast<std::uint32_t>(scene.positions.size() - 1);
}

void assign_normals(Scene& scene, const std::vector<std::uint8_t>& has_normal, CornerGroups& groups,
                    const std::vector<Vec3>& normals) {
  constexpr Corner kUnused = std::numeric_limits<Corner>::max();
  std::vector<Corner> first_group(has_normal.size(), kUnused);
  std::unordered_map<Corner, std::vector<std::pair<std::uint32_t, std::uint32_t>>>
      copies;  // of (vertex, copy)
  for (Corner corner = 0; corner < 3 * scene.triangles.size(); ++corner) {
    const std::uint32_t vertex = vertex_of(scene, corner);
    if (has_normal[vertex] != 0) continue;
    const Corner group = groups.find(corner);
    std::uint32_t target = vertex;
    if (first_group[vertex] == kUnused) first_group[vertex] = group;
    if (first_group[vertex] != group) {
      auto& of_group = copies[group];
      const auto known = std::find_if(of_group.begin(), of_group.end(),
                                      [&](const auto& copy) { return copy.first == vertex; });
      target = known != of_group.end() ? known->second : append_copy(scene, vertex);
      if (known == of_group.end()) of_group.emplace_back(vertex, target);
    }
    scene.normals[target] = normals[group];
    scene.triangles[corner / 3][static_cast<int>(corner % 3)] = target;
  }
  for (std::size_t v = 0; v < first_group.size(); ++v) {
    if (has_normal[v] == 0 && first_group[v] == kUnused) scene.normals[v] = Vec3(0.0F, 1.0F, 0.0F);
  }
}

}  // namespace

Scene with_computed_normals(Scene scene, const std::vector<std::uint8_t>& has_normal, float crease_deg) {
  if (!(crease_deg >= 0.0F && crease_deg <= 180.0F)) {
    throw InputError(fmt::format("crease angle is {} degrees, expected 0 to 180", crease_deg));
  }
  if (std::find(has_normal.begin(), has_normal.end(), std::uint8_t{0}) == has_normal.end()) return scene;
  const std::vector<Vec3d> normals = face_normals(scene);
  CornerGroups groups =
      group_corners(scene, weld(scene, has_normal), normals, static_cast<double>(crease_deg));
  const std::vector<Vec3> of_group = group_normals(scene, groups, normals);
  assign_normals(scene, has_normal, groups, of_group);
  return scene;
}

}  // namespace plumbline::scene
