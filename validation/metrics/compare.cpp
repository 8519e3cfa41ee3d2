#include "validation/metrics/compare.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <span>

#include "reference/base/error.hpp"
#include "reference/image/exr.hpp"
#include "reference/image/file.hpp"
#include "validation/metrics/flip.hpp"
#include "validation/metrics/ssim.hpp"

namespace plumbline::metrics {
namespace {

using image::Image;
using image::LayeredImage;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// ---------------------------------------------------------------- input

std::optional<Image> optional_layer(const LayeredImage& layers, const char* which, const std::string& layer) {
  const auto count = static_cast<std::size_t>(layers.width) * static_cast<std::size_t>(layers.height);
  std::string present;
  std::string missing;
  for (const char* channel : {"R", "G", "B"}) {
    const std::string name = layer.empty() ? channel : layer + "." + channel;
    const auto found = layers.channels.find(name);
    if (found == layers.channels.end()) {
      missing = name;
    } else if (found->second.size() != count) {
      throw InputError(fmt::format("compare: {}: channel {} must hold {} x {} values, holds {}", which, name,
                                   layers.width, layers.height, found->second.size()));
    } else {
      present = name;
    }
  }
  if (!missing.empty() && !present.empty()) {
    throw InputError(
        fmt::format("compare: {}: channel {} is there but {} is missing", which, present, missing));
  }
  return image::rgb_layer(layers, layer);
}

Image mean_layer(const LayeredImage& layers, const char* which) {
  std::optional<Image> mean = optional_layer(layers, which, "");
  if (!mean) throw InputError(fmt::format("compare: {}: channels R, G, B are missing", which));
  return *std::move(mean);
}

void require_equal_sizes(const Image& reference, const Image& test) {
  if (reference.width == test.width && reference.height == test.height) return;
  throw InputError(
      fmt::format("compare: images must have one size, are {} x {} (reference) and {} x {} (test)",
                  reference.width, reference.height, test.width, test.height));
}

// A pair of images and the pixels at which they can be compared.
struct Pair {
  Image reference;
  Image test;
  std::vector<std::size_t> compared;

