// reference/integrate/allocation.hpp: where an image's samples go.
#pragma once

#include <span>
#include <vector>

#include "reference/integrate/film.hpp"

namespace plumbline::integrate {

/// How many samples each pixel gets, relative to the others; the mean weight is 1.
///
/// The image's error is the mean over pixels of variance_p / n_p, so that for a given number of samples it is least where n_p
/// goes with the standard deviation. Weights come from a pilot image that is not part of the result: were the same samples
/// used for both, pixels that happen to look dark and calm would be left early and the image would be too dark (Kirk &
/// Arvo, "Unbiased sampling techniques for image synthesis", 1991). Given the weights, each pixel's mean is unbiased.
class Allocation {
 public:
  /// The same for all pixels.
  Allocation() = default;
  /// @param pilot  of width x height pixels, row by row; pixels without samples (another shard's) get weight 1.
  /// Standard deviations are averaged over 3 x 3 pixels, since a pilot of few samples knows them badly, and limited to a quarter
  /// and eight times the mean: a pixel where the pilot saw no noise may still have some.
  Allocation(std::span<const RgbEstimate> pilot, int width, int height);

  /// Samples of pixel `pixel` in a round of `mean` samples a pixel: a multiple of `randomisations` where there are that many
  /// (each randomisation gets as many), at least 2.
  [[nodiscard]] int samples(std::size_t pixel, double mean, int randomisations) const;
  [[nodiscard]] bool is_uniform() const { return weights_.empty(); }

  /// Mean squared error of an image of one sample a pixel, over that of the same samples dealt evenly: at most 1 by
  /// Cauchy-Schwarz, up to the limits above.
  [[nodiscard]] double gain() const { return gain_; }

 private:
  std::vector<float> weights_;
  double gain_ = 1.0;
};

}  // namespace plumbline::integrate
