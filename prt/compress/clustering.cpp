#include "prt/compress/clustering.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "prt/compress/distances.hpp"
#include "prt/compress/seeding.hpp"
#include "reference/base/error.hpp"
#include "reference/base/parallel.hpp"

namespace plumbline::compress {
namespace {

constexpr std::size_t kBlock = 256;  // vectors one thread takes at a time

void require(const Vectors& vectors, const ClusterSettings& settings) {
  if (vectors.dimension < 1 || vectors.dimension > kMaxDimension) {
    throw InputError(
        fmt::format("compress: dimension: expected 1 to {}, got {}", kMaxDimension, vectors.dimension));
  }
  const auto most = std::min<std::size_t>(vectors.count(), kMaxClusters);
  if (settings.clusters < 1 || static_cast<std::size_t>(settings.clusters) > most) {
    throw InputError(fmt::format("clusters: expected 1 to {} for {} vertices, got {}", most, vectors.count(),
                                 settings.clusters));
  }
  if (settings.components < 0 || static_cast<std::size_t>(settings.components) > vectors.dimension) {
    throw InputError(fmt::format("components: expected 0 to {} for vectors of {} numbers, got {}",
                                 vectors.dimension, vectors.dimension, settings.components));
  }
}

std::vector<double> mean_of_all(const Vectors& vectors) {
  std::vector<std::uint32_t> all(vectors.count());
  std::iota(all.begin(), all.end(), 0U);
  return fit_affine(vectors, all, 0).mean;
}

struct Nearest {
  std::vector<std::uint32_t> labels;
  std::vector<double> squared_distances;
};

/// The closest of: the two subspaces that float finds closest, and `current` (a tie leaves the vector where it is).
void choose(const std::vector<Affine>& subspaces, std::span<const float> relative, std::span<const float> x,
            std::uint32_t& label, double& distance) {
  std::uint32_t best[2] = {0, 0};
  for (std::uint32_t c = 1; c < subspaces.size(); ++c) {
    if (relative[c] < relative[best[0]]) {
      best[1] = best[0];
      best[0] = c;
    } else if (best[1] == best[0] || relative[c] < relative[best[1]]) {
      best[1] = c;
    }
  }
  distance = squared_distance(subspaces[label], x);
  for (const std::uint32_t c : best) {
    const double other = c == label ? distance : squared_distance(subspaces[c], x);
    if (other < distance) {
      label = c;
      distance = other;
    }
  }
}

Nearest nearest_subspaces(const Vectors& vectors, const std::vector<Affine>& subspaces,
                          const std::vector<double>& origin, std::vector<std::uint32_t> labels, int threads) {
  const SubspaceTable table = make_table(subspaces, origin);
  const std::size_t stride = table.groups * kGroup;
  Nearest result{std::move(labels), std::vector<double>(vectors.count())};
  parallel_for((vectors.count() + kBlock - 1) / kBlock, threads, [&](std::size_t block) {
    const std::size_t first = block * kBlock;
    const std::size_t count = std::min(kBlock, vectors.count() - first);
    std::vector<float> x(count * vectors.dimension);
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double value = vectors.values[first * vectors.dimension + i];
      x[i] = static_cast<float>(value - origin[i % vectors.dimension]);
    }
    std::vector<float> distances(count * stride);
    relative_distances(table, x.data(), count, distances.data());
    for (std::size_t r = 0; r < count; ++r) {
      choose(subspaces, std::span<const float>(distances).subspan(r * stride, stride), vectors[first + r],
             result.labels[first + r], result.squared_distances[first + r]);
    }
  });
  return result;
}

/// A cluster without members gets the vector that is farthest from its own cluster's subspace, which leaves that one. The
/// error falls by the vector's squared distance; where all distances are 0 the cluster stays empty.
void fill_empty(Nearest& nearest, std::size_t clusters) {
  std::vector<std::size_t> sizes(clusters, 0);
  for (const std::uint32_t label : nearest.labels) ++sizes[label];
  for (std::uint32_t c = 0; c < clusters; ++c) {
    if (sizes[c] > 0) continue;
    const auto farthest =
        std::max_element(nearest.squared_distances.begin(), nearest.squared_distances.end());
    if (!(*farthest > 0.0)) return;
    std::uint32_t& label =
        nearest.labels[static_cast<std::size_t>(farthest - nearest.squared_distances.begin())];
    --sizes[label];
    label = c;
    sizes[c] = 1;
    *farthest = 0.0;
  }
}

/// New subspaces for clusters whose members changed.
void refit(const Vectors& vectors, const std::vector<std::uint32_t>& old_labels, int components, int threads,
           Clustering& clustering) {
  std::vector<char> has_changed(clustering.clusters.size(), old_labels.empty() ? 1 : 0);
  for (std::size_t i = 0; i < old_labels.size(); ++i) {
    if (old_labels[i] == clustering.labels[i]) continue;
    has_changed[old_labels[i]] = 1;
    has_changed[clustering.labels[i]] = 1;
  }
  const auto members = members_of(clustering.labels, clustering.clusters.size());
  parallel_for(members.size(), threads, [&](std::size_t c) {
    if (has_changed[c] != 0) {
      clustering.clusters[c] = fit_affine(vectors, members[c], static_cast<std::size_t>(components));
    }
  });
}

double squared_error_of(const Vectors& vectors, const Clustering& clustering, int threads) {
  std::vector<double> sums((vectors.count() + kBlock - 1) / kBlock, 0.0);
  parallel_for(sums.size(), threads, [&](std::size_t block) {
    const std::size_t end = std::min((block + 1) * kBlock, vectors.count());
    for (std::size_t i = block * kBlock; i < end; ++i) {
      sums[block] += squared_distance(clustering.clusters[clustering.labels[i]], vectors[i]);
    }
  });
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

/// Vectors to subspaces, subspaces to vectors, until it gains no more.
void iterate(const Vectors& vectors, const ClusterSettings& settings, int components,
             Clustering& clustering) {
  const std::vector<double> origin = mean_of_all(vectors);
  for (int i = 0; i < settings.max_iterations && clustering.clusters.size() > 1; ++i) {
    Nearest nearest =
        nearest_subspaces(vectors, clustering.clusters, origin, clustering.labels, settings.threads);
    fill_empty(nearest, clustering.clusters.size());
    if (nearest.labels == clustering.labels) break;
    const std::vector<std::uint32_t> old = std::exchange(clustering.labels, std::move(nearest.labels));
    refit(vectors, old, components, settings.threads, clustering);
    const double before = clustering.squared_error;
    clustering.squared_error = squared_error_of(vectors, clustering, settings.threads);
    clustering.history.push_back(clustering.squared_error);
    if (settings.progress) settings.progress(static_cast<double>(i + 1) / settings.max_iterations);
    if (!(before - clustering.squared_error > settings.least_gain * before)) break;
  }
}

}  // namespace

std::vector<std::vector<std::uint32_t>> members_of(const std::vector<std::uint32_t>& labels,
                                                   std::size_t clusters) {
  std::vector<std::vector<std::uint32_t>> members(clusters);
  for (std::size_t i = 0; i < labels.size(); ++i) members[labels[i]].push_back(static_cast<std::uint32_t>(i));
  return members;
}

Clustering cluster_by_mean(const Vectors& vectors, const ClusterSettings& settings) {
  require(vectors, settings);
  Clustering clustering;
  clustering.labels.assign(vectors.count(), 0);
  for (const std::uint32_t seed :
       choose_seeds(vectors, static_cast<std::size_t>(settings.clusters), settings.seed, settings.threads)) {
    clustering.clusters.push_back(fit_affine(vectors, std::span(&seed, 1), 0));
  }
  // Where fewer vectors differ than clusters were asked for, the rest start empty.
  clustering.clusters.resize(static_cast<std::size_t>(settings.clusters), clustering.clusters.back());
  const std::vector<double> origin = mean_of_all(vectors);
  Nearest first =
      nearest_subspaces(vectors, clustering.clusters, origin, std::move(clustering.labels), settings.threads);
  clustering.labels = std::move(first.labels);
  refit(vectors, {}, 0, settings.threads, clustering);
  clustering.squared_error = squared_error_of(vectors, clustering, settings.threads);
  clustering.history = {clustering.squared_error};
  iterate(vectors, settings, 0, clustering);
  return clustering;
}

Clustering with_components(const Vectors& vectors, const Clustering& clustering, int components,
                           int threads) {
  ClusterSettings settings;
  settings.clusters = static_cast<int>(clustering.clusters.size());
  settings.components = components;
  require(vectors, settings);
  Clustering result = clustering;
  refit(vectors, {}, components, threads, result);
  result.squared_error = squared_error_of(vectors, result, threads);
  result.history = {result.squared_error};
  return result;
}

Clustering cluster_static(const Vectors& vectors, const ClusterSettings& settings) {
  require(vectors, settings);
  return with_components(vectors, cluster_by_mean(vectors, settings), settings.components, settings.threads);
}

Clustering improve(const Vectors& vectors, Clustering start, const ClusterSettings& settings) {
  require(vectors, settings);
  iterate(vectors, settings, settings.components, start);
  return start;
}

Clustering cluster_iteratively(const Vectors& vectors, const ClusterSettings& settings) {
  return improve(vectors, cluster_static(vectors, settings), settings);
}

}  // namespace plumbline::compress
