#include "validation/metrics/compare.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "reference/base/error.hpp"
#include "reference/image/exr.hpp"
#include "reference/image/file.hpp"
#include "validation/metrics/statistics.hpp"

namespace plumbline::metrics {
namespace {

using image::Image;
using image::LayeredImage;
using image::make_image;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr float kNanF = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinityF = std::numeric_limits<float>::infinity();

using Generator = std::mt19937_64;
double uniform(Generator& generator) {
  return (static_cast<double>(generator() >> 11U) + 0.5) * 0x1p-53;
}
double normal(Generator& generator) {
  const double radius = std::sqrt(-2.0 * std::log(uniform(generator)));
  return radius * std::cos(2.0 * kPi * uniform(generator));
}

LayeredImage layered(const Image& mean) {
  LayeredImage layers{mean.width, mean.height, {}, {}};
  set_rgb_layer(layers, "", mean);
  return layers;
}

LayeredImage constant(int width, int height, float value) {
  return layered(make_image(width, height, Rgb(value)));
}

// Every pixel different, channels different, mean about 1: no accident hides a swap, a mirror or a factor.
Image picture(int width, int height) {
  Image image = make_image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float u = static_cast<float>(x) / static_cast<float>(width);
      const float v = static_cast<float>(y) / static_cast<float>(height);
      image.at(x, y) = {0.5F + u, 0.8F + 0.4F * v, 1.3F - 0.5F * u * v};
    }
  }
  return image;
}

template <typename Change>
LayeredImage changed(Image image, const Change& change) {
  for (Rgb& pixel : image.pixels) change(pixel);
  return layered(image);
}

// ---------------------------------------------------------------- values

TEST(Compare, OfAnImageWithItselfFindsNothing) {
  for (const auto& [width, height] : {std::pair{33, 20}, std::pair{1, 1}}) {
    const LayeredImage image = layered(picture(width, height));
    const ImageComparison found = compare(image, image);
    EXPECT_EQ(found.rmse, 0.0);
    EXPECT_EQ(found.relative_rmse, 0.0);
    EXPECT_EQ(found.mse_unbiased, 0.0);
    EXPECT_EQ(found.max_abs, 0.0);
    EXPECT_EQ(found.mean_signed, 0.0);
    EXPECT_EQ(found.mean_signed_stderr, 0.0);
    EXPECT_EQ(found.bias_z, 0.0);
    EXPECT_EQ(found.psnr, kInfinity);
    EXPECT_EQ(found.flip_mean, 0.0);
    EXPECT_LE(std::abs(found.ssim - 1.0), 1e-12);
    EXPECT_EQ(found.pixels, static_cast<std::size_t>(width * height));
    EXPECT_EQ(found.nonfinite, 0U);
  }
}

TEST(Compare, AveragesOverPixelsAndChannels) {
  // Differences (1, 0, -2), (0, 0, 0): mse 5 / 6, mean -1 / 6. Reference mean (1 + 2 + 3 + 1 + 2 + 3) / 6
  // = 2.
  Image reference = make_image(2, 1, {1.0F, 2.0F, 3.0F});
  Image test = reference;
  test.pixels[0] = {2.0F, 2.0F, 1.0F};
  const ImageComparison found = compare(layered(reference), layered(test));
  EXPECT_LE(std::abs(found.mse - 5.0 / 6.0), 1e-15);
  EXPECT_LE(std::abs(found.rmse - std::sqrt(5.0 / 6.0)), 1e-15);
  EXPECT_LE(std::abs(found.relative_rmse - std::sqrt(5.0 / 6.0) / 2.0), 1e-15);
  EXPECT_LE(std::abs(found.mean_signed + 1.0 / 6.0), 1e-15);
  EXPECT_EQ(found.max_abs, 2.0);
  EXPECT_EQ(found.mse_unbiased, found.mse);  // no noise layers: nothing to take off
}

TEST(Compare, RelativeErrorOfADarkReferenceIsInfinite) {
  EXPECT_EQ(compare(constant(3, 3, 0.0F), constant(3, 3, 1.0F)).relative_rmse, kInfinity);
  EXPECT_EQ(compare(constant(3, 3, -1.0F), constant(3, 3, 1.0F)).relative_rmse, kInfinity);
  EXPECT_EQ(compare(constant(3, 3, 0.0F), constant(3, 3, 0.0F)).relative_rmse, 0.0);
}

