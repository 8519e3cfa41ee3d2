// prt/sh/rotator_kernels.hpp: what rotator.cpp prepares and rotator_kernels.cpp runs. Not for others.
#pragma once

#include <cstddef>

namespace plumbline::sh::rotator {

// ---------------------------------------------------------------- few bands: values in fixed directions

inline constexpr int kMostSampledBands = 8;
inline constexpr int kSamples = 16;  // 2 bands - 1 of them used, the rest are zero

/// Numbers that hold degree l's 2l + 1 results: whole small vectors.
[[nodiscard]] constexpr int result_width(int degree) {
  return degree <= 1 ? 4 : degree <= 3 ? 8 : 16;
}

/// Layout of the table: x, y, z of the directions (kSamples each), scale of each coefficient (64), the recurrence's
/// constants (64, at index(l, m), m >= 0), then for degree 1, 2, …: 2l + 1 columns of result_width(l).
inline constexpr int kScales = 3 * kSamples;
inline constexpr int kRecurrence = kScales + 64;
inline constexpr int kColumns = kRecurrence + 64;
[[nodiscard]] constexpr int columns_start(int degree) {
  int start = kColumns;
  for (int l = 1; l < degree; ++l) start += (2 * l + 1) * result_width(l);
  return start;
}

/// matrix: nine numbers, row-major R. `out` may be `in`.
void rotate_by_samples(int bands, const float* table, const float* matrix, const float* in, float* out);

// ---------------------------------------------------------------- any bands: turns about z, and exchanges of y and z

/// A degree's coefficients in four rows, by parity of m: 0 even cosines (m = 0, 2, …), 1 odd cosines (1, 3, …), 2 even
/// sines (a zero for m = 0, then 2, 4, …), 3 odd sines. Every row is padded with zeros to row_width.
[[nodiscard]] constexpr int row_size(int degree, int row) {
  return row % 2 == 0 ? degree / 2 + 1 : (degree + 1) / 2;
}
inline constexpr int kRowStep = 16;
[[nodiscard]] constexpr int row_width(int degree) {
  return (degree / 2 + kRowStep) / kRowStep * kRowStep;
}
/// Row to which the exchange of y and z takes a row: parity in y becomes parity in z and the other way around.
[[nodiscard]] constexpr int exchanged_row(int degree, int row) {
  const bool is_kept = degree % 2 == 0 ? row == 0 || row == 3 : row == 1 || row == 2;
  return is_kept ? row : 3 - row;
}
/// Numbers of the exchange's blocks of one degree: for each row, row_size columns of row_width.
[[nodiscard]] constexpr std::size_t exchange_size(int degree) {
  const auto columns = static_cast<std::size_t>(2 * (row_size(degree, 0) + row_size(degree, 1)));
  return columns * static_cast<std::size_t>(row_width(degree));
}

/// exchange: the blocks of degree 1, 2, …. turns: for gamma, beta, alpha in turn cos 2j a, cos (2j + 1) a, sin 2j a,
/// sin (2j + 1) a, row_width(bands - 1) numbers each. scratch: 8 row_width(bands - 1) numbers.
void rotate_by_exchange(int bands, const float* exchange, const float* turns, const float* in, float* out,
                        float* scratch);
void rotate_by_exchange(int bands, const double* exchange, const double* turns, const double* in, double* out,
                        double* scratch);

// ---------------------------------------------------------------- one rotation, many functions

/// blocks: row-major, degree 0 first.
void apply_blocks_to_many(int bands, const float* blocks, std::size_t count, const float* in, float* out);

}  // namespace plumbline::sh::rotator
