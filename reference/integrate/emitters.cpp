#include "reference/integrate/emitters.hpp"

#include <algorithm>
#include <cmath>

#include "reference/integrate/emissive_primitives.hpp"

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
    surfaces_.push_back(t);
    cumulative_.push_back(total_);
    density_[t] = brightness;
  }
  const auto triangles = static_cast<std::uint32_t>(scene.triangles.size());
  for (std::uint32_t i = 0; i < scene::primitive_count(scene); ++i) {
    const double weight = primitive_weight(scene, triangles + i);
    if (!(weight > 0.0)) continue;
    if (primitives_.empty()) primitives_.resize(scene::primitive_count(scene), 0.0);
    total_ += weight;
    surfaces_.push_back(triangles + i);
    cumulative_.push_back(total_);
    primitives_[i] = weight;
  }
  for (double& density : density_) density /= total_;
  for (double& probability : primitives_) probability /= total_;
}

// Area density -> solid angle density: p_w = p_A d^2 / cos.
double EmitterTable::pdf(std::uint32_t triangle, float distance, float cos_emitter) const {
  if (density_.empty() || !(cos_emitter > 0.0F)) return 0.0;
  return density_[triangle] * static_cast<double>(distance) * static_cast<double>(distance) /
         static_cast<double>(cos_emitter);
}

double EmitterTable::primitive_pdf(std::uint32_t surface, const trace::SurfacePoint& point, float distance,
                                   const Vec3& direction) const {
  if (primitives_.empty()) return 0.0;
  const double probability = primitives_[surface - scene_->triangles.size()];
  return probability * integrate::primitive_pdf(*scene_, surface, point, distance, direction);
}

std::optional<EmitterSample> EmitterTable::sample(const Vec3& receiver, float pick, const Vec2& u) const {
  const double target = static_cast<double>(pick) * total_;
  const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), target);
  const auto slot = static_cast<std::size_t>(std::min<std::ptrdiff_t>(
      found - cumulative_.begin(), static_cast<std::ptrdiff_t>(cumulative_.size()) - 1));
  const std::uint32_t triangle = surfaces_[slot];
  if (triangle >= scene_->triangles.size()) {
    std::optional<EmitterSample> sample = sample_primitive(*scene_, triangle, receiver, u);
    if (sample) sample->pdf *= primitives_[triangle - scene_->triangles.size()];
    return sample;
  }
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
