#include "reference/integrate/gather.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "pieces.hpp"
#include "reference/base/error.hpp"
#include "reference/scene/builtin.hpp"

namespace plumbline::integrate {
namespace {

const World& cornell() {
  static const World world(scene::make_builtin_scene("cornell"), test::no_sky());
  return world;
}

std::vector<trace::SurfacePoint> some_points() {
  std::vector<trace::SurfacePoint> points = trace::vertex_points(cornell().scene);
  points.resize(std::min<std::size_t>(points.size(), 12));
  return points;
}

GatherSettings settings_with(int samples, int bounces) {
  GatherSettings settings;
  settings.samples = samples;
  settings.max_bounces = bounces;
  settings.seed = 77;
  return settings;
}

bool is_same(const RgbEstimate& a, const RgbEstimate& b) {
  return a.mean == b.mean && a.standard_error == b.standard_error && a.samples == b.samples;
}

TEST(GatherBounces, SumIsExactlyTheIrradianceAndItsPartsAddUpToIt) {
  const auto points = some_points();
  const GatherSettings settings = settings_with(200, 3);
  const auto irradiance = gather_irradiance(cornell(), points, settings);
  const auto split = gather_bounces(cornell(), points, settings);
  double indirect = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_TRUE(is_same(split[i].irradiance, irradiance[i]));
    ASSERT_EQ(split[i].bounces.size(), 4U);
    RgbD sum(0.0);
    for (const RgbEstimate& part : split[i].bounces) sum += part.mean;
    // The same doubles in another order: 800 additions of positive terms.
    EXPECT_LE(glm::length(sum - irradiance[i].mean), 800 * 2.3e-16 * glm::length(sum) * 2.0);
    const auto single = gather_bounces(cornell(), points[i], i, settings);
    for (std::size_t k = 0; k < 4; ++k) EXPECT_TRUE(is_same(single[k], split[i].bounces[k]));
    indirect += split[i].bounces[1].mean.x;
  }
  EXPECT_GT(indirect, 0.0);  // a first bounce that is left out would show
}

TEST(GatherBounces, NeedsALimit) {
  EXPECT_THROW((void)gather_bounces(cornell(), some_points(), settings_with(4, kAllBounces)), InputError);
}

TEST(GatherTargetError, IsReachedAndNotWildlyOverdone) {
  GatherSettings settings = settings_with(1, kAllBounces);
  settings.target_error = 0.01;
  const auto points = some_points();
  const auto estimates = gather_irradiance(cornell(), points, settings);
  double mean = 0.0;
  double variance = 0.0;
  for (const RgbEstimate& e : estimates) {
    mean += e.mean.x + e.mean.y + e.mean.z;
    variance += glm::dot(e.standard_error, e.standard_error);
    EXPECT_EQ(e.samples, estimates.front().samples);
  }
  const double values = 3.0 * static_cast<double>(points.size());
  const double relative = std::sqrt(variance / values) / (mean / values);
  EXPECT_LE(relative, 0.01);
  EXPECT_GE(relative, 0.001);
  settings.threads = 3;
  const auto again = gather_irradiance(cornell(), points, settings);
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_TRUE(is_same(estimates[i], again[i]));
}

// Rounds are independent: what a target gives agrees with a plain run of another seed.
TEST(GatherTargetError, RoundsEstimateTheSameThing) {
  GatherSettings settings = settings_with(4096, 2);
  const auto points = some_points();
  const auto plain = gather_irradiance(cornell(), points, settings);
  settings.seed = 78;
  settings.target_error = 0.01;
  const auto rounds = gather_bounces(cornell(), points, settings);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const RgbEstimate& a = plain[i];
    const RgbEstimate& b = rounds[i].irradiance;
    const double error = std::hypot(a.standard_error.y, b.standard_error.y);
    EXPECT_LE(std::abs(a.mean.y - b.mean.y), 6.0 * error + 1e-12);
    double sum = 0.0;
    for (const RgbEstimate& part : rounds[i].bounces) sum += part.mean.y;
    EXPECT_LE(std::abs(sum - b.mean.y), 1e-11 * sum);
  }
}

TEST(GatherTargetError, RefusesWhatCannotBe) {
  GatherSettings settings = settings_with(16, 0);
  settings.target_error = 0.0;
  EXPECT_THROW((void)gather_irradiance(cornell(), some_points(), settings), InputError);
  settings.target_error = NAN;
  EXPECT_THROW((void)gather_irradiance(cornell(), some_points(), settings), InputError);
  // Light that takes more than it gives: no mean to be relative to.
  const World negative(test::nothing_in_the_way(),
                       test::analytic_sky([](const Vec3d& d) { return d.y - 2.0; }));
  settings.target_error = 1e-3;
  const trace::SurfacePoint point = trace::free_point(Vec3(0.0F), {0, 1, 0});
  EXPECT_THROW((void)gather_irradiance(negative, std::span(&point, 1), settings), InputError);
}

TEST(GatherTargetError, DarknessIsReachedAtOnce) {
  const World dark(test::nothing_in_the_way(), test::no_sky());
  GatherSettings settings = settings_with(16, 0);
  settings.target_error = 0.01;
  const trace::SurfacePoint point = trace::free_point(Vec3(0.0F), {0, 1, 0});
  const auto estimates = gather_irradiance(dark, std::span(&point, 1), settings);
  EXPECT_EQ(estimates[0].mean, RgbD(0.0));
}

}  // namespace
}  // namespace plumbline::integrate
