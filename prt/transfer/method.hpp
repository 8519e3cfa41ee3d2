// prt/transfer/method.hpp: the ways there are to compute a transfer.
// [1] Sloan, Kautz & Snyder, "Precomputed Radiance Transfer for Real-Time Rendering in Dynamic, Low-Frequency Lighting
// Environments", SIGGRAPH 2002, section 5. [2] Peers, "Deriving basic Precomputed Radiance Transfer", 2009, eq. 17-22.
// [3] Green, "Spherical Harmonic Lighting: The Gritty Details", 2003.
#pragma once

#include <limits>
#include <string_view>

namespace plumbline::transfer {

/// Bounces of light between surfaces without a limit.
inline constexpr int kAllBounces = std::numeric_limits<int>::max();

/// What computes the bounces. traced: a random walk from every vertex, of which every step samples one more bounce.
/// Nothing is interpolated on the way, so that the standard errors cover all there is to be wrong: the default.
/// iterative: bounce k at a vertex gathers bounce k-1 of all others, interpolated over the triangles that are hit [1]; rays
/// are traced once. Much less noise for the same rays, and an error of interpolation on coarse meshes that no standard error
/// shows.
enum class Solver { traced, iterative };

/// How directions are distributed. qmc: cosine density, a randomly shifted lattice; cosine: cosine density, one random direction
/// in each cell of a grid [2]; uniform: over the whole sphere, one in each cell of a grid, those below the horizon dark [3].
enum class Sampling { qmc, cosine, uniform };

/// per_vertex: every vertex draws its own, so that the error of one says nothing of its neighbour's; shared: the same draws
/// for all, as in the papers: errors change smoothly over a surface, which hides them from the eye and leaves them in every
/// mean.
enum class DirectionSets { per_vertex, shared };

struct Method {
  Solver solver = Solver::traced;
  Sampling sampling = Sampling::qmc;
  DirectionSets directions = DirectionSets::per_vertex;
};

[[nodiscard]] std::string_view to_string(Solver solver);
[[nodiscard]] std::string_view to_string(Sampling sampling);
[[nodiscard]] std::string_view to_string(DirectionSets directions);
/// @throws InputError listing what there is.
[[nodiscard]] Solver solver_from_string(std::string_view text);
[[nodiscard]] Sampling sampling_from_string(std::string_view text);
[[nodiscard]] DirectionSets direction_sets_from_string(std::string_view text);

}  // namespace plumbline::transfer
