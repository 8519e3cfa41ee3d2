#include "reference/scene/normals.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "reference/base/error.hpp"
#include "validation/tests/scene/scene_files.hpp"

namespace plumbline::scene {
namespace {

Scene make_mesh(std::vector<Vec3> positions, std::vector<glm::uvec3> triangles) {
  Scene scene;
  scene.positions = std::move(positions);
  scene.triangles = std::move(triangles);
  scene.normals.assign(scene.positions.size(), Vec3(0.0F));
  scene.triangle_materials.assign(scene.triangles.size(), 0U);
  scene.materials.resize(1);
  return scene;
}

Scene with_all_computed(const Scene& scene, float crease_deg) {
  return with_computed_normals(scene, std::vector<std::uint8_t>(scene.positions.size(), 0), crease_deg);
}

// The unit cube: 8 shared vertices, outward.
Scene cube() {
  std::vector<Vec3> positions;
  for (int i = 0; i < 8; ++i) positions.emplace_back(i & 1, (i >> 1) & 1, i >> 2);
  return make_mesh(positions, {{0, 2, 3},
                               {0, 3, 1},
                               {4, 5, 7},
                               {4, 7, 6},
                               {0, 1, 5},
                               {0, 5, 4},
                               {2, 6, 7},
                               {2, 7, 3},
                               {0, 4, 6},
                               {0, 6, 2},
                               {1, 3, 7},
                               {1, 7, 5}});
}

// Two squares that meet in the edge x = 0 at the given angle between their normals.
Scene fold(float angle_deg) {
  const float angle = angle_deg * static_cast<float>(kPi) / 180.0F;
  const float x = std::cos(angle);
  const float y = -std::sin(angle);
  return make_mesh({{-1.0F, 0.0F, 0.0F},
                    {-1.0F, 0.0F, 1.0F},
                    {0.0F, 0.0F, 0.0F},
                    {0.0F, 0.0F, 1.0F},
                    {x, y, 0.0F},
                    {x, y, 1.0F}},
                   {{0, 1, 3}, {0, 3, 2}, {2, 3, 5}, {2, 5, 4}});
}

TEST(Normals, ACubeWithoutCreaseAngleIsFlat) {
  const Scene flat = with_all_computed(cube(), 0.0F);
  EXPECT_EQ(flat.positions.size(), 24U);
  for (std::size_t t = 0; t < flat.triangles.size(); ++t) {
    const Vec3 normal = geometric_normal(flat, static_cast<std::uint32_t>(t));
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t v = flat.triangles[t][k];
      expect_same_vector(flat.normals[v], normal);
      EXPECT_EQ(flat.positions[v], cube().positions[cube().triangles[t][k]]);
    }
  }
}

TEST(Normals, ACubeThatIsAllSmoothKeepsItsVertices) {
  const Scene smooth = with_all_computed(cube(), 180.0F);
  ASSERT_EQ(smooth.positions.size(), 8U);
  // Each of the three faces spans 90 degrees at a corner, in one triangle or in two: the sum is the diagonal.
  for (std::size_t v = 0; v < 8; ++v) {
    expect_same_vector(smooth.normals[v], glm::normalize(smooth.positions[v] - Vec3(0.5F)));
  }
}

TEST(Normals, AnEdgeSplitsExactlyBeyondTheCreaseAngle) {
  for (const float angle : {1.0F, 30.0F, 60.0F, 120.0F}) {
    EXPECT_EQ(with_all_computed(fold(angle), angle - 0.1F).positions.size(), 8U) << angle;
    EXPECT_EQ(with_all_computed(fold(angle), angle + 0.1F).positions.size(), 6U) << angle;
  }
}

TEST(Normals, CoplanarTrianglesShareNormalsAtCreaseZero) {
  EXPECT_EQ(with_all_computed(fold(0.0F), 0.0F).positions.size(), 6U);
  EXPECT_EQ(with_all_computed(fold(0.005F), 0.0F).positions.size(), 6U);
  EXPECT_EQ(with_all_computed(fold(0.02F), 0.0F).positions.size(), 8U);
}

TEST(Normals, TheFirstGroupKeepsTheIndexAndCopiesAreAppended) {
  Scene scene = fold(90.0F);
  scene.texcoords = {{0.0F, 0.0F}, {1.0F, 0.0F}, {2.0F, 0.0F}, {3.0F, 0.0F}, {4.0F, 0.0F}, {5.0F, 0.0F}};
  const Scene split = with_all_computed(scene, 0.0F);
  ASSERT_EQ(split.positions.size(), 8U);
  EXPECT_EQ(split.triangles[0], glm::uvec3(0, 1, 3));
  EXPECT_EQ(split.triangles[1], glm::uvec3(0, 3, 2));
  EXPECT_EQ(split.triangles[2], glm::uvec3(6, 7, 5));
  EXPECT_EQ(split.triangles[3], glm::uvec3(6, 5, 4));
  EXPECT_EQ(split.texcoords[6].x, 2.0F);
  EXPECT_EQ(split.texcoords[7].x, 3.0F);
  expect_same_vector(split.normals[2], {0.0F, 1.0F, 0.0F});
  expect_same_vector(split.normals[6], {1.0F, 0.0F, 0.0F});
}

TEST(Normals, AngleWeightsDoNotDependOnTheTriangulation) {
  // The same corner of a cube, its top face cut into one triangle at the corner or into two.
  const std::vector<Vec3> p = {
      {0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, {0.0F, 0.0F, 1.0F}, {1.0F, 1.0F, 0.0F}};
  const Scene one = make_mesh(p, {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}});
  const Scene two = make_mesh(p, {{0, 4, 1}, {0, 2, 4}, {0, 3, 2}, {0, 1, 3}});
  expect_same_vector(with_all_computed(one, 180.0F).normals[0], glm::normalize(Vec3(-1.0F)));
  expect_same_vector(with_all_computed(two, 180.0F).normals[0], glm::normalize(Vec3(-1.0F)));
}

TEST(Normals, SeamsOfEqualPositionsDoNotShow) {
  // The fold as loose triangles: twelve vertices, smooth across the edge all the same.
  const Scene shared = fold(30.0F);
  std::vector<Vec3> positions;
  std::vector<glm::uvec3> triangles;
  for (const glm::uvec3& t : shared.triangles) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    for (int k = 0; k < 3; ++k) positions.push_back(shared.positions[t[k]]);
    triangles.emplace_back(first, first + 1, first + 2);
  }
  const Scene smooth = with_all_computed(shared, 60.0F);
  const Scene loose = with_all_computed(make_mesh(positions, triangles), 60.0F);
  ASSERT_EQ(loose.positions.size(), 12U);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      expect_same_vector(loose.normals[loose.triangles[t][k]], smooth.normals[smooth.triangles[t][k]]);
    }
  }
}

