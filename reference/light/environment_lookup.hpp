// reference/light/environment_lookup.hpp: direction -> texel, shared by radiance() and EnvironmentSampler so
// that a direction, its radiance and its density always mean the same texel. Internal to reference/light.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "reference/light/environment.hpp"

namespace plumbline::light {

/// Rotation is environment to world; a vector on the left of a matrix is multiplied by its transpose.
[[nodiscard]] inline Vec3 to_environment_frame(const Environment& environment, const Vec3& world_direction) {
  return world_direction * environment.rotation;
}

/// Index of the texel that holds a coordinate in [0, 1]; 1 (and a NaN) stays inside the image.
[[nodiscard]] inline int texel_index(float coordinate, int count) {
  const float scaled = coordinate * static_cast<float>(count);
  return scaled > 0.0F ? std::min(static_cast<int>(scaled), count - 1) : 0;
}

struct Texel {
  int x = 0;
  int y = 0;
};

[[nodiscard]] inline Texel texel_at(const Vec2& uv, int width, int height) {
  return {texel_index(uv.x, width), texel_index(uv.y, height)};
}

/// The point (s, t), from the top left in [-1, 1], of a cube face at distance 1; faces +X -X +Y -Y +Z -Z.
[[nodiscard]] inline Vec3d cube_face_point(int face, double s, double t) {
  const std::array<Vec3d, 6> points{Vec3d(1.0, -t, -s), Vec3d(-1.0, -t, s), Vec3d(s, 1.0, t),
                                    Vec3d(s, -1.0, -t), Vec3d(s, -t, 1.0),  Vec3d(-s, -t, -1.0)};
  return points.at(static_cast<std::size_t>(face));
}

/// Is the direction (in the frame of the environment) inside the disc? Compares chords: the angle between two
/// nearly parallel float vectors is lost in their dot product (half a per cent of the sun's solid angle), but
/// not in the length of their difference.
[[nodiscard]] inline bool contains(const SunDisc& sun, const Vec3& local_direction) {
  if (sun.half_angle_rad >= kPi) return true;
  const Vec3d difference = Vec3d(local_direction) - Vec3d(sun.direction);
  const double squared_chord = glm::dot(difference, difference);
  if (squared_chord > sun.half_angle_rad * sun.half_angle_rad)
    return false;  // a chord is shorter than its arc
  const double longest_chord = 2.0 * std::sin(0.5 * sun.half_angle_rad);
  return squared_chord <= longest_chord * longest_chord;
}

/// 2 pi (1 - cos a), without the cancellation.
[[nodiscard]] inline double solid_angle(const SunDisc& sun) {
  const double half_chord = std::sin(0.5 * sun.half_angle_rad);
  return 4.0 * kPi * half_chord * half_chord;
}

}  // namespace plumbline::light
