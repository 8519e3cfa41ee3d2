// validation/truth/distant.hpp: moments of distant light, and what a camera sees, in closed form. Arguments outside
// the stated range throw InputError. Held against quadratures in validation/tests/truth/distant_test.cpp.
#pragma once

#include <span>

#include "reference/base/vector.hpp"

namespace plumbline::truth {

/// The vector irradiance D = int L w dw over the whole sphere decides the difference of two opposite receivers,
/// under any distant light: E(n) - E(-n) = D . n (max(0, c) - max(0, -c) = c: only the odd band 1 is left). The
/// mean of E(n) over all n is int L dw / 4.

/// D of a disc of half-angle a in [0, pi] about `axis` (unit): pi L sin^2 a axis. a = 30 deg, L = 1: (pi/4) axis.
[[nodiscard]] Vec3d disc_vector_irradiance(const Vec3d& axis, double half_angle, double radiance);

/// D and int L dw of a latitude-longitude image (CONVENTIONS.md#environments) of constant texels, rows from the top:
///   texel of theta in (t0, t1), azimuth in (p0, p1) from +X to +Z:
///   int w dw = ((t1 - t0)/2 - (sin 2 t1 - sin 2 t0)/4) (sin p1 - sin p0, ., cos p0 - cos p1)
///   with y: (p1 - p0) (sin^2 t1 - sin^2 t0)/2.
struct DistantMoments {
  double flux = 0.0;  // int L dw
  Vec3d vector{0.0};  // int L w dw
};
/// @param texels  width x height radiances
[[nodiscard]] DistantMoments lat_long_moments(std::span<const double> texels, int width, int height);

/// Share of a square image of field of view f in (0, pi) that a sphere of radius R covers, its centre on the
/// optical axis at distance D > R and its outline inside the image: pi R^2/(D^2 - R^2)/(4 tan^2(f/2)).
/// R = 1, D = 3, f = 60 deg: 0.294524311274.
[[nodiscard]] double sphere_silhouette_share(double radius, double distance, double fov);

/// Moments of directions with density cos/pi about the normal, x and z in the tangent plane and c along the normal:
/// E[c] = 2/3, E[c^2] = 1/2, E[x^2] = 1/4; of uniform directions: E|c| = 1/2, E[c^2] = 1/3, E[x^2 y^2] = 1/15.
inline constexpr double kCosineMeanCosine = 2.0 / 3.0;
inline constexpr double kCosineMeanSquaredCosine = 1.0 / 2.0;
inline constexpr double kCosineMeanSquaredTangent = 1.0 / 4.0;
inline constexpr double kUniformMeanCosine = 1.0 / 2.0;
inline constexpr double kUniformMeanSquaredCosine = 1.0 / 3.0;
inline constexpr double kUniformMeanProduct = 1.0 / 15.0;

}  // namespace plumbline::truth
