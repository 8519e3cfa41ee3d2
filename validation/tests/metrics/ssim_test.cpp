#include "validation/metrics/ssim.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "reference/base/error.hpp"

namespace plumbline::metrics {
namespace {

std::vector<float> random_image(int count, unsigned seed) {
  std::mt19937 generator(seed);
  std::vector<float> image(static_cast<std::size_t>(count));
  for (float& value : image) value = static_cast<float>(generator() >> 8U) * 0x1p-24F;
  return image;
}

// The definition, pixel by pixel: central moments over the window's pixels, no separation.
double direct_ssim(const std::vector<float>& a, const std::vector<float>& b, int width, int height) {
  const auto at = [width](const std::vector<float>& image, int x, int y) {
    return static_cast<double>(image[static_cast<std::size_t>(y * width + x)]);
  };
  double total = 0.0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      double sums[4] = {};  // weight, a, b, then central moments
      double central[3] = {};
      for (int pass = 0; pass < 2; ++pass) {
        for (int j = y - 5; j <= y + 5; ++j) {
          for (int i = x - 5; i <= x + 5; ++i) {
            if (i < 0 || j < 0 || i >= width || j >= height) continue;
            const double weight = std::exp(-((i - x) * (i - x) + (j - y) * (j - y)) / 4.5);
            if (pass == 0) {
              sums[0] += weight;
              sums[1] += weight * at(a, i, j);
              sums[2] += weight * at(b, i, j);
            } else {
              const double da = at(a, i, j) - sums[1] / sums[0];
              const double db = at(b, i, j) - sums[2] / sums[0];
              central[0] += weight * da * da / sums[0];
              central[1] += weight * db * db / sums[0];
              central[2] += weight * da * db / sums[0];
            }
          }
        }
      }
      const double ma = sums[1] / sums[0];
      const double mb = sums[2] / sums[0];
      total += (2 * ma * mb + 1e-4) * (2 * central[2] + 9e-4) /
               ((ma * ma + mb * mb + 1e-4) * (central[0] + central[1] + 9e-4));
    }
  }
  return total / (width * height);
}

TEST(Ssim, IsOneForEqualImages) {
  const std::vector<float> image = random_image(17 * 13, 1);
  EXPECT_LE(std::abs(ssim(image, image, 17, 13) - 1.0), 1e-12);
}

TEST(Ssim, OfConstantImagesIsTheLuminanceTerm) {
  const std::vector<float> a(64, 0.25F);
  const std::vector<float> b(64, 0.75F);
  const double expected = (2 * 0.25 * 0.75 + 1e-4) / (0.0625 + 0.5625 + 1e-4);
  EXPECT_LE(std::abs(ssim(a, b, 8, 8) - expected), 1e-12);  // rounding of moments over C2: 1e-16 / 1e-3
}

TEST(Ssim, MatchesTheDirectDefinition) {
  for (const auto& [width, height] :
       {std::pair{19, 14}, std::pair{5, 3}, std::pair{1, 1}, std::pair{40, 1}}) {
    const std::vector<float> a = random_image(width * height, 2);
    std::vector<float> b = random_image(width * height, 3);
    for (std::size_t i = 0; i < b.size(); ++i) b[i] = 0.7F * a[i] + 0.3F * b[i];
    // Raw minus squared moments lose at most a few eps of 1 against C2 = 9e-4: 1e-12 leaves room.
    EXPECT_LE(std::abs(ssim(a, b, width, height) - direct_ssim(a, b, width, height)), 1e-11) << width;
  }
}

TEST(Ssim, FallsWhenStructureIsLost) {
  const std::vector<float> a = random_image(400, 4);
  std::vector<float> inverted = a;
  for (float& value : inverted) value = 1.0F - value;
  EXPECT_LE(ssim(a, inverted, 20, 20), 0.0);  // anticorrelated
  EXPECT_LE(ssim(a, random_image(400, 5), 20, 20), 0.3);
}

TEST(Ssim, ShowsNanAndRefusesWrongSizes) {
  std::vector<float> a = random_image(64, 6);
  const std::vector<float> b = a;
  a[9] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(std::isnan(ssim(a, b, 8, 8)));
  EXPECT_THROW((void)ssim(a, b, 8, 9), InputError);
  EXPECT_THROW((void)ssim({}, {}, 0, 0), InputError);
}

}  // namespace
}  // namespace plumbline::metrics
