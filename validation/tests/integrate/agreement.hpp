// validation/tests/integrate/agreement.hpp: estimates of the path tracer held against closed forms.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "reference/integrate/gather.hpp"
#include "reference/integrate/path.hpp"
#include "reference/trace/surface_point.hpp"

namespace plumbline::test {

/// Agreement of an estimate with a truth known up to a relative model error (tessellation, finite planes; 0 =
/// exact). An estimate whose relative standard error is above `precision` proves nothing and does not pass.
inline bool agrees(double mean, double standard_error, double truth, double model_error, double precision) {
  constexpr double kRounding =
      2e-6;  // float storage of radiance, albedo and geometry: a few units of 6e-8 a step
  const double slack = (model_error + kRounding) * std::abs(truth);
  return standard_error <= precision * std::abs(truth) &&
         std::abs(mean - truth) <= 4.0 * standard_error + slack;
}

inline void expect_agrees(double mean, double standard_error, double truth, double model_error = 0.0,
                          double precision = 0.001) {
  const auto is_accepted = [&](double value) {
    return agrees(value, standard_error, truth, model_error, precision);
  };
  EXPECT_TRUE(is_accepted(mean)) << "estimate " << mean << " +- " << standard_error << ", truth " << truth
                                 << ", relative difference " << mean / truth - 1.0;
  EXPECT_FALSE(is_accepted((1.0 + 10.0 * precision) * mean)) << "an error of 10 precisions would pass";
  EXPECT_FALSE(is_accepted((1.0 - 10.0 * precision) * mean)) << "an error of -10 precisions would pass";
  EXPECT_FALSE(is_accepted(NAN));
}

inline void expect_agrees(const integrate::RgbEstimate& estimate, double truth, double model_error = 0.0,
                          double precision = 0.001) {
  expect_agrees(estimate.mean.y, estimate.standard_error.y, truth, model_error, precision);
}

inline integrate::RgbEstimate irradiance(const integrate::World& world, const trace::SurfacePoint& point,
                                         int samples, int bounces = integrate::kAllBounces) {
  integrate::GatherSettings settings;
  settings.samples = samples;
  settings.max_bounces = bounces;
  settings.seed = 20240229;
  return integrate::gather_irradiance(world, point, 1, settings);
}

inline integrate::RgbEstimate irradiance(const integrate::World& world, Vec3 position, Vec3 normal,
                                         int samples, int bounces = integrate::kAllBounces) {
  return irradiance(world, trace::free_point(position, glm::normalize(normal)), samples, bounces);
}

/// Mean irradiance over an area: jittered points on a strata x strata grid mapped by `place`, one path each,
/// 16 independent repetitions.
inline integrate::RgbEstimate mean_irradiance(const integrate::World& world,
                                              const std::function<trace::SurfacePoint(Vec2)>& place,
                                              int strata, int bounces) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
  integrate::RandomisedMean mean(integrate::kRandomisations);
  integrate::BounceTerms terms;
  for (int r = 0; r < integrate::kRandomisations; ++r) {
    RgbD sum(0.0);
    for (int i = 0; i < strata * strata; ++i) {
      const Vec2 u((static_cast<float>(i % strata) + uniform(random)) / static_cast<float>(strata),
                   (static_cast<float>(i / strata) + uniform(random)) / static_cast<float>(strata));
      integrate::Sampler sampler(11, static_cast<std::uint64_t>(i), static_cast<std::uint32_t>(r), 0);
      terms.clear();
      integrate::add_irradiance(world, place(u), bounces, sampler, terms);
      for (const RgbD& term : terms) sum += term;
    }
    mean.add(r, sum / static_cast<double>(strata * strata));
  }
  return mean.estimate();
}

}  // namespace plumbline::test
