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

std::size_t coefficients_of(const ClusterBlocks& blocks) {
  return static_cast<std::size_t>(sh::coefficient_count(blocks.bands));
}

/// Vector number `at` among the constants.
void put_constant(const float* vector, std::size_t at, ClusterBlocks& blocks) {
  const std::size_t dimension = coefficients_of(blocks) * static_cast<std::size_t>(blocks.channels);
  float* to =
      blocks.constant_vectors.data() + at / kClusterLanes * kClusterLanes * dimension + at % kClusterLanes;
  for (std::size_t i = 0; i < dimension; ++i) to[i * kClusterLanes] = vector[i];
}

std::size_t whole_blocks(std::size_t count) {
  return (count + kClusterLanes - 1) / kClusterLanes;
}

void put_constants(const compress::Compressed& compressed, ClusterBlocks& blocks) {
  const std::size_t dimension = compressed.dimension;
  const std::size_t components = compressed.components();
  blocks.constants = static_cast<std::size_t>(compressed.clusters) * (components + 1);
  blocks.constant_vectors.assign(whole_blocks(blocks.constants) * kClusterLanes * dimension, 0.0F);
  for (std::size_t c = 0; c < static_cast<std::size_t>(compressed.clusters); ++c) {
    put_constant(compressed.means.data() + c * dimension, c * (components + 1), blocks);
    for (std::size_t k = 0; k < components; ++k) {
      put_constant(compressed.axes.data() + (c * components + k) * dimension, c * (components + 1) + k + 1,
                   blocks);
    }
  }
}

/// Exit radiance of the constants, [constant][r, g, b].
std::vector<float> lit_constants(const ClusterBlocks& blocks, const sh::ShRgb& lighting) {
  if (lighting.bands < blocks.bands) {
    throw InputError(
        fmt::format("lighting: {} bands are fewer than the transfer's {}", lighting.bands, blocks.bands));
  }
  const std::size_t coefficients = coefficients_of(blocks);
  std::vector<float> lights;
  for (std::size_t i = 0; i < coefficients; ++i) {
    for (int c = 0; c < 3; ++c) lights.push_back(static_cast<float>(lighting.coefficients[i][c]));
  }
  const std::size_t count = whole_blocks(blocks.constants);
  std::vector<float> lit(3 * kClusterLanes * count);
  light_constants({blocks.constant_vectors.data(), lights.data(), coefficients,
                   static_cast<std::size_t>(blocks.channels)},
                  count, lit.data());
  return lit;
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
  blocks.bands = like.bands;
  blocks.channels = like.channels;
  put_constants(compressed, blocks);
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
  const std::vector<float> constants = lit_constants(blocks, lighting);
  const ClusterInput in{constants.data(),      blocks.stored_bits.data(), blocks.stored_bits.size(),
                        blocks.cluster.data(), blocks.vertex.data(),      blocks.codes.data(),
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