  [[nodiscard]] bool is_finite_at(std::size_t pixel) const {
    return is_finite(reference.pixels[pixel]) && is_finite(test.pixels[pixel]);
  }
  [[nodiscard]] RgbD difference(std::size_t pixel) const {
    return RgbD(test.pixels[pixel]) - RgbD(reference.pixels[pixel]);
  }
};

double channel_mean(const RgbD& value) {
  return (value.x + value.y + value.z) / 3.0;
}

Pair make_pair_of(Image reference, Image test) {
  require_equal_sizes(reference, test);
  Pair pair{std::move(reference), std::move(test), {}};
  for (std::size_t i = 0; i < pair.reference.pixels.size(); ++i) {
    if (pair.is_finite_at(i)) pair.compared.push_back(i);
  }
  return pair;
}

Pair make_pair_of(const LayeredImage& reference, const LayeredImage& test) {
  return make_pair_of(mean_layer(reference, "reference"), mean_layer(test, "test"));
}

// ---------------------------------------------------------------- noise

// Variances of every pixel: of its three values (their mean), and of the mean of its three values. NaN =
// unknown.
struct Noise {
  std::vector<double> of_values;
  std::vector<double> of_mean;
};

// Var(mean of channels) is at most (sum of standard errors / 3)^2, reached when the channels move together,
// as they do for gray paths. Without knowing the correlation the bound is what can be claimed.
Noise noise_from_stderr(const Image& standard_error) {
  Noise noise;
  for (const Rgb& pixel : standard_error.pixels) {
    const RgbD error(pixel);
    const bool is_known = is_finite(pixel) && pixel.x >= 0.0F && pixel.y >= 0.0F && pixel.z >= 0.0F;
    noise.of_values.push_back(is_known ? channel_mean(error * error) : kNan);
    noise.of_mean.push_back(is_known ? channel_mean(error) * channel_mean(error) : kNan);
  }
  return noise;
}

// m = (a + b) / 2 of independent halves of variance s^2 each: Var(m) = s^2 / 2 and E (a - b)^2 = 2 s^2, so
// that (a - b)^2 / 4 is unbiased for Var(m). Taking it off the squared error is the same as multiplying the
// errors of the halves: (m - r)^2 - (a - b)^2 / 4 = (a - r)(b - r). The halves know the channels'
// correlation.
Noise noise_from_halves(const Image& a, const Image& b) {
  Noise noise;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const RgbD half = (RgbD(a.pixels[i]) - RgbD(b.pixels[i])) / 2.0;
    const bool is_known = is_finite(a.pixels[i]) && is_finite(b.pixels[i]);
    noise.of_values.push_back(is_known ? channel_mean(half * half) : kNan);
    noise.of_mean.push_back(is_known ? channel_mean(half) * channel_mean(half) : kNan);
  }
  return noise;
}

std::optional<Noise> noise_of(const LayeredImage& layers, const char* which) {
  if (const auto standard_error = optional_layer(layers, which, "stderr"))
    return noise_from_stderr(*standard_error);
  const auto a = optional_layer(layers, which, "a");
  const auto b = optional_layer(layers, which, "b");
  if (a && b) return noise_from_halves(*a, *b);
  return std::nullopt;
}

// Of the difference of two independent images; none when neither has any.
std::optional<Noise> noise_of_difference(const LayeredImage& reference, const LayeredImage& test) {
  std::optional<Noise> noise = noise_of(reference, "reference");
  const std::optional<Noise> other = noise_of(test, "test");
  if (!noise) return other;
  if (!other) return noise;
  for (std::size_t i = 0; i < noise->of_values.size(); ++i) {
    noise->of_values[i] += other->of_values[i];
    noise->of_mean[i] += other->of_mean[i];
  }
  return noise;
}

double sum_over(const std::vector<double>& values, const std::vector<std::size_t>& pixels) {
  double sum = 0.0;
  for (const std::size_t pixel : pixels) sum += values[pixel];
  return sum;
}

double z_of(double mean, double standard_error) {
  if (standard_error == 0.0) return mean == 0.0 ? 0.0 : mean * kInfinity;
  return mean / standard_error;
}

// ---------------------------------------------------------------- tiles

int tiles_along(int pixels, int tile) {
  return (pixels + tile - 1) / tile;
}

std::size_t tile_of(std::size_t pixel, int width, int tile) {
  const auto x = static_cast<int>(pixel % static_cast<std::size_t>(width));
  const auto y = static_cast<int>(pixel / static_cast<std::size_t>(width));
  return static_cast<std::size_t>(y / tile) * static_cast<std::size_t>(tiles_along(width, tile)) +
         static_cast<std::size_t>(x / tile);
}

struct TileSum {
  double difference = 0.0;
  double variance = 0.0;
  double count = 0.0;
};

int default_tile(int width, int height) {
  constexpr int kTile = 16;
  constexpr int kFewestTiles = 16;
  int tile = kTile;
  while (tile > 1 && tiles_along(width, tile) * tiles_along(height, tile) < kFewestTiles) tile /= 2;
  return tile;
}

// Tile means d_t over n_t pixels of N, independent and of variance inversely proportional to n_t: the
// weighted mean m = sum n_t d_t / N has variance about T / (T - 1) sum (n_t / N)^2 (d_t - m)^2 over T tiles;
// for equal tiles that is the sample variance over T. One tile has no spread: unknown, unless nothing
// differs.
double stderr_from_tiles(const Pair& pair) {
  const int tile = default_tile(pair.reference.width, pair.reference.height);
  std::vector<TileSum> sums(static_cast<std::size_t>(tiles_along(pair.reference.width, tile)) *
                            static_cast<std::size_t>(tiles_along(pair.reference.height, tile)));
  double mean = 0.0;
  double largest = 0.0;
  for (const std::size_t pixel : pair.compared) {
    const double difference = channel_mean(pair.difference(pixel));
    TileSum& sum = sums[tile_of(pixel, pair.reference.width, tile)];
    sum.difference += difference;
    sum.count += 1.0;
    mean += difference;
    largest = std::max(largest, std::abs(difference));
  }
  const auto total = static_cast<double>(pair.compared.size());
  mean /= total;
  double tiles = 0.0;
  double squares = 0.0;
  for (const TileSum& sum : sums) {
    const double deviation = (sum.difference - sum.count * mean) / total;
    squares += deviation * deviation;
    if (sum.count > 0.0) tiles += 1.0;
  }
  if (tiles < 2.0) return tiles == 1.0 && largest == 0.0 ? 0.0 : kNan;
  return std::sqrt(squares * tiles / (tiles - 1.0));
}

// ---------------------------------------------------------------- tone mapping

// Nearest rank: the smallest value with at least 99 % of the values at or below it.
double percentile_99(std::vector<double> values) {
  const auto rank = static_cast<std::size_t>(std::ceil(0.99 * static_cast<double>(values.size())));
  const auto position = values.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(rank, 1) - 1);
  std::nth_element(values.begin(), position, values.end());
  return *position;
}

