// prt/compress/quantise.hpp: weights as integers of few bits.
#pragma once

#include <vector>

#include "prt/compress/compressed.hpp"

namespace plumbline::compress {

/// The weights of one component of one cluster lie in [low, high]; 2^bits levels are spread evenly over it, ends included:
/// weight = low + step (code + 2^(bits-1)), step = (high - low) / (2^bits - 1). The nearest level errs by at most step/2, and by
/// step^2/12 in the mean square where the weights are spread over many levels [Bennett 1948].
struct Levels {
  double low = 0.0;
  double step = 0.0;  // 0 where all weights are the same

  [[nodiscard]] double value(int code, int bits) const { return low + step * (code + (1 << (bits - 1))); }
  [[nodiscard]] int code(double weight, int bits) const;
};
/// bits: 4, 8 or 16.
[[nodiscard]] Levels levels_for(double low, double high, int bits);

/// Smallest and largest weight of each cluster's components.
struct WeightRanges {
  std::size_t components = 0;
  std::vector<double> low;         // [cluster][component]; 0 where a cluster has no members
  std::vector<double> high;        // the same
  std::vector<std::size_t> sizes;  // [cluster] members
};
/// @param weights  [vector][component]
[[nodiscard]] WeightRanges weight_ranges(const Clustering& clustering, const std::vector<float>& weights,
                                         std::size_t components);

/// Weights of every vector in its cluster, [vector][component], in float.
[[nodiscard]] std::vector<float> all_weights(const Vectors& vectors, const Clustering& clustering,
                                             int threads);

/// sum over all vectors of step^2/12 of their components: what quantisation adds to the squared error. Axes are orthonormal, so
/// that errors of weights are errors of vectors; and orthogonal to what the subspace leaves, so that the two add up.
[[nodiscard]] double expected_squared_error(const WeightRanges& ranges, const std::vector<int>& bits);

/// Bits that fall with the components: the first gets `first_bits`, each further one the fewest of 4, 8, 16 whose expected squared
/// error is no more than the first one's.
[[nodiscard]] std::vector<int> falling_bits(const WeightRanges& ranges, int first_bits);

struct CompressSettings {
  Method method = Method::cpca;  // vq: components = 0; pca: clusters = 1
  bool is_iterative = true;
  ClusterSettings clusters;
  std::vector<int> bits = {8};    // one a component; the last number goes for all that follow
  bool has_falling_bits = false;  // falling_bits(bits.front()) in their place
};

/// @throws InputError when a setting does not fit the transfer or the method
[[nodiscard]] Compressed compress(const transfer::Transfer& transfer, const CompressSettings& settings);

/// The vectors of a clustering with weights of so many bits, one number a component.
[[nodiscard]] Compressed quantise(const Vectors& vectors, const Clustering& clustering,
                                  const std::vector<int>& bits, int threads);

}  // namespace plumbline::compress
