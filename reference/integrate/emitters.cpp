#include "reference/integrate/emitters.hpp"

#include <limits>

#include "reference/integrate/emissive_primitives.hpp"

namespace plumbline::integrate {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

}  // namespace

EmitterTable::EmitterTable(const scene::Scene& scene) : scene_(&scene) {
  std::vector<LightBounds> lights;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    if (is_black(scene::material_of(scene, t).emission)) continue;
    const EmissiveTriangle triangle = make_emissive_triangle(scene, t);
    const LightBounds bounds = light_bounds(triangle);
    if (!(bounds.strength > 0.0)) continue;
    triangles_.push_back(triangle);
    lights.push_back(bounds);
    surfaces_.push_back(t);
  }
  const auto count = static_cast<std::uint32_t>(scene.triangles.size() + scene::primitive_count(scene));
  for (auto surface = static_cast<std::uint32_t>(scene.triangles.size()); surface < count; ++surface) {
    const LightBounds bounds = primitive_bounds(scene, surface);
    if (!(bounds.strength > 0.0)) continue;
    lights.push_back(bounds);
    surfaces_.push_back(surface);
  }
  tree_ = LightTree(lights);
  if (surfaces_.empty()) return;
  emitters_.resize(count, kNone);
  for (std::uint32_t i = 0; i < surfaces_.size(); ++i) emitters_[surfaces_[i]] = i;
}

std::optional<EmitterSample> EmitterTable::sample(const Receiver& receiver, const Vec2& pick,
                                                  const Vec2& u) const {
  constexpr double kGrain = 0x1p-24;  // of the sampler's numbers
  const double target = static_cast<double>(pick.x) + kGrain * static_cast<double>(pick.y);
  const std::optional<LightChoice> choice = tree_.sample(receiver, target);
  if (!choice) return std::nullopt;
  std::optional<EmitterSample> sample =
      choice->light < triangles_.size()
          ? sample_triangle(triangles_[choice->light], receiver.position, u)
          : sample_primitive(*scene_, surfaces_[choice->light], receiver.position, u);
  if (sample) sample->pdf *= choice->probability;
  return sample;
}

double EmitterTable::pdf(const Receiver& receiver, std::uint32_t surface, const trace::SurfacePoint& point,
                         float distance, const Vec3& direction) const {
  if (emitters_.empty() || emitters_[surface] == kNone) return 0.0;
  const std::uint32_t emitter = emitters_[surface];
  const double density =
      emitter < triangles_.size()
          ? triangle_pdf(triangles_[emitter], receiver.position, static_cast<double>(distance),
                         static_cast<double>(-glm::dot(point.geometric_normal, direction)))
          : primitive_pdf(*scene_, surface, point, distance, direction);
  return density * tree_.probability(receiver, emitter);
}

}  // namespace plumbline::integrate
