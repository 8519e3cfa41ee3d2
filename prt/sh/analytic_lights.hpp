// prt/sh/analytic_lights.hpp: lights whose SH coefficients have a closed form. All are functions on the whole sphere:
// no horizon clips them. Zonal lights are z_l about their own axis; put them anywhere with rotate_zonal() or lit().
#pragma once

#include <span>
#include <vector>

#include "prt/sh/lighting.hpp"

namespace plumbline::sh {

/// Coefficients of one light times its radiance. @throws InputError when the number of coefficients is no square
[[nodiscard]] ShRgb lit(const std::vector<double>& coefficients, const RgbD& radiance);
/// A zonal light turned to `axis` (of any length), times its radiance. The bands are those of `zonal`.
/// @throws InputError for an axis without length or a number that is not finite
[[nodiscard]] ShRgb lit(const std::vector<double>& zonal, const Vec3d& axis, const RgbD& radiance);

/// A light without extent, of irradiance 1 on a surface that faces it: a pulse, c_i = y_i(direction). Zonal form:
/// z_l = sqrt((2l + 1)/(4 pi)). Truncated it rings; it has no radiance to normalise.
/// @throws InputError for bands out of range (here and below)
[[nodiscard]] std::vector<double> directional_light(int bands);

/// A ball of radius r whose centre is at `distance`: a cap of half angle asin(r / distance), radiance 1. Discs that face
/// the receiver (a sun) are cap() itself. @throws InputError unless 0 < radius < distance, both finite
[[nodiscard]] std::vector<double> sphere_light(int bands, double distance, double radius);

/// The sky of two colours: radiance (1 + cos)/2 from above and (1 - cos)/2 from below blend over the whole sphere. Both
/// 1 give the constant 1: sqrt(4 pi) y_00 (some engines' hemisphere light is 1.5 times that).
/// z: {sqrt(pi), +-sqrt(pi/3), 0, …}. The jump at the horizon, radiance 1 above and 0 below, is cap(bands, pi/2).
struct HemisphereLight {
  RgbD above{0.0};  // radiance towards `up`
  RgbD below{0.0};
};
/// @throws InputError for an axis without length or a radiance that is not finite
[[nodiscard]] ShRgb hemisphere_light(int bands, const HemisphereLight& light, const Vec3d& up);

/// exp(sharpness (cos t - 1)), 1 at its axis: z_l = sqrt(4 pi (2l + 1)) e^-k i_l(k), i_l the modified spherical Bessel
/// functions of the first kind. Relative error below 1e-13. @throws InputError unless sharpness is finite and >= 0
[[nodiscard]] std::vector<double> spherical_gaussian(int bands, double sharpness);

/// Indicator of the part of the sphere that a flat polygon covers, as seen from the origin; convex or not, 3 or more
/// vertices, relative to the receiver, in any unit. It counts positive where the vertices run clockwise as seen from the
/// origin (counterclockwise from outside the sphere), negative the other way: solid angle = sqrt(4 pi) c_00.
///
/// Green's formula on each degree (the boundary integrals of Wang & Ramamoorthi 2018 and Belcour et al. 2018 in another
/// form): per edge a closed form in the edge's own frame, then one rotation. O(vertices bands^3); absolute error below
/// 1e-13 to 30 bands. A plane through the origin covers nothing: all zero.
/// @throws InputError for fewer than 3 vertices, a vertex at the origin or not finite, or an edge through the origin
[[nodiscard]] std::vector<double> polygon_light(int bands, std::span<const Vec3d> vertices);

/// A polygon that emits `radiance` from one side, that from which its vertices run counterclockwise, or from both.
enum class EmittingSides { front, both };
/// What arrives at `receiver` over the whole sphere; all zero behind a one-sided polygon. An emissive triangle has three
/// vertices. @throws InputError as polygon_light()
[[nodiscard]] ShRgb emissive_polygon(int bands, const Vec3d& receiver, std::span<const Vec3d> vertices,
                                     const RgbD& radiance, EmittingSides sides = EmittingSides::front);

}  // namespace plumbline::sh
