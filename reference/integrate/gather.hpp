// reference/integrate/gather.hpp: path-traced irradiance at points.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "reference/integrate/film.hpp"
#include "reference/integrate/render.hpp"
#include "reference/trace/surface_point.hpp"

namespace plumbline::integrate {

struct GatherSettings {
  int samples = 1024;  // of a run without target_error
  int max_bounces = kAllBounces;
  std::uint64_t seed = 0;
  int threads = 0;
  Progress progress;
  /// Relative: root of the mean squared standard error of all points over their mean irradiance. Only the
  /// functions that take many points read it.
  std::optional<double> target_error = {};
};

/// Irradiance [W m^-2] at a point, the sum over bounces, with its standard error.
[[nodiscard]] RgbEstimate gather_irradiance(const World& world, const trace::SurfacePoint& point,
                                            std::uint64_t stream, const GatherSettings& settings);

/// The same for many points; the i-th uses stream i. With target_error in rounds of growing size, 256 samples
/// a point at first; how many there are in the end depends on nothing but the arguments.
/// @throws InputError when settings are out of range, or when the mean is so small or so negative after 2^16
/// samples a point that an error relative to it means nothing.
[[nodiscard]] std::vector<RgbEstimate> gather_irradiance(const World& world,
                                                         std::span<const trace::SurfacePoint> points,
                                                         const GatherSettings& settings);

/// Per bounce: element k is the irradiance from light that bounced k times, k = 0 … bounces.
[[nodiscard]] std::vector<RgbEstimate> gather_bounces(const World& world, const trace::SurfacePoint& point,
                                                      std::uint64_t stream, const GatherSettings& settings);

/// Irradiance and its parts by number of bounces.
struct BouncesEstimate {
  RgbEstimate irradiance;            // exactly what gather_irradiance gives
  std::vector<RgbEstimate> bounces;  // k = 0 … bounces; their means add up to that of the irradiance
};
/// The same for many points, as gather_irradiance for many points does it.
/// @throws InputError as there, and without a limit to the bounces.
[[nodiscard]] std::vector<BouncesEstimate> gather_bounces(const World& world,
                                                          std::span<const trace::SurfacePoint> points,
                                                          const GatherSettings& settings);

}  // namespace plumbline::integrate
