// reference/integrate/probe.hpp: path-traced light probes: the radiance arriving at a point from all sides.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "reference/integrate/gather.hpp"

namespace plumbline::integrate {

/// Functions y_i on the sphere to expand in.
struct SphereFunctions {
  std::size_t count = 0;
  /// Writes `count` values at a unit direction; called from many threads.
  std::function<void(const Vec3d& direction, std::span<double> values)> evaluate;
};

/// Coefficients c_i = integral over the whole sphere of L_i(w) y_i(w) dw of the radiance L_i arriving at a
/// point, `count` of them, each with its standard error (those of one probe come from the same paths and are
/// correlated).
///
/// L_i is everything that arrives: sky, suns and emitters seen directly (bounce 0), lights without extent (a
/// pulse of their irradiance from their direction), and what surfaces reflect (bounces 1 and more: bounce k
/// met k surfaces, as in gather_irradiance, so that y = max(0, n.w) gives that very irradiance).
/// A free point's normal plays no part; at a vertex, rays leave the surface on their own side.
/// @throws InputError for samples below 1, bounces below 0, a target_error (probes have none), or a light
/// without extent exactly at the point.
[[nodiscard]] std::vector<RgbEstimate> gather_probe(const World& world, const trace::SurfacePoint& point,
                                                    const SphereFunctions& functions, std::uint64_t stream,
                                                    const GatherSettings& settings);

/// The same for many points; the i-th uses stream i.
[[nodiscard]] std::vector<std::vector<RgbEstimate>> gather_probes(const World& world,
                                                                  std::span<const trace::SurfacePoint> points,
                                                                  const SphereFunctions& functions,
                                                                  const GatherSettings& settings);

}  // namespace plumbline::integrate
