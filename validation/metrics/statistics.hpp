// validation/metrics/statistics.hpp: the judge's arithmetic of chance.
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

/// Probability of a standard normal (or Student-t) variable beyond |z| on both sides. NaN in, 0 out: NaN is
/// never innocent.
[[nodiscard]] double two_sided_p(double z);
[[nodiscard]] double two_sided_p_student(double t, double degrees_of_freedom);
/// z with P(|Z| > z) = p.
[[nodiscard]] double two_sided_z(double p);

/// Per-test significance so that `tests` independent tests together raise a false alarm with probability
/// `family`: Sidak.
[[nodiscard]] double sidak(double family, std::size_t tests);

struct TestResult {
  double statistic = 0.0;
  double p = 0.0;
};
/// Kolmogorov-Smirnov distance of values from the uniform distribution on [0, 1], with the asymptotic p.
[[nodiscard]] TestResult kolmogorov_smirnov_uniform(std::span<const double> values);
/// Pearson's chi-squared over bins; neighbouring bins are pooled until each expects at least 5.
[[nodiscard]] TestResult chi_squared(std::span<const double> observed, std::span<const double> expected);
/// Welch's t of two estimates with n1 and n2 values.
[[nodiscard]] TestResult welch(const Estimate& a, std::size_t n1, const Estimate& b, std::size_t n2);

/// Two one-sided tests: true when the 1 - 2 alpha confidence interval of the estimate lies inside expected +-
/// margin. False for NaN and for a standard error of 0 with no samples behind it.
[[nodiscard]] bool equivalent(const Estimate& estimate, double expected, double margin, double alpha);

}  // namespace plumbline::metrics
