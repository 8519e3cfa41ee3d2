// validation/truth/multibounce.hpp: interreflection in closed form.
// All surfaces are Lambertian; irradiance E and radiosity B (flux leaving per area) [W m^-2], radiance L [W
// m^-2 sr^-1], B = pi L = M + rho E with emitted radiosity M. Albedos lie in [0, 1]; arguments outside the
// stated range throw InputError. `bounces` counts indirect bounces as `--bounces` does: 0 = direct light
// only, std::nullopt = all. The closed forms are Neumann series that happen to be geometric: where every
// point sees the reflecting surface with the same form factor F, bounce k carries e (rho F)^k of the direct
// irradiance e. [1] Siegel & Howell, Thermal Radiation Heat Transfer (enclosures of diffuse gray surfaces,
// form factors of wedges and of spheres). The rest is derived in multibounce.cpp and held against quadratures
// and iterated integral equations in validation/tests/truth/multibounce_test.cpp.
#pragma once

#include <array>
#include <optional>

#include "reference/base/vector.hpp"

namespace plumbline::truth {

using Bounces = std::optional<int>;
inline constexpr Bounces kAllBounces = std::nullopt;

// ---------------------------------------------------------------- the series
/// What bounce k (0 = direct) adds to the irradiance: e (rho F)^k. e = pi/2, rho = .8, F = 1/2, k = 2:
/// 0.251327412287.
[[nodiscard]] double neumann_term(double direct, double albedo, double form_factor, int bounce);
/// Bounces 0..N together. rho F < 1 unless N is given.
[[nodiscard]] double neumann_sum(double direct, double albedo, double form_factor, Bounces bounces);
/// What is missing after bounces 0..N: e (rho F)^(N+1)/(1 - rho F).
[[nodiscard]] double neumann_remainder(double direct, double albedo, double form_factor, int bounces);

// ---------------------------------------------------------------- furnaces
/// Exit radiance everywhere in a closed enclosure of any shape, emission (radiance) and albedo < 1 the same
/// everywhere: L_e/(1 - rho) for all bounces, L_e (1 - rho^(N+2))/(1 - rho) for N (emission seen directly,
/// direct light and N bounces). L_e = 1, rho = .8: 5; N = 7: 4.32891136.
[[nodiscard]] double enclosure_radiance(double emission, double albedo, Bounces bounces = kAllBounces);

/// T_00 of exit radiance in a white furnace, any open scene of albedo 1 under a uniform sky: T_00 sqrt(4 pi)
/// = 1. 1/sqrt(4 pi) = 0.282094791774.
[[nodiscard]] double white_furnace_transfer();

// ---------------------------------------------------------------- inside a sphere
/// Any light that delivers `flux` to the wall of a closed sphere of radius R: the indirect irradiance is the
/// same everywhere, E_ind = Phi/(4 pi R^2) (rho + rho^2 + ... rho^N). Phi = 4 pi, R = 1, rho = .5: 1.
[[nodiscard]] double sphere_indirect_irradiance(double flux, double radius, double albedo,
                                                Bounces bounces = kAllBounces);

/// Exit radiance of the wall, isotropic point light of intensity I at distance s < R from the centre, wall
/// point at angle t from the light's side of that axis (c = cos t):
///   L = rho/pi (E_direct + E_ind),  E_direct = I (R - s c)/(R^2 + s^2 - 2 R s c)^(3/2),  Phi = 4 pi I.
/// I = pi, s = 0, R = 1, rho = .5: 1. I = 1, s = .5, R = 1, rho = .5: c = 1: 0.795774715459, c = -1:
/// 0.229890473355.
[[nodiscard]] double sphere_point_light_radiance(double radiant_intensity, double offset, double radius,
                                                 double cos_angle, double albedo,
                                                 Bounces bounces = kAllBounces);

/// Spherical cavity whose opening is a removed cap of half-angle a (of the cavity, 0 < a < pi), under a
/// uniform sky (radiance L) that fills the opening: with f = (1 - cos a)/2, the opening's share of the
/// sphere,
///   E = pi L f/(1 - rho (1 - f)) at every point.  Bowl (a = pi/2), rho = .8: 2.61799387799; rho = 1: pi.
[[nodiscard]] double cavity_irradiance(double opening_half_angle, double albedo, double radiance,
                                       Bounces bounces = kAllBounces);

/// Indirect irradiance in a hemispherical bowl, the same at every point, when any light gives its aperture
/// (the flat disc) the mean irradiance E_a and nothing of it misses the bowl:
///   E_ind = E_a rho/4 (1 + rho/2 + ... (rho/2)^(N-1)), all: E_a (rho/4)/(1 - rho/2).
/// E_a = 1 (sun along the axis), rho = .8: 1/3; N = 1: .2; N = 2: .28.
[[nodiscard]] double bowl_indirect_irradiance(double aperture_irradiance, double albedo,
                                              Bounces bounces = kAllBounces);

// ---------------------------------------------------------------- pairs of surfaces
struct Pair {
  double first = 0.0;
  double second = 0.0;
};

/// Form factor from any point of a face of an infinite dihedral of opening phi in (0, pi] to the other face:
/// (1 + cos phi)/2, whatever the distance from the edge.
[[nodiscard]] double dihedral_form_factor(double opening);

/// Irradiance of both faces under a uniform sky (radiance L), e = pi L (1 - F):
///   E1 = e (1 + F rho2)/(1 - F^2 rho1 rho2), E2 likewise; equal albedos: e/(1 - rho F).
/// rho = .8: phi = 60 deg 1.96349540849, 90 deg 2.61799387799, 120 deg 2.94524311274.
/// .5/.8 at 90 deg: 2.44346095279, 2.18166156499.
[[nodiscard]] Pair dihedral_irradiances(double opening, double albedo1, double albedo2, double radiance,
                                        Bounces bounces = kAllBounces);

/// Form factor from the middle of one side of the edge of a finite right-angled corner to the other face:
/// both faces reach `reach` along the edge to either side and away from it; the point is at distance d from
/// the edge:
///   F = [atan(W/d) - d/sqrt(W^2 + d^2) atan(W/sqrt(W^2 + d^2))]/pi = 1/2 - (1/pi + 1/4) d/W + O((d/W)^2)
/// W = 1000, d = 1: 0.499431690424.
[[nodiscard]] double finite_corner_form_factor(double reach, double distance);

/// Radiosities of two concentric spheres r1 < r2 facing each other, q = (r1/r2)^2:
///   B1 = M1 + rho1 B2,  B2 = M2 + rho2 (q B1 + (1 - q) B2).  r = 1, 2; M = 1, 0; rho = .5, .8: 4/3, 2/3.
[[nodiscard]] Pair concentric_spheres_radiosity(double radius1, double radius2, const Pair& emitted,
                                                const Pair& albedo);

/// Radiosities of two infinite parallel plates: B1 = (M1 + rho1 M2)/(1 - rho1 rho2), B2 likewise.
/// M = 1, 0; rho = .5, .8: 5/3, 4/3.
[[nodiscard]] Pair parallel_plates_radiosity(const Pair& emitted, const Pair& albedo);

// ---------------------------------------------------------------- transfer vectors
/// Nine coefficients of three bands in the project's convention (CONVENTIONS.md#spherical-harmonics).
using ThreeBands = std::array<double, 9>;

/// Direct transfer vector (unit albedo, 1/pi inside) of a point on the floor of an infinite right-angled
/// corner that is black: T_i = (1/pi) int over {w.f > 0, w.n_wall > 0} of y_i(w) (w.f) dw, in any frame.
/// floor +z, wall +y: T_00 = 0.141047395887 = 1/sqrt(16 pi), T_11 = 0.
[[nodiscard]] ThreeBands corner_direct_transfer(const Vec3d& floor_normal, const Vec3d& wall_normal);

/// The same with interreflection: with D1 and D2 the direct transfer vectors of floor and wall and F = 1/2,
///   T = (D1 + F rho_wall D2)/(1 - F^2 rho_floor rho_wall)
/// at every point of the floor; the wall's is got by exchanging the arguments. Exit radiance = albedo (T . l)
/// for any distant light l of three bands.
/// @param floor_normal, wall_normal  unit, perpendicular to each other (to 1e-6)
/// floor +z, wall +y, both .8: T_00 = 0.235078993145, T_1-1 = -0.200990089, T_10 = 0.243263540.
[[nodiscard]] ThreeBands corner_transfer(const Vec3d& floor_normal, const Vec3d& wall_normal,
                                         double floor_albedo, double wall_albedo,
                                         Bounces bounces = kAllBounces);

}  // namespace plumbline::truth
