#include "reference/integrate/allocation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace plumbline::integrate {
namespace {

// The left half has ten times the standard error of the right one.
std::vector<RgbEstimate> two_halves(int width, int height) {
  std::vector<RgbEstimate> pilot;
  for (int i = 0; i < width * height; ++i)
    pilot.push_back({RgbD(1.0), RgbD(i % width < width / 2 ? 0.1 : 0.01), 16});
  return pilot;
}

TEST(Allocation, GoesWithTheStandardDeviation) {
  const Allocation allocation(two_halves(32, 8), 32, 8);
  const int noisy = allocation.samples(3, 1600.0, 16);
  const int calm = allocation.samples(28, 1600.0, 16);
  // 1 : 10 would be best; the least weight is a quarter of the mean deviation 0.55 (before weights are made to average 1).
  EXPECT_NEAR(static_cast<double>(noisy) / calm, (0.1 / 0.055) / 0.25, 0.1);
  double sum = 0.0;
  for (std::size_t p = 0; p < 32 * 8; ++p) sum += allocation.samples(p, 1600.0, 16);
  EXPECT_NEAR(sum / (32 * 8), 1600.0, 8.0);  // each is rounded to a multiple of 16
}

TEST(Allocation, SaysWhatItGains) {
  const Allocation allocation(two_halves(64, 64), 64, 64);
  EXPECT_LT(allocation.gain(), 0.7);
  EXPECT_GT(allocation.gain(), (0.055 * 0.055) / (0.5 * (0.1 * 0.1 + 0.01 * 0.01)));  // Cauchy-Schwarz' bound
  EXPECT_EQ(Allocation().gain(), 1.0);
}

TEST(Allocation, DealsEvenlyWhereNothingIsKnown) {
  const std::vector<RgbEstimate> silent(64, {RgbD(1.0), RgbD(0.0), 16});
  EXPECT_TRUE(Allocation(silent, 8, 8).is_uniform());
  const std::vector<RgbEstimate> single(64, {RgbD(1.0), RgbD(INFINITY), 1});
  EXPECT_TRUE(Allocation(single, 8, 8).is_uniform());
}

TEST(Allocation, GivesEveryRandomisationAsMuch) {
  const Allocation allocation(two_halves(32, 8), 32, 8);
  for (const double mean : {2.0, 16.0, 100.0, 1e5}) {
    for (std::size_t p = 0; p < 32 * 8; ++p) {
      const int samples = allocation.samples(p, mean, 16);
      EXPECT_GE(samples, 2);
      EXPECT_TRUE(samples < 16 || samples % 16 == 0) << samples;
    }
  }
}

}  // namespace
}  // namespace plumbline::integrate
