// validation/truth/irradiance.hpp: direct light in closed form.
// Lengths share any one unit, angles are radians, radiance L [W m^-2 sr^-1], irradiance E [W m^-2], radiant
// intensity I [W sr^-1]. A form factor F is a pure number: E = pi L F from a Lambertian surface of radiance
// L, and F = mean sky view where the surface hides a sky. Every formula is held against an independent
// quadrature in validation/tests/truth/irradiance_test.cpp. Arguments outside the stated range throw
// InputError: a closed form used outside its range is a wrong truth. [1] Lambert, Photometria, 1760. [2]
// Siegel & Howell, Thermal Radiation Heat Transfer. [3] Howell, A Catalog of Radiation Heat Transfer
// Configuration Factors (B: point to surface, C: surface to surface). [4] Moon & Spencer, Illumination from a
// non-uniform sky, 1942 (the CIE overcast sky).
#pragma once

#include <span>
#include <vector>

#include "reference/base/vector.hpp"

namespace plumbline::truth {

// ---------------------------------------------------------------- skies
/// Under a uniform sky of the given radiance, nothing in the way: E = pi L. L = 1: 3.14159265359.
[[nodiscard]] double uniform_sky_irradiance(double radiance);

/// Receiver tilted by `tilt` in [0, pi] from the horizontal over an infinite horizontal plane of albedo
/// `ground_albedo` that sees nothing but the sky: E = pi L [(1 + cos b) + g (1 - cos b)] / 2. Exact at every
/// point of a convex body over that plane where the body's own shadow on the ground is left out (g = 0:
/// always). b = 60 deg, L = 1: 2.35619449019 (g = 0), 2.59181393921 (g = 0.3).
[[nodiscard]] double tilted_receiver_irradiance(double tilt, double ground_albedo, double radiance);

/// Solid angle of a cap: 4 pi sin^2(a/2) [sr], half-angle a in [0, pi]. a = 0.2665 deg: 6.79670235728e-5.
[[nodiscard]] double cap_solid_angle(double half_angle);

/// Uniform cap of half-angle a, its centre at `angle` from the normal, wholly above the horizon (a + angle <=
/// pi/2): E = pi L sin^2 a cos(angle). a = 30 deg at 45 deg, L = 1: 0.555360367270; at 0: pi/4.
/// A sphere of radius R at distance d is a cap with sin a = R/d.
[[nodiscard]] double cap_irradiance(double half_angle, double angle, double radiance);

/// Radiance of a sun disc at the zenith that gives `irradiance`: E / (pi sin^2 a), a in (0, pi/2].
/// a = 0.2665 deg, E = 1: 14713.0969712.
[[nodiscard]] double sun_radiance(double half_angle, double irradiance);

/// CIE overcast sky L = L_z (1 + 2 cos t)/3 over black ground, receiver tilted by b in [0, pi]:
///   E = L_z/3 [pi (1 + cos b)/2 + 4/3 ((pi - b) cos b + sin b)]   [4 for b = 0 and pi/2]
/// L_z = 1: horizontal 7 pi/9 = 2.44346095279, vertical (pi/2 + 4/3)/3 = 0.968043220043.
[[nodiscard]] double overcast_irradiance(double tilt, double zenith_radiance);

// ---------------------------------------------------------------- band-limited environments (whole sphere)
/// L(w) = a + b w.z, n_z = n.z in [-1, 1]: E = pi a + (2 pi/3) b n_z. a = b = 1, n_z = 1/2: 4.18879020479.
[[nodiscard]] double linear_environment_irradiance(double a, double b, double n_z);

/// L(w) = (w.z)^k, k in 0..4: E = pi, (2 pi/3) n_z, (pi/4)(1 + n_z^2), (2 pi/5) n_z,
/// pi/5 + (pi/7) P_2(n_z) - (pi/105) P_4(n_z) with Legendre's P. At n = z, k even: 2 pi/(k + 2).
/// k = 2, n at 60 deg: 0.981747704247; k = 4, n = z: pi/3.
[[nodiscard]] double axis_power_irradiance(int power, double n_z);

// ---------------------------------------------------------------- lights
/// Point light at height h > 0 over the plane, lateral distance x: E = I h/(h^2 + x^2)^(3/2).
/// I = 1, h = 2, x = 1: 0.178885438200.
[[nodiscard]] double point_light_irradiance(double radiant_intensity, double height, double lateral);

/// Form factor of a parallel disc of radius r at height h > 0, axis at lateral distance x (Howell B-12):
///   F = (1 - (x^2 + h^2 - r^2)/sqrt((x^2 + h^2 + r^2)^2 - 4 r^2 x^2))/2
/// h = 2, x = 1, r = 1: 0.146446609407; h = 2, x = 0, r = 1: 0.2.
[[nodiscard]] double disc_form_factor(double radius, double height, double lateral);

/// Parallel rectangle a x b at height c > 0, one corner straight above the point (Howell B-3), A = a/c, B =
/// b/c:
///   F = [A/sqrt(1+A^2) atan(B/sqrt(1+A^2)) + B/sqrt(1+B^2) atan(A/sqrt(1+B^2))]/(2 pi)
/// A = B = 1: 0.138531605995.
[[nodiscard]] double corner_rectangle_form_factor(double a, double b, double height);

/// The same rectangle centred above the point: four quarters. 2 x 2 at height 1: 0.554126423980.
[[nodiscard]] double centred_rectangle_form_factor(double a, double b, double height);

/// Rectangle of height a, width b that stands perpendicular on the receiver's plane at distance c > 0, one
/// lower corner at the foot of the perpendicular from the point (Howell B-4), s = sqrt(a^2 + c^2):
///   F = [atan(b/c) - (c/s) atan(b/s)]/(2 pi).  a = b = c = 1: 0.0557341970026.
[[nodiscard]] double perpendicular_rectangle_form_factor(double height, double width, double distance);

/// Lambert's formula: E = (L/2) sum_i theta_i (Gamma_i . n), theta_i the angle between v_i and v_(i+1),
/// Gamma_i = unit(v_i x v_(i+1)); |sum|, so either turning sense will do. The polygon must be wholly above
/// the horizon (v.n >= 0 up to rounding): clip_to_horizon() first. [1]
/// @param vertices  planar polygon relative to the receiver, >= 3 points, not through the receiver
/// (1,0,1), (0,1,1), (-1,-1,2) over n = z, L = 1: 0.687617388735.
[[nodiscard]] double polygon_irradiance(std::span<const Vec3d> vertices, const Vec3d& normal,
                                        double radiance);

/// The part of a polygon with v.n >= 0 (Sutherland & Hodgman); may be empty.
[[nodiscard]] std::vector<Vec3d> clip_to_horizon(std::span<const Vec3d> vertices, const Vec3d& normal);

/// Solid angle of a triangle seen from the origin [sr] (van Oosterom & Strackee 1983):
///   tan(Omega/2) = |a.(b x c)|/(abc + (a.b)c + (b.c)a + (c.a)b).  The triangle above: 0.748996398184.
[[nodiscard]] double triangle_solid_angle(const Vec3d& a, const Vec3d& b, const Vec3d& c);

// ---------------------------------------------------------------- obstructions of a uniform sky: E = pi L V
/// Sky view V of a horizontal point at distance d > 0 from an infinitely long wall of height h >= 0:
/// V = (1 + cos(atan(h/d)))/2. h = d: 0.853553390593; h to infinity: 1/2.
[[nodiscard]] double wall_sky_view(double height, double distance);

/// Sky view of any point on a face of an infinite dihedral of opening angle phi in [0, pi]: (1 - cos phi)/2.
[[nodiscard]] double dihedral_sky_view(double opening);

/// Sky view under a sphere of radius R whose centre is at height h >= R, lateral distance x (ambient
/// occlusion, black sphere): V = 1 - h R^2/(h^2 + x^2)^(3/2). R = h = x = 1: 0.646446609407; R = 1, h = 2:
/// .75 (x = 0), 0.821114561800 (x = 1).
[[nodiscard]] double sphere_sky_view(double radius, double height, double lateral);

/// The same sphere as a uniform emitter: E = pi L h R^2/(h^2 + x^2)^(3/2).
[[nodiscard]] double sphere_irradiance(double radius, double height, double lateral, double radiance);
/// Flux [W] of that sphere through the whole plane: half of what it emits, 2 pi^2 R^2 L. R = L =
/// 1: 19.7392088022.
[[nodiscard]] double sphere_flux_on_plane(double radius, double radiance);

// ---------------------------------------------------------------- between surfaces
/// Coaxial parallel discs, radii r1 (from) and r2, distance h > 0 (Howell C-41), R_i = r_i/h:
///   X = 1 + (1 + R2^2)/R1^2,  F12 = (X - sqrt(X^2 - 4 (R2/R1)^2))/2.  R1 = R2 = 1: 0.381966011250.
[[nodiscard]] double coaxial_discs_form_factor(double radius1, double radius2, double distance);

/// Equal, opposite a x b rectangles at distance c > 0 (Howell C-11), X = a/c, Y = b/c:
///   F = 2/(pi X Y) {ln sqrt[(1+X^2)(1+Y^2)/(1+X^2+Y^2)] + X sqrt(1+Y^2) atan(X/sqrt(1+Y^2))
///       + Y sqrt(1+X^2) atan(Y/sqrt(1+X^2)) - X atan X - Y atan Y}.  Unit cube: 0.199824895698.
[[nodiscard]] double opposite_rectangles_form_factor(double a, double b, double distance);

/// From a rectangle (edge l, depth w) to one at right angles along the common edge l (height h), all > 0
/// (Howell C-14), W = w/l, H = h/l, S = W^2 + H^2:
///   F12 = 1/(pi W) {W atan(1/W) + H atan(1/H) - sqrt(S) atan(1/sqrt(S))
///         + 1/4 ln[(1+W^2)(1+H^2)/(1+S) (W^2 (1+S)/((1+W^2) S))^(W^2) (H^2 (1+S)/((1+H^2) S))^(H^2)]}
/// Unit cube: 0.200043776075; four of these and one opposite face make 1.
[[nodiscard]] double adjacent_rectangles_form_factor(double edge, double depth, double height);

/// Sphere (any radius that clears the disc) to a coaxial disc of radius r >= 0 at distance h > 0 from its
/// centre: F = (1 - 1/sqrt(1 + (r/h)^2))/2. r = h: 0.146446609407.
[[nodiscard]] double sphere_to_disc_form_factor(double radius, double distance);

/// Inside a sphere of radius R: F from any point to any patch of area A of the same sphere: A/(4 pi R^2).
[[nodiscard]] double inside_sphere_form_factor(double area, double radius);

}  // namespace plumbline::truth
