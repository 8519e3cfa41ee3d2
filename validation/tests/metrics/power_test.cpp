#include "validation/metrics/power.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "reference/base/error.hpp"
#include "validation/metrics/statistics.hpp"

namespace plumbline::metrics {
namespace {

constexpr double kFreedom = 15.0;

/// A sample of 16 normal values with mean `shift` standard errors: its t.
double drawn_t(std::mt19937_64& random, double shift) {
  RunningMoments moments;
  for (int i = 0; i < 16; ++i) {
    const double u = (static_cast<double>(random() >> 11U) + 0.5) * 0x1p-53;
    const double v = (static_cast<double>(random() >> 11U) + 0.5) * 0x1p-53;
    moments.add(std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * M_PI * v) + shift / 4.0);
  }
  return moments.mean() / moments.estimate().standard_error;
}

TEST(Power, StudentPowerIsTheRateOfRejections) {
  std::mt19937_64 random(1);
  for (const double shift : {0.0, 1.0, 3.0, 5.0}) {
    const double limit = two_sided_t(0.01, kFreedom);
    std::size_t rejected = 0;
    for (int i = 0; i < 20000; ++i) rejected += std::abs(drawn_t(random, shift)) > limit ? 1U : 0U;
    const Proportion rate = proportion(rejected, 20000, 1e-4);
    const double stated = student_power(shift, 0.01, kFreedom);
    EXPECT_LE(rate.low, stated) << shift;
    EXPECT_GE(rate.high, stated) << shift;
  }
  EXPECT_EQ(student_power(0.0, 0.01, kFreedom), 0.01);
  EXPECT_EQ(student_power(1e6, 0.01, kFreedom), 1.0);
  EXPECT_NEAR(student_power(-3.0, 0.01, kFreedom), student_power(3.0, 0.01, kFreedom), 1e-12);
  EXPECT_THROW((void)student_power(NAN, 0.01, kFreedom), InputError);
}

TEST(Power, StudentPowerTendsToTheNormalOne) {
  const double z = two_sided_z(0.01);
  const double normal =
      0.5 * std::erfc((z - 3.0) / std::sqrt(2.0)) + 0.5 * std::erfc((z + 3.0) / std::sqrt(2.0));
  EXPECT_NEAR(student_power(3.0, 0.01, 1e6), normal, 1e-4);
}

TEST(Power, EquivalencePowerIsTheRateOfPasses) {
  std::mt19937_64 random(2);
  const double alpha = 0.01;
  for (const auto& [shift, margin] : {std::pair(0.0, 4.0), {1.0, 4.0}, {4.0, 4.0}}) {
    const double t = two_sided_t(2.0 * alpha, kFreedom);
    std::size_t passed = 0;
    for (int i = 0; i < 20000; ++i) {
      // mean and spread of a sample from its t and a second, independent look: mean = t s
      RunningMoments moments;
      for (int k = 0; k < 16; ++k) {
        const double u = (static_cast<double>(random() >> 11U) + 0.5) * 0x1p-53;
        const double v = (static_cast<double>(random() >> 11U) + 0.5) * 0x1p-53;
        moments.add(4.0 * std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * M_PI * v) + shift);
      }
      passed += std::abs(moments.mean()) + t * moments.estimate().standard_error <= margin ? 1U : 0U;
    }
    const Proportion rate = proportion(passed, 20000, 1e-4);
    const double stated = equivalence_power(shift, margin, alpha, kFreedom);
    EXPECT_LE(rate.low, stated + 1e-3) << shift;  // 1e-3: the quadrature's accuracy
    EXPECT_GE(rate.high, stated - 1e-3) << shift;
  }
}

TEST(Power, LargestStandardErrorGivesTheWantedPower) {
  for (const double alpha : {1e-6, 0.01}) {
    const double error = largest_standard_error(alpha, 0.9, 60.0);
    EXPECT_NEAR(equivalence_power(0.0, 1.0 / error, alpha, 60.0), 0.9, 1e-4);
  }
  EXPECT_THROW((void)largest_standard_error(0.6, 0.9, 60.0), InputError);
}

TEST(Power, SpreadBoundIsSeldomPassed) {
  std::mt19937_64 random(3);
  std::size_t passed = 0;
  for (int i = 0; i < 20000; ++i) {
    RunningMoments moments;
    for (int k = 0; k < 16; ++k) {
      const double u = (static_cast<double>(random() >> 11U) + 0.5) * 0x1p-53;
      const double v = (static_cast<double>(random() >> 11U) + 0.5) * 0x1p-53;
      moments.add(std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * M_PI * v));
    }
    passed += std::sqrt(moments.variance()) * spread_bound(0.95, kFreedom) < 1.0 ? 1U : 0U;
  }
  EXPECT_GE(binomial_p(passed, 20000, 0.05), 1e-4) << passed;
}

TEST(Power, ProportionsHaveExactIntervals) {
  const Proportion none = proportion(0, 100, 0.05);
  EXPECT_EQ(none.low, 0.0);
  EXPECT_NEAR(none.high, 1.0 - std::pow(0.025, 0.01), 1e-12);  // (1 - p)^100 = 0.025
  const Proportion all = proportion(100, 100, 0.05);
  EXPECT_EQ(all.high, 1.0);
  EXPECT_NEAR(all.low, std::pow(0.025, 0.01), 1e-12);
  EXPECT_THROW((void)proportion(3, 2, 0.05), InputError);
}

TEST(Power, BinomialPKnowsBothTails) {
  EXPECT_NEAR(binomial_p(0, 10, 0.5), 2.0 / 1024.0, 1e-12);
  EXPECT_NEAR(binomial_p(10, 10, 0.5), 2.0 / 1024.0, 1e-12);
  EXPECT_EQ(binomial_p(5, 10, 0.5), 1.0);
  EXPECT_THROW((void)binomial_p(1, 0, 0.5), InputError);
}

}  // namespace
}  // namespace plumbline::metrics
