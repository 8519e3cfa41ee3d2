// reference/integrate/path.hpp: the estimator: one random path, its light split by the number of bounces.
#pragma once

#include <limits>
#include <vector>

#include "reference/integrate/sampler.hpp"
#include "reference/integrate/world.hpp"
#include "reference/trace/surface_point.hpp"

namespace plumbline::integrate {

/// Indirect bounces without a limit: Russian roulette ends the paths.
inline constexpr int kAllBounces = std::numeric_limits<int>::max();

/// Light of one path by bounce: terms[k] has bounced k times before it arrives (0 = straight from a light).
/// Grows as needed.
using BounceTerms = std::vector<RgbD>;

/// Adds to `terms` an unbiased estimate of the irradiance [W m^-2] at a point: sum over k <= max_bounces.
///
/// E = integral L_i(w) max(0, n.w) V dw. At each vertex of the path light is sampled twice: by drawing from
/// the lights (environment, emissive triangles, one light without extent), and by following a
/// cosine-distributed direction, which also goes on to the next vertex. The two estimates are combined by the
/// power heuristic (Veach & Guibas 1995, beta = 2). Light leaving a Lambertian surface is albedo E / pi, so
/// the throughput from irradiance to irradiance is the product of the albedos passed.
void add_irradiance(const World& world, const trace::SurfacePoint& point, int max_bounces, Sampler& sampler,
                    BounceTerms& terms);

/// What a camera ray meets.
struct CameraSample {
  Rgb emission{0.0F};  // light seen directly: an emitter or the environment
  Rgb albedo{0.0F};
  bool is_hit = false;
  trace::SurfacePoint point;  // valid when is_hit
  float distance = 0.0F;
};

/// Radiance along a camera ray: emission + sum of `terms` (cleared first; radiance, not irradiance: albedo /
/// pi is applied).
[[nodiscard]] CameraSample sample_radiance(const World& world, const trace::Ray& ray, int max_bounces,
                                           Sampler& sampler, BounceTerms& terms);

}  // namespace plumbline::integrate
