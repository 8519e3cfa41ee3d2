#include "reference/scene/polygon.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "reference/base/error.hpp"

namespace plumbline::scene {
namespace {

// Signed area along +z of the triangles, and whether every one of them faces +z.
struct Cover {
  double area = 0.0;
  bool is_one_sided = true;
};

Cover cover(const std::vector<Vec3>& corners) {
  Cover result;
  for (const glm::uvec3& t : triangulate(corners)) {
    const Vec3d a(corners[t.x]);
    const double area = 0.5 * glm::cross(Vec3d(corners[t.y]) - a, Vec3d(corners[t.z]) - a).z;
    result.area += area;
    result.is_one_sided = result.is_one_sided && area > 0.0;
  }
  return result;
}

TEST(Polygon, ConvexOnesBecomeFans) {
  const std::vector<Vec3> square = {
      {0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {1.0F, 1.0F, 0.0F}, {0.0F, 1.0F, 0.0F}};
  const auto triangles = triangulate(square);
  ASSERT_EQ(triangles.size(), 2U);
  EXPECT_EQ(triangles[0], glm::uvec3(0, 1, 2));
  EXPECT_EQ(triangles[1], glm::uvec3(0, 2, 3));
}

TEST(Polygon, ConcaveOnesAreCoveredWithoutOverlap) {
  // An L of three unit squares, from every first corner.
  std::vector<Vec3> corners = {{0.0F, 0.0F, 0.0F}, {2.0F, 0.0F, 0.0F}, {2.0F, 1.0F, 0.0F},
                               {1.0F, 1.0F, 0.0F}, {1.0F, 2.0F, 0.0F}, {0.0F, 2.0F, 0.0F}};
  for (std::size_t turn = 0; turn < corners.size(); ++turn) {
    const Cover covered = cover(corners);
    EXPECT_EQ(covered.area, 3.0) << "turn " << turn;
    EXPECT_TRUE(covered.is_one_sided) << "turn " << turn;
    std::rotate(corners.begin(), corners.begin() + 1, corners.end());
  }
}

TEST(Polygon, AStarIsCovered) {
  std::vector<Vec3> corners;
  for (int i = 0; i < 10; ++i) {
    const float angle = 0.2F * static_cast<float>(kPi) * static_cast<float>(i);
    corners.emplace_back((i % 2 == 0 ? 1.0F : 0.4F) * Vec3(std::cos(angle), std::sin(angle), 0.0F));
  }
  // ten triangles around the centre, each r R sin(36 deg) / 2
  const double exact = 10.0 * 0.5 * 0.4 * std::sin(kPi / 5.0);
  EXPECT_LE(std::abs(cover(corners).area - exact), 1e-6);
  EXPECT_TRUE(cover(corners).is_one_sided);
}

TEST(Polygon, DegenerateAndCrossingOnesEnd) {
  EXPECT_TRUE(triangulate(std::vector<Vec3>(2)).empty());
  EXPECT_EQ(triangulate(std::vector<Vec3>(5)).size(), 3U);  // all corners at one place
  const std::vector<Vec3> bow = {
      {0.0F, 0.0F, 0.0F}, {1.0F, 1.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {0.0F, 2.0F, 0.0F}};
  EXPECT_EQ(triangulate(bow).size(), 2U);
}

TEST(Polygon, AHugeConcaveOneIsRefused) {
  std::vector<Vec3> comb;
  for (int i = 0; i < 2000; ++i) {
    comb.emplace_back(static_cast<float>(i), i % 2 == 0 ? 0.0F : 5.0F, 0.0F);
  }
  comb.emplace_back(2000.0F, -9.0F, 0.0F);
  EXPECT_THROW((void)triangulate(comb), InputError);
}

}  // namespace
}  // namespace plumbline::scene
