// prt/relight/screen_triangle.hpp: barycentric coordinates as functions of the place in the image.
#pragma once

#include <cstdint>

#include "reference/base/vector.hpp"
#include "reference/scene/camera.hpp"
#include "reference/scene/scene.hpp"

namespace plumbline::relight {

/// An image's samples: grid x grid a pixel, at the centres of equal cells. Sample (X, Y), X in [0, columns), lies in pixel
/// (X / grid, Y / grid).
struct SampleGrid {
  Vec3d eye{0.0};
  scene::ImagePlane plane;  // right and down: one sample
  int columns = 0;
  int rows = 0;
};
[[nodiscard]] SampleGrid sample_grid(const scene::Camera& camera, int width, int height, int grid);
/// Unit direction of a sample's ray.
[[nodiscard]] inline Vec3 sample_direction(const SampleGrid& grid, int column, int row) {
  return scene::ray_direction(grid.plane, static_cast<float>(column) + 0.5F, static_cast<float>(row) + 0.5F);
}

/// Of a triangle and a view: weight[k] = a + b (X - x) + c (Y - y) is the barycentric coordinate of corner k over the depth of
/// the point that sample (X, Y) sees. In float, and accurate to a few units in the last place wherever the triangle is
/// small or large in the image: (x, y) is its middle.
struct ScreenTriangle {
  Vec3 a{0.0F};  // one component a corner; all 0 when the eye lies in the triangle's plane
  Vec3 b{0.0F};
  Vec3 c{0.0F};
  float x = 0.0F;  // whole numbers
  float y = 0.0F;
  bool is_front = false;  // the eye is before the triangle
};
[[nodiscard]] ScreenTriangle screen_triangle(const scene::Scene& scene, std::uint32_t triangle,
                                             const SampleGrid& grid);

/// Barycentric coordinates of all three corners at a sample of the triangle's plane, as rounded by these operations in this
/// order: the OpenGL shader has the same. NaN for a triangle seen edge-on.
[[nodiscard]] inline Vec3 weights_at(const ScreenTriangle& triangle, int column, int row) {
  const float dx = static_cast<float>(column) - triangle.x;
  const float dy = static_cast<float>(row) - triangle.y;
  const Vec3 over_depth = triangle.a + triangle.b * dx + triangle.c * dy;
  const float depth = 1.0F / (over_depth.x + over_depth.y + over_depth.z);
  return over_depth * depth;
}

}  // namespace plumbline::relight
