#include "validation/checks/error_parts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "reference/base/error.hpp"

namespace plumbline::checks {
namespace {

constexpr std::size_t kWidth = 160;
constexpr std::size_t kHeight = 128;
constexpr double kNoise = 0.05;
using Value = std::function<double(std::size_t pixel)>;

double truth(std::size_t pixel) {
  return 1.0 + 0.3 * std::sin(0.1 * static_cast<double>(pixel % kWidth));
}
double interpolation(std::size_t pixel) {
  return pixel % 2 == 0 ? 0.02 : -0.02;
}
double truncation(std::size_t pixel) {
  return pixel % 3 == 0 ? 0.1 : -0.1;
}

/// An image of this value with independent noise.
Image noisy(const Value& value, double sigma, std::mt19937& random) {
  std::normal_distribution<double> normal(0.0, sigma);
  Image result = image::make_image(kWidth, kHeight);
  for (std::size_t i = 0; i < result.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) result.pixels[i][c] = static_cast<float>(value(i) + normal(random));
  }
  return result;
}

/// Views that differ exactly as they may; `fault` is what the method adds beyond.
Parts parts_of(const Value& fault) {
  std::mt19937 random(17);
  const Image variance = image::make_image(kWidth, kHeight, Rgb(static_cast<float>(kNoise * kNoise)));
  const Value full = [](std::size_t i) { return truth(i) + truncation(i); };
  const Value vertices = [](std::size_t i) { return truth(i) + interpolation(i); };
  const Value method = [&](std::size_t i) { return vertices(i) + fault(i); };
  Pictures p;
  p.full = {noisy(full, kNoise, random), variance, 0.0};
  p.band_limited = {noisy(truth, kNoise, random), variance, 0.0};
  p.vertex_a = noisy(vertices, 0.03, random);
  p.vertex_b = noisy(vertices, 0.03, random);
  p.prt_a = noisy(method, 0.02, random);
  p.prt_b = noisy(method, 0.02, random);
  return measure(p, Mask(kWidth * kHeight, true));
}

int failures(const Parts& parts) {
  int count = 0;
  for (const Finding& finding : judge_parts("case", parts, 1e-4)) {
    count += finding.verdict != Verdict::pass ? 1 : 0;
  }
  return count;
}

void expect_near(const metrics::Estimate& found, double expected) {
  EXPECT_LE(std::abs(found.mean - expected), 4.5 * found.standard_error);
  EXPECT_LE(found.standard_error, 0.2 * expected);  // else nothing was tested
}

TEST(ErrorParts, AreMeasuredWithoutTheNoiseOfTheTruth) {
  const Parts parts = parts_of([](std::size_t) { return 0.0; });
  expect_near(parts.interpolation, 0.02 * 0.02);
  expect_near(parts.truncation, 0.1 * 0.1);
  expect_near(parts.bake_noise, 0.02 * 0.02 / 2.0);  // of the mean of two halves
  expect_near(parts.without_bake_noise, 0.02 * 0.02);
  expect_near(parts.band_limited, 1.5 * 0.02 * 0.02);
  EXPECT_EQ(failures(parts), 0);
}

TEST(ErrorParts, FaultsOfTheMethodAreFound) {
  EXPECT_GE(failures(parts_of([](std::size_t i) { return 0.01 * truth(i); })), 1);               // 1 % bright
  EXPECT_GE(failures(parts_of([](std::size_t i) { return (1.0 / kPi - 1.0) * truth(i); })), 2);  // 1/pi twice
  EXPECT_GE(failures(parts_of([](std::size_t i) { return i % 4 < 2 ? 0.05 : -0.05; })), 1);  // wrong places
  EXPECT_EQ(failures(parts_of([](std::size_t i) { return i == 0 ? std::nan("") : 0.0; })), 3);
}

TEST(TileMean, NeedsTwoTiles) {
  Mask mask(kWidth * kHeight, false);
  const auto one = [](std::size_t, int) { return 1.0; };
  mask[0] = true;
  EXPECT_THROW((void)tile_mean(mask, kWidth, kHeight, one), InputError);
  mask[20] = true;
  EXPECT_EQ(tile_mean(mask, kWidth, kHeight, one).mean, 1.0);
}

}  // namespace
}  // namespace plumbline::checks
