// prt/normal_map/local_transfer.hpp: transfer that leaves the normal open: exit radiance follows per pixel, from a normal map.
// [1] Sloan, "Practical PRT" (part II: normal mapping), SIGGRAPH 2005 course: e(n) = y(n)^T C R M l.
// [2] McTaggart, "Half-Life 2 / Valve Source shading", GDC 2004.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "prt/normal_map/normal_basis.hpp"
#include "prt/sh/lighting.hpp"
#include "reference/scene/scene.hpp"

namespace plumbline::normal_map {

/// A matrix at every vertex that takes the light's coefficients (world axes) to `rows` numbers about the light that arrives there.
/// What the rows mean is said by the function that made them. Gray: the same for r, g, b. No standard errors are kept.
struct LocalTransfer {
  int rows = 0;
  int bands = 0;
  std::size_t vertices = 0;
  std::vector<float> matrices;  // [vertex][row][bands^2]

  [[nodiscard]] std::span<const float> matrix(std::size_t vertex) const;
};

struct LocalBakeSettings {
  int bands = 5;       // of the light
  int samples = 1024;  // directions a vertex
  std::uint64_t seed = 0;
  int threads = 0;  // 0 = all there are; never changes the result
  std::function<void(double fraction)> progress;
};

/// M of [1]: nine rows, the quadratic SH coefficients in world axes of the distant light that reaches the vertex:
///   M_ji = integral y_j(w) V(w) y_i(w) dw
/// over the hemisphere above the vertex' surface plane, V = 1 where nothing is met. Directions uniform over the hemisphere from 16
/// shifted point sets; direct light only. The normal map itself plays no part: bumps neither shadow nor light each other.
/// @throws InputError for bands or samples out of range (16 … 2^26), or a scene that holds spheres or discs
[[nodiscard]] LocalTransfer bake_incident_radiance(const scene::Scene& scene,
                                                   const LocalBakeSettings& settings);

/// R M: the same rows in each vertex' right-handed tangent frame (tangent, normal x tangent, normal).
/// @throws InputError when the scene has no tangents or another number of vertices, or `world` has not 9 rows
[[nodiscard]] LocalTransfer in_tangent_frames(const LocalTransfer& world, const scene::Scene& scene);

/// The first `terms` rows of S V^T R M: multiplied by u_k(n) they give exit radiance for unit albedo.
/// @throws InputError unless `tangent` has 9 rows and 1 <= terms <= 9
[[nodiscard]] LocalTransfer compressed(const LocalTransfer& tangent, const NormalBasis& basis, int terms);

/// Three rows: exit radiance for unit albedo of surfaces that face the directions of Half-Life 2's basis [2].
/// @throws InputError unless `tangent` has 9 rows
[[nodiscard]] LocalTransfer half_life_2(const LocalTransfer& tangent);

/// Three rows again, the least-squares fit of p_k(n) = max(0, n.b_k)^2 to the nine terms over the hemisphere of normals, cosine-weighted:
/// the course's "project convolved radiance into" this basis [1]. They multiply half_life_2_functions().
/// @throws InputError unless `tangent` has 9 rows
[[nodiscard]] LocalTransfer half_life_2_fitted(const LocalTransfer& tangent);

/// Rows times light at every vertex: [vertex][row]. Lighting with more bands is truncated.
/// @throws InputError when the lighting has fewer bands than the transfer
[[nodiscard]] std::vector<Rgb> lit_rows(const LocalTransfer& transfer, const sh::ShRgb& lighting);

/// max(0, n.b_k)^2 with b_k = (sqrt(2/3), 0, 1/sqrt 3), (-1/sqrt 6, +-1/sqrt 2, 1/sqrt 3). `normal`: unit, tangent frame.
[[nodiscard]] Vec3d half_life_2_functions(const Vec3d& normal);
/// The same over their sum (which is 1 where none is clamped): weights of the three rows of half_life_2(). z > 0.
[[nodiscard]] Vec3d half_life_2_weights(const Vec3d& normal);

}  // namespace plumbline::normal_map
