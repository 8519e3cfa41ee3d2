// The inner loops of batch.hpp. This file is compiled once for each instruction set (foreach_target.h).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prt/sh/batch_kernels.cpp"
// SSE4 adds nothing to SSSE3 here; vectors without a fixed size fit in no array.
#define HWY_DISABLED_TARGETS (HWY_SSE4 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#include <hwy/foreach_target.h>
// foreach_target.h comes first
#include <hwy/highway.h>

#include "prt/sh/batch.hpp"
#include "prt/sh/batch_closed-inl.hpp"
#include "prt/sh/batch_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace plumbline::sh {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

template <class T>
using Tag = hn::CappedTag<T, kBlockDirections>;
template <class T>
using Vec = hn::Vec<Tag<T>>;

template <class T>
constexpr std::size_t kLanes = hn::MaxLanes(Tag<T>());

/// Several vectors at a time hide the recurrence's latency, as many as the registers hold.
template <class T>
constexpr std::size_t kTogether = sizeof(Vec<T>) == 64 ? 4 : 2;

/// kCount vectors of directions and what the recurrence needs of them.
template <class T, std::size_t kCount>
struct Place {
  Vec<T> x[kCount];
  Vec<T> y[kCount];
  Vec<T> t[kCount];     // 1 - |z|
  Vec<T> sign[kCount];  // the sign bit of z
};

template <class T, std::size_t kCount>
HWY_INLINE Place<T, kCount> place_at(const DirectionBlocks<T>& in, std::size_t first) {
  const Tag<T> d;
  const auto one = hn::Set(d, T(1));
  Place<T, kCount> at;
  for (std::size_t u = 0; u < kCount; ++u) {
    const std::size_t k = first + u * kLanes<T>;
    at.x[u] = hn::LoadU(d, in.x + k);
    at.y[u] = hn::LoadU(d, in.y + k);
    const auto z = hn::LoadU(d, in.z + k);
    const auto square = hn::MulAdd(at.x[u], at.x[u], hn::Mul(at.y[u], at.y[u]));
    at.t[u] = hn::Div(square, hn::Add(one, hn::Abs(z)));
    at.sign[u] = hn::And(z, hn::SignBit(d));
  }
  return at;
}

/// (-x - iy)^m, times the scale.
template <class T, std::size_t kCount>
struct Azimuth {
  Vec<T> re[kCount];
  Vec<T> im[kCount];
};

template <class T, std::size_t kCount>
HWY_INLINE void next_azimuth(const Place<T, kCount>& at, Azimuth<T, kCount>& azimuth) {
  for (std::size_t u = 0; u < kCount; ++u) {
    const auto re = azimuth.re[u];
    const auto im = azimuth.im[u];
    azimuth.re[u] = hn::NegMulAdd(at.x[u], re, hn::Mul(at.y[u], im));
    azimuth.im[u] = hn::Neg(hn::MulAdd(at.x[u], im, hn::Mul(at.y[u], re)));
  }
}

/// The azimuth of odd l - m: with the sign of z.
template <class T, std::size_t kCount>
HWY_INLINE Azimuth<T, kCount> signed_azimuth(const Place<T, kCount>& at, const Azimuth<T, kCount>& azimuth) {
  Azimuth<T, kCount> result;
  for (std::size_t u = 0; u < kCount; ++u) {
    result.re[u] = hn::Xor(azimuth.re[u], at.sign[u]);
    result.im[u] = hn::Xor(azimuth.im[u], at.sign[u]);
  }
  return result;
}

/// q_l^m(|z|) of one column and its difference.
template <class T, std::size_t kCount>
struct Column {
  Vec<T> q[kCount];
  Vec<T> difference[kCount];
};

template <class T, std::size_t kCount>
HWY_INLINE Column<T, kCount> start_column(T start) {
  const Tag<T> d;
  Column<T, kCount> column;
  for (std::size_t u = 0; u < kCount; ++u) {
    column.q[u] = hn::Set(d, start);
    column.difference[u] = hn::Zero(d);
  }
  return column;
}

