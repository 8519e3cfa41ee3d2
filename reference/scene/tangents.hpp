// reference/scene/tangents.hpp: tangents for normal-mapped meshes that come without.
#pragma once

#include "reference/scene/scene.hpp"

namespace plumbline::scene {

/// Gives each vertex of a normal-mapped triangle that has no tangent one, after the rule of Mikkelsen's MikkTSpace ("Simulation of
/// Wrinkled Surfaces Revisited", 2008), which glTF asks for: each triangle's direction of growing u, projected into the plane of the
/// vertex normal, weighted by the triangle's angle there, summed over all triangle corners of equal position, normal, texture
/// coordinate and handedness (whether the texture is mirrored). A vertex used with both handednesses is split: the copy is appended.
/// (MikkTSpace also keeps apart corners that no chain of shared edges connects; here they are summed.)
/// Triangles without area in the texture have no part. Where nothing remains the tangent is any unit vector of the plane.
/// @param scene  positions, normals, finite texture coordinates of every vertex, triangles, materials; tangents of every
///               vertex, (0, 0, 0, 0) where one is to be computed. Vertices that no normal-mapped triangle uses get any unit vector.
[[nodiscard]] Scene with_computed_tangents(Scene scene);

}  // namespace plumbline::scene
