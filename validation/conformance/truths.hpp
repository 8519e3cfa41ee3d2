// validation/conformance/truths.hpp: what the checks hold answers against: definitions and exact quadrature, from
// the textbook basis alone. Coefficients are in Plumbline's convention.
#pragma once

#include <functional>
#include <vector>

#include "reference/base/vector.hpp"
#include "reference/image/image.hpp"

namespace plumbline::conformance::truths {

using Values = std::vector<double>;
using Function = std::function<double(const Vec3d&)>;

/// n^2 values, the textbook basis in a direction.
[[nodiscard]] Values basis(int bands, const Vec3d& direction);
/// The band-limited function's value.
[[nodiscard]] double value(const Values& coefficients, const Vec3d& direction);

/// integral of f y_i by the quadrature that is exact for f of `exact_bands` bands times y_i of as many.
[[nodiscard]] Values projected(int bands, const Function& f, int exact_bands);

/// integral of z^power y_l0 over the part of the sphere with cosine in [1 - width, 1], by Gauss-Legendre nodes: exact,
/// to a relative 1e-14 for small widths too. width 1, power 1: the clamped cosine.
[[nodiscard]] Values zonal_integral(int bands, double width, int power);
/// A_l, from the definition 2 pi integral_0^1 z P_l(z) dz.
[[nodiscard]] double cosine_factor(int degree);
/// sqrt(4 pi/(2l + 1)) z_l y_lm(axis).
[[nodiscard]] Values about_axis(const Values& zonal, const Vec3d& axis);

/// Coefficients of f(R^-1 w), by projecting anew.
[[nodiscard]] Values rotated(int bands, const Values& coefficients, const glm::dmat3& rotation);
/// Projection of a(w) b(w).
[[nodiscard]] Values product(int bands, const Values& a, const Values& b);
/// Projection of g(a(w)) for a smooth g.
[[nodiscard]] Values composed(int bands, const Values& a, const std::function<double(double)>& g);

/// integral of y_i over a texel of a lat-long image.
[[nodiscard]] Values lat_long_texel(int bands, int width, int height, double x, double y);
/// integral of y_i over a texel of a cube map's face.
[[nodiscard]] Values cube_texel(int bands, int size, int face, double x, double y);
/// Direction of the middle of a texel.
[[nodiscard]] Vec3d lat_long_centre(int width, int height, double x, double y);
[[nodiscard]] Vec3d cube_direction(int face, double s, double t);

/// A smooth function of 3 bands without any symmetry, positive, and its 3 bands' coefficients.
[[nodiscard]] double polynomial_sky(const Vec3d& w);
/// Deterministic numbers without structure, in [-1, 1].
[[nodiscard]] Values some_values(std::size_t count, unsigned seed);
/// Rotations of no special position and the bad ones: identity, 180 degrees about each axis, beta = 0, pi and 1e-8.
[[nodiscard]] std::vector<glm::dmat3> rotations();

}  // namespace plumbline::conformance::truths
