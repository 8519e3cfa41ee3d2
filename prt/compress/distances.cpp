#include "prt/compress/distances.hpp"

#include <algorithm>
#include <limits>

// One 128-bit, one 256-bit and one 512-bit set: the kernel needs no more than arithmetic and loads.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prt/compress/distances.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace plumbline::compress::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kRows = 4;

/// One chunk of columns of one vector of subspaces, for kCount rows: sums in registers, then subtracted from `distances`.
template <std::size_t kCount, class D>
HWY_INLINE void subtract_chunk(D d, std::size_t dimension, const float* columns, const float* offsets,
                               bool has_mean, const float* x, std::size_t stride, float* distances) {
  using V = hn::Vec<D>;
  V sums[kCount][kColumns];
  for (auto& row : sums) {
    for (V& sum : row) sum = hn::Zero(d);
  }
  for (std::size_t i = 0; i < dimension; ++i, columns += kColumns * kGroup) {
    for (std::size_t c = 0; c < kColumns; ++c) {
      const V column = hn::LoadU(d, columns + c * kGroup);
      for (std::size_t r = 0; r < kCount; ++r) {
        sums[r][c] = hn::MulAdd(hn::Set(d, x[r * dimension + i]), column, sums[r][c]);
      }
    }
  }
  for (std::size_t r = 0; r < kCount; ++r) {
    V distance = hn::LoadU(d, distances + r * stride);
    for (std::size_t c = 0; c < kColumns; ++c) {
      const V sum = hn::Sub(sums[r][c], hn::LoadU(d, offsets + c * kGroup));
      distance = has_mean && c == 0 ? hn::NegMulAdd(hn::Set(d, 2.0F), sum, distance)
                                    : hn::NegMulAdd(sum, sum, distance);
    }
    hn::StoreU(distance, d, distances + r * stride);
  }
}

template <std::size_t kCount>
HWY_INLINE void distances_of(const SubspaceTable& table, std::size_t group, const float* x,
                             float* distances) {
  const hn::CappedTag<float, kGroup> d;
  const std::size_t stride = table.groups * kGroup;
  for (std::size_t r = 0; r < kCount; ++r) {
    std::copy_n(table.squares.data() + group * kGroup, kGroup, distances + r * stride + group * kGroup);
  }
  for (std::size_t chunk = 0; chunk < table.chunks; ++chunk) {
    const std::size_t at = (group * table.chunks + chunk) * kColumns * kGroup;
    for (std::size_t lane = 0; lane < kGroup; lane += hn::Lanes(d)) {
      subtract_chunk<kCount>(d, table.dimension, table.columns.data() + at * table.dimension + lane,
                             table.offsets.data() + at + lane, chunk == 0, x, stride,
                             distances + group * kGroup + lane);
    }
  }
}

void all_distances(const SubspaceTable& table, const float* x, std::size_t rows, float* distances) {
  const std::size_t stride = table.groups * kGroup;
  for (std::size_t group = 0; group < table.groups; ++group) {  // a group's columns stay in the cache
    std::size_t r = 0;
    for (; r + kRows <= rows; r += kRows) {
      distances_of<kRows>(table, group, x + r * table.dimension, distances + r * stride);
    }
    for (; r < rows; ++r) distances_of<1>(table, group, x + r * table.dimension, distances + r * stride);
  }
}

}  // namespace plumbline::compress::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace plumbline::compress {
namespace {

void put_subspace(SubspaceTable& table, const Affine& affine, std::size_t at) {
  const std::size_t group = at / kGroup;
  const std::size_t lane = at % kGroup;
  std::vector<double> mean = affine.mean;
  double square = 0.0;
  for (std::size_t i = 0; i < mean.size(); ++i) {
    mean[i] -= table.origin[i];
    square += mean[i] * mean[i];
  }
  table.squares[at] = static_cast<float>(square);
  for (std::size_t column = 0; column <= affine.components(); ++column) {
    const double* values = column == 0 ? mean.data() : affine.axis(column - 1).data();
    const std::size_t first = (group * table.chunks + column / kColumns) * kColumns * kGroup;
    const std::size_t place = column % kColumns * kGroup + lane;
    double offset = 0.0;
    for (std::size_t i = 0; i < mean.size(); ++i) {
      table.columns[first * table.dimension + i * kColumns * kGroup + place] = static_cast<float>(values[i]);
      offset += column == 0 ? 0.0 : values[i] * mean[i];
    }
    table.offsets[first + place] = static_cast<float>(offset);
  }
}

}  // namespace

SubspaceTable make_table(const std::vector<Affine>& subspaces, std::vector<double> origin) {
  SubspaceTable table;
  table.dimension = origin.size();
  table.origin = std::move(origin);
  table.groups = (subspaces.size() + kGroup - 1) / kGroup;
  table.chunks = (subspaces.front().components() + 1 + kColumns - 1) / kColumns;
  table.offsets.assign(table.groups * table.chunks * kColumns * kGroup, 0.0F);
  table.columns.assign(table.offsets.size() * table.dimension, 0.0F);
  table.squares.assign(table.groups * kGroup, std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < subspaces.size(); ++i) put_subspace(table, subspaces[i], i);
  return table;
}

HWY_EXPORT(all_distances);

void relative_distances(const SubspaceTable& table, const float* x, std::size_t rows, float* distances) {
  HWY_DYNAMIC_DISPATCH(all_distances)(table, x, rows, distances);
}

}  // namespace plumbline::compress

#endif  // HWY_ONCE
