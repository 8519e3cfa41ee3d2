// prt/compress/vectors.hpp: what is compressed: many vectors of one dimension.
#pragma once

#include <cstddef>
#include <span>

namespace plumbline::compress {

/// Borrowed vectors, one after the other. Of a transfer: one a vertex, all channels together, channels * bands^2 numbers.
struct Vectors {
  std::span<const float> values;
  std::size_t dimension = 0;  // >= 1

  [[nodiscard]] std::size_t count() const { return values.size() / dimension; }
  [[nodiscard]] std::span<const float> operator[](std::size_t i) const {
    return values.subspan(i * dimension, dimension);
  }
};

/// Vectors whose covariance matrix would take more than this are refused.
inline constexpr std::size_t kMaxDimension = 4096;

/// sum of |x|^2 over all vectors: what relative errors are relative to.
[[nodiscard]] double sum_of_squares(const Vectors& vectors);

}  // namespace plumbline::compress
