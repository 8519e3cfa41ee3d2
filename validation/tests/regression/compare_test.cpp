// Baselines: between two runs of the same nothing is found, as often as stated; changes worth knowing are found.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "reference/base/error.hpp"
#include "reference/scene/builtin.hpp"
#include "validation/metrics/mann_whitney.hpp"
#include "validation/metrics/power.hpp"
#include "validation/metrics/statistics.hpp"
#include "validation/regression/quantities.hpp"

namespace plumbline::regression {
namespace {

using checks::Finding;
using checks::Verdict;

constexpr int kCopies = 16;

std::size_t count(const std::vector<Finding>& findings, Verdict verdict) {
  return static_cast<std::size_t>(std::count_if(findings.begin(), findings.end(),
                                                [&](const Finding& f) { return f.verdict == verdict; }));
}

// ---------------------------------------------------------------- synthetic runs
class Runs {
 public:
  explicit Runs(unsigned seed) : random_(seed) {}

  Quantity quantity(const std::string& name, double mean, double standard_error) {
    metrics::RunningMoments moments;
    for (int i = 0; i < kCopies; ++i)
      moments.add(mean + standard_error * std::sqrt(kCopies) * normal_(random_));
    return {name, moments.mean(), moments.estimate().standard_error, kCopies, 1e-5};
  }
  Finding finding(const std::string& name, double error, double standard_error) {
    Finding f;
    f.family = "images";
    f.name = name;
    f.measured = error + standard_error * normal_(random_);
    f.uncertainty = metrics::two_sided_z(0.05) * standard_error;
    f.bound = 2.0 * error;
    f.verdict = Verdict::pass;
    return f;
  }
  KernelTimes times(const std::string& name, double median, double noise, int repetitions = 15) {
    KernelTimes result{name, {}};
    for (int i = 0; i < repetitions; ++i)
      result.seconds.push_back(median * std::exp(noise * normal_(random_)));
    return result;
  }
  Baseline run() {
    Baseline result;
    result.command = "plumbline validate";
    result.machine = {{"cpu", "one"}};
    for (int i = 0; i < 40; ++i) result.quantities.push_back(quantity(std::to_string(i), 1.0, 5e-4));
    for (int i = 0; i < 40; ++i) result.findings.push_back(finding(std::to_string(i), 0.01, 1e-3));
    return result;
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
};

Baseline with(const Quantity& quantity) {
  Baseline result;
  result.quantities = {quantity};
  return result;
}

Baseline with(const KernelTimes& times, const std::string& cpu = "one") {
  Baseline result;
  result.machine = {{"cpu", cpu}};
  result.times = {times};
  return result;
}

// ---------------------------------------------------------------- runs of the same
TEST(Baseline, TwoRunsOfTheSamePassAThousandTimesOutOfAThousand) {
  Runs runs(1);
  std::size_t alarms = 0;
  for (int i = 0; i < 1000; ++i) {
    Baseline before = runs.run();
    Baseline now = runs.run();
    for (int k = 0; k < 6; ++k) {
      before.times.push_back(runs.times(std::to_string(k), 1.0, 0.03));
      now.times.push_back(runs.times(std::to_string(k), 1.0, 0.03));
    }
    alarms += count(compare(before, now, {}), Verdict::fail) > 0 ? 1U : 0U;
  }
  EXPECT_EQ(alarms, 0U);  // 0.1 are expected
}

TEST(Baseline, RaisesFalseAlarmsAsOftenAsItWasTold) {
  Runs runs(2);
  CompareSettings settings;
  settings.significance = 0.05;
  std::size_t alarms = 0;
  for (int i = 0; i < 1000; ++i) {
    const Baseline before = runs.run();
    alarms += count(compare(before, runs.run(), settings), Verdict::fail) > 0 ? 1U : 0U;
  }
  EXPECT_GE(metrics::binomial_p(alarms, 1000, settings.significance), 1e-4) << alarms;
}

// ---------------------------------------------------------------- changes
TEST(Baseline, FindsAChangeOfHalfAPercentAndProvesItsAbsence) {
  Runs runs(3);
  for (int i = 0; i < 100; ++i) {
    const Baseline before = with(runs.quantity("mean", 1.0, 3e-4));
    EXPECT_EQ(compare(before, with(runs.quantity("mean", 1.005, 3e-4)), {})[0].verdict, Verdict::fail);
    EXPECT_EQ(compare(before, with(runs.quantity("mean", 0.995, 3e-4)), {})[0].verdict, Verdict::fail);
    EXPECT_EQ(compare(before, with(runs.quantity("mean", 1.0, 3e-4)), {})[0].verdict, Verdict::pass);
  }
}

TEST(Baseline, ANumberTooNoisyToTellIsInconclusive) {
  Runs runs(4);
  const Baseline before = with(runs.quantity("mean", 1.0, 0.02));
  EXPECT_EQ(compare(before, with(runs.quantity("mean", 1.0, 0.02)), {})[0].verdict, Verdict::inconclusive);
}

TEST(Baseline, ExactNumbersMayDifferByRoundingOnly) {
  const Baseline before = with(Quantity{"coefficient", 0.5, 0.0, 0, 1e-5});
  EXPECT_EQ(compare(before, with(Quantity{"coefficient", 0.500009, 0.0, 0, 1e-5}), {})[0].verdict,
            Verdict::pass);
  for (const double changed : {0.5025, 0.4975, static_cast<double>(NAN)})
    EXPECT_EQ(compare(before, with(Quantity{"coefficient", changed, 0.0, 0, 1e-5}), {})[0].verdict,
              Verdict::fail);
}

TEST(Baseline, WhatIsGoneOrNotANumberFails) {
  Runs runs(5);
  const Baseline before = runs.run();
  Baseline now = runs.run();
  now.quantities.erase(now.quantities.begin());
  now.findings.pop_back();
  EXPECT_EQ(count(compare(before, now, {}), Verdict::fail), 2U);
  now = runs.run();
  now.quantities[3].mean = NAN;
  now.findings[3].measured = NAN;
  EXPECT_EQ(count(compare(before, now, {}), Verdict::fail), 2U);
}

TEST(Baseline, ErrorsMayFallButNotGrow) {
  Runs runs(6);
  const Baseline before = runs.run();
  Baseline now = before;
  now.findings[0].measured *= 0.2;
  now.findings[0].uncertainty *= 0.2;
  EXPECT_EQ(count(compare(before, now, {}), Verdict::fail), 0U);
  now.findings[0].measured = 3.0 * before.findings[0].measured;
  EXPECT_EQ(count(compare(before, now, {}), Verdict::fail), 1U);
  now = before;
  now.findings[1].verdict = Verdict::inconclusive;
  EXPECT_EQ(count(compare(before, now, {}), Verdict::fail), 1U);
}

TEST(Baseline, ErrorsWithoutNoiseMayGrowByATenthOfTheirBound) {
  Baseline before;
  Finding f;
  f.name = "gram";
  f.measured = 1e-7;
  f.bound = 1e-6;
  f.verdict = Verdict::pass;
  before.findings = {f};
  Baseline now = before;
  now.findings[0].measured = 1.9e-7;
  EXPECT_EQ(count(compare(before, now, {}), Verdict::fail), 0U);
  now.findings[0].measured = 2.1e-7;
  EXPECT_EQ(count(compare(before, now, {}), Verdict::fail), 1U);
  now.seed = 1;  // another seed: such a number may be chance
  EXPECT_EQ(count(compare(before, now, {}), Verdict::fail), 0U);
}

TEST(Baseline, AnotherCommandIsRefused) {
  Baseline before;
  Baseline now;
  now.command = "plumbline validate builtin:plaza";
  EXPECT_THROW((void)compare(before, now, {}), InputError);
}

// ---------------------------------------------------------------- times
TEST(Baseline, ReportsAKernelThatIsAFifthSlowerAndNoNoise) {
  Runs runs(7);
  for (int i = 0; i < 100; ++i) {
    const Baseline before = with(runs.times("rotate", 1.0, 0.03));
    EXPECT_EQ(compare(before, with(runs.times("rotate", 1.2, 0.03)), {})[0].verdict, Verdict::fail);
    EXPECT_EQ(compare(before, with(runs.times("rotate", 1.05, 0.03)), {})[0].verdict, Verdict::pass);
    EXPECT_EQ(compare(before, with(runs.times("rotate", 0.5, 0.03)), {})[0].verdict, Verdict::pass);
  }
}

TEST(Baseline, NeverJudgesTimesOfAnotherMachineOrOfTooFewRepetitions) {
  Runs runs(8);
  const Baseline before = with(runs.times("rotate", 1.0, 0.03));
  for (const Baseline& now :
       {with(runs.times("rotate", 9.0, 0.03), "two"), with(runs.times("rotate", 9.0, 0.03, 8))})
    EXPECT_EQ(compare(before, now, {})[0].verdict, Verdict::inconclusive);
}

TEST(MannWhitney, IsExactForSmallSamples) {
  // 3 above 3: 1 of the 20 arrangements; one exchange away: 2 of 20.
  const std::vector<double> low = {1, 2, 3};
  EXPECT_DOUBLE_EQ(metrics::mann_whitney_greater(std::vector<double>{4, 5, 6}, low).p, 1.0 / 20.0);
  EXPECT_DOUBLE_EQ(metrics::mann_whitney_greater(std::vector<double>{2.5, 5, 6}, low).p, 2.0 / 20.0);
  EXPECT_DOUBLE_EQ(metrics::mann_whitney_greater(low, std::vector<double>{4, 5, 6}).p, 1.0);
  EXPECT_EQ(metrics::mann_whitney_greater(std::vector<double>{NAN}, low).p, 1.0);
  EXPECT_THROW((void)metrics::mann_whitney_greater({}, low), InputError);
}

TEST(MannWhitney, TiesAreNoEvidence) {
  const std::vector<double> same(20, 1.0);
  EXPECT_EQ(metrics::mann_whitney_greater(same, same).p, 1.0);
  std::vector<double> half = same;
  for (std::size_t i = 0; i < 10; ++i) half[i] = 2.0;
  const double p =
      metrics::mann_whitney_greater(half, same).p;  // z = 99.5 / sqrt(400/12 (41 - 26970/1560)) = 3.54
  EXPECT_NEAR(p, 2.0e-4, 5e-5);
}

// ---------------------------------------------------------------- real runs
checks::Suite small_suite(float albedo_factor, std::uint64_t seed) {
  checks::Suite suite;
  scene::Scene scene = scene::make_builtin_scene("convex");
  for (scene::Material& material : scene.materials) material.albedo *= albedo_factor;
  suite.scenes.push_back({"convex", scene, ""});
  suite.environments.push_back(light::make_builtin_environment("two-lobes"));
  suite.bands = {3};
  suite.budget.seed = seed;
  suite.budget.image_samples = 512;
  suite.budget.bake_samples = 1 << 15;
  return suite;
}

Baseline real_run(float albedo_factor, std::uint64_t seed) {
  Baseline result;
  result.quantities = measure_quantities(small_suite(albedo_factor, seed));
  return result;
}

TEST(BaselineQuantities, TellAHalfPercentDarkerAlbedoFromAnotherSeed) {
  const Baseline before = real_run(1.0F, 1);
  const std::vector<Finding> same = compare(before, real_run(1.0F, 2), {});
  EXPECT_EQ(count(same, Verdict::fail), 0U);
  EXPECT_EQ(count(same, Verdict::inconclusive), 0U);
  const std::vector<Finding> darker = compare(before, real_run(0.995F, 2), {});
  // Path traced, unshadowed and shadowed; red, green and blue. The light's 9 coefficients a colour are what they were.
  EXPECT_EQ(count(darker, Verdict::fail), 9U);
  // A constant of the relighting that is half a per cent off.
  Baseline constant = before;
  for (Quantity& q : constant.quantities) {
    if (q.name.find("shadowed transfer") != std::string::npos) q.mean *= 1.005;
  }
  EXPECT_EQ(count(compare(before, constant, {}), Verdict::fail), 6U);
}

}  // namespace
}  // namespace plumbline::regression
