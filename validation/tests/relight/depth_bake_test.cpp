#include "prt/relight/gl/depth_bake.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "../integrate/pieces.hpp"
#include "gl_context.hpp"
#include "reference/base/error.hpp"
#include "validation/checks/depth_bias.hpp"

namespace plumbline::relight::gl {
namespace {

using checks::depth_bias;
using checks::DepthBias;

// A floor of 32 x 32 quads with a square roof of half its width floating above its middle.
scene::Scene roof_over_floor() {
  scene::Scene scene;
  const std::uint32_t material = test::add_material(scene, Rgb(0.8F));
  for (int z = 0; z < 32; ++z) {
    for (int x = 0; x < 32; ++x)
      test::add_quad(scene,
                     {-2.0F + 0.125F * static_cast<float>(x), 0, -2.0F + 0.125F * static_cast<float>(z)},
                     {0, 0, 0.125F}, {0.125F, 0, 0}, material);
  }
  test::add_quad(scene, {-1, 0.7F, -1}, {0, 0, 2}, {2, 0, 0}, material);
  test::add_quad(scene, {-1, 0.7F, -1}, {2, 0, 0}, {0, 0, 2}, material);
  return scene;
}

DepthBakeSettings settings_of(int resolution, double offset, int directions = 256) {
  DepthBakeSettings settings;
  settings.bands = 3;
  settings.directions = directions;
  settings.resolution = resolution;
  settings.offset = offset;
  return settings;
}

class DepthBakeOn : public test::OnEachProvider {};
INSTANTIATE_TEST_SUITE_P(Providers, DepthBakeOn, testing::Values(Provider::osmesa, Provider::egl),
                         test::name_of);

// With an offset beyond the scene's size nothing is ever in shadow, and both sums have the same terms: a product of two
// roundings each, added N times.
TEST_P(DepthBakeOn, AddsWhatRaysAddWhereNothingBlocks) {
  const auto context = test::context_of(GetParam());
  if (!context) return;
  const scene::Scene scene = roof_over_floor();
  scene::Scene floor = scene;
  floor.triangles.resize(2048);
  floor.triangle_materials.resize(2048);
  const DepthBakeSettings settings = settings_of(64, 64.0);
  const transfer::Transfer depth = bake_from_depth(*context, scene, settings);
  const transfer::Transfer rays = bake_along(floor, settings);
  ASSERT_EQ(depth.coefficients.size(), rays.coefficients.size());
  const std::size_t of_floor = 2048 * 3 * 9;
  double worst = 0.0;
  for (std::size_t i = 0; i < of_floor; ++i)
    worst = std::max(worst, std::abs(static_cast<double>(depth.coefficients[i]) -
                                     static_cast<double>(rays.coefficients[i])));
  EXPECT_LE(worst, 256.0 * std::ldexp(1.0, -24) * 4.0);  // sum of |terms| <= 4 max |y| cos < 4
  // Along many directions it is the closed form: T_0 = y_00.
  EXPECT_NEAR(depth.coefficients[0], 0.5 / std::sqrt(kPi), 0.01);
}

TEST_P(DepthBakeOn, FindsTheShadowAndComesNearerWithResolution) {
  const auto context = test::context_of(GetParam());
  if (!context) return;
  const scene::Scene scene = roof_over_floor();
  const transfer::Transfer rays = bake_along(scene, settings_of(0, 0.0));
  const auto bias = [&](int resolution, double offset) {
    return depth_bias(bake_from_depth(*context, scene, settings_of(resolution, offset)), rays);
  };
  const DepthBias coarse = bias(32, 2.0);
  const DepthBias fine = bias(512, 2.0);
  EXPECT_LT(fine.relative_rmse, 0.5 * coarse.relative_rmse);
  EXPECT_LT(fine.relative_rmse, 0.1);
  // Without an offset surfaces shadow themselves; with one as large as the roof's height its shadow is lost.
  EXPECT_LT(bias(512, 0.0).mean_signed, -0.05);
  const double lost = bias(64, 32.0).mean_signed;
  EXPECT_GT(lost, 0.02);
  EXPECT_LT(std::abs(fine.mean_signed), 0.25 * lost);
}

TEST_P(DepthBakeOn, RefusesWhatIsOutOfRange) {
  const auto context = test::context_of(GetParam());
  if (!context) return;
  const scene::Scene scene = roof_over_floor();
  const auto refuses = [&](DepthBakeSettings settings) {
    EXPECT_THROW((void)bake_from_depth(*context, scene, settings), InputError);
  };
  refuses(settings_of(0, 1.0));
  refuses(settings_of(1 << 20, 1.0));
  refuses(settings_of(64, -1.0));
  refuses(settings_of(64, std::numeric_limits<double>::quiet_NaN()));
  refuses(settings_of(64, 1.0, 0));
  DepthBakeSettings many_bands = settings_of(64, 1.0);
  many_bands.bands = 100;
  refuses(many_bands);
}

TEST(DepthBias, MeasuresRootMeanSquareAndSign) {
  transfer::Transfer rays;
  rays.bands = 1;
  rays.vertices = 2;
  rays.coefficients = {1.0F, 1.0F};
  transfer::Transfer depth = rays;
  depth.coefficients = {0.5F, 1.0F};
  const DepthBias bias = depth_bias(depth, rays);
  EXPECT_NEAR(bias.relative_rmse, std::sqrt(0.125), 1e-12);
  EXPECT_NEAR(bias.mean_signed, -0.25 * std::sqrt(4.0 * kPi), 1e-12);
  EXPECT_NEAR(bias.largest, 0.5 * std::sqrt(4.0 * kPi), 1e-12);
  depth.coefficients.pop_back();
  EXPECT_THROW((void)depth_bias(depth, rays), InputError);
}

}  // namespace
}  // namespace plumbline::relight::gl
