#include <algorithm>
#include <cmath>

#include "validation/checks/truths_scenes.hpp"

namespace plumbline::checks {

void add_sphere(scene::Scene& scene, const Vec3d& centre, double radius, Front front, std::uint32_t material,
                const Kept& kept) {
  constexpr int kRings = 96;
  const Vec3d w = glm::normalize(kept.axis);
  const Vec3d u = glm::normalize(glm::cross(std::abs(w.y) < 0.9 ? Vec3d(0, 1, 0) : Vec3d(1, 0, 0), w));
  const Vec3d v = glm::cross(w, u);
  const double last = std::acos(std::clamp(kept.min_cosine, -1.0, 1.0));
  const double h = kPi / (2.0 * kRings);
  const auto point = [&](int ring, int k) {
    const double theta = last * ring / kRings;
    const double phi = kPi * k / kRings;
    return centre + radius * (1.0 + 0.5 * h * h) *
                        (w * std::cos(theta) + std::sin(theta) * (u * std::cos(phi) + v * std::sin(phi)));
  };
  const auto add = [&](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    front == Front::inward ? add_triangle(scene, a, c, b, material) : add_triangle(scene, a, b, c, material);
  };
  for (int ring = 0; ring < kRings; ++ring) {
    for (int k = 0; k < 2 * kRings; ++k) {
      if (ring > 0) add(point(ring, k), point(ring + 1, k), point(ring, k + 1));
      if (ring < kRings - 1 || kept.min_cosine > -1.0)
        add(point(ring, k + 1), point(ring + 1, k), point(ring + 1, k + 1));
    }
  }
}

void add_disc(scene::Scene& scene, const Vec3d& centre, const Vec3d& normal, double radius,
              std::uint32_t material) {
  constexpr int kSides = 1024;
  const Vec3d w = glm::normalize(normal);
  const Vec3d u = glm::normalize(glm::cross(std::abs(w.y) < 0.9 ? Vec3d(0, 1, 0) : Vec3d(1, 0, 0), w));
  const Vec3d v = glm::cross(w, u);
  const auto rim = [&](int k) {
    const double a = 2.0 * kPi * k / kSides;
    return centre + radius * (u * std::cos(a) + v * std::sin(a));
  };
  for (int k = 0; k < kSides; ++k) add_triangle(scene, centre, rim(k), rim(k + 1), material);
}

}  // namespace plumbline::checks
