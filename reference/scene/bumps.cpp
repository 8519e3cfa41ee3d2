#include "reference/scene/bumps.hpp"

#include <cmath>
#include <functional>

#include "reference/scene/shapes.hpp"
#include "reference/scene/tangents.hpp"

namespace plumbline::scene {
namespace {

// Height over the tile's side: h = a cos 2 pi u cos 2 pi v + b cos 2 pi (3 u + v).
Vec3d relief_normal(double u, double v) {
  constexpr double kCoarse = 0.09;
  constexpr double kFine = 0.015;
  constexpr double kTurn = 2.0 * kPi;
  const double fine = -kFine * kTurn * std::sin(kTurn * (3.0 * u + v));
  const double along_u = -kCoarse * kTurn * std::sin(kTurn * u) * std::cos(kTurn * v) + 3.0 * fine;
  const double along_v = -kCoarse * kTurn * std::cos(kTurn * u) * std::sin(kTurn * v) + fine;
  return glm::normalize(Vec3d(-along_u, along_v, 1.0));  // the map's +y is towards smaller v
}

struct Patch {
  int columns = 1;
  int rows = 1;
  std::function<Vec3d(double u, double v)> point;
  std::function<Vec3d(double u, double v)> normal;  // du x dv, unit
  std::function<Vec2(double u, double v)> texcoord;
};

void append_patch(Scene& scene, const Patch& patch, std::uint32_t material) {
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  const auto stride = static_cast<std::uint32_t>(patch.columns) + 1;
  for (int j = 0; j <= patch.rows; ++j) {
    for (int i = 0; i <= patch.columns; ++i) {
      const double u = static_cast<double>(i) / patch.columns;
      const double v = static_cast<double>(j) / patch.rows;
      scene.positions.emplace_back(patch.point(u, v));
      scene.normals.emplace_back(patch.normal(u, v));
      scene.texcoords.push_back(patch.texcoord(u, v));
    }
  }
  for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(patch.rows); ++j) {
    for (std::uint32_t i = 0; i + 1 < stride; ++i) {
      const std::uint32_t a = first + j * stride + i;
      scene.triangles.emplace_back(a, a + 1, a + stride + 1);
      scene.triangles.emplace_back(a, a + stride + 1, a + stride);
    }
  }
  scene.triangle_materials.resize(scene.triangles.size(), material);
}

/// `low` is where u = v = 0; the texture is `repeats` tiles wide and high, u from left to right or, mirrored, from right to left.
Patch make_square(int cells, const Vec3d& low, const Vec3d& edge_u, const Vec3d& edge_v,
                  const Vec2& repeats) {
  const Vec3d normal = glm::normalize(glm::cross(edge_u, edge_v));
  return {cells, cells, [=](double u, double v) { return low + u * edge_u + v * edge_v; },
          [=](double, double) { return normal; },
          [=](double u, double v) {
            return Vec2(repeats.x * static_cast<float>(u), std::abs(repeats.y) * static_cast<float>(1.0 - v));
          }};
}

Patch make_ring(double major, double minor, const Vec3d& centre, const Vec2& repeats) {
  const auto outward = [](double u, double v) {
    const double a = 2.0 * kPi * u;
    const double b = 2.0 * kPi * v;
    return Vec3d(std::cos(b) * std::cos(a), std::cos(b) * std::sin(a), std::sin(b));
  };
  const auto point = [=](double u, double v) {
    const double a = 2.0 * kPi * u;
    return centre + major * Vec3d(std::cos(a), std::sin(a), 0.0) + minor * outward(u, v);
  };
  return {96, 40, point, outward, [=](double u, double v) {
            return Vec2(repeats.x * static_cast<float>(u), repeats.y * static_cast<float>(1.0 - v));
          }};
}

}  // namespace

Texture make_bump_map(int side) {
  Texture map{image::make_image(side, side)};
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const Vec3d normal = relief_normal((x + 0.5) / side, (y + 0.5) / side);
      for (int c = 0; c < 3; ++c) {
        const auto level = static_cast<float>(std::lround(127.5 * (normal[c] + 1.0)));
        map.image.at(x, y)[c] = level * (1.0F / 255.0F);  // as image files are read, to the last bit
      }
    }
  }
  return map;
}

Scene make_normal_mapped() {
  Scene scene;
  scene.textures.push_back(make_bump_map(64));
  const auto material = [&](const char* name, Rgb albedo) {
    return add_material(scene, {.name = name, .albedo = albedo, .normal_texture = 0});
  };
  append_patch(scene, make_square(48, {-3.0, 0.0, 3.0}, {6.0, 0.0, 0.0}, {0.0, 0.0, -6.0}, {6.0F, 6.0F}),
               material("ground", Rgb(0.6F)));
  append_patch(scene, make_square(32, {-2.4, 0.0, -1.5}, {4.8, 0.0, 0.0}, {0.0, 3.0, 0.0}, {-4.8F, 3.0F}),
               material("wall", {0.7F, 0.6F, 0.5F}));
  append_patch(scene, make_ring(0.9, 0.38, {0.0, 1.26, 0.0}, {6.0F, 2.0F}),
               material("ring", {0.5F, 0.6F, 0.8F}));
  scene.tangents.resize(scene.positions.size(), glm::vec4(0.0F));
  scene = with_computed_tangents(std::move(scene));
  scene.cameras.push_back(
      look_at({2.4F, 2.6F, 5.0F}, {0.0F, 1.0F, -0.3F}, {0.0F, 1.0F, 0.0F}, 40.0F, "front"));
  return scene;
}

}  // namespace plumbline::scene
