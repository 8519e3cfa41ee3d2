// prt/sh/batch.hpp: the basis, and sums over it, at many directions at a time, with the machine's widest vectors.
// Conventions: CONVENTIONS.md#spherical-harmonics. The formulas are those of basis.hpp and recurrence.hpp.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "prt/sh/lighting.hpp"

namespace plumbline::sh {

/// Unit directions as three arrays of the same length.
template <class Real>
struct Directions {
  std::span<const Real> x;
  std::span<const Real> y;
  std::span<const Real> z;
};

/// Directions that share a block of the blocked layout, in float and in double, on every machine.
inline constexpr std::size_t kBlockDirections = 16;
/// Numbers in a blocked array of `count` directions: whole blocks of kBlockDirections n^2.
[[nodiscard]] std::size_t blocked_size(int bands, std::size_t count);
/// Place of coefficient i of direction k in a blocked array: blocks of 16 directions, in each block the coefficients
/// one after the other, of each the 16 directions side by side.
[[nodiscard]] constexpr std::size_t blocked_index(int bands, std::size_t k, std::size_t i) {
  const auto size = static_cast<std::size_t>(coefficient_count(bands));
  return (k / kBlockDirections * size + i) * kBlockDirections + k % kBlockDirections;
}

/// What the kernels read: the constants of the recurrence, column after column.
template <class Real>
struct RecurrenceTable {
  int bands = 0;
  Real scale{};
  std::vector<Real> starts;  // q_m^m / scale
  std::vector<Real> steps;   // for m = 0 … n-1: alpha, beta, gamma of l = m+1 … n-1
};

/// Evaluates the basis of `bands` bands at many directions. Make one and use it often.
///
/// Both float and double compute in their own precision. Largest absolute error over uniform directions, against
/// quadruple precision (ShBatch.* tests): double as Basis<double>; float 7e-7, 2.5e-6, 1e-5, 3e-5 at 6, 10, 20, 64
/// bands. Near the poles pairs keep their digits as in Basis. Above 256 bands float calls Basis<float>.
///
/// The instruction set is chosen when the program runs (AVX-512, AVX2, SSSE3 or plain code). Results are the same
/// bits for any number of threads and any place in the batch, but differ in the last bits between instruction sets,
/// because those with fused multiply-add round once where others round twice.
template <class Real>
class BatchBasis {
 public:
  /// @throws InputError unless 1 <= bands <= kMaxBands
  explicit BatchBasis(int bands);

  [[nodiscard]] int bands() const { return table_.bands; }

  /// Values in the blocked layout; those of the directions that fill up the last block are numbers of no meaning.
  /// Fastest: every store is a whole vector.
  /// @throws InputError when the arrays differ in length or `values` is shorter than blocked_size()
  void evaluate_blocked(const Directions<Real>& directions, std::span<Real> values, int threads = 1) const;

  /// Values direction after direction, n^2 each, index l(l+1)+m.
  /// @throws InputError when the arrays differ in length or `values` is shorter than count n^2
  void evaluate(const Directions<Real>& directions, std::span<Real> values, int threads = 1) const;

 private:
  RecurrenceTable<Real> table_;
};
extern template class BatchBasis<float>;
extern template class BatchBasis<double>;

/// Three arrays of the same length.
template <class Real>
struct RgbArrays {
  std::span<Real> r;
  std::span<Real> g;
  std::span<Real> b;
};

/// An RGB function on the sphere, to be evaluated at many directions: the sum over all coefficients without ever
/// storing the basis. Make one and use it often.
/// Error: rounding, about n times that of Real relative to the root of the sum of squared coefficients.
template <class Real>
class BatchFunction {
 public:
  /// @throws InputError when the number of coefficients does not fit the bands
  explicit BatchFunction(const ShRgb& function);

  [[nodiscard]] int bands() const { return table_.bands; }

  /// @throws InputError when the arrays, in and out, differ in length
  void evaluate(const Directions<Real>& directions, const RgbArrays<Real>& values, int threads = 1) const;

 private:
  RecurrenceTable<Real> table_;
  std::vector<Real> coefficients_;  // in the order in which the kernel meets them
  ShRgb function_;                  // where the kernel does not reach
};
extern template class BatchFunction<float>;
extern template class BatchFunction<double>;

}  // namespace plumbline::sh
