#include "prt/compress/quantise.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "reference/base/error.hpp"
#include "reference/base/parallel.hpp"

namespace plumbline::compress {
namespace {

constexpr std::size_t kBlock = 1024;  // vectors one thread takes at a time

void put_code(std::uint8_t* plane, int bits, std::size_t vertex, int code) {
  switch (bits) {
    case 4:
      plane[vertex / 2] = static_cast<std::uint8_t>(plane[vertex / 2] | ((code & 15) << (vertex % 2 * 4)));
      break;
    case 8:
      plane[vertex] = static_cast<std::uint8_t>(code);
      break;
    default: {
      const auto value = static_cast<std::int16_t>(code);
      std::memcpy(plane + vertex * sizeof(value), &value, sizeof(value));
    }
  }
}

/// Cluster c's constants: the mean with the weights of code 0 inside, and the axes times a step.
void put_constants(const Affine& affine, const std::vector<Levels>& levels, const std::vector<int>& bits,
                   float* mean_out, float* axes_out) {
  std::vector<double> mean = affine.mean;
  for (std::size_t k = 0; k < bits.size(); ++k) {
    const double scale = bits[k] == 32 ? 1.0 : levels[k].step;
    const double zero = bits[k] == 32 ? 0.0 : levels[k].value(0, bits[k]);
    for (std::size_t i = 0; i < mean.size(); ++i) {
      const double axis = affine.axes[k * mean.size() + i];
      axes_out[k * mean.size() + i] = static_cast<float>(scale * axis);
      mean[i] += zero * axis;
    }
  }
  for (std::size_t i = 0; i < mean.size(); ++i) mean_out[i] = static_cast<float>(mean[i]);
}

std::vector<std::vector<Levels>> all_levels(const WeightRanges& ranges, const std::vector<int>& bits) {
  std::vector<std::vector<Levels>> levels(ranges.sizes.size(), std::vector<Levels>(bits.size()));
  for (std::size_t c = 0; c < levels.size(); ++c) {
    for (std::size_t k = 0; k < bits.size(); ++k) {
      const std::size_t at = c * ranges.components + k;
      if (bits[k] != 32) levels[c][k] = levels_for(ranges.low[at], ranges.high[at], bits[k]);
    }
  }
  return levels;
}

void put_plane(const Compressed& compressed, const std::vector<std::vector<Levels>>& levels,
               const std::vector<float>& weights, std::size_t component, std::uint8_t* plane) {
  const std::size_t components = compressed.components();
  const int bits = compressed.bits[component];
  for (std::size_t v = 0; v < compressed.vertices; ++v) {
    const float weight = weights[v * components + component];
    if (bits == 32) {
      std::memcpy(plane + v * sizeof(float), &weight, sizeof(float));
    } else {
      put_code(plane, bits, v, levels[compressed.labels[v]][component].code(weight, bits));
    }
  }
}

void require_bits(const std::vector<int>& bits, bool is_falling) {
  if (bits.empty()) throw InputError("bits: expected at least one number");
  for (const int b : bits) {
    if (b != 4 && b != 8 && b != 16 && b != 32) {
      throw InputError(fmt::format("bits: expected 4, 8, 16 or 32, got {}", b));
    }
  }
  if (is_falling && (bits.size() != 1 || bits.front() == 32)) {
    throw InputError("bits: falling bits start from one number, 4, 8 or 16");
  }
}

std::vector<int> one_a_component(std::vector<int> bits, std::size_t components) {
  if (bits.size() > components && components > 0) {
    throw InputError(fmt::format("bits: {} numbers for {} components", bits.size(), components));
  }
  bits.resize(components, bits.back());
  return bits;
}

Clustering cluster(const Vectors& vectors, const CompressSettings& settings) {
  ClusterSettings clusters = settings.clusters;
  if (settings.method == Method::vq) clusters.components = 0;
  if (settings.method == Method::pca) clusters.clusters = 1;
  if (settings.method == Method::cpca && settings.is_iterative) return cluster_iteratively(vectors, clusters);
  return cluster_static(vectors, clusters);
}

}  // namespace

int Levels::code(double weight, int bits) const {
  const int half = 1 << (bits - 1);
  if (step == 0.0) return -half;
  return std::clamp(static_cast<int>(std::lround((weight - low) / step)) - half, -half, half - 1);
}

Levels levels_for(double low, double high, int bits) {
  return {low, (high - low) / ((1 << bits) - 1)};
}

std::vector<float> all_weights(const Vectors& vectors, const Clustering& clustering, int threads) {
  const std::size_t components = clustering.clusters.front().components();
  std::vector<float> weights(vectors.count() * components);
  parallel_for((vectors.count() + kBlock - 1) / kBlock, threads, [&](std::size_t block) {
    const std::size_t end = std::min((block + 1) * kBlock, vectors.count());
    for (std::size_t v = block * kBlock; v < end; ++v) {
      const std::vector<double> exact = weights_of(clustering.clusters[clustering.labels[v]], vectors[v]);
      for (std::size_t k = 0; k < components; ++k) weights[v * components + k] = static_cast<float>(exact[k]);
    }
  });
  return weights;
}

WeightRanges weight_ranges(const Clustering& clustering, const std::vector<float>& weights,
                           std::size_t components) {
  const std::size_t clusters = clustering.clusters.size();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  WeightRanges ranges{components, std::vector<double>(clusters * components, kInfinity),
                      std::vector<double>(clusters * components, -kInfinity),
                      std::vector<std::size_t>(clusters, 0)};
  for (std::size_t v = 0; v < clustering.labels.size(); ++v) {
    const std::size_t c = clustering.labels[v];
    ++ranges.sizes[c];
    for (std::size_t k = 0; k < components; ++k) {
      const double weight = weights[v * components + k];
      ranges.low[c * components + k] = std::min(ranges.low[c * components + k], weight);
      ranges.high[c * components + k] = std::max(ranges.high[c * components + k], weight);
    }
  }
  for (std::size_t c = 0; c < clusters; ++c) {
    if (ranges.sizes[c] > 0) continue;
    std::fill_n(ranges.low.begin() + static_cast<std::ptrdiff_t>(c * components), components, 0.0);
    std::fill_n(ranges.high.begin() + static_cast<std::ptrdiff_t>(c * components), components, 0.0);
  }
  return ranges;
}

namespace {

double component_squared_error(const WeightRanges& ranges, std::size_t component, int bits) {
  if (bits == 32) return 0.0;
  double sum = 0.0;
  for (std::size_t c = 0; c < ranges.sizes.size(); ++c) {
    const std::size_t at = c * ranges.components + component;
    const double step = levels_for(ranges.low[at], ranges.high[at], bits).step;
    sum += static_cast<double>(ranges.sizes[c]) * step * step / 12.0;
  }
  return sum;
}

}  // namespace

double expected_squared_error(const WeightRanges& ranges, const std::vector<int>& bits) {
  double sum = 0.0;
  for (std::size_t k = 0; k < bits.size(); ++k) sum += component_squared_error(ranges, k, bits[k]);
  return sum;
}

std::vector<int> falling_bits(const WeightRanges& ranges, int first_bits) {
  std::vector<int> bits(ranges.components, first_bits);
  for (std::size_t k = 1; k < bits.size(); ++k) {
    const double allowed = component_squared_error(ranges, 0, first_bits);
    for (const int fewer : {4, 8, 16}) {
      if (fewer > first_bits || component_squared_error(ranges, k, fewer) > allowed) continue;
      bits[k] = fewer;
      break;
    }
  }
  return bits;
}

Compressed quantise(const Vectors& vectors, const Clustering& clustering, const std::vector<int>& bits,
                    int threads) {
  Compressed result;
  result.vertices = vectors.count();
  result.dimension = vectors.dimension;
  result.clusters = static_cast<int>(clustering.clusters.size());
  result.bits = bits;
  result.labels.assign(clustering.labels.begin(), clustering.labels.end());
  const std::vector<float> weights = all_weights(vectors, clustering, threads);
  const auto levels = all_levels(weight_ranges(clustering, weights, bits.size()), bits);
  const std::size_t clusters = clustering.clusters.size();
  result.means.resize(clusters * result.dimension);
  result.axes.resize(clusters * bits.size() * result.dimension);
  for (std::size_t c = 0; c < clusters; ++c) {
    put_constants(clustering.clusters[c], levels[c], bits, result.means.data() + c * result.dimension,
                  result.axes.data() + c * bits.size() * result.dimension);
  }
  std::size_t size = 0;
  for (const int b : bits) size += plane_size(result.vertices, b);
  result.codes.assign(size, 0);
  std::uint8_t* plane = result.codes.data();
  for (std::size_t k = 0; k < bits.size(); ++k) {
    put_plane(result, levels, weights, k, plane);
    plane += plane_size(result.vertices, bits[k]);
  }
  const std::vector<float> decoded = decode(result);
  result.relative_error = relative_error(vectors, {decoded, vectors.dimension});
  const double total = sum_of_squares(vectors);
  result.clustering_relative_error = total > 0.0 ? std::sqrt(clustering.squared_error / total) : 0.0;
  return result;
}

Compressed compress(const transfer::Transfer& transfer, const CompressSettings& settings) {
  require_bits(settings.bits, settings.has_falling_bits);
  const Vectors vectors = vectors_of(transfer);
  const Clustering clustering = cluster(vectors, settings);
  const std::size_t components = clustering.clusters.front().components();
  std::vector<int> bits = one_a_component(settings.bits, components);
  if (settings.has_falling_bits) {
    const std::vector<float> weights = all_weights(vectors, clustering, settings.clusters.threads);
    bits = falling_bits(weight_ranges(clustering, weights, components), settings.bits.front());
  }
  Compressed result = quantise(vectors, clustering, bits, settings.clusters.threads);
  result.method = settings.method;
  result.is_iterative = settings.method == Method::cpca && settings.is_iterative;
  result.bake_relative_error = bake_relative_error(transfer);
  return result;
}

}  // namespace plumbline::compress
