// validation/checks/truths_calibration.hpp: is the judge itself right? The standard errors tell the truth (p values are
// uniform), biases are found as often as claimed, and nothing is found where there is nothing.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "validation/checks/truths.hpp"
#include "validation/metrics/power.hpp"
#include "validation/metrics/statistics.hpp"

namespace plumbline::checks {

/// The estimate multiplied by 1 + bias: the fault a test must find. Lives here, not in the path tracer.
[[nodiscard]] Measurement biased(Measurement m, double bias);

// ---------------------------------------------------------------- p values
/// Two-sided p of each case and seed, one run of 16 randomisations each: uniform if means and standard errors are both
/// right. `samples` paths a run. Cases without noise, or with less than 20 times float rounding, are left out.
struct PValues {
  std::vector<double> values;
  std::vector<double> t;        // the deviations they come from, in standard errors …
  std::vector<double> freedom;  // … of so many degrees of freedom
  std::size_t cases = 0;
  std::size_t seeds = 0;
};
struct PValueBudget {
  int samples = 4096;
  std::size_t seeds = 32;
  std::uint64_t seed = 0;
  int threads = 0;
};
[[nodiscard]] PValues p_values(std::span<const TruthCase> cases, const PValueBudget& budget);
/// The p values had all standard errors been `factor` times as large: a renderer that misjudges its own noise.
[[nodiscard]] PValues with_error_factor(PValues p, double factor);

/// Kolmogorov-Smirnov distance from uniform, and how many are below 0.01 against the binomial law.
struct Flatness {
  metrics::TestResult distance;
  std::size_t below = 0;  // 0.01
  double below_p = 0.0;
};
[[nodiscard]] Flatness flatness(const PValues& p);
/// Both p values at least sidak(significance, 2).
[[nodiscard]] bool is_flat(const Flatness& f, double significance);

// ---------------------------------------------------------------- power
/// How often a bias is found among `seeds` estimates, each by its own t test of that significance; and how often it
/// should be: noncentral t with the spread that other estimates showed.
struct PowerPoint {
  std::string estimator;
  double bias = 0.0;        // relative, injected; 0: false alarms
  double stated = 0.0;      // probability
  double stated_low = 0.0;  // the same at the ends of the spread's own interval
  double stated_high = 0.0;
  metrics::Proportion measured;  // interval at the significance of the comparison
};
struct PowerBudget {
  std::size_t seeds = 1000;
  double test_significance = 0.01;  // of each t test
  double interval_significance = 1e-4;
  std::uint64_t seed = 0;
  int threads = 0;
};
inline constexpr double kInjectedBiases[] = {0.0, 0.001, 0.003, 0.01, 0.03};
/// Samples a run are set so that a bias of `found` is found with probability 0.9 (the power of the next ones is then
/// nearly 1); the spread comes from `seeds` further estimates.
[[nodiscard]] std::vector<PowerPoint> power_curve(const TruthCase& one, double found,
                                                  const PowerBudget& budget);
/// The interval of the measured rate and that of the stated one overlap. False for NaN.
[[nodiscard]] bool agrees(const PowerPoint& point);

/// A/A: two runs of the same thing with different seeds, Welch's t test; the share that differs.
[[nodiscard]] PowerPoint false_alarms_between_runs(const TruthCase& one, int samples,
                                                   const PowerBudget& budget);

}  // namespace plumbline::checks
