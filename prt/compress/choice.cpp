#include "prt/compress/choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "reference/base/error.hpp"

namespace plumbline::compress {
namespace {

constexpr double kLeastGain = 1e-3;      // of an iteration where clusters are only weighed
constexpr double kIterativeGain = 1.25;  // static error over iterative error, up to which it is worth a try …
constexpr int kMostBold = 6;             // … so many times

/// A static clustering with as many components as are weighed.
struct Weighed {
  Clustering clustering;
  WeightRanges ranges;
  std::vector<double> squared_errors;  // [number of components]
};

Weighed weigh(const Vectors& vectors, const ClusterSettings& settings) {
  Weighed weighed{cluster_static(vectors, settings), {}, {}};
  const auto components = static_cast<std::size_t>(settings.components);
  const std::vector<float> weights = all_weights(vectors, weighed.clustering, settings.threads);
  weighed.ranges = weight_ranges(weighed.clustering, weights, components);
  weighed.squared_errors.assign(components + 1, 0.0);
  for (std::size_t k = 0; k <= components; ++k) {
    weighed.squared_errors[k] = weighed.clustering.squared_error;
    for (const Affine& affine : weighed.clustering.clusters) {
      for (std::size_t j = k; j < components; ++j) weighed.squared_errors[k] += affine.eigenvalues[j];
    }
  }
  return weighed;
}

std::vector<std::vector<int>> bit_choices(const Weighed& weighed, std::size_t components,
                                          const std::vector<int>& first) {
  std::vector<std::vector<int>> choices;
  for (const int bits : first) {
    choices.emplace_back(components, bits);
    if (bits == 32) continue;
    std::vector<int> falling = falling_bits(weighed.ranges, bits);
    falling.resize(components);
    if (falling != choices.back()) choices.push_back(std::move(falling));
  }
  return choices;
}

void add_candidates(const Vectors& vectors, const Weighed& weighed, std::size_t least_components,
                    const std::vector<int>& first_bits, double total, std::vector<Candidate>& candidates) {
  const int clusters = static_cast<int>(weighed.clustering.clusters.size());
  for (std::size_t k = least_components; k < weighed.squared_errors.size(); ++k) {
    for (std::vector<int>& bits : bit_choices(weighed, k, first_bits)) {
      const double squared = weighed.squared_errors[k] + expected_squared_error(weighed.ranges, bits);
      const double size = bytes_per_vertex(vectors.count(), vectors.dimension, clusters, bits);
      candidates.push_back({clusters, std::move(bits), size, total > 0.0 ? std::sqrt(squared / total) : 0.0});
      if (k == 0) break;  // no weights, no bits
    }
  }
}

std::vector<int> cluster_counts(Method method, std::size_t vertices) {
  std::vector<int> counts;
  const int most = method == Method::pca ? 1 : kMostClusters;
  for (int c = 1; c <= most && static_cast<std::size_t>(c) <= vertices; c *= 2) counts.push_back(c);
  return counts;
}

Compressed carry_out(const Vectors& vectors, const Candidate& candidate, const Clustering& start,
                     const ChoiceSettings& settings) {
  ClusterSettings clusters = settings.clusters;
  clusters.clusters = candidate.clusters;
  clusters.components = static_cast<int>(candidate.bits.size());
  Clustering clustering = with_components(vectors, start, clusters.components, clusters.threads);
  const bool is_iterative = settings.method == Method::cpca && settings.is_iterative;
  if (is_iterative) clustering = improve(vectors, std::move(clustering), clusters);
  Compressed compressed = quantise(vectors, clustering, candidate.bits, clusters.threads);
  compressed.method = settings.method;
  compressed.is_iterative = is_iterative;
  return compressed;
}

void require_target(double target) {
  if (!(target > 0.0) || !std::isfinite(target)) {
    throw InputError(fmt::format("target error: expected a number above 0, got {}", target));
  }
}

}  // namespace

std::optional<Choice> choose(const transfer::Transfer& transfer, const ChoiceSettings& settings) {
  require_target(settings.target_error);
  const Vectors vectors = vectors_of(transfer);
  const double total = sum_of_squares(vectors);
  const std::vector<int> first_bits = settings.bits.empty() ? std::vector<int>{8, 16, 32} : settings.bits;
  ClusterSettings clusters = settings.clusters;
  clusters.components =
      settings.method == Method::vq ? 0 : std::min<int>(kMostComponents, static_cast<int>(vectors.dimension));
  clusters.least_gain = std::max(clusters.least_gain, kLeastGain);
  Choice choice;
  std::map<int, Weighed> weighed;
  for (const int count : cluster_counts(settings.method, vectors.count())) {
    clusters.clusters = count;
    const Weighed& added = weighed.emplace(count, weigh(vectors, clusters)).first->second;
    add_candidates(vectors, added, settings.method == Method::vq ? 0 : 1, first_bits, total,
                   choice.candidates);
  }
  std::stable_sort(
      choice.candidates.begin(), choice.candidates.end(),
      [](const Candidate& a, const Candidate& b) { return a.bytes_per_vertex < b.bytes_per_vertex; });
  const bool is_bold = settings.method == Method::cpca && settings.is_iterative;
  int bold = 0;
  for (const Candidate& candidate : choice.candidates) {
    const bool is_expected = candidate.expected_error <= settings.target_error;
    if (!is_expected && !(is_bold && candidate.expected_error <= kIterativeGain * settings.target_error &&
                          bold < kMostBold)) {
      continue;
    }
    bold += is_expected ? 0 : 1;
    ++choice.tried;
    choice.compressed = carry_out(vectors, candidate, weighed.at(candidate.clusters).clustering, settings);
    if (choice.compressed.relative_error <= settings.target_error) {
      choice.compressed.bake_relative_error = bake_relative_error(transfer);
      return choice;
    }
  }
  return std::nullopt;
}

}  // namespace plumbline::compress
