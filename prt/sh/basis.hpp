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
template <class Real>
class Basis {
 public:
  explicit Basis(int bands);

  [[nodiscard]] int bands() const { return bands_; }
  [[nodiscard]] int coefficient_count() const { return bands_ * bands_; }

  /// Writes coefficient_count() values; (x, y, z) must be unit length.
  void evaluate(Real x, Real y, Real z, std::span<Real> values) const;

 private:
  int bands_ = 0;
  std::vector<Real> constants_;
};

extern template class Basis<float>;
extern template class Basis<double>;

/// One direction, in double: for tests and for places where speed does not matter.
[[nodiscard]] std::vector<double> evaluate_basis(int bands, const Vec3d& direction);

}  // namespace plumbline::sh
