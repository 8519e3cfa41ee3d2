#include "validation/checks/paired_error.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "reference/base/error.hpp"

namespace plumbline::checks {

// The mean is a ratio of sums over tiles, sum_t s_t / sum_t n_t. To first order its error is that of the residuals s_t - mean n_t (Cochran 1977,
// "Sampling Techniques", section 6.4): Var = T / (T - 1) sum_t (s_t - mean n_t)^2 / (sum_t n_t)^2.
metrics::Estimate tile_mean(const Mask& mask, int width, int height,
                            const std::function<double(std::size_t, int)>& value) {
  constexpr int kTile = 16;
  struct Tile {
    double sum = 0.0;
    double count = 0.0;
  };
  const int columns = (width + kTile - 1) / kTile;
  const int rows = (height + kTile - 1) / kTile;
  std::vector<Tile> tiles(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const auto pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
      if (!mask[pixel]) continue;
      Tile& tile = tiles[static_cast<std::size_t>(y / kTile) * static_cast<std::size_t>(columns) +
                         static_cast<std::size_t>(x / kTile)];
      for (int c = 0; c < 3; ++c) tile.sum += value(pixel, c);
      tile.count += 3.0;
    }
  }
  std::erase_if(tiles, [](const Tile& tile) { return tile.count == 0.0; });
  if (tiles.size() < 2)
    throw InputError(
        "images: fewer than two 16 x 16 tiles show the scene; use a larger --size or another camera");
  double sum = 0.0;
  double count = 0.0;
  for (const Tile& tile : tiles) {
    sum += tile.sum;
    count += tile.count;
  }
  const double mean = sum / count;
  double squares = 0.0;
  for (const Tile& tile : tiles) squares += std::pow(tile.sum - mean * tile.count, 2);
  const auto n = static_cast<double>(tiles.size());
  return {mean, std::sqrt(squares * n / (n - 1.0)) / count};
}

RootMeanSquare root(const metrics::Estimate& mean_square) {
  const double half = metrics::two_sided_z(0.05) * mean_square.standard_error;
  const auto safe_root = [](double square) { return std::sqrt(std::max(0.0, square)); };
  return {safe_root(mean_square.mean), safe_root(mean_square.mean - half),
          safe_root(mean_square.mean + half)};
}

}  // namespace plumbline::checks
