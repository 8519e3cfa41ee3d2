// validation/metrics/compare.hpp: how far a test image is from a reference, and how sure that is.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "reference/image/image.hpp"

namespace plumbline::metrics {

/// All over pixels x 3 channels whose both values are finite; the rest is counted in `nonfinite` and never
/// skipped silently: a verdict must refuse nonfinite > 0 or pixels = 0. r = reference, v = test. A pixel is
/// compared as a whole: one bad channel takes all three out. Over no pixels every mean is NaN.
///
/// Noise. The variance of an image's values is taken from its layers `stderr.R/G/B` (squared), else from
/// independent halves `a.R/G/B` and `b.R/G/B` whose mean it is ((a - b)^2 / 4). An image with neither counts
/// as free of noise. A standard error at a compared pixel that is not finite or negative means "unknown":
/// then mse_unbiased, mean_signed_stderr and bias_z are NaN.
///
/// Tone mapping (psnr, flip_mean, ssim only). One exposure for both images: the reference's 99th percentile
/// of luminance maps to 1/2 (exposure 1 where it is not positive), then values are clamped to [0, 1]. What
/// exceeds twice that luminance in both images therefore looks the same to these three, and to no other metric. flip_mean sees the linear values, psnr the sRGB-encoded
/// values, ssim the sRGB-encoded luminances. flip_mean and ssim look at neighbourhoods and are NaN when
/// nonfinite > 0.
struct ImageComparison {
  double rmse = 0.0;           // sqrt(mean (v - r)^2)
  double relative_rmse = 0.0;  // rmse / mean(r); mean(r) <= 0: infinite, but 0 when rmse = 0
  double relmse = 0.0;         // mean (v - r)^2 / (r^2 + 0.01), as renderers are compared
  double mse = 0.0;
  double mse_unbiased = 0.0;  // mse less the mean variance of both images (see Noise); may be < 0
  double max_abs = 0.0;
  double mean_signed = 0.0;         // mean (v - r)
  double mean_signed_stderr = 0.0;  // its standard error: from the noise of both images, pixels independent
                                    // and the channels of a pixel taken as fully correlated (never too small)
                                    // for stderr layers; where neither has any, from the spread over 16x16
                                    // tiles (smaller ones, halved until there are 16, in small images)
  double bias_z = 0.0;              // mean_signed / mean_signed_stderr; 0/0 = 0, x/0 = +-infinity
  double psnr = 0.0;          // 10 log10(1 / mse of the tone-mapped images) [dB], infinite for equal images
  double flip_mean = 0.0;     // LDR-FLIP of the tone-mapped images, 67 pixels per degree
  double ssim = 0.0;          // of the tone-mapped luminances
  std::size_t pixels = 0;     // compared
  std::size_t nonfinite = 0;  // pixels with a NaN or Inf in either image
};

/// @throws InputError when sizes differ, R, G, B are missing in either, a layer named above is there in part,
/// or a channel does not hold width * height values.
[[nodiscard]] ImageComparison compare(const image::LayeredImage& reference, const image::LayeredImage& test);

/// Name -> value, as written by `compare --json` and as accepted by --fail-above.
[[nodiscard]] std::map<std::string, double> as_map(const ImageComparison& comparison);

/// The verdicts of --fail-above and --fail-below: whether the metric is above (below) the threshold,
/// literally also for psnr and ssim, where larger is better. mean_signed and bias_z are judged by magnitude.
/// NaN, as the metric or as the threshold, is above and below everything, so that it fails.
/// @throws InputError for an unknown name; the message lists the known ones.
[[nodiscard]] bool exceeds(const ImageComparison& comparison, std::string_view metric, double threshold);
[[nodiscard]] bool falls_below(const ImageComparison& comparison, std::string_view metric, double threshold);

/// z of every tile: mean signed difference over its standard error, from the noise of both images as above.
/// Where the images have equal expectations and the noise is stated honestly, these are standard normal (or
/// closer to 0, where the channels' noise is not fully correlated). After Jung, Hanika and Dachsbacher,
/// "Detecting Bias in Monte Carlo Renderers using Welch's t-test", JCGT 9(2), 2020, with stated standard
/// errors in place of sampled ones.
struct TileZ {
  int columns = 0;
  int rows = 0;
  std::vector<double> z;  // columns * rows, row 0 at the top; NaN where a pixel or its noise is not finite
};
/// @param tile  edge length in pixels, >= 1; tiles at the right and bottom border may be smaller
/// @throws InputError as compare(), for tile < 1, and when neither image has noise layers.
[[nodiscard]] TileZ tile_z(const image::LayeredImage& reference, const image::LayeredImage& test, int tile);

// ---------------------------------------------------------------- pictures of the difference

/// The 99th percentile of |v - r| averaged over channels (of finite pixels), for the maps below; their
/// maximum where that is 0, and 1 where all are equal: always > 0. @throws InputError when sizes differ.
[[nodiscard]] double heat_scale(const image::Image& reference, const image::Image& test);

/// |v - r| averaged over channels as a colour map from 0 (dark) to `scale` (bright); a non-finite pixel is
/// magenta. Steps in CIE L* are even along the map. @throws InputError when sizes differ or scale is not > 0.
[[nodiscard]] image::Image8 heat_map(const image::Image& reference, const image::Image& test, double scale);

/// v - r averaged over channels, from -scale (blue) over 0 (white) to scale (red); a non-finite pixel is
/// magenta.
/// @throws InputError when sizes differ or scale is not > 0.
[[nodiscard]] image::Image8 signed_map(const image::Image& reference, const image::Image& test, double scale);

}  // namespace plumbline::metrics
