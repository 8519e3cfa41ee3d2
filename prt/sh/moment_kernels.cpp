// The inner loops of the projection of images. This file is compiled once for each instruction set (foreach_target.h).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prt/sh/moment_kernels.cpp"
// SSE4 adds nothing to SSSE3 here; vectors without a fixed size fit in no array.
#define HWY_DISABLED_TARGETS (HWY_SSE4 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#include <hwy/foreach_target.h>
// foreach_target.h comes first
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "prt/sh/batch.hpp"
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

// ---------------------------------------------------------------- faces of cubes

struct Pixels {
  Numbers channel[3];
};

template <bool kIsReversed>
HWY_INLINE Pixels load_pixels(const float* rgb) {
  const Narrow narrow;
  const Wide d;
  hn::Vec<Narrow> r, g, b;
  hn::LoadInterleaved3(narrow, rgb, r, g, b);
  if constexpr (kIsReversed) {
    return {{hn::PromoteTo(d, hn::Reverse(narrow, r)), hn::PromoteTo(d, hn::Reverse(narrow, g)),
             hn::PromoteTo(d, hn::Reverse(narrow, b))}};
  } else {
    return {{hn::PromoteTo(d, r), hn::PromoteTo(d, g), hn::PromoteTo(d, b)}};
  }
}

HWY_INLINE void fold_pixel(const float* top, const float* bottom, std::size_t width, std::size_t x,
                           double* parts, std::size_t stride) {
  const std::size_t mirror = width - 1 - x;
  const auto at = [=](const float* row, std::size_t k, std::size_t c) {
    return row != nullptr ? static_cast<double>(row[3 * k + c]) : 0.0;
  };
  for (std::size_t c = 0; c < 3; ++c) {
    const double top_right = mirror != x ? at(top, mirror, c) : 0.0;
    const double bottom_right = mirror != x ? at(bottom, mirror, c) : 0.0;
    const double even_top = at(top, x, c) + top_right;
    const double odd_top = at(top, x, c) - top_right;
    const double even_bottom = at(bottom, x, c) + bottom_right;
    const double odd_bottom = at(bottom, x, c) - bottom_right;
    double* part = parts + c * stride + x;
    part[0] = even_top + even_bottom;
    part[3 * stride] = odd_top + odd_bottom;
    part[6 * stride] = even_top - even_bottom;
    part[9 * stride] = odd_top - odd_bottom;
  }
}

void fold(const float* top, const float* bottom, std::size_t width, double* parts, std::size_t stride) {
  const Wide d;
  std::size_t x = 0;
  for (; bottom != nullptr && x + kLanes <= width / 2; x += kLanes) {
    const std::size_t mirror = width - kLanes - x;
    const Pixels top_left = load_pixels<false>(top + 3 * x);
    const Pixels top_right = load_pixels<true>(top + 3 * mirror);
    const Pixels bottom_left = load_pixels<false>(bottom + 3 * x);
    const Pixels bottom_right = load_pixels<true>(bottom + 3 * mirror);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto even_top = hn::Add(top_left.channel[c], top_right.channel[c]);
      const auto odd_top = hn::Sub(top_left.channel[c], top_right.channel[c]);
      const auto even_bottom = hn::Add(bottom_left.channel[c], bottom_right.channel[c]);
      const auto odd_bottom = hn::Sub(bottom_left.channel[c], bottom_right.channel[c]);
      double* part = parts + c * stride + x;
      hn::StoreU(hn::Add(even_top, even_bottom), d, part);
      hn::StoreU(hn::Add(odd_top, odd_bottom), d, part + 3 * stride);
      hn::StoreU(hn::Sub(even_top, even_bottom), d, part + 6 * stride);
      hn::StoreU(hn::Sub(odd_top, odd_bottom), d, part + 9 * stride);
    }
  }
  for (; x < (width + 1) / 2; ++x) fold_pixel(top, bottom, width, x, parts, stride);
}

/// kCount rows of weights at once: enough sums that they do not wait for themselves.
template <std::size_t kCount>
HWY_INLINE void add_moments_of(const double* weights, const double* channels, std::size_t stride,
                               std::size_t count, double* sums) {
  const Wide d;
  Numbers total[3 * kCount];
  for (std::size_t i = 0; i < 3 * kCount; ++i) total[i] = hn::LoadU(d, sums + i * kSumLanes);
  for (std::size_t k = 0; k < count; k += kLanes) {
    const auto red = hn::LoadU(d, channels + k);
    const auto green = hn::LoadU(d, channels + stride + k);
    const auto blue = hn::LoadU(d, channels + 2 * stride + k);
    for (std::size_t r = 0; r < kCount; ++r) {
      const auto weight = hn::LoadU(d, weights + r * stride + k);
      total[3 * r] = hn::MulAdd(weight, red, total[3 * r]);
      total[3 * r + 1] = hn::MulAdd(weight, green, total[3 * r + 1]);
      total[3 * r + 2] = hn::MulAdd(weight, blue, total[3 * r + 2]);
    }
  }
  for (std::size_t i = 0; i < 3 * kCount; ++i) hn::StoreU(total[i], d, sums + i * kSumLanes);
}

