// prt/sh/projection_parts.hpp: what projection.cpp and projection_cube.cpp share.
#pragma once

#include <functional>
#include <vector>

#include "prt/sh/basis.hpp"
#include "reference/light/environment.hpp"

namespace plumbline::sh {

using Coefficients = std::vector<RgbD>;
using Matrix = glm::dmat3;

/// Sum over i = 0 … count-1 of what add(i, sum) adds to `size` values. The blocks and their places in the sum depend on
/// count only, so that the bits do not depend on the threads.
[[nodiscard]] Coefficients sum_in_blocks(std::size_t count, std::size_t size, int threads,
                                         const std::function<void(std::size_t, Coefficients&)>& add);

/// A function's coefficients in a frame of its own.
struct TurnedPart {
  Coefficients coefficients;
  Matrix to_world;  // orthogonal, mirrors included
};
/// The sum of the parts, in the world's frame: evaluated at the nodes of a rule that is exact for the degree, and
/// projected again.
[[nodiscard]] Coefficients turned(const std::vector<TurnedPart>& parts, int bands, int threads);

/// Largest number of bands that project_cube_faces() has room for.
inline constexpr int kCubeFaceBands = 64;
/// Six square faces of constant texels. Same integrals as those of append_cube_nodes(), rule and solid angles, with the
/// symmetries of a face made use of.
[[nodiscard]] Coefficients project_cube_faces(const light::CubeMapSky& sky, const Matrix& rotation, int bands,
                                              int gauss_nodes, int threads);

}  // namespace plumbline::sh
