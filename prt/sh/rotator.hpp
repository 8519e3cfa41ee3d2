// prt/sh/rotator.hpp: turning SH coefficients fast, without building matrices.
#pragma once

#include <span>
#include <vector>

#include "prt/sh/rotation.hpp"

namespace plumbline::sh {

/// Turns one function at a time by any rotation: f'(w) = f(R^-1 w). Make one and use it for many rotations.
///
/// - float, 2 to 8 bands: the turned function is evaluated in 2 bands - 1 fixed directions (a polynomial of R's
///   elements: no angles, so no rotation is special), and a constant matrix a degree takes the values to
///   coefficients.
/// - otherwise: R = Rz(alpha) P Rz(beta) P Rz(gamma), where P exchanges y and z. P's blocks fall apart into four
///   of half the size; the angles' cosines and sines are algebraic in R, their multiples a recurrence.
///
/// Largest error of a coefficient for coefficients in [-1, 1] and every rotation (ShRotator.* tests):
/// float 5e-7, 1e-6, 2.5e-6 at 3, 6, 20 bands; double 1e-13 at 20 bands.
/// NaN and Inf spread through their own degree and no further. float sums are in float: numbers above 1e36
/// may overflow to Inf.
/// Vector width is chosen at run time, and with it the last bits of float results.
template <class Real>
class Rotator {
 public:
  /// O(bands^3) time and memory. @throws InputError unless 1 <= bands <= kMaxBands
  explicit Rotator(int bands);

  [[nodiscard]] int bands() const { return bands_; }

  /// in -> out, coefficient_count(bands()) numbers each; they may be the same place.
  /// @throws InputError for other lengths
  void apply(const RotationMatrix& rotation, std::span<const Real> in, std::span<Real> out) const;
  /// @throws InputError also where the matrix is no rotation (see RotationMatrix)
  void apply(const glm::dmat3& rotation, std::span<const Real> in, std::span<Real> out) const;

 private:
  int bands_ = 0;
  std::vector<Real> tables_;
};

extern template class Rotator<float>;
extern template class Rotator<double>;

/// One rotation applied to `count` functions. Structure of arrays: coefficient i of function v is at
/// i * count + v, in `in` and in `out`, which must not overlap. Error as Rotator<float>'s, from the double
/// matrices rounded once.
/// @throws InputError unless both hold coefficient_count(rotation.bands()) * count numbers
void apply_to_many(const Rotation& rotation, std::size_t count, std::span<const float> in,
                   std::span<float> out);

}  // namespace plumbline::sh
