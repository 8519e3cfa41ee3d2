// prt/sh/basis.hpp: real spherical harmonics (SH) for any number of bands.
// Conventions: CONVENTIONS.md#spherical-harmonics (orthonormal, Condon-Shortley sign kept, index l(l+1)+m,
// polar axis +z).
#pragma once

#include <span>
#include <vector>

#include "reference/base/vector.hpp"

namespace plumbline::sh {

/// Largest number of bands the library takes. n bands are degrees l = 0 … n-1 (Sloan's "order n").
inline constexpr int kMaxBands = 1000;

/// n bands hold n^2 coefficients.
[[nodiscard]] constexpr int coefficient_count(int bands) {
  return bands * bands;
}
/// Place of degree l, -l <= m <= l.
[[nodiscard]] constexpr int index(int l, int m) {
  return l * (l + 1) + m;
}

/// Throws InputError unless 1 <= bands <= kMaxBands.
void require_bands(int bands);

/// Evaluates all functions of `bands` bands at a direction. Make one and use it for many directions.
///
/// No trigonometry and no factorials: sin^m(theta) e^(i m phi) is (x + iy)^m, and the polynomials in z run over
/// 1 - |z| (recurrence.hpp), so that nothing loses its digits at the poles. Cost: about 8 flops a coefficient;
/// 10 bands or fewer are straight-line code. Above 5 bands float computes in double and rounds once, so that its
/// error is that of the rounded direction. batch.hpp does the same for many directions at a time.
///
/// Largest absolute error over uniform directions (ShBasis.* tests, against quadruple precision):
/// - double: 3e-15, 4e-14, 2e-13, 2e-13 at 6, 20, 64, 200 bands
/// - float: 7e-7, 2.5e-6, 1e-5, 3e-5 at 6, 10, 20, 64 bands
/// At 1e-1 … 1e-8 rad from a pole each +-m pair is right to 3e-14 of its own size (double, 20 bands; float 1e-6, 10
/// bands; double still 3e-14 at 200 bands from 1e-2 rad inwards), down to the smallest numbers that Real holds.
///
/// Finite for every unit direction up to kMaxBands. A direction longer or shorter than 1 by e costs degree l
/// a relative error of about l e.
template <class Real>
class Basis {
 public:
  /// @throws InputError unless 1 <= bands <= kMaxBands
  explicit Basis(int bands);

  [[nodiscard]] int bands() const { return bands_; }
  [[nodiscard]] int coefficient_count() const { return bands_ * bands_; }

  /// Writes coefficient_count() values, index l(l+1)+m; (x, y, z) must be unit length.
  /// @throws InputError when `values` is shorter than coefficient_count()
  void evaluate(Real x, Real y, Real z, std::span<Real> values) const;

 private:
  int bands_ = 0;
  std::vector<double> constants_;  // empty where closed forms serve
};

extern template class Basis<float>;
extern template class Basis<double>;

/// The general recurrence, without the straight-line code for few bands: its oracle in the tests.
[[nodiscard]] std::vector<double> evaluate_basis_by_recurrence(int bands, const Vec3d& direction);

/// One direction, in double: for tests and for places where speed does not matter.
[[nodiscard]] std::vector<double> evaluate_basis(int bands, const Vec3d& direction);

}  // namespace plumbline::sh
