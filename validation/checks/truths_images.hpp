// validation/checks/truths_images.hpp: images that must agree: of one scene at three scales, and of a tiny bright sun
// against a long reference.
#pragma once

#include <vector>

#include "validation/checks/case.hpp"
#include "validation/checks/finding.hpp"
#include "validation/metrics/statistics.hpp"

namespace plumbline::checks {

/// Means of pixels or tiles with their standard errors, of 16 randomisations each.
using Values = std::vector<metrics::Estimate>;

/// The largest |t| of the differences, Welch's test with Sidak's limit over all values: fails beyond chance. Degenerate
/// pairs (both without noise) must be equal to 1e-4.
[[nodiscard]] Finding judge_values(const std::string& name, const Values& a, const Values& b,
                                   double significance);
/// Mean difference of all values relative to the mean of a, by two one-sided tests with that margin.
[[nodiscard]] Finding judge_mean(const std::string& name, const Values& a, const Values& b, double margin,
                                 double significance);

/// Means over 8 x 8 pixel tiles of an image of the Cornell box, all lengths multiplied by `scale`. Each value's error is
/// that of the tile's mean over 16 independent images.
[[nodiscard]] Values scaled_image(float scale, int samples_per_pixel, const Budget& budget,
                                  std::uint64_t seed);

/// Pixels of the open box under a sky of 1 with a sun of 1e5 that covers one texel of 512 x 256.
struct SunImages {
  Values quick;      // rendered to a target error of 1 %
  Values reference;  // rendered long, other random numbers
  double relative_error = 0.0;
  double kurtosis = 0.0;  // of the pixels' t values: 3 for noise without fireflies
  std::int64_t samples_per_pixel = 0;
};
[[nodiscard]] SunImages sun_images(const Budget& budget, int reference_samples);

/// All of these as findings.
[[nodiscard]] std::vector<Finding> check_truth_images(const Budget& budget);

}  // namespace plumbline::checks
