#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "validation/checks/truths.hpp"
#include "validation/metrics/power.hpp"
#include "validation/metrics/statistics.hpp"

namespace plumbline::checks {
namespace {

constexpr int kRandomisations = 16;  // of one run of the integrator
constexpr int kCopies = 4;
enum Purpose : std::uint64_t { kPilot = 1, kRun = 2 };

double scale_of(const TruthCase& one) {
  return std::abs(one.scale != 0.0 ? one.scale : one.truth);
}

/// What is left of the margin for noise.
double noise_margin(const TruthCase& one, double margin) {
  return margin - one.model_error - kRounding;
}

bool is_sound(const TruthCase& one, const Measurement& m) {
  if (!std::isfinite(m.mean) || !std::isfinite(m.standard_error) || m.standard_error < 0.0) return false;
  return one.is_noiseless || m.standard_error > 0.0;
}

std::string sentence(const TruthCase& one, const TruthPlan& plan, const Measurement& m, double p) {
  const std::string noise =
      one.is_noiseless ? std::string("noise-free by construction")
                       : fmt::format("{} paths, t test against no bias at all: p = {:.2g}",
                                     static_cast<std::int64_t>(plan.effort.samples) * plan.effort.copies, p);
  return fmt::format(
      "Truth {:.10g}, path tracer {:.10g}: {}.{}", one.truth, m.mean, noise,
      one.margin_factor == 1.0
          ? ""
          : fmt::format(" Rare paths: {:.3g} x the margin of the other cases.", one.margin_factor));
}

}  // namespace

// FNV-1a over the name, then SplitMix64's finaliser.
std::uint64_t truth_seed(std::uint64_t seed, const std::string& name, std::uint64_t purpose) {
  std::uint64_t hash = 0xCBF29CE484222325ULL ^ seed;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3ULL;
  hash += purpose * 0x9E3779B97F4A7C15ULL;
  hash = (hash ^ (hash >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  hash = (hash ^ (hash >> 27U)) * 0x94D049BB133111EBULL;
  return hash ^ (hash >> 31U);
}

// The error of n samples falls at least as fast as 1/sqrt(n). Wanted: standard error <= margin x
// largest_standard_error(); known: that of the pilot, whose upper bound is taken.
TruthPlan plan_truth(const TruthCase& one, const Estimator& estimator, const Budget& budget,
                     std::size_t cases) {
  TruthPlan plan;
  plan.significance = metrics::sidak(budget.significance, cases);
  plan.margin = one.is_noiseless ? kNoiselessMargin : one.margin_factor * tier_margin(budget.tier);
  plan.effort = {one.pilot_samples, one.is_noiseless ? 1 : kCopies, truth_seed(budget.seed, one.name, kRun),
                 budget.threads};
  if (one.is_noiseless) return plan;
  Effort pilot = plan.effort;
  pilot.seed = truth_seed(budget.seed, one.name, kPilot);
  const Measurement m = estimator(pilot);
  if (!is_sound(one, m)) return plan;  // the run itself will say so
  const double spread = m.standard_error / scale_of(one) * metrics::spread_bound(0.95, m.degrees_of_freedom);
  const double wanted = noise_margin(one, plan.margin) *
                        metrics::largest_standard_error(plan.significance, kTruthPower, m.degrees_of_freedom);
  const double ratio = std::max(1.0, spread / wanted);
  const double samples = std::min(ratio * ratio * one.pilot_samples, kMostPaths / kCopies);
  // Powers of two in each randomisation: the points fill their square evenly.
  const double each = std::exp2(std::ceil(std::log2(samples / kRandomisations)));
  plan.effort.samples = kRandomisations * static_cast<int>(each);
  return plan;
}

Finding judge_truth(const TruthCase& one, const TruthPlan& plan, const Measurement& m) {
  constexpr double kPerCent = 100.0;
  Finding finding;
  finding.family = "truths";
  finding.name = one.name;
  finding.unit = "%";
  finding.source = one.formula;
  finding.seed = plan.effort.seed;
  finding.bound = kPerCent * plan.margin;
  const double bias = (m.mean - one.truth) / scale_of(one);
  const double error = m.standard_error / scale_of(one);
  finding.measured = kPerCent * bias;
  finding.verdict = Verdict::fail;
  if (!is_sound(one, m)) {
    finding.detail =
        fmt::format("Truth {:.10g}, path tracer {} +- {}: {}.", one.truth, m.mean, m.standard_error,
                    std::isfinite(m.mean) ? "an estimate that varies must know its spread" : "not a number");
    return finding;
  }
  const double nu = m.degrees_of_freedom;
  finding.uncertainty = kPerCent * metrics::two_sided_t(0.05, nu) * error;
  const double reach =
      metrics::two_sided_t(2.0 * plan.significance, nu) * error + one.model_error + kRounding;
  if (std::abs(bias) + reach <= plan.margin) {
    finding.verdict = Verdict::pass;
  } else if (!(std::abs(bias) - reach > plan.margin)) {
    finding.verdict = Verdict::inconclusive;
  }
  const double p = error > 0.0 ? metrics::two_sided_p_student(bias / error, nu) : 1.0;
  finding.detail = sentence(one, plan, m, p);
  if (finding.verdict == Verdict::inconclusive)
    finding.detail += fmt::format(" The interval of +-{:.3g} % reaches out of the margin.", kPerCent * reach);
  return finding;
}

TruthResult run_truth(const TruthCase& one, const Budget& budget, std::size_t cases) {
  const auto start = std::chrono::steady_clock::now();
  const Estimator estimator = one.prepare();
  TruthResult result;
  result.plan = plan_truth(one, estimator, budget, cases);
  result.measurement = estimator(result.plan.effort);
  result.finding = judge_truth(one, result.plan, result.measurement);
  result.finding.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

std::vector<TruthCase> truth_cases() {
  std::vector<TruthCase> all;
  for (const auto& part :
       {direct_light_cases, distant_light_cases, enclosure_cases, interreflection_cases, sampling_cases}) {
    for (TruthCase& one : part()) all.push_back(std::move(one));
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const TruthCase& a, const TruthCase& b) { return a.name < b.name; });
  return all;
}

}  // namespace plumbline::checks
