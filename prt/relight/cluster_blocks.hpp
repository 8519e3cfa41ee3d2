// prt/relight/cluster_blocks.hpp: light times compressed transfer, without decoding it.
// [1] Sloan, Hall, Hart & Snyder, "Clustered Principal Components for Precomputed Radiance Transfer", SIGGRAPH 2003.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "prt/compress/compressed.hpp"
#include "prt/relight/cpu.hpp"
#include "prt/sh/aligned.hpp"

namespace plumbline::relight {

/// Lanes of a block: one cache line of float, the longest vector of today's machines.
inline constexpr std::size_t kClusterLanes = 16;

/// A compressed transfer laid out for being read once a frame: the vertices of a cluster together, in blocks of kClusterLanes. The last block
/// of a cluster is filled up with its last vertex.
struct ClusterBlocks {
  std::size_t vertices = 0;
  int bands = 0;
  int channels = 1;           // 1 or 3, as Transfer's
  std::size_t constants = 0;  // mean, axis 0, axis 1, … of cluster 0, then of cluster 1, …
  /// [block of constants][channel][coefficient][lane], filled up with zeros.
  sh::AlignedVector<float> constant_vectors;
  std::vector<int> stored_bits;           // [component] 8 (codes of 4 bits too), 16, 32
  std::size_t block_bytes = 0;            // of one block's codes
  std::vector<std::uint32_t> cluster;     // [block]
  std::vector<std::uint32_t> vertex;      // [block][lane]
  sh::AlignedVector<std::uint8_t> codes;  // [block][component][lane]
};

/// Once for all frames. @param like  gives bands and channels
/// @throws InputError when the two do not have one shape
[[nodiscard]] ClusterBlocks make_cluster_blocks(const compress::Compressed& compressed,
                                                const transfer::Transfer& like);

/// Exit radiance for unit albedo at every vertex, as of the decoded transfer: sum over k of code_k e_ck + e_c, where e_c and e_ck
/// are the dot products of the light with the mean and the axes of the vertex's cluster [1, eq. 7]. In float: within
/// (n^2 + K + 3) 2^-24 (sum_i |mean_i l_i| + sum_k |code_k| sum_i |axis_ki l_i|) of exact sums. Same bits for any number of
/// threads (0 = all).
/// @param out  one place a vertex
/// @throws InputError when the lighting has fewer bands than the transfer, or for another number of places
void unit_albedo_exit_radiance(const ClusterBlocks& blocks, const sh::ShRgb& lighting, std::span<Rgb> out,
                               int threads = 0);
[[nodiscard]] std::vector<Rgb> unit_albedo_exit_radiance(const ClusterBlocks& blocks,
                                                         const sh::ShRgb& lighting, int threads = 0);

}  // namespace plumbline::relight
