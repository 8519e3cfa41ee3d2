#include "reference/integrate/film.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "validation/metrics/statistics.hpp"

namespace plumbline::integrate {
namespace {

TEST(RandomisedMean, EqualsTheFormulaForIndependentSamples) {
  RandomisedMean mean(4);
  const double values[] = {1.0, 2.0, 4.0, 9.0};
  for (int i = 0; i < 4; ++i) mean.add(i, RgbD(values[i]));
  const RgbEstimate e = mean.estimate();
  // mean 4, sum of squared deviations 9 + 4 + 0 + 25 = 38; variance of the mean 38 / 3 / 4
  EXPECT_DOUBLE_EQ(e.mean.x, 4.0);
  EXPECT_LE(std::abs(e.standard_error.x - std::sqrt(38.0 / 12.0)), 1e-15);
}

TEST(RandomisedMean, OneSampleHasNoStandardError) {
  RandomisedMean mean(1);
  mean.add(0, RgbD(2.0));
  EXPECT_TRUE(std::isinf(mean.estimate().standard_error.y));
}

// z = mean / standard error of data with true mean 0 follows Student's t with 15 degrees of freedom, also
// when the samples within a randomisation are correlated.
TEST(RandomisedMean, StandardErrorIsHonestForCorrelatedSamples) {
  std::mt19937_64 random(12);
  std::normal_distribution<double> normal;
  std::vector<double> p;
  for (int trial = 0; trial < 4000; ++trial) {
    double common[kRandomisations];
    for (double& value : common) value = normal(random);
    RandomisedMean mean(64);
    for (int i = 0; i < 64; ++i) mean.add(i, RgbD(common[i % kRandomisations] + 0.1 * normal(random)));
    const RgbEstimate e = mean.estimate();
    p.push_back(metrics::two_sided_p_student(e.mean.x / e.standard_error.x, kRandomisations - 1));
  }
  EXPECT_GE(metrics::kolmogorov_smirnov_uniform(p).p, 1e-3);
  // The same z-scores against the wrong idea that all 64 samples are independent are far too large.
  for (double& value : p) value = std::min(1.0, value * 0.5);
  EXPECT_LE(metrics::kolmogorov_smirnov_uniform(p).p, 1e-6);
}

TEST(Combined, WeighsRoundsByTheirSamples) {
  const RgbEstimate a{RgbD(1.0), RgbD(0.3), 10};
  const RgbEstimate b{RgbD(4.0), RgbD(0.4), 30};
  const RgbEstimate c = combined(a, b);
  EXPECT_DOUBLE_EQ(c.mean.x, 3.25);
  EXPECT_LE(std::abs(c.standard_error.x - std::hypot(0.25 * 0.3, 0.75 * 0.4)), 1e-15);
  EXPECT_EQ(c.samples, 40);
}

}  // namespace
}  // namespace plumbline::integrate
