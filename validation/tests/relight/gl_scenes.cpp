#include "gl_scenes.hpp"

#include <utility>

#include "../integrate/pieces.hpp"
#include "prt/transfer/bake.hpp"
#include "reference/light/environment.hpp"
#include "reference/scene/builtin.hpp"
#include "reference/scene/load.hpp"

namespace plumbline::test {
namespace {

transfer::Transfer baked(const scene::Scene& scene, int bands, transfer::Kind kind) {
  transfer::BakeSettings settings;
  settings.bands = bands;
  settings.kind = kind;
  settings.samples = 32;  // noise does not matter: both sides get the same transfer
  return transfer::bake(scene, settings);
}

// Red and blue vectors are the gray one scaled and turned round, so that a mix-up of channels shows.
transfer::Transfer in_three_channels(const transfer::Transfer& gray) {
  transfer::Transfer result = gray;
  result.channels = 3;
  result.coefficients.clear();
  result.standard_errors.clear();
  for (std::size_t v = 0; v < gray.vertices; ++v) {
    const std::span<const float> vector = gray.vector(v, 0);
    for (const float value : vector) result.coefficients.push_back(0.5F * value);
    for (const float value : vector) result.coefficients.push_back(value);
    for (std::size_t i = 0; i < vector.size(); ++i)
      result.coefficients.push_back(i % 2 == 0 ? vector[i] : -0.25F * vector[i]);
  }
  return result;
}

int add_texture(scene::Scene& scene, int width, int height, scene::Wrap wrap_u, scene::Wrap wrap_v) {
  image::Image image = image::make_image(width, height);
  std::uint32_t state = 12345U;
  for (Rgb& texel : image.pixels) {
    for (int c = 0; c < 3; ++c) {
      state = state * 1664525U + 1013904223U;
      texel[c] = 0.02F + 0.96F * static_cast<float>(state >> 8U) / 16777216.0F;
    }
  }
  scene.textures.push_back({std::move(image), wrap_u, wrap_v});
  return static_cast<int>(scene.textures.size() - 1);
}

std::uint32_t add_textured(scene::Scene& scene, int texture) {
  const std::uint32_t material = add_material(scene, Rgb(0.9F, 0.8F, 1.0F));
  scene.materials[material].albedo_texture = texture;
  return material;
}

scene::Scene textured_scene() {
  using scene::Wrap;
  scene::Scene scene;
  const std::uint32_t repeated =
      add_textured(scene, add_texture(scene, 64, 32, Wrap::kRepeat, Wrap::kMirror));
  const std::uint32_t clamped = add_textured(scene, add_texture(scene, 7, 5, Wrap::kMirror, Wrap::kClamp));
  const std::uint32_t plain = add_material(scene, Rgb(0.3F, 0.6F, 0.9F));
  add_quad(scene, {-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, repeated);
  add_quad(scene, {-3, 0, -2}, {6, 0, 1}, {0, 3, 0}, clamped);
  add_sphere(scene, {1, 1, 1}, 1.0, 24, false, plain);
  add_triangle(scene, {-2, 0.1F, 1}, {-2, 2, 0}, {-1, 0.1F, 1}, plain);  // seen from behind
  for (const Vec3& p : scene.positions) {
    scene.texcoords.emplace_back(0.7F * p.x + 0.2F * p.y - 3.3F, 0.6F * p.z - 0.4F * p.y + 0.1F);
    scene.vertex_colors.emplace_back(0.5F + 0.1F * p.x, 0.6F + 0.05F * p.z, 0.9F);
  }
  for (Rgb& color : scene.vertex_colors) color = glm::clamp(color, 0.0F, 1.0F);
  scene.cameras.push_back(scene::look_at({0.5F, 4.0F, 9.0F}, {0, 0.5F, 0}, {0, 1, 0}, 45.0F));
  scene::validate(scene, "textures");
  return scene;
}

}  // namespace

RelitScene plaza_in_the_sun() {
  scene::Scene scene = scene::make_builtin_scene("plaza");
  transfer::Transfer transfer = baked(scene, 5, transfer::Kind::shadowed);
  return {"plaza under sun-sky, 5 bands",
          {std::move(scene), std::move(transfer)},
          sh::project_radiance(light::make_builtin_environment("sun-sky"), 5)};
}

RelitScene bunny_in_the_city() {
  scene::Scene scene = scene::load_scene("/usr/share/glmark2/models/bunny.obj");
  transfer::Transfer transfer = baked(scene, 4, transfer::Kind::shadowed);
  return {"bunny under city.exr, 4 bands",
          {std::move(scene), std::move(transfer)},
          sh::project_radiance(
              light::load_environment("/usr/share/blender/datafiles/studiolights/world/city.exr"), 4)};
}

RelitScene textures() {
  scene::Scene scene = textured_scene();
  transfer::Transfer transfer = in_three_channels(baked(scene, 3, transfer::Kind::unshadowed));
  return {"textures under two-lobes, 3 bands, RGB transfer",
          {std::move(scene), std::move(transfer)},
          sh::project_radiance(light::make_builtin_environment("two-lobes"), 3)};
}

std::vector<Rgb> rounded_sums(const RelitScene& scene) {
  std::vector<Rgb> result(scene.baked.transfer.vertices, Rgb(0.0F));
  for (std::size_t v = 0; v < result.size(); ++v) {
    for (int c = 0; c < 3; ++c) {
      const std::span<const float> vector = scene.baked.transfer.vector(v, c);
      double sum = 0.0;
      for (std::size_t i = 0; i < vector.size(); ++i)
        sum += static_cast<double>(vector[i]) * scene.lighting.coefficients[i][c];
      result[v][c] = static_cast<float>(sum);
    }
  }
  return result;
}

}  // namespace plumbline::test
