// prt/transfer/set_statistics.hpp: mean and standard error over independent sets of directions.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace plumbline::transfer {

/// Independent sets of directions that a bake draws at a point; the spread of their results is the standard error.
inline constexpr int kSets = 16;

/// Welford's mean and sum of squared deviations for many numbers at a time.
struct SetStatistics {
  std::vector<double> mean;
  std::vector<double> squares;
  int sets = 0;

  explicit SetStatistics(std::size_t size) : mean(size, 0.0), squares(size, 0.0) {}

  void add(std::span<const double> values, double scale) {
    ++sets;
    for (std::size_t i = 0; i < mean.size(); ++i) {
      const double value = scale * values[i];
      const double difference = value - mean[i];
      mean[i] += difference / sets;
      squares[i] += difference * (value - mean[i]);
    }
  }
  /// Of the mean; two sets or more.
  [[nodiscard]] double standard_error(std::size_t i) const {
    return std::sqrt(squares[i] / (static_cast<double>(sets) * (sets - 1)));
  }
};

}  // namespace plumbline::transfer