TEST(Compare, ToneMapsByTheReferencesBrightness) {
  // 5 and 2.5 become 0.5 and 0.25, sRGB 1.055 x^(1 / 2.4) - 0.055.
  const auto shown = [](double x) { return 1.055 * std::pow(x, 1.0 / 2.4) - 0.055; };
  const ImageComparison found = compare(constant(8, 8, 5.0F), constant(8, 8, 2.5F));
  const double a = shown(0.5);
  const double b = shown(0.25);
  EXPECT_LE(std::abs(found.psnr + 20.0 * std::log10(a - b)), 1e-5);  // float curve: 1e-7 of the difference
  EXPECT_LE(std::abs(found.ssim - (2.0 * a * b + 1e-4) / (a * a + b * b + 1e-4)), 1e-6);
  // A reference without light is shown as it is: black against 0.5 of white.
  const double dark = compare(constant(8, 8, 0.0F), constant(8, 8, 0.5F)).psnr;
  EXPECT_LE(std::abs(dark + 20.0 * std::log10(shown(0.5))), 1e-5);
  // A brighter test shows up to twice white; what clips in both looks the same, as documented, and the plain errors still see it.
  EXPECT_LE(std::abs(compare(constant(8, 8, 1.0F), constant(8, 8, 9.0F)).psnr +
                     20.0 * std::log10(1.0 - shown(0.5))),
            1e-5);
  Image sparkling = make_image(20, 10, Rgb(1.0F));
  sparkling.pixels[0] = Rgb(10.0F);
  Image brighter = sparkling;
  brighter.pixels[0] = Rgb(20.0F);
  EXPECT_EQ(compare(layered(sparkling), layered(brighter)).psnr, kInfinity);
  EXPECT_EQ(compare(layered(sparkling), layered(brighter)).max_abs, 10.0);
}

TEST(Compare, IsIndependentOfTheUnitOfRadiance) {
  const Image reference = picture(24, 18);
  const auto darker = [](Rgb& pixel) { pixel *= Rgb(0.8F, 0.9F, 0.7F); };
  const auto in_other_unit = [](Rgb& pixel) { pixel *= 1024.0F; };  // a power of 2: exact
  const ImageComparison a = compare(layered(reference), changed(reference, darker));
  const ImageComparison b = compare(changed(reference, in_other_unit),
                                    changed(*rgb_layer(changed(reference, darker), ""), in_other_unit));
  EXPECT_EQ(a.relative_rmse, b.relative_rmse);
  EXPECT_EQ(a.psnr, b.psnr);
  EXPECT_EQ(a.flip_mean, b.flip_mean);
  EXPECT_EQ(a.ssim, b.ssim);
  EXPECT_EQ(a.bias_z, b.bias_z);
}

TEST(Compare, WhiteIsTheNinetyNinthPercentile) {
  // One firefly in 200 pixels does not set the exposure, three do.
  Image reference = make_image(20, 10, Rgb(1.0F));
  const LayeredImage half = constant(20, 10, 0.5F);
  const auto shown = [](double x) { return 1.055 * std::pow(x, 1.0 / 2.4) - 0.055; };
  const double plain = compare(layered(reference), half).psnr;
  reference.pixels[0] = Rgb(1e4F);  // clips; the other 199 are shown as before
  const double squares = 199.0 * std::pow(shown(0.5) - shown(0.25), 2) + std::pow(1.0 - shown(0.25), 2);
  EXPECT_LE(std::abs(compare(layered(reference), half).psnr + 10.0 * std::log10(squares / 200.0)), 1e-5);
  reference.pixels[1] = reference.pixels[2] = Rgb(1e4F);
  EXPECT_GE(compare(layered(reference), half).psnr, plain + 3.0);  // now almost everything is near black
}

// ---------------------------------------------------------------- planted faults