void add_all_moments(const double* weights, std::size_t rows, const double* channels, std::size_t stride,
                     std::size_t count, double* sums) {
  std::size_t r = 0;
  for (; r + 4 <= rows; r += 4) {
    add_moments_of<4>(weights + r * stride, channels, stride, count, sums + 3 * r * kSumLanes);
  }
  if (rows - r == 3)
    add_moments_of<3>(weights + r * stride, channels, stride, count, sums + 3 * r * kSumLanes);
  if (rows - r == 2)
    add_moments_of<2>(weights + r * stride, channels, stride, count, sums + 3 * r * kSumLanes);
  if (rows - r == 1)
    add_moments_of<1>(weights + r * stride, channels, stride, count, sums + 3 * r * kSumLanes);
}

void scale(double* weight, std::size_t blocks, const double* sums) {
  const Wide d;
  for (std::size_t u = 0; u < kBlockDirections; u += kLanes) {
    auto total = hn::Zero(d);
    for (std::size_t b = 0; b < blocks; ++b) {
      total = hn::Add(total, hn::LoadU(d, weight + b * kBlockDirections + u));
    }
    const auto is_zero = hn::Eq(total, hn::Zero(d));
    const auto factor = hn::Div(hn::LoadU(d, sums + u), hn::IfThenElse(is_zero, hn::Set(d, 1.0), total));
    for (std::size_t b = 0; b < blocks; ++b) {
      double* out = weight + b * kBlockDirections + u;
      hn::StoreU(hn::Mul(factor, hn::LoadU(d, out)), d, out);
    }
  }
}

void add_blocks(const double* weight, const double* values, std::size_t blocks, const std::size_t* place,
                std::size_t size, bool is_first, double* table, std::size_t stride) {
  const Wide d;
  constexpr std::size_t kVectors = kBlockDirections / kLanes;
  for (std::size_t i = 0; i < size; ++i) {
    double* out = table + place[i] * stride;
    const double* value = values + i * kBlockDirections;
    Numbers sum[kVectors];
    for (std::size_t u = 0; u < kVectors; ++u) {
      sum[u] = is_first ? hn::Zero(d) : hn::LoadU(d, out + u * kLanes);
    }
    for (std::size_t b = 0; b < blocks; ++b) {
      const double* w = weight + b * kBlockDirections;
      const double* v = value + b * size * kBlockDirections;
      for (std::size_t u = 0; u < kVectors; ++u) {
        sum[u] = hn::MulAdd(hn::LoadU(d, w + u * kLanes), hn::LoadU(d, v + u * kLanes), sum[u]);
      }
    }
    for (std::size_t u = 0; u < kVectors; ++u) hn::StoreU(sum[u], d, out + u * kLanes);
  }
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

HWY_EXPORT(fold);
HWY_EXPORT(moments_of_rows);
HWY_EXPORT(add_all_moments);
HWY_EXPORT(scale);
HWY_EXPORT(add_blocks);
HWY_EXPORT(nodes);

}  // namespace

void fold_rows(const float* top, const float* bottom, std::size_t width, double* parts, std::size_t stride) {
  HWY_DYNAMIC_DISPATCH(fold)(top, bottom, width, parts, stride);
}
void row_moments(const float* const* rows, const RowWeights& weights, double* room, double* out) {
  HWY_DYNAMIC_DISPATCH(moments_of_rows)(rows, weights, room, out);
}
void add_moments(const double* weights, std::size_t rows, const double* channels, std::size_t stride,
                 std::size_t count, double* sums) {
  HWY_DYNAMIC_DISPATCH(add_all_moments)(weights, rows, channels, stride, count, sums);
}
void scale_weights(double* weight, std::size_t blocks, const double* sums) {
  HWY_DYNAMIC_DISPATCH(scale)(weight, blocks, sums);
}
void add_weighted_blocks(const double* weight, const double* values, std::size_t blocks,
                         const std::size_t* place, std::size_t size, bool is_first, double* table,
                         std::size_t stride) {
  HWY_DYNAMIC_DISPATCH(add_blocks)(weight, values, blocks, place, size, is_first, table, stride);
}
void face_nodes(const double* s, const double* ds, double t, double dt, std::size_t count, double* x,
                double* y, double* z, double* weight) {
  HWY_DYNAMIC_DISPATCH(nodes)(s, ds, t, dt, count, x, y, z, weight);
}

}  // namespace plumbline::sh
#endif  // HWY_ONCE