double exposure_of(const Pair& pair) {
  std::vector<double> luminances;
  for (const std::size_t pixel : pair.compared) luminances.push_back(luminance(pair.reference.pixels[pixel]));
  const double white = luminances.empty() ? 0.0 : percentile_99(std::move(luminances));
  constexpr double kWhite = 0.5;  // a stop of headroom, so that a test brighter than the reference shows
  return white > 0.0 ? kWhite / white : 1.0;
}

Image tone_mapped(const Image& image, double exposure) {
  Image result = image;
  for (Rgb& pixel : result.pixels) pixel = Rgb(glm::clamp(RgbD(pixel) * exposure, 0.0, 1.0));
  return result;
}

double psnr_of(const Pair& shown) {
  double squares = 0.0;
  for (const std::size_t pixel : shown.compared) {
    for (int c = 0; c < 3; ++c) {
      const double difference = double{image::srgb_from_linear(shown.test.pixels[pixel][c])} -
                                double{image::srgb_from_linear(shown.reference.pixels[pixel][c])};
      squares += difference * difference;
    }
  }
  return -10.0 * std::log10(squares / (3.0 * static_cast<double>(shown.compared.size())));
}

std::vector<float> encoded_luminances(const Image& image) {
  std::vector<float> result;
  for (const Rgb& pixel : image.pixels) result.push_back(image::srgb_from_linear(luminance(pixel)));
  return result;
}

void add_perceptual(ImageComparison& result, const Pair& pair) {
  const double exposure = exposure_of(pair);
  const Pair shown{tone_mapped(pair.reference, exposure), tone_mapped(pair.test, exposure), pair.compared};
  result.psnr = psnr_of(shown);
  result.flip_mean = kNan;
  result.ssim = kNan;
  if (result.nonfinite > 0 || result.pixels == 0) return;
  const std::vector<float> differences = flip(shown.reference, shown.test);
  result.flip_mean =
      std::accumulate(differences.begin(), differences.end(), 0.0) / static_cast<double>(differences.size());
  result.ssim = ssim(encoded_luminances(shown.reference), encoded_luminances(shown.test),
                     shown.reference.width, shown.reference.height);
}

// ---------------------------------------------------------------- the plain errors

