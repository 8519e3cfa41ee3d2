// prt/relight/dot_kernels.hpp: the vector code behind cpu.hpp, chosen for the machine when the program runs.
#pragma once

#include <cstddef>

namespace plumbline::relight {

/// Whole blocks of kBlockVertices vertices: [block][channel][coefficient][vertex], starting on a cache line.
struct DotInput {
  const float* lights;  // [coefficient][r, g, b]
  std::size_t coefficients;
  const float* transfer;
  std::size_t blocks;
};

/// out[3 v + c] = sum_i transfer_v,i light_i,c, `vertices` triples: as many as the blocks hold, or, for the last
/// block, fewer.
void dot_gray(const DotInput& in, std::size_t vertices, float* out);

/// The same for a transfer of three channels: sum_i transfer_v,c,i light_i,c.
void dot_rgb(const DotInput& in, std::size_t vertices, float* out);

}  // namespace plumbline::relight
