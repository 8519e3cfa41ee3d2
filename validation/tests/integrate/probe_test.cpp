// Light probes against closed forms, against exact projections of the light, and against gathered irradiance.
#include "reference/integrate/probe.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "pieces.hpp"
#include "prt/sh/basis.hpp"
#include "prt/sh/lighting.hpp"
#include "reference/base/error.hpp"
#include "reference/scene/builtin.hpp"
#include "validation/metrics/statistics.hpp"

namespace plumbline {
namespace {

using integrate::RgbEstimate;
using integrate::World;

integrate::SphereFunctions sh_functions(int bands) {
  return {static_cast<std::size_t>(sh::coefficient_count(bands)),
          [basis = sh::Basis<double>(bands)](const Vec3d& d, std::span<double> values) {
            basis.evaluate(d.x, d.y, d.z, values);
          }};
}

integrate::SphereFunctions cosine_about(const Vec3d& normal) {
  return {1, [normal](const Vec3d& d, std::span<double> values) {
            values[0] = std::max(0.0, glm::dot(normal, d));
          }};
}

integrate::GatherSettings settings_with(int samples, int bounces = integrate::kAllBounces) {
  integrate::GatherSettings settings;
  settings.samples = samples;
  settings.max_bounces = bounces;
  settings.seed = 4711;
  return settings;
}

std::vector<RgbEstimate> probe(const World& world, Vec3 position, int bands, int samples,
                               int bounces = integrate::kAllBounces) {
  return integrate::gather_probe(world, trace::free_point(position, {0, 1, 0}), sh_functions(bands), 3,
                                 settings_with(samples, bounces));
}

/// What is wrong, or nothing: every coefficient must be within what its standard error allows, a family of tests with one false alarm in 10^4; and
/// no standard error above `precision` times the largest coefficient, so that the agreement means something.
std::string disagreement(const std::vector<RgbEstimate>& estimates, const std::vector<RgbD>& truth,
                         double precision) {
  if (estimates.size() != truth.size()) return "number of coefficients";
  double scale = 0.0;
  for (const RgbD& value : truth) scale = std::max(scale, static_cast<double>(max_magnitude(Vec3(value))));
  const double t =
      metrics::two_sided_t(metrics::sidak(1e-4, 3 * truth.size()), integrate::kRandomisations - 1);
  const double rounding = 2e-6 * scale;  // float radiance and directions, a few units of 6e-8
  for (std::size_t i = 0; i < truth.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double mean = estimates[i].mean[c];
      const double error = estimates[i].standard_error[c];
      if (error <= precision * scale && std::abs(mean - truth[i][c]) <= t * error + rounding) continue;
      return fmt::format("coefficient {} channel {}: {} +- {}, truth {}", i, c, mean, error, truth[i][c]);
    }
  }
  return "";
}

bool agrees(const std::vector<RgbEstimate>& estimates, const std::vector<RgbD>& truth, double precision) {
  return disagreement(estimates, truth, precision).empty();
}

void expect_agrees(const std::vector<RgbEstimate>& estimates, const std::vector<RgbD>& truth,
                   double precision) {
  EXPECT_EQ(disagreement(estimates, truth, precision), "");
}

TEST(Probe, FreePointUnderBandLimitedLightHasItsCoefficients) {
  sh::ShRgb light{3, std::vector<RgbD>(9, RgbD(0.0))};
  for (std::size_t i = 0; i < 9; ++i)
    light.coefficients[i] =
        RgbD(1.0 / (1.0 + static_cast<double>(i)), 0.3 - 0.1 * static_cast<double>(i), 0.5);
  const World world(test::nothing_in_the_way(), sh::band_limited_environment(light, "light"));
  const auto estimates = probe(world, Vec3(0.0F), 4, 16384);
  std::vector<RgbD> truth = light.coefficients;
  truth.resize(16, RgbD(0.0));  // degree 3 is not in it
  expect_agrees(estimates, truth, 2e-3);
  // The other sign of one function, another polar axis and a factor of 1.05 are noticed.
  for (const auto& spoil : {std::function<void()>([&] { truth[3] = -truth[3]; }),
                            std::function<void()>([&] { std::swap(truth[1], truth[2]); }),
                            std::function<void()>([&] { truth[0] *= 1.05; })}) {
    const std::vector<RgbD> right = truth;
    spoil();
    EXPECT_FALSE(agrees(estimates, truth, 2e-3));
    truth = right;
  }
}

// In a closed room whose walls emit e and reflect a, radiance is e (1 + a + … + a^N) from everywhere: only y_00.
TEST(Probe, FurnaceHasOnlyItsFirstCoefficient) {
  scene::Scene room;
  test::add_room(room, 1.0F, test::add_material(room, Rgb(0.2F, 0.5F, 0.8F), Rgb(1.0F, 2.0F, 0.5F)));
  const World world(room, test::no_sky());
  const RgbD albedo(Rgb(0.2F, 0.5F, 0.8F));
  const RgbD emission(1.0, 2.0, 0.5);
  for (const int bounces : {0, 1, 3, integrate::kAllBounces}) {
    RgbD radiance = emission / (1.0 - albedo);
    if (bounces != integrate::kAllBounces) {
      radiance = RgbD(0.0);
      for (int k = 0; k <= bounces; ++k) radiance = emission + albedo * radiance;
    }
    std::vector<RgbD> truth(9, RgbD(0.0));
    truth[0] = std::sqrt(4.0 * kPi) * radiance;
    const auto estimates = probe(world, {0.3F, 0.6F, 0.45F}, 3, 8192, bounces);
    expect_agrees(estimates, truth, 2e-2);
    truth[0] *= 1.05;
    EXPECT_FALSE(agrees(estimates, truth, 2e-2)) << bounces;
  }
}

TEST(Probe, OneTexelSunAndSunDiscConverge) {
  light::Environment texel = test::no_sky();
  image::Image image = image::make_image(64, 32);
  image.at(40, 9) = Rgb(1e4F, 8e3F, 5e3F);
  texel.sky = light::LatLongSky{image};
  light::Environment disc = test::white_sky(0.1F);
  disc.suns.push_back({glm::normalize(Vec3(1, 2, -1)), 0.005, Rgb(1e4F)});
  for (const light::Environment& environment : {texel, disc}) {
    const World world(test::nothing_in_the_way(), environment);
    const sh::ShRgb truth = sh::project_radiance(environment, 4);
    const auto estimates = probe(world, Vec3(0.0F), 4, 4096);
    expect_agrees(estimates, truth.coefficients, 5e-3);
    const sh::ShRgb turned = sh::project_radiance(light::rotated(environment, {0, 10, 0}), 4);
    EXPECT_FALSE(agrees(estimates, turned.coefficients, 5e-3));
  }
}

TEST(Probe, LightsWithoutExtentArePulsesAndCanBeHidden) {
  scene::Scene scene = test::nothing_in_the_way();
  scene.lights.emplace_back(light::DirectionalLight{glm::normalize(Vec3(1, -2, 2)), Rgb(3.0F)});
  scene.lights.emplace_back(light::PointLight{{0, 0, 2}, Rgb(8.0F)});
  const auto y_sun = sh::evaluate_basis(3, glm::normalize(Vec3d(-1, 2, -2)));
  const auto y_lamp = sh::evaluate_basis(3, Vec3d(0, 0, 1));
  std::vector<RgbD> truth;
  for (std::size_t i = 0; i < 9; ++i) truth.emplace_back(3.0 * y_sun[i] + 8.0 / 4.0 * y_lamp[i]);
  expect_agrees(probe(World(scene, test::no_sky()), Vec3(0.0F), 3, 16), truth, 0.0);
  test::add_quad(scene, {-1, -1, 1}, {2, 0, 0}, {0, 2, 0},
                 test::add_material(scene, Rgb(0.0F)));  // before the lamp
  const auto hidden = probe(World(scene, test::no_sky()), Vec3(0.0F), 3, 16);
  EXPECT_FALSE(agrees(hidden, truth, 0.0));
  for (std::size_t i = 0; i < 9; ++i) truth[i] = RgbD(3.0 * y_sun[i]);
  expect_agrees(hidden, truth, 0.0);
  EXPECT_THROW((void)probe(World(scene, test::no_sky()), {0, 0, 2}, 3, 16), InputError);
}

// With y = max(0, n.w) the coefficient is the irradiance that gather_irradiance estimates in its own way.
TEST(Probe, CosineCoefficientIsTheGatheredIrradiance) {
  light::Environment sky = test::white_sky(0.3F);
  sky.suns.push_back({glm::normalize(Vec3(0.3F, 1, 0.4F)), 0.05, Rgb(300.0F)});
  const World cornell(scene::make_builtin_scene("cornell"), test::no_sky());
  const World plain(scene::make_builtin_scene("sphere-on-plane"), sky);
  for (const World* world : {&cornell, &plain}) {
    const scene::Bounds box = scene::bounds(world->scene);
    const Vec3 position = box.low + Vec3(0.45F, 0.62F, 0.58F) * (box.high - box.low);
    for (const Vec3& normal : {Vec3(0, 1, 0), glm::normalize(Vec3(1, -1, 0.5F))}) {
      const trace::SurfacePoint point = trace::free_point(position, normal);
      for (const int bounces : {0, 1, integrate::kAllBounces}) {
        const RgbEstimate gathered =
            integrate::gather_irradiance(*world, point, 1, settings_with(8192, bounces));
        const RgbEstimate probed = integrate::gather_probe(*world, point, cosine_about(Vec3d(normal)), 2,
                                                           settings_with(16384, bounces))[0];
        const double error = std::hypot(gathered.standard_error.x, probed.standard_error.x);
        const double t = metrics::two_sided_t(metrics::sidak(1e-4, 12), integrate::kRandomisations - 1);
        const double scale = gathered.mean.x;
        EXPECT_LE(std::abs(gathered.mean.x - probed.mean.x), t * error + 1e-5 * scale) << bounces;
        EXPECT_LE(t * error, 0.1 * scale) << bounces;  // 10 % off would be found
      }
    }
  }
}

TEST(Probe, IsTheSameForAnyNumberOfThreads) {
  const World world(scene::make_builtin_scene("cornell"), test::white_sky());
  const auto points = trace::vertex_points(world.scene);
  integrate::GatherSettings settings = settings_with(20, 2);
  settings.threads = 1;
  const auto one = integrate::gather_probes(world, points, sh_functions(2), settings);
  settings.threads = 5;
  const auto five = integrate::gather_probes(world, points, sh_functions(2), settings);
  for (std::size_t p = 0; p < points.size(); ++p) {
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(one[p][i].mean, five[p][i].mean);
  }
  EXPECT_NE(one[0][0].mean, one[1][0].mean);
}

TEST(Probe, RefusesAbsurdSettings) {
  const World world(test::nothing_in_the_way(), test::white_sky());
  EXPECT_THROW((void)probe(world, Vec3(0.0F), 2, 0), InputError);
  EXPECT_THROW((void)probe(world, Vec3(0.0F), 2, 4, -1), InputError);
  integrate::GatherSettings settings = settings_with(4);
  settings.target_error = 0.1;
  EXPECT_THROW((void)integrate::gather_probe(world, trace::free_point(Vec3(0.0F), {0, 1, 0}), sh_functions(2),
                                             0, settings),
               InputError);
}

}  // namespace
}  // namespace plumbline
