#include "validation/metrics/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "reference/base/error.hpp"
#include "reference/base/vector.hpp"

namespace plumbline::metrics {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

void require(bool holds, const char* where, const char* relation, double actual) {
  if (!holds) throw InputError(fmt::format("{}: {}, is {}", where, relation, actual));
}

// Q(x) = P(K > x) of Kolmogorov's distribution. Two series for the same theta function, each used where a few
// terms reach double precision:
//   x large:  Q = 2 sum_{j >= 1} (-1)^(j-1) exp(-2 j^2 x^2)
//   x small:  Q = 1 - sqrt(2 pi) / x sum_{j >= 1} exp(-(2j - 1)^2 pi^2 / (8 x^2))
// At the switch x = 1 the ratios of successive terms are e^-6 and e^-9.9.
double kolmogorov_complement(double x) {
  if (x <= 0.0) return 1.0;
  double sum = 0.0;
  if (x < 1.0) {
    for (int j = 1; j <= 9; j += 2) sum += std::exp(-j * j * kPi * kPi / (8.0 * x * x));
    return 1.0 - std::sqrt(2.0 * kPi) / x * sum;
  }
  for (int j = 1; j <= 5; ++j) sum += (j % 2 == 1 ? 2.0 : -2.0) * std::exp(-2.0 * j * j * x * x);
  return sum;
}

struct Bin {
  double observed = 0.0;
  double expected = 0.0;
};

// Left to right; what is left over at the end goes into the last full bin.
std::vector<Bin> pool(std::span<const double> observed, std::span<const double> expected) {
  constexpr double kLeastExpected = 5.0;
  std::vector<Bin> pooled;
  Bin open;
  for (std::size_t i = 0; i < observed.size(); ++i) {
    require(expected[i] >= 0.0 && std::isfinite(expected[i]), "chi_squared: expected",
            "must be finite and not negative", expected[i]);
    open.observed += observed[i];
    open.expected += expected[i];
    if (open.expected >= kLeastExpected) {
      pooled.push_back(open);
      open = {};
    }
  }
  if (!pooled.empty()) {
    pooled.back().observed += open.observed;
    pooled.back().expected += open.expected;
  }
  return pooled;
}

}  // namespace

void RunningMoments::add(double value) {
  ++count_;
  const double step = value - mean_;
  mean_ += step / static_cast<double>(count_);
  squares_ += step * (value - mean_);
}

// With n = n_a + n_b and d = mean_b - mean_a:
//   mean = mean_a + d n_b / n,   squares = squares_a + squares_b + d^2 n_a n_b / n.
void RunningMoments::merge(const RunningMoments& other) {
  if (other.count_ == 0) return;
  const auto ours = static_cast<double>(count_);
  const auto theirs = static_cast<double>(other.count_);
  const double distance = other.mean_ - mean_;
  mean_ += distance * theirs / (ours + theirs);
  squares_ += other.squares_ + distance * distance * ours * theirs / (ours + theirs);
  count_ += other.count_;
}

double RunningMoments::variance() const {
  require(count_ >= 2, "RunningMoments", "needs at least 2 values", static_cast<double>(count_));
  return squares_ / static_cast<double>(count_ - 1);
}

Estimate RunningMoments::estimate() const {
  return {mean_, std::sqrt(variance() / static_cast<double>(count_))};
}

Estimate estimate(std::span<const double> values) {
  require(values.size() >= 2, "estimate", "needs at least 2 values", static_cast<double>(values.size()));
  RunningMoments moments;
  for (const double value : values) moments.add(value);
  return moments.estimate();
}

double two_sided_p(double z) {
  if (std::isnan(z)) return 0.0;
  return std::erfc(std::abs(z) / std::sqrt(2.0));
}

double two_sided_p_student(double t, double degrees_of_freedom) {
  require(degrees_of_freedom > 0.0, "two_sided_p_student: degrees_of_freedom", "must be > 0",
          degrees_of_freedom);
  if (!std::isfinite(t)) return 0.0;
  const boost::math::students_t distribution(degrees_of_freedom);
  return 2.0 * cdf(complement(distribution, std::abs(t)));
}

double two_sided_z(double p) {
  require(p >= 0.0 && p <= 1.0, "two_sided_z: p", "must be in [0, 1]", p);
  if (p == 0.0) return kInfinity;
  return quantile(complement(boost::math::normal(), p / 2.0));
}

double two_sided_t(double p, double degrees_of_freedom) {
  require(p >= 0.0 && p <= 1.0, "two_sided_t: p", "must be in [0, 1]", p);
  require(degrees_of_freedom > 0.0, "two_sided_t: degrees_of_freedom", "must be > 0", degrees_of_freedom);
  if (p == 0.0) return kInfinity;
  return quantile(complement(boost::math::students_t(degrees_of_freedom), p / 2.0));
}

