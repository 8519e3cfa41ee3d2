#include "validation/checks/truths_calibration.hpp"

#include <algorithm>
#include <cmath>

#include "reference/base/parallel.hpp"

namespace plumbline::checks {
namespace {

enum Purpose : std::uint64_t { kPValue = 11, kPilot, kSpread, kDetect, kFirst, kSecond };

double scale_of(const TruthCase& one) {
  return std::abs(one.scale != 0.0 ? one.scale : one.truth);
}

/// `count` estimates, each with a seed of its own; they run side by side, each on one thread.
std::vector<Measurement> estimates(const TruthCase& one, const Estimator& estimator, const Effort& effort,
                                   std::size_t count, std::uint64_t purpose) {
  std::vector<Measurement> result(count);
  parallel_for(count, effort.threads, [&](std::size_t i) {
    Effort own = effort;
    own.threads = 1;
    own.seed = truth_seed(effort.seed + i, one.name, purpose);
    result[i] = estimator(own);
  });
  return result;
}

double p_of(const TruthCase& one, const Measurement& m) {
  return metrics::two_sided_p_student((m.mean - one.truth) / m.standard_error, m.degrees_of_freedom);
}

}  // namespace

Measurement biased(Measurement m, double bias) {
  m.mean *= 1.0 + bias;
  m.standard_error *= std::abs(1.0 + bias);
  return m;
}

PValues p_values(std::span<const TruthCase> cases, const PValueBudget& budget) {
  constexpr double kLeastNoise = 20.0 * kRounding;
  PValues result;
  result.seeds = budget.seeds;
  for (const TruthCase& one : cases) {
    if (one.is_noiseless) continue;
    const Estimator estimator = one.prepare();
    Effort effort{std::max(budget.samples, one.pilot_samples / 4), 1,
                  truth_seed(budget.seed, one.name, kPilot), budget.threads};
    // Decided on a run that is not counted.
    if (!(estimator(effort).standard_error > kLeastNoise * scale_of(one))) continue;
    effort.seed = budget.seed;
    ++result.cases;
    for (const Measurement& m : estimates(one, estimator, effort, budget.seeds, kPValue)) {
      result.t.push_back((m.mean - one.truth) / m.standard_error);
      result.freedom.push_back(m.degrees_of_freedom);
    }
  }
  return with_error_factor(std::move(result), 1.0);
}

PValues with_error_factor(PValues p, double factor) {
  p.values.clear();
  for (std::size_t i = 0; i < p.t.size(); ++i) {
    p.t[i] /= factor;
    p.values.push_back(metrics::two_sided_p_student(p.t[i], p.freedom[i]));
  }
  return p;
}

Flatness flatness(const PValues& p) {
  constexpr double kSmall = 0.01;
  Flatness result;
  result.distance = metrics::kolmogorov_smirnov_uniform(p.values);
  for (const double value : p.values) result.below += value < kSmall ? 1U : 0U;
  result.below_p = metrics::binomial_p(result.below, p.values.size(), kSmall);
  return result;
}

bool is_flat(const Flatness& f, double significance) {
  const double each = metrics::sidak(significance, 2);
  return f.distance.p >= each && f.below_p >= each;
}

namespace {

/// Samples for which `found` is found with probability 0.9, by the pilot's spread.
int samples_to_find(const TruthCase& one, const Estimator& estimator, double found,
                    const PowerBudget& budget) {
  constexpr double kPower = 0.9;
  const Effort pilot{one.pilot_samples, 1, budget.seed, budget.threads};
  double variance = 0.0;
  const std::vector<Measurement> runs = estimates(one, estimator, pilot, 32, kPilot);
  for (const Measurement& m : runs) variance += m.standard_error * m.standard_error;
  const double relative = std::sqrt(variance / static_cast<double>(runs.size())) / scale_of(one);
  double shift = 1.0;  // standard errors that are found so often
  while (metrics::student_power(shift, budget.test_significance, runs.front().degrees_of_freedom) < kPower)
    shift += 0.01;
  const double ratio = relative * shift / found;
  return 16 * std::max(1, static_cast<int>(std::lround(ratio * ratio * one.pilot_samples / 16.0)));
}

}  // namespace

// The spread s of single estimates is known from n of them: (n - 1) s^2/sigma^2 is chi^2, relative error about
// 1/sqrt(2 (n - 1)); its interval is carried through the power.
std::vector<PowerPoint> power_curve(const TruthCase& one, double found, const PowerBudget& budget) {
  const Estimator estimator = one.prepare();
  const Effort effort{samples_to_find(one, estimator, found, budget), 1, budget.seed, budget.threads};
  metrics::RunningMoments spread;
  for (const Measurement& m : estimates(one, estimator, effort, budget.seeds, kSpread)) spread.add(m.mean);
  const double relative = std::sqrt(spread.variance()) / scale_of(one);
  const double reach = metrics::two_sided_z(budget.interval_significance) /
                       std::sqrt(2.0 * (static_cast<double>(budget.seeds) - 1.0));
  // One set of estimates serves all biases: the adapter only multiplies.
  const std::vector<Measurement> runs = estimates(one, estimator, effort, budget.seeds, kDetect);
  std::vector<PowerPoint> curve;
  for (const double bias : kInjectedBiases) {
    PowerPoint point;
    point.estimator = one.name;
    point.bias = bias;
    std::size_t found_count = 0;
    for (const Measurement& m : runs)
      found_count += p_of(one, biased(m, bias)) < budget.test_significance ? 1U : 0U;
    const double freedom = runs.front().degrees_of_freedom;
    const auto power = [&](double s) {
      return metrics::student_power(bias / ((1.0 + bias) * s), budget.test_significance, freedom);
    };
    point.stated = power(relative);
    point.stated_low = power(relative * (1.0 + reach));
    point.stated_high = power(relative / (1.0 + reach));
    point.measured = metrics::proportion(found_count, budget.seeds, budget.interval_significance);
    curve.push_back(point);
  }
  return curve;
}

bool agrees(const PowerPoint& point) {
  return point.measured.low <= point.stated_high && point.measured.high >= point.stated_low;  // false for NaN
}

PowerPoint false_alarms_between_runs(const TruthCase& one, int samples, const PowerBudget& budget) {
  constexpr std::size_t kRandomisations = 16;
  const Estimator estimator = one.prepare();
  const Effort effort{samples, 1, budget.seed, budget.threads};
  const std::vector<Measurement> a = estimates(one, estimator, effort, budget.seeds, kFirst);
  const std::vector<Measurement> b = estimates(one, estimator, effort, budget.seeds, kSecond);
  std::size_t alarms = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const metrics::TestResult welch = metrics::welch({a[i].mean, a[i].standard_error}, kRandomisations,
                                                     {b[i].mean, b[i].standard_error}, kRandomisations);
    alarms += welch.p < budget.test_significance ? 1U : 0U;
  }
  PowerPoint point;
  point.estimator = one.name;
  point.stated = point.stated_low = point.stated_high = budget.test_significance;
  point.measured = metrics::proportion(alarms, budget.seeds, budget.interval_significance);
  return point;
}

}  // namespace plumbline::checks
