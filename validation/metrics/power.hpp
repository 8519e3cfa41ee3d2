// validation/metrics/power.hpp: what a test can see, and how often it was right. The distributions are Boost.Math's.
#pragma once

#include <cstddef>

namespace plumbline::metrics {

/// Probability that a two-sided Student test of this significance rejects a mean that is `shift` standard errors
/// away: P(|T'| > t) with T' noncentral Student-t of that many degrees of freedom and noncentrality `shift`.
/// shift = 0: the significance itself. @throws InputError unless significance is in (0, 1),
/// degrees_of_freedom > 0 and shift is finite.
[[nodiscard]] double student_power(double shift, double significance, double degrees_of_freedom);

/// Probability that two one-sided Student tests of significance alpha call an estimate equivalent whose bias is
/// `shift` and whose margin is `margin`, both in standard errors (of the truth, not of the estimate):
///   P(|T_bias| + t_alpha s <= margin), s the estimate's relative spread, chi-distributed.
/// Numerical integration over s, good to 1e-3. @throws InputError as above, and for a margin below 0.
[[nodiscard]] double equivalence_power(double shift, double margin, double alpha, double degrees_of_freedom);

/// The largest standard error, in units of the margin, at which an unbiased estimate passes two one-sided tests
/// with probability `power`. @throws InputError unless alpha is in (0, 0.5) and power in (0, 1).
[[nodiscard]] double largest_standard_error(double alpha, double power, double degrees_of_freedom);

/// Upper bound, with this confidence, of a standard deviation over its estimate: sqrt(nu / chi^2_(1 - confidence)).
/// @throws InputError unless confidence is in (0, 1) and degrees_of_freedom > 0.
[[nodiscard]] double spread_bound(double confidence, double degrees_of_freedom);

/// A proportion with its exact interval (Clopper and Pearson 1934).
struct Proportion {
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;
};
/// @param significance  1 - confidence. @throws InputError unless 0 <= successes <= trials, trials > 0 and
/// significance is in (0, 1).
[[nodiscard]] Proportion proportion(std::size_t successes, std::size_t trials, double significance);

/// Two-sided p of a count under a binomial law: twice the smaller tail, at most 1.
/// @throws InputError unless successes <= trials, trials > 0 and probability is in (0, 1).
[[nodiscard]] double binomial_p(std::size_t successes, std::size_t trials, double probability);

}  // namespace plumbline::metrics
