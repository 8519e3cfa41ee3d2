// prt/compress/distances.hpp: squared distances of many vectors to many affine subspaces, in float and fast: what picks
// the candidates that are then measured in double. Not for others.
#pragma once

#include <cstddef>
#include <vector>

#include "prt/compress/affine.hpp"

namespace plumbline::compress {

inline constexpr std::size_t kGroup = 16;  // subspaces side by side
inline constexpr std::size_t kColumns =
    3;  // columns of a subspace (mean or axis) that are multiplied at a time

/// Subspaces rearranged for the kernel: by groups of kGroup, within by chunks of kColumns of the columns mean, axis 0,
/// axis 1, …: [group][chunk][dimension][column][kGroup].
struct SubspaceTable {
  std::size_t dimension = 0;
  std::size_t groups = 0;
  std::size_t chunks = 0;
  std::vector<double> origin;  // [dimension]: vectors and means are held relative to it
  std::vector<float> columns;
  std::vector<float> offsets;  // [group][chunk][column][kGroup]: axis . mean; 0 for the mean's own column
  std::vector<float> squares;  // [group][kGroup]: |mean|^2; infinite where there is no subspace
};

[[nodiscard]] SubspaceTable make_table(const std::vector<Affine>& subspaces, std::vector<double> origin);

/// distances[row][groups * kGroup] = |x|^2 - 2 x.mean + |mean|^2 - sum_k (axis_k.x - axis_k.mean)^2 - |x|^2: without |x|^2,
/// which is the same for all. `x`: `rows` vectors less the origin.
void relative_distances(const SubspaceTable& table, const float* x, std::size_t rows, float* distances);

}  // namespace plumbline::compress
