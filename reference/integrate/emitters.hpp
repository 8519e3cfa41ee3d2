// reference/integrate/emitters.hpp: the emissive surfaces of a scene, to be sampled as a receiver sees them.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "reference/integrate/emissive_triangle.hpp"
#include "reference/integrate/emitter_sample.hpp"
#include "reference/integrate/light_tree.hpp"
#include "reference/scene/scene.hpp"

namespace plumbline::integrate {

/// A surface is drawn by a light tree, a point on a triangle as sample_triangle() does it, on a sphere or disc as
/// sample_primitive() does it.
class EmitterTable {
 public:
  explicit EmitterTable(const scene::Scene& scene);

  [[nodiscard]] bool is_empty() const { return surfaces_.empty(); }

  /// None when the point drawn shows its dark back or is seen edge-on, and where no emitter can be seen. `pick` in
  /// [0, 1)^2 chooses the emitter: the second number refines the 24 bits of the first, that thousands of emitters be told
  /// apart; u in [0, 1)^2 the point.
  [[nodiscard]] std::optional<EmitterSample> sample(const Receiver& receiver, const Vec2& pick,
                                                    const Vec2& u) const;

  /// Density per solid angle [sr^-1] with which sample() draws what a ray from the receiver along `direction` has met:
  /// `point` of `surface`, turned to the receiver, `distance` away; 0 for a surface that does not emit.
  [[nodiscard]] double pdf(const Receiver& receiver, std::uint32_t surface, const trace::SurfacePoint& point,
                           float distance, const Vec3& direction) const;

 private:
  const scene::Scene* scene_;
  std::vector<EmissiveTriangle> triangles_;  // the first emitters
  std::vector<std::uint32_t> surfaces_;      // of all emitters
  std::vector<std::uint32_t> emitters_;      // of all surfaces; empty when nothing emits
  LightTree tree_;
};

}  // namespace plumbline::integrate
