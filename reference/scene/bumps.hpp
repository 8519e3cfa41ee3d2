// reference/scene/bumps.hpp: a scene whose fine shape is a normal map.
#pragma once

#include "reference/scene/scene.hpp"

namespace plumbline::scene {

/// Normal map of a tileable relief, 8 bits a channel; normals lean by up to about 40 degrees. `side` texels each way.
[[nodiscard]] Texture make_bump_map(int side);

/// A ring standing on a ground before a wall, all with the same relief; on the wall the texture is mirrored. The meshes are smooth and
/// fine enough for transfer at vertices.
[[nodiscard]] Scene make_normal_mapped();

}  // namespace plumbline::scene