void add_errors(ImageComparison& result, const Pair& pair) {
  double squares = 0.0;
  double relative_squares = 0.0;
  double differences = 0.0;
  double reference = 0.0;
  double largest = pair.compared.empty() ? kNan : 0.0;
  for (const std::size_t pixel : pair.compared) {
    const RgbD difference = pair.difference(pixel);
    const RgbD truth(pair.reference.pixels[pixel]);
    squares += channel_mean(difference * difference);
    relative_squares += channel_mean(difference * difference / (truth * truth + 0.01));
    differences += channel_mean(difference);
    reference += channel_mean(truth);
    for (int c = 0; c < 3; ++c) largest = std::max(largest, std::abs(difference[c]));
  }
  const auto count = static_cast<double>(pair.compared.size());
  result.mse = squares / count;
  result.relmse = relative_squares / count;
  result.rmse = std::sqrt(result.mse);
  result.max_abs = largest;
  result.mean_signed = differences / count;
  result.relative_rmse = reference > 0.0 ? result.rmse / (reference / count) : z_of(result.rmse, 0.0);
}

void add_significance(ImageComparison& result, const Pair& pair, const std::optional<Noise>& noise) {
  const auto count = static_cast<double>(pair.compared.size());
  if (noise) {
    result.mse_unbiased = result.mse - sum_over(noise->of_values, pair.compared) / count;
    result.mean_signed_stderr = std::sqrt(sum_over(noise->of_mean, pair.compared)) / count;
  } else {
    result.mse_unbiased = result.mse;
    result.mean_signed_stderr = stderr_from_tiles(pair);
  }
  result.bias_z = z_of(result.mean_signed, result.mean_signed_stderr);
}

double judged_value(const ImageComparison& comparison, std::string_view metric) {
  const std::map<std::string, double> values = as_map(comparison);
  const auto found = values.find(std::string(metric));
  if (found == values.end()) {
    std::vector<std::string> names;
    for (const auto& [name, value] : values) names.push_back(name);
    throw InputError(fmt::format("metric must be one of {}; is \"{}\"", fmt::join(names, ", "), metric));
  }
  const bool is_signed = metric == "mean_signed" || metric == "bias_z";
  return is_signed ? std::abs(found->second) : found->second;
}

// ---------------------------------------------------------------- colour maps

struct Colour8 {
  std::uint8_t r, g, b;
};
constexpr Colour8 kMagenta{255, 0, 255};

// Black, indigo, purple, crimson, orange, amber, straw, near white: chosen by hue, then moved towards black
// or white until CIE L* is 0, 14, 28 ... 98.
constexpr Colour8 kHeat[] = {{0, 0, 0},     {45, 16, 94},   {109, 26, 124}, {178, 48, 101},
                             {226, 91, 62}, {243, 149, 30}, {237, 208, 87}, {251, 251, 231}};
// Navy, blue, white, red, maroon with CIE L* 20, 60, 100, 60, 20: equal differences of either sign look
// equally strong.
constexpr Colour8 kSigned[] = {{20, 40, 119}, {98, 146, 217}, {255, 255, 255}, {218, 116, 82}, {99, 12, 25}};

// Colour at t in [0, 1], linear between evenly spaced knots.
Colour8 colour_at(std::span<const Colour8> knots, double t) {
  const double position = std::clamp(t, 0.0, 1.0) * static_cast<double>(knots.size() - 1);
  const std::size_t knot = std::min(static_cast<std::size_t>(position), knots.size() - 2);
  const double share = position - static_cast<double>(knot);
  const auto mix = [share](std::uint8_t from, std::uint8_t to) {
    return static_cast<std::uint8_t>(std::lround((1.0 - share) * from + share * to));
  };
  const Colour8& from = knots[knot];
  const Colour8& to = knots[knot + 1];
  return {mix(from.r, to.r), mix(from.g, to.g), mix(from.b, to.b)};
}

void require_scale(double scale) {
  if (!(scale > 0.0)) throw InputError(fmt::format("colour map: scale must be > 0, is {}", scale));
}

template <typename ColourOf>
image::Image8 map_of(const Image& reference, const Image& test, const ColourOf& colour_of) {
  require_equal_sizes(reference, test);
  image::Image8 result{reference.width, reference.height, {}};
  for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
    const RgbD difference = RgbD(test.pixels[i]) - RgbD(reference.pixels[i]);
    const bool is_known = is_finite(reference.pixels[i]) && is_finite(test.pixels[i]);
    const Colour8 colour = is_known ? colour_of(difference) : kMagenta;
    result.rgb.insert(result.rgb.end(), {colour.r, colour.g, colour.b});
  }
  return result;
}

}  // namespace

