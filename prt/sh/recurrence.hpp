// prt/sh/recurrence.hpp: the constants of the recurrence that both the single-direction and the batch basis use.
#pragma once

#include <vector>

namespace plumbline::sh {

// Real spherical harmonics as columns of constant m:
//
//   y_lm = q_l^m(z) Re (-x - iy)^m,   y_l,-m = q_l^m(z) Im (-x - iy)^m,   m >= 0.
//
// The minus signs carry the Condon-Shortley phase, and q_l^m = sqrt(2) K_lm P_l^m(z) / (1 - z^2)^(m/2)
// (without the root of 2 at m = 0) is a polynomial of degree l - m, even or odd with it. K_lm^2 = (2l + 1)/(4 pi)
// (l - m)!/(l + m)!.
//
// The usual recurrence q_l = a z q_(l-1) - b q_(l-2) loses l^2/2 roundings near the poles: those of z, and its own,
// because there it subtracts two nearly equal numbers. So let c_l = q_l^m(z) / q_l^m(1), for z >= 0, and run over the
// differences d_l = c_l - c_(l-1) with t = 1 - z (Reinsch's device for Chebyshev series, here for Gegenbauer's
// polynomials C_(l-m)^(m+1/2), which the c_l are up to a factor). From (l - m) P_l = (2l - 1) z P_(l-1)
// - (l + m - 1) P_(l-2) and q_l^m(1)/q_(l-1)^m(1) = gamma_lm:
//
//   (l + m) d_l = (l - 1 - m) d_(l-1) - (2l - 1) t c_(l-1),   c_l = c_(l-1) + d_l,
//   gamma_lm^2 = (2l + 1)(l + m) / ((2l - 1)(l - m)),
//
// and, multiplied by q_l^m(1) so that D_l = q_l^m(1) d_l,
//
//   D_l = alpha D_(l-1) - beta t q_(l-1),  alpha = gamma (l - 1 - m)/(l + m),  beta = gamma (2l - 1)/(l + m),
//   q_l = gamma q_(l-1) + D_l,             q_m^m^2 = (2 - [m = 0]) / (4 pi) product_(k=1..m) (2k + 1)/(2k).
//
// t comes from (x^2 + y^2) / (1 + |z|), which keeps its digits where 1 - z has none; z < 0 changes the sign of every
// odd l - m. A +-m pair keeps its digits however close to a pole (relative 5e-15 at 200 bands).
//
// The largest value is q_l^m(1), about ((1 + sqrt 5)/2)^l at m = l / sqrt 5: 1e209 at l = 1000, while (x + iy)^m is
// as small as q is large. q carries the factor 1/recurrence_scale and (x + iy)^m the factor recurrence_scale: neither
// overflows or underflows where their product does not (double: to 1000 bands; float: to kFloatRecurrenceBands,
// but for the last digits of pairs below 1e-25).

/// A power of 2 (2^700 in double; 1 in float to 64 bands and 2^100 above).
template <class Real>
[[nodiscard]] constexpr Real recurrence_scale(int bands) {
  if constexpr (sizeof(Real) == sizeof(double)) return 0x1p700;
  return bands <= 64 ? 1.0F : 0x1p100F;
}

/// float takes the recurrence to this many bands: 1.618^256 / 2^100 is below its largest number.
inline constexpr int kFloatRecurrenceBands = 256;

/// q_m^m / recurrence_scale, for m = 0 … bands-1.
template <class Real>
[[nodiscard]] std::vector<Real> recurrence_starts(int bands);

template <class Real>
struct RecurrenceStep {
  Real alpha{};
  Real beta{};
  Real gamma{};
};
/// The step from q_(l-1)^m to q_l^m, 0 <= m < l.
template <class Real>
[[nodiscard]] RecurrenceStep<Real> recurrence_step(int l, int m);

}  // namespace plumbline::sh
