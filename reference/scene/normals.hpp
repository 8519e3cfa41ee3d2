// reference/scene/normals.hpp: normals for meshes that come without. CONVENTIONS.md#surfaces.
#pragma once

#include <cstdint>
#include <vector>

#include "reference/scene/scene.hpp"

namespace plumbline::scene {

/// Gives each vertex without a normal one, by the crease rule: the triangles around a point are grouped over
/// shared edges at which their normals differ by at most the crease angle, and each group has one normal, the
/// sum of its triangles' normals weighted by their angles at the point. Two points are the same when their
/// coordinates are equal, so seams of texture coordinates do not show. A vertex that belongs to several
/// groups keeps its index for the first of them (in the order of triangles); a copy for each further group is
/// appended.
/// @param has_normal  one per vertex: 0 where `normals` is to be computed. Only triangle corners at such
///                    vertices take part.
/// @param crease_deg  0..180. At 0 triangles still share a normal when they are coplanar to 0.01 degrees:
/// float
///                    coordinates are no better. An edge of more than 16 triangles is always sharp.
/// @param scene       positions, triangles and normals (any values where missing); no degenerate triangles
/// @throws InputError when crease_deg is outside its range
[[nodiscard]] Scene with_computed_normals(Scene scene, const std::vector<std::uint8_t>& has_normal,
                                          float crease_deg);

}  // namespace plumbline::scene