TEST(CompareFaults, ABrokenPixelIsCountedAndNotAveragedAway) {
  const Image reference = picture(16, 16);
  for (const float bad : {kNanF, kInfinityF, -kInfinityF}) {
    Image test = reference;
    test.at(3, 5).y = bad;
    for (const ImageComparison& found :
         {compare(layered(reference), layered(test)), compare(layered(test), layered(reference))}) {
      EXPECT_EQ(found.nonfinite, 1U);
      EXPECT_EQ(found.pixels, 255U);
      EXPECT_EQ(found.rmse, 0.0);
      EXPECT_TRUE(std::isnan(found.flip_mean));
      EXPECT_TRUE(std::isnan(found.ssim));
      EXPECT_TRUE(exceeds(found, "nonfinite", 0.0));
      EXPECT_TRUE(exceeds(found, "flip_mean", 1.0));
    }
  }
}

TEST(CompareFaults, NothingComparedPassesNothing) {
  const ImageComparison found = compare(constant(4, 4, kNanF), constant(4, 4, 1.0F));
  EXPECT_EQ(found.pixels, 0U);
  EXPECT_EQ(found.nonfinite, 16U);
  for (const char* metric : {"rmse", "relative_rmse", "relmse", "mse", "mse_unbiased", "max_abs",
                             "mean_signed", "mean_signed_stderr", "bias_z", "psnr", "flip_mean", "ssim"}) {
    EXPECT_TRUE(exceeds(found, metric, 1e30)) << metric;
    EXPECT_TRUE(falls_below(found, metric, -1e30)) << metric;
  }
}

TEST(CompareFaults, OnePercentBrighterIsABias) {
  const Image reference = picture(64, 64);
  LayeredImage test = changed(reference, [](Rgb& pixel) { pixel *= 1.01F; });
  const ImageComparison bare = compare(layered(reference), test);
  // Tiles differ from -0.5 to +0.5 of a mean of 1 along x: z is at most about 1 / (0.3 / sqrt 16) = 13.
  EXPECT_LE(std::abs(bare.mean_signed - 0.01), 0.002);
  EXPECT_GE(bare.bias_z, 6.0);
  set_rgb_layer(test, "stderr", make_image(64, 64, Rgb(0.05F)));
  const ImageComparison noisy = compare(layered(reference), test);
  EXPECT_LE(std::abs(noisy.mean_signed_stderr - 0.05 / 64.0), 1e-9);
  EXPECT_GE(noisy.bias_z,
            10.0);  // 0.01 / (0.05 / 64) = 12.8, though each pixel is within 0.2 standard errors
}

TEST(CompareFaults, AForgottenPiIsFound) {
  const Image reference = picture(32, 32);
  const ImageComparison found =
      compare(layered(reference), changed(reference, [](Rgb& pixel) { pixel /= static_cast<float>(kPi); }));
  EXPECT_GE(found.relative_rmse, 1.0 - 1.0 / kPi);  // root mean square >= mean
  EXPECT_LE(found.psnr, 15.0);
  EXPECT_GE(found.flip_mean, 0.1);
}

TEST(CompareFaults, SwappedChannelsAreFoundThoughTheMeanStays) {
  const Image reference = picture(32, 32);
  const ImageComparison found =
      compare(layered(reference), changed(reference, [](Rgb& pixel) { std::swap(pixel.x, pixel.z); }));
  EXPECT_LE(std::abs(found.mean_signed), 1e-9);
  EXPECT_GE(found.rmse, 0.1);
  EXPECT_GE(found.flip_mean, 0.02);
}

TEST(CompareFaults, AMirroredImageIsFoundThoughTheMeanStays) {
  const Image reference = picture(32, 32);
  Image mirrored = reference;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 32; ++x) mirrored.at(x, y) = reference.at(31 - x, y);
  }
  const ImageComparison found = compare(layered(reference), layered(mirrored));
  EXPECT_LE(std::abs(found.mean_signed), 1e-9);
  EXPECT_LE(std::abs(found.bias_z), 1e-6);
  EXPECT_GE(found.flip_mean, 0.05);
  EXPECT_GE(found.relative_rmse, 0.1);
}

