#include "validation/checks/suite.hpp"

namespace plumbline::checks {

const std::vector<Family>& families() {
  static const std::vector<Family> all = {
      {"basis", "orthonormality, signs, addition theorem, clamped cosine", check_basis},
      {"projection", "coefficients of each environment, convergence with bands", check_projection},
      {"transfer", "transfer vectors against closed forms", check_transfer},
      {"furnace", "white furnace on each scene", check_furnace},
      {"bounces", "interreflected transfer, bounce by bounce", check_bounces, true},
      {"truths", "path tracer against closed forms of light transport", check_truths, true},
      {"images", "PRT images against path-traced ones", check_images},
      {"normal-maps", "normal-mapped PRT in seven forms against path tracing with the same map",
       check_normal_maps, true},
      {"exponential", "products, exponentials and logarithms, accumulated blockers", check_exponential},
      {"compression", "size against error of compressed transfer, and what one sees of it", check_compression,
       true},
  };
  return all;
}

}  // namespace plumbline::checks
