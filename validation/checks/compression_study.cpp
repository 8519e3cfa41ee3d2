#include "validation/checks/compression_study.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "prt/compress/quantise.hpp"

namespace plumbline::checks {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The larger of two, NaN counting as nothing so far.
double larger(double so_far, double value) {
  return so_far >= value ? so_far : value;
}

class Study {
 public:
  Study(const transfer::Transfer& transfer, const CompressionGrid& grid)
      : vectors_(compress::vectors_of(transfer)), grid_(&grid) {}

  [[nodiscard]] std::vector<SizedError> run() {
    for (const int clusters : grid_->vq_clusters) {
      if (is_small_enough(clusters))
        add("VQ", compress::cluster_by_mean(vectors_, settings_of(clusters, 0)), {32});
    }
    for (const int components : grid_->pca_components) {
      if (static_cast<std::size_t>(components) > vectors_.dimension) continue;
      add("PCA", compress::cluster_static(vectors_, settings_of(1, components)), grid_->bits);
    }
    for (const int clusters : grid_->clusters) {
      if (is_small_enough(clusters)) add_clustered(clusters);
    }
    return std::move(points_);
  }

 private:
  [[nodiscard]] bool is_small_enough(int clusters) const {
    return static_cast<std::size_t>(clusters) * 4 <= vectors_.count();
  }
  [[nodiscard]] compress::ClusterSettings settings_of(int clusters, int components) const {
    compress::ClusterSettings settings;
    settings.clusters = clusters;
    settings.components = components;
    settings.least_gain = grid_->least_gain;
    settings.seed = grid_->seed;
    settings.threads = grid_->threads;
    return settings;
  }
  void add_clustered(int clusters) {
    const compress::Clustering by_mean = compress::cluster_by_mean(vectors_, settings_of(clusters, 0));
    for (const int components : grid_->components) {
      compress::Clustering found = compress::with_components(vectors_, by_mean, components, grid_->threads);
      add("static CPCA", found, grid_->bits);
      found = compress::improve(vectors_, std::move(found), settings_of(clusters, components));
      add("iterative CPCA", found, grid_->bits);
    }
  }
  void add(const std::string& method, const compress::Clustering& clustering, const std::vector<int>& bits) {
    const std::size_t components = clustering.clusters.front().components();
    for (const int b : bits) {
      const compress::Compressed compressed =
          compress::quantise(vectors_, clustering, std::vector<int>(components, b), grid_->threads);
      points_.push_back({method, compressed.clusters, static_cast<int>(components), b,
                         compress::bytes_per_vertex(compressed), compressed.relative_error,
                         compressed.clustering_relative_error});
    }
  }

  compress::Vectors vectors_;
  const CompressionGrid* grid_;
  std::vector<SizedError> points_;
};

}  // namespace

std::vector<SizedError> compression_study(const transfer::Transfer& transfer, const CompressionGrid& grid) {
  return Study(transfer, grid).run();
}

double largest_ratio(const std::vector<SizedError>& points, const std::string& of, const std::string& to) {
  double largest = kNaN;
  for (const SizedError& a : points) {
    for (const SizedError& b : points) {
      const bool is_pair = a.method == of && b.method == to && a.clusters == b.clusters &&
                           a.components == b.components && a.bits == b.bits;
      if (is_pair) largest = larger(largest, a.error / b.error);
    }
  }
  return largest;
}

namespace {

/// VQ's error at a size, on the line between its neighbours in size (both axes logarithmic, as a power law is straight); below the smallest
/// VQ that one's error; none above the largest.
std::optional<double> vq_error_at(const std::vector<SizedError>& points, double bytes) {
  const SizedError* below = nullptr;
  const SizedError* above = nullptr;
  for (const SizedError& point : points) {
    if (point.method != "VQ") continue;
    const bool is_above = point.bytes_per_vertex >= bytes;
    const SizedError*& nearest = is_above ? above : below;
    const bool is_nearer =
        nearest == nullptr || (point.bytes_per_vertex < nearest->bytes_per_vertex) == is_above;
    if (is_nearer) nearest = &point;
  }
  if (above == nullptr) return std::nullopt;
  if (below == nullptr || above->bytes_per_vertex == bytes) return above->error;
  const double share =
      std::log(bytes / below->bytes_per_vertex) / std::log(above->bytes_per_vertex / below->bytes_per_vertex);
  return below->error * std::pow(above->error / below->error, share);
}

}  // namespace

double largest_ratio_to_vq(const std::vector<SizedError>& points, const std::string& of, int bits) {
  double largest = kNaN;
  for (const SizedError& point : points) {
    if (point.method != of || point.bits != bits) continue;
    if (const auto rival = vq_error_at(points, point.bytes_per_vertex))
      largest = larger(largest, point.error / *rival);
  }
  return largest;
}

double largest_increase(const std::vector<SizedError>& points, const std::string& of, int bits) {
  double largest = kNaN;
  for (const SizedError& a : points) {
    if (a.method == of && a.bits == bits) largest = larger(largest, a.error / a.clustering_error - 1.0);
  }
  return largest;
}

}  // namespace plumbline::checks
