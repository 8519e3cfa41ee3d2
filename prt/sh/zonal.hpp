// prt/sh/zonal.hpp: functions that are symmetric about an axis, in closed form.
#pragma once

#include <vector>

#include "reference/base/vector.hpp"

namespace plumbline::sh {

/// Convolution factors of the clamped cosine max(0, cos): irradiance E_lm = A_l L_lm.
/// A = pi, 2 pi/3, pi/4, 0, -pi/24, 0, pi/64, ... (Ramamoorthi & Hanrahan 2001). The square root below is
/// already inside. @throws InputError when degree < 0
[[nodiscard]] double clamped_cosine_factor(int degree);

/// Zonal coefficients z_l (of y_l0, axis +z) of max(0, z) for l = 0 … bands-1: z_l = sqrt((2l + 1)/(4 pi))
/// A_l.
/// @throws InputError unless 1 <= bands <= kMaxBands
[[nodiscard]] std::vector<double> clamped_cosine(int bands);
/// Indicator of the cap of half angle a in (0, pi] (radians) about +z, radiance 1: z_0 = sqrt(pi) (1 - cos
/// a), z_l = sqrt(pi/(2l + 1)) (P_(l-1)(cos a) - P_(l+1)(cos a)), computed without cancellation: relative
/// error about 1e-15 l^2 for the smallest discs too. @throws InputError for other bands or angles
[[nodiscard]] std::vector<double> cap(int bands, double half_angle_rad);

/// Zonal coefficients of max(0, z)^exponent, radiance of a Phong lobe. exponent 1 is clamped_cosine(), 0 the hemisphere.
/// @throws InputError unless exponent is finite and >= 0
[[nodiscard]] std::vector<double> clamped_cosine_power(int bands, double exponent);
/// The weights with which a receiver averages over a sphere that it sees under half angle `half_angle_rad` in
/// (0, pi/2), as a function on that sphere about the direction from its centre to the receiver: the cosine of the angle
/// between the sphere's normal and the direction to the receiver, or 0 where the sphere turns away, divided by its
/// integral. For a small sphere it is clamped_cosine() / pi. (Source: the thesis "Soft shadows and diffuse reflections",
/// eq. 4.24, sin(atan(...) - alpha), which is (cos a - s) / sqrt(1 + s^2 - 2 s cos a) with s the sine of the half angle.)
/// @throws InputError for other bands or angles
[[nodiscard]] std::vector<double> form_factor_lobe(int bands, double half_angle_rad);

/// Legendre polynomials P_0 … P_(count-1) at x in [-1, 1]. @throws InputError when count < 0
[[nodiscard]] std::vector<double> legendre(int count, double x);

/// Turns zonal coefficients about +z to the axis `direction` (unit): f_lm = sqrt(4 pi/(2l + 1)) z_l
/// y_lm(direction).
[[nodiscard]] std::vector<double> rotate_zonal(const std::vector<double>& zonal, const Vec3d& direction);

}  // namespace plumbline::sh
