#include "prt/sh/rotator_kernels.hpp"

// One 128-bit, one 256-bit and one 512-bit set: the kernels need no more than arithmetic and loads.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prt/sh/rotator_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace plumbline::sh::rotator::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr int place(int l, int m) {
  return l * (l + 1) + m;
}

/// Adds degree kL's part of column kM, p = p_lm(z) and previous = p_(l-1)m, and goes on to degree kL + 1.
template <int kBands, int kM, int kL, class D, class V>
HWY_INLINE void add_column(D d, const float* beta, const float* scaled, V re, V im, V z, V previous, V p,
                           V* sums) {
  if constexpr (kL < kBands) {
    if constexpr (kL > 0) {
      V t = hn::Set(d, scaled[place(kL, kM)]);
      if constexpr (kM > 0) t = hn::MulAdd(t, re, hn::Mul(hn::Set(d, scaled[place(kL, -kM)]), im));
      if constexpr (kM == 0) {
        sums[kL] = hn::Mul(p, t);
      } else if constexpr (kL == kM) {
        sums[kL] = hn::Add(sums[kL], t);
      } else {
        sums[kL] = hn::MulAdd(p, t, sums[kL]);
      }
    }
    V next = z;
    if constexpr (kL > kM && kL + 1 < kBands) {
      next = hn::NegMulAdd(hn::Set(d, beta[place(kL + 1, kM)]), previous, hn::Mul(z, p));
    }
    add_column<kBands, kM, kL + 1>(d, beta, scaled, re, im, z, p, next, sums);
  }
}

template <int kBands, int kM, class D, class V>
HWY_INLINE void add_columns(D d, const float* beta, const float* scaled, V x, V y, V z, V re, V im, V* sums) {
  if constexpr (kM < kBands) {
    const V one = hn::Set(d, 1.0F);
    add_column<kBands, kM, kM>(d, beta, scaled, re, im, z, one, one, sums);
    const V next_re = kM == 0 ? x : hn::NegMulAdd(y, im, hn::Mul(x, re));
    const V next_im = kM == 0 ? y : hn::MulAdd(x, im, hn::Mul(y, re));
    add_columns<kBands, kM + 1>(d, beta, scaled, x, y, z, next_re, next_im, sums);
  }
}

/// Evaluates degrees 1 … kBands-1 of the function in one vector of directions: sum over m of
/// p_lm(z) (f_lm Re + f_l,-m Im)(x + iy)^m with monic p_lm = z p_(l-1)m - beta_lm p_(l-2)m.
/// Templates, not loops, so that the sums stay in registers.
template <int kBands, class D, class V>
HWY_INLINE void evaluate_degrees(D d, const float* beta, const float* scaled, V x, V y, V z, float* values) {
  V sums[kBands];
  add_columns<kBands, 0>(d, beta, scaled, x, y, z, z, z, sums);
  for (int l = 1; l < kBands; ++l) hn::StoreU(sums[l], d, values + l * kSamples);
}

/// Degree l's coefficients: the constant matrix times the values. `last`: nothing behind may be written.
template <int kL, bool kIsLast>
HWY_INLINE void coefficients_of_degree(const float* table, const float* values, float* out) {
  constexpr int kWidth = result_width(kL);
  const hn::CappedTag<float, kWidth> d;
  constexpr int kCount = 2 * kL + 1;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const float* columns = table + columns_start(kL);
  for (int lane = 0; lane < kCount; lane += lanes) {
    auto even = hn::Mul(hn::Set(d, values[0]), hn::LoadU(d, columns + lane));
    auto odd = hn::Mul(hn::Set(d, values[1]), hn::LoadU(d, columns + kWidth + lane));
    for (int k = 2; k < kCount; k += 2) {
      even = hn::MulAdd(hn::Set(d, values[k]), hn::LoadU(d, columns + k * kWidth + lane), even);
      if (k + 1 == kCount) break;
      odd = hn::MulAdd(hn::Set(d, values[k + 1]), hn::LoadU(d, columns + (k + 1) * kWidth + lane), odd);
    }
    const auto result = hn::Add(even, odd);
    if (kIsLast && lane + lanes > kCount) {
      hn::BlendedStore(result, hn::FirstN(d, static_cast<std::size_t>(kCount - lane)), d,
                       out + kL * kL + lane);
    } else {
      hn::StoreU(result, d, out + kL * kL + lane);
    }
  }
}

template <int kBands, int kL>
HWY_INLINE void coefficients_from_degree(const float* table, const float* values, float* out) {
  if constexpr (kL < kBands) {
    coefficients_of_degree<kL, kL + 1 == kBands>(table, values + kL * kSamples, out);
    coefficients_from_degree<kBands, kL + 1>(table, values, out);
  }
}

