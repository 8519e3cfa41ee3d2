// prt/relight/transfer_blocks.hpp: a transfer laid out for being read once a frame.
#pragma once

#include <cstddef>

#include "prt/sh/aligned.hpp"
#include "prt/transfer/transfer.hpp"

namespace plumbline::relight {

/// One cache line of float, the longest vector of today's machines.
inline constexpr std::size_t kBlockVertices = 16;

/// [block][channel][coefficient][vertex of the block], so that the vertices of a block are a vector's lanes. The last
/// block is filled up with zeros.
struct TransferBlocks {
  int bands = 0;
  int channels = 1;  // 1 or 3, as Transfer's
  std::size_t vertices = 0;
  sh::AlignedVector<float> coefficients;
};

/// Once for all frames: as much memory as the transfer has, read and written once.
/// @throws InputError when the transfer's sizes do not agree
[[nodiscard]] TransferBlocks make_blocks(const transfer::Transfer& transfer, int threads = 0);

}  // namespace plumbline::relight
