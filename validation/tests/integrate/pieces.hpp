// validation/tests/integrate/pieces.hpp: small scenes for tests, made of a few shapes.
#pragma once

#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "reference/light/environment.hpp"
#include "reference/scene/scene.hpp"

namespace plumbline::test {

inline std::uint32_t add_material(scene::Scene& scene, Rgb albedo, Rgb emission = Rgb(0.0F),
                                  bool is_double_sided = false) {
  scene.materials.push_back({"", albedo, emission, -1, is_double_sided});
  return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

/// A flat triangle, counter-clockwise as seen from its front.
inline void add_triangle(scene::Scene& scene, Vec3 a, Vec3 b, Vec3 c, std::uint32_t material) {
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  const Vec3 normal(glm::normalize(glm::cross(Vec3d(b) - Vec3d(a), Vec3d(c) - Vec3d(a))));
  for (const Vec3& corner : {a, b, c}) {
    scene.positions.push_back(corner);
    scene.normals.push_back(normal);
  }
  scene.triangles.emplace_back(first, first + 1, first + 2);
  scene.triangle_materials.push_back(material);
}

/// A parallelogram corner, corner + u, corner + u + v, corner + v; front along u x v.
inline void add_quad(scene::Scene& scene, Vec3 corner, Vec3 u, Vec3 v, std::uint32_t material) {
  add_triangle(scene, corner, corner + u, corner + u + v, material);
  add_triangle(scene, corner, corner + u + v, corner + v, material);
}

/// A regular polygon of `sides` sides that stands for a disc: its area is smaller by the factor 1 - 2 pi^2 /
/// (3 sides^2).
inline void add_disc(scene::Scene& scene, Vec3 centre, Vec3 u, Vec3 v, int sides, std::uint32_t material) {
  const auto rim = [&](int k) {
    const double angle = 2.0 * kPi * k / sides;
    return centre + static_cast<float>(std::cos(angle)) * u + static_cast<float>(std::sin(angle)) * v;
  };
  for (int k = 0; k < sides; ++k) add_triangle(scene, centre, rim(k), rim(k + 1), material);
}

/// A sphere of `rings` x 2 `rings` flat facets, h = pi / (2 rings) half a facet's angle. A facet's middle
/// lies deeper than its corners by up to h^2 of the radius, so with corners at radius (1 + h^2 / 2) every
/// point is within h^2 / 2 of the sphere, and what depends on the radius squared (area, solid angle) within
/// h^2; twice that covers the facets' tilt: relative error <= 2 h^2.
inline void add_sphere(scene::Scene& scene, Vec3 centre, double radius, int rings, bool is_inward,
                       std::uint32_t material) {
  const double h = kPi / (2.0 * rings);
  const double outer = radius * (1.0 + 0.5 * h * h);
  const auto point = [&](int ring, int k) {
    const double theta = kPi * ring / rings;
    const double phi = kPi * k / rings;
    return centre + Vec3(Vec3d(outer * std::sin(theta) * std::cos(phi), outer * std::cos(theta),
                               outer * std::sin(theta) * std::sin(phi)));
  };
  const auto add = [&](Vec3 a, Vec3 b, Vec3 c) {
    is_inward ? add_triangle(scene, a, c, b, material) : add_triangle(scene, a, b, c, material);
  };
  for (int ring = 0; ring < rings; ++ring) {
    for (int k = 0; k < 2 * rings; ++k) {
      if (ring > 0) add(point(ring, k), point(ring, k + 1), point(ring + 1, k));
      if (ring < rings - 1) add(point(ring, k + 1), point(ring + 1, k + 1), point(ring + 1, k));
    }
  }
}

/// A cube [0, size]^3 whose faces look inwards.
inline void add_room(scene::Scene& scene, float size, std::uint32_t material) {
  const Vec3 x(size, 0, 0);
  const Vec3 y(0, size, 0);
  const Vec3 z(0, 0, size);
  const Vec3 o(0.0F);
  add_quad(scene, o, z, x, material);  // floor, up
  add_quad(scene, y, x, z, material);  // ceiling, down
  add_quad(scene, o, x, y, material);  // z = 0, +z
  add_quad(scene, z, y, x, material);  // z = size, -z
  add_quad(scene, o, y, z, material);  // x = 0, +x
  add_quad(scene, x, z, y, material);  // x = size, -x
}

/// Something far below to trace against, when only the sky matters.
inline scene::Scene nothing_in_the_way() {
  scene::Scene scene;
  add_triangle(scene, {0, -2e6F, 0}, {0, -2e6F, 1}, {1, -2e6F, 0}, add_material(scene, Rgb(0.0F)));
  return scene;
}

inline light::Environment white_sky(float radiance = 1.0F) {
  light::Environment environment;
  environment.name = "white";
  environment.sky = light::ConstantSky{Rgb(radiance)};
  return environment;
}

inline light::Environment no_sky() {
  return white_sky(0.0F);
}

inline light::Environment analytic_sky(std::function<double(const Vec3d&)> radiance) {
  light::Environment environment;
  environment.name = "analytic";
  environment.sky = light::AnalyticSky{[radiance = std::move(radiance)](const Vec3& d) {
    return Rgb(static_cast<float>(radiance(Vec3d(d))));
  }};
  return environment;
}

}  // namespace plumbline::test
