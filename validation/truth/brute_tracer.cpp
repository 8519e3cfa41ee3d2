#include "validation/truth/brute_tracer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "validation/truth/require.hpp"

namespace plumbline::truth {
namespace {

constexpr const char* kName = "brute_force_irradiance";
constexpr std::size_t kNoTriangle = std::numeric_limits<std::size_t>::max();

struct Triangle {
  Vec3d corner;
  Vec3d edge1;
  Vec3d edge2;
};

struct Crossing {
  std::size_t triangle = kNoTriangle;
  double distance = std::numeric_limits<double>::infinity();
  Vec3d weights{0.0};  // barycentric, of the three corners
};

/// Where a path stands, seen from the side it came from.
struct Vertex {
  Vec3d position;
  Vec3d geometric_normal;
  Vec3d shading_normal;
  std::size_t triangle = kNoTriangle;
};

struct Tracer {
  const scene::Scene& scene;
  const light::Environment& environment;
  std::vector<Triangle> triangles;
  double shortest = 0.0;  // what is nearer is the surface just left, or its coplanar neighbour
};

Tracer make_tracer(const scene::Scene& scene, const light::Environment& environment) {
  Tracer tracer{scene, environment, {}, 0.0};
  Vec3d low(std::numeric_limits<double>::infinity());
  Vec3d high = -low;
  for (const glm::uvec3& c : scene.triangles) {
    const Vec3d corner(scene.positions[c.x]);
    tracer.triangles.push_back(
        {corner, Vec3d(scene.positions[c.y]) - corner, Vec3d(scene.positions[c.z]) - corner});
    for (const std::uint32_t v : {c.x, c.y, c.z}) {
      low = glm::min(low, Vec3d(scene.positions[v]));
      high = glm::max(high, Vec3d(scene.positions[v]));
    }
  }
  tracer.shortest = 1e-9 * glm::length(high - low);
  return tracer;
}

double uniform(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11U) * 0x1p-53;  // the 53 bits a double holds
}

// Uniform on the sphere (Archimedes: height and azimuth are uniform), then turned to the normal's side.
Vec3d uniform_hemisphere(const Vec3d& normal, std::mt19937_64& random) {
  const double height = 2.0 * uniform(random) - 1.0;
  const double azimuth = 2.0 * kPi * uniform(random);
  const double radius = std::sqrt(1.0 - height * height);
  const Vec3d direction(radius * std::cos(azimuth), radius * std::sin(azimuth), height);
  return glm::dot(direction, normal) < 0.0 ? -direction : direction;
}

// origin + t direction = corner + b1 edge1 + b2 edge2, by Cramer's rule (Moller & Trumbore, "Fast, Minimum
// Storage Ray/Triangle Intersection", 1997); front and back alike.
std::optional<Crossing> cross(const Triangle& triangle, const Vec3d& origin, const Vec3d& direction) {
  const Vec3d p = glm::cross(direction, triangle.edge2);
  const double determinant = glm::dot(triangle.edge1, p);
  if (determinant == 0.0) return std::nullopt;
  const double inverse = 1.0 / determinant;
  const Vec3d offset = origin - triangle.corner;
  const double b1 = glm::dot(offset, p) * inverse;
  if (b1 < 0.0 || b1 > 1.0) return std::nullopt;
  const Vec3d q = glm::cross(offset, triangle.edge1);
  const double b2 = glm::dot(direction, q) * inverse;
  if (b2 < 0.0 || b1 + b2 > 1.0) return std::nullopt;
  return Crossing{kNoTriangle, glm::dot(triangle.edge2, q) * inverse, Vec3d(1.0 - b1 - b2, b1, b2)};
}

std::optional<Crossing> nearest_crossing(const Tracer& tracer, const Vertex& from, const Vec3d& direction) {
  Crossing nearest;
  for (std::size_t t = 0; t < tracer.triangles.size(); ++t) {
    if (t == from.triangle) continue;
    const std::optional<Crossing> found = cross(tracer.triangles[t], from.position, direction);
    if (!found || !(found->distance > tracer.shortest) || !(found->distance < nearest.distance)) continue;
    nearest = *found;
    nearest.triangle = t;
  }
  if (nearest.triangle == kNoTriangle) return std::nullopt;
  return nearest;
}

template <class Values>
Vec3d interpolated(const Values& values, const glm::uvec3& corners, const Vec3d& weights) {
  return weights.x * Vec3d(values[corners.x]) + weights.y * Vec3d(values[corners.y]) +
         weights.z * Vec3d(values[corners.z]);
}

RgbD albedo(const scene::Scene& scene, const scene::Material& material, const Crossing& crossing) {
  if (material.albedo_texture >= 0) {
    return RgbD(scene::albedo_at(scene, static_cast<std::uint32_t>(crossing.triangle),
                                 Vec2(crossing.weights.y, crossing.weights.z)));
  }
  const RgbD factor(material.albedo);
  if (scene.vertex_colors.empty()) return factor;
  return factor * interpolated(scene.vertex_colors, scene.triangles[crossing.triangle], crossing.weights);
}

Vertex vertex_at(const Tracer& tracer, const Crossing& crossing, bool is_front) {
  const Triangle& triangle = tracer.triangles[crossing.triangle];
  const glm::uvec3 corners = tracer.scene.triangles[crossing.triangle];
  const double side = is_front ? 1.0 : -1.0;
  const Vec3d normal = glm::normalize(glm::cross(triangle.edge1, triangle.edge2));
  const Vec3d smooth = interpolated(tracer.scene.normals, corners, crossing.weights);
  const double length = glm::length(smooth);
  return {interpolated(tracer.scene.positions, corners, crossing.weights), side * normal,
          side * (length > 1e-6 ? smooth / length : normal), crossing.triangle};
}

// E = int L_i max(0, n.w) dw, with w uniform over the hemisphere: 2 pi cos L_i. Where w meets a surface,
// L_i = emission + albedo E' / pi, so the factor from E' to E is 2 cos albedo. A path whose throughput has
// sunk below 1 goes on with that probability, by which it is then divided.
RgbD path_irradiance(const Tracer& tracer, Vertex at, int max_bounces, std::mt19937_64& random) {
  RgbD sum(0.0);
  RgbD throughput(1.0);
  for (int bounce = 0;; ++bounce) {
    const Vec3d direction = uniform_hemisphere(at.shading_normal, random);
    if (!(glm::dot(direction, at.geometric_normal) > 0.0)) return sum;  // the surface itself is in the way
    throughput *= 2.0 * glm::dot(direction, at.shading_normal);
    const std::optional<Crossing> met = nearest_crossing(tracer, at, direction);
    if (!met) return sum + throughput * kPi * RgbD(light::radiance(tracer.environment, Vec3(direction)));

    const Triangle& triangle = tracer.triangles[met->triangle];
    const bool is_front = glm::dot(glm::cross(triangle.edge1, triangle.edge2), direction) <= 0.0;
    const scene::Material& material = tracer.scene.materials[tracer.scene.triangle_materials[met->triangle]];
    if (!is_front && !material.is_double_sided) return sum;  // a dark back
    sum += throughput * kPi * RgbD(material.emission);
    if (bounce == max_bounces) return sum;
    throughput *= albedo(tracer.scene, material, *met);
    const double survival = std::min(1.0, std::max({throughput.x, throughput.y, throughput.z}));
    if (!(uniform(random) < survival)) return sum;
    throughput /= survival;
    at = vertex_at(tracer, *met, is_front);
  }
}

}  // namespace

