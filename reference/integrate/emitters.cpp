#include "reference/integrate/emitters.hpp"

#include <algorithm>
#include <cmath>

namespace plumbline::integrate {
namespace {

double area(const scene::Scene& scene, std::uint32_t triangle) {
  const glm::uvec3 c = scene.triangles[triangle];
  const Vec3d origin(scene.positions[c.x]);
  return 0.5 *
         glm::length(glm::cross(Vec3d(scene.positions[c.y]) - origin, Vec3d(scene.positions[c.z]) - origin));
}

}  // namespace

EmitterTable::EmitterTable(const scene::Scene& scene) : scene_(&scene) {
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const double brightness = max_component(scene.materials[scene.triangle_materials[t]].emission);
    const double weight = area(scene, t) * brightness;
    if (!(weight > 0.0)) continue;
    if (density_.empty()) density_.resize(scene.triangles.size(), 0.0);
    total_ += weight;
    triangles_.push_back(t);
    cumulative_.push_back(total_);
    density_[t] = brightness;
  }
  for (double& density : density_) density /= total_;
}

// Area density -> solid angle density: p_w = p_A d^2 / cos.
double EmitterTable::pdf(std::uint32_t triangle, float distance, float cos_emitter) const {
  if (triangle >= density_.size() || !(cos_emitter > 0.0F)) return 0.0;
  return density_[triangle] * static_cast<double>(distance) * static_cast<double>(distance) /
         static_cast<double>(cos_emitter);
}

std::optional<EmitterSample> EmitterTable::sample(const Vec3& receiver, float pick, const Vec2& u) const {
  const double target = static_cast<double>(pick) * total_;
  const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), target);
  const auto slot = static_cast<std::size_t>(std::min<std::ptrdiff_t>(
      found - cumulative_.begin(), static_cast<std::ptrdiff_t>(cumulative_.size()) - 1));
  const std::uint32_t triangle = triangles_[slot];
  // Uniform on the triangle: fold the unit square along its diagonal by the square root (Turk 1990).
  const float root = std::sqrt(u.x);
  const trace::Hit on_triangle{triangle, Vec2(root * (1.0F - u.y), root * u.y), 0.0F};
  const scene::Material& material = scene_->materials[scene_->triangle_materials[triangle]];
  // The viewing direction only decides the side; any point of the triangle gives the same one.
  const Vec3 towards = scene_->positions[scene_->triangles[triangle].x] - receiver;
  const trace::SurfaceHit seen = trace::surface_hit(*scene_, on_triangle, towards);
  if (!seen.is_front && !material.is_double_sided) return std::nullopt;
  const Vec3 offset = seen.point.position - receiver;
  const float distance = glm::length(offset);
  if (!(distance > 0.0F)) return std::nullopt;
  const Vec3 direction = offset / distance;
  const float cos_emitter = -glm::dot(direction, seen.point.geometric_normal);
  if (!(cos_emitter > 0.0F)) return std::nullopt;
  return EmitterSample{direction, seen.point, pdf(triangle, distance, cos_emitter), material.emission};
}

}  // namespace plumbline::integrate
