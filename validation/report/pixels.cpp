#include "validation/report/pixels.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace plumbline::report {
namespace {

constexpr int kStepsPerStop = 512;
constexpr int kCodeOfOne = 16384;
constexpr int kLargest = 32765;
constexpr int kInfinite = 32766;
constexpr int kNotANumber = 32767;
constexpr int kSign = 0x8000;
constexpr int kDifferenceOffset = 128;  // small differences of either sign share one high byte

std::uint16_t wrapped(int code) {
  return static_cast<std::uint16_t>(code & 0xFFFF);
}

// Mean of the pixels of the factor x factor block at (x, y), cut at the image's edge.
Rgb block_mean(const image::Image& image, int x, int y, int factor) {
  const int x_end = std::min(x + factor, image.width);
  const int y_end = std::min(y + factor, image.height);
  RgbD sum(0.0);
  for (int v = y; v < y_end; ++v) {
    for (int u = x; u < x_end; ++u) sum += RgbD(image.at(u, v));
  }
  return Rgb(sum / static_cast<double>((x_end - x) * (y_end - y)));
}

}  // namespace

std::uint16_t log_code(float value) {
  if (std::isnan(value)) return kNotANumber;
  const int sign = std::signbit(value) ? kSign : 0;
  if (std::isinf(value)) return wrapped(sign | kInfinite);
  if (value == 0.0F) return 0;
  const double code =
      std::round(std::log2(std::abs(static_cast<double>(value))) * kStepsPerStop) + kCodeOfOne;
  if (code < 1.0) return 0;
  return wrapped(sign | (code > kLargest ? kInfinite : static_cast<int>(code)));
}

float value_of_log_code(std::uint16_t code) {
  const int magnitude = code & 0x7FFF;
  if (magnitude == kNotANumber) return std::nanf("");
  if (magnitude == 0) return 0.0F;
  const double value = magnitude == kInfinite
                           ? static_cast<double>(INFINITY)
                           : std::exp2(static_cast<double>(magnitude - kCodeOfOne) / kStepsPerStop);
  return static_cast<float>((code & kSign) != 0 ? -value : value);
}

image::Image8 pack_radiance(const image::Image& image) {
  const std::size_t half = image.pixels.size() * 3;
  image::Image8 packed{image.width, 2 * image.height, std::vector<std::uint8_t>(2 * half)};
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const Rgb& pixel = image.pixels[i];
    const int red = log_code(pixel.x);
    const std::uint16_t planes[3] = {wrapped(red), wrapped(log_code(pixel.y) - red + kDifferenceOffset),
                                     wrapped(log_code(pixel.z) - red + kDifferenceOffset)};
    for (std::size_t c = 0; c < 3; ++c) {
      packed.rgb[3 * i + c] = static_cast<std::uint8_t>(planes[c] >> 8U);
      packed.rgb[half + 3 * i + c] = static_cast<std::uint8_t>(planes[c] & 0xFFU);
    }
  }
  return packed;
}

image::Image unpack_radiance(const image::Image8& packed) {
  image::Image result = image::make_image(packed.width, packed.height / 2);
  const std::size_t half = result.pixels.size() * 3;
  for (std::size_t i = 0; i < result.pixels.size(); ++i) {
    int planes[3];
    for (std::size_t c = 0; c < 3; ++c) planes[c] = packed.rgb[3 * i + c] << 8 | packed.rgb[half + 3 * i + c];
    result.pixels[i] = Rgb(value_of_log_code(wrapped(planes[0])),
                           value_of_log_code(wrapped(planes[1] + planes[0] - kDifferenceOffset)),
                           value_of_log_code(wrapped(planes[2] + planes[0] - kDifferenceOffset)));
  }
  return result;
}

image::Image shrink(const image::Image& image, int longest) {
  const int factor = (std::max(image.width, image.height) + longest - 1) / longest;
  if (factor <= 1) return image;
  image::Image result =
      image::make_image((image.width + factor - 1) / factor, (image.height + factor - 1) / factor);
  for (int y = 0; y < result.height; ++y) {
    for (int x = 0; x < result.width; ++x)
      result.at(x, y) = block_mean(image, x * factor, y * factor, factor);
  }
  return result;
}

}  // namespace plumbline::report
