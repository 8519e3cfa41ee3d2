#include "reference/scene/builtin.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "reference/base/error.hpp"
#include "reference/scene/shapes.hpp"

namespace plumbline::scene {
namespace {

using Triangle = std::array<Vec3d, 3>;
using Key = std::tuple<float, float, float>;

template <class Shape>  // Scene or Mesh
Triangle corners(const Shape& shape, const glm::uvec3& t) {
  return {Vec3d(shape.positions[t.x]), Vec3d(shape.positions[t.y]), Vec3d(shape.positions[t.z])};
}
Vec3d scaled_normal(const Triangle& t) {  // length = twice the area
  return glm::cross(t[1] - t[0], t[2] - t[0]);
}

template <class Shape>
double smallest_area(const Shape& shape) {
  double area = 1e300;
  for (const auto& t : shape.triangles) {
    area = std::min(area, 0.5 * glm::length(scaled_normal(corners(shape, t))));
  }
  return area;
}

/// Vertex normals that are not unit (to 1e-5: a few roundings of float) or look behind their triangle.
template <class Shape>
std::size_t wrong_normals(const Shape& shape) {
  std::size_t wrong = 0;
  for (const auto& t : shape.triangles) {
    const Vec3d front = scaled_normal(corners(shape, t));
    for (int k = 0; k < 3; ++k) {
      const Vec3d normal(shape.normals[t[k]]);
      const bool is_right = std::abs(glm::length(normal) - 1.0) <= 1e-5 && glm::dot(normal, front) > 0.0;
      wrong += is_right ? 0U : 1U;
    }
  }
  return wrong;
}

/// Directed edges, after welding equal positions, that no neighbour runs through the other way.
template <class Shape>
std::vector<std::pair<Vec3, Vec3>> open_edges(const Shape& shape) {
  const auto key = [](const Vec3& p) { return Key(p.x + 0.0F, p.y + 0.0F, p.z + 0.0F); };
  std::map<std::pair<Key, Key>, int> surplus;
  const auto add = [&](const Vec3& a, const Vec3& b) {
    const bool is_ordered = key(a) < key(b);
    surplus[is_ordered ? std::pair(key(a), key(b)) : std::pair(key(b), key(a))] += is_ordered ? 1 : -1;
  };
  for (const auto& t : shape.triangles) {
    for (int k = 0; k < 3; ++k) add(shape.positions[t[k]], shape.positions[t[(k + 1) % 3]]);
  }
  std::vector<std::pair<Vec3, Vec3>> open;
  for (const auto& [edge, count] : surplus) {
    if (count == 0) continue;
    const auto point = [](const Key& k) { return Vec3(std::get<0>(k), std::get<1>(k), std::get<2>(k)); };
    open.emplace_back(point(edge.first), point(edge.second));
  }
  return open;
}

/// Divergence theorem: > 0 where fronts look outward.
template <class Shape>
double signed_volume(const Shape& shape) {
  double sum = 0.0;
  for (const auto& t : shape.triangles) {
    const Triangle c = corners(shape, t);
    sum += glm::dot(c[0], glm::cross(c[1], c[2])) / 6.0;
  }
  return sum;
}

/// Separating axes in the plane of `a`: do the interiors share more than a sliver?
bool overlap_in_plane(const Triangle& a, const Triangle& b) {
  constexpr double kSliver = 1e-5;  // metres: float rounding of coordinates up to 20 m is 1e-6
  const Vec3d normal = glm::normalize(scaled_normal(a));
  for (const Triangle* side : {&a, &b}) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d axis = glm::normalize(glm::cross(normal, (*side)[(k + 1) % 3] - (*side)[k]));
      const auto range = [&](const Triangle& t) {
        return std::minmax({glm::dot(axis, t[0]), glm::dot(axis, t[1]), glm::dot(axis, t[2])});
      };
      const auto [low_a, high_a] = range(a);
      const auto [low_b, high_b] = range(b);
      if (std::min(high_a, high_b) - std::max(low_a, low_b) <= kSliver) return false;
    }
  }
  return true;
}

