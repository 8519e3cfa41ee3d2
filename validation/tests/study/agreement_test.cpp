#include "validation/study/agreement.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <string>

#include "reference/base/error.hpp"
#include "validation/study/method.hpp"
#include "validation/study/preset.hpp"

namespace plumbline::study {
namespace {

using checks::Finding;
using checks::Verdict;

constexpr int kSide = 128;

/// A gradient from 0.5 to 1.5 with relative noise, and a factor on one 16 x 16 tile and on all.
image::Image picture(unsigned seed, float noise, float tile_factor = 1.0F, float factor = 1.0F) {
  std::mt19937 engine(seed);
  std::normal_distribution<float> normal(0.0F, noise);
  image::Image image = image::make_image(kSide, kSide);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const float value = 0.5F + static_cast<float>(x) / kSide;
      const float local = x / 16 == 3 && y / 16 == 5 ? tile_factor : 1.0F;
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] = factor * local * value * (1.0F + normal(engine));
    }
  return image;
}

Halved halved(unsigned seed, float noise, float tile_factor = 1.0F, float factor = 1.0F) {
  return {picture(seed, noise, tile_factor, factor), picture(seed + 1, noise, tile_factor, factor)};
}

const Finding& find(const Agreement& agreement, const std::string& part) {
  for (const Finding& finding : agreement.findings)
    if (finding.name.find(part) != std::string::npos) return finding;
  throw InputError("no finding " + part);
}

TEST(Agreement, PassesForTheSameImageWithDifferentNoise) {
  const Agreement agreement = compare_renderers("a against b", halved(1, 0.05F), halved(3, 0.05F));
  ASSERT_EQ(agreement.findings.size(), 5U);
  for (const Finding& finding : agreement.findings) EXPECT_EQ(finding.verdict, Verdict::pass) << finding.name;
  EXPECT_EQ(agreement.tiles.columns, 8);
  EXPECT_EQ(agreement.z_map.width, kSide);
}

// 2 % too bright everywhere: four times the mean's margin; the noise of the mean is 0.05 / sqrt(2 * 128^2) or so.
TEST(Agreement, SeesAFactorOnAll) {
  const Agreement agreement =
      compare_renderers("a against b", halved(1, 0.05F), halved(3, 0.05F, 1.0F, 1.02F));
  EXPECT_EQ(find(agreement, "mean difference").verdict, Verdict::fail);
  EXPECT_NEAR(find(agreement, "mean difference").measured, 0.02, 0.002);
  EXPECT_EQ(find(agreement, "median").verdict, Verdict::fail);
}

// 3 % on one tile of 64 moves the mean by 0.05 % only. The tile's mean has a noise of 0.05 / sqrt(2) / 16 per image and channels that
// are independent: z is about 0.03 / 0.0018.
TEST(Agreement, SeesASingleTile) {
  const Agreement agreement = compare_renderers("a against b", halved(1, 0.05F), halved(3, 0.05F, 1.03F));
  EXPECT_EQ(find(agreement, "mean difference").verdict, Verdict::pass);
  EXPECT_EQ(find(agreement, "tiles").verdict, Verdict::fail);
  EXPECT_GT(agreement.tiles.z[5 * 8 + 3], 5.0);
}

TEST(Agreement, IsUndecidedWhereNoiseHidesTheAnswer) {
  const Agreement agreement = compare_renderers("a against b", halved(1, 3.0F), halved(3, 3.0F));
  EXPECT_EQ(find(agreement, "mean difference").verdict, Verdict::inconclusive);
}

TEST(Agreement, FailsForNaN) {
  Halved broken = halved(3, 0.05F);
  broken.a.pixels[77].y = std::numeric_limits<float>::quiet_NaN();
  const Agreement agreement = compare_renderers("a against b", halved(1, 0.05F), broken);
  EXPECT_EQ(find(agreement, "mean difference").verdict, Verdict::fail);
  EXPECT_EQ(find(agreement, "tiles").verdict, Verdict::fail);
}

TEST(Agreement, IsPerfectForEqualImagesWithoutNoise) {
  const image::Image flat = image::make_image(40, 24, Rgb(2.0F));
  const Agreement agreement = compare_renderers("a against b", {flat, flat}, {flat, flat});
  for (const Finding& finding : agreement.findings) EXPECT_EQ(finding.verdict, Verdict::pass) << finding.name;
}

TEST(SharedLight, KeepsImagesAndConstantsAndAveragesTheRest) {
  EXPECT_FALSE(shared_light(light::make_builtin_environment("white")).is_resampled);
  const SharedLight sun = shared_light(light::make_builtin_environment("sun-sky"));
  ASSERT_TRUE(sun.is_resampled);
  EXPECT_TRUE(sun.environment.suns.empty());
  EXPECT_EQ(sun.environment.texels, 1024U * 512U);
  EXPECT_FALSE(shared_light(sun.environment).is_resampled);
}

TEST(Presets, BunnyStandsOnItsGround) {
  const Preset bunny = make_preset("bunny");
  EXPECT_EQ(bunny.scene.triangles.size(), 69668U);  // 69,666 of the mesh and the ground's two
  const scene::Bounds box = scene::bounds(bunny.scene);
  EXPECT_EQ(box.low, Vec3(-6.0F, 0.0F, -6.0F));
  EXPECT_EQ(make_preset("cornell").scene.triangles.size(), 32U);
  EXPECT_THROW((void)make_preset("teapot"), InputError);
}

}  // namespace
}  // namespace plumbline::study
