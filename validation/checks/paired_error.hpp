// validation/checks/paired_error.hpp: squared differences of images whose noise is known or independent.
#pragma once

#include <functional>
#include <vector>

#include "reference/image/image.hpp"
#include "validation/metrics/statistics.hpp"

namespace plumbline::checks {

/// Pixels that take part.
using Mask = std::vector<bool>;

/// Mean over masked pixels x channels of a per-value function, with a standard error from the spread over 16 x 16 tiles (neighbouring pixels share vertices,
/// so single pixels are not independent). @throws InputError when fewer than two tiles hold masked pixels.
[[nodiscard]] metrics::Estimate tile_mean(const Mask& mask, int width, int height,
                                          const std::function<double(std::size_t pixel, int channel)>& value);

/// A root mean square with the interval of the mean square carried through the root; a mean square below 0 (noise taken off) has the root 0.
struct RootMeanSquare {
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;
};
[[nodiscard]] RootMeanSquare root(const metrics::Estimate& mean_square);

}  // namespace plumbline::checks
