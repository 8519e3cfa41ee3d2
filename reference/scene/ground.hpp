// reference/scene/ground.hpp: something to stand on, for meshes that come without.
#pragma once

#include "reference/scene/scene.hpp"

namespace plumbline::scene {

struct GroundOptions {
  float albedo = 0.5F;
  float extent = 6.0F;  // side of the square in units of the scene's largest horizontal extent
  int cells = 96;       // per side
};

/// Adds a horizontal square under the scene, at its lowest point, as a grid of cells (per-vertex transfer needs them). Cameras stay.
[[nodiscard]] Scene with_ground(Scene scene, const GroundOptions& options = {});

}  // namespace plumbline::scene
