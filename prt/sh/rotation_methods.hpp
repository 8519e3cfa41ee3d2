// prt/sh/rotation_methods.hpp: other ways to turn SH coefficients: the slow definition, the factorisation into turns
// about fixed axes, and an approximation for small angles. Rotation (rotation.hpp) and Rotator (rotator.hpp) are what
// to use; these are here to be held against them.
#pragma once

#include <vector>

#include "prt/sh/rotation.hpp"

namespace plumbline::sh {

/// The definition: f(R^-1 w) evaluated at the nodes of a rule that is exact for the degree, and projected again.
/// O(bands^4). Takes any orthogonal matrix, mirrors included.
/// @throws InputError when the number of coefficients is no square
[[nodiscard]] std::vector<double> rotate_by_projection(const std::vector<double>& coefficients,
                                                       const glm::dmat3& matrix);

/// Turn about +z: the pair y_lm, y_l,-m turns by m times the angle. O(bands^2).
[[nodiscard]] std::vector<double> rotate_z(const std::vector<double>& coefficients, double angle_rad);

/// Kautz, Sloan & Snyder 2002: R = Rz(alpha) Ry(beta) Rz(gamma) with Ry(beta) = Rx(-90) Rz(beta) Rx(90), so that
/// only the constant blocks of Rx(90) are needed besides turns about z. Make one and use it for many rotations.
class ZxzxzRotator {
 public:
  /// @throws InputError for bands out of range
  explicit ZxzxzRotator(int bands);
  /// O(bands^3). @throws InputError unless there are coefficient_count(bands) coefficients
  [[nodiscard]] std::vector<double> apply(const std::vector<double>& coefficients,
                                          const RotationMatrix& rotation) const;

 private:
  Rotation quarter_turn_;  // Rx(90)
};

/// (w x grad) f in the direction of `axis`: d/dt of the coefficients turned by t about it, at t = 0. In each degree
/// the generator is sparse and antisymmetric; along z it is exact differentiation in azimuth. O(bands^2).
[[nodiscard]] std::vector<double> rotation_derivative(const std::vector<double>& coefficients,
                                                      const Vec3d& axis);

/// Krivanek et al. 2006: Ry(beta) as its Taylor series to `terms` powers of beta (theirs is 2), through the
/// generator of turns about y. O(terms bands^2).
/// The relative error is below ((bands - 1) beta)^(terms + 1) / (terms + 1)!: with two terms 1 % is kept up to
/// beta = 0.39 / (bands - 1), 0.1 % up to 0.18 / (bands - 1). @throws InputError unless terms >= 1
[[nodiscard]] std::vector<double> rotate_y_by_taylor(const std::vector<double>& coefficients, double beta_rad,
                                                     int terms = 2);
/// The same with the exact turns about z around it.
[[nodiscard]] std::vector<double> rotate_by_taylor(const std::vector<double>& coefficients,
                                                   const RotationMatrix& rotation, int terms = 2);

}  // namespace plumbline::sh
