// prt/sh/window.hpp: the least window that takes all negative lobes out of a light, proved rather than sampled.
#pragma once

#include <vector>

#include "prt/sh/lighting.hpp"

namespace plumbline::sh {

/// The minimum of a band-limited function over the whole sphere lies in [lower_bound, value].
struct SphereMinimum {
  Vec3d direction{0.0, 0.0, 1.0};
  double value = 0.0;        // the function at `direction`
  double lower_bound = 0.0;  // proved, rounding of the sums included
};
/// Branch and bound over spherical triangles, each bounded by value, gradient and a bound on the second derivative. Ends
/// when value - lower_bound <= tolerance, or after 500,000 triangles with the wider interval it has.
/// @throws InputError for a number of coefficients that is no square, one that is not finite, or tolerance <= 0
[[nodiscard]] SphereMinimum minimum_on_sphere(const std::vector<double>& coefficients, double tolerance);
/// True where the function is proved to be at least `threshold` everywhere; false where a direction has less, or where
/// the proof ran out of triangles. Quick wherever the answer is clear.
[[nodiscard]] bool is_certainly_at_least(const std::vector<double>& coefficients, double threshold);

/// What the window of least lambda does.
struct AutomaticWindow {
  double lambda = 0.0;
  ShRgb function;                // windowed by Window::laplacian with that lambda
  double lower_bound = 0.0;      // proved, of all channels
  double relative_change = 0.0;  // L2 norm of (windowed - original) over that of the original
};
/// The least lambda of the Laplacian window, to a thousandth, for which no channel is below `floor` anywhere: proved on
/// the whole sphere, not sampled. 0 where the function needs no window. Found by bisection, so that just below it the
/// function is negative somewhere (or unproved); the mean (degree 0) never changes. It does not depend on how the
/// function is turned. @throws InputError when a channel's mean is below the floor or equal to it without the channel
/// being constant (no window helps), or as minimum_on_sphere()
[[nodiscard]] AutomaticWindow automatic_window(const ShRgb& function, double floor = 0.0);

}  // namespace plumbline::sh