TEST(CompareFaults, UnusableInputIsRefused) {
  const LayeredImage good = layered(picture(8, 6));
  EXPECT_THROW((void)compare(good, layered(picture(6, 8))), InputError);
  LayeredImage missing = good;
  missing.channels.erase("G");
  EXPECT_THROW((void)compare(good, missing), InputError);
  EXPECT_THROW((void)compare(LayeredImage{8, 6, {}, {}}, good), InputError);
  LayeredImage partial = good;
  partial.channels["stderr.R"] = std::vector<float>(48, 0.1F);
  EXPECT_THROW((void)compare(partial, good), InputError);
  LayeredImage cut = good;
  cut.channels["B"].pop_back();
  EXPECT_THROW((void)compare(cut, good), InputError);
}

// ---------------------------------------------------------------- noise

// Standard errors that vary over the image, equal in the three channels.
float stated_error(std::size_t pixel) {
  return 0.02F + 0.001F * static_cast<float>(pixel % 50);
}

// The noise of gray paths moves all channels together, that of coloured ones each by itself.
enum class Channels { together, apart };

LayeredImage noisy(const Image& truth, Generator& generator, Channels channels) {
  Image mean = truth;
  Image error = make_image(truth.width, truth.height);
  for (std::size_t i = 0; i < mean.pixels.size(); ++i) {
    const double common = normal(generator);
    error.pixels[i] = Rgb(stated_error(i));
    for (int c = 0; c < 3; ++c) {
      const double deviate = channels == Channels::together ? common : normal(generator);
      mean.pixels[i][c] += stated_error(i) * static_cast<float>(deviate);
    }
  }
  LayeredImage layers = layered(mean);
  set_rgb_layer(layers, "stderr", error);
  return layers;
}

// Var of mean((v - r)^2), v - r normal with variance s^2 at a pixel: 2 sum s^4 / N^2 (channels together).
double error_of_mse(std::size_t pixels, double images) {
  double sum = 0.0;
  for (std::size_t i = 0; i < pixels; ++i) sum += std::pow(images * stated_error(i) * stated_error(i), 2.0);
  return std::sqrt(2.0 * sum) / static_cast<double>(pixels);
}

TEST(CompareNoise, OfEqualTruthsIsTakenOffAndIsNoBias) {
  constexpr int kSeeds = 300;
  const Image truth = picture(18, 17);
  std::vector<double> p_values;
  double mse_z = 0.0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    Generator generator(static_cast<std::uint64_t>(seed));
    const LayeredImage reference = noisy(truth, generator, Channels::together);
    const ImageComparison found = compare(reference, noisy(truth, generator, Channels::together));
    const double z = found.mse_unbiased / error_of_mse(truth.pixels.size(), 2.0);
    EXPECT_LE(std::abs(z), 5.0) << seed;  // 300 draws of a law close to normal
    if (seed == 0) {
      EXPECT_LE(std::abs(z), 4.0);
    }
    mse_z += z;
    p_values.push_back(two_sided_p(found.bias_z));
  }
  EXPECT_LE(std::abs(mse_z) / std::sqrt(kSeeds), 4.0);
  EXPECT_GE(kolmogorov_smirnov_uniform(p_values).p, 1e-3);
}

TEST(CompareNoise, UnderstatedErrorsFailTheSameTest) {
  // The negative of the test above: errors stated at half their size give z twice too large.
  const Image truth = picture(18, 17);
  std::vector<double> p_values;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Generator generator(seed);
    LayeredImage test = noisy(truth, generator, Channels::together);
    for (const char* channel : {"stderr.R", "stderr.G", "stderr.B"}) {
      for (float& value : test.channels[channel]) value *= 0.5F;
    }
    p_values.push_back(two_sided_p(compare(layered(truth), test).bias_z));
  }
  EXPECT_LE(kolmogorov_smirnov_uniform(p_values).p, 1e-4);
}

TEST(CompareNoise, IndependentChannelsMakeTheBiasTestCautious) {
  // The bound sum(s) / 3 = s stands for a true standard error of s / sqrt 3: z has variance 1 / 3.
  constexpr int kSeeds = 200;
  const Image truth = picture(12, 10);
  double squares = 0.0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    Generator generator(seed);
    const double z = compare(layered(truth), noisy(truth, generator, Channels::apart)).bias_z;
    squares += z * z;
  }
  EXPECT_LE(std::abs(squares / kSeeds - 1.0 / 3.0), 4.0 / 3.0 * std::sqrt(2.0 / kSeeds));
}