/// Pairs of triangles that lie in one plane (normals and offsets equal to 1e-4, either side up) and overlap.
std::size_t coplanar_overlaps(const Scene& scene) {
  using Plane = std::array<long, 4>;
  std::map<Plane, std::vector<Triangle>> planes;
  for (const auto& t : scene.triangles) {
    const Triangle c = corners(scene, t);
    Vec3d n = glm::normalize(scaled_normal(c));
    const double largest =
        std::max({n.x, n.y, n.z}, [](double p, double q) { return std::abs(p) < std::abs(q); });
    if (largest < 0.0) n = -n;
    const auto rounded = [](double x) { return std::lround(x * 1e4); };
    planes[{rounded(n.x), rounded(n.y), rounded(n.z), rounded(glm::dot(n, c[0]))}].push_back(c);
  }
  const auto low = [](const Triangle& t) { return std::min({t[0].x, t[1].x, t[2].x}); };
  const auto high = [](const Triangle& t) { return std::max({t[0].x, t[1].x, t[2].x}); };
  std::size_t overlaps = 0;
  for (auto& [plane, triangles] : planes) {
    std::sort(triangles.begin(), triangles.end(),
              [&](const auto& a, const auto& b) { return low(a) < low(b); });
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      for (std::size_t j = i + 1; j < triangles.size() && low(triangles[j]) <= high(triangles[i]); ++j) {
        overlaps += overlap_in_plane(triangles[i], triangles[j]) ? 1U : 0U;
      }
    }
  }
  return overlaps;
}

Vec3d extent(const Scene& scene) {
  Vec3d low(1e300);
  Vec3d high(-1e300);
  for (const Vec3& p : scene.positions) {
    low = glm::min(low, Vec3d(p));
    high = glm::max(high, Vec3d(p));
  }
  return high - low;
}

TEST(BuiltinScenes, EveryNameMakesASceneWithConsistentArrays) {
  for (const BuiltinInfo& info : builtin_scenes()) {
    SCOPED_TRACE(info.name);
    const Scene scene = make_builtin_scene(info.name);
    EXPECT_EQ(scene.name, "builtin:" + info.name);
    EXPECT_EQ(scene.normals.size(), scene.positions.size());
    EXPECT_EQ(scene.triangle_materials.size(), scene.triangles.size());
    EXPECT_FALSE(scene.cameras.empty());
    for (const auto& t : scene.triangles) ASSERT_LT(std::max({t.x, t.y, t.z}), scene.positions.size());
    for (const auto m : scene.triangle_materials) ASSERT_LT(m, scene.materials.size());
    EXPECT_EQ(info.description.find('\n'), std::string::npos);
    const bool is_exact = primitive_count(scene) > 0;  // these say so instead of counting
    const std::string head = is_exact ? "exact" : std::to_string(scene.triangles.size()) + " triangles";
    EXPECT_NE(info.description.substr(0, 24).find(head), std::string::npos);
    EXPECT_NO_THROW(validate(scene, info.name));
  }
}

TEST(BuiltinScenes, UnknownNameListsTheNames) {
  try {
    (void)make_builtin_scene("cornel");
    FAIL() << "no exception";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("cornel:"), std::string::npos);
    for (const BuiltinInfo& info : builtin_scenes()) EXPECT_NE(message.find(info.name), std::string::npos);
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

TEST(BuiltinScenes, TerrainHasAsManyTrianglesAsAskedAndTheSameSurface) {
  const Scene coarse = make_builtin_scene("terrain:8");
  const Scene fine = make_builtin_scene("terrain:16");
  EXPECT_EQ(coarse.triangles.size(), 128U);
  EXPECT_EQ(fine.triangles.size(), 512U);
  EXPECT_EQ(coarse.name, "builtin:terrain:8");
  EXPECT_EQ(coarse.positions[4 * 9 + 4], fine.positions[8 * 17 + 8]);
  for (const char* name : {"terrain:", "terrain:7", "terrain:8193", "terrain:1x", "terrain:-8"})
    EXPECT_THROW((void)make_builtin_scene(name), InputError) << name;
}

TEST(BuiltinScenes, NormalsAreUnitAndAgreeWithTheFronts) {
  for (const BuiltinInfo& info : builtin_scenes()) {
    EXPECT_EQ(wrong_normals(make_builtin_scene(info.name)), 0U) << info.name;
  }
  Scene turned = make_builtin_scene("corner");  // planted fault
  turned.normals[0] = -turned.normals[0];
  EXPECT_GT(wrong_normals(turned), 0U);
}

TEST(BuiltinScenes, CamerasAreOrthonormalFrames) {
  for (const BuiltinInfo& info : builtin_scenes()) {
    for (const Camera& camera : make_builtin_scene(info.name).cameras) {
      EXPECT_LE(std::abs(glm::length(camera.forward) - 1.0F), 1e-5F) << info.name;
      EXPECT_LE(std::abs(glm::length(camera.up) - 1.0F), 1e-5F) << info.name;
      EXPECT_LE(std::abs(glm::dot(camera.up, camera.forward)), 1e-5F) << info.name;
    }
  }
}

TEST(BuiltinScenes, NoTriangleIsDegenerate) {
  for (const BuiltinInfo& info : builtin_scenes()) {
    // The smallest wanted triangles are millimetres wide; rounding of 20 m coordinates makes 1e-12 m^2.
    EXPECT_GE(smallest_area(make_builtin_scene(info.name)), 1e-7) << info.name;
  }
}

TEST(BuiltinScenes, NoTwoTrianglesOverlapInOnePlane) {
  for (const BuiltinInfo& info : builtin_scenes()) {
    EXPECT_EQ(coplanar_overlaps(make_builtin_scene(info.name)), 0U) << info.name;
  }
  Scene doubled = make_builtin_scene("box-furnace");  // planted fault
  doubled.triangles.push_back(doubled.triangles[3]);
  EXPECT_GT(coplanar_overlaps(doubled), 0U);
}

TEST(BuiltinScenes, TheSameEveryTime) {
  const Scene a = make_builtin_scene("plaza");
  const Scene b = make_builtin_scene("plaza");
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.triangles, b.triangles);
}

