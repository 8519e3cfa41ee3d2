// validation/checks/sh_checks.hpp: how far a spherical-harmonics implementation is from the truth.
// Each function takes the implementation as a callable and returns a plain number, 0 for a perfect one; a NaN
// anywhere makes the result NaN. Conventions: CONVENTIONS.md#spherical-harmonics.
#pragma once

#include <functional>
#include <vector>

#include "reference/base/vector.hpp"
#include "reference/light/environment.hpp"

namespace plumbline::checks {

/// Values of all functions at a unit direction, index l(l+1)+m; at least as many as the check's bands need.
using BasisUnderTest = std::function<std::vector<double>(const Vec3d& direction)>;
/// n^2 RGB coefficients of an environment's radiance.
using ProjectionUnderTest =
    std::function<std::vector<RgbD>(const light::Environment& environment, int bands)>;

/// Directions of no special position, the axes, and points close to the poles.
[[nodiscard]] std::vector<Vec3d> probe_directions();

/// The definition of the basis (associated Legendre functions and the azimuth), in long double: the judge's truth,
/// independent of prt/sh. Good to about 1e-16 bands for up to 100 bands.
[[nodiscard]] std::vector<double> textbook_basis(int bands, const Vec3d& direction);

struct GramDeviation {
  double value = 0.0;  // max |G - I|
  int row = 0;         // where: coefficient indices, row >= column
  int column = 0;
};
/// G_ij = integral of y_i y_j, by a quadrature that is exact for the degree. Sees wrong constants, wrong
/// polynomials and mixed-up functions. It cannot see a function's sign or a permutation: basis_deviation()
/// does.
[[nodiscard]] GramDeviation gram_deviation(const BasisUnderTest& basis, int bands);

struct BasisDeviation {
  double value = 0.0;  // max |y - truth|
  int index = 0;       // of which coefficient
  Vec3d direction{0.0};
};
/// Against the definition (associated Legendre functions and the azimuth, in long double) at fixed
/// directions, the poles and the axes among them. Sees signs and order too. Truth is good to about 1e-16
/// bands for up to 100 bands.
[[nodiscard]] BasisDeviation basis_deviation(const BasisUnderTest& basis, int bands);

/// max over degrees and pairs of directions of |sum_m y_lm(a) y_lm(b) - (2l + 1)/(4 pi) P_l(a . b)|.
[[nodiscard]] double addition_theorem_deviation(const BasisUnderTest& basis, int bands);

/// max over l < degrees of |factor(l) - 2 pi integral_0^1 z P_l(z) dz|.
[[nodiscard]] double clamped_cosine_factor_error(const std::function<double(int degree)>& factor,
                                                 int degrees);

/// White sky: c_00 = sqrt(4 pi), all others 0. Largest absolute deviation.
[[nodiscard]] double white_projection_error(const ProjectionUnderTest& project, int bands);
/// Lat-long image of constant radiance 1, which must give the same numbers as the white sky.
[[nodiscard]] double white_image_projection_error(const ProjectionUnderTest& project, int bands);
/// Cube map with six different constant faces against the closed form up to l = 2. Sees swapped and mirrored
/// axes and the order and signs of the functions.
[[nodiscard]] double cube_face_projection_error(const ProjectionUnderTest& project);
/// Skies that are polynomials in x, y and z of degree 2, no symmetry: irradiance from the projected
/// coefficients and `factor` against the closed form, largest absolute deviation over fixed normals.
[[nodiscard]] double polynomial_irradiance_error(const ProjectionUnderTest& project,
                                                 const BasisUnderTest& basis,
                                                 const std::function<double(int degree)>& factor);

}  // namespace plumbline::checks
