// validation/checks/exponential_study.hpp: how far each way to exponentiate spherical harmonics is from the truth,
// on the functions it is used for: log visibilities of spheres, single and accumulated.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace plumbline::checks {

/// Errors are root mean squares over the sphere of a visibility between 0 and 1.
struct MethodError {
  double error = 0.0;  // NaN = the method refuses this magnitude
  int products = 0;    // SH products (or squares) it took
};

/// The methods, in the order of `StudyCase::errors`.
[[nodiscard]] const std::vector<std::string>& exponential_methods();

/// Exponentials of one function f.
struct StudyCase {
  double parameter = 0.0;  // angular radius [degrees], or number of blockers
  double magnitude = 0.0;  // |f^|
  double best_a = 0.0;     // eq. 3.29, by the oracle
  double best_b = 0.0;
  int clipped = 0;  // eigenvalues of the visibility below the floor (single spheres)
  double clipped_energy = 0.0;
  std::vector<MethodError> errors;        // against exp of the reconstructed f, projected again
  std::vector<double> visibility_errors;  // the same approximations against the visibility itself, projected
  double oracle_visibility_error = 0.0;   // and the oracle's: what the logarithm has lost
  double product_visibility_error = 0.0;  // and that of repeated SH products without any logarithm (eq. 3.23)
};

/// One sphere of angular radius 1, 3 … 89 degrees.
[[nodiscard]] std::vector<StudyCase> study_single_spheres(int bands);

/// 1, 2, 5, 10, 20, 50 and 100 spheres of angular radius 3 to 23 degrees in uniform directions, `trials` draws of
/// each.
[[nodiscard]] std::vector<StudyCase> study_accumulations(int bands, int trials, std::uint64_t seed);

/// Root mean square over the cases of method `index`; NaN if it refuses any.
[[nodiscard]] double overall_error(const std::vector<StudyCase>& cases, std::size_t index);

/// |log(exp f) - f| / |f|, f = 0.7 z - 1, exp by quadrature: what the truncation to `bands` loses.
[[nodiscard]] double round_trip_residual(int bands);

}  // namespace plumbline::checks
