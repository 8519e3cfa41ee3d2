// prt/sh/batch_kernels.hpp: the vector code behind batch.hpp, chosen for the machine when the program runs.
#pragma once

#include <cstddef>

namespace plumbline::sh {

template <class Real>
struct RecurrenceTable;

/// Closed forms serve up to this many bands.
inline constexpr int kBatchClosedBands = 5;

/// Whole blocks of directions.
template <class Real>
struct DirectionBlocks {
  const Real* x;
  const Real* y;
  const Real* z;
  std::size_t count;
};

/// The blocked layout.
void evaluate_blocks(const RecurrenceTable<float>& table, const DirectionBlocks<float>& in, float* out);
void evaluate_blocks(const RecurrenceTable<double>& table, const DirectionBlocks<double>& in, double* out);

/// One block turned from [n^2][16] into `rows` <= 16 rows of n^2.
void transpose_block(const float* block, std::size_t size, std::size_t rows, float* out);
void transpose_block(const double* block, std::size_t size, std::size_t rows, double* out);

/// Sums over all coefficients, three arrays of whole blocks. Up to kBatchClosedBands `coefficients` are n^2 triples r, g,
/// b; above, for m = 0 the triples of l = 0 … n-1 and for each m > 0 and l = m … n-1 six numbers: those of m, then of -m.
void sum_blocks(const RecurrenceTable<float>& table, const float* coefficients,
                const DirectionBlocks<float>& in, float* const* out);
void sum_blocks(const RecurrenceTable<double>& table, const double* coefficients,
                const DirectionBlocks<double>& in, double* const* out);

}  // namespace plumbline::sh
