#include "prt/transfer/basis_sums.hpp"

#include <algorithm>

#include "prt/sh/basis.hpp"
#include "prt/transfer/kernels.hpp"

namespace plumbline::transfer {
namespace {

// Directions evaluated at a time: where there are few bands, values stay in the first-level cache until they are summed.
std::size_t directions_together(std::size_t size) {
  return size <= 1024 ? 4 * sh::kBlockDirections : sh::kBlockDirections;
}

void pad(Bundle& bundle) {
  const std::size_t end =
      (bundle.count + sh::kBlockDirections - 1) / sh::kBlockDirections * sh::kBlockDirections;
  for (std::size_t k = bundle.count; k < end; ++k) {
    bundle.x[k] = 0.0F;
    bundle.y[k] = 0.0F;
    bundle.z[k] = 1.0F;
    for (int c = 0; c < bundle.channels; ++c) bundle.weight(c)[k] = 0.0F;
  }
}

/// As a tree: a chain of sixteen additions would take as long as some rays.
double sum_of_block(const float* values) {
  double sums[8];
  for (int u = 0; u < 8; ++u) sums[u] = static_cast<double>(values[u]) + static_cast<double>(values[u + 8]);
  return ((sums[0] + sums[4]) + (sums[1] + sums[5])) + ((sums[2] + sums[6]) + (sums[3] + sums[7]));
}

}  // namespace

BasisSums::BasisSums(const sh::BatchBasis<float>& basis, int channels)
    : basis_(&basis),
      channels_(channels),
      size_(static_cast<std::size_t>(sh::coefficient_count(basis.bands()))),
      values_(directions_together(size_) * size_),
      partial_(static_cast<std::size_t>(channels) * size_ * sh::kBlockDirections) {}

void BasisSums::add(Bundle& bundle, std::span<double> sums) {
  if (bundle.count == 0) return;
  pad(bundle);
  std::fill(partial_.begin(), partial_.end(), 0.0F);
  const std::size_t together = directions_together(size_);
  for (std::size_t first = 0; first < bundle.count; first += together) {
    const std::size_t blocks =
        (std::min(together, bundle.count - first) + sh::kBlockDirections - 1) / sh::kBlockDirections;
    const std::size_t count = blocks * sh::kBlockDirections;
    basis_->evaluate_blocked({{bundle.x.data() + first, count},
                              {bundle.y.data() + first, count},
                              {bundle.z.data() + first, count}},
                             values_);
    add_weighted(values_.data(), bundle.weight(0) + first, bundle.capacity, channels_, blocks, size_,
                 partial_.data());
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(channels_) * size_; ++i)
    sums[i] += sum_of_block(partial_.data() + i * sh::kBlockDirections);
}

}  // namespace plumbline::transfer
