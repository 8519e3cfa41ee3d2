// The inner loops of the bake. This file is compiled once for each instruction set (foreach_target.h).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prt/transfer/kernels.cpp"
// SSE4 adds nothing to SSSE3 here; vectors without a fixed size fit in no array.
#define HWY_DISABLED_TARGETS (HWY_SSE4 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#include <hwy/foreach_target.h>
// foreach_target.h comes first
#include <hwy/highway.h>

#include "prt/sh/batch.hpp"
#include "prt/transfer/kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace plumbline::transfer {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;
using Vector = hn::Vec<Floats>;
constexpr std::size_t kLanes = hn::MaxLanes(Floats());
constexpr std::size_t kVectors = sh::kBlockDirections / kLanes;

// cos and sin of a sum of angles: no trigonometry a direction. sqrt(u) and sqrt(1 - u) are sine and cosine of the angle to
// the normal (Peers, eq. 17-18).
void make_directions(const LatticeFrame& frame, const float* cosine, const float* sine, const float* height,
                     std::size_t count, float* x, float* y, float* z) {
  const Floats d;
  const auto one = hn::Set(d, 1.0F);
  const auto c0 = hn::Set(d, frame.start_cosine);
  const auto s0 = hn::Set(d, frame.start_sine);
  const auto h0 = hn::Set(d, frame.start_height);
  float* const out[3] = {x, y, z};
  for (std::size_t k = 0; k < count; k += kLanes) {
    const auto place = hn::Min(one, hn::Add(h0, hn::Load(d, height + k)));  // beyond n: padding
    const auto u = hn::Sub(one, hn::Abs(hn::Sub(hn::Add(place, place), one)));
    const auto radius = hn::Sqrt(u);
    const auto up = hn::Sqrt(hn::Sub(one, u));
    const auto c = hn::Load(d, cosine + k);
    const auto s = hn::Load(d, sine + k);
    const auto a = hn::Mul(radius, hn::Sub(hn::Mul(c0, c), hn::Mul(s0, s)));
    const auto b = hn::Mul(radius, hn::MulAdd(s0, c, hn::Mul(c0, s)));
    for (std::size_t i = 0; i < 3; ++i) {
      auto v = hn::Mul(a, hn::Set(d, frame.tangent[i]));
      v = hn::MulAdd(b, hn::Set(d, frame.bitangent[i]), v);
      v = hn::MulAdd(up, hn::Set(d, frame.normal[i]), v);
      hn::Store(v, d, out[i] + k);
    }
  }
}

void weighted(const float* values, const float* weights, std::size_t stride, int channels, std::size_t blocks,
              std::size_t size, float* sums) {
  const Floats d;
  for (int c = 0; c < channels; ++c) {
    for (std::size_t i = 0; i < size; ++i) {
      float* out = sums + (static_cast<std::size_t>(c) * size + i) * sh::kBlockDirections;
      const float* value = values + i * sh::kBlockDirections;
      Vector total[kVectors];
      for (std::size_t u = 0; u < kVectors; ++u) total[u] = hn::Load(d, out + u * kLanes);
      for (std::size_t b = 0; b < blocks; ++b) {
        const float* w = weights + static_cast<std::size_t>(c) * stride + b * sh::kBlockDirections;
        const float* v = value + b * size * sh::kBlockDirections;
        for (std::size_t u = 0; u < kVectors; ++u) {
          total[u] = hn::MulAdd(hn::Load(d, w + u * kLanes), hn::Load(d, v + u * kLanes), total[u]);
        }
      }
      for (std::size_t u = 0; u < kVectors; ++u) hn::Store(total[u], d, out + u * kLanes);
    }
  }
}

void rows(const float* const* corners, const float* weights, std::size_t hits, int channels, std::size_t row,
          float* sums) {
  const Floats d;
  const auto n = static_cast<std::size_t>(channels);
  for (std::size_t h = 0; h < hits; ++h) {
    const float* const* corner = corners + 3 * h;
    const float* weight = weights + 3 * h * n;
    for (std::size_t c = 0; c < n; ++c) {
      const auto w0 = hn::Set(d, weight[c]);
      const auto w1 = hn::Set(d, weight[n + c]);
      const auto w2 = hn::Set(d, weight[2 * n + c]);
      for (std::size_t i = c * row; i < (c + 1) * row; i += kLanes) {
        auto total = hn::Load(d, sums + i);
        total = hn::MulAdd(w0, hn::Load(d, corner[0] + i), total);
        total = hn::MulAdd(w1, hn::Load(d, corner[1] + i), total);
        total = hn::MulAdd(w2, hn::Load(d, corner[2] + i), total);
        hn::Store(total, d, sums + i);
      }
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace plumbline::transfer
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plumbline::transfer {
namespace {

HWY_EXPORT(make_directions);
HWY_EXPORT(weighted);
HWY_EXPORT(rows);

}  // namespace

void lattice_directions(const LatticeFrame& frame, const float* cosine, const float* sine,
                        const float* height, std::size_t count, float* x, float* y, float* z) {
  HWY_DYNAMIC_DISPATCH(make_directions)(frame, cosine, sine, height, count, x, y, z);
}
void add_weighted(const float* values, const float* weights, std::size_t stride, int channels,
                  std::size_t blocks, std::size_t size, float* sums) {
  HWY_DYNAMIC_DISPATCH(weighted)(values, weights, stride, channels, blocks, size, sums);
}
void add_rows(const float* const* corners, const float* weights, std::size_t hits, int channels,
              std::size_t row, float* sums) {
  HWY_DYNAMIC_DISPATCH(rows)(corners, weights, hits, channels, row, sums);
}

}  // namespace plumbline::transfer
#endif  // HWY_ONCE
