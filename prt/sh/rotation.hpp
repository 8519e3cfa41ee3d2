// prt/sh/rotation.hpp: turning functions that are given as SH coefficients.
// The rotated function is f'(w) = f(R^-1 w): what f had in direction d, f' has in direction R d.
#pragma once

#include <glm/gtc/quaternion.hpp>
#include <span>
#include <vector>

#include "prt/sh/lighting.hpp"

namespace plumbline::sh {

/// A proper rotation of directions, orthonormal to rounding (1e-15).
class RotationMatrix {
 public:
  RotationMatrix() = default;  // the identity
  /// Matrices off by no more than kTolerance (a float matrix's rounding) become the nearest rotation.
  /// @throws InputError for anything else: a scale, a shear, a mirror, a non-finite element
  explicit RotationMatrix(const glm::dmat3& matrix);

  [[nodiscard]] const glm::dmat3& matrix() const { return matrix_; }

  /// Largest element of R^T R - 1 that is taken for rounding.
  static constexpr double kTolerance = 1e-4;

 private:
  glm::dmat3 matrix_{1.0};
};

/// Any length is taken, since it does not change what a quaternion turns: it is divided out.
/// @throws InputError for one that is zero or not finite
[[nodiscard]] RotationMatrix rotation_from_quaternion(const glm::dquat& quaternion);

/// Rz(alpha) Ry(beta) Rz(gamma), right-handed, in radians: gamma acts first.
struct EulerZyz {
  double alpha_rad = 0.0;
  double beta_rad = 0.0;
  double gamma_rad = 0.0;
};
/// @throws InputError for an angle that is not finite
[[nodiscard]] RotationMatrix rotation_from_euler(const EulerZyz& angles);
/// beta in [0, pi]. Where beta is 0 or pi, alpha is 0. Of full accuracy for every rotation: gamma is taken
/// from what alpha leaves, so that close to the z axis, where alpha and gamma are ill-defined, they still
/// belong together.
[[nodiscard]] EulerZyz euler_of(const RotationMatrix& rotation);

/// The matrices that turn SH coefficients, one (2l + 1) x (2l + 1) block a degree, in double.
///
/// Built by the recursion of Ivanic & Ruedenberg 1996, J. Phys. Chem. 100, 6342, with the corrections of 1998,
/// J. Phys. Chem. A 102, 9099. Cost: about 10 bands^3 to build, 4/3 bands^3 to apply.
/// Error against exact quadrature: below 1e-13 at 20 bands for every rotation, near the z axis too.
class Rotation {
 public:
  /// @throws InputError unless 1 <= bands <= kMaxBands
  Rotation(const RotationMatrix& rotation, int bands);
  /// @throws InputError also where the matrix is no rotation (see RotationMatrix)
  Rotation(const glm::dmat3& rotation, int bands);

  [[nodiscard]] int bands() const { return bands_; }
  /// Block of degree l, row-major: element (m' + l)(2l + 1) + m + l takes coefficient m to m'.
  /// @throws InputError unless 0 <= degree < bands()
  [[nodiscard]] std::span<const double> band(int degree) const;

  /// in -> out, coefficient_count(bands()) numbers each, which must not overlap. NaN and Inf spread through
  /// their own degree and no further. @throws InputError for other lengths
  void apply(std::span<const double> in, std::span<double> out) const;
  /// The inverse rotation: the transposed blocks.
  void apply_inverse(std::span<const double> in, std::span<double> out) const;
  /// float in and out, sums in double.
  void apply(std::span<const float> in, std::span<float> out) const;

 private:
  int bands_ = 0;
  std::vector<double> blocks_;  // degree l starts at l (2l - 1)(2l + 1) / 3
};

/// Number of bands that `count` coefficients belong to; `where` is named in the message.
/// @throws InputError unless count is 1, 4, 9, … kMaxBands^2
[[nodiscard]] int bands_of(std::size_t count, const char* where);

/// Coefficients of f(R^-1 w); as many bands as there are coefficients for.
/// @throws InputError when the matrix is no rotation, or the number of coefficients no square (1 … kMaxBands^2)
[[nodiscard]] std::vector<double> rotate(const std::vector<double>& coefficients, const glm::dmat3& rotation);
[[nodiscard]] ShRgb rotate(const ShRgb& function, const glm::dmat3& rotation);

}  // namespace plumbline::sh
