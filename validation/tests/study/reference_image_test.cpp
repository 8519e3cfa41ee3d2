#include "validation/study/reference_image.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "reference/base/error.hpp"
#include "reference/image/exr.hpp"
#include "validation/tests/app/processes.hpp"

namespace plumbline::study {
namespace {

constexpr int kSide = 64;
constexpr double kValues = 3.0 * kSide * kSide;

/// 1 + noise of one standard deviation a value.
image::Image noisy(float mean, float sigma, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<float> noise(0.0F, sigma);
  image::Image image = image::make_image(kSide, kSide);
  for (Rgb& pixel : image.pixels)
    for (int c = 0; c < 3; ++c) pixel[c] = mean + noise(engine);
  return image;
}

TEST(Relmse, IsTheDefinitionForAnExactReference) {
  const image::Image two = image::make_image(2, 1, Rgb(2.0F));
  const image::Image three = image::make_image(2, 1, Rgb(3.0F));
  EXPECT_DOUBLE_EQ(relmse(three, {two, two}), 1.0 / 4.01);
  EXPECT_EQ(own_relmse({two, two}), 0.0);
}

// (v - r)^2 is s_v^2 + s_r^2 on average; the product of the halves leaves s_v^2. Of N = 12288 normal values the mean of
// (v - a)(v - b) has variance (2 s_v^4 + 2 s_v^2 s_h^2 + s_h^4) / N with s_h^2 = 2 s_r^2: 5 sigma.
TEST(Relmse, LeavesOutTheNoiseOfTheReference) {
  const float sigma = 0.01F;
  const Halved reference{noisy(1.0F, sigma, 1), noisy(1.0F, sigma, 2)};
  const image::Image test = noisy(1.0F, sigma, 3);
  const double square = 1e-4;
  const double bound = 5.0 * std::sqrt(5.0) * square / std::sqrt(kValues) / 1.01;
  EXPECT_NEAR(relmse(test, reference), square / 1.01, bound);
  const image::Image mean = mean_of(reference);
  const double naive = relmse(test, {mean, mean});
  EXPECT_GT(naive, square / 1.01 + bound) << "the noise of the reference must show where it is not taken off";
  EXPECT_NEAR(naive - own_relmse(reference), relmse(test, reference), 1e-9);
}

TEST(Relmse, IsNanWhereAnythingIsNotFinite) {
  const image::Image one = image::make_image(2, 2, Rgb(1.0F));
  image::Image broken = one;
  broken.pixels[3].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(std::isnan(relmse(broken, {one, one})));
  EXPECT_TRUE(std::isnan(relmse(one, {broken, one})));
}

TEST(Relmse, RefusesDifferentSizes) {
  const image::Image small = image::make_image(2, 2);
  const image::Image large = image::make_image(3, 2);
  EXPECT_THROW((void)relmse(small, {large, large}), InputError);
  EXPECT_THROW((void)make_reference({{"one", {small, small}}, {"two", {large, large}}}), InputError);
  EXPECT_THROW((void)make_reference({}), InputError);
}

TEST(ReferenceFile, ComesBackWithItsRenderers) {
  const test::ScratchFolder folder("reference-file");
  const std::map<std::string, Halved> renderers = {{"one", {noisy(1.0F, 0.1F, 1), noisy(1.0F, 0.1F, 2)}},
                                                   {"two", {noisy(1.0F, 0.1F, 3), noisy(1.0F, 0.1F, 4)}}};
  save_reference(folder / "r.exr", renderers, {{"plumbline.sceneHash", "x"}});
  const LoadedReference loaded = load_reference(folder / "r.exr");
  EXPECT_TRUE(loaded.has_halves);
  EXPECT_EQ(loaded.attributes.at("plumbline.sceneHash"), "x");
  ASSERT_EQ(loaded.renderers.size(), 2U);
  EXPECT_EQ(loaded.renderers.at("two").b.pixels, renderers.at("two").b.pixels);
  const Halved reference = make_reference(renderers);
  EXPECT_EQ(loaded.reference.a.pixels, reference.a.pixels);
  EXPECT_FLOAT_EQ(reference.a.pixels[0].x,
                  0.5F * (renderers.at("one").a.pixels[0].x + renderers.at("two").a.pixels[0].x));
}

TEST(ReferenceFile, WithoutHalvesIsTakenAsExact) {
  const test::ScratchFolder folder("reference-file");
  image::LayeredImage file{2, 2, {}, {}};
  image::set_rgb_layer(file, "", image::make_image(2, 2, Rgb(0.5F)));
  image::write_exr(folder / "r.exr", file);
  const LoadedReference loaded = load_reference(folder / "r.exr");
  EXPECT_FALSE(loaded.has_halves);
  EXPECT_TRUE(loaded.renderers.empty());
  EXPECT_EQ(own_relmse(loaded.reference), 0.0);
  file.channels.erase("G");
  image::write_exr(folder / "r.exr", file);
  EXPECT_THROW((void)load_reference(folder / "r.exr"), InputError);
}

}  // namespace
}  // namespace plumbline::study
