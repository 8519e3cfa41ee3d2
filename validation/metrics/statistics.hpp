// validation/metrics/statistics.hpp: the judge's arithmetic of chance.
// The distributions are Boost.Math's. NaN is never innocent: it gives p = 0, and no statistic hides it.
#pragma once

#include <cstddef>
#include <span>

namespace plumbline::metrics {

/// A mean with its standard error.
struct Estimate {
  double mean = 0.0;
  double standard_error = 0.0;
};
/// Mean and standard error of independent, identically distributed values. @throws InputError for fewer
/// than 2.
[[nodiscard]] Estimate estimate(std::span<const double> values);

/// Count, mean and spread of values that come one at a time, without keeping them (Welford 1962); two of them
/// merge into the moments of all their values (Chan, Golub and LeVeque 1979). NaN stays NaN.
class RunningMoments {
 public:
  void add(double value);
  void merge(const RunningMoments& other);

  [[nodiscard]] std::size_t count() const { return count_; }
  /// 0 before the first value.
  [[nodiscard]] double mean() const { return mean_; }
  /// Unbiased, sum (x - mean)^2 / (count - 1). @throws InputError for fewer than 2 values.
  [[nodiscard]] double variance() const;
  /// The mean with sqrt(variance / count). @throws InputError for fewer than 2 values.
  [[nodiscard]] Estimate estimate() const;

 private:
  std::size_t count_ = 0;
  double mean_ = 0.0;
  double squares_ = 0.0;  // sum of (x - mean)^2
};

/// Probability of a standard normal (or Student-t) variable beyond |z| on both sides. NaN in, 0 out: NaN is
/// never innocent. @throws InputError unless degrees_of_freedom > 0.
[[nodiscard]] double two_sided_p(double z);
[[nodiscard]] double two_sided_p_student(double t, double degrees_of_freedom);
/// z with P(|Z| > z) = p, for p in [0, 1] (p = 0 gives infinity). @throws InputError for any other p.
[[nodiscard]] double two_sided_z(double p);
/// t with P(|T| > t) = p for a Student-t variable T: the half width of a 1 - p interval in standard errors.
/// @throws InputError unless p is in [0, 1] and degrees_of_freedom > 0.
[[nodiscard]] double two_sided_t(double p, double degrees_of_freedom);

/// Per-test significance so that `tests` independent tests together raise a false alarm with probability
/// `family`: Sidak, 1 - (1 - family)^(1 / tests). @throws InputError unless family is in [0, 1] and tests >
/// 0.
[[nodiscard]] double sidak(double family, std::size_t tests);

/// The smallest shift of a mean that a two-sided z test with this standard error and significance finds with
/// probability `power`: (z_{1 - significance / 2} + z_power) standard errors.
/// @throws InputError unless significance and power are in (0, 1) and standard_error >= 0.
[[nodiscard]] double detectable_shift(double standard_error, double significance, double power);

struct TestResult {
  double statistic = 0.0;
  double p = 0.0;
};
/// Kolmogorov-Smirnov distance of values from the uniform distribution on [0, 1], with the asymptotic p and
/// Stephens' correction for small samples. A NaN among them gives p = 0. @throws InputError for no values.
[[nodiscard]] TestResult kolmogorov_smirnov_uniform(std::span<const double> values);
/// Pearson's chi-squared over bins; neighbouring bins are pooled until each expects at least 5. The degrees
/// of freedom are pooled bins - 1 (the totals are meant to agree; where they do not, the statistic shows it).
/// @throws InputError when sizes differ, an expectation is negative or not finite, or fewer than 2 pooled
/// bins are left: such a test could not fail.
[[nodiscard]] TestResult chi_squared(std::span<const double> observed, std::span<const double> expected);
/// Welch's t of two estimates with n1 and n2 values, a.mean - b.mean over its standard error. Both standard
/// errors 0: statistic 0 and p = 1 for equal means, else +-infinity and p = 0. @throws InputError for n < 2.
[[nodiscard]] TestResult welch(const Estimate& a, std::size_t n1, const Estimate& b, std::size_t n2);

/// Two one-sided tests: true when the 1 - 2 alpha confidence interval of the estimate lies inside expected +-
/// margin. False for NaN and for a standard error of 0 with no samples behind it: as the estimate does not
/// say what is behind it, for every standard error that is not above 0 (compare exact values directly).
/// @throws InputError unless alpha is in (0, 0.5).
[[nodiscard]] bool equivalent(const Estimate& estimate, double expected, double margin, double alpha);

}  // namespace plumbline::metrics
