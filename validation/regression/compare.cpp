#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reference/base/error.hpp"
#include "validation/metrics/mann_whitney.hpp"
#include "validation/metrics/statistics.hpp"
#include "validation/regression/baseline.hpp"

namespace plumbline::regression {
namespace {

using checks::Finding;
using checks::Verdict;

constexpr std::size_t kLeastRepetitions = 9;  // below, the test's smallest p is no longer small
constexpr const char* kOfChance =
    "standard errors";  // the unit of the largest of many z: differs from seed to seed

Finding start(const std::string& name, const char* source) {
  Finding finding;
  finding.family = "baseline";
  finding.name = name;
  finding.source = source;
  return finding;
}

Finding gone(const std::string& name) {
  Finding finding = start(name, "the baseline has it");
  finding.measured = 1.0;
  finding.verdict = Verdict::fail;
  finding.detail = "Is in the baseline and was not measured now.";
  return finding;
}

template <class T>
const T* find(const std::vector<T>& all, const std::string& name) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const T& one) { return one.name == name; });
  return found == all.end() ? nullptr : &*found;
}

// ---------------------------------------------------------------- quantities

Finding compare_exact(const Quantity& before, const Quantity& now) {
  Finding finding = start(before.name, "rounding of another order of summation or another instruction set");
  finding.measured = std::abs(now.mean - before.mean);
  finding.bound = before.tolerance;
  finding.verdict = finding.measured <= finding.bound ? Verdict::pass : Verdict::fail;
  finding.detail = fmt::format("Was {:.8g}, is {:.8g}; neither has noise.", before.mean, now.mean);
  return finding;
}

// Welch's test for a change; if there is none to be seen, two one-sided tests of level 5 % for whether a change of the
// margin could have hidden. Both on d = now - before with s^2 = s_before^2 + s_now^2.
Finding compare_noisy(const Quantity& before, const Quantity& now, double significance, double margin) {
  constexpr double kAlpha = 0.05;
  Finding finding =
      start(before.name, "Welch's t test; where it finds nothing, two one-sided tests against the margin");
  finding.unit = "%";
  const double scale = std::abs(before.mean);
  const metrics::Estimate a{now.mean, now.standard_error};
  const metrics::Estimate b{before.mean, before.standard_error};
  const double change = a.mean - b.mean;
  const double spread = std::hypot(a.standard_error, b.standard_error);
  finding.measured = 100.0 * change / scale;
  finding.uncertainty = 100.0 * metrics::two_sided_z(0.05) * spread / scale;
  finding.bound = 100.0 * margin;
  const bool is_changed = !(metrics::welch(a, now.count, b, before.count).p >= significance);
  const bool is_equal = metrics::equivalent({change, spread}, 0.0, margin * scale, kAlpha);
  finding.verdict = is_changed ? Verdict::fail : is_equal ? Verdict::pass : Verdict::inconclusive;
  finding.detail = fmt::format(
      "Was {:.6g} +- {:.2g}, is {:.6g} +- {:.2g} (standard errors). Smallest change found with probability "
      "90 %: {:.2g} %.",
      before.mean, before.standard_error, now.mean, now.standard_error,
      spread > 0.0 ? 100.0 * metrics::detectable_shift(spread, significance, 0.9) / scale : 0.0);
  return finding;
}

Finding compare_quantity(const Quantity& before, const Quantity& now, double significance, double margin) {
  const bool is_noisy = before.count >= 2 && now.count >= 2 &&
                        std::max(before.standard_error, now.standard_error) > before.tolerance;
  if (!is_noisy) return compare_exact(before, now);
  return compare_noisy(before, now, significance, margin);
}

// ---------------------------------------------------------------- findings

std::string full_name(const Finding& finding) {
  return finding.family + " / " + finding.name;
}

bool is_statistical(const Finding& before, const Finding& now) {
  return before.uncertainty > 0.0 && now.uncertainty > 0.0;
}

double allowed_growth(const Finding& before, const Finding& now, double significance, bool is_same_seed) {
  if (is_statistical(before, now)) {
    const double each = metrics::two_sided_z(0.05);  // an uncertainty is the half width of the 95 % interval
    return metrics::two_sided_z(2.0 * significance) * std::hypot(before.uncertainty, now.uncertainty) / each;
  }
  const bool is_comparable = is_same_seed && before.unit != kOfChance && before.bound > 0.0;
  return is_comparable ? 0.1 * before.bound : HUGE_VAL;
}