std::array<metrics::Estimate, 3> brute_force_irradiance(const scene::Scene& scene,
                                                        const light::Environment& environment,
                                                        const Vec3d& position, const Vec3d& normal,
                                                        const BruteForceSettings& settings) {
  constexpr int kMostBounces = 1000;
  scene::validate(scene, kName);
  scene::refuse_primitives(scene, kName);
  require(scene.lights.empty(), kName, "a scene without punctual lights",
          static_cast<double>(scene.lights.size()));
  require(settings.samples >= 2, kName, "samples >= 2", settings.samples);
  require(settings.max_bounces >= 0 && settings.max_bounces <= kMostBounces, kName,
          "0 <= max_bounces <= 1000", settings.max_bounces);
  require(std::abs(glm::length(normal) - 1.0) <= 1e-6, kName, "a normal of length 1", glm::length(normal));
  const Tracer tracer = make_tracer(scene, environment);
  const Vertex start{position, normal, normal, kNoTriangle};
  std::mt19937_64 random(settings.seed);
  std::array<metrics::RunningMoments, 3> channels;
  for (int s = 0; s < settings.samples; ++s) {
    const RgbD irradiance = path_irradiance(tracer, start, settings.max_bounces, random);
    for (int c = 0; c < 3; ++c) channels[static_cast<std::size_t>(c)].add(irradiance[c]);
  }
  return {channels[0].estimate(), channels[1].estimate(), channels[2].estimate()};
}

}  // namespace plumbline::truth
