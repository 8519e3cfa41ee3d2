// reference/light/environment_sampler.hpp: directions drawn in proportion to an environment's radiance.
#pragma once

#include <optional>
#include <vector>

#include "reference/light/environment.hpp"

namespace plumbline::light {

struct DirectionSample {
  Vec3 direction{0.0F};  // unit
  double pdf = 0.0;      // per solid angle [sr^-1], > 0
  Rgb radiance{0.0F};    // from that direction
};

/// Draws directions with a density that is positive wherever the radiance is not zero, and proportional to
/// its magnitude (largest of |r|, |g|, |b|) up to the resolution of the tables. Lat-long images: exactly per
/// texel. Everything else: a table over lat-long cells filled from the largest of several lookups in each
/// cell, mixed with a small uniform part. Suns: their own cones. Keeps a copy of nothing: the environment
/// must outlive it.
class EnvironmentSampler {
 public:
  explicit EnvironmentSampler(const Environment& environment);

  /// None when the environment is black. u in [0, 1)^2.
  [[nodiscard]] std::optional<DirectionSample> sample(Vec2 u) const;
  /// Density with which sample() gives this direction; 0 for a black environment.
  [[nodiscard]] double pdf(const Vec3& direction) const;
  [[nodiscard]] bool is_black() const { return is_black_; }

 private:
  const Environment* environment_;
  bool is_black_ = true;
};

}  // namespace plumbline::light
