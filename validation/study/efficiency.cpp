#include "validation/study/efficiency.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "validation/metrics/statistics.hpp"

namespace plumbline::study {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kOutside = 0.05;  // of a 95 % interval

struct Interval {
  double mean = 0.0;
  double half_width = 0.0;  // NaN for a single value
};

Interval student_interval(const std::vector<double>& values) {
  if (values.size() < 2) return {values.front(), kNan};
  const metrics::Estimate estimate = metrics::estimate(values);
  return {estimate.mean,
          metrics::two_sided_t(kOutside, static_cast<double>(values.size() - 1)) * estimate.standard_error};
}

Budget budget_of(std::span<const Run> runs, const std::string& method, int spp) {
  std::vector<double> seconds;
  std::vector<double> errors;
  for (const Run& run : runs) {
    if (run.method != method || run.spp != spp) continue;
    seconds.push_back(run.seconds);
    errors.push_back(run.relmse);
  }
  const Interval error = student_interval(errors);
  Budget budget{method, spp, static_cast<int>(errors.size())};
  budget.seconds = student_interval(seconds).mean;
  budget.relmse = error.mean;
  budget.relmse_low = error.mean - error.half_width;
  budget.relmse_high = error.mean + error.half_width;
  budget.efficiency = efficiency(budget.relmse, budget.seconds);
  return budget;
}

void mark_front(std::vector<Budget>& all) {
  for (Budget& one : all) {
    one.is_on_front = std::none_of(all.begin(), all.end(), [&](const Budget& other) {
      const bool is_no_worse = other.seconds <= one.seconds && other.relmse <= one.relmse;
      return is_no_worse && (other.seconds < one.seconds || other.relmse < one.relmse);
    });
  }
}

const Run* partner(std::span<const Run> runs, const std::string& method, const Run& run) {
  const auto found = std::find_if(runs.begin(), runs.end(), [&](const Run& other) {
    return other.method == method && other.spp == run.spp && other.repetition == run.repetition;
  });
  return found == runs.end() ? nullptr : &*found;
}

}  // namespace

double efficiency(double relmse, double seconds) {
  return relmse > 0.0 && seconds > 0.0 ? 1.0 / (relmse * seconds) : kNan;
}

std::vector<Budget> budgets(std::span<const Run> runs) {
  std::vector<Budget> result;
  for (const Run& run : runs) {
    const bool is_known = std::any_of(result.begin(), result.end(), [&](const Budget& budget) {
      return budget.method == run.method && budget.spp == run.spp;
    });
    if (!is_known) result.push_back(budget_of(runs, run.method, run.spp));
  }
  mark_front(result);
  return result;
}

std::vector<Ratio> ratios(std::span<const Run> runs, const std::string& base) {
  std::vector<Ratio> result;
  for (const Budget& budget : budgets(runs)) {
    if (budget.method == base) continue;
    std::vector<double> logarithms;
    for (const Run& run : runs) {
      if (run.method != budget.method || run.spp != budget.spp) continue;
      const Run* other = partner(runs, base, run);
      if (other == nullptr) continue;
      logarithms.push_back(
          std::log(efficiency(run.relmse, run.seconds) / efficiency(other->relmse, other->seconds)));
    }
    if (logarithms.empty()) continue;
    const Interval interval = student_interval(logarithms);
    result.push_back({budget.method, base, budget.spp, std::exp(interval.mean),
                      std::exp(interval.mean - interval.half_width),
                      std::exp(interval.mean + interval.half_width)});
  }
  return result;
}

// The slope is S_xy / S_xx about the means of the logarithms.
std::optional<PowerLaw> fit(std::span<const Budget> all, const std::string& method) {
  std::vector<double> x;
  std::vector<double> y;
  for (const Budget& budget : all) {
    if (budget.method != method || !(budget.relmse > 0.0) || !(budget.seconds > 0.0)) continue;
    x.push_back(std::log(budget.seconds));
    y.push_back(std::log(budget.relmse));
  }
  if (x.size() < 2) return std::nullopt;
  const double mean_x = metrics::estimate(x).mean;
  const double mean_y = metrics::estimate(y).mean;
  double squares = 0.0;
  double products = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    squares += (x[i] - mean_x) * (x[i] - mean_x);
    products += (x[i] - mean_x) * (y[i] - mean_y);
  }
  if (!(squares > 0.0)) return std::nullopt;
  const double slope = products / squares;
  return PowerLaw{std::exp(mean_y - slope * mean_x), slope};
}

}  // namespace plumbline::study
