#include "reference/scene/ground.hpp"

#include <algorithm>

namespace plumbline::scene {
namespace {

// Arrays that hold one value per vertex, or none at all, stay that way.
template <class Value>
void pad(std::vector<Value>& values, std::size_t vertices, const Value& fill) {
  if (!values.empty()) values.resize(vertices, fill);
}

}  // namespace

Scene with_ground(Scene scene, const GroundOptions& options) {
  const Bounds box = bounds(scene);
  const Vec3 size = box.high - box.low;
  const Vec3 centre = 0.5F * (box.low + box.high);
  const float side = options.extent * std::max(std::max(size.x, size.z), 0.5F * size.y);
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  const auto row = static_cast<std::uint32_t>(options.cells) + 1;
  for (std::uint32_t i = 0; i < row; ++i) {
    for (std::uint32_t k = 0; k < row; ++k) {
      const float u = static_cast<float>(k) / static_cast<float>(options.cells) - 0.5F;
      const float v = static_cast<float>(i) / static_cast<float>(options.cells) - 0.5F;
      scene.positions.emplace_back(centre.x + u * side, box.low.y, centre.z + v * side);
      scene.normals.emplace_back(0.0F, 1.0F, 0.0F);
    }
  }
  pad(scene.texcoords, scene.positions.size(), Vec2(0.0F));
  pad(scene.vertex_colors, scene.positions.size(), Rgb(1.0F));
  pad(scene.tangents, scene.positions.size(), glm::vec4(1.0F, 0.0F, 0.0F, 1.0F));
  scene.materials.push_back({"ground", Rgb(options.albedo), Rgb(0.0F), -1, false});
  for (std::uint32_t i = 0; i + 1 < row; ++i) {
    for (std::uint32_t k = 0; k + 1 < row; ++k) {
      const std::uint32_t a = first + i * row + k;
      scene.triangles.emplace_back(a, a + row, a + row + 1);
      scene.triangles.emplace_back(a, a + row + 1, a + 1);
    }
  }
  scene.triangle_materials.resize(scene.triangles.size(),
                                  static_cast<std::uint32_t>(scene.materials.size() - 1));
  return scene;
}

}  // namespace plumbline::scene
