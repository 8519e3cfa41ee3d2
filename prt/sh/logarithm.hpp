// prt/sh/logarithm.hpp: logarithm of a function held in spherical harmonics, and the log visibility of spheres.
// Conventions: CONVENTIONS.md#spherical-harmonics; equation numbers: exponential.hpp [2].
#pragma once

#include <vector>

#include "prt/sh/exponential.hpp"

namespace plumbline::sh {

/// Eigenvalues (function values) below this are raised to it. The thesis says "a small epsilon" and gives none.
/// With 1/20 the log visibilities of single spheres at 4 bands reach |f^| = 5.1, near the limit of 4.8 it states,
/// and exp(log) comes nearest to the visibility; smaller floors ring (1/1000 reaches 10.7).
inline constexpr double kDefaultFloor = 0.05;

/// A logarithm, and how much of the function was too small for one.
struct Logarithm {
  std::vector<double> coefficients;
  int clipped = 0;        // eigenvalues below the floor
  int eigenvalues = 0;    // of so many
  double smallest = 0.0;  // eigenvalue, before clipping
  double energy = 0.0;    // share of the function 1 that the clipped eigenvectors hold, 0 … 1
};

/// Logarithm by eigen-analysis of g's product matrix (eq. 3.34): R' q(D) R (g - 1), q(x) = log x / (x - 1), with
/// D raised to `floor`. A function that is nowhere near `floor` loses nothing. Costs bands^6.
/// @throws InputError for sizes as product() does, a non-finite coefficient, or floor <= 0
[[nodiscard]] Logarithm logarithm(const std::vector<double>& g, double floor = kDefaultFloor);

/// The same for a function symmetric about +z, from and to n zonal coefficients: bands^3.
[[nodiscard]] Logarithm zonal_logarithm(const std::vector<double>& zonal, double floor = kDefaultFloor);

/// The oracle: projection of log(max(g(direction), floor)) by quadrature with as many points as `points` bands
/// of sphere_quadrature() have; `energy` is the share of the sphere below the floor, `smallest` the smallest
/// value met, `clipped` and `eigenvalues` count points.
[[nodiscard]] Logarithm logarithm_by_quadrature(const std::vector<double>& g, double floor = kDefaultFloor,
                                                int points = 128);

/// Visibility past a sphere of this angular radius around +z: 0 inside the cone, 1 outside. n zonal
/// coefficients. @throws InputError as cap() does
[[nodiscard]] std::vector<double> sphere_visibility(int bands, double angular_radius_rad);

}  // namespace plumbline::sh
