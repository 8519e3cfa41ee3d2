#include "prt/relight/screen_triangle.hpp"

#include <algorithm>
#include <cmath>

namespace plumbline::relight {

SampleGrid sample_grid(const scene::Camera& camera, int width, int height, int grid) {
  scene::ImagePlane plane = scene::image_plane(camera, width, height);
  plane.right /= grid;
  plane.down /= grid;
  return {Vec3d(camera.eye), plane, width * grid, height * grid};
}

// With corners p_k seen from the eye, and d the sample's direction of depth 1, the point t d of the triangle's plane is
// sum_k beta_k p_k. Multiplied by n_0 = p_1 x p_2 (and so on in turn) only one term is left: t (n_0 . d) = beta_0 D, where
// D = p_0 . n_0 is the same for all three. So beta_k / t = n_k . d / D, which is linear in the sample's place, and the sum
// over k is 1 / t. In double, for the cross products cancel as the square of distance over size. What is left to evaluate in
// float is a sum of three terms of the size of the result, for the place is counted from the triangle's own middle.
ScreenTriangle screen_triangle(const scene::Scene& scene, std::uint32_t triangle, const SampleGrid& grid) {
  const glm::uvec3 corners = scene.triangles[triangle];
  Vec3d p[3];
  for (int k = 0; k < 3; ++k) p[k] = Vec3d(scene.positions[corners[k]]) - grid.eye;
  const Vec3d right = glm::normalize(grid.plane.right);
  const Vec3d down = glm::normalize(grid.plane.down);
  const Vec3d forward = glm::cross(right, down);
  const Vec3d middle = (p[0] + p[1] + p[2]) / 3.0;
  const double middle_depth = glm::dot(middle, forward);
  const Vec3d first = grid.plane.corner + 0.5 * grid.plane.right + 0.5 * grid.plane.down;
  ScreenTriangle result;
  if (middle_depth > 0.0) {
    const Vec3d place = middle / middle_depth - first;
    const auto whole = [](double value, int count) {
      return static_cast<float>(std::round(std::clamp(value, 0.0, count - 1.0)));
    };
    result.x = whole(glm::dot(place, right) / glm::length(grid.plane.right), grid.columns);
    result.y = whole(glm::dot(place, down) / glm::length(grid.plane.down), grid.rows);
  }
  const Vec3d direction = first + static_cast<double>(result.x) * grid.plane.right +
                          static_cast<double>(result.y) * grid.plane.down;
  const double determinant = glm::dot(p[0], glm::cross(p[1] - p[0], p[2] - p[0]));
  if (determinant == 0.0) return result;
  for (int k = 0; k < 3; ++k) {
    const Vec3d n = glm::cross(p[(k + 1) % 3], p[(k + 2) % 3]) / determinant;
    result.a[k] = static_cast<float>(glm::dot(n, direction));
    result.b[k] = static_cast<float>(glm::dot(n, grid.plane.right));
    result.c[k] = static_cast<float>(glm::dot(n, grid.plane.down));
  }
  result.is_front = determinant < 0.0;  // its normal points against the corners' direction
  return result;
}

}  // namespace plumbline::relight
