// validation/tests/light/support.hpp: what the tests of reference/light share.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "reference/light/environment_sampler.hpp"

namespace plumbline::light::testing {

inline constexpr unsigned kSeed = 20240607;

/// Floats in [0, 1) with 24 bits, as renderers have them.
class Numbers {
 public:
  explicit Numbers(unsigned seed = kSeed) : engine_(seed) {}
  [[nodiscard]] float next() { return static_cast<float>(engine_() >> 8U) * 0x1p-24F; }
  [[nodiscard]] Vec2 next_pair() {
    const float x = next();
    return {x, next()};
  }
  [[nodiscard]] Vec3 direction() {
    const double y = 1.0 - 2.0 * static_cast<double>(next());
    const double phi = 2.0 * kPi * static_cast<double>(next());
    const double across = std::sqrt(1.0 - y * y);
    return Vec3(Vec3d(across * std::cos(phi), y, across * std::sin(phi)));
  }

 private:
  std::mt19937 engine_;
};

/// The axes, the diagonals of faces and cube, and neighbours of the axes: where mappings break.
inline std::vector<Vec3> special_directions() {
  std::vector<Vec3> result;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -1; z <= 1; ++z) {
        if (x == 0 && y == 0 && z == 0) continue;
        const Vec3 direction(Vec3d(glm::normalize(Vec3d(x, y, z))));
        for (const float tiny : {0.0F, 1e-40F, 1e-20F, 1e-7F, 1e-4F}) {
          for (int axis = 0; axis < 3; ++axis) {
            for (const float sign : {-1.0F, 1.0F}) {
              Vec3 moved = direction;
              moved[axis] += sign * tiny;
              result.push_back(Vec3(glm::normalize(Vec3d(moved))));
            }
          }
        }
      }
    }
  }
  return result;
}

inline Environment lat_long_environment(image::Image image) {
  Environment result;
  result.name = "test";
  result.sky = LatLongSky{std::move(image)};
  return result;
}

inline Environment analytic_environment(std::function<Rgb(const Vec3&)> radiance) {
  Environment result;
  result.name = "test";
  result.sky = AnalyticSky{std::move(radiance)};
  return result;
}

inline Environment sun_environment(const SunDisc& sun, const Rgb& sky = Rgb(0.0F)) {
  Environment result;
  result.name = "test";
  result.sky = ConstantSky{sky};
  result.suns.push_back(sun);
  return result;
}

/// Exact solid angle of a texel of a width x height lat-long image.
inline double texel_solid_angle(int row, int width, int height) {
  return 2.0 * kPi / width * (std::cos(kPi * row / height) - std::cos(kPi * (row + 1) / height));
}

inline Vec3 texel_centre(int x, int y, int width, int height) {
  return direction_from_lat_long({(static_cast<float>(x) + 0.5F) / static_cast<float>(width),
                                  (static_cast<float>(y) + 0.5F) / static_cast<float>(height)});
}

}  // namespace plumbline::light::testing
