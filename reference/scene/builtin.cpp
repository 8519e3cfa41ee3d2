#include "reference/scene/builtin.hpp"

#include <fmt/format.h>

#include <array>

#include "reference/base/error.hpp"
#include "reference/scene/bumps.hpp"
#include "reference/scene/cornell.hpp"
#include "reference/scene/exact_scenes.hpp"
#include "reference/scene/plaza.hpp"
#include "reference/scene/shapes.hpp"
#include "reference/scene/terrain.hpp"
#include "reference/scene/text.hpp"

namespace plumbline::scene {
namespace {

constexpr Vec3 kUp(0.0F, 1.0F, 0.0F);

/// Exact unit sphere up to its facets (their points lie at most 1.1e-3 inside it); it touches the ground's
/// central vertex at the origin.
Scene make_sphere_on_plane() {
  Scene scene;
  const auto ground = add_material(scene, {.name = "ground", .albedo = Rgb(0.5F)});
  const auto sphere = add_material(scene, {.name = "sphere", .albedo = Rgb(0.7F, 0.6F, 0.5F)});
  append(scene, make_grid({-6.0, 0.0, 6.0}, {12.0, 0.0, 0.0}, {0.0, 0.0, -12.0}, 48, 48), ground);
  append(scene, placed(make_icosphere(5), {0.0, 1.0, 0.0}), sphere);
  scene.cameras.push_back(look_at({2.8F, 2.4F, 5.2F}, {0.0F, 0.75F, 0.0F}, kUp, 40.0F, "front"));
  return scene;
}

/// The edge is the x axis; both quads reach W = 1000 from the origin along x and away from the edge, so that
/// at distance d from the edge's middle they stand for infinite half planes up to (1/pi + 1/4) d/W in the
/// mutual form factor.
Scene make_corner() {
  constexpr double kReach = 1000.0;
  Scene scene;
  const auto floor = add_material(scene, {.name = "floor", .albedo = Rgb(0.8F)});
  const auto wall = add_material(scene, {.name = "wall", .albedo = Rgb(0.8F)});
  const Vec3d along(2.0 * kReach, 0.0, 0.0);
  append(scene, make_grid({-kReach, 0.0, kReach}, along, {0.0, 0.0, -kReach}, 1, 1), floor);
  append(scene, make_grid({-kReach, 0.0, 0.0}, along, {0.0, kReach, 0.0}, 1, 1), wall);
  scene.cameras.push_back(look_at({0.8F, 1.0F, 2.0F}, {0.0F, 0.3F, 0.0F}, kUp, 45.0F, "front"));
  return scene;
}

Scene make_box_furnace() {
  Scene scene;
  const auto wall = add_material(scene, {.name = "wall", .albedo = Rgb(0.8F), .emission = Rgb(1.0F)});
  append(scene, inside_out(make_box(Vec3d(-1.0), Vec3d(1.0))), wall);
  scene.cameras.push_back(look_at({0.3F, -0.2F, 0.7F}, {-0.4F, 0.3F, -1.0F}, kUp, 70.0F, "inside"));
  return scene;
}

/// Walls are sheets without thickness, front towards the inside, lit on both sides. The camera looks in
/// through the opening and sees fronts only: per-vertex transfer describes the side of the vertex normal.
Scene make_open_box() {
  constexpr int kCells = 24;
  struct Wall {
    const char* name;
    Rgb albedo;
    Vec3d corner, edge_u, edge_v;
  };
  const std::array<Wall, 5> walls = {{
      {"floor", Rgb(0.75F), {-1.0, 0.0, 1.0}, {2.0, 0.0, 0.0}, {0.0, 0.0, -2.0}},
      {"back", {0.80F, 0.76F, 0.55F}, {-1.0, 0.0, -1.0}, {2.0, 0.0, 0.0}, {0.0, 1.4, 0.0}},
      {"front", {0.45F, 0.40F, 0.65F}, {1.0, 0.0, 1.0}, {-2.0, 0.0, 0.0}, {0.0, 1.4, 0.0}},
      {"left", {0.75F, 0.20F, 0.12F}, {-1.0, 0.0, 1.0}, {0.0, 0.0, -2.0}, {0.0, 1.4, 0.0}},
      {"right", {0.15F, 0.35F, 0.70F}, {1.0, 0.0, -1.0}, {0.0, 0.0, 2.0}, {0.0, 1.4, 0.0}},
  }};
  Scene scene;
  for (const Wall& wall : walls) {
    const auto material =
        add_material(scene, {.name = wall.name, .albedo = wall.albedo, .is_double_sided = true});
    append(scene, make_grid(wall.corner, wall.edge_u, wall.edge_v, kCells, kCells), material);
  }
  scene.cameras.push_back(look_at({0.0F, 3.6F, 0.95F}, {0.0F, 0.45F, -0.2F}, kUp, 50.0F, "above"));
  return scene;
}

Scene make_convex() {
  Scene scene;
  const auto white = add_material(scene, {.name = "white", .albedo = Rgb(1.0F)});
  append(scene, faceted(make_icosphere(0)), white);
  scene.cameras.push_back(look_at({1.2F, 1.0F, 3.2F}, Vec3(0.0F), kUp, 45.0F, "front"));
  return scene;
}

Scene make_small_terrain() {
  return make_terrain(100);
}

/// "terrain:CELLS".
constexpr std::string_view kSizedTerrain = "terrain:";

Scene make_sized_terrain(std::string_view name) {
  const auto cells = parse_integer(name.substr(kSizedTerrain.size()));
  if (!cells || *cells < kFewestTerrainCells || *cells > kMostTerrainCells) {
    throw InputError(fmt::format("builtin:{}: expected terrain:CELLS with {} to {} cells a side", name,
                                 kFewestTerrainCells, kMostTerrainCells));
  }
  Scene scene = make_terrain(static_cast<int>(*cells));
  scene.name = fmt::format("builtin:{}", name);
  return scene;
}

struct Entry {
  const char* name;
  const char* description;
  Scene (*make)();
};

constexpr std::array<Entry, 13> kEntries = {{
    {"cornell", "32 triangles: the Cornell box from its measured data; area light, colour bleeding",
     make_cornell},
    {"sphere-on-plane",
     "25088 triangles: sphere resting on ground; soft shadow and ambient occlusion, per-vertex bakes",
     make_sphere_on_plane},
    {"corner", "4 triangles: two quads at 90 degrees, albedo 0.8; closed-form interreflection near the edge",
     make_corner},
    {"box-furnace", "12 triangles: closed cube, emission 1, albedo 0.8; radiance 5 everywhere",
     make_box_furnace},
    {"open-box",
     "5760 triangles: box without a lid, five colours, double-sided; interreflected per-vertex bakes",
     make_open_box},
    {"plaza", "78188 triangles: colonnades, arch, knot sculpture; a detailed scene for skies and suns",
     make_plaza},
    {"convex", "20 triangles: icosahedron, albedo 1; white furnace and unshadowed transfer", make_convex},
    {"terrain",
     "20000 triangles: hills, to see how costs grow; terrain:CELLS has 2 x CELLS^2 (terrain:2237: ten "
     "million)",
     make_small_terrain},
    {"normal-mapped", "14336 triangles: ring, ground and wall under one normal map; normal-mapped transfer",
     make_normal_mapped},
    {"sphere-furnace", "exact sphere seen from inside: emission 1, albedo 0.8; radiance 5 everywhere",
     [] { return make_sphere_room(); }},
    {"bowl", "exact half sphere, open above, albedo 0.8; under `white` irradiance 2.618 everywhere",
     [] { return make_bowl(); }},
    {"concentric", "two exact spheres facing each other, the inner one shines; radiosity 4/3 and 2/3",
     [] { return make_concentric_spheres(); }},
    {"exact-sphere-on-plane",
     "exact black sphere on a plane of 82 triangles; closed-form ambient occlusion under `white`",
     [] { return make_sphere_over_plane(); }},
}};

}  // namespace

std::vector<BuiltinInfo> builtin_scenes() {
  std::vector<BuiltinInfo> infos;
  for (const Entry& entry : kEntries) infos.push_back({entry.name, entry.description});
  return infos;
}

Scene make_builtin_scene(std::string_view name) {
  if (name.starts_with(kSizedTerrain)) return make_sized_terrain(name);
  std::string known;
  for (const Entry& entry : kEntries) {
    if (name == entry.name) {
      Scene scene = entry.make();
      scene.name = fmt::format("builtin:{}", name);
      return scene;
    }
    known += fmt::format("{}{}", known.empty() ? "" : ", ", entry.name);
  }
  throw InputError(fmt::format("builtin:{}: not one of {}", name, known));
}

}  // namespace plumbline::scene
