// validation/conformance/diagnosis.hpp: from wrong numbers to the likely cause.
#pragma once

#include <string>
#include <vector>

namespace plumbline::conformance {

/// What was expected and what came, several vectors of n^2 coefficients each (Plumbline's convention).
struct Evidence {
  int bands = 0;
  std::vector<std::vector<double>> expected;
  std::vector<std::vector<double>> measured;
  double tolerance =
      1e-5;  // relative to the largest expected value; what a cause must explain the numbers to
};

/// The simplest cause that explains all vectors, tried in this order: values that are no numbers; one factor; signs
/// of odd m, of odd bands, mirrored or swapped axes; order within the bands; a factor for each band; a few
/// coefficients with factors, swapped or missing. Else where the largest error is. Never empty.
[[nodiscard]] std::string diagnose(const Evidence& evidence);

/// "pi times too large", "sqrt(2) times too small", "1.27 times too large", "of the wrong sign".
[[nodiscard]] std::string in_words(double factor);

/// Cause of single values (irradiances, radiances) that should be `expected`: one factor, or the largest difference.
[[nodiscard]] std::string diagnose_values(const std::vector<double>& expected,
                                          const std::vector<double>& measured, double tolerance);

}  // namespace plumbline::conformance
