// reference/scene/camera.hpp: a pinhole camera.
#pragma once

#include <string>

#include "reference/base/vector.hpp"

namespace plumbline::scene {

/// Looks along `forward` from `eye`; image rows run along -up, columns along `right`; right = forward x up.
struct Camera {
  std::string name;
  Vec3 eye{0.0F, 0.0F, 1.0F};
  Vec3 forward{0.0F, 0.0F, -1.0F};  // unit
  Vec3 up{0.0F, 1.0F, 0.0F};        // unit, orthogonal to forward
  float vertical_fov_rad = 0.7F;    // full angle, in (0, pi)
};

/// @throws InputError when eye = target, the field of view is outside (0, 180) degrees, or up is parallel to
/// the view.
[[nodiscard]] Camera look_at(Vec3 eye, Vec3 target, Vec3 up, float vertical_fov_deg,
                             std::string name = "camera");

/// A width x height image with square pixels at unit distance before the eye; the vertical field of view spans the height.
struct ImagePlane {
  Vec3d corner{0.0};  // from the eye to the top left corner of the top left pixel
  Vec3d right{0.0};   // one pixel
  Vec3d down{0.0};    // one pixel
};
[[nodiscard]] ImagePlane image_plane(const Camera& camera, int width, int height);

/// Unit direction through the image point (x, y) in pixels.
[[nodiscard]] inline Vec3 ray_direction(const ImagePlane& plane, float x, float y) {
  return Vec3(glm::normalize(plane.corner + static_cast<double>(x) * plane.right +
                             static_cast<double>(y) * plane.down));
}

/// Unit direction through the image point (x, y) in pixels (0,0 = top left corner of the top left pixel) of a
/// width x height image with square pixels; the vertical field of view spans the height.
[[nodiscard]] Vec3 ray_direction(const Camera& camera, float x, float y, int width, int height);

}  // namespace plumbline::scene
