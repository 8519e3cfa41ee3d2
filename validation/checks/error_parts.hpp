// validation/checks/error_parts.hpp: the error of a PRT image, taken apart.
#pragma once

#include <string>
#include <vector>

#include "reference/image/image.hpp"
#include "validation/checks/finding.hpp"
#include "validation/checks/paired_error.hpp"
#include "validation/metrics/statistics.hpp"

namespace plumbline::checks {

using image::Image;

/// A path-traced image and its squared standard error.
struct Traced {
  Image mean;
  Image variance;
  double seconds = 0.0;
};

/// All images of one scene, light and band count.
struct Pictures {
  Traced full;          // A
  Traced band_limited;  // B
  Image vertex_a, vertex_b;
  Image prt_a, prt_b;
  Image unshadowed;
};

[[nodiscard]] Image mean_image(const Image& a, const Image& b);

/// The parts of the error, as mean squares over masked pixels, each with a standard error.
struct Parts {
  double mean_radiance = 0.0;            // of A
  metrics::Estimate full;                // P to A
  metrics::Estimate truncation;          // B to A
  metrics::Estimate band_limited;        // P to B, bake noise included
  metrics::Estimate without_bake_noise;  // the same without
  metrics::Estimate interpolation;       // C to B
  metrics::Estimate bake_noise;
  metrics::Estimate method;           // (P to B) - (C to B): must be 0
  metrics::Estimate mean_difference;  // mean of P - C over the mean radiance: must be 0
};

[[nodiscard]] Parts measure(const Pictures& pictures, const Mask& mask);

/// The three findings about one image: PRT's mean, its error beyond interpolation, and its error under the full light.
[[nodiscard]] std::vector<Finding> judge_parts(const std::string& name, const Parts& parts,
                                               double significance);

}  // namespace plumbline::checks
