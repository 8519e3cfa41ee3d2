#include "reference/scene/load.hpp"

#include <fmt/format.h>

#include "reference/base/error.hpp"
#include "reference/base/text.hpp"
#include "reference/scene/builtin.hpp"

namespace plumbline::scene {
Scene load_scene(const std::string& source, const LoadOptions& options) {
  constexpr std::string_view kBuiltin = "builtin:";
  if (source.starts_with(kBuiltin)) {
    return make_builtin_scene(std::string_view(source).substr(kBuiltin.size()));
  }
  const std::string extension = lower_case_extension(source);
  if (extension == ".gltf" || extension == ".glb") return load_gltf(source, options);
  if (extension == ".obj") return load_obj(source, options);
  if (extension == ".ply") return load_ply(source, options);
  throw InputError(
      fmt::format("{}: unknown kind of scene \"{}\", expected .gltf, .glb, .obj, .ply or builtin:NAME",
                  source, extension));
}

// The sphere around the bounds fits into the narrower of the two fields of view of a square or wide image:
// distance = radius / sin(fov / 2), and 5 % of air.
Camera frame_camera(const Scene& scene) {
  constexpr double kFovDeg = 40.0;
  const Bounds box = bounds(scene);
  const Vec3d low(box.low);
  const Vec3d high(box.high);
  const Vec3d centre = 0.5 * (low + high);
  const double radius = 0.5 * glm::length(high - low);
  const double distance = 1.05 * radius / std::sin(0.5 * kFovDeg * kPi / 180.0);
  const Vec3d front_right_above = glm::normalize(Vec3d(0.5, 0.4, 1.0));
  const Vec3d eye = centre + distance * front_right_above;
  return look_at(Vec3(eye), Vec3(centre), Vec3(0.0F, 1.0F, 0.0F), static_cast<float>(kFovDeg), "framed");
}

const Camera& find_camera(const Scene& scene, const std::string& name) {
  if (scene.cameras.empty()) throw InputError(fmt::format("scene {}: has no camera", scene.name));
  if (name.empty()) return scene.cameras.front();
  std::string names;
  for (const Camera& camera : scene.cameras) {
    if (camera.name == name) return camera;
    names += (names.empty() ? "" : ", ") + camera.name;
  }
  throw InputError(fmt::format("scene {}: no camera \"{}\", there are: {}", scene.name, name, names));
}

}  // namespace plumbline::scene
