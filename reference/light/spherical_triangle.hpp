// reference/light/spherical_triangle.hpp: a triangle as seen from a point, and directions drawn uniformly towards it.
// Arvo, "Stratified sampling of spherical triangles", SIGGRAPH 1995. Pure geometry in double.
#pragma once

#include "reference/base/vector.hpp"

namespace plumbline::light {

/// A triangle of the unit sphere.
struct SphericalTriangle {
  Vec3d a{0.0}, b{0.0}, c{0.0};  // unit
  double solid_angle = 0.0;      // [sr], in [0, 2 pi]
};

/// The triangle with these corners, given relative to the eye, none of them at it. solid_angle is 0 for an eye in
/// its plane outside of it.
///   tan(Omega/2) = |a.(b x c)|/(1 + a.b + b.c + c.a)   (van Oosterom & Strackee 1983; unit vectors)
[[nodiscard]] SphericalTriangle spherical_triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c);

/// A direction (unit) drawn uniformly by solid angle, density 1/solid_angle; u in [0, 1)^2, triangle.solid_angle
/// > 0. Neighbouring u give neighbouring directions.
[[nodiscard]] Vec3d sample_spherical_triangle(const SphericalTriangle& triangle, const Vec2& u);

}  // namespace plumbline::light
