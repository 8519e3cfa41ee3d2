#include "reference/scene/exact_scenes.hpp"

#include <cmath>

#include "reference/scene/shapes.hpp"

namespace plumbline::scene {
namespace {

constexpr Vec3 kUp(0.0F, 1.0F, 0.0F);

}  // namespace

Scene make_sphere_room(const SphereRoom& room) {
  Scene scene;
  const auto wall =
      add_material(scene, {.name = "wall", .albedo = Rgb(room.albedo), .emission = Rgb(room.emission)});
  scene.spheres.push_back({.radius = room.radius, .material = wall, .is_inward = true});
  const float r = room.radius;
  scene.cameras.push_back(
      look_at({0.3F * r, -0.2F * r, 0.5F * r}, {-0.4F * r, 0.3F * r, -r}, kUp, 70.0F, "inside"));
  return scene;
}

Scene make_cavity(double opening_half_angle_rad, float albedo) {
  Scene scene;
  const auto wall = add_material(scene, {.name = "wall", .albedo = Rgb(albedo)});
  scene.spheres.push_back({.material = wall,
                           .is_inward = true,
                           .keep_axis = -kUp,
                           .keep_min_cosine = static_cast<float>(-std::cos(opening_half_angle_rad))});
  scene.cameras.push_back(look_at({0.0F, 2.6F, 1.2F}, {0.0F, -0.3F, 0.0F}, kUp, 40.0F, "above"));
  return scene;
}

Scene make_bowl(float albedo) {
  return make_cavity(0.5 * kPi, albedo);
}

Scene make_concentric_spheres(const ConcentricSpheres& spheres) {
  const auto radiance = [](float exitance) {
    return Rgb(static_cast<float>(static_cast<double>(exitance) / kPi));
  };
  Scene scene;
  const auto inner = add_material(
      scene,
      {.name = "inner", .albedo = Rgb(spheres.inner_albedo), .emission = radiance(spheres.inner_exitance)});
  const auto outer = add_material(
      scene,
      {.name = "outer", .albedo = Rgb(spheres.outer_albedo), .emission = radiance(spheres.outer_exitance)});
  scene.spheres.push_back({.radius = spheres.inner_radius, .material = inner});
  scene.spheres.push_back({.radius = spheres.outer_radius, .material = outer, .is_inward = true});
  const float between = 0.2F * spheres.inner_radius + 0.8F * spheres.outer_radius;
  scene.cameras.push_back(
      look_at({0.0F, 0.0F, between}, {spheres.inner_radius, 0.0F, 0.0F}, kUp, 80.0F, "between"));
  return scene;
}

Scene make_sphere_over_plane(const SphereOverPlane& shape) {
  Scene scene;
  const auto plane = add_material(scene, {.name = "plane", .albedo = Rgb(shape.plane_albedo)});
  const auto sphere = add_material(
      scene, {.name = "sphere", .albedo = Rgb(shape.sphere_albedo), .emission = Rgb(shape.sphere_emission)});
  append(scene, make_graded_square(Vec3d(0.0), {1.0, 0.0, 0.0}, {0.0, 0.0, -1.0}, 1e-3, 1e3), plane);
  scene.spheres.push_back({.centre = {0.0F, shape.height, 0.0F}, .radius = shape.radius, .material = sphere});
  const float size = shape.height + shape.radius;
  scene.cameras.push_back(
      look_at({1.4F * size, 1.2F * size, 2.6F * size}, {0.0F, 0.35F * size, 0.0F}, kUp, 40.0F, "front"));
  return scene;
}

}  // namespace plumbline::scene
