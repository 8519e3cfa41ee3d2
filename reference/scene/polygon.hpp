// reference/scene/polygon.hpp: polygons to triangles.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "reference/base/vector.hpp"

namespace plumbline::scene {

/// A non-convex polygon may have at most this many corners (the time grows with up to their cube).
inline constexpr std::size_t kMostConcaveCorners = 1024;

/// Triangles (indices into `corners`) of a simple polygon, same winding: the fan around the first corner
/// where that is right (always for convex polygons), else by cutting off ears. Where the polygon crosses
/// itself the remainder becomes a fan.
/// @throws InputError for a polygon of more than kMostConcaveCorners corners that is not convex
[[nodiscard]] std::vector<glm::uvec3> triangulate(std::span<const Vec3> corners);

}  // namespace plumbline::scene
