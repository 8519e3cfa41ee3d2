#include "validation/checks/truths_scenes.hpp"

#include <cmath>

namespace plumbline::checks {
namespace {

Vec3 unit(const Vec3d& v) {
  return Vec3(glm::normalize(v));
}

/// A face from the z axis out to kFar along u; front along u x z, or z x u.
enum class Turn { u_then_z, z_then_u };
void add_graded_face(scene::Scene& scene, const Vec3d& u, Turn turn, double albedo) {
  const std::uint32_t material = add_grey(scene, albedo);
  std::vector<double> marks = {0.0};
  for (double mark = kNear / 4.0; mark < kFar; mark *= 4.0) marks.push_back(mark);
  marks.push_back(kFar);
  const auto cell = [&](std::size_t i, double z0, double z1) {
    const Vec3d corner = u * marks[i] + Vec3d(0.0, 0.0, z0);
    const Vec3d along_u = u * (marks[i + 1] - marks[i]);
    const Vec3d along_z(0.0, 0.0, z1 - z0);
    turn == Turn::u_then_z ? add_quad(scene, corner, along_u, along_z, material)
                           : add_quad(scene, corner, along_z, along_u, material);
  };
  for (std::size_t i = 0; i + 1 < marks.size(); ++i) {
    for (std::size_t k = 0; k + 1 < marks.size(); ++k) {
      cell(i, marks[k], marks[k + 1]);
      cell(i, -marks[k + 1], -marks[k]);
    }
  }
}

}  // namespace

std::uint32_t add_grey(scene::Scene& scene, double albedo, double emission, bool is_double_sided) {
  scene.materials.push_back(
      {"", Rgb(static_cast<float>(albedo)), Rgb(static_cast<float>(emission)), -1, is_double_sided});
  return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

void add_triangle(scene::Scene& scene, const Vec3d& a, const Vec3d& b, const Vec3d& c,
                  std::uint32_t material) {
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  const Vec3 normal = unit(glm::cross(b - a, c - a));
  for (const Vec3d& corner : {a, b, c}) {
    scene.positions.emplace_back(corner);
    scene.normals.push_back(normal);
  }
  scene.triangles.emplace_back(first, first + 1, first + 2);
  scene.triangle_materials.push_back(material);
}

void add_quad(scene::Scene& scene, const Vec3d& corner, const Vec3d& u, const Vec3d& v,
              std::uint32_t material) {
  add_triangle(scene, corner, corner + u, corner + u + v, material);
  add_triangle(scene, corner, corner + u + v, corner + v, material);
}

void add_sphere(scene::Scene& scene, const Vec3d& centre, double radius, Front front, std::uint32_t material,
                const Kept& kept) {
  scene::Sphere sphere;
  sphere.centre = Vec3(centre);
  sphere.radius = static_cast<float>(radius);
  sphere.material = material;
  sphere.is_inward = front == Front::inward;
  sphere.keep_axis = unit(kept.axis);
  sphere.keep_min_cosine = static_cast<float>(kept.min_cosine);
  scene.spheres.push_back(sphere);
}

void add_disc(scene::Scene& scene, const Vec3d& centre, const Vec3d& normal, double radius,
              std::uint32_t material) {
  scene.discs.push_back({Vec3(centre), unit(normal), static_cast<float>(radius), material});
}

void add_room(scene::Scene& scene, double size, std::uint32_t material) {
  const Vec3d x(size, 0.0, 0.0);
  const Vec3d y(0.0, size, 0.0);
  const Vec3d z(0.0, 0.0, size);
  const Vec3d o(0.0);
  add_quad(scene, o, z, x, material);  // floor
  add_quad(scene, y, x, z, material);  // ceiling
  add_quad(scene, o, x, y, material);
  add_quad(scene, z, y, x, material);
  add_quad(scene, o, y, z, material);
  add_quad(scene, x, z, y, material);
}

void add_ground(scene::Scene& scene, double albedo) {
  add_quad(scene, {-kFar, 0.0, -kFar}, {0.0, 0.0, 2.0 * kFar}, {2.0 * kFar, 0.0, 0.0},
           add_grey(scene, albedo));
}

scene::Scene dihedral(double opening, double floor_albedo, double wall_albedo) {
  scene::Scene scene;
  add_graded_face(scene, {1.0, 0.0, 0.0}, Turn::z_then_u, floor_albedo);
  add_graded_face(scene, {std::cos(opening), std::sin(opening), 0.0}, Turn::u_then_z, wall_albedo);
  return scene;
}

scene::Scene nothing_in_the_way() {
  scene::Scene scene;
  add_triangle(scene, {0.0, -2e6, 0.0}, {0.0, -2e6, 1.0}, {1.0, -2e6, 0.0}, add_grey(scene, 0.0));
  return scene;
}

light::Environment constant_sky(double radiance) {
  light::Environment environment;
  environment.name = "constant";
  environment.sky = light::ConstantSky{Rgb(static_cast<float>(radiance))};
  return environment;
}

light::Environment analytic_sky(std::function<double(const Vec3d&)> radiance) {
  light::Environment environment;
  environment.name = "analytic";
  environment.sky = light::AnalyticSky{[radiance = std::move(radiance)](const Vec3& direction) {
    return Rgb(static_cast<float>(radiance(Vec3d(direction))));
  }};
  return environment;
}

light::Environment lat_long_sky(const std::vector<double>& texels, int width, int height,
                                light::Lookup lookup) {
  light::Environment environment;
  environment.name = "image";
  environment.lookup = lookup;
  image::Image image = image::make_image(width, height);
  for (std::size_t i = 0; i < texels.size(); ++i) image.pixels[i] = Rgb(static_cast<float>(texels[i]));
  environment.sky = light::LatLongSky{std::move(image)};
  return environment;
}

light::SunDisc sun(const Vec3d& direction, double half_angle, double radiance) {
  return {unit(direction), half_angle, Rgb(static_cast<float>(radiance))};
}

Vec3d tilted(double angle) {
  return {std::sin(angle), std::cos(angle), 0.0};
}

// Archimedes: the height is uniform.
Vec3d uniform_direction(double u, double v) {
  const double height = 1.0 - 2.0 * u;
  const double radius = std::sqrt(std::max(0.0, 1.0 - height * height));
  return {radius * std::cos(2.0 * kPi * v), height, radius * std::sin(2.0 * kPi * v)};
}

}  // namespace plumbline::checks
