// The inner loops of the projection of images. This file is compiled once for each instruction set (foreach_target.h).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prt/sh/moment_kernels.cpp"
// SSE4 adds nothing to SSSE3 here; vectors without a fixed size fit in no array.
#define HWY_DISABLED_TARGETS (HWY_SSE4 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#include <hwy/foreach_target.h>
// foreach_target.h comes first
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "prt/sh/moment_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace plumbline::sh {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Wide = hn::CappedTag<double, 8>;
using Narrow = hn::Rebind<float, Wide>;
using Numbers = hn::Vec<Wide>;
constexpr std::size_t kLanes = hn::MaxLanes(Wide());

struct Pixels {
  Numbers channel[3];
};

HWY_INLINE Pixels load_pixels(const float* rgb) {
  const Wide d;
  hn::Vec<Narrow> r, g, b;
  hn::LoadInterleaved3(Narrow(), rgb, r, g, b);
  return {{hn::PromoteTo(d, r), hn::PromoteTo(d, g), hn::PromoteTo(d, b)}};
}

void split(const float* rgb, std::size_t count, double* channels, std::size_t stride) {
  const Wide d;
  std::size_t k = 0;
  for (; k + kLanes <= count; k += kLanes) {
    const Pixels pixels = load_pixels(rgb + 3 * k);
    for (std::size_t c = 0; c < 3; ++c) hn::StoreU(pixels.channel[c], d, channels + c * stride + k);
  }
  for (; k < count; ++k) {
    for (std::size_t c = 0; c < 3; ++c) channels[c * stride + k] = static_cast<double>(rgb[3 * k + c]);
  }
}

// ---------------------------------------------------------------- rows of RGB pixels as they lie in memory
//
// Pixels stay interleaved: with vectors of L numbers, every third vector starts with the same channel, so that the sums
// of vector v, v + 3, v + 6, … hold the same channels in the same lanes.

/// Rows at a time: as many as have registers for their sums.
constexpr std::size_t kRows = kLanes == 8 ? kRowsTogether : 1;
/// Numbers at a time: the folded rows stay in the first-level cache.
constexpr std::size_t kChunk = 192;

struct Chunk {
  HWY_ALIGN double sums[kRows][kChunk];
  HWY_ALIGN double differences[kRows][kChunk];
  std::size_t count = 0;  // a multiple of 3 kLanes
};

HWY_INLINE Numbers load_doubles(const float* in) {
  return hn::PromoteTo(Wide(), hn::LoadU(Narrow(), in));
}

/// Brings rows to the second-level cache one after the other: chunks of several half rows are more and shorter streams
/// than the machine foresees.
HWY_INLINE void fetch_rows(const float* const* rows, const RowWeights& weights) {
  constexpr std::size_t kLine = 64 / sizeof(float);
  const std::size_t length = 3 * weights.pixels * (weights.is_folded ? 2 : 1);
  for (std::size_t r = 0; r < kRows; ++r) {
    for (std::size_t k = 0; k < length; k += kLine) hwy::Prefetch(rows[r] + k);
  }
}

/// Numbers from `first` on of kRows rows, padded with zeros.
HWY_INLINE void make_chunk(const float* const* rows, const RowWeights& weights, std::size_t first,
                           Chunk& chunk) {
  const Wide d;
  const std::size_t half = 3 * weights.pixels;
  const std::size_t length = half - first < kChunk ? half - first : kChunk;
  chunk.count = (length + 3 * kLanes - 1) / (3 * kLanes) * (3 * kLanes);
  for (std::size_t r = 0; r < kRows; ++r) {
    const float* a = rows[r] + first;
    const float* b = weights.is_folded ? a + half : nullptr;
    std::size_t k = 0;
    for (; k + kLanes <= length; k += kLanes) {
      const auto va = load_doubles(a + k);
      const auto vb = b != nullptr ? load_doubles(b + k) : hn::Zero(d);
      hn::Store(hn::Add(va, vb), d, chunk.sums[r] + k);
      hn::Store(hn::Sub(va, vb), d, chunk.differences[r] + k);
    }
    for (; k < chunk.count; ++k) {
      const double va = k < length ? static_cast<double>(a[k]) : 0.0;
      const double vb = k < length && b != nullptr ? static_cast<double>(b[k]) : 0.0;
      chunk.sums[r][k] = va + vb;
      chunk.differences[r][k] = va - vb;
    }
  }
}

/// Adds the chunk's part of two moments, cos and sin of one m, to 6 kRows vectors.
HWY_INLINE void add_chunk(const double (*data)[kChunk], std::size_t count, const double* cosine,
                          const double* sine, double* sums) {
  const Wide d;
  constexpr std::size_t kHalf = 3 * kRows;
  Numbers total[2 * kHalf];
#pragma GCC unroll 24
  for (std::size_t i = 0; i < 2 * kHalf; ++i) total[i] = hn::LoadU(d, sums + i * kLanes);
  for (std::size_t k = 0; k < count; k += 3 * kLanes) {
    for (std::size_t p = 0; p < 3; ++p) {
      const auto c = hn::LoadU(d, cosine + k + p * kLanes);
      const auto s = hn::LoadU(d, sine + k + p * kLanes);
      for (std::size_t r = 0; r < kRows; ++r) {
        const auto x = hn::Load(d, data[r] + k + p * kLanes);
        total[p * kRows + r] = hn::MulAdd(c, x, total[p * kRows + r]);
        total[kHalf + p * kRows + r] = hn::MulAdd(s, x, total[kHalf + p * kRows + r]);
      }
    }
  }
#pragma GCC unroll 24
  for (std::size_t i = 0; i < 2 * kHalf; ++i) hn::StoreU(total[i], d, sums + i * kLanes);
}