template <int kBands>
HWY_INLINE void rotate_sampled(const float* table, const float* r, const float* in, float* out) {
  constexpr int kUsed = 2 * kBands - 1;
  const hn::CappedTag<float, kUsed <= 8 ? 8 : 16> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  HWY_ALIGN float scaled[64];
  for (int i = 1; i < kBands * kBands; ++i) scaled[i] = table[kScales + i] * in[i];
  HWY_ALIGN float values[kBands * kSamples];
  for (int first = 0; first < kUsed; first += lanes) {
    const auto dx = hn::LoadU(d, table + first);
    const auto dy = hn::LoadU(d, table + kSamples + first);
    const auto dz = hn::LoadU(d, table + 2 * kSamples + first);
    const auto back = [&](int axis) HWY_ATTR {  // (R^T direction)[axis]
      const auto yz = hn::MulAdd(hn::Set(d, r[3 + axis]), dy, hn::Mul(hn::Set(d, r[6 + axis]), dz));
      return hn::MulAdd(hn::Set(d, r[axis]), dx, yz);
    };
    evaluate_degrees<kBands>(d, table + kRecurrence, scaled, back(0), back(1), back(2), values + first);
  }
  out[0] = in[0];
  coefficients_from_degree<kBands, 1>(table, values, out);
}

void sampled(int bands, const float* table, const float* matrix, const float* in, float* out) {
  switch (bands) {
    case 2:
      return rotate_sampled<2>(table, matrix, in, out);
    case 3:
      return rotate_sampled<3>(table, matrix, in, out);
    case 4:
      return rotate_sampled<4>(table, matrix, in, out);
    case 5:
      return rotate_sampled<5>(table, matrix, in, out);
    case 6:
      return rotate_sampled<6>(table, matrix, in, out);
    case 7:
      return rotate_sampled<7>(table, matrix, in, out);
    default:
      return rotate_sampled<8>(table, matrix, in, out);
  }
}

// ---------------------------------------------------------------- exchange

/// Rows turn in pairs, cosines with sines: rows 0 and 2, rows 1 and 3. turn: four rows of `stride`.
template <class Real>
HWY_INLINE void turn_about_z(int width, int stride, const Real* turn, Real* rows) {
  const hn::CappedTag<Real, kRowStep> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  for (int row = 0; row < 2; ++row) {
    const Real* cosine = turn + row * stride;
    const Real* sine = turn + (row + 2) * stride;
    Real* even = rows + row * width;
    Real* odd = rows + (row + 2) * width;
    for (int i = 0; i < width; i += lanes) {
      const auto c = hn::LoadU(d, cosine + i);
      const auto s = hn::LoadU(d, sine + i);
      const auto a = hn::LoadU(d, even + i);
      const auto b = hn::LoadU(d, odd + i);
      hn::StoreU(hn::NegMulAdd(s, b, hn::Mul(c, a)), d, even + i);
      hn::StoreU(hn::MulAdd(s, a, hn::Mul(c, b)), d, odd + i);
    }
  }
}

/// to[:] = sum over columns of block[column][:] * from[column].
template <class Real>
HWY_INLINE void multiply_block(int columns, int width, const Real* block, const Real* from, Real* to) {
  const hn::CappedTag<Real, kRowStep> d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  for (int i = 0; i < width; i += lanes) {
    auto even = hn::Zero(d);
    auto odd = hn::Zero(d);
    int k = 0;
    for (; k + 1 < columns; k += 2) {
      even = hn::MulAdd(hn::Set(d, from[k]), hn::LoadU(d, block + k * width + i), even);
      odd = hn::MulAdd(hn::Set(d, from[k + 1]), hn::LoadU(d, block + (k + 1) * width + i), odd);
    }
    if (k < columns) even = hn::MulAdd(hn::Set(d, from[k]), hn::LoadU(d, block + k * width + i), even);
    hn::StoreU(hn::Add(even, odd), d, to + i);
  }
}

template <class Real>
HWY_INLINE void exchange_axes(int l, const Real* block, const Real* from, Real* to) {
  const int width = row_width(l);
  for (int row = 0; row < 4; ++row) {
    const int columns = row_size(l, row);
    multiply_block(columns, width, block, from + row * width, to + exchanged_row(l, row) * width);
    block += columns * width;
  }
}

template <class Real>
HWY_INLINE void split_rows(int l, const Real* in, Real* rows) {
  const int width = row_width(l);
  for (int i = 0; i < 4 * width; ++i) rows[i] = Real(0);
  const Real* centre = in + place(l, 0);
  for (int j = 0; 2 * j <= l; ++j) rows[j] = centre[2 * j];
  for (int j = 0; 2 * j + 1 <= l; ++j) rows[width + j] = centre[2 * j + 1];
  for (int j = 1; 2 * j <= l; ++j) rows[2 * width + j] = centre[-2 * j];
  for (int j = 0; 2 * j + 1 <= l; ++j) rows[3 * width + j] = centre[-2 * j - 1];
}

