// prt/transfer/basis_sums.hpp: weighted sums of the basis over many directions.
#pragma once

#include <span>

#include "prt/sh/aligned.hpp"
#include "prt/sh/batch.hpp"
#include "prt/transfer/bundle.hpp"

namespace plumbline::transfer {

/// Scratch for sum over directions k of weight_c(k) y_i(k), for every channel c and coefficient i. Basis values are floats,
/// sixteen partial sums of at most kMostDirections / 16 of them too, everything beyond is double: the relative error is that of
/// the float basis (sh/batch.hpp).
class BasisSums {
 public:
  /// Directions that one call may take.
  static constexpr std::size_t kMostDirections = 1024;

  BasisSums(const sh::BatchBasis<float>& basis, int channels);

  /// Adds to sums[channel][bands^2]. Fills the bundle's last block with directions of weight 0.
  void add(Bundle& bundle, std::span<double> sums);

 private:
  const sh::BatchBasis<float>* basis_;
  int channels_;
  std::size_t size_;
  sh::AlignedVector<float> values_;   // the blocked layout
  sh::AlignedVector<float> partial_;  // [channel][bands^2][16]
};

}  // namespace plumbline::transfer
