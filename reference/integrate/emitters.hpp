// reference/integrate/emitters.hpp: the emissive triangles of a scene, to be sampled by area and brightness.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "reference/scene/scene.hpp"
#include "reference/trace/surface_point.hpp"

namespace plumbline::integrate {

struct EmitterSample {
  Vec3 direction{0.0F};            // unit, from the receiver
  trace::SurfacePoint on_emitter;  // seen from the receiver's side
  double pdf = 0.0;                // per solid angle at the receiver [sr^-1]
  Rgb radiance{0.0F};
};

/// A triangle is drawn in proportion to area x largest emission component, a point on it uniformly.
class EmitterTable {
 public:
  explicit EmitterTable(const scene::Scene& scene);

  [[nodiscard]] bool is_empty() const { return cumulative_.empty(); }

  /// None when the point drawn shows its dark back or is seen edge-on. `pick` in [0, 1), u in [0, 1)^2.
  [[nodiscard]] std::optional<EmitterSample> sample(const Vec3& receiver, float pick, const Vec2& u) const;

  /// Density per solid angle of drawing, from a receiver `distance` away, the point of `triangle` that is
  /// seen under |cos| = cos_emitter from its normal; 0 for a triangle that does not emit,
  /// and for spheres and discs: they are met, not drawn.
  [[nodiscard]] double pdf(std::uint32_t triangle, float distance, float cos_emitter) const;

 private:
  const scene::Scene* scene_;
  std::vector<std::uint32_t> triangles_;
  std::vector<double> cumulative_;  // of area x brightness, ends at total_
  std::vector<double> density_;     // per area, one per triangle of the scene; empty when nothing emits
  double total_ = 0.0;
};

}  // namespace plumbline::integrate