template <class Real>
HWY_INLINE void join_rows(int l, const Real* rows, Real* out) {
  const int width = row_width(l);
  Real* centre = out + place(l, 0);
  for (int j = 0; 2 * j <= l; ++j) centre[2 * j] = rows[j];
  for (int j = 0; 2 * j + 1 <= l; ++j) centre[2 * j + 1] = rows[width + j];
  for (int j = 1; 2 * j <= l; ++j) centre[-2 * j] = rows[2 * width + j];
  for (int j = 0; 2 * j + 1 <= l; ++j) centre[-2 * j - 1] = rows[3 * width + j];
}

template <class Real>
HWY_INLINE void exchanged(int bands, const Real* exchange, const Real* turns, const Real* in, Real* out,
                          Real* scratch) {
  const int stride = row_width(bands - 1);
  Real* a = scratch;
  Real* b = scratch + 4 * stride;
  out[0] = in[0];
  for (int l = 1; l < bands; ++l) {
    split_rows(l, in, a);
    turn_about_z(row_width(l), stride, turns, a);
    exchange_axes(l, exchange, a, b);
    turn_about_z(row_width(l), stride, turns + 4 * stride, b);
    exchange_axes(l, exchange, b, a);
    turn_about_z(row_width(l), stride, turns + 8 * stride, a);
    join_rows(l, a, out);
    exchange += exchange_size(l);
  }
}

void exchanged_f32(int bands, const float* exchange, const float* turns, const float* in, float* out,
                   float* scratch) {
  exchanged(bands, exchange, turns, in, out, scratch);
}
void exchanged_f64(int bands, const double* exchange, const double* turns, const double* in, double* out,
                   double* scratch) {
  exchanged(bands, exchange, turns, in, out, scratch);
}

// ---------------------------------------------------------------- many functions

template <int kRows, class D>
HWY_INLINE void multiply_rows(D d, int size, const float* block, std::size_t count, const float* in,
                              float* out) {
  hn::Vec<D> sums[kRows];
  for (auto& sum : sums) sum = hn::Zero(d);
  for (int column = 0; column < size; ++column) {
    const auto x = hn::LoadU(d, in + static_cast<std::size_t>(column) * count);
    for (int row = 0; row < kRows; ++row) {
      sums[row] = hn::MulAdd(hn::Set(d, block[row * size + column]), x, sums[row]);
    }
  }
  for (int row = 0; row < kRows; ++row) hn::StoreU(sums[row], d, out + static_cast<std::size_t>(row) * count);
}

template <class D>
HWY_INLINE void multiply_degrees(D d, int bands, const float* block, std::size_t count, const float* in,
                                 float* out) {
  for (int size = 1; size < 2 * bands; size += 2) {
    const auto step = static_cast<std::size_t>(size) * count;
    float* to = out;
    int row = 0;
    for (; row + 4 <= size; row += 4, block += 4 * size, to += 4 * count) {
      multiply_rows<4>(d, size, block, count, in, to);
    }
    for (; row < size; ++row, block += size, to += count) multiply_rows<1>(d, size, block, count, in, to);
    in += step;
    out += step;
  }
}

void many(int bands, const float* blocks, std::size_t count, const float* in, float* out) {
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t v = 0;
  for (; v + lanes <= count; v += lanes) multiply_degrees(d, bands, blocks, count, in + v, out + v);
  const hn::CappedTag<float, 1> one;
  for (; v < count; ++v) multiply_degrees(one, bands, blocks, count, in + v, out + v);
}

}  // namespace plumbline::sh::rotator::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace plumbline::sh::rotator {

HWY_EXPORT(sampled);
HWY_EXPORT(exchanged_f32);
HWY_EXPORT(exchanged_f64);
HWY_EXPORT(many);

void rotate_by_samples(int bands, const float* table, const float* matrix, const float* in, float* out) {
  HWY_DYNAMIC_DISPATCH(sampled)(bands, table, matrix, in, out);
}

void rotate_by_exchange(int bands, const float* exchange, const float* turns, const float* in, float* out,
                        float* scratch) {
  HWY_DYNAMIC_DISPATCH(exchanged_f32)(bands, exchange, turns, in, out, scratch);
}

void rotate_by_exchange(int bands, const double* exchange, const double* turns, const double* in, double* out,
                        double* scratch) {
  HWY_DYNAMIC_DISPATCH(exchanged_f64)(bands, exchange, turns, in, out, scratch);
}

void apply_blocks_to_many(int bands, const float* blocks, std::size_t count, const float* in, float* out) {
  HWY_DYNAMIC_DISPATCH(many)(bands, blocks, count, in, out);
}

}  // namespace plumbline::sh::rotator

#endif  // HWY_ONCE
