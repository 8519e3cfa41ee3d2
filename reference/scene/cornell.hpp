// reference/scene/cornell.hpp: the Cornell box from its measured data.
#pragma once

#include "reference/scene/scene.hpp"

namespace plumbline::scene {

/// The Cornell box in metres: 32 flat triangles. Geometry and camera are the measured data that Cornell's
/// Program of Computer Graphics publishes (www.graphics.cornell.edu/online/box/data.html) divided
/// by 100, the floor's and the walls' slight skew included. The lamp hangs 5 mm below the
/// closed ceiling instead of filling a hole in it. Colours are the usual three-channel values, not the
/// measured spectra.
[[nodiscard]] Scene make_cornell();

}  // namespace plumbline::scene
