// validation/checks/depth_bias.hpp: what depth maps do to a bake.
#pragma once

#include "prt/relight/gl/depth_bake.hpp"

namespace plumbline::checks {

/// A bake from depth maps against rays along the same directions: nothing but visibility differs.
struct DepthBias {
  double relative_rmse = 0.0;  // of all coefficients, over the root mean square of the rays'
  double mean_signed =
      0.0;  // of the share of a white sky that vertices see, E / pi: < 0 too dark, > 0 too bright
  double largest = 0.0;  // |difference| of that share at a vertex
};
/// Both transfers have the same shape. @throws InputError when they have not.
[[nodiscard]] DepthBias depth_bias(const transfer::Transfer& depth, const transfer::Transfer& rays);

}  // namespace plumbline::checks
