// reference/integrate/gather.hpp: path-traced irradiance at points.
#pragma once

#include <span>
#include <vector>

#include "reference/integrate/film.hpp"
#include "reference/integrate/render.hpp"
#include "reference/trace/surface_point.hpp"

namespace plumbline::integrate {

struct GatherSettings {
  int samples = 1024;
  int max_bounces = kAllBounces;
  std::uint64_t seed = 0;
  int threads = 0;
  Progress progress;
};

/// Irradiance [W m^-2] at a point, the sum over bounces, with its standard error.
[[nodiscard]] RgbEstimate gather_irradiance(const World& world, const trace::SurfacePoint& point,
                                            std::uint64_t stream, const GatherSettings& settings);

/// The same for many points; the i-th uses stream i.
[[nodiscard]] std::vector<RgbEstimate> gather_irradiance(const World& world,
                                                         std::span<const trace::SurfacePoint> points,
                                                         const GatherSettings& settings);

/// Per bounce: element k is the irradiance from light that bounced k times, k = 0 … bounces.
[[nodiscard]] std::vector<RgbEstimate> gather_bounces(const World& world, const trace::SurfacePoint& point,
                                                      std::uint64_t stream, const GatherSettings& settings);

}  // namespace plumbline::integrate
