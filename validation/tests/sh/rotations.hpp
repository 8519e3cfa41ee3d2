// validation/tests/sh/rotations.hpp: rotations and coefficients to try things with.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "prt/sh/rotation.hpp"

namespace plumbline::sh_test {

/// Uniform numbers in [-1, 1), the same on every machine.
class Uniform {
 public:
  explicit Uniform(unsigned seed) : bits_(seed) {}
  double operator()() { return (static_cast<double>(bits_()) + 0.5) / 2147483648.0 - 1.0; }

 private:
  std::mt19937 bits_;
};

inline std::vector<double> random_vector(int bands, unsigned seed) {
  Uniform uniform(seed);
  std::vector<double> result;
  for (int i = 0; i < bands * bands; ++i) result.push_back(uniform());
  return result;
}

/// Uniform rotations: unit quaternions by rejection from the cube.
inline glm::dmat3 random_rotation(Uniform& uniform) {
  for (;;) {
    const glm::dquat q(uniform(), uniform(), uniform(), uniform());
    const double length = glm::length(q);
    if (length > 0.1 && length <= 1.0) return sh::rotation_from_quaternion(q).matrix();
  }
}

inline glm::dmat3 turn(const Vec3d& axis, double angle) {
  const Vec3d half = std::sin(0.5 * angle) * glm::normalize(axis);
  return sh::rotation_from_quaternion(glm::dquat(std::cos(0.5 * angle), half.x, half.y, half.z)).matrix();
}

inline double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return std::nan("");
  double result = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double error = std::abs(a[i] - b[i]);
    result = std::isnan(result) || result >= error ? result : error;
  }
  return result;
}

/// Rotations at which implementations fail: on and next to the axes and the singularities of Euler angles.
inline std::vector<glm::dmat3> hard_rotations() {
  const Vec3d x(1.0, 0.0, 0.0);
  const Vec3d y(0.0, 1.0, 0.0);
  const Vec3d z(0.0, 0.0, 1.0);
  std::vector<glm::dmat3> result{glm::dmat3(1.0)};
  for (const Vec3d& axis : {x, y, z, Vec3d(1.0, 1.0, 0.0), Vec3d(1.0, -2.0, 0.5)}) {
    for (const double angle : {kPi, kPi / 2.0, 1e-8, kPi - 1e-8, 1e-5, 1e-4, 1e-3}) {
      result.push_back(turn(axis, angle));
      result.push_back(turn(axis, angle) * turn(z, 0.7));
      result.push_back(turn(z, -2.1) * turn(axis, angle) * turn(z, 0.7));
    }
  }
  return result;
}

}  // namespace plumbline::sh_test