TEST(CompareNoise, OfOneImageAloneIsTakenOff) {
  LayeredImage test = constant(20, 20, 1.5F);
  set_rgb_layer(test, "stderr", make_image(20, 20, {0.1F, 0.2F, 0.3F}));
  const ImageComparison found = compare(constant(20, 20, 1.0F), test);
  EXPECT_LE(std::abs(found.mse_unbiased - (0.25 - 0.14 / 3.0)), 1e-8);
  EXPECT_LE(std::abs(found.mean_signed_stderr - 0.2 / 20.0), 1e-9);  // (0.1 + 0.2 + 0.3) / 3 over sqrt(400)
  const ImageComparison exchanged = compare(test, constant(20, 20, 1.0F));
  EXPECT_EQ(exchanged.mse_unbiased, found.mse_unbiased);
  EXPECT_EQ(exchanged.bias_z, -found.bias_z);
}

TEST(CompareNoise, OfHalvesIsTheProductOfTheirErrors) {
  // mse - mean((a - b)^2) / 4 = mean((a - r)(b - r)).
  Generator generator(11);
  const Image truth = picture(16, 12);
  Image a = truth;
  Image b = truth;
  Image mean = truth;
  double product = 0.0;
  for (std::size_t i = 0; i < truth.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      a.pixels[i][c] += 0.1F * static_cast<float>(normal(generator));
      b.pixels[i][c] += 0.1F * static_cast<float>(normal(generator));
      mean.pixels[i][c] = 0.5F * (a.pixels[i][c] + b.pixels[i][c]);
      product +=
          (double{a.pixels[i][c]} - truth.pixels[i][c]) * (double{b.pixels[i][c]} - truth.pixels[i][c]);
    }
  }
  LayeredImage test = layered(mean);
  set_rgb_layer(test, "a", a);
  set_rgb_layer(test, "b", b);
  const ImageComparison found = compare(layered(truth), test);
  EXPECT_LE(std::abs(found.mse_unbiased - product / (3.0 * 16.0 * 12.0)),
            1e-7);  // float rounding of the mean
  // Standard error of the mean: 0.1 / sqrt 2 a value, 576 independent values; known to 1 / sqrt(2 * 192) = 5
  // %.
  const double expected = 0.1 / std::sqrt(2.0 * 576.0);
  EXPECT_LE(std::abs(found.mean_signed_stderr - expected), 4.0 * 0.051 * expected);
}

TEST(CompareNoise, UnknownErrorsGiveNoVerdict) {
  for (const float bad : {kInfinityF, kNanF, -0.1F}) {
    LayeredImage test = constant(4, 4, 1.0F);
    Image error = make_image(4, 4, Rgb(0.1F));
    error.at(1, 2).z = bad;
    set_rgb_layer(test, "stderr", error);
    const ImageComparison found = compare(constant(4, 4, 1.0F), test);
    EXPECT_TRUE(std::isnan(found.mse_unbiased));
    EXPECT_TRUE(std::isnan(found.mean_signed_stderr));
    EXPECT_TRUE(exceeds(found, "bias_z", 1e6));
    EXPECT_EQ(found.nonfinite, 0U);  // the picture itself is whole
  }
}

TEST(CompareNoise, WithoutLayersIsReadOffTheTiles) {
  // 4 x 4 tiles of 16 x 16 with differences 0 and 2 in equal number: standard error sqrt(16 / 15) / 4.
  Image test = make_image(64, 64);
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) test.at(x, y) = Rgb((x / 16 + y / 16) % 2 == 0 ? 2.0F : 0.0F);
  }
  const ImageComparison found = compare(constant(64, 64, 0.0F), layered(test));
  EXPECT_LE(std::abs(found.mean_signed_stderr - std::sqrt(16.0 / 15.0) / 4.0), 1e-12);
  EXPECT_LE(std::abs(found.bias_z - 4.0 / std::sqrt(16.0 / 15.0)), 1e-12);
}

TEST(CompareNoise, AnExactOffsetIsInfinitelySignificant) {
  EXPECT_EQ(compare(constant(8, 8, 1.0F), constant(8, 8, 2.0F)).bias_z, kInfinity);
  EXPECT_EQ(compare(constant(8, 8, 2.0F), constant(8, 8, 1.0F)).bias_z, -kInfinity);
  EXPECT_TRUE(
      std::isnan(compare(constant(1, 1, 1.0F), constant(1, 1, 2.0F)).bias_z));  // one tile has no spread
}

