#include "validation/study/agreement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "reference/image/exr.hpp"
#include "validation/metrics/statistics.hpp"

namespace plumbline::study {
namespace {

using checks::Finding;
using checks::Verdict;

constexpr int kTile = 16;
constexpr double kMeanMargin = 0.005;
constexpr double kMedianMargin = 0.01;
constexpr double kExtremeMargin = 0.03;
constexpr double kFalseAlarm = 1e-4;
constexpr double kDarkTile = 1e-3;  // of the image's mean
constexpr double kRounding =
    1e-5;  // relative: two programs that compute the same in 32 bits; keeps noiseless pixels from z = infinity
constexpr double kHalfWidth95 = 1.959963984540054;

/// One tile's sums over pixels and channels.
struct Tile {
  double base = 0.0;
  double test = 0.0;
  double variance_base = 0.0;  // of the sums
  double variance_test = 0.0;
  double count = 0.0;
};

double channel_sum(const Rgb& c) {
  return static_cast<double>(c.x) + static_cast<double>(c.y) + static_cast<double>(c.z);
}

/// Of the mean of the halves' channel sums at one pixel: ((a - b) / 2)^2 is its unbiased variance.
double variance(const Halved& halved, std::size_t p) {
  const double a = channel_sum(halved.a.pixels[p]);
  const double b = channel_sum(halved.b.pixels[p]);
  const double rounding = kRounding * 0.5 * (a + b);
  return 0.25 * (a - b) * (a - b) + rounding * rounding;
}

int tiles_along(int pixels) {
  return (pixels + kTile - 1) / kTile;
}

std::vector<Tile> tiles_of(const Halved& base, const Halved& test) {
  const int width = base.a.width;
  const int columns = tiles_along(width);
  std::vector<Tile> tiles(static_cast<std::size_t>(columns * tiles_along(base.a.height)));
  const image::Image base_mean = mean_of(base);
  const image::Image test_mean = mean_of(test);
  for (std::size_t p = 0; p < base_mean.pixels.size(); ++p) {
    const int x = static_cast<int>(p) % width;
    const int y = static_cast<int>(p) / width;
    Tile& tile = tiles[static_cast<std::size_t>((y / kTile) * columns + x / kTile)];
    tile.base += channel_sum(base_mean.pixels[p]);
    tile.test += channel_sum(test_mean.pixels[p]);
    tile.variance_base += variance(base, p);
    tile.variance_test += variance(test, p);
    tile.count += 1.0;
  }
  return tiles;
}

Tile sum_of(const std::vector<Tile>& tiles) {
  Tile sum;
  for (const Tile& tile : tiles) {
    sum.base += tile.base;
    sum.test += tile.test;
    sum.variance_base += tile.variance_base;
    sum.variance_test += tile.variance_test;
    sum.count += tile.count;
  }
  return sum;
}

/// Within the bound with its whole interval, outside with its whole interval, or neither. NaN fails.
Verdict decide(double measured, double uncertainty, double bound) {
  if (!(std::abs(measured) - uncertainty <= bound)) return Verdict::fail;
  return std::abs(measured) + uncertainty <= bound ? Verdict::pass : Verdict::inconclusive;
}

Finding finding(const std::string& name, double measured, double uncertainty, double bound) {
  Finding result;
  result.family = "agreement";
  result.name = name;
  result.measured = measured;
  result.uncertainty = uncertainty;
  result.bound = bound;
  result.verdict = decide(measured, uncertainty, bound);
  return result;
}

Finding mean_finding(const std::string& names, const Tile& all) {
  const double error = std::sqrt(all.variance_base + all.variance_test);
  const double difference = all.test - all.base;
  Finding result = finding(names + " / mean difference", difference / all.base,
                           kHalfWidth95 * error / all.base, kMeanMargin);
  result.source = "0.5 %: the equivalence margin of this project's quick truths";
  result.detail = fmt::format(
      "(mean of the image - mean of the base) / mean of the base, 95 % interval; {:+.1f} standard errors",
      difference / error);
  return result;
}

Finding tile_finding(const std::string& names, const std::vector<double>& z) {
  const double bound = metrics::two_sided_z(metrics::sidak(kFalseAlarm, z.size()));
  double largest = 0.0;
  for (const double value : z) largest = std::isnan(value) ? value : std::max(largest, std::abs(value));
  Finding result = finding(names + " / largest |z| of the tiles", largest, 0.0, bound);
  result.source = fmt::format("false alarm {:g} over {} tiles (Sidak)", kFalseAlarm, z.size());
  result.detail =
      "mean difference of each 16 x 16 tile over its standard error, from independent halves of both images";
  return result;
}

double quantile(const std::vector<double>& sorted, double q) {
  return sorted[static_cast<std::size_t>(std::lround(q * static_cast<double>(sorted.size() - 1)))];
}

struct Blocks {
  std::vector<double> ratios;  // sorted
  double typical_error = 0.0;  // median standard error of a ratio
};

std::optional<Blocks> blocks_of(const std::vector<Tile>& tiles) {
  const Tile all = sum_of(tiles);
  Blocks blocks;
  std::vector<double> errors;
  for (const Tile& tile : tiles) {
    if (!(tile.base / tile.count > kDarkTile * all.base / all.count)) continue;
    blocks.ratios.push_back(tile.test / tile.base);
    errors.push_back(std::sqrt(tile.variance_base + tile.variance_test) / tile.base);
  }
  if (errors.empty()) return std::nullopt;
  std::sort(blocks.ratios.begin(), blocks.ratios.end());
  std::sort(errors.begin(), errors.end());
  blocks.typical_error = quantile(errors, 0.5);
  return blocks;
}

/// The median of n ratios has the standard error sqrt(pi / 2 n) of one (normal noise); noise widens the extremes by about 2.3 standard
/// errors of a ratio, their own interval is taken as wide as that.
std::vector<Finding> block_findings(const std::string& names, const Blocks& blocks) {
  const auto n = static_cast<double>(blocks.ratios.size());
  const double median_error = kHalfWidth95 * blocks.typical_error * std::sqrt(kPi / (2.0 * n));
  const double extreme_error = metrics::two_sided_z(0.02) * blocks.typical_error;
  std::vector<Finding> result = {finding(names + " / block ratio, median", quantile(blocks.ratios, 0.5) - 1.0,
                                         median_error, kMedianMargin),
                                 finding(names + " / block ratio, 1 %", quantile(blocks.ratios, 0.01) - 1.0,
                                         extreme_error, kExtremeMargin),
                                 finding(names + " / block ratio, 99 %", quantile(blocks.ratios, 0.99) - 1.0,
                                         extreme_error, kExtremeMargin)};
  result[0].source = "1 %: what independent renderers agree to in the median";
  result[1].source = result[2].source =
      "3 %: two public renderers were measured at -1.4 % and +2.5 % on 16 x 16 blocks";
  for (Finding& one : result)
    one.detail = fmt::format("image / base - 1 over {} blocks of 16 x 16 pixels; noise of one block {:.2g}",
                             blocks.ratios.size(), blocks.typical_error);
  return result;
}

image::Image8 picture_of(const metrics::TileZ& tiles, int width, int height) {
  const image::Image zero = image::make_image(width, height);
  image::Image z = zero;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      z.at(x, y) =
          Rgb(static_cast<float>(tiles.z[static_cast<std::size_t>((y / kTile) * tiles.columns + x / kTile)]));
  return metrics::signed_map(zero, z, kFullZ);
}

}  // namespace

Agreement compare_renderers(const std::string& names, const Halved& base, const Halved& test) {
  (void)relmse(mean_of(test), base);  // the sizes
  const std::vector<Tile> tiles = tiles_of(base, test);
  const Tile all = sum_of(tiles);
  Agreement result;
  result.tiles = {tiles_along(base.a.width), tiles_along(base.a.height), {}};
  for (const Tile& tile : tiles) {
    const double error = std::sqrt(tile.variance_base + tile.variance_test);
    const double difference = tile.test - tile.base;
    result.tiles.z.push_back(difference == 0.0 ? 0.0 : difference / error);
  }
  result.z_map = picture_of(result.tiles, base.a.width, base.a.height);
  result.findings = {mean_finding(names, all), tile_finding(names, result.tiles.z)};
  if (const std::optional<Blocks> blocks = blocks_of(tiles)) {
    for (Finding& one : block_findings(names, *blocks)) result.findings.push_back(std::move(one));
  }
  return result;
}

}  // namespace plumbline::study
