// validation/checks/truths.hpp: the path tracer against every closed form there is for it, one case each, and the
// verdict: two one-sided tests, so that "equal" is shown and not merely not refuted.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "validation/checks/case.hpp"
#include "validation/checks/finding.hpp"

namespace plumbline::checks {

/// An estimate with what its standard error is worth.
struct Measurement {
  double mean = 0.0;
  double standard_error = 0.0;
  double degrees_of_freedom = 0.0;
};

/// How an estimate is to be made: `copies` independent runs of `samples` paths each. One run knows its error from 16
/// randomisations (15 degrees of freedom); four together have 60, which shortens far tails much.
struct Effort {
  int samples = 1024;
  int copies = 1;
  std::uint64_t seed = 0;
  int threads = 0;
};
using Estimator = std::function<Measurement(const Effort&)>;

/// One closed form and the path tracer's way to it.
struct TruthCase {
  std::string name;     // "D09_CornerRectangle": letters, digits and _
  std::string formula;  // the closed form in one line
  double truth = 0.0;
  std::function<Estimator()> prepare;  // makes the scene: only when the case runs

  /// What biases are relative to; 0 = the truth itself.
  double scale = 0.0;
  /// Relative error of the scene that stands for the truth's (planes that end); widens the interval.
  double model_error = 0.0;
  /// Every sample is the same by construction: held against rounding alone.
  bool is_noiseless = false;
  /// The margin is so many times the tier's. 1 but for late bounces; said in the finding.
  double margin_factor = 1.0;
  /// Samples of the pilot that measures the spread.
  int pilot_samples = 1 << 12;
};

/// Float storage of radiance, albedo and geometry: a few units of 6e-8 a step.
inline constexpr double kRounding = 2e-6;
/// What a noiseless case may be off: some more such steps.
inline constexpr double kNoiselessMargin = 1e-5;

/// Largest relative bias that still counts as none.
[[nodiscard]] constexpr double tier_margin(Tier tier) {
  return tier == Tier::nightly ? 1e-3 : 5e-3;
}

/// All of them, sorted by name. Names are unique.
[[nodiscard]] std::vector<TruthCase> truth_cases();
/// The parts of it.
[[nodiscard]] std::vector<TruthCase> direct_light_cases();
[[nodiscard]] std::vector<TruthCase> distant_light_cases();
[[nodiscard]] std::vector<TruthCase> enclosure_cases();
[[nodiscard]] std::vector<TruthCase> interreflection_cases();
[[nodiscard]] std::vector<TruthCase> sampling_cases();

/// How a case is judged, fixed before its estimate is made.
struct TruthPlan {
  double margin = 0.0;        // relative
  double significance = 0.0;  // of each one-sided test
  Effort effort;
};

/// Paths for which an unbiased path tracer passes with probability kTruthPower: from the margin, the significance and
/// the spread that a pilot run with other random numbers finds (its 95 % upper bound). At most kMostPaths.
inline constexpr double kTruthPower = 0.9;
inline constexpr double kMostPaths = 1u << 28U;
[[nodiscard]] TruthPlan plan_truth(const TruthCase& one, const Estimator& estimator, const Budget& budget,
                                   std::size_t cases);

/// pass: the 1 - 2 alpha interval of the relative bias (model error and rounding added) lies within the margin; fail:
/// it lies outside, or a number is not finite, or an estimate that should vary does not; else inconclusive.
/// `measured`, `uncertainty` (95 %) and `bound` in per cent.
[[nodiscard]] Finding judge_truth(const TruthCase& one, const TruthPlan& plan,
                                  const Measurement& measurement);

/// Prepares, plans, measures and judges.
struct TruthResult {
  TruthPlan plan;
  Measurement measurement;
  Finding finding;
};
[[nodiscard]] TruthResult run_truth(const TruthCase& one, const Budget& budget, std::size_t cases);

/// A seed of its own for every case and purpose.
[[nodiscard]] std::uint64_t truth_seed(std::uint64_t seed, const std::string& name, std::uint64_t purpose);

}  // namespace plumbline::checks
