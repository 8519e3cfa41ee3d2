// reference/scene/terrain.hpp: a landscape of any number of triangles, to see how costs grow.
#pragma once

#include "reference/scene/scene.hpp"

namespace plumbline::scene {

/// Cells along a side of the landscape; 2 x cells^2 triangles: 2237 gives ten million.
inline constexpr int kFewestTerrainCells = 8;
inline constexpr int kMostTerrainCells = 8192;

/// Rolling hills over a square of 20 x 20, up to about 1.8 high, smooth normals, albedo 0.5. The surface is the same function at any
/// number of cells. @throws InputError for a number out of range.
[[nodiscard]] Scene make_terrain(int cells);

}  // namespace plumbline::scene
