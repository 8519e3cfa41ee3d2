#include "prt/relight/cluster_kernels.hpp"

#include <cstring>

#include "prt/relight/cluster_blocks.hpp"

// One 128-bit, one 256-bit and one 512-bit set: the kernel needs no more than conversions and arithmetic.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prt/relight/cluster_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace plumbline::relight::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class Integer, class D>
HWY_INLINE hn::Vec<D> integers(D d, const std::uint8_t* codes, std::size_t lane) {
  const hn::Rebind<Integer, D> narrow;
  const hn::Rebind<std::int32_t, D> wide;
  const auto* from = reinterpret_cast<const Integer*>(codes) + lane;
  return hn::ConvertTo(d, hn::PromoteTo(wide, hn::LoadU(narrow, from)));
}

template <class D>
HWY_INLINE hn::Vec<D> weights(D d, const std::uint8_t* codes, int bits, std::size_t lane) {
  if (bits == 8) return integers<std::int8_t>(d, codes, lane);
  if (bits == 16) return integers<std::int16_t>(d, codes, lane);
  return hn::LoadU(d, reinterpret_cast<const float*>(codes) + lane);
}

/// kVectors vectors of lanes at a time, so that a component's constants are spread only once for all of them.
template <std::size_t kVectors, class D>
HWY_INLINE void sum_block(D d, const ClusterInput& in, const float* constants, const std::uint8_t* codes,
                          float* sums) {
  using V = hn::Vec<D>;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t first = 0; first < kClusterLanes; first += kVectors * lanes) {
    V r[kVectors];
    V g[kVectors];
    V b[kVectors];
    for (std::size_t v = 0; v < kVectors; ++v) {
      r[v] = hn::Set(d, constants[0]);
      g[v] = hn::Set(d, constants[1]);
      b[v] = hn::Set(d, constants[2]);
    }
    const std::uint8_t* plane = codes;
    for (std::size_t k = 0; k < in.components; ++k) {
      const float* axis = constants + 3 * (k + 1);
      for (std::size_t v = 0; v < kVectors; ++v) {
        const V weight = weights(d, plane, in.stored_bits[k], first + v * lanes);
        r[v] = hn::MulAdd(weight, hn::Set(d, axis[0]), r[v]);
        g[v] = hn::MulAdd(weight, hn::Set(d, axis[1]), g[v]);
        b[v] = hn::MulAdd(weight, hn::Set(d, axis[2]), b[v]);
      }
      plane += kClusterLanes * static_cast<std::size_t>(in.stored_bits[k] / 8);
    }
    for (std::size_t v = 0; v < kVectors; ++v) {
      hn::StoreInterleaved3(r[v], g[v], b[v], d, sums + 3 * (first + v * lanes));
    }
  }
}

/// Two sums, of even and odd coefficients, so that one need not wait for the other.
template <class D>
HWY_INLINE hn::Vec<D> light_vector(D d, const float* vectors, const float* lights, std::size_t coefficients) {
  auto even = hn::Zero(d);
  auto odd = hn::Zero(d);
  std::size_t i = 0;
  for (; i + 2 <= coefficients; i += 2) {
    even = hn::MulAdd(hn::LoadU(d, vectors + i * kClusterLanes), hn::Set(d, lights[3 * i]), even);
    odd = hn::MulAdd(hn::LoadU(d, vectors + (i + 1) * kClusterLanes), hn::Set(d, lights[3 * i + 3]), odd);
  }
  if (i < coefficients)
    even = hn::MulAdd(hn::LoadU(d, vectors + i * kClusterLanes), hn::Set(d, lights[3 * i]), even);
  return hn::Add(even, odd);
}

void light_blocks(const ConstantInput& in, std::size_t blocks, float* out) {
  const hn::CappedTag<float, kClusterLanes> d;
  const std::size_t channel = in.coefficients * kClusterLanes;
  const std::size_t step = in.channels == 3 ? channel : 0;  // from a channel's coefficients to the next one's
  for (std::size_t block = 0; block < blocks; ++block) {
    for (std::size_t lane = 0; lane < kClusterLanes; lane += hn::Lanes(d)) {
      const float* from = in.vectors + block * in.channels * channel + lane;
      const auto r = light_vector(d, from, in.lights, in.coefficients);
      const auto g = light_vector(d, from + step, in.lights + 1, in.coefficients);
      const auto b = light_vector(d, from + 2 * step, in.lights + 2, in.coefficients);
      hn::StoreInterleaved3(r, g, b, d, out + 3 * (block * kClusterLanes + lane));
    }
  }
}

void sum_range(const ClusterInput& in, std::size_t first, std::size_t end, float* out) {
  const hn::CappedTag<float, kClusterLanes> d;
  HWY_ALIGN float sums[3 * kClusterLanes];
  for (std::size_t block = first; block < end; ++block) {
    const float* constants = in.constants + in.cluster[block] * 3 * (in.components + 1);
    const std::uint8_t* codes = in.codes + block * in.block_bytes;
    if (hn::Lanes(d) == kClusterLanes) {
      sum_block<1>(d, in, constants, codes, sums);
    } else {
      sum_block<2>(d, in, constants, codes, sums);
    }
    const std::uint32_t* vertex = in.vertex + block * kClusterLanes;
    for (std::size_t lane = 0; lane < kClusterLanes; ++lane) {
      std::memcpy(out + 3 * static_cast<std::size_t>(vertex[lane]), sums + 3 * lane, 3 * sizeof(float));
    }
  }
}

}  // namespace plumbline::relight::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace plumbline::relight {

HWY_EXPORT(light_blocks);
HWY_EXPORT(sum_range);

void light_constants(const ConstantInput& in, std::size_t blocks, float* out) {
  HWY_DYNAMIC_DISPATCH(light_blocks)(in, blocks, out);
}

void sum_clusters(const ClusterInput& in, std::size_t first, std::size_t end, float* out) {
  HWY_DYNAMIC_DISPATCH(sum_range)(in, first, end, out);
}

}  // namespace plumbline::relight

#endif  // HWY_ONCE