void moments_of_rows(const float* const* rows, const RowWeights& weights, double* room, double* out) {
  Chunk chunk;
  for (std::size_t first_row = 0; first_row < kRowsTogether; first_row += kRows) {
    fetch_rows(rows + first_row, weights);
    for (std::size_t i = 0; i < weights.rows * 3 * kRows * kLanes; ++i) room[i] = 0.0;
    for (std::size_t first = 0; first < 3 * weights.pixels; first += kChunk) {
      make_chunk(rows + first_row, weights, first, chunk);
      for (std::size_t r = 0; r < weights.rows; r += 2) {
        const bool is_odd = weights.is_folded && r % 4 != 0;
        const double* weight = weights.weights + r * weights.stride + first;
        add_chunk(is_odd ? chunk.differences : chunk.sums, chunk.count, weight, weight + weights.stride,
                  room + r * 3 * kRows * kLanes);
      }
    }
    for (std::size_t r = 0; r < weights.rows; ++r) {
      for (std::size_t row = 0; row < kRows; ++row) {
        double channel[3] = {0.0, 0.0, 0.0};
        for (std::size_t p = 0; p < 3; ++p) {
          const double* sums = room + ((r * 3 + p) * kRows + row) * kLanes;
          for (std::size_t lane = 0; lane < kLanes; ++lane) channel[(p * kLanes + lane) % 3] += sums[lane];
        }
        for (std::size_t c = 0; c < 3; ++c) out[((first_row + row) * weights.rows + r) * 3 + c] = channel[c];
      }
    }
  }
}

/// kRows rows of weights at once; two vectors at a time, so that the sums do not wait for themselves.
template <std::size_t kRows>
HWY_INLINE void moments_of(const double* const* weights, const double* channels, std::size_t stride,
                           std::size_t count, double* out) {
  const Wide d;
  Numbers even[3 * kRows];
  Numbers odd[3 * kRows];
  for (std::size_t i = 0; i < 3 * kRows; ++i) even[i] = odd[i] = hn::Zero(d);
  for (std::size_t k = 0; k < count; k += 2 * kLanes) {
    for (std::size_t r = 0; r < kRows; ++r) {
      const auto w0 = hn::LoadU(d, weights[r] + k);
      const auto w1 = hn::LoadU(d, weights[r] + k + kLanes);
      for (std::size_t c = 0; c < 3; ++c) {
        even[3 * r + c] = hn::MulAdd(w0, hn::LoadU(d, channels + c * stride + k), even[3 * r + c]);
        odd[3 * r + c] = hn::MulAdd(w1, hn::LoadU(d, channels + c * stride + k + kLanes), odd[3 * r + c]);
      }
    }
  }
  for (std::size_t i = 0; i < 3 * kRows; ++i)
    out[i] = hn::GetLane(hn::SumOfLanes(d, hn::Add(even[i], odd[i])));
}

void moments(const double* const* weights, std::size_t rows, const double* channels, std::size_t stride,
             std::size_t count, double* out) {
  std::size_t r = 0;
  for (; r + 2 <= rows; r += 2) moments_of<2>(weights + r, channels, stride, count, out + 3 * r);
  if (r < rows) moments_of<1>(weights + r, channels, stride, count, out + 3 * r);
}

void nodes(const double* s, const double* ds, double t, double dt, std::size_t count, double* x, double* y,
           double* z, double* weight) {
  const Wide d;
  const auto one = hn::Set(d, 1.0);
  const auto vt = hn::Set(d, t);
  const auto vdt = hn::Set(d, dt);
  const auto base = hn::Set(d, 1.0 + t * t);
  for (std::size_t k = 0; k < count; k += kLanes) {
    const auto vs = hn::LoadU(d, s + k);
    const auto inverse = hn::Div(one, hn::Sqrt(hn::MulAdd(vs, vs, base)));
    hn::StoreU(hn::Mul(vs, inverse), d, x + k);
    hn::StoreU(hn::Mul(vt, inverse), d, y + k);
    hn::StoreU(inverse, d, z + k);
    const auto cube = hn::Mul(hn::Mul(inverse, inverse), inverse);
    hn::StoreU(hn::Mul(hn::Mul(hn::LoadU(d, ds + k), vdt), cube), d, weight + k);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace plumbline::sh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plumbline::sh {
namespace {

HWY_EXPORT(split);
HWY_EXPORT(moments_of_rows);
HWY_EXPORT(moments);
HWY_EXPORT(nodes);

}  // namespace

void split_pixels(const float* rgb, std::size_t count, double* channels, std::size_t stride) {
  HWY_DYNAMIC_DISPATCH(split)(rgb, count, channels, stride);
}
void row_moments(const float* const* rows, const RowWeights& weights, double* room, double* out) {
  HWY_DYNAMIC_DISPATCH(moments_of_rows)(rows, weights, room, out);
}
void channel_moments(const double* const* weights, std::size_t rows, const double* channels,
                     std::size_t stride, std::size_t count, double* out) {
  HWY_DYNAMIC_DISPATCH(moments)(weights, rows, channels, stride, count, out);
}
void face_nodes(const double* s, const double* ds, double t, double dt, std::size_t count, double* x,
                double* y, double* z, double* weight) {
  HWY_DYNAMIC_DISPATCH(nodes)(s, ds, t, dt, count, x, y, z, weight);
}

}  // namespace plumbline::sh
#endif  // HWY_ONCE