TEST(BuiltinScenes, CornellHasItsMeasuredDimensions) {
  const Scene scene = make_builtin_scene("cornell");
  ASSERT_EQ(scene.triangles.size(), 32U);
  const Vec3d size = extent(scene);
  EXPECT_LE(std::abs(size.x - 5.56), 1e-6);
  EXPECT_LE(std::abs(size.y - 5.488), 1e-6);
  EXPECT_LE(std::abs(size.z - 5.592), 1e-6);
  double lamp_area = 0.0;
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    if (is_black(scene.materials[scene.triangle_materials[i]].emission)) continue;
    const Triangle c = corners(scene, scene.triangles[i]);
    lamp_area += 0.5 * glm::length(scaled_normal(c));
    EXPECT_LT(glm::normalize(scaled_normal(c)).y, -0.999999);
    for (const Vec3d& p : c) EXPECT_LE(std::abs(p.y - 5.483), 1e-6);
  }
  EXPECT_LE(std::abs(lamp_area - 1.30 * 1.05), 1e-5);  // float rounding of 5 m coordinates, times 1 m
}

TEST(BuiltinScenes, CornellIsRedOnTheLeftOfItsPicture) {
  const Scene scene = make_builtin_scene("cornell");
  const Camera& camera = scene.cameras[0];
  EXPECT_LE(std::abs(camera.vertical_fov_rad * 180.0 / kPi - 39.3077), 1e-4);
  const Vec3 right = glm::cross(camera.forward, camera.up);
  int seen = 0;
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    const std::string& name = scene.materials[scene.triangle_materials[i]].name;
    if (name != "red" && name != "green") continue;
    const Triangle c = corners(scene, scene.triangles[i]);
    const Vec3d middle = (c[0] + c[1] + c[2]) / 3.0;
    const double side = glm::dot(middle - Vec3d(camera.eye), Vec3d(right));
    EXPECT_TRUE(name == "red" ? side < 0.0 : side > 0.0);
    EXPECT_LT(glm::dot(scaled_normal(c), Vec3d(right)) * side, 0.0) << "the wall looks into the room";
    ++seen;
  }
  EXPECT_EQ(seen, 4);
}

TEST(BuiltinScenes, CornellBlocksAreOpenOnlyAtTheFloor) {
  const Scene scene = make_builtin_scene("cornell");
  Mesh blocks;
  blocks.positions = scene.positions;
  blocks.triangles.assign(scene.triangles.begin() + 12, scene.triangles.end());
  const auto open = open_edges(blocks);
  EXPECT_EQ(open.size(), 8U);
  for (const auto& [a, b] : open) EXPECT_EQ(a.y + b.y, 0.0F);
  // Bases by the shoelace formula on the published corners: 2.76330 m^2 x 1.65 m and 2.76265 m^2 x 3.30 m.
  EXPECT_LE(std::abs(signed_volume(blocks) - 13.67619), 2e-5);
}

