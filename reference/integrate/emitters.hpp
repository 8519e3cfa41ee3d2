// reference/integrate/emitters.hpp: the emissive surfaces of a scene, to be sampled by area and brightness.
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

/// A surface is drawn in proportion to area x largest emission component, a point on a triangle uniformly, on a
/// sphere or disc as sample_primitive() does it.
class EmitterTable {
 public:
  explicit EmitterTable(const scene::Scene& scene);

  [[nodiscard]] bool is_empty() const { return cumulative_.empty(); }

  /// None when the point drawn shows its dark back or is seen edge-on. `pick` in [0, 1), u in [0, 1)^2.
  [[nodiscard]] std::optional<EmitterSample> sample(const Vec3& receiver, float pick, const Vec2& u) const;

  /// Density per solid angle of drawing, from a receiver `distance` away, the point of `triangle` that is
  /// seen under |cos| = cos_emitter from its normal; 0 for a triangle that does not emit.
  [[nodiscard]] double pdf(std::uint32_t triangle, float distance, float cos_emitter) const;

  /// The same for a sphere or disc, of which `point` is seen along `direction` from `distance` away.
  [[nodiscard]] double primitive_pdf(std::uint32_t surface, const trace::SurfacePoint& point, float distance,
                                     const Vec3& direction) const;

 private:
  /// One emissive triangle, ready to be sampled.
  struct Emitter {
    Vec3 corners[3];
    Vec3 normal{0.0F};  // geometric, unit
    Rgb radiance{0.0F};
    bool is_double_sided = false;
    double density = 0.0;  // per area
  };
  std::vector<Emitter> emitters_;
  const scene::Scene* scene_;
  std::vector<std::uint32_t>
      surfaces_;                    // of the emissive primitives, which follow the triangles in cumulative_
  std::vector<double> cumulative_;  // of area x brightness, ends at total_
  std::vector<double> density_;     // per area, one per triangle of the scene; empty when nothing emits
  std::vector<double> primitives_;  // probability of each sphere and disc to be drawn; empty when none emits
  double total_ = 0.0;
};

}  // namespace plumbline::integrate
