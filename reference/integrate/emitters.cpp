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
    const scene::Material& material = scene.materials[scene.triangle_materials[t]];
    const double brightness = max_component(material.emission);
    const double weight = area(scene, t) * brightness;
    if (!(weight > 0.0)) continue;
    if (density_.empty()) density_.resize(scene.triangles.size(), 0.0);
    total_ += weight;
    cumulative_.push_back(total_);
    density_[t] = brightness;
    const glm::uvec3 c = scene.triangles[t];
    emitters_.push_back({{scene.positions[c.x], scene.positions[c.y], scene.positions[c.z]},
                         scene::geometric_normal(scene, t),
                         material.emission,
                         material.is_double_sided,
                         brightness});
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
  for (Emitter& emitter : emitters_) emitter.density /= total_;
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
  if (slot >= emitters_.size()) {
    const std::uint32_t surface = surfaces_[slot - emitters_.size()];
    std::optional<EmitterSample> sample = sample_primitive(*scene_, surface, receiver, u);
    if (sample) sample->pdf *= primitives_[surface - scene_->triangles.size()];
    return sample;
  }
  const Emitter& emitter = emitters_[slot];
  // Uniform on the triangle: fold the unit square along its diagonal by the square root (Turk 1990).
  const float root = std::sqrt(u.x);
  const Vec3 weights(1.0F - root, root * (1.0F - u.y), root * u.y);
  trace::SurfacePoint on_emitter = trace::point_on_plane(emitter.corners, weights, emitter.normal);
  const Vec3 offset = on_emitter.position - receiver;
  const float distance = glm::length(offset);
  if (!(distance > 0.0F)) return std::nullopt;
  const Vec3 direction = offset / distance;
  float cos_emitter = -glm::dot(direction, emitter.normal);
  if (cos_emitter < 0.0F && emitter.is_double_sided) {
    cos_emitter = -cos_emitter;
    on_emitter.geometric_normal = on_emitter.shading_normal = -emitter.normal;
  }
  if (!(cos_emitter > 0.0F)) return std::nullopt;
  const double distance_squared = static_cast<double>(distance) * static_cast<double>(distance);
  return EmitterSample{direction, on_emitter,
                       emitter.density * distance_squared / static_cast<double>(cos_emitter),
                       emitter.radiance};
}

}  // namespace plumbline::integrate