template <class T, std::size_t kCount>
HWY_INLINE void next_degree(const Place<T, kCount>& at, const T* step, Column<T, kCount>& column) {
  const Tag<T> d;
  const auto alpha = hn::Set(d, step[0]);
  const auto beta = hn::Set(d, step[1]);
  const auto gamma = hn::Set(d, step[2]);
  for (std::size_t u = 0; u < kCount; ++u) {
    column.difference[u] =
        hn::NegMulAdd(hn::Mul(beta, at.t[u]), column.q[u], hn::Mul(alpha, column.difference[u]));
    column.q[u] = hn::MulAdd(gamma, column.q[u], column.difference[u]);
  }
}

template <bool kIsPair, class T, std::size_t kCount>
HWY_INLINE void store_degree(const Column<T, kCount>& column, const Azimuth<T, kCount>& azimuth,
                             std::size_t centre, std::size_t m, T* const* out) {
  const Tag<T> d;
  for (std::size_t u = 0; u < kCount; ++u) {
    hn::StoreU(hn::Mul(column.q[u], azimuth.re[u]), d, out[u] + (centre + m) * kBlockDirections);
    if constexpr (kIsPair) {
      hn::StoreU(hn::Mul(column.q[u], azimuth.im[u]), d, out[u] + (centre - m) * kBlockDirections);
    }
  }
}

/// Degrees m … n-1 of column m, two at a time: those of even l - m, and of odd with the sign of z.
template <bool kIsPair, class T, std::size_t kCount>
HWY_INLINE void store_column(const RecurrenceTable<T>& table, const Place<T, kCount>& at,
                             const Azimuth<T, kCount>& azimuth, std::size_t m, const T* step, T* const* out) {
  const Azimuth<T, kCount> odd = signed_azimuth(at, azimuth);
  Column<T, kCount> column = start_column<T, kCount>(table.starts[m]);
  const auto bands = static_cast<std::size_t>(table.bands);
  for (std::size_t l = m;;) {
    store_degree<kIsPair>(column, azimuth, l * (l + 1), m, out);
    if (++l == bands) return;
    next_degree(at, step, column);
    store_degree<kIsPair>(column, odd, l * (l + 1), m, out);
    if (++l == bands) return;
    next_degree(at, step + 3, column);
    step += 6;
  }
}

template <class T, std::size_t kCount>
HWY_INLINE Azimuth<T, kCount> start_azimuth(T scale) {
  const Tag<T> d;
  Azimuth<T, kCount> azimuth;
  for (std::size_t u = 0; u < kCount; ++u) {
    azimuth.re[u] = hn::Set(d, scale);
    azimuth.im[u] = hn::Zero(d);
  }
  return azimuth;
}

template <std::size_t kCount, class T>
void store_recurrence(const RecurrenceTable<T>& table, const DirectionBlocks<T>& in, std::size_t first,
                      T* out) {
  const auto bands = static_cast<std::size_t>(table.bands);
  T* places[kCount];
  for (std::size_t u = 0; u < kCount; ++u)
    places[u] = out + blocked_index(table.bands, first + u * kLanes<T>, 0);
  const Place<T, kCount> at = place_at<T, kCount>(in, first);
  Azimuth<T, kCount> azimuth = start_azimuth<T, kCount>(table.scale);
  const T* steps = table.steps.data();
  store_column<false>(table, at, azimuth, 0, steps, places);
  for (std::size_t m = 1; m < bands; ++m) {
    steps += 3 * (bands - m);
    next_azimuth(at, azimuth);
    store_column<true>(table, at, azimuth, m, steps, places);
  }
}

// The same as straight-line code: the short loops of few bands end in a branch that nobody foresees.

/// Degrees kL … kBands-1 of column kM, whose constants start at `step`.
template <int kBands, int kM, int kL, class T, std::size_t kCount>
HWY_INLINE void store_unrolled_degrees(const Place<T, kCount>& at, const Azimuth<T, kCount>& azimuth,
                                       const Azimuth<T, kCount>& odd, const T* step,
                                       Column<T, kCount>& column, T* const* out) {
  store_degree<(kM > 0)>(column, (kL - kM) % 2 == 0 ? azimuth : odd, kL * (kL + 1), kM, out);
  if constexpr (kL + 1 < kBands) {
    next_degree(at, step, column);
    store_unrolled_degrees<kBands, kM, kL + 1>(at, azimuth, odd, step + 3, column, out);
  }
}

