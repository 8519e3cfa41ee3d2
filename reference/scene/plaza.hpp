// reference/scene/plaza.hpp: the detailed built-in scene.
#pragma once

#include "reference/scene/scene.hpp"

namespace plumbline::scene {

/// A round terrace with two fluted colonnades, an arch between them, a trefoil-knot sculpture, benches and
/// planted urns, on an open ground; 78 188 triangles, no light of its own (meant for a sky). Pieces are
/// closed solids that stand 1 cm deep in what carries them, so that nothing overlaps in a plane.
[[nodiscard]] Scene make_plaza();

}  // namespace plumbline::scene