// ---------------------------------------------------------------- verdicts

TEST(CompareVerdict, NamesAreThoseOfTheJson) {
  const std::map<std::string, double> values = as_map(ImageComparison{});
  for (const char* name :
       {"rmse", "relative_rmse", "relmse", "mse", "mse_unbiased", "max_abs", "mean_signed",
        "mean_signed_stderr", "bias_z", "psnr", "flip_mean", "ssim", "pixels", "nonfinite"}) {
    EXPECT_TRUE(values.contains(name)) << name;
  }
  EXPECT_EQ(values.size(), 14U);
}

TEST(CompareVerdict, IsStrictAndJudgesSignedMetricsByMagnitude) {
  ImageComparison comparison;
  comparison.rmse = 0.5;
  comparison.bias_z = -5.0;
  comparison.mse_unbiased = -1.0;
  comparison.psnr = kInfinity;
  EXPECT_FALSE(exceeds(comparison, "rmse", 0.5));
  EXPECT_FALSE(falls_below(comparison, "rmse", 0.5));
  EXPECT_TRUE(exceeds(comparison, "rmse", 0.49));
  EXPECT_TRUE(falls_below(comparison, "rmse", 0.51));
  EXPECT_TRUE(exceeds(comparison, "bias_z", 4.0));
  EXPECT_FALSE(exceeds(comparison, "mse_unbiased", 0.0));
  EXPECT_FALSE(falls_below(comparison, "psnr", 40.0));
}

TEST(CompareVerdict, NanFailsAndUnknownNamesAreRefused) {
  ImageComparison comparison;
  comparison.rmse = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(exceeds(comparison, "rmse", 1.0));
  EXPECT_TRUE(falls_below(comparison, "rmse", 1.0));
  EXPECT_TRUE(exceeds(comparison, "ssim", std::numeric_limits<double>::quiet_NaN()));
  try {
    (void)exceeds(comparison, "rsme", 1.0);
    FAIL() << "an unknown metric must be refused";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("rsme"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("flip_mean"), std::string::npos);
  }
}

// ---------------------------------------------------------------- tiles

TEST(TileZ, IsStandardNormalForHonestNoise) {
  Generator generator(21);
  const Image truth = picture(128, 96);
  const LayeredImage reference = noisy(truth, generator, Channels::together);
  const TileZ found = tile_z(reference, noisy(truth, generator, Channels::together), 8);
  EXPECT_EQ(found.columns, 16);
  EXPECT_EQ(found.rows, 12);
  std::vector<double> p_values;
  for (const double z : found.z) p_values.push_back(two_sided_p(z));
  EXPECT_GE(kolmogorov_smirnov_uniform(p_values).p, 1e-3);
}

TEST(TileZ, PointsAtTheTileThatIsOff) {
  Generator generator(22);
  const Image truth = picture(40, 30);  // the last column of tiles is 8 wide, the last row 14 high
  LayeredImage test = noisy(truth, generator, Channels::together);
  for (const char* channel : {"R", "G", "B"}) {
    for (std::size_t y = 16; y < 30; ++y) {
      for (std::size_t x = 32; x < 40; ++x) test.channels[channel][y * 40 + x] += 0.1F;
    }
  }
  const TileZ found = tile_z(layered(truth), test, 16);
  ASSERT_EQ(found.z.size(), 6U);
  for (std::size_t tile = 0; tile < 5; ++tile) EXPECT_LE(std::abs(found.z[tile]), 4.5) << tile;
  EXPECT_GE(found.z[5], 10.0);  // 0.1 / (0.045 / sqrt 112) = 23
}

TEST(TileZ, ShowsBrokenPixelsAndNeedsNoise) {
  Generator generator(23);
  const Image truth = picture(8, 8);
  LayeredImage test = noisy(truth, generator, Channels::together);
  test.channels["B"][0] = kNanF;
  const TileZ found = tile_z(layered(truth), test, 4);
  EXPECT_TRUE(std::isnan(found.z[0]));
  EXPECT_TRUE(std::isfinite(found.z[3]));
  EXPECT_THROW((void)tile_z(layered(truth), layered(truth), 4), InputError);
  EXPECT_THROW((void)tile_z(layered(truth), test, 0), InputError);
}

