#include "reference/scene/camera.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "reference/base/error.hpp"
#include "validation/tests/scene/scene_files.hpp"

namespace plumbline::scene {
namespace {

TEST(Camera, LookAtIsAnOrthonormalFrame) {
  const Camera camera = look_at({3.0F, 2.0F, 5.0F}, {0.0F, 1.0F, 0.0F}, {0.0F, 7.0F, 0.0F}, 40.0F);
  expect_same_vector(camera.forward, glm::normalize(Vec3(-3.0F, -1.0F, -5.0F)));
  EXPECT_LE(std::abs(glm::length(camera.up) - 1.0F), 5e-7F);
  EXPECT_LE(std::abs(glm::dot(camera.up, camera.forward)), 5e-7F);
  EXPECT_GT(camera.up.y, 0.0F);
  EXPECT_LE(std::abs(camera.vertical_fov_rad - 0.69813170F), 1e-7F);
}

TEST(Camera, RaysThroughCentreEdgesAndCorners) {
  // 90 degrees: the image plane at distance 1 reaches from -1 to 1 vertically and from -2 to 2 horizontally.
  const Camera camera = look_at(Vec3(0.0F), {0.0F, 0.0F, -1.0F}, {0.0F, 1.0F, 0.0F}, 90.0F);
  expect_same_vector(ray_direction(camera, 200.0F, 100.0F, 400, 200), {0.0F, 0.0F, -1.0F});
  expect_same_vector(ray_direction(camera, 200.0F, 0.0F, 400, 200), glm::normalize(Vec3(0.0F, 1.0F, -1.0F)));
  expect_same_vector(ray_direction(camera, 400.0F, 100.0F, 400, 200),
                     glm::normalize(Vec3(2.0F, 0.0F, -1.0F)));
  expect_same_vector(ray_direction(camera, 0.0F, 200.0F, 400, 200),
                     glm::normalize(Vec3(-2.0F, -1.0F, -1.0F)));
}

TEST(Camera, LookAtRefusesWhatHasNoView) {
  const Vec3 up(0.0F, 1.0F, 0.0F);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW((void)look_at(Vec3(1.0F), Vec3(1.0F), up, 40.0F), InputError);
  EXPECT_THROW((void)look_at(Vec3(0.0F), up, up, 40.0F), InputError);
  EXPECT_THROW((void)look_at(Vec3(0.0F), Vec3(1.0F), Vec3(0.0F), 40.0F), InputError);
  EXPECT_THROW((void)look_at(Vec3(0.0F), Vec3(1.0F), up, 0.0F), InputError);
  EXPECT_THROW((void)look_at(Vec3(0.0F), Vec3(1.0F), up, 180.0F), InputError);
  EXPECT_THROW((void)look_at(Vec3(0.0F), Vec3(1.0F), up, nan), InputError);
  EXPECT_THROW((void)look_at(Vec3(nan), Vec3(1.0F), up, 40.0F), InputError);
}

}  // namespace
}  // namespace plumbline::scene
