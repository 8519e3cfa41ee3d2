// validation/checks/verdicts.hpp: from numbers to verdicts, in the three ways the checks use.
#pragma once

#include <string>

#include "validation/checks/finding.hpp"
#include "validation/metrics/statistics.hpp"

namespace plumbline::checks {

struct Label {
  std::string family;
  std::string name;
  std::string source;  // where the bound comes from
  std::string detail;  // what to read off it
};

/// A deterministic error against its bound: pass when error <= bound. NaN fails.
[[nodiscard]] Finding judge_error(const Label& label, double error, double bound);

/// A measured deviation from 0 with its standard error, at this significance: fails when |deviation| exceeds `allowance` (known model error) by
/// more than chance explains; inconclusive when the test could not have seen a deviation of `resolution` (power 90 %).
[[nodiscard]] Finding judge_deviation(const Label& label, const metrics::Estimate& deviation,
                                      double allowance, double resolution, double significance);

/// The largest of `count` independent |z| against the limit that chance exceeds with probability `significance` in all.
/// @param degrees_of_freedom  of the standard errors behind the z (Student-t); 0 = normal
[[nodiscard]] Finding judge_largest_z(const Label& label, double largest_z, std::size_t count,
                                      double degrees_of_freedom, double significance);

}  // namespace plumbline::checks
