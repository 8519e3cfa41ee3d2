// validation/checks/compression_study.hpp: size against error of the ways to compress a transfer.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "prt/compress/clustering.hpp"
#include "prt/transfer/transfer.hpp"

namespace plumbline::checks {

/// A compressed transfer, as a point of the plane of size and error.
struct SizedError {
  std::string method;  // "VQ", "PCA", "static CPCA", "iterative CPCA"
  int clusters = 1;
  int components = 0;
  int bits = 32;  // a weight
  double bytes_per_vertex = 0.0;
  double error = 0.0;             // relative, root mean square
  double clustering_error = 0.0;  // the part that exact weights would leave
};

/// What is compared. Numbers of clusters above a quarter of the vertices are left out.
struct CompressionGrid {
  std::vector<int> vq_clusters = {16, 64, 256, 1024, 2048, 4096};
  std::vector<int> pca_components = {1, 2, 4, 8, 12, 16, 20, 24, 32};
  std::vector<int> clusters = {16, 64, 256};
  std::vector<int> components = {4, 8, 12};
  std::vector<int> bits = {8, 16, 32};
  double least_gain = 1e-3;
  std::uint64_t seed = 0;
  int threads = 0;
};

[[nodiscard]] std::vector<SizedError> compression_study(const transfer::Transfer& transfer,
                                                        const CompressionGrid& grid);

/// Largest ratio of the errors of two methods at equal clusters, components and bits, so at equal size. NaN when there is no pair.
[[nodiscard]] double largest_ratio(const std::vector<SizedError>& points, const std::string& of,
                                   const std::string& to);
/// Largest ratio of the error of a method with weights of `bits` to VQ's at the same size, read off the straight line between the VQs
/// next in size (logarithmic in both). Points larger than every VQ are left out; NaN when none is left.
[[nodiscard]] double largest_ratio_to_vq(const std::vector<SizedError>& points, const std::string& of,
                                         int bits);
/// Largest part by which weights of `bits` raise the error that exact weights leave, over a method's points. NaN when there is none.
[[nodiscard]] double largest_increase(const std::vector<SizedError>& points, const std::string& of, int bits);

}  // namespace plumbline::checks