// ---------------------------------------------------------------- pictures

double lightness(const image::Image8& image, std::size_t pixel) {
  Rgb linear;
  for (int c = 0; c < 3; ++c) {
    linear[c] = image::linear_from_srgb(
        static_cast<float>(image.rgb[3 * pixel + static_cast<std::size_t>(c)]) / 255.0F);
  }
  const double y = luminance(linear);
  return y > 216.0 / 24389.0 ? 116.0 * std::cbrt(y) - 16.0 : 24389.0 / 27.0 * y;
}

Image ramp(int steps, double from, double to) {
  Image image = make_image(steps, 1);
  for (int i = 0; i < steps; ++i)
    image.at(i, 0) = Rgb(static_cast<float>(from + (to - from) * i / (steps - 1)));
  return image;
}

TEST(HeatMap, RisesEvenlyFromDarkToBright) {
  const image::Image8 map = heat_map(make_image(101, 1), ramp(101, 0.0, 2.0), 2.0);
  for (std::size_t i = 1; i <= 100; ++i) {
    EXPECT_GE(lightness(map, i), lightness(map, i - 1) - 1e-9) << i;
    // 98 in 100 steps; 8-bit rounding moves L* by up to 1, between knots the straight line bends by a little
    // more.
    EXPECT_LE(std::abs(lightness(map, i) - 0.98 * static_cast<double>(i)), 3.0) << i;
  }
}

TEST(HeatMap, ClampsAboveTheScaleAndShowsBrokenPixelsInMagenta) {
  Image test = make_image(3, 1);
  test.pixels[0] = Rgb(kNanF, 0.0F, 0.0F);
  test.pixels[1] = {3.0F, -6.0F, 0.0F};  // |.| averages to 3
  test.pixels[2] = Rgb(100.0F);
  const image::Image8 map = heat_map(make_image(3, 1), test, 3.0);
  EXPECT_EQ(std::vector<int>(map.rgb.begin(), map.rgb.begin() + 3), (std::vector<int>{255, 0, 255}));
  EXPECT_TRUE(std::equal(map.rgb.begin() + 3, map.rgb.begin() + 6, map.rgb.begin() + 6));
  EXPECT_THROW((void)heat_map(make_image(3, 1), make_image(1, 3), 1.0), InputError);
  EXPECT_THROW((void)heat_map(test, test, 0.0), InputError);
  EXPECT_THROW((void)signed_map(test, test, static_cast<double>(kNanF)), InputError);
}

TEST(SignedMap, IsBlueBelowWhiteAtAndRedAboveZero) {
  const image::Image8 map = signed_map(make_image(101, 1), ramp(101, -1.0, 1.0), 1.0);
  EXPECT_EQ(std::vector<int>(map.rgb.begin() + 150, map.rgb.begin() + 153),
            (std::vector<int>{255, 255, 255}));
  for (std::size_t i = 0; i < 50; ++i) {
    EXPECT_GE(map.rgb[3 * i + 2], map.rgb[3 * i] + 1) << i;                  // blue over red
    EXPECT_GE(map.rgb[3 * (100 - i)], map.rgb[3 * (100 - i) + 2] + 1) << i;  // red over blue
    EXPECT_LE(std::abs(lightness(map, i) - lightness(map, 100 - i)), 3.0) << i;
  }
}

TEST(HeatScale, IsRobustAndNeverZero) {
  Image test = ramp(200, 0.0, 0.0);
  EXPECT_EQ(heat_scale(test, test), 1.0);
  const Image black = test;
  test.pixels[7] = Rgb(5.0F);
  EXPECT_EQ(heat_scale(black, test), 5.0);  // one in 200: the percentile is 0, the maximum is not
  test = make_image(200, 1, Rgb(-2.0F));
  test.pixels[7] = Rgb(1e6F);
  test.pixels[8] = Rgb(kNanF);
  EXPECT_EQ(heat_scale(black, test), 2.0);
  EXPECT_EQ(heat_scale(black, make_image(200, 1, Rgb(kNanF))), 1.0);
}

}  // namespace
}  // namespace plumbline::metrics
