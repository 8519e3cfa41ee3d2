// validation/metrics/compare.hpp: how far a test image is from a reference, and how sure that is.
#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "reference/image/image.hpp"

namespace plumbline::metrics {

/// All over pixels x 3 channels whose both values are finite; the rest is counted in `nonfinite` and never
/// skipped silently: a verdict must refuse nonfinite > 0 or pixels = 0. r = reference, v = test.
struct ImageComparison {
  double rmse = 0.0;           // sqrt(mean (v - r)^2)
  double relative_rmse = 0.0;  // rmse / mean(r)
  double mse = 0.0;
  double mse_unbiased =
      0.0;  // mse less the variance of both images (stderr layers, or halves "a" and "b"); may be < 0
  double max_abs = 0.0;
  double mean_signed = 0.0;  // mean (v - r)
  double mean_signed_stderr =
      0.0;  // its standard error from the stderr layers; without them from the spread over 16x16 tiles
  double bias_z = 0.0;        // mean_signed / mean_signed_stderr
  double psnr = 0.0;          // 10 log10(1 / mse of the tone-mapped images) [dB], infinite for equal images
  double flip_mean = 0.0;     // LDR-FLIP of the tone-mapped images, 67 pixels per degree
  double ssim = 0.0;          // of the tone-mapped luminances
  std::size_t pixels = 0;     // compared
  std::size_t nonfinite = 0;  // pixels with a NaN or Inf in either image
};

/// @throws InputError when sizes differ or R, G, B are missing in either.
[[nodiscard]] ImageComparison compare(const image::LayeredImage& reference, const image::LayeredImage& test);

/// Name -> value, as written by `compare --json` and as accepted by --fail-above.
[[nodiscard]] std::map<std::string, double> as_map(const ImageComparison& comparison);

/// |v - r| averaged over channels as a colour map from 0 (dark) to `scale` (bright); a non-finite pixel is
/// magenta.
[[nodiscard]] image::Image8 heat_map(const image::Image& reference, const image::Image& test, double scale);

}  // namespace plumbline::metrics
