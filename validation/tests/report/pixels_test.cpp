#include "validation/report/pixels.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <random>

#include "reference/base/atomic_file.hpp"
#include "reference/image/file.hpp"

namespace plumbline::report {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
// Half a step of 2^(1/512), plus the rounding of the float that comes back.
const double kRelativeError = std::exp2(1.0 / 1024.0) - 1.0 + 1e-7;

TEST(ReportPixels, CodesKeepEveryMagnitudeToHalfAStep) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> stops(-31.9, 31.9);
  for (int i = 0; i < 20000; ++i) {
    const auto value = static_cast<float>(std::exp2(stops(generator)) * (i % 2 == 0 ? 1.0 : -1.0));
    const double back = value_of_log_code(log_code(value));
    ASSERT_LE(std::abs(back - static_cast<double>(value)),
              kRelativeError * std::abs(static_cast<double>(value)))
        << value;
  }
}

TEST(ReportPixels, CodesKeepZeroOneAndBrokenValues) {
  EXPECT_EQ(value_of_log_code(log_code(0.0F)), 0.0F);
  EXPECT_EQ(value_of_log_code(log_code(1.0F)), 1.0F);
  EXPECT_EQ(value_of_log_code(log_code(-0.25F)), -0.25F);
  EXPECT_EQ(value_of_log_code(log_code(kInf)), kInf);
  EXPECT_EQ(value_of_log_code(log_code(-kInf)), -kInf);
  EXPECT_EQ(value_of_log_code(log_code(1e30F)), kInf);  // out of range shows, it does not pass for a colour
  EXPECT_EQ(value_of_log_code(log_code(1e-30F)), 0.0F);
  EXPECT_TRUE(std::isnan(value_of_log_code(log_code(std::nanf("")))));
}

TEST(ReportPixels, EveryCodeComesBackAsItself) {
  for (int code = 1; code < 0x8000; ++code) {
    ASSERT_EQ(log_code(value_of_log_code(static_cast<std::uint16_t>(code))), code);
  }
}

image::Image colourful() {
  image::Image image = image::make_image(5, 3, Rgb(0.2F, 0.4F, 0.8F));
  image.at(0, 0) = Rgb(1e6F, -3.0F, 0.0F);
  image.at(4, 2) = Rgb(0.0F, kInf, 1e-5F);
  return image;
}

void expect_unpacked(const image::Image& back, const image::Image& image) {
  ASSERT_EQ(back.width, image.width);
  ASSERT_EQ(back.height, image.height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c)
      EXPECT_EQ(back.pixels[i][c], value_of_log_code(log_code(image.pixels[i][c]))) << i;
  }
}

TEST(ReportPixels, PackedPicturesComeBack) {
  expect_unpacked(unpack_radiance(pack_radiance(colourful())), colourful());
}

TEST(ReportPixels, PngKeepsThePackedBytes) {
  const image::Image8 packed = pack_radiance(colourful());
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "report_packed.png";
  write_text_atomically(path, image::encode_png(packed));
  EXPECT_EQ(image::tone_map(image::read_image(path)).rgb, packed.rgb);
}

TEST(ReportPixels, ShrinkKeepsTheMeanAndShowsBrokenPixels) {
  image::Image image = image::make_image(6, 4, Rgb(1.0F));
  image.at(0, 0) = Rgb(5.0F);
  image.at(5, 3) = Rgb(std::nanf(""));
  const image::Image small = shrink(image, 3);
  ASSERT_EQ(small.width, 3);
  ASSERT_EQ(small.height, 2);
  EXPECT_EQ(small.at(0, 0).x, 2.0F);
  EXPECT_EQ(small.at(1, 0).x, 1.0F);
  EXPECT_TRUE(std::isnan(small.at(2, 1).x));
  EXPECT_EQ(shrink(image, 6).width, 6);
}

}  // namespace
}  // namespace plumbline::report
