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

/// The two neighbours of a coordinate in [0, 1] along one axis of an image, for bilinear lookups: cells run from
/// texel centre to texel centre, cell c from texel c - 1 to texel c, so that there are count + 1 of them and the
/// first and the last are half cells. The value is (1 - fraction) first + fraction second.
struct Neighbours {
  int cell = 0;  // 0 … count
  int first = 0;
  int second = 0;
  float fraction = 0.0F;  // [0, 1]
};

/// Beyond the border is the texel at the border. A coordinate outside [0, 1] (and a NaN) stays in the image.
[[nodiscard]] inline Neighbours clamped_neighbours(float coordinate, int count) {
  const float end = static_cast<float>(count);
  const float scaled = coordinate > 0.0F ? std::min(coordinate * end, end) : 0.0F;
  const float shifted = scaled + 0.5F;  // > 0: truncation is floor
  const int cell = std::min(static_cast<int>(shifted), count);
  // Not from `shifted`, which has lost the low bits of small coordinates.
  const float fraction = std::clamp((scaled - static_cast<float>(cell)) + 0.5F, 0.0F, 1.0F);
  return {cell, std::max(cell - 1, 0), std::min(cell, count - 1), fraction};
}

/// Beyond the border is the other end: half cells 0 and count make up one cell, across the seam.
[[nodiscard]] inline Neighbours wrapped_neighbours(float coordinate, int count) {
  Neighbours result = clamped_neighbours(coordinate, count);
  if (result.cell == 0 || result.cell == count) {
    result.first = count - 1;
    result.second = 0;
  }
  return result;
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
