#include "validation/metrics/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "reference/base/error.hpp"
#include "reference/base/vector.hpp"

namespace plumbline::metrics {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// mt19937_64 is fixed by the standard; the distributions of <random> are not, so these two are ours.
using Generator = std::mt19937_64;
double uniform(Generator& generator) {
  return (static_cast<double>(generator() >> 11U) + 0.5) * 0x1p-53;
}
double normal(Generator& generator) {
  const double radius = std::sqrt(-2.0 * std::log(uniform(generator)));
  return radius * std::cos(2.0 * kPi * uniform(generator));
}
std::vector<double> normals(Generator& generator, std::size_t count, double mean = 0.0) {
  std::vector<double> values(count);
  for (double& value : values) value = mean + normal(generator);
  return values;
}

// Alarms among `runs` at rate p are binomial: 4 standard deviations is passed by chance once in 16 000 seeds.
void expect_rate(std::size_t alarms, std::size_t runs, double p) {
  const auto n = static_cast<double>(runs);
  EXPECT_LE(std::abs(static_cast<double>(alarms) - n * p), 4.0 * std::sqrt(n * p * (1.0 - p)))
      << alarms << " of " << runs << " at " << p;
}

TEST(Statistics, EstimateIsTheMeanAndItsStandardError) {
  // Mean 3; squared deviations 4 + 1 + 0 + 1 + 4 = 10; variance 10 / 4; standard error sqrt(2.5 / 5).
  const std::vector<double> values = {1.0, 2.0, 3.0, 4.0, 5.0};
  const Estimate found = estimate(values);
  EXPECT_LE(std::abs(found.mean - 3.0), 1e-15);
  EXPECT_LE(std::abs(found.standard_error - std::sqrt(0.5)), 1e-15);
  EXPECT_THROW((void)estimate(std::vector<double>{1.0}), InputError);
  EXPECT_TRUE(std::isnan(estimate(std::vector<double>{1.0, kNan, 2.0}).mean));
}

TEST(RunningMoments, SurviveALargeMean) {
  // Values 1e8 +- 1: variance n / (n - 1). A sum of squares minus a squared mean has no digit left here.
  RunningMoments moments;
  for (int i = 0; i < 1000; ++i) moments.add(i % 2 == 0 ? 1e8 + 1.0 : 1e8 - 1.0);
  EXPECT_LE(std::abs(moments.variance() - 1000.0 / 999.0), 1e-9);
}

TEST(RunningMoments, MergeEqualsOnePass) {
  Generator generator(1);
  RunningMoments whole;
  RunningMoments parts[3];
  for (std::size_t i = 0; i < 300; ++i) {
    const double value = 5.0 + normal(generator);
    whole.add(value);
    parts[i < 200 ? 0 : 1].add(value);  // parts[2] stays empty
  }
  RunningMoments merged = parts[2];
  for (const RunningMoments& part : parts) merged.merge(part);
  EXPECT_EQ(merged.count(), whole.count());
  // n additions of values near 5: n eps |x| bounds the rounding of the mean.
  EXPECT_LE(std::abs(merged.mean() - whole.mean()), 300 * 2.3e-16 * 5.0);
  EXPECT_LE(std::abs(merged.variance() - whole.variance()), 300 * 2.3e-16 * 25.0);
  EXPECT_THROW((void)RunningMoments().variance(), InputError);
}

TEST(Statistics, NormalTailsAreTheTableValues) {
  // P(|Z| > z): 0.05 at 1.959963984540054, 0.01 at 2.5758293035489004, erfc(1 / sqrt 2) at 1.
  EXPECT_LE(std::abs(two_sided_p(1.959963984540054) - 0.05), 1e-15);
  EXPECT_LE(std::abs(two_sided_p(-2.5758293035489004) - 0.01), 1e-16);
  EXPECT_LE(std::abs(two_sided_p(1.0) - 0.31731050786291415), 1e-15);
  EXPECT_LE(std::abs(two_sided_z(0.05) - 1.959963984540054), 1e-14);
  EXPECT_EQ(two_sided_p(0.0), 1.0);
  EXPECT_EQ(two_sided_z(1.0), 0.0);
  EXPECT_EQ(two_sided_z(0.0), kInfinity);
  for (const double p : {1e-12, 1e-4, 0.3, 0.999}) {
    EXPECT_LE(std::abs(two_sided_p(two_sided_z(p)) - p), 1e-12 * p) << p;
  }
}

TEST(Statistics, NanAndInfinityAreNeverInnocent) {
  EXPECT_EQ(two_sided_p(kNan), 0.0);
  EXPECT_EQ(two_sided_p(kInfinity), 0.0);
  EXPECT_EQ(two_sided_p_student(kNan, 3.0), 0.0);
  EXPECT_EQ(two_sided_p_student(-kInfinity, 3.0), 0.0);
  EXPECT_THROW((void)two_sided_p_student(1.0, 0.0), InputError);
  EXPECT_THROW((void)two_sided_z(kNan), InputError);
  EXPECT_THROW((void)two_sided_z(1.5), InputError);
}

TEST(Statistics, StudentTailsHaveClosedForms) {
  // 1 degree of freedom is Cauchy: P(|T| > t) = 1 - 2 atan(t) / pi; 2: P(|T| > t) = 1 - t / sqrt(2 + t^2).
  for (const double t : {0.1, 1.0, 3.0, 12.706204736174694}) {
    EXPECT_LE(std::abs(two_sided_p_student(t, 1.0) - (1.0 - 2.0 * std::atan(t) / kPi)), 1e-14) << t;
    EXPECT_LE(std::abs(two_sided_p_student(-t, 2.0) - (1.0 - t / std::sqrt(2.0 + t * t))), 1e-14) << t;
  }
  EXPECT_LE(std::abs(two_sided_p_student(12.706204736174694, 1.0) - 0.05), 1e-14);
  EXPECT_LE(std::abs(two_sided_p_student(2.0, 1e12) - two_sided_p(2.0)), 1e-11);
}

TEST(Statistics, StudentQuantileInvertsTheTail) {
  EXPECT_LE(std::abs(two_sided_t(0.05, 1.0) - std::tan(kPi * 0.475)), 1e-11);
  for (const double degrees : {1.0, 2.5, 30.0}) {
    EXPECT_LE(std::abs(two_sided_p_student(two_sided_t(0.01, degrees), degrees) - 0.01), 1e-13) << degrees;
  }
  EXPECT_EQ(two_sided_t(0.0, 5.0), kInfinity);
  EXPECT_THROW((void)two_sided_t(0.5, -1.0), InputError);
}

TEST(Statistics, SidakBoundsTheFamily) {
  for (const std::size_t tests : {1UL, 7UL, 1000000UL}) {
    const double each = sidak(1e-4, tests);
    EXPECT_LE(std::abs(-std::expm1(static_cast<double>(tests) * std::log1p(-each)) - 1e-4), 1e-16) << tests;
  }
  // The |z| limits for a family of 0.01 over 1e3 and 1e6 tests: 4.42 and 5.73 to two decimals.
  EXPECT_LE(std::abs(two_sided_z(sidak(0.01, 1000)) - 4.42), 0.005);
  EXPECT_LE(std::abs(two_sided_z(sidak(0.01, 1000000)) - 5.73), 0.005);
  EXPECT_THROW((void)sidak(0.01, 0), InputError);
  EXPECT_THROW((void)sidak(kNan, 3), InputError);
}

TEST(KolmogorovSmirnov, DistanceAndTailAreTheKnownOnes) {
  // Midpoints (i + 1/2) / n are the closest sample there is: D = 1 / 2n.
  const TestResult closest = kolmogorov_smirnov_uniform(std::vector<double>{0.125, 0.875, 0.375, 0.625});
  EXPECT_LE(std::abs(closest.statistic - 0.125), 1e-15);
  EXPECT_GE(closest.p, 0.9999);
  // i / n + D has distance D; the 5 % point of Kolmogorov's distribution is 1.3580986393.
  constexpr std::size_t kCount = 1000;
  const double root = std::sqrt(1000.0);
  const double distance = 1.3580986393 / (root + 0.12 + 0.11 / root);
  std::vector<double> shifted(kCount);
  for (std::size_t i = 0; i < kCount; ++i) shifted[i] = static_cast<double>(i) / 1000.0 + distance;
  EXPECT_LE(std::abs(kolmogorov_smirnov_uniform(shifted).statistic - distance), 1e-15);
  EXPECT_LE(std::abs(kolmogorov_smirnov_uniform(shifted).p - 0.05), 1e-10);
}

TEST(KolmogorovSmirnov, TailIsContinuousWhereTheSeriesSwitch) {
  // One value at u >= 1/2: D = u, x = 1.23 u. Around x = 1 the two series must agree.
  const auto p = [](double x) { return kolmogorov_smirnov_uniform(std::vector<double>{x / 1.23}).p; };
  EXPECT_LE(std::abs(p(1.0 - 1e-9) - p(1.0 + 1e-9)), 1e-8);
  EXPECT_LE(std::abs(p(1.0) - 0.26999967167735456), 1e-9);  // 2 (e^-2 - e^-8 + e^-18 - e^-32)
}

TEST(KolmogorovSmirnov, FindsNanAndPlantedFaults) {
  Generator generator(2);
  std::vector<double> values(2000);
  for (double& value : values) value = uniform(generator);
  EXPECT_GE(kolmogorov_smirnov_uniform(values).p, 1e-3);
  std::vector<double> squared = values;
  for (double& value : squared) value *= value;
  EXPECT_LE(kolmogorov_smirnov_uniform(squared).p, 1e-12);
  values[7] = kNan;
  EXPECT_EQ(kolmogorov_smirnov_uniform(values).p, 0.0);
  EXPECT_THROW((void)kolmogorov_smirnov_uniform({}), InputError);
}

TEST(ChiSquared, IsTheClosedFormForTwoDegreesOfFreedom) {
  // Three bins: P(X > x) = exp(-x / 2); x = (10^2 + 5^2 + 5^2) / 20 = 7.5.
  const TestResult found = chi_squared(std::vector<double>{30, 15, 15}, std::vector<double>{20, 20, 20});
  EXPECT_LE(std::abs(found.statistic - 7.5), 1e-14);
  EXPECT_LE(std::abs(found.p - std::exp(-3.75)), 1e-15);
}

TEST(ChiSquared, PoolsBinsThatExpectTooLittle) {
  // {4 + 4, 10, 20 + 1}: the first two pool, the last is too small and joins its neighbour.
  const TestResult pooled =
      chi_squared(std::vector<double>{6, 4, 10, 19, 0}, std::vector<double>{4, 4, 10, 20, 1});
  EXPECT_LE(std::abs(pooled.statistic - (4.0 / 8.0 + 0.0 + 4.0 / 21.0)), 1e-14);
  EXPECT_LE(std::abs(pooled.p - std::exp(-pooled.statistic / 2.0)), 1e-15);
}

TEST(ChiSquared, RefusesATestThatCannotFail) {
  EXPECT_THROW((void)chi_squared(std::vector<double>{4}, std::vector<double>{9}), InputError);
  EXPECT_THROW((void)chi_squared(std::vector<double>{1, 2}, std::vector<double>{2, 2}), InputError);
  EXPECT_THROW((void)chi_squared(std::vector<double>{1, 2}, std::vector<double>{2}), InputError);
  EXPECT_THROW((void)chi_squared(std::vector<double>{9, 9}, std::vector<double>{9, -9}), InputError);
  EXPECT_EQ(chi_squared(std::vector<double>{kNan, 9}, std::vector<double>{9, 9}).p, 0.0);
}

TEST(Welch, IsStudentsTestForEqualSpreads) {
  // Equal standard errors s and sizes n: t = d / (s sqrt 2), 2 (n - 1) degrees of freedom.
  const TestResult found = welch({3.0, 0.5}, 10, {1.0, 0.5}, 10);
  EXPECT_LE(std::abs(found.statistic - 2.0 / (0.5 * std::sqrt(2.0))), 1e-14);
  EXPECT_LE(std::abs(found.p - two_sided_p_student(found.statistic, 18.0)), 1e-14);
}

TEST(Welch, HandlesExactAndBrokenEstimates) {
  EXPECT_EQ(welch({1.0, 0.0}, 5, {1.0, 0.0}, 5).p, 1.0);
  EXPECT_EQ(welch({1.0, 0.0}, 5, {2.0, 0.0}, 5).p, 0.0);
  EXPECT_EQ(welch({1.0, 0.0}, 5, {2.0, 0.0}, 5).statistic, -kInfinity);
  EXPECT_EQ(welch({kNan, 1.0}, 5, {2.0, 1.0}, 5).p, 0.0);
  EXPECT_EQ(welch({1.0, kInfinity}, 5, {2.0, 1.0}, 5).p, 0.0);
  EXPECT_LE(std::abs(welch({1.0, 0.0}, 5, {2.0, 1.0}, 5).p - two_sided_p_student(1.0, 4.0)), 1e-14);
  EXPECT_THROW((void)welch({1.0, 1.0}, 1, {1.0, 1.0}, 5), InputError);
}

TEST(Equivalent, NeedsTheWholeIntervalInside) {
  // alpha = 0.05: the interval reaches 1.6448536269514722 standard errors.
  EXPECT_TRUE(equivalent({1.0, 0.1}, 1.0, 0.16449, 0.05));
  EXPECT_FALSE(equivalent({1.0, 0.1}, 1.0, 0.16448, 0.05));
  EXPECT_FALSE(equivalent({1.1, 0.1}, 1.0, 0.2, 0.05));
  EXPECT_FALSE(equivalent({kNan, 0.1}, 1.0, 10.0, 0.05));
  EXPECT_FALSE(equivalent({1.0, kNan}, 1.0, 10.0, 0.05));
  EXPECT_FALSE(equivalent({1.0, 0.0}, 1.0, 10.0, 0.05));  // a default-made estimate claims nothing
  EXPECT_FALSE(equivalent({1.0, 0.1}, 1.0, kNan, 0.05));
  EXPECT_THROW((void)equivalent({1.0, 0.1}, 1.0, 1.0, 0.5), InputError);
}

// ---------------------------------------------------------------- calibration: equal things raise the
// claimed alarms

TEST(StatisticsCalibration, EqualMeansAlarmAtTheClaimedRate) {
  constexpr std::size_t kRuns = 4000;
  Generator generator(3);
  std::size_t welch_alarms = 0;
  std::size_t student_alarms = 0;
  std::vector<double> p_values;
  for (std::size_t run = 0; run < kRuns; ++run) {
    const Estimate a = estimate(normals(generator, 12));
    const Estimate b = estimate(normals(generator, 12));
    if (welch(a, 12, b, 12).p < 0.05) ++welch_alarms;
    p_values.push_back(two_sided_p_student(a.mean / a.standard_error, 11.0));
    if (p_values.back() < 0.05) ++student_alarms;
  }
  expect_rate(welch_alarms, kRuns, 0.05);
  expect_rate(student_alarms, kRuns, 0.05);
  EXPECT_GE(kolmogorov_smirnov_uniform(p_values).p, 1e-4);
}

TEST(StatisticsCalibration, NormalTailsOnFewValuesWouldAlarmTooOften) {
  // The negative of the test above: judging 4 values by the normal law alarms at P(|T_3| > 1.96) = 0.145.
  constexpr std::size_t kRuns = 4000;
  Generator generator(4);
  std::size_t alarms = 0;
  for (std::size_t run = 0; run < kRuns; ++run) {
    const Estimate found = estimate(normals(generator, 4));
    if (two_sided_p(found.mean / found.standard_error) < 0.05) ++alarms;
  }
  expect_rate(alarms, kRuns, two_sided_p_student(two_sided_z(0.05), 3.0));
}

TEST(StatisticsCalibration, DistributionTestsAlarmAtTheClaimedRate) {
  constexpr std::size_t kRuns = 4000;
  Generator generator(5);
  std::size_t ks_alarms = 0;
  std::size_t chi_alarms = 0;
  const std::vector<double> expected(10, 40.0);
  for (std::size_t run = 0; run < kRuns; ++run) {
    std::vector<double> values(400);
    std::vector<double> observed(10, 0.0);
    for (double& value : values) {
      value = uniform(generator);
      observed[static_cast<std::size_t>(value * 10.0)] += 1.0;
    }
    if (kolmogorov_smirnov_uniform(values).p < 0.05) ++ks_alarms;
    if (chi_squared(observed, expected).p < 0.05) ++chi_alarms;
  }
  expect_rate(ks_alarms, kRuns, 0.05);
  expect_rate(chi_alarms, kRuns, 0.05);
}

TEST(StatisticsCalibration, EquivalenceIsGrantedToAnOutsiderAtRateAlpha) {
  // True value exactly at the margin: granted with probability alpha (the far side is 20 errors away).
  constexpr std::size_t kRuns = 4000;
  Generator generator(6);
  std::size_t granted = 0;
  for (std::size_t run = 0; run < kRuns; ++run) {
    if (equivalent({10.0 + normal(generator), 1.0}, 0.0, 10.0, 0.05)) ++granted;
  }
  expect_rate(granted, kRuns, 0.05);
}

// ---------------------------------------------------------------- power: planted shifts are found

TEST(StatisticsPower, DetectableShiftIsFoundAsOftenAsClaimed) {
  constexpr std::size_t kRuns = 4000;
  Generator generator(7);
  const double shift = detectable_shift(1.0, 0.01, 0.9);
  // z_{0.995} + z_{0.9} = 2.5758293 + 1.2815516.
  EXPECT_LE(std::abs(shift - 3.8573809), 1e-7);
  std::size_t found = 0;
  for (std::size_t run = 0; run < kRuns; ++run) {
    if (two_sided_p(shift + normal(generator)) < 0.01) ++found;
  }
  expect_rate(found, kRuns, 0.9);
  EXPECT_THROW((void)detectable_shift(1.0, 0.0, 0.9), InputError);
}

TEST(StatisticsPower, WelchFindsAPlantedShift) {
  // Shift 1 with two times 100 values of spread 1: t is about 1 / sqrt(0.02) = 7.
  Generator generator(8);
  const Estimate a = estimate(normals(generator, 100, 1.0));
  const Estimate b = estimate(normals(generator, 100));
  EXPECT_LE(welch(a, 100, b, 100).p, 1e-4);
}

}  // namespace
}  // namespace plumbline::metrics