template <int kBands, int kM, class T, std::size_t kCount>
HWY_INLINE void store_unrolled_columns(const RecurrenceTable<T>& table, const Place<T, kCount>& at,
                                       Azimuth<T, kCount>& azimuth, const T* steps, T* const* out) {
  if constexpr (kM > 0) next_azimuth(at, azimuth);
  const Azimuth<T, kCount> odd = signed_azimuth(at, azimuth);
  Column<T, kCount> column = start_column<T, kCount>(table.starts[kM]);
  store_unrolled_degrees<kBands, kM, kM>(at, azimuth, odd, steps, column, out);
  if constexpr (kM + 1 < kBands) {
    store_unrolled_columns<kBands, kM + 1>(table, at, azimuth, steps + 3 * (kBands - 1 - kM), out);
  }
}

template <int kBands, std::size_t kCount, class T>
HWY_NOINLINE void store_unrolled(const RecurrenceTable<T>& table, const DirectionBlocks<T>& in,
                                 std::size_t first, T* out) {
  T* places[kCount];
  for (std::size_t u = 0; u < kCount; ++u) places[u] = out + blocked_index(kBands, first + u * kLanes<T>, 0);
  const Place<T, kCount> at = place_at<T, kCount>(in, first);
  Azimuth<T, kCount> azimuth = start_azimuth<T, kCount>(table.scale);
  store_unrolled_columns<kBands, 0>(table, at, azimuth, table.steps.data(), places);
}

/// Calls wide(first) for groups of kTogether vectors and narrow(first) for the vectors left over.
template <class T, class Wide, class Narrow>
HWY_INLINE void for_vectors(std::size_t count, const Wide& wide, const Narrow& narrow) {
  constexpr std::size_t kGroup = kTogether<T> * kLanes<T>;
  std::size_t k = 0;
  for (; k + kGroup <= count; k += kGroup) wide(k);
  for (; k < count; k += kLanes<T>) narrow(k);
}

template <int kBands, class T>
void store_few(const RecurrenceTable<T>& table, const DirectionBlocks<T>& in, T* out) {
  for_vectors<T>(
      in.count, [&](std::size_t k) { store_unrolled<kBands, kTogether<T>>(table, in, k, out); },
      [&](std::size_t k) { store_unrolled<kBands, 1>(table, in, k, out); });
}

/// What closed forms give their values to: the blocked layout.
template <class T>
struct Store {
  T* out;
  HWY_INLINE void operator()(std::size_t i, Vec<T> value) const {
    hn::StoreU(value, Tag<T>(), out + i * kBlockDirections);
  }
};

template <int kBands, class T>
void store_closed(const DirectionBlocks<T>& in, T* out) {
  const Tag<T> d;
  for (std::size_t k = 0; k < in.count; k += kLanes<T>) {
    evaluate_closed<kBands>(d, hn::LoadU(d, in.x + k), hn::LoadU(d, in.y + k), hn::LoadU(d, in.z + k),
                            Store<T>{out + blocked_index(kBands, k, 0)});
  }
}

template <class T>
void evaluate_blocks_of(const RecurrenceTable<T>& table, const DirectionBlocks<T>& in, T* out) {
  switch (table.bands) {
    case 1:
      return store_closed<1>(in, out);
    case 2:
      return store_closed<2>(in, out);
    case 3:
      return store_closed<3>(in, out);
    case 4:
      return store_closed<4>(in, out);
    case 5:
      return store_closed<5>(in, out);
    case 6:
      return store_few<6>(table, in, out);
    case 7:
      return store_few<7>(table, in, out);
    case 8:
      return store_few<8>(table, in, out);
    default:
      return for_vectors<T>(
          in.count, [&](std::size_t k) { store_recurrence<kTogether<T>>(table, in, k, out); },
          [&](std::size_t k) { store_recurrence<1>(table, in, k, out); });
  }
}