int badness(Verdict verdict) {
  return verdict == Verdict::pass ? 0 : verdict == Verdict::inconclusive ? 1 : 2;
}

// An error is what it is away from what it should be.
Finding compare_finding(const Finding& before, const Finding& now, double significance, bool is_same_seed) {
  Finding finding =
      start(full_name(before), "the baseline's value, both uncertainties, a tenth of the check's bound");
  const double old_error = std::abs(before.measured - before.expected);
  const double new_error = std::abs(now.measured - now.expected);
  finding.measured = new_error - old_error;
  finding.bound = allowed_growth(before, now, significance, is_same_seed);
  finding.unit = before.unit;
  const bool is_worse =
      badness(now.verdict) > badness(before.verdict) || !(finding.measured <= finding.bound);
  finding.verdict = is_worse ? Verdict::fail : Verdict::pass;
  if (std::isinf(finding.bound)) finding.bound = 0.0;  // only the verdict was compared
  finding.detail = fmt::format("Error was {:.4g} ({}), is {:.4g} ({}).", old_error,
                               checks::to_string(before.verdict), new_error, checks::to_string(now.verdict));
  return finding;
}

// ---------------------------------------------------------------- times

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n == 0 ? NAN : 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

Finding compare_times(const KernelTimes& before, const KernelTimes& now, double significance,
                      double slow_down) {
  Finding finding =
      start("time / " + before.name, "Mann and Whitney's test against the old times and the least effect");
  finding.unit = "%";
  finding.measured = 100.0 * (median(now.seconds) / median(before.seconds) - 1.0);
  finding.bound = 100.0 * slow_down;
  std::vector<double> allowed = before.seconds;
  for (double& seconds : allowed) seconds *= 1.0 + slow_down;
  if (std::min(allowed.size(), now.seconds.size()) < kLeastRepetitions) {
    finding.detail = fmt::format("Not judged: fewer than {} repetitions.", kLeastRepetitions);
    return finding;
  }
  const metrics::TestResult test = metrics::mann_whitney_greater(now.seconds, allowed);
  finding.verdict = test.p < significance ? Verdict::fail : Verdict::pass;
  finding.detail =
      fmt::format("Median {:.4g} s, was {:.4g} s; p = {:.2g} that it grew by no more than {:.0f} %.",
                  median(now.seconds), median(before.seconds), test.p, 100.0 * slow_down);
  return finding;
}

Finding times_not_judged(const char* why) {
  Finding finding = start("time", "times of two machines say nothing about the code");
  finding.detail = std::string("Times were not compared: ") + why;
  return finding;
}

void compare_all_times(const Baseline& before, const Baseline& now, double each, double slow_down,
                       std::vector<Finding>& findings) {
  if (before.times.empty() || now.times.empty()) return;
  if (before.machine != now.machine) {
    findings.push_back(times_not_judged("the baseline is of another machine, system or compiler."));
    return;
  }
  for (const KernelTimes& kernel : before.times) {
    const KernelTimes* other = find(now.times, kernel.name);
    findings.push_back(other == nullptr ? gone("time / " + kernel.name)
                                        : compare_times(kernel, *other, each, slow_down));
  }
}

}  // namespace

std::vector<Finding> compare(const Baseline& before, const Baseline& now, const CompareSettings& settings) {
  if (before.command != now.command) {
    throw InputError(fmt::format("baseline: it is of another command: expected \"{}\", got \"{}\"",
                                 before.command, now.command));
  }
  const std::size_t tests = before.quantities.size() + before.findings.size() + before.times.size();
  const double each = metrics::sidak(settings.significance, std::max<std::size_t>(1, tests));
  std::vector<Finding> findings;
  for (const Quantity& quantity : before.quantities) {
    const Quantity* other = find(now.quantities, quantity.name);
    findings.push_back(other == nullptr ? gone(quantity.name)
                                        : compare_quantity(quantity, *other, each, settings.margin));
  }
  for (const Finding& one : before.findings) {
    const auto other = std::find_if(now.findings.begin(), now.findings.end(), [&](const Finding& f) {
      return f.family == one.family && f.name == one.name;
    });
    findings.push_back(other == now.findings.end()
                           ? gone(full_name(one))
                           : compare_finding(one, *other, each, before.seed == now.seed));
  }
  compare_all_times(before, now, each, settings.slow_down, findings);
  return findings;
}

}  // namespace plumbline::regression
