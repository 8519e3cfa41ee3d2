#include "reference/integrate/direct_view.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "pieces.hpp"
#include "reference/integrate/render.hpp"

namespace plumbline::integrate {
namespace {

constexpr float kRadiance = 17.0F;

/// Sees the square [-1, 1]^2 of the plane z = -1 as one pixel.
scene::Camera square_camera() {
  return scene::look_at({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 90.0F);
}

/// A lamp over the left `coverage` of the pixel, facing the camera (or away from it).
scene::Scene lamp_over(float coverage, bool is_facing = true) {
  scene::Scene scene = test::nothing_in_the_way();
  const std::uint32_t lamp = test::add_material(scene, Rgb(0.0F), Rgb(kRadiance));
  const Vec3 width(2.0F * coverage + 1.0F, 0, 0);
  const Vec3 height(0, 6, 0);
  test::add_quad(scene, {-2, -3, -1}, is_facing ? width : height, is_facing ? height : width, lamp);
  return scene;
}

bool is_uneven(const scene::Scene& scene, const light::Environment& sky, bool is_background_visible = true) {
  const World world(scene, sky);
  return is_emission_uneven(
      world, {Vec3(0.0F), scene::image_plane(square_camera(), 1, 1), 0, 0, is_background_visible});
}

TEST(DirectView, APixelIsUnevenWhereAnEdgeCrossesIt) {
  for (const float coverage : {0.01F, 0.37F, 0.99F}) {
    EXPECT_TRUE(is_uneven(lamp_over(coverage), test::no_sky())) << coverage;
  }
  EXPECT_FALSE(is_uneven(lamp_over(1.01F), test::no_sky()));
  EXPECT_FALSE(is_uneven(lamp_over(0.37F, false), test::no_sky()));  // its back is dark
  EXPECT_FALSE(is_uneven(lamp_over(0.37F), test::white_sky(kRadiance)));
  EXPECT_TRUE(is_uneven(lamp_over(0.37F), test::white_sky(kRadiance), false));
  EXPECT_FALSE(is_uneven(test::nothing_in_the_way(), test::white_sky(), false));
}

// 64 samples in 16 randomisations are sequences of 4 points, split 64: the edge is in one of 4 or of 64 columns, each of one point.
// In that column at most a quarter is the variance, so the standard deviation of the mean coverage is at most 1/2/4/sqrt(16)
// = 0.031 without and 1/2/64/sqrt(16) = 0.0020 with splitting.
TEST(DirectView, SplittingFindsTheCoverage) {
  constexpr double kCoverage = 0.37;
  constexpr int kSeeds = 200;
  constexpr double kSplitDeviation = 0.5 / 64.0 / 4.0;
  const World world(lamp_over(static_cast<float>(kCoverage)), test::no_sky());
  RenderSettings settings;
  settings.width = settings.height = 1;
  settings.samples_per_pixel = 64;
  settings.layers.emission = true;
  double sum = 0.0;
  double squares = 0.0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    settings.seed = static_cast<std::uint64_t>(seed);
    const RenderResult result = render(world, square_camera(), settings);
    const double mean = static_cast<double>(result.image.channels.at("R")[0]) / kRadiance;
    EXPECT_EQ(result.image.channels.at("R"), result.image.channels.at("emission.R"));
    sum += mean;
    squares += (mean - kCoverage) * (mean - kCoverage);
  }
  EXPECT_NEAR(sum / kSeeds, kCoverage, 4.0 * kSplitDeviation / std::sqrt(kSeeds));
  // A fifth more for the estimate of a deviation from 200 values (four times its 5 %); a sixteenth of what unsplit samples have.
  EXPECT_LE(std::sqrt(squares / kSeeds), 1.2 * kSplitDeviation);
  EXPECT_GT(squares, 0.0);
}

}  // namespace
}  // namespace plumbline::integrate
