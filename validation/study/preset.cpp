#include "validation/study/preset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "reference/base/error.hpp"
#include "reference/scene/builtin.hpp"
#include "reference/scene/load.hpp"
#include "reference/scene/shapes.hpp"

namespace plumbline::study {
namespace {

constexpr const char* kBunny = "/usr/share/glmark2/models/bunny.obj";
constexpr const char* kCity = "/usr/share/blender/datafiles/studiolights/world/city.exr";

void require_file(const char* path, const char* package) {
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored)) return;
  throw InputError(fmt::format("preset bunny: {}: no such file (Debian package {})", path, package));
}

/// Largest extent 2, the middle of its bounds over the origin, the lowest point on y = 0.
void stand_on_origin(scene::Scene& scene) {
  const scene::Bounds box = scene::bounds(scene);
  const Vec3 size = box.high - box.low;
  const float scale = 2.0F / max_component(size);
  const Vec3 foot(0.5F * (box.low.x + box.high.x), box.low.y, 0.5F * (box.low.z + box.high.z));
  for (Vec3& position : scene.positions) position = scale * (position - foot);
}

}  // namespace

std::vector<std::string> preset_names() {
  return {"cornell", "bunny"};
}

scene::Scene make_bunny_on_ground(float crease_deg) {
  require_file(kBunny, "glmark2-data");
  scene::Scene scene = scene::load_scene(kBunny, {.crease_deg = crease_deg});
  stand_on_origin(scene);
  for (scene::Material& material : scene.materials) material.albedo = Rgb(0.7F, 0.6F, 0.5F);
  const auto ground = scene::add_material(scene, {.name = "ground", .albedo = Rgb(0.4F)});
  scene::append(scene, scene::make_grid({-6.0, 0.0, 6.0}, {12.0, 0.0, 0.0}, {0.0, 0.0, -12.0}, 1, 1), ground);
  scene.cameras = {
      scene::look_at({1.6F, 1.9F, 3.6F}, {0.0F, 0.75F, 0.0F}, {0.0F, 1.0F, 0.0F}, 40.0F, "front")};
  scene.name = "preset:bunny";
  return scene;
}

Preset make_preset(const std::string& name) {
  if (name == "cornell") return {scene::make_builtin_scene("cornell"), "builtin:black"};
  if (name == "bunny") {
    Preset preset{make_bunny_on_ground(), kCity};
    require_file(kCity, "blender-data");
    return preset;
  }
  throw InputError(fmt::format("preset {}: not one of {}", name, fmt::join(preset_names(), ", ")));
}

}  // namespace plumbline::study