TEST(BuiltinScenes, BoxFurnaceIsClosedAndLooksInward) {
  const Scene scene = make_builtin_scene("box-furnace");
  EXPECT_TRUE(open_edges(scene).empty());
  EXPECT_EQ(signed_volume(scene), -8.0);
  Scene holed = scene;  // planted fault
  holed.triangles.pop_back();
  EXPECT_EQ(open_edges(holed).size(), 3U);
}

TEST(BuiltinScenes, ConvexIsTheRegularIcosahedron) {
  const Scene scene = make_builtin_scene("convex");
  EXPECT_TRUE(open_edges(scene).empty());
  // Circumscribed radius 1: edge a = 1 / sin(72 deg), volume 5 (3 + sqrt 5) a^3 / 12.
  const double edge = 1.0 / std::sin(72.0 * kPi / 180.0);
  const double volume = 5.0 * (3.0 + std::sqrt(5.0)) * edge * edge * edge / 12.0;
  EXPECT_LE(std::abs(signed_volume(scene) - volume), 1e-6);
}

TEST(BuiltinScenes, SphereRestsOnItsPlane) {
  const Scene scene = make_builtin_scene("sphere-on-plane");
  float lowest = 1.0F;
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    if (scene.triangle_materials[i] != 1U) continue;
    for (int k = 0; k < 3; ++k) {
      const Vec3& p = scene.positions[scene.triangles[i][k]];
      lowest = std::min(lowest, p.y);
      EXPECT_LE(glm::distance(p, scene.normals[scene.triangles[i][k]] + Vec3(0.0F, 1.0F, 0.0F)), 1e-6F);
    }
  }
  EXPECT_EQ(lowest, 0.0F);
}

TEST(BuiltinScenes, CornerIsTwoQuadsAtARightAngle) {
  const Scene scene = make_builtin_scene("corner");
  EXPECT_EQ(scene.triangles.size(), 4U);
  EXPECT_EQ(scene.normals.front(), Vec3(0.0F, 1.0F, 0.0F));
  EXPECT_EQ(scene.normals.back(), Vec3(0.0F, 0.0F, 1.0F));
  EXPECT_EQ(extent(scene), Vec3d(2000.0, 1000.0, 1000.0));
}

TEST(BuiltinScenes, OpenBoxLacksOnlyItsLid) {
  const Scene scene = make_builtin_scene("open-box");
  const auto open = open_edges(scene);
  EXPECT_EQ(open.size(), 4U * 24U);
  for (const auto& [a, b] : open) {
    EXPECT_EQ(a.y, 1.4F);
    EXPECT_EQ(b.y, 1.4F);
  }
  for (const Material& material : scene.materials) EXPECT_TRUE(material.is_double_sided) << material.name;
}

TEST(BuiltinScenes, PlazaIsClosedButForTheBorderOfItsGround) {
  const Scene scene = make_builtin_scene("plaza");
  EXPECT_GE(scene.triangles.size(), 20000U);
  const auto open = open_edges(scene);
  EXPECT_EQ(open.size(), 4U * 64U);
  for (const auto& [a, b] : open) {
    const bool is_border = a.y == 0.0F && b.y == 0.0F &&
                           ((a.x == b.x && std::abs(a.x) == 18.0F) || (a.z == b.z && std::abs(a.z) == 18.0F));
    EXPECT_TRUE(is_border) << a.x << ' ' << a.y << ' ' << a.z;
  }
}

// ---------------------------------------------------------------- shapes
struct NamedMesh {
  std::string name;
  Mesh mesh;
  double volume;     // exact, of the smooth shape
  double tolerance;  // relative: facets inscribed in a circle of n chords lose 2 pi^2 / 3 n^2 of the area
};

double chord_loss(int chords) {
  return 2.0 * kPi * kPi / (3.0 * chords * chords);
}

