// validation/metrics/flip.hpp: the FLIP image difference (Andersson et al. 2020, "FLIP: A Difference
// Evaluator for Alternating Images", HPG), low dynamic range.
#pragma once

#include <vector>

#include "reference/image/image.hpp"

namespace plumbline::metrics {

/// Per-pixel difference in [0, 1] of two images of equal size holding *linear* RGB in [0, 1]: what a viewer
/// sees who flips between them. 0 where they are equal; the same with the two images exchanged. Borders are
/// continued by their nearest pixel.
/// @param pixels_per_degree  67.02 = 0.7 m from a 0.7 m wide, 3840 pixel monitor
/// @throws InputError when sizes differ, a value is outside [0, 1] or NaN, or pixels_per_degree is not in (0,
/// 1000]
[[nodiscard]] std::vector<float> flip(const image::Image& reference, const image::Image& test,
                                      double pixels_per_degree = 67.0206);

}  // namespace plumbline::metrics
