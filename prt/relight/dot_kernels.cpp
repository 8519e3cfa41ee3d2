// The inner loops of relighting. This file is compiled once for each instruction set (foreach_target.h).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prt/relight/dot_kernels.cpp"
// SSE4 adds nothing to SSSE3 here; vectors without a fixed size fit in no array.
#define HWY_DISABLED_TARGETS (HWY_SSE4 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#include <hwy/foreach_target.h>
// foreach_target.h comes first
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>

#include "prt/relight/dot_kernels.hpp"
#include "prt/relight/transfer_blocks.hpp"

HWY_BEFORE_NAMESPACE();
namespace plumbline::relight {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, kBlockVertices>;
using Vec = hn::Vec<Tag>;
constexpr std::size_t kLanes = hn::MaxLanes(Tag());
constexpr std::size_t kVectors = kBlockVertices / kLanes;  // of a block
/// Blocks at a time: twelve sums hide the latency of multiply-adds, and their registers are there.
constexpr std::size_t kTogether = kVectors >= 4 ? 1 : 4 / kVectors;

/// How far ahead of the sums memory is asked for where every load has three sums to feed: at that pace the machine does
/// not run ahead far enough by itself. A prefetch behind the array's end does nothing.
constexpr std::size_t kAhead = 200 * kBlockVertices;

/// One transfer vector for all lights, or one each.
enum class Channels { one, three };

template <std::size_t kBlocks>
struct Sums {
  Vec of[kBlocks * kVectors][3];
};

// Vertices are lanes, so that sums need no shuffles, and what one vertex gets does not depend on the vectors' width.
template <Channels kChannels, std::size_t kBlocks>
HWY_INLINE Sums<kBlocks> sum_blocks(const DotInput& in, const float* transfer) {
  const Tag d;
  constexpr std::size_t kRows = kChannels == Channels::three ? 3 : 1;
  const std::size_t row = in.coefficients * kBlockVertices;
  Sums<kBlocks> sums;
  for (auto& vector : sums.of)
    for (Vec& sum : vector) sum = hn::Zero(d);
  for (std::size_t i = 0; i < in.coefficients; ++i) {
    const Vec lights[3] = {hn::Set(d, in.lights[3 * i]), hn::Set(d, in.lights[3 * i + 1]),
                           hn::Set(d, in.lights[3 * i + 2])};
    for (std::size_t u = 0; u < kBlocks * kVectors; ++u) {
      const float* at = transfer + u / kVectors * kRows * row + i * kBlockVertices + u % kVectors * kLanes;
      if constexpr (kRows == 1) hwy::Prefetch(at + kAhead);
      for (std::size_t c = 0; c < 3; ++c)
        sums.of[u][c] = hn::MulAdd(hn::Load(d, at + (kRows == 3 ? c * row : 0)), lights[c], sums.of[u][c]);
    }
  }
  return sums;
}

template <std::size_t kBlocks>
HWY_INLINE void store(const Sums<kBlocks>& sums, float* out) {
  for (std::size_t u = 0; u < kBlocks * kVectors; ++u)
    hn::StoreInterleaved3(sums.of[u][0], sums.of[u][1], sums.of[u][2], Tag(), out + 3 * kLanes * u);
}

template <Channels kChannels>
void dot(const DotInput& in, std::size_t vertices, float* out) {
  const std::size_t stride = (kChannels == Channels::three ? 3 : 1) * in.coefficients * kBlockVertices;
  const std::size_t whole = std::min(in.blocks, vertices / kBlockVertices);
  std::size_t b = 0;
  for (; b + kTogether <= whole; b += kTogether)
    store(sum_blocks<kChannels, kTogether>(in, in.transfer + b * stride), out + 3 * kBlockVertices * b);
  for (; b < in.blocks; ++b) {
    HWY_ALIGN float block[3 * kBlockVertices];
    store(sum_blocks<kChannels, 1>(in, in.transfer + b * stride), block);
    const std::size_t count = std::min(kBlockVertices, vertices - b * kBlockVertices);
    std::copy_n(block, 3 * count, out + 3 * kBlockVertices * b);
  }
}

// ---------------------------------------------------------------- entry points: no templates across the dispatch

void dot_one_channel(const DotInput& in, std::size_t vertices, float* out) {
  dot<Channels::one>(in, vertices, out);
}
void dot_three_channels(const DotInput& in, std::size_t vertices, float* out) {
  dot<Channels::three>(in, vertices, out);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace plumbline::relight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plumbline::relight {
namespace {

HWY_EXPORT(dot_one_channel);
HWY_EXPORT(dot_three_channels);

}  // namespace

void dot_gray(const DotInput& in, std::size_t vertices, float* out) {
  HWY_DYNAMIC_DISPATCH(dot_one_channel)(in, vertices, out);
}
void dot_rgb(const DotInput& in, std::size_t vertices, float* out) {
  HWY_DYNAMIC_DISPATCH(dot_three_channels)(in, vertices, out);
}

}  // namespace plumbline::relight
#endif  // HWY_ONCE