double sidak(double family, std::size_t tests) {
  require(family >= 0.0 && family <= 1.0, "sidak: family", "must be in [0, 1]", family);
  require(tests > 0, "sidak: tests", "must be > 0", static_cast<double>(tests));
  return -std::expm1(std::log1p(-family) / static_cast<double>(tests));  // exact for tiny probabilities
}

double detectable_shift(double standard_error, double significance, double power) {
  require(standard_error >= 0.0, "detectable_shift: standard_error", "must be >= 0", standard_error);
  require(significance > 0.0 && significance < 1.0, "detectable_shift: significance", "must be in (0, 1)",
          significance);
  require(power > 0.0 && power < 1.0, "detectable_shift: power", "must be in (0, 1)", power);
  return (two_sided_z(significance) + quantile(boost::math::normal(), power)) * standard_error;
}

// D = sup |F_n(x) - x|; sqrt(n) D tends to Kolmogorov's distribution, and (sqrt n + 0.12 + 0.11 / sqrt n) D
// is close to it already for small n (Stephens, "EDF Statistics for Goodness of Fit and Some Comparisons",
// 1974).
TestResult kolmogorov_smirnov_uniform(std::span<const double> values) {
  require(!values.empty(), "kolmogorov_smirnov_uniform", "needs values", 0.0);
  std::vector<double> sorted(values.begin(), values.end());
  if (std::any_of(sorted.begin(), sorted.end(), [](double v) { return std::isnan(v); })) return {1.0, 0.0};
  std::sort(sorted.begin(), sorted.end());
  const auto n = static_cast<double>(sorted.size());
  double distance = 0.0;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const double uniform = std::clamp(sorted[i], 0.0, 1.0);
    const double below = static_cast<double>(i) / n;
    const double above = static_cast<double>(i + 1) / n;
    distance = std::max({distance, uniform - below, above - uniform});
  }
  const double root = std::sqrt(n);
  return {distance, kolmogorov_complement((root + 0.12 + 0.11 / root) * distance)};
}

TestResult chi_squared(std::span<const double> observed, std::span<const double> expected) {
  if (observed.size() != expected.size()) {
    throw InputError(fmt::format("chi_squared: observed and expected must have one size, are {} and {}",
                                 observed.size(), expected.size()));
  }
  const std::vector<Bin> bins = pool(observed, expected);
  require(bins.size() >= 2, "chi_squared: bins that expect at least 5", "must be at least 2",
          static_cast<double>(bins.size()));
  double statistic = 0.0;
  for (const Bin& bin : bins) {
    const double difference = bin.observed - bin.expected;
    statistic += difference * difference / bin.expected;
  }
  if (!std::isfinite(statistic)) return {statistic, 0.0};
  const boost::math::chi_squared distribution(static_cast<double>(bins.size() - 1));
  return {statistic, cdf(complement(distribution, statistic))};
}

// Degrees of freedom by Welch and Satterthwaite: (A + B)^2 / (A^2 / (n1 - 1) + B^2 / (n2 - 1)) with A, B the
// squared standard errors; written with A / (A + B), which neither overflows nor underflows.
TestResult welch(const Estimate& a, std::size_t n1, const Estimate& b, std::size_t n2) {
  require(n1 >= 2, "welch: n1", "must be at least 2", static_cast<double>(n1));
  require(n2 >= 2, "welch: n2", "must be at least 2", static_cast<double>(n2));
  const double difference = a.mean - b.mean;
  const double error = std::hypot(a.standard_error, b.standard_error);
  if (error == 0.0 && difference == 0.0) return {0.0, 1.0};
  const double t = difference / error;
  if (!std::isfinite(t)) return {t, 0.0};
  const double share = (a.standard_error / error) * (a.standard_error / error);
  const double degrees_of_freedom = 1.0 / (share * share / static_cast<double>(n1 - 1) +
                                           (1.0 - share) * (1.0 - share) / static_cast<double>(n2 - 1));
  if (!std::isfinite(degrees_of_freedom)) return {t, 0.0};  // an infinite standard error proves nothing
  return {t, two_sided_p_student(t, degrees_of_freedom)};
}

bool equivalent(const Estimate& estimate, double expected, double margin, double alpha) {
  require(alpha > 0.0 && alpha < 0.5, "equivalent: alpha", "must be in (0, 0.5)", alpha);
  if (!(estimate.standard_error > 0.0)) return false;
  const double reach = two_sided_z(2.0 * alpha) * estimate.standard_error;
  return std::abs(estimate.mean - expected) + reach <= margin;
}

}  // namespace plumbline::metrics
