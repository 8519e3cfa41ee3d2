#include "validation/checks/depth_bias.hpp"

#include <algorithm>
#include <cmath>

#include "prt/sh/basis.hpp"
#include "reference/base/error.hpp"

namespace plumbline::checks {

// A white sky has one coefficient, sqrt(4 pi).
DepthBias depth_bias(const transfer::Transfer& depth, const transfer::Transfer& rays) {
  if (depth.coefficients.size() != rays.coefficients.size() || depth.bands != rays.bands ||
      depth.vertices != rays.vertices || rays.coefficients.empty())
    throw InputError("depth bias: the transfers differ in shape");
  DepthBias result;
  double squares = 0.0;
  double energy = 0.0;
  for (std::size_t i = 0; i < rays.coefficients.size(); ++i) {
    const auto truth = static_cast<double>(rays.coefficients[i]);
    const double difference = static_cast<double>(depth.coefficients[i]) - truth;
    squares += difference * difference;
    energy += truth * truth;
  }
  result.relative_rmse = std::sqrt(squares / energy);
  for (std::size_t v = 0; v < rays.vertices; ++v) {
    const double share = std::sqrt(4.0 * kPi) * (static_cast<double>(depth.vector(v, 0)[0]) -
                                                 static_cast<double>(rays.vector(v, 0)[0]));
    result.mean_signed += share / static_cast<double>(rays.vertices);
    result.largest = std::max(result.largest, std::abs(share));
  }
  return result;
}

}  // namespace plumbline::checks
