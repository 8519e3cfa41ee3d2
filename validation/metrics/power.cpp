#include "validation/metrics/power.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/non_central_t.hpp>
#include <cmath>
#include <span>
#include <vector>

#include "reference/base/error.hpp"
#include "validation/metrics/statistics.hpp"

namespace plumbline::metrics {
namespace {

void require(bool holds, const char* where, const char* relation, double actual) {
  if (!holds) throw InputError(fmt::format("{}: {}, is {}", where, relation, actual));
}

void require_open_unit(double value, const char* where) {
  require(value > 0.0 && value < 1.0, where, "must be in (0, 1)", value);
}

}  // namespace

// Beyond 38 standard errors no double is left of the chance to miss: Boost's series need not be asked.
double student_power(double shift, double significance, double degrees_of_freedom) {
  constexpr double kCertain = 38.0;
  require_open_unit(significance, "student_power: significance");
  require(degrees_of_freedom > 0.0, "student_power: degrees_of_freedom", "must be > 0", degrees_of_freedom);
  require(std::isfinite(shift), "student_power: shift", "must be finite", shift);
  if (shift == 0.0) return significance;
  const double limit = two_sided_t(significance, degrees_of_freedom);
  if (std::abs(shift) > kCertain + limit) return 1.0;
  const boost::math::non_central_t shifted(degrees_of_freedom, std::abs(shift));
  return cdf(complement(shifted, limit)) + cdf(shifted, -limit);
}

namespace {

// Nodes of a midpoint rule in probability for s, s^2 = chi^2_nu / nu: an estimate's spread over the true one.
std::vector<double> spreads(double degrees_of_freedom) {
  constexpr int kSteps = 500;
  const boost::math::chi_squared law(degrees_of_freedom);
  std::vector<double> result;
  for (int i = 0; i < kSteps; ++i)
    result.push_back(std::sqrt(quantile(law, (i + 0.5) / kSteps) / degrees_of_freedom));
  return result;
}

// s is independent of the mean: P = E_s max(0, Phi(margin - t s - shift) - Phi(-margin + t s - shift)).
double equivalence_power(double shift, double margin, double t, std::span<const double> spread) {
  const auto phi = [](double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); };
  double sum = 0.0;
  for (const double s : spread) {
    const double room = margin - t * s;
    if (room > 0.0) sum += phi(room - shift) - phi(-room - shift);
  }
  return sum / static_cast<double>(spread.size());
}

void require_alpha(double alpha, const char* where) {
  require(alpha > 0.0 && alpha < 0.5, where, "must be in (0, 0.5)", alpha);
}

}  // namespace

double equivalence_power(double shift, double margin, double alpha, double degrees_of_freedom) {
  require(std::isfinite(shift), "equivalence_power: shift", "must be finite", shift);
  require(margin >= 0.0, "equivalence_power: margin", "must be >= 0", margin);
  require_alpha(alpha, "equivalence_power: alpha");
  const double t = two_sided_t(2.0 * alpha, degrees_of_freedom);
  return equivalence_power(shift, margin, t, spreads(degrees_of_freedom));
}

double largest_standard_error(double alpha, double power, double degrees_of_freedom) {
  require_open_unit(power, "largest_standard_error: power");
  require_alpha(alpha, "largest_standard_error: alpha");
  const double t = two_sided_t(2.0 * alpha, degrees_of_freedom);
  const std::vector<double> spread = spreads(degrees_of_freedom);
  double low = 0.0;  // margins, in standard errors: too small …
  double high = 1.0;
  while (equivalence_power(0.0, high, t, spread) < power) {
    low = high;
    high *= 2.0;
  }
  for (int step = 0; step < 30; ++step) {
    const double middle = 0.5 * (low + high);
    (equivalence_power(0.0, middle, t, spread) < power ? low : high) = middle;
  }
  return 1.0 / high;
}

double spread_bound(double confidence, double degrees_of_freedom) {
  require_open_unit(confidence, "spread_bound: confidence");
  require(degrees_of_freedom > 0.0, "spread_bound: degrees_of_freedom", "must be > 0", degrees_of_freedom);
  const boost::math::chi_squared distribution(degrees_of_freedom);
  return std::sqrt(degrees_of_freedom / quantile(distribution, 1.0 - confidence));
}

Proportion proportion(std::size_t successes, std::size_t trials, double significance) {
  require(trials > 0, "proportion: trials", "must be > 0", static_cast<double>(trials));
  require(successes <= trials, "proportion: successes", "must be at most trials",
          static_cast<double>(successes));
  require_open_unit(significance, "proportion: significance");
  using Law = boost::math::binomial;
  const auto n = static_cast<double>(trials);
  const auto k = static_cast<double>(successes);
  return {k / n, Law::find_lower_bound_on_p(n, k, significance / 2.0),
          Law::find_upper_bound_on_p(n, k, significance / 2.0)};
}

double binomial_p(std::size_t successes, std::size_t trials, double probability) {
  require(trials > 0, "binomial_p: trials", "must be > 0", static_cast<double>(trials));
  require(successes <= trials, "binomial_p: successes", "must be at most trials",
          static_cast<double>(successes));
  require_open_unit(probability, "binomial_p: probability");
  const boost::math::binomial law(static_cast<double>(trials), probability);
  const auto k = static_cast<double>(successes);
  const double below = cdf(law, k);
  const double above = successes == 0 ? 1.0 : cdf(complement(law, k - 1.0));
  return std::min(1.0, 2.0 * std::min(below, above));
}

}  // namespace plumbline::metrics