TEST(Normals, GivenNormalsStayAndUnusedVerticesPointUp) {
  Scene scene = fold(30.0F);
  scene.positions.emplace_back(9.0F);
  scene.normals.emplace_back(0.0F);
  scene.normals[0] = Vec3(1.0F, 0.0F, 0.0F);
  const Scene result = with_computed_normals(scene, {1, 0, 0, 0, 0, 0, 0}, 60.0F);
  EXPECT_EQ(result.normals[0], Vec3(1.0F, 0.0F, 0.0F));
  EXPECT_EQ(result.normals[6], Vec3(0.0F, 1.0F, 0.0F));
  for (const Vec3& normal : result.normals) EXPECT_LE(std::abs(glm::length(normal) - 1.0F), 1e-6F);
}

TEST(Normals, CancellingTrianglesStillHaveANormal) {
  const Scene sheet =
      make_mesh({{0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}}, {{0, 1, 2}, {0, 2, 1}});
  const Scene smooth = with_all_computed(sheet, 180.0F);
  for (const Vec3& normal : smooth.normals) EXPECT_EQ(normal, Vec3(0.0F, 0.0F, 1.0F));
  EXPECT_EQ(with_all_computed(sheet, 0.0F).positions.size(), 6U);
}

TEST(Normals, ACreaseAngleOutsideItsRangeIsRefused) {
  for (const float angle : {-1.0F, 181.0F, std::numeric_limits<float>::quiet_NaN()}) {
    EXPECT_THROW((void)with_all_computed(cube(), angle), InputError) << angle;
  }
}

}  // namespace
}  // namespace plumbline::scene
