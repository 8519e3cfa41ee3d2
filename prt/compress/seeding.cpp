#include "prt/compress/seeding.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <limits>
#include <numeric>

#include "reference/base/parallel.hpp"

namespace plumbline::compress {
namespace {

constexpr std::size_t kBlock = 1024;  // vectors one thread takes at a time

/// Random number i of a seed, in [0, 1): SplitMix64 (Steele, Lea & Flood 2014).
double random_number(std::uint64_t seed, std::uint64_t i) {
  std::uint64_t z = seed * 0xD1B54A32D192ED03ULL + (i + 1) * 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
  return static_cast<double>((z ^ (z >> 31U)) >> 11U) * 0x1p-53;
}

double squared_difference(std::span<const float> a, std::span<const float> b) {
  const auto n = static_cast<Eigen::Index>(a.size());
  const Eigen::Map<const Eigen::ArrayXf> x(a.data(), n);
  const Eigen::Map<const Eigen::ArrayXf> y(b.data(), n);
  return (x.cast<double>() - y.cast<double>()).square().sum();
}

/// Lowers each vector's squared distance to the nearest centre for a new centre. Sums of blocks, so that the order of
/// addition is fixed.
std::vector<double> take_centre(const Vectors& vectors, std::size_t centre, std::vector<double>& nearest,
                                int threads) {
  std::vector<double> sums((vectors.count() + kBlock - 1) / kBlock, 0.0);
  parallel_for(sums.size(), threads, [&](std::size_t block) {
    const std::size_t end = std::min((block + 1) * kBlock, vectors.count());
    for (std::size_t i = block * kBlock; i < end; ++i) {
      nearest[i] = std::min(nearest[i], squared_difference(vectors[i], vectors[centre]));
      sums[block] += nearest[i];
    }
  });
  return sums;
}

/// The vector at which the running sum of `weights` passes `target`; one of weight above 0.
std::size_t pick(const std::vector<double>& weights, const std::vector<double>& block_sums, double target) {
  std::size_t block = 0;
  while (block + 1 < block_sums.size() && target >= block_sums[block]) target -= block_sums[block++];
  std::size_t last = weights.size();
  for (std::size_t i = block * kBlock; i < weights.size(); ++i) {
    if (!(weights[i] > 0.0)) continue;
    last = i;
    if (target < weights[i]) return i;
    target -= weights[i];
  }
  // Rounding ran past the end: the last vector with a weight.
  return last < weights.size()
             ? last
             : static_cast<std::size_t>(std::max_element(weights.begin(), weights.end()) - weights.begin());
}

}  // namespace

std::vector<std::uint32_t> choose_seeds(const Vectors& vectors, std::size_t count, std::uint64_t seed,
                                        int threads) {
  const std::size_t n = vectors.count();
  std::vector<double> nearest(n, std::numeric_limits<double>::infinity());
  std::vector<std::uint32_t> seeds{static_cast<std::uint32_t>(
      std::min(n - 1, static_cast<std::size_t>(random_number(seed, 0) * static_cast<double>(n))))};
  while (seeds.size() < count) {
    const std::vector<double> sums = take_centre(vectors, seeds.back(), nearest, threads);
    const double total = std::accumulate(sums.begin(), sums.end(), 0.0);
    if (!(total > 0.0)) break;
    seeds.push_back(
        static_cast<std::uint32_t>(pick(nearest, sums, random_number(seed, seeds.size()) * total)));
  }
  return seeds;
}

}  // namespace plumbline::compress
