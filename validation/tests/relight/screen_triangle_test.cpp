#include "prt/relight/screen_triangle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../integrate/pieces.hpp"
#include "reference/trace/ray_caster.hpp"

namespace plumbline::relight {
namespace {

// Barycentric coordinates where the sample's line meets the triangle's plane, in long double, by Cramer's rule.
Vec3d true_weights(const scene::Scene& scene, const SampleGrid& grid, int column, int row) {
  using Long = glm::tvec3<long double>;
  const Long d = Long(grid.plane.corner) + (0.5L + column) * Long(grid.plane.right) +
                 (0.5L + row) * Long(grid.plane.down);
  const glm::uvec3 corners = scene.triangles[0];
  const Long a(scene.positions[corners.x]);
  const Long u = Long(scene.positions[corners.y]) - a;
  const Long v = Long(scene.positions[corners.z]) - a;
  const Long from = Long(grid.eye) - a;
  const long double determinant = glm::dot(u, glm::cross(v, d));
  const long double b1 = glm::dot(from, glm::cross(v, d)) / determinant;
  const long double b2 = glm::dot(u, glm::cross(from, d)) / determinant;
  return {static_cast<double>(1.0L - b1 - b2), static_cast<double>(b1), static_cast<double>(b2)};
}

/// Largest error of weights_at() over the samples near a triangle of `size` at distance 10; and of Embree's coordinates.
struct Errors {
  double ours = 0.0;
  double of_the_hit = 0.0;
};
Errors errors_of(float size) {
  scene::Scene scene;
  test::add_triangle(scene, {0.31F, 0.2F, 0.0F}, {0.31F + size, 0.2F + 0.1F * size, 0.0F},
                     {0.31F + 0.3F * size, 0.2F + size, 0.3F * size}, test::add_material(scene, Rgb(1.0F)));
  const scene::Camera camera = scene::look_at({0.5F, 1.0F, 10.0F}, {0, 0, 0}, {0, 1, 0}, 20.0F);
  const SampleGrid grid = sample_grid(camera, 4000, 4000, 1);
  const ScreenTriangle triangle = screen_triangle(scene, 0, grid);
  EXPECT_TRUE(triangle.is_front);
  const trace::RayCaster caster(scene);
  Errors worst;
  int hits = 0;
  const int reach = std::max(2, static_cast<int>(0.7F * size * 1150.0F));
  for (int y = -reach; y <= reach; y += std::max(1, reach / 20)) {
    for (int x = -reach; x <= reach; x += std::max(1, reach / 20)) {
      const int column = static_cast<int>(triangle.x) + x;
      const int row = static_cast<int>(triangle.y) + y;
      const auto hit = caster.closest_hit({Vec3(grid.eye), sample_direction(grid, column, row)});
      if (!hit) continue;
      ++hits;
      const Vec3d truth = true_weights(scene, grid, column, row);
      const Vec3d ours(weights_at(triangle, column, row));
      worst.ours = std::max(worst.ours, glm::length(ours - truth));
      worst.of_the_hit = std::max(worst.of_the_hit,
                                  glm::length(glm::dvec2(hit->barycentrics) - glm::dvec2(truth.y, truth.z)));
    }
  }
  EXPECT_GE(hits, 3);
  return worst;
}

// Three terms that are at most of the size of the weights near the triangle, each rounded a few times.
TEST(ScreenTriangle, WeightsAreGoodToRoundingAtAnySize) {
  for (const float size : {2.0F, 0.1F, 0.01F}) {
    const Errors errors = errors_of(size);
    EXPECT_LE(errors.ours, 16.0 * std::numeric_limits<float>::epsilon()) << size;
  }
  // Those of the ray query carry the rounding of the distance, 1000 times the triangle here.
  EXPECT_GT(errors_of(0.01F).of_the_hit, 16.0 * std::numeric_limits<float>::epsilon());
}

TEST(ScreenTriangle, TellsFrontBackAndEdgeOn) {
  const scene::Camera camera = scene::look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 40.0F);
  const SampleGrid grid = sample_grid(camera, 100, 100, 1);
  scene::Scene scene;
  const std::uint32_t material = test::add_material(scene, Rgb(1.0F));
  test::add_triangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, material);
  test::add_triangle(scene, {0, 0, 0}, {0, 1, 0}, {1, 0, 0}, material);
  test::add_triangle(scene, {0, 0, 0}, {0, 1, 0}, {0, 0, 1}, material);
  test::add_triangle(scene, {0, 0, 9}, {1, 0, 9}, {0, 1, 9},
                     material);  // behind the eye, its back towards it
  EXPECT_TRUE(screen_triangle(scene, 0, grid).is_front);
  EXPECT_FALSE(screen_triangle(scene, 1, grid).is_front);
  const ScreenTriangle edge = screen_triangle(scene, 2, grid);
  EXPECT_FALSE(edge.is_front);
  EXPECT_EQ(edge.a, Vec3(0.0F));
  EXPECT_TRUE(std::isnan(weights_at(edge, 50, 50).x));
  EXPECT_FALSE(screen_triangle(scene, 3, grid).is_front);
}

}  // namespace
}  // namespace plumbline::relight
