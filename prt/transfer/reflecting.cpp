#include "prt/transfer/reflecting.hpp"

#include <algorithm>
#include <vector>

namespace plumbline::transfer {
namespace {

bool is_gray(const Rgb& colour) {
  return colour.r == colour.g && colour.g == colour.b;
}

/// Calls body(material) for those that a triangle uses, until one answers false.
template <class Body>
bool all_used_materials(const scene::Scene& scene, const Body& body) {
  std::vector<bool> is_used(scene.materials.size(), false);
  for (const std::uint32_t material : scene.triangle_materials) is_used[material] = true;
  for (std::size_t m = 0; m < is_used.size(); ++m) {
    if (is_used[m] && !body(scene.materials[m])) return false;
  }
  return true;
}

template <class Is>
bool all_texels(const image::Image& image, const Is& is) {
  return std::all_of(image.pixels.begin(), image.pixels.end(), is);
}

}  // namespace

bool is_gray(const scene::Scene& scene) {
  const auto gray = [](const Rgb& colour) { return is_gray(colour); };
  if (!std::all_of(scene.vertex_colors.begin(), scene.vertex_colors.end(), gray)) return false;
  return all_used_materials(scene, [&](const scene::Material& material) {
    if (!is_gray(material.albedo)) return plumbline::is_black(material.albedo);
    return material.albedo_texture < 0 ||
           all_texels(scene.textures[static_cast<std::size_t>(material.albedo_texture)].image, gray);
  });
}

bool is_black(const scene::Scene& scene) {
  const auto black = [](const Rgb& colour) { return plumbline::is_black(colour); };
  return all_used_materials(scene, [&](const scene::Material& material) {
    return black(material.albedo) ||
           (material.albedo_texture >= 0 &&
            all_texels(scene.textures[static_cast<std::size_t>(material.albedo_texture)].image, black));
  });
}

}  // namespace plumbline::transfer
