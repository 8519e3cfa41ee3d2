#include "prt/transfer/set_statistics.hpp"

#include <cmath>

namespace plumbline::transfer {
namespace {

// First set and step.
struct Sets {
  int first;
  int step;
};

Sets sets_of(Half half) {
  return half == Half::all ? Sets{0, 1} : Sets{half == Half::even ? 0 : 1, 2};
}

}  // namespace

double standard_error(const std::vector<double>& values, std::size_t size, std::size_t i, Half half) {
  const Sets sets = sets_of(half);
  const auto all = static_cast<int>(values.size() / size);
  const auto value = [&](int set) { return values[static_cast<std::size_t>(set) * size + i]; };
  double sum = 0.0;
  int count = 0;
  for (int set = sets.first; set < all; set += sets.step, ++count) sum += value(set);
  const double mean = sum / count;
  double squares = 0.0;
  for (int set = sets.first; set < all; set += sets.step)
    squares += (value(set) - mean) * (value(set) - mean);
  return count > 1 ? std::sqrt(squares / (static_cast<double>(count - 1) * all)) : 0.0;
}

SetStatistics statistics_of(const std::vector<double>& sums, std::size_t size, double count, Half half) {
  const std::size_t sets = sums.size() / size;
  SetStatistics result{std::vector<double>(size), std::vector<double>(size)};
  for (std::size_t i = 0; i < size; ++i) {
    double sum = 0.0;
    for (std::size_t set = 0; set < sets; ++set) sum += sums[set * size + i];
    result.mean[i] = sum / (static_cast<double>(sets) * count);
    result.standard_errors[i] = standard_error(sums, size, i, half) / count;
  }
  return result;
}

}  // namespace plumbline::transfer
