// validation/metrics/ssim.hpp: structural similarity (Wang, Bovik, Sheikh and Simoncelli, "Image Quality
// Assessment: From Error Visibility to Structural Similarity", 2004).
#pragma once

#include <span>

namespace plumbline::metrics {

/// Mean SSIM of two gray images with values in [0, 1]: Gaussian window 11 x 11, sigma 1.5, K = 0.01 / 0.03,
/// range 1. Windows are cut at the border and renormalised. 1 for equal images, NaN when a value is NaN.
///   (2 m_a m_b + C1)(2 s_ab + C2) / ((m_a^2 + m_b^2 + C1)(s_a^2 + s_b^2 + C2)),  C1 = 0.01^2, C2 = 0.03^2
/// with the window's weighted means m, variances s^2 and covariance s_ab (weights of sum 1).
/// @throws InputError when a or b does not hold width * height values, or there are none.
[[nodiscard]] double ssim(std::span<const float> a, std::span<const float> b, int width, int height);

}  // namespace plumbline::metrics
