// prt/sh/zonal_fit.hpp: any function as a sum of few zonal lobes, which are cheap to turn.
#pragma once

#include <span>
#include <vector>

#include "reference/base/vector.hpp"

namespace plumbline::sh {

/// A zonal function z_l turned from +z to `axis` (unit).
struct ZonalLobe {
  Vec3d axis{0.0, 0.0, 1.0};
  std::vector<double> zonal;
};

/// The sum of lobes as SH coefficients: f_lm = sum of sqrt(4 pi/(2l + 1)) z_l y_lm(axis) (the thesis's eq. 3.57).
/// @throws InputError when the lobes differ in bands, or there is none
[[nodiscard]] std::vector<double> sum_of_lobes(std::span<const ZonalLobe> lobes);

/// The one lobe about `axis` (unit) that is closest to the function (least squares, the thesis's eq. 3.58):
/// z_l = sqrt(4 pi/(2l + 1)) sum over m of y_lm(axis) f_lm. @throws InputError when the number of coefficients is no
/// square
[[nodiscard]] ZonalLobe closest_lobe(const std::vector<double>& coefficients, const Vec3d& axis);

struct ZonalFit {
  std::vector<ZonalLobe> lobes;
  double relative_error = 0.0;  // L2 norm of what is left, over that of the function; 0 for the zero function
};
/// Fits `lobes` lobes. One after the other is put where it takes most of what the ones before leave (Sloan, Luna & Snyder
/// 2005, and the thesis); after each, all axes are refined together by Levenberg-Marquardt, with the zonal coefficients
/// solved for exactly at each step (Kaufman's variable projection). Starts are a fixed grid's few best axes, so that
/// the same input gives the same lobes. A local minimum: more lobes never fit worse, but the best fit is not promised.
/// @throws InputError for a number of coefficients that is no square, one that is not finite, or lobes < 1
[[nodiscard]] ZonalFit fit_zonal(const std::vector<double>& coefficients, int lobes);

}  // namespace plumbline::sh
