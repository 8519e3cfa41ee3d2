#include "reference/scene/cornell.hpp"

#include <array>
#include <cmath>

#include "reference/scene/shapes.hpp"

namespace plumbline::scene {
namespace {

using Corners = std::array<Vec3d, 4>;

// The published order of the corners is counter-clockwise seen from the lit side in a right-handed frame (the
// camera looks along +z, +x is on its left).
Mesh quad(const Corners& corners) {
  Mesh mesh;
  for (const Vec3d& corner : corners) mesh.positions.emplace_back(corner / 100.0);
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return faceted(mesh);
}

constexpr Corners kFloor = {{{552.8, 0.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 559.2}, {549.6, 0.0, 559.2}}};
constexpr Corners kCeiling = {
    {{556.0, 548.8, 0.0}, {556.0, 548.8, 559.2}, {0.0, 548.8, 559.2}, {0.0, 548.8, 0.0}}};
constexpr Corners kBack = {
    {{549.6, 0.0, 559.2}, {0.0, 0.0, 559.2}, {0.0, 548.8, 559.2}, {556.0, 548.8, 559.2}}};
constexpr Corners kRight = {{{0.0, 0.0, 559.2}, {0.0, 0.0, 0.0}, {0.0, 548.8, 0.0}, {0.0, 548.8, 559.2}}};
constexpr Corners kLeft = {
    {{552.8, 0.0, 0.0}, {549.6, 0.0, 559.2}, {556.0, 548.8, 559.2}, {556.0, 548.8, 0.0}}};
constexpr Corners kLamp = {
    {{343.0, 548.3, 227.0}, {343.0, 548.3, 332.0}, {213.0, 548.3, 332.0}, {213.0, 548.3, 227.0}}};

constexpr std::array<Corners, 5> kShortBlock = {{
    {{{130.0, 165.0, 65.0}, {82.0, 165.0, 225.0}, {240.0, 165.0, 272.0}, {290.0, 165.0, 114.0}}},
    {{{290.0, 0.0, 114.0}, {290.0, 165.0, 114.0}, {240.0, 165.0, 272.0}, {240.0, 0.0, 272.0}}},
    {{{130.0, 0.0, 65.0}, {130.0, 165.0, 65.0}, {290.0, 165.0, 114.0}, {290.0, 0.0, 114.0}}},
    {{{82.0, 0.0, 225.0}, {82.0, 165.0, 225.0}, {130.0, 165.0, 65.0}, {130.0, 0.0, 65.0}}},
    {{{240.0, 0.0, 272.0}, {240.0, 165.0, 272.0}, {82.0, 165.0, 225.0}, {82.0, 0.0, 225.0}}},
}};
constexpr std::array<Corners, 5> kTallBlock = {{
    {{{423.0, 330.0, 247.0}, {265.0, 330.0, 296.0}, {314.0, 330.0, 456.0}, {472.0, 330.0, 406.0}}},
    {{{423.0, 0.0, 247.0}, {423.0, 330.0, 247.0}, {472.0, 330.0, 406.0}, {472.0, 0.0, 406.0}}},
    {{{472.0, 0.0, 406.0}, {472.0, 330.0, 406.0}, {314.0, 330.0, 456.0}, {314.0, 0.0, 456.0}}},
    {{{314.0, 0.0, 456.0}, {314.0, 330.0, 456.0}, {265.0, 330.0, 296.0}, {265.0, 0.0, 296.0}}},
    {{{265.0, 0.0, 296.0}, {265.0, 330.0, 296.0}, {423.0, 330.0, 247.0}, {423.0, 0.0, 247.0}}},
}};

}  // namespace

Scene make_cornell() {
  Scene scene;
  const auto white = add_material(scene, {.name = "white", .albedo = Rgb(0.725F, 0.71F, 0.68F)});
  const auto red = add_material(scene, {.name = "red", .albedo = Rgb(0.63F, 0.065F, 0.05F)});
  const auto green = add_material(scene, {.name = "green", .albedo = Rgb(0.14F, 0.45F, 0.091F)});
  const auto lamp =
      add_material(scene, {.name = "lamp", .albedo = Rgb(0.0F), .emission = Rgb(17.0F, 12.0F, 4.0F)});
  for (const Corners& wall : {kFloor, kCeiling, kBack}) append(scene, quad(wall), white);
  append(scene, quad(kLeft), red);
  append(scene, quad(kRight), green);
  append(scene, quad(kLamp), lamp);
  for (const Corners& face : kShortBlock) append(scene, quad(face), white);
  for (const Corners& face : kTallBlock) append(scene, quad(face), white);

  // Film 25 mm wide behind a focal length of 35 mm.
  const double half_angle = std::atan(0.5 * 0.025 / 0.035);
  scene.cameras.push_back({.name = "front",
                           .eye = Vec3(2.78F, 2.73F, -8.0F),
                           .forward = Vec3(0.0F, 0.0F, 1.0F),
                           .up = Vec3(0.0F, 1.0F, 0.0F),
                           .vertical_fov_rad = static_cast<float>(2.0 * half_angle)});
  return scene;
}

}  // namespace plumbline::scene
