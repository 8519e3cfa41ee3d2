#include "prt/relight/transfer_blocks.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "prt/sh/basis.hpp"
#include "reference/base/error.hpp"
#include "reference/base/parallel.hpp"

namespace plumbline::relight {

TransferBlocks make_blocks(const transfer::Transfer& transfer, int threads) {
  const auto rows = static_cast<std::size_t>(sh::coefficient_count(transfer.bands)) *
                    static_cast<std::size_t>(transfer.channels);
  if ((transfer.channels != 1 && transfer.channels != 3) ||
      transfer.coefficients.size() != rows * transfer.vertices) {
    throw InputError(fmt::format("relight: {} coefficients for {} vertices of {} channels and {} bands",
                                 transfer.coefficients.size(), transfer.vertices, transfer.channels,
                                 transfer.bands));
  }
  const std::size_t blocks = (transfer.vertices + kBlockVertices - 1) / kBlockVertices;
  TransferBlocks result{transfer.bands, transfer.channels, transfer.vertices, {}};
  result.coefficients.resize(blocks * kBlockVertices * rows);
  constexpr std::size_t kTogether = 64;  // blocks a task
  parallel_for((blocks + kTogether - 1) / kTogether, threads, [&](std::size_t task) {
    const std::size_t end = std::min(transfer.vertices, (task + 1) * kTogether * kBlockVertices);
    for (std::size_t v = task * kTogether * kBlockVertices; v < end; ++v) {
      const float* from = transfer.coefficients.data() + v * rows;
      float* to =
          result.coefficients.data() + v / kBlockVertices * kBlockVertices * rows + v % kBlockVertices;
      for (std::size_t i = 0; i < rows; ++i) to[i * kBlockVertices] = from[i];
    }
  });
  return result;
}

}  // namespace plumbline::relight
