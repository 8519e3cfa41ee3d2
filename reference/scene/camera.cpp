#include "reference/scene/camera.hpp"

#include <fmt/format.h>

#include <utility>

#include "reference/base/error.hpp"

namespace plumbline::scene {

Camera look_at(Vec3 eye, Vec3 target, Vec3 up, float vertical_fov_deg, std::string name) {
  if (!is_finite(eye) || !is_finite(target) || !is_finite(up)) {
    throw InputError(fmt::format("camera {}: eye, target and up are not all finite", name));
  }
  if (!(vertical_fov_deg > 0.0F && vertical_fov_deg < 180.0F)) {
    throw InputError(fmt::format("camera {}: vertical field of view is {} degrees, expected 0 < angle < 180",
                                 name, vertical_fov_deg));
  }
  const Vec3d view = Vec3d(target) - Vec3d(eye);
  if (!(glm::length(view) > 0.0)) throw InputError(fmt::format("camera {}: eye and target coincide", name));
  const Vec3d forward = glm::normalize(view);
  const Vec3d right = glm::cross(forward, Vec3d(up));
  if (!(glm::length(right) > 1e-9 * glm::length(Vec3d(up)))) {
    throw InputError(fmt::format("camera {}: up is zero or parallel to the view", name));
  }
  const Vec3d true_up = glm::normalize(glm::cross(right, forward));
  const auto fov_rad = static_cast<float>(static_cast<double>(vertical_fov_deg) * kPi / 180.0);
  return {std::move(name), eye, Vec3(forward), Vec3(true_up), fov_rad};
}

ImagePlane image_plane(const Camera& camera, int width, int height) {
  const double half_height = std::tan(0.5 * static_cast<double>(camera.vertical_fov_rad));
  const double pixel = 2.0 * half_height / static_cast<double>(height);
  const Vec3d forward(camera.forward);
  const Vec3d up(camera.up);
  const Vec3d right = pixel * glm::cross(forward, up);
  const Vec3d down = -pixel * up;
  return {forward - 0.5 * width * right - 0.5 * height * down, right, down};
}

Vec3 ray_direction(const Camera& camera, float x, float y, int width, int height) {
  return ray_direction(image_plane(camera, width, height), x, y);
}

}  // namespace plumbline::scene
