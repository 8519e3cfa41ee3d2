// prt/relight/cluster_kernels.hpp: the vector code behind cluster_blocks.hpp, chosen for the machine when the program runs.
#pragma once

#include <cstddef>
#include <cstdint>

namespace plumbline::relight {

/// Vectors whose exit radiance is wanted.
struct ConstantInput {
  const float* vectors;  // [block][channel][coefficient][lane]
  const float* lights;   // [coefficient][r, g, b]
  std::size_t coefficients;
  std::size_t channels;  // 1 or 3
};

/// out[3 vector + channel] = sum_i vector_i light_i,channel, for all the lanes of so many blocks.
void light_constants(const ConstantInput& in, std::size_t blocks, float* out);

/// As ClusterBlocks holds them.
struct ClusterInput {
  const float* constants;  // [cluster][1 + components][r, g, b]
  const int* stored_bits;  // [component]
  std::size_t components;
  const std::uint32_t* cluster;
  const std::uint32_t* vertex;
  const std::uint8_t* codes;
  std::size_t block_bytes;
};

/// out[3 vertex + channel] of the vertices of blocks first … end - 1.
void sum_clusters(const ClusterInput& in, std::size_t first, std::size_t end, float* out);

}  // namespace plumbline::relight
