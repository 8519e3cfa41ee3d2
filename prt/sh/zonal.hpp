// prt/sh/zonal.hpp: functions that are symmetric about an axis, in closed form.
#pragma once

#include <vector>

namespace plumbline::sh {

/// Convolution factors A_l = integral of max(0, cos) against a zonal function: irradiance E_lm = A_l L_lm.
/// A = pi, 2 pi/3, pi/4, 0, -pi/24, 0, pi/64, ... (Ramamoorthi & Hanrahan 2001).
[[nodiscard]] double clamped_cosine_factor(int degree);

/// Zonal coefficients z_l (of y_l0, axis +z) for l = 0 … bands-1.
[[nodiscard]] std::vector<double> clamped_cosine(int bands);
/// Indicator of the cap of half angle a (radians) about +z, radiance 1.
[[nodiscard]] std::vector<double> cap(int bands, double half_angle_rad);

/// Legendre polynomials P_0 … P_(count-1) at x.
[[nodiscard]] std::vector<double> legendre(int count, double x);

}  // namespace plumbline::sh
