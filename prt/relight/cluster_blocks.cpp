#include "prt/relight/cluster_blocks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "prt/relight/cluster_kernels.hpp"
#include "prt/sh/basis.hpp"
#include "reference/base/error.hpp"
#include "reference/base/parallel.hpp"

namespace plumbline::relight {
namespace {

constexpr std::size_t kBlocksAtATime = 256;  // one thread's share: 4096 vertices

transfer::Transfer constants_of(const compress::Compressed& compressed, const transfer::Transfer& like) {
  transfer::Transfer constants;
  constants.bands = like.bands;
  constants.channels = like.channels;
  const std::size_t dimension = compressed.dimension;
  const std::size_t axes = compressed.components() * dimension;
  constants.vertices = static_cast<std::size_t>(compressed.clusters) * (compressed.components() + 1);
  constants.coefficients.reserve(constants.vertices * dimension);
  const auto append = [&](const std::vector<float>& from, std::size_t first, std::size_t count) {
    const auto begin = from.begin() + static_cast<std::ptrdiff_t>(first);
    constants.coefficients.insert(constants.coefficients.end(), begin,
                                  begin + static_cast<std::ptrdiff_t>(count));
  };
  for (std::size_t c = 0; c < static_cast<std::size_t>(compressed.clusters); ++c) {
    append(compressed.means, c * dimension, dimension);
    append(compressed.axes, c * axes, axes);
  }
  return constants;
}

void put_code(std::uint8_t* plane, int stored_bits, std::size_t lane, float code) {
  const auto put = [&](auto value) { std::memcpy(plane + lane * sizeof(value), &value, sizeof(value)); };
  if (stored_bits == 8) return put(static_cast<std::int8_t>(code));
  if (stored_bits == 16) return put(static_cast<std::int16_t>(code));
  put(code);
}

void put_codes(const compress::Compressed& compressed, ClusterBlocks& blocks) {
  blocks.codes.assign(blocks.cluster.size() * blocks.block_bytes, 0);
  std::size_t offset = 0;
  for (std::size_t k = 0; k < compressed.components(); ++k) {
    const std::span<const std::uint8_t> plane = compress::plane_of(compressed, k);
    for (std::size_t i = 0; i < blocks.vertex.size(); ++i) {
      put_code(blocks.codes.data() + i / kClusterLanes * blocks.block_bytes + offset, blocks.stored_bits[k],
               i % kClusterLanes, compress::code_of(plane, compressed.bits[k], blocks.vertex[i]));
    }
    offset += kClusterLanes * static_cast<std::size_t>(blocks.stored_bits[k] / 8);
  }
}

}  // namespace

ClusterBlocks make_cluster_blocks(const compress::Compressed& compressed, const transfer::Transfer& like) {
  compress::validate(compressed, "relight");
  if (compressed.dimension != static_cast<std::size_t>(like.channels * sh::coefficient_count(like.bands))) {
    throw InputError(
        fmt::format("relight: compressed vectors of {} numbers do not fit {} bands and {} channels",
                    compressed.dimension, like.bands, like.channels));
  }
  ClusterBlocks blocks;
  blocks.vertices = compressed.vertices;
  blocks.constants = constants_of(compressed, like);
  for (const int bits : compressed.bits) {
    blocks.stored_bits.push_back(std::max(bits, 8));
    blocks.block_bytes += kClusterLanes * static_cast<std::size_t>(blocks.stored_bits.back() / 8);
  }
  const std::vector<std::uint32_t> labels(compressed.labels.begin(), compressed.labels.end());
  const auto members = compress::members_of(labels, static_cast<std::size_t>(compressed.clusters));
  for (std::uint32_t c = 0; c < members.size(); ++c) {
    for (std::size_t first = 0; first < members[c].size(); first += kClusterLanes) {
      blocks.cluster.push_back(c);
      for (std::size_t lane = 0; lane < kClusterLanes; ++lane) {
        blocks.vertex.push_back(members[c][std::min(first + lane, members[c].size() - 1)]);
      }
    }
  }
  put_codes(compressed, blocks);
  return blocks;
}

void unit_albedo_exit_radiance(const ClusterBlocks& blocks, const sh::ShRgb& lighting, std::span<Rgb> out,
                               int threads) {
  if (out.size() != blocks.vertices) {
    throw InputError(fmt::format("relight: {} places for {} vertices", out.size(), blocks.vertices));
  }
  static_assert(sizeof(Rgb) == 3 * sizeof(float));
  const std::vector<Rgb> constants = unit_albedo_exit_radiance(blocks.constants, lighting);
  const ClusterInput in{reinterpret_cast<const float*>(constants.data()),
                        blocks.stored_bits.data(),
                        blocks.stored_bits.size(),
                        blocks.cluster.data(),
                        blocks.vertex.data(),
                        blocks.codes.data(),
                        blocks.block_bytes};
  parallel_for((blocks.cluster.size() + kBlocksAtATime - 1) / kBlocksAtATime, threads, [&](std::size_t part) {
    const std::size_t first = part * kBlocksAtATime;
    sum_clusters(in, first, std::min(first + kBlocksAtATime, blocks.cluster.size()),
                 reinterpret_cast<float*>(out.data()));
  });
}

std::vector<Rgb> unit_albedo_exit_radiance(const ClusterBlocks& blocks, const sh::ShRgb& lighting,
                                           int threads) {
  std::vector<Rgb> result(blocks.vertices);
  unit_albedo_exit_radiance(blocks, lighting, result, threads);
  return result;
}

}  // namespace plumbline::relight