ImageComparison compare(const LayeredImage& reference, const LayeredImage& test) {
  const Pair pair = make_pair_of(reference, test);
  ImageComparison result;
  result.pixels = pair.compared.size();
  result.nonfinite = pair.reference.pixels.size() - result.pixels;
  add_errors(result, pair);
  add_significance(result, pair, noise_of_difference(reference, test));
  add_perceptual(result, pair);
  return result;
}

std::map<std::string, double> as_map(const ImageComparison& comparison) {
  return {{"rmse", comparison.rmse},
          {"relative_rmse", comparison.relative_rmse},
          {"relmse", comparison.relmse},
          {"mse", comparison.mse},
          {"mse_unbiased", comparison.mse_unbiased},
          {"max_abs", comparison.max_abs},
          {"mean_signed", comparison.mean_signed},
          {"mean_signed_stderr", comparison.mean_signed_stderr},
          {"bias_z", comparison.bias_z},
          {"psnr", comparison.psnr},
          {"flip_mean", comparison.flip_mean},
          {"ssim", comparison.ssim},
          {"pixels", static_cast<double>(comparison.pixels)},
          {"nonfinite", static_cast<double>(comparison.nonfinite)}};
}

// Written as "not at most": false only where the metric is known to be within.
bool exceeds(const ImageComparison& comparison, std::string_view metric, double threshold) {
  return !(judged_value(comparison, metric) <= threshold);
}

bool falls_below(const ImageComparison& comparison, std::string_view metric, double threshold) {
  return !(judged_value(comparison, metric) >= threshold);
}

TileZ tile_z(const LayeredImage& reference, const LayeredImage& test, int tile) {
  if (tile < 1) throw InputError(fmt::format("tile_z: tile must be >= 1, is {}", tile));
  const Pair pair = make_pair_of(reference, test);
  const std::optional<Noise> noise = noise_of_difference(reference, test);
  if (!noise) throw InputError("tile_z: either image must have layers stderr, or a and b; neither has");
  TileZ result{tiles_along(reference.width, tile), tiles_along(reference.height, tile), {}};
  std::vector<TileSum> sums(static_cast<std::size_t>(result.columns) * static_cast<std::size_t>(result.rows));
  for (std::size_t pixel = 0; pixel < pair.reference.pixels.size(); ++pixel) {
    TileSum& sum = sums[tile_of(pixel, reference.width, tile)];
    sum.difference += pair.is_finite_at(pixel) ? channel_mean(pair.difference(pixel)) : kNan;
    sum.variance += noise->of_mean[pixel];
  }
  for (const TileSum& sum : sums) result.z.push_back(z_of(sum.difference, std::sqrt(sum.variance)));
  return result;
}

double heat_scale(const Image& reference, const Image& test) {
  const Pair pair = make_pair_of(reference, test);
  std::vector<double> errors;
  for (const std::size_t pixel : pair.compared)
    errors.push_back(channel_mean(glm::abs(pair.difference(pixel))));
  if (errors.empty()) return 1.0;
  const double largest = *std::max_element(errors.begin(), errors.end());
  const double scale = percentile_99(std::move(errors));
  return scale > 0.0 ? scale : largest > 0.0 ? largest : 1.0;
}

image::Image8 heat_map(const Image& reference, const Image& test, double scale) {
  require_scale(scale);
  return map_of(reference, test,
                [scale](const RgbD& d) { return colour_at(kHeat, channel_mean(glm::abs(d)) / scale); });
}

image::Image8 signed_map(const Image& reference, const Image& test, double scale) {
  require_scale(scale);
  return map_of(reference, test,
                [scale](const RgbD& d) { return colour_at(kSigned, 0.5 + 0.5 * channel_mean(d) / scale); });
}

}  // namespace plumbline::metrics
