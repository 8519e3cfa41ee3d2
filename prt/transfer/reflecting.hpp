// prt/transfer/reflecting.hpp: what a scene's surfaces can do to light on its way between them.
#pragma once

#include "reference/scene/scene.hpp"

namespace plumbline::transfer {

/// Whether every surface reflects red, green and blue alike: factors, textures and vertex colours of materials that triangles
/// use.
[[nodiscard]] bool is_gray(const scene::Scene& scene);
/// Whether no surface reflects anything.
[[nodiscard]] bool is_black(const scene::Scene& scene);

}  // namespace plumbline::transfer
