// validation/tests/light/sampling.hpp: estimates by EnvironmentSampler, and its samples held against its density.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "validation/tests/light/support.hpp"

namespace plumbline::light::testing {

inline constexpr int kSamples = 200000;

// ---------------------------------------------------------------- estimates

struct Estimate {
  double mean = 0.0;
  double standard_error = 0.0;
};

using Integrand = std::function<double(const Vec3& direction, const Rgb& radiance)>;

// Mean and standard error of f / pdf over the sampler's directions.
inline Estimate estimate(const Environment& environment, const Integrand& f, int samples = kSamples) {
  const EnvironmentSampler sampler(environment);
  Numbers numbers;
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < samples; ++i) {
    const auto sample = sampler.sample(numbers.next_pair());
    const double value = sample ? f(sample->direction, sample->radiance) / sample->pdf : 0.0;
    sum += value;
    squares += value * value;
  }
  const double mean = sum / samples;
  return {mean, std::sqrt(std::max(0.0, squares / samples - mean * mean) / (samples - 1))};
}

inline Estimate irradiance(const Environment& environment, const Vec3d& normal, int samples = kSamples) {
  return estimate(
      environment,
      [&](const Vec3& direction, const Rgb& radiance) {
        return static_cast<double>(radiance.x) * std::max(0.0, glm::dot(Vec3d(direction), normal));
      },
      samples);
}

inline Estimate total(const Environment& environment) {
  return estimate(environment,
                  [](const Vec3&, const Rgb& radiance) { return static_cast<double>(radiance.x); });
}

// 4 standard errors (false alarm 6e-5 a test with a fixed seed), and 1e-6 for float radiance and direction
// where sampling is in exact proportion and leaves no noise.
inline void expect_agrees(const Estimate& found, double expected, const char* what) {
  const double tolerance = 4.0 * found.standard_error + 1e-6 * std::abs(expected);
  EXPECT_LE(std::abs(found.mean - expected), tolerance)
      << what << ": " << found.mean << " +- " << found.standard_error << ", expected " << expected;
}

// The test must also be able to tell two per cent: else it proves nothing.
inline void expect_shown(const Estimate& found, double expected, const char* what) {
  expect_agrees(found, expected, what);
  EXPECT_LE(4.0 * found.standard_error, 0.02 * std::abs(expected)) << what;
}

// ---------------------------------------------------------------- chi-squared

// Probabilities of bins x bins/2 world lat-long bins, by the midpoint rule with exact solid angles.
using Density = std::function<double(const Vec3& direction)>;
inline std::vector<double> bin_probabilities(const Density& pdf, int bins, int points) {
  const int width = bins * points;
  const int height = bins / 2 * points;
  std::vector<double> result(static_cast<std::size_t>(bins) * static_cast<std::size_t>(bins / 2));
  for (int y = 0; y < height; ++y) {
    const double omega = texel_solid_angle(y, width, height);
    for (int x = 0; x < width; ++x) {
      const auto bin = static_cast<std::size_t>(y / points * bins + x / points);
      result[bin] += omega * pdf(texel_centre(x, y, width, height));
    }
  }
  return result;
}

inline std::vector<double> bin_counts(const EnvironmentSampler& sampler, int bins, int samples,
                                      const glm::mat3& back) {
  std::vector<double> result(static_cast<std::size_t>(bins) * static_cast<std::size_t>(bins / 2));
  Numbers numbers;
  for (int i = 0; i < samples; ++i) {
    const auto sample = sampler.sample(numbers.next_pair());
    if (!sample) continue;
    const Vec2 uv = lat_long_from_direction(back * sample->direction);
    const int x = std::min(static_cast<int>(uv.x * static_cast<float>(bins)), bins - 1);
    const int y = std::min(static_cast<int>(uv.y * static_cast<float>(bins / 2)), bins / 2 - 1);
    result[static_cast<std::size_t>(y * bins + x)] += 1.0;
  }
  return result;
}

struct ChiSquared {
  double statistic = 0.0;
  double critical = 0.0;  // exceeded with probability 1e-6
  [[nodiscard]] bool passes() const { return statistic <= critical; }
};

// Pearson's statistic; bins that expect fewer than 10 are pooled. The critical value is Wilson and
// Hilferty's: (chi^2 / k)^(1/3) is nearly normal with mean 1 - 2 / 9k and variance 2 / 9k; 4.753 sigma has a
// tail of 1e-6.
inline ChiSquared chi_squared(const std::vector<double>& counts, const std::vector<double>& probabilities,
                              int samples) {
  double statistic = 0.0;
  double pooled_expected = 0.0;
  double pooled_count = 0.0;
  int cells = 0;
  const auto add = [&](double expected, double count) {
    statistic += (count - expected) * (count - expected) / expected;
    ++cells;
  };
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double expected = probabilities[i] * samples;
    if (expected >= 10.0) {
      add(expected, counts[i]);
    } else {
      pooled_expected += expected;
      pooled_count += counts[i];
    }
  }
  if (pooled_expected > 0.0) add(pooled_expected, pooled_count);
  if (pooled_expected <= 0.0 && pooled_count > 0.0) statistic = std::numeric_limits<double>::infinity();
  const double k = std::max(1, cells - 1);
  const double root = 1.0 - 2.0 / (9.0 * k) + 4.753 * std::sqrt(2.0 / (9.0 * k));
  return {statistic, k * root * root * root};
}

}  // namespace plumbline::light::testing
