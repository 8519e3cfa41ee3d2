// validation/regression/baseline.hpp: what an earlier run found, kept in a file, and what has changed since.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "validation/checks/finding.hpp"

namespace plumbline::regression {

/// A number that says what comes out, not how wrong it is: radiance, coefficients. A change of scene, light or code
/// shows in it even where method and truth change together.
struct Quantity {
  std::string name;
  double mean = 0.0;
  double standard_error = 0.0;  // of `count` independent values
  std::size_t count = 0;        // 0: computed exactly
  double tolerance = 0.0;  // exact ones, and those whose standard errors are below it, may differ by this
};

/// Repeated times of one piece of code.
struct KernelTimes {
  std::string name;
  std::vector<double> seconds;
};

/// Why and when a baseline was last made anew.
struct Revision {
  std::string date;
  std::string version;
  std::string reason;
};

struct Baseline {
  std::string command;  // without seed, outputs and threads: what both runs must share
  std::uint64_t seed = 0;
  std::map<std::string, std::string> machine;
  std::vector<checks::Finding> findings;
  std::vector<Quantity> quantities;
  std::vector<KernelTimes> times;  // empty: not measured
  std::vector<Revision> history;   // the latest last
};

/// @throws InputError naming the file and what is wrong with it.
[[nodiscard]] Baseline read_baseline(const std::filesystem::path& path);
[[nodiscard]] std::string to_json(const Baseline& baseline);

struct CompareSettings {
  double significance = 1e-4;  // chance that anything at all is reported between two runs of the same
  double margin = 5e-3;        // relative change of a quantity that must not go unseen
  double slow_down = 0.10;     // times may grow by this share before it counts
};

/// What has changed, as findings of the family "baseline": `fail` for what got worse or is no longer there.
///
/// - quantities: exact ones by their tolerance; others by Welch's t test, both sides, and where it finds nothing two
///   one-sided tests: `pass` when the change is shown to be below the margin, else `inconclusive`.
/// - findings: a verdict that got worse; an error that grew beyond what both uncertainties explain, one-sided; an
///   error without uncertainty that grew by more than a tenth of its bound (with equal seeds only).
/// - times: Mann and Whitney's test of the new times against the old ones times 1 + slow_down. Of another machine, or
///   fewer than 9 repetitions: said, and never judged.
///
/// All tests together raise a false alarm with probability `significance` (Sidak).
/// @throws InputError when the two runs are not of the same command.
[[nodiscard]] std::vector<checks::Finding> compare(const Baseline& before, const Baseline& now,
                                                   const CompareSettings& settings);

}  // namespace plumbline::regression
