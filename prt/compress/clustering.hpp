// prt/compress/clustering.hpp: vectors in clusters, each with the affine subspace closest to its members.
// [1] Sloan, Hall, Hart & Snyder, "Clustered Principal Components for Precomputed Radiance Transfer", SIGGRAPH 2003.
// [2] Arthur & Vassilvitskii, "k-means++: the advantages of careful seeding", 2007. [3] Kambhatla & Leen, "Dimension
// reduction by local principal component analysis", 1997.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "prt/compress/affine.hpp"
#include "prt/compress/vectors.hpp"

namespace plumbline::compress {

inline constexpr int kMaxClusters = 65536;

struct ClusterSettings {
  int clusters = 256;        // 1 … min(vectors, kMaxClusters)
  int components = 12;       // axes a cluster, 0 … dimension
  int max_iterations = 100;  // of each of the two loops, by mean and by subspace
  /// The loops also end when an iteration lessens the sum of squares by less than this part of it.
  double least_gain = 1e-4;
  std::uint64_t seed = 0;
  int threads = 0;  // 0 = all there are; never changes the result
  std::function<void(double fraction)> progress;
};

/// A vector belongs to one cluster.
struct Clustering {
  std::vector<Affine> clusters;       // those that lost all their members and found no new one have mean 0
  std::vector<std::uint32_t> labels;  // [vector]
  double squared_error = 0.0;         // sum of squared distances of the vectors to their clusters' subspaces
  std::vector<double> history;        // squared_error after each iteration; never rises
};

/// Vector quantisation: Lloyd's iteration from a k-means++ start [2]. `components` is not read: no cluster has axes.
/// @throws InputError when a setting is out of range or the dimension exceeds kMaxDimension
[[nodiscard]] Clustering cluster_by_mean(const Vectors& vectors, const ClusterSettings& settings);

/// Static clustered PCA: vector quantisation, then the subspaces of what it found. One cluster is plain PCA. @throws InputError
[[nodiscard]] Clustering cluster_static(const Vectors& vectors, const ClusterSettings& settings);

/// Iterative clustered PCA [1, 3]: starts from the static one, then in turn every vector goes to the cluster whose subspace is
/// closest and every cluster takes the subspace of its members. The error never rises, so it ends at or below the
/// static one's. @throws InputError
[[nodiscard]] Clustering cluster_iteratively(const Vectors& vectors, const ClusterSettings& settings);

/// The subspaces of given clusters, `components` axes each. @throws InputError
[[nodiscard]] Clustering with_components(const Vectors& vectors, const Clustering& clustering, int components,
                                         int threads);

/// Iterations from a given start. @throws InputError
[[nodiscard]] Clustering improve(const Vectors& vectors, Clustering start, const ClusterSettings& settings);

/// The members of every cluster, in rising order.
[[nodiscard]] std::vector<std::vector<std::uint32_t>> members_of(const std::vector<std::uint32_t>& labels,
                                                                 std::size_t clusters);

}  // namespace plumbline::compress
