// prt/compress/affine.hpp: the affine subspace closest to a set of vectors (principal component analysis).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "prt/compress/vectors.hpp"

namespace plumbline::compress {

/// mean + the span of `axes`. Axes are orthonormal, in the order of falling variance; one that the vectors do not need (fewer
/// vectors, or of lower rank) is all zeros.
struct Affine {
  std::vector<double> mean;  // [dimension]
  std::vector<double> axes;  // [component][dimension]
  std::vector<double>
      eigenvalues;  // all of the scatter matrix sum (x - mean)(x - mean)^T, falling; at least `components`

  [[nodiscard]] std::size_t components() const { return mean.empty() ? 0 : axes.size() / mean.size(); }
  [[nodiscard]] std::span<const double> axis(std::size_t k) const {
    return std::span<const double>(axes).subspan(k * mean.size(), mean.size());
  }
};

/// The affine subspace of `components` dimensions with the least sum of squared distances to vectors[members]. That sum is the
/// sum of the eigenvalues that were dropped. No members: mean 0, axes 0.
[[nodiscard]] Affine fit_affine(const Vectors& vectors, std::span<const std::uint32_t> members,
                                std::size_t components);

/// Squared distance from x, of at most kMaxDimension numbers, to the subspace, in double.
[[nodiscard]] double squared_distance(const Affine& affine, std::span<const float> x);

/// Coordinates of x's projection: axis_k . (x - mean).
[[nodiscard]] std::vector<double> weights_of(const Affine& affine, std::span<const float> x);

}  // namespace plumbline::compress
