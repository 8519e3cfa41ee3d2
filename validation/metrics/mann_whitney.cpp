#include "validation/metrics/mann_whitney.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "reference/base/error.hpp"

namespace plumbline::metrics {
namespace {

constexpr std::size_t kMostExact = 64;

// The number of ways in which n values of one sample and m of another can lie with U = u is the coefficient of q^u in the
// Gaussian binomial
//   prod_{i = 1 .. n} (1 - q^(m + i)) / (1 - q^i)
// (Mann and Whitney 1947). Each factor is applied to the polynomial in place; below 2^53 ways all are exact, above them
// double's relative rounding of 1e-16 a step stays.
std::vector<double> ways(std::size_t n, std::size_t m) {
  std::vector<double> count(n * m + 1, 0.0);
  count[0] = 1.0;
  for (std::size_t i = 1; i <= n; ++i) {
    for (std::size_t u = n * m; u + 1 > m + i; --u) count[u] -= count[u - m - i];
    for (std::size_t u = i; u <= n * m; ++u) count[u] += count[u - i];
  }
  return count;
}

double exact_p(double statistic, std::size_t n, std::size_t m) {
  const std::vector<double> count = ways(n, m);
  double above = 0.0;
  double all = 0.0;
  for (std::size_t u = 0; u < count.size(); ++u) {
    all += count[u];
    if (static_cast<double>(u) >= statistic) above += count[u];
  }
  return above / all;
}

// sum over groups of tied values of t^3 - t.
double tie_sum(std::span<const double> a, std::span<const double> b) {
  std::map<double, double> groups;
  for (const double value : a) ++groups[value];
  for (const double value : b) ++groups[value];
  double sum = 0.0;
  for (const auto& [value, size] : groups) sum += size * size * size - size;
  return sum;
}

// Var U = nm/12 ((N + 1) - ties / (N (N - 1))), N = n + m.
double normal_p(double statistic, double n, double m, double ties) {
  const double total = n + m;
  const double variance = n * m / 12.0 * (total + 1.0 - ties / (total * (total - 1.0)));
  if (!(variance > 0.0)) return 1.0;  // all values are the same
  const double z = (statistic - 0.5 * n * m - 0.5) / std::sqrt(variance);
  return 0.5 * std::erfc(z / std::sqrt(2.0));
}

}  // namespace

TestResult mann_whitney_greater(std::span<const double> a, std::span<const double> b) {
  if (a.empty() || b.empty()) throw InputError("mann_whitney_greater: needs values on both sides, has none");
  const auto is_nan = [](double value) { return std::isnan(value); };
  if (std::any_of(a.begin(), a.end(), is_nan) || std::any_of(b.begin(), b.end(), is_nan)) return {0.0, 1.0};
  double statistic = 0.0;
  for (const double x : a) {
    for (const double y : b) statistic += x > y ? 1.0 : x == y ? 0.5 : 0.0;
  }
  const double ties = tie_sum(a, b);
  const bool is_exact = ties == 0.0 && std::max(a.size(), b.size()) <= kMostExact;
  return {statistic,
          is_exact ? exact_p(statistic, a.size(), b.size())
                   : normal_p(statistic, static_cast<double>(a.size()), static_cast<double>(b.size()), ties)};
}

}  // namespace plumbline::metrics
