// validation/study/efficiency.hpp: run time against error: efficiencies, their ratios, slopes, and who is on the Pareto front.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace plumbline::study {

/// One image that one method made.
struct Run {
  std::string method;
  int spp = 0;  // samples a pixel
  int repetition = 0;
  std::uint64_t seed = 0;
  double seconds = 0.0;  // tracing only
  double relmse = 0.0;   // without the reference's own error
};

/// 1 / (relmse x seconds); NaN unless both are above 0 (a relMSE less the reference's own error may not be).
[[nodiscard]] double efficiency(double relmse, double seconds);

/// A method's runs at one budget: means, and the efficiency of the means.
struct Budget {
  std::string method;
  int spp = 0;
  int repetitions = 0;
  double seconds = 0.0;
  double relmse = 0.0;
  double relmse_low = 0.0;  // 95 % interval of the mean, Student-t over repetitions; NaN for a single one
  double relmse_high = 0.0;
  double efficiency = 0.0;
  bool is_on_front = false;  // no other budget is both faster and better
};
/// In the order of their first runs.
[[nodiscard]] std::vector<Budget> budgets(std::span<const Run> runs);

/// How many times as efficient `method` is as `base` at equal samples. Runs of one repetition belong together (they were made one
/// after the other): the ratio is the geometric mean of the repetitions' ratios, its 95 % interval Student-t in the logarithm.
struct Ratio {
  std::string method;
  std::string base;
  int spp = 0;
  double ratio = 0.0;
  double low = 0.0;  // NaN for a single repetition
  double high = 0.0;
};
/// One entry for each method other than `base` and each budget both ran; a repetition without a finite efficiency makes it NaN.
[[nodiscard]] std::vector<Ratio> ratios(std::span<const Run> runs, const std::string& base);

/// log relMSE = log c + slope x log seconds by least squares over a method's budgets: -1 for independent samples, steeper for
/// points that cover better. None for fewer than two budgets with finite logarithms, or for equal times.
struct PowerLaw {
  double factor = 0.0;  // relMSE at one second
  double slope = 0.0;
};
[[nodiscard]] std::optional<PowerLaw> fit(std::span<const Budget> budgets, const std::string& method);

}  // namespace plumbline::study
