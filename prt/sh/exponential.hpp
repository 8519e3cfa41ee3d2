// prt/sh/exponential.hpp: exponential of a function held in spherical harmonics, as soft shadows need it.
// Conventions: CONVENTIONS.md#spherical-harmonics. Vectors of n^2 coefficients, as in product.hpp.
// [1] Ren et al., "Real-time soft shadows in dynamic scenes using spherical harmonic exponentiation", 2006.
// [2] the thesis "soft shadows and diffuse reflections", section 3.1.4 (its equation numbers below).
//     Errata: the asterisks of eq. 3.29 are inner products, not SH products; section 3.5 defines g as 1 where
//     the sphere blocks, eq. 3.62 needs 0 there (as section 3.1.4 and eq. 4.3 have it).
//
// f = (f_0 / sqrt(4 pi)) 1 + f^, where 1 = (sqrt(4 pi), 0, …) and f^ lacks the constant part. All functions
// throw InputError for a size that is no square, for a non-finite coefficient and where the result would
// leave double's range. None clamps anything.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "prt/sh/product.hpp"

namespace plumbline::sh {

/// |f^|: norm of all coefficients but the first.
[[nodiscard]] double magnitude_without_mean(const std::vector<double>& f);

/// sum_(k = 0 … degree) of f * … * f / k! (k factors, SH products): eq. 3.25. degree >= 0.
[[nodiscard]] std::vector<double> exponential_series(const std::vector<double>& f, int degree);

/// exp(f_0 / sqrt(4 pi)) times the series of f^: eq. 3.27.
[[nodiscard]] std::vector<double> exponential_isolated(const std::vector<double>& f, int degree);

/// What the series tends to: exp(M_f) 1 with the product matrix M_f, by its eigenvectors. For comparisons:
/// costs bands^6.
[[nodiscard]] std::vector<double> exponential_of_matrix(const std::vector<double>& f);

/// a and b of the optimal linear approximation exp(f^) ~ a 1 + b f^ by |f^| (eq. 3.30), at |f^| = i step.
struct LinearTable {
  double step = 0.0;
  std::vector<double> a;
  std::vector<double> b;
};
/// Largest |f^| in the tables.
inline constexpr double kLargestTabled = 8.0;
/// Fitted here, when first asked for (milliseconds), the same on every run. The inner products of eq. 3.29
/// averaged over the log visibilities of spheres of angular radius 1, 3 … 89 degrees, each scaled to |f^|; exp
/// itself by quadrature. @throws InputError unless 1 <= bands <= kMaxProductBands
[[nodiscard]] const LinearTable& linear_table(int bands);

/// exp(f_0 / sqrt(4 pi)) (a 1 + b f^): eq. 3.30, bands^2 operations.
/// @throws InputError too when |f^| > kLargestTabled
[[nodiscard]] std::vector<double> exponential_linear(const std::vector<double>& f);

/// |f^| / 2^p that the next two functions scale to before they square p times, with the smallest such p.
inline constexpr double kScaledMagnitude = 1.0;
/// Largest |f^| they take: 30 squarings.
inline constexpr double kLargestMagnitude = kScaledMagnitude * 1073741824.0;

/// The hybrid method: exponential_linear(f / 2^p), squared p times (eq. 3.32). Stays finite for every f that is
/// nowhere far above 0. @throws InputError too when |f^| > kLargestMagnitude
[[nodiscard]] std::vector<double> exponential_hybrid(const std::vector<double>& f);
[[nodiscard]] std::vector<float> exponential_hybrid(const std::vector<float>& f);

/// The method to use for accumulated blockers at 3 bands and more; at 2 the hybrid errs less (the `exponential` checks of `plumbline validate` measure why):
/// exponential_isolated(f / 2^p, 2), squared p times. One more product than the hybrid method and no table.
/// @throws InputError too when |f^| > kLargestMagnitude
[[nodiscard]] std::vector<double> exponential(const std::vector<double>& f);

/// Both for many float vectors at once, in the layout of multiply_blocks(), for 2 … 6 bands. They do not throw
/// for what a vector holds: an input that is not finite or beyond kLargestMagnitude gives a vector of NaN, a
/// result beyond float's range has infinities or NaN.
/// @return how many vectors hold something not finite
/// @throws InputError for sizes as multiply_blocks() does, and unless 2 <= bands <= 6
[[nodiscard]] std::size_t exponential_hybrid_blocks(int bands, std::span<const float> f,
                                                    std::span<float> out);
[[nodiscard]] std::size_t exponential_blocks(int bands, std::span<const float> f, std::span<float> out);

/// A function of the reconstructed function, evaluated point by point and projected again.
struct Reprojected {
  std::vector<double> coefficients;
  double uncertainty = 0.0;  // largest difference to half as many points in z and azimuth
};
/// The oracle: projection of exp(f(direction)) by quadrature with as many points as it takes (512 bands at
/// most; `uncertainty` tells).
[[nodiscard]] Reprojected exponential_by_quadrature(const std::vector<double>& f);

}  // namespace plumbline::sh