std::vector<NamedMesh> closed_shapes() {
  const std::array<ProfilePoint, 5> cone = {{{0, 0}, {1, 0}, {1, 1}, {0.5, 1.5}, {0, 2}}};
  const std::array<ProfilePoint, 4> section = {{{2, 0}, {3, 0}, {3, 1}, {2, 1}}};
  const auto torus = [](double u, double v) {  // u about the tube, v about the axis
    const double r = 2.0 + 0.5 * std::cos(2.0 * kPi * u);
    return around_y(r, 0.5 * std::sin(2.0 * kPi * u), -2.0 * kPi * v);
  };
  const auto cylinder = [](double u, double v) { return around_y(1.0, v, 2.0 * kPi * u); };
  const ArchShape arch = {
      .half_width = 2.0, .height = 4.0, .opening_half_width = 1.0, .springing_height = 2.0, .depth = 0.5};
  return {
      {"box", make_box({-1, 0, 2}, {1, 3, 4}), 12.0, 1e-12},
      {"sphere", make_icosphere(4), 4.0 * kPi / 3.0, 4e-3},  // chord angle 4 degrees: about 0.62 a^2 = 3e-3
      {"lathe", make_lathe(cone, 90, 30.0), kPi * (1.0 + 1.0 / 3.0), 1.1 * chord_loss(90)},
      {"sector", make_ring_sector(section, 0.3, 0.3 + kPi / 2.0, 30), kPi / 4.0 * 5.0, 1.1 * chord_loss(120)},
      {"torus", make_tube(torus, 60, 120, Ends::joined), 2.0 * kPi * kPi * 2.0 * 0.25,
       1.1 * (chord_loss(60) + chord_loss(120))},
      {"cylinder", make_tube(cylinder, 60, 3, Ends::capped), kPi, 1.1 * chord_loss(60)},
      {"arch", make_arch(arch, 64), 0.5 * (4.0 * 4.0 - 2.0 * 2.0 - kPi / 2.0), chord_loss(128)},
  };
}

TEST(Shapes, ClosedShapesAreClosedAndHoldTheirVolume) {
  for (const NamedMesh& shape : closed_shapes()) {
    EXPECT_TRUE(open_edges(shape.mesh).empty()) << shape.name;
    EXPECT_LE(std::abs(signed_volume(shape.mesh) / shape.volume - 1.0), shape.tolerance) << shape.name;
    EXPECT_EQ(wrong_normals(shape.mesh), 0U) << shape.name;
    EXPECT_GT(smallest_area(shape.mesh), 1e-6) << shape.name;
  }
}

TEST(Shapes, PlacingKeepsThemClosedAndScalesTheVolume) {
  for (const NamedMesh& shape : closed_shapes()) {
    const Mesh moved = placed(shape.mesh, {3.0, -1.0, 2.0}, 1.7, 0.6);
    EXPECT_TRUE(open_edges(moved).empty()) << shape.name;
    EXPECT_EQ(wrong_normals(moved), 0U) << shape.name;
    const double ratio = signed_volume(moved) / signed_volume(shape.mesh);
    EXPECT_LE(std::abs(ratio / (1.7 * 1.7 * 1.7) - 1.0), 1e-5) << shape.name;
    EXPECT_LT(signed_volume(inside_out(moved)), 0.0) << shape.name;
  }
}

TEST(Shapes, IcosphereHasTheAxisPointsAndTheCountsOfEuler) {
  for (int level = 0; level <= 5; ++level) {
    const Mesh sphere = make_icosphere(level);
    EXPECT_EQ(sphere.triangles.size(), 20U << (2 * level));
    EXPECT_EQ(sphere.positions.size(), sphere.triangles.size() / 2 + 2);
  }
  const Mesh sphere = make_icosphere(1);
  for (const Vec3& pole : {Vec3(0, -1, 0), Vec3(1, 0, 0), Vec3(0, 0, 1)}) {
    EXPECT_NE(std::find(sphere.positions.begin(), sphere.positions.end(), pole), sphere.positions.end());
  }
}

TEST(Shapes, LatheSmoothsBelowTheCreaseOnly) {
  const std::array<ProfilePoint, 5> cone = {{{0, 0}, {1, 0}, {1, 1}, {0.5, 1.5}, {0, 2}}};
  const std::size_t sharp = make_lathe(cone, 12, 30.0).positions.size();
  const std::size_t smooth = make_lathe(cone, 12, 50.0).positions.size();
  EXPECT_EQ(sharp, 1U + 12U + 24U + 24U + 1U);  // collinear (0.5, 1.5) shared, 45 and 90 degrees split
  EXPECT_EQ(smooth, sharp - 12U);
}

}  // namespace
}  // namespace plumbline::scene
