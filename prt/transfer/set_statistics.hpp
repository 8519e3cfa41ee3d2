// prt/transfer/set_statistics.hpp: mean and standard error over independent sets of directions.
#pragma once

#include <cstddef>
#include <vector>

namespace plumbline::transfer {

/// Independent sets of directions that a bake draws at a point unless told otherwise; the spread of their results is the
/// standard error.
inline constexpr int kSets = 16;

/// Means of many numbers over sets, and their standard errors (0 of a single set: unknown).
struct SetStatistics {
  std::vector<double> mean;
  std::vector<double> standard_errors;
};

/// Which sets' spread is asked for.
enum class Half { all, even, odd };

/// Standard error of the mean over *all* sets, as the spread of some of them tells it.
/// @param values  [set][size]; index i of each is looked at
[[nodiscard]] double standard_error(const std::vector<double>& values, std::size_t size, std::size_t i,
                                    Half half);

/// @param sums  [set][size]: sums over `count` directions each
[[nodiscard]] SetStatistics statistics_of(const std::vector<double>& sums, std::size_t size, double count,
                                          Half half);

}  // namespace plumbline::transfer
