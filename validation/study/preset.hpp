// validation/study/preset.hpp: the scenes on which renderers are compared, with their light.
#pragma once

#include <string>
#include <vector>

#include "reference/scene/scene.hpp"

namespace plumbline::study {

struct Preset {
  scene::Scene scene;       // its first camera is the view
  std::string environment;  // as light::load_environment takes it
};

/// What there is: "cornell" (the measured Cornell box, black sky) and "bunny" (69,666 triangles on a ground of 12 x 12, HDR light).
[[nodiscard]] std::vector<std::string> preset_names();

/// @throws InputError for another name, and when a file of Debian's glmark2-data or blender-data is not there: the message
/// says which package has it.
[[nodiscard]] Preset make_preset(const std::string& name);

/// Debian's Stanford bunny, scaled to a largest extent of 2 and standing on y = 0 above the origin, on a square of two triangles.
/// `crease_deg` as in scene::LoadOptions: 0 gives flat faces. @throws InputError as make_preset.
[[nodiscard]] scene::Scene make_bunny_on_ground(float crease_deg = 0.0F);

}  // namespace plumbline::study
