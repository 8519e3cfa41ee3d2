#include "reference/scene/terrain.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "reference/base/error.hpp"
#include "reference/scene/shapes.hpp"

namespace plumbline::scene {
namespace {

constexpr double kSide = 20.0;

/// One ripple: height amplitude * sin(kx x + kz z + phase).
struct Wave {
  double amplitude, kx, kz, phase;
};
// Seven waves, each about half as high and twice as short as the one before; directions by the golden angle, so that none repeats.
constexpr std::array<Wave, 7> kWaves = {{{0.90, 0.45, 0.10, 0.0},
                                         {0.45, -0.62, 0.68, 1.1},
                                         {0.22, 0.15, -1.84, 2.3},
                                         {0.11, 2.28, 2.90, 0.4},
                                         {0.05, -7.24, -1.24, 1.7},
                                         {0.024, 12.3, -8.1, 2.9},
                                         {0.012, -8.9, 28.1, 0.8}}};

struct Ground {
  double height = 0.0;
  double slope_x = 0.0;
  double slope_z = 0.0;
};

Ground ground_at(double x, double z) {
  Ground ground;
  for (const Wave& wave : kWaves) {
    const double angle = wave.kx * x + wave.kz * z + wave.phase;
    ground.height += wave.amplitude * std::sin(angle);
    ground.slope_x += wave.amplitude * wave.kx * std::cos(angle);
    ground.slope_z += wave.amplitude * wave.kz * std::cos(angle);
  }
  return ground;
}

void add_vertices(int cells, Scene& scene) {
  const auto count = static_cast<std::size_t>(cells + 1) * static_cast<std::size_t>(cells + 1);
  scene.positions.reserve(count);
  scene.normals.reserve(count);
  for (int row = 0; row <= cells; ++row) {
    for (int column = 0; column <= cells; ++column) {
      const double x = kSide * (static_cast<double>(column) / cells - 0.5);
      const double z = kSide * (static_cast<double>(row) / cells - 0.5);
      const Ground ground = ground_at(x, z);
      scene.positions.emplace_back(x, ground.height, z);
      scene.normals.emplace_back(glm::normalize(Vec3d(-ground.slope_x, 1.0, -ground.slope_z)));
    }
  }
}

void add_triangles(int cells, std::uint32_t material, Scene& scene) {
  const auto row = static_cast<std::uint32_t>(cells + 1);
  scene.triangles.reserve(2 * static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells));
  for (std::uint32_t z = 0; z + 1 < row; ++z) {
    for (std::uint32_t x = 0; x + 1 < row; ++x) {
      const std::uint32_t a = z * row + x;
      scene.triangles.emplace_back(a, a + row, a + row + 1);
      scene.triangles.emplace_back(a, a + row + 1, a + 1);
    }
  }
  scene.triangle_materials.assign(scene.triangles.size(), material);
}

}  // namespace

Scene make_terrain(int cells) {
  if (cells < kFewestTerrainCells || cells > kMostTerrainCells) {
    throw InputError(fmt::format("terrain: expected {} to {} cells a side, got {}", kFewestTerrainCells,
                                 kMostTerrainCells, cells));
  }
  Scene scene;
  const auto soil = add_material(scene, {.name = "soil", .albedo = Rgb(0.5F)});
  add_vertices(cells, scene);
  add_triangles(cells, soil, scene);
  scene.cameras.push_back(
      look_at({0.0F, 5.5F, 13.0F}, {0.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, 45.0F, "front"));
  return scene;
}

}  // namespace plumbline::scene