// ---------------------------------------------------------------- sums over all coefficients

/// What closed forms give their values to: three sums.
template <class T>
struct Accumulate {
  const T* coefficients;
  Vec<T>* sums;
  HWY_INLINE void operator()(std::size_t i, Vec<T> value) const {
    const Tag<T> d;
    for (std::size_t c = 0; c < 3; ++c) {
      sums[c] = hn::MulAdd(hn::Set(d, coefficients[3 * i + c]), value, sums[c]);
    }
  }
};

template <int kBands, class T>
void sum_closed(const T* coefficients, const DirectionBlocks<T>& in, T* const* out) {
  const Tag<T> d;
  for (std::size_t k = 0; k < in.count; k += kLanes<T>) {
    Vec<T> sums[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    evaluate_closed<kBands>(d, hn::LoadU(d, in.x + k), hn::LoadU(d, in.y + k), hn::LoadU(d, in.z + k),
                            Accumulate<T>{coefficients, sums});
    for (std::size_t c = 0; c < 3; ++c) hn::StoreU(sums[c], d, out[c] + k);
  }
}

/// sums[c] += c_lm q, and for pairs sums[3 + c] += c_l,-m q.
template <bool kIsPair, class T>
HWY_INLINE void add_degree(Vec<T> q, const T* coefficients, Vec<T>* sums) {
  const Tag<T> d;
  for (std::size_t c = 0; c < (kIsPair ? 6 : 3); ++c) {
    sums[c] = hn::MulAdd(hn::Set(d, coefficients[c]), q, sums[c]);
  }
}

/// Adds column m to the three sums; returns where the coefficients of the next one are.
template <bool kIsPair, class T>
HWY_INLINE const T* add_column(const RecurrenceTable<T>& table, const Place<T, 1>& at,
                               const Azimuth<T, 1>& azimuth, std::size_t m, const T* step,
                               const T* coefficients, Vec<T>* totals) {
  constexpr std::size_t kWidth = kIsPair ? 6 : 3;
  const Tag<T> d;
  Vec<T> sums[6] = {hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  Column<T, 1> column = start_column<T, 1>(table.starts[m]);
  const auto bands = static_cast<std::size_t>(table.bands);
  for (std::size_t l = m;;) {
    add_degree<kIsPair>(column.q[0], coefficients, sums);
    coefficients += kWidth;
    if (++l == bands) break;
    next_degree(at, step, column);
    add_degree<kIsPair>(hn::Xor(column.q[0], at.sign[0]), coefficients, sums);
    coefficients += kWidth;
    if (++l == bands) break;
    next_degree(at, step + 3, column);
    step += 6;
  }
  for (std::size_t c = 0; c < 3; ++c) {
    totals[c] = hn::MulAdd(sums[c], azimuth.re[0], totals[c]);
    if constexpr (kIsPair) totals[c] = hn::MulAdd(sums[3 + c], azimuth.im[0], totals[c]);
  }
  return coefficients;
}

template <class T>
void sum_recurrence(const RecurrenceTable<T>& table, const T* coefficients, const DirectionBlocks<T>& in,
                    std::size_t first, T* const* out) {
  const Tag<T> d;
  const auto bands = static_cast<std::size_t>(table.bands);
  const Place<T, 1> at = place_at<T, 1>(in, first);
  Azimuth<T, 1> azimuth = start_azimuth<T, 1>(table.scale);
  Vec<T> totals[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  const T* steps = table.steps.data();
  coefficients = add_column<false>(table, at, azimuth, 0, steps, coefficients, totals);
  for (std::size_t m = 1; m < bands; ++m) {
    steps += 3 * (bands - m);
    next_azimuth(at, azimuth);
    coefficients = add_column<true>(table, at, azimuth, m, steps, coefficients, totals);
  }
  for (std::size_t c = 0; c < 3; ++c) hn::StoreU(totals[c], d, out[c] + first);
}

template <class T>
void sum_blocks_of(const RecurrenceTable<T>& table, const T* coefficients, const DirectionBlocks<T>& in,
                   T* const* out) {
  switch (table.bands) {
    case 1:
      return sum_closed<1>(coefficients, in, out);
    case 2:
      return sum_closed<2>(coefficients, in, out);
    case 3:
      return sum_closed<3>(coefficients, in, out);
    case 4:
      return sum_closed<4>(coefficients, in, out);
    case 5:
      return sum_closed<5>(coefficients, in, out);
    default:
      for (std::size_t k = 0; k < in.count; k += kLanes<T>) sum_recurrence(table, coefficients, in, k, out);
  }
}

// ---------------------------------------------------------------- one block, turned
//
// Vectors are put together from 16-byte pieces, so that a transposition inside each piece leaves as many consecutive
// coefficients of one direction as a vector holds.

#if HWY_TARGET != HWY_SCALAR
/// The pieces at in, in + stride, … as one vector.
template <class D, class T = hn::TFromD<D>>
HWY_INLINE hn::Vec<D> gather_pieces(D d, const T* in, std::size_t stride) {
  if constexpr (hn::MaxLanes(D()) * sizeof(T) <= 16) {
    (void)stride;
    return hn::LoadU(d, in);
  } else {
    const hn::Half<D> half;
    constexpr std::size_t kHalfPieces = hn::MaxLanes(hn::Half<D>()) * sizeof(T) / 16;
    return hn::Combine(d, gather_pieces(half, in + kHalfPieces * stride, stride),
                       gather_pieces(half, in, stride));
  }
}

/// As many coefficients from `in` on as d has lanes, of the 4 directions from there on, to rows `out`.
template <class D>
HWY_INLINE void transpose_pieces(D d, const float* in, float* const* out) {
  const hn::Repartition<double, D> wide;
  constexpr std::size_t kStride = 4 * kBlockDirections;
  const auto a0 = gather_pieces(d, in, kStride);
  const auto a1 = gather_pieces(d, in + kBlockDirections, kStride);
  const auto a2 = gather_pieces(d, in + 2 * kBlockDirections, kStride);
  const auto a3 = gather_pieces(d, in + 3 * kBlockDirections, kStride);
  const auto low01 = hn::BitCast(wide, hn::InterleaveLower(d, a0, a1));
  const auto low23 = hn::BitCast(wide, hn::InterleaveLower(d, a2, a3));
  const auto high01 = hn::BitCast(wide, hn::InterleaveUpper(d, a0, a1));
  const auto high23 = hn::BitCast(wide, hn::InterleaveUpper(d, a2, a3));
  hn::StoreU(hn::BitCast(d, hn::InterleaveLower(wide, low01, low23)), d, out[0]);
  hn::StoreU(hn::BitCast(d, hn::InterleaveUpper(wide, low01, low23)), d, out[1]);
  hn::StoreU(hn::BitCast(d, hn::InterleaveLower(wide, high01, high23)), d, out[2]);
  hn::StoreU(hn::BitCast(d, hn::InterleaveUpper(wide, high01, high23)), d, out[3]);
}

/// The same of 2 directions.
template <class D>
HWY_INLINE void transpose_pieces(D d, const double* in, double* const* out) {
  constexpr std::size_t kStride = 2 * kBlockDirections;
  const auto a0 = gather_pieces(d, in, kStride);
  const auto a1 = gather_pieces(d, in + kBlockDirections, kStride);
  hn::StoreU(hn::InterleaveLower(d, a0, a1), d, out[0]);
  hn::StoreU(hn::InterleaveUpper(d, a0, a1), d, out[1]);
}

/// Whole blocks; the last group of coefficients overlaps the one before. size >= lanes of d.
template <class D, class T = hn::TFromD<D>>
HWY_INLINE void transpose_in_groups(D d, const T* block, std::size_t size, T* out) {
  constexpr std::size_t kGroup = hn::MaxLanes(D());
  constexpr std::size_t kRows = 16 / sizeof(T);
  for (std::size_t k = 0; k < kBlockDirections; k += kRows) {
    for (std::size_t i = 0;; i += kGroup) {
      const std::size_t first = i + kGroup <= size ? i : size - kGroup;
      T* rows[kRows];
      for (std::size_t r = 0; r < kRows; ++r) rows[r] = out + (k + r) * size + first;
      transpose_pieces(d, block + first * kBlockDirections + k, rows);
      if (first + kGroup == size) break;
    }
  }
}
#endif

template <class T>
void transpose_block_of(const T* block, std::size_t size, std::size_t rows, T* out) {
  const bool is_scalar = HWY_TARGET == HWY_SCALAR;
  if (is_scalar || rows < kBlockDirections || size < 16 / sizeof(T)) {
    for (std::size_t k = 0; k < rows; ++k) {
      for (std::size_t i = 0; i < size; ++i) out[k * size + i] = block[i * kBlockDirections + k];
    }
    return;
  }
#if HWY_TARGET != HWY_SCALAR
  if (size >= kLanes<T>) return transpose_in_groups(Tag<T>(), block, size, out);
  if (size >= 8) return transpose_in_groups(hn::CappedTag<T, 8>(), block, size, out);
  transpose_in_groups(hn::CappedTag<T, 4>(), block, size, out);
#endif
}

// ---------------------------------------------------------------- entry points: no templates across the dispatch

void evaluate_f32(const RecurrenceTable<float>& table, const DirectionBlocks<float>& in, float* out) {
  evaluate_blocks_of(table, in, out);
}
void evaluate_f64(const RecurrenceTable<double>& table, const DirectionBlocks<double>& in, double* out) {
  evaluate_blocks_of(table, in, out);
}
void transpose_f32(const float* block, std::size_t size, std::size_t rows, float* out) {
  transpose_block_of(block, size, rows, out);
}
void transpose_f64(const double* block, std::size_t size, std::size_t rows, double* out) {
  transpose_block_of(block, size, rows, out);
}
void sum_f32(const RecurrenceTable<float>& table, const float* coefficients, const DirectionBlocks<float>& in,
             float* const* out) {
  sum_blocks_of(table, coefficients, in, out);
}
void sum_f64(const RecurrenceTable<double>& table, const double* coefficients,
             const DirectionBlocks<double>& in, double* const* out) {
  sum_blocks_of(table, coefficients, in, out);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace plumbline::sh
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plumbline::sh {
namespace {

HWY_EXPORT(evaluate_f32);
HWY_EXPORT(evaluate_f64);
HWY_EXPORT(transpose_f32);
HWY_EXPORT(transpose_f64);
HWY_EXPORT(sum_f32);
HWY_EXPORT(sum_f64);

}  // namespace

void evaluate_blocks(const RecurrenceTable<float>& table, const DirectionBlocks<float>& in, float* out) {
  HWY_DYNAMIC_DISPATCH(evaluate_f32)(table, in, out);
}
void evaluate_blocks(const RecurrenceTable<double>& table, const DirectionBlocks<double>& in, double* out) {
  HWY_DYNAMIC_DISPATCH(evaluate_f64)(table, in, out);
}
void transpose_block(const float* block, std::size_t size, std::size_t rows, float* out) {
  HWY_DYNAMIC_DISPATCH(transpose_f32)(block, size, rows, out);
}
void transpose_block(const double* block, std::size_t size, std::size_t rows, double* out) {
  HWY_DYNAMIC_DISPATCH(transpose_f64)(block, size, rows, out);
}
void sum_blocks(const RecurrenceTable<float>& table, const float* coefficients,
                const DirectionBlocks<float>& in, float* const* out) {
  HWY_DYNAMIC_DISPATCH(sum_f32)(table, coefficients, in, out);
}
void sum_blocks(const RecurrenceTable<double>& table, const double* coefficients,
                const DirectionBlocks<double>& in, double* const* out) {
  HWY_DYNAMIC_DISPATCH(sum_f64)(table, coefficients, in, out);
}

}  // namespace plumbline::sh
#endif  // HWY_ONCE
