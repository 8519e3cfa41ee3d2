// validation/metrics/ssim.hpp: structural similarity (Wang et al. 2004).
#pragma once

#include <span>

namespace plumbline::metrics {

/// Mean SSIM of two gray images with values in [0, 1]: Gaussian window 11 x 11, sigma 1.5, K = 0.01 / 0.03,
/// range 1. Windows are cut at the border and renormalised. 1 for equal images.
[[nodiscard]] double ssim(std::span<const float> a, std::span<const float> b, int width, int height);

}  // namespace plumbline::metrics
