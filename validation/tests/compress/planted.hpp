// validation/tests/compress/planted.hpp: vectors of which the tests know where they lie.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "prt/compress/vectors.hpp"

namespace plumbline::compress {

struct Planted {
  std::size_t dimension = 0;
  std::vector<float> values;
  std::vector<std::uint32_t> truth;  // which subspace a vector is on

  [[nodiscard]] Vectors vectors() const { return {values, dimension}; }
};

/// `count` vectors each on `subspaces` random affine subspaces: offset of normal numbers times `distance`, `components` axes of
/// normal numbers, weights uniform in [-1, 1]. noise: of normal numbers that are added.
inline Planted plant(std::size_t dimension, std::size_t subspaces, std::size_t components, std::size_t count,
                     double distance, double noise = 0.0, unsigned seed = 1) {
  std::mt19937_64 bits(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Planted planted{dimension, {}, {}};
  for (std::size_t s = 0; s < subspaces; ++s) {
    std::vector<double> base((components + 1) * dimension);
    for (double& x : base) x = normal(bits);
    for (std::size_t i = 0; i < count; ++i) {
      std::vector<double> x(dimension);
      for (std::size_t d = 0; d < dimension; ++d) x[d] = distance * base[d] + noise * normal(bits);
      for (std::size_t k = 1; k <= components; ++k) {
        const double weight = uniform(bits);
        for (std::size_t d = 0; d < dimension; ++d) x[d] += weight * base[k * dimension + d];
      }
      planted.values.insert(planted.values.end(), x.begin(), x.end());
      planted.truth.push_back(static_cast<std::uint32_t>(s));
    }
  }
  return planted;
}

/// Vectors along a bent sheet of `dimension` dimensions: smooth, and nowhere flat; the flatter the lower the frequency.
inline Planted bent_sheet(std::size_t dimension, std::size_t count, double frequency = 3.0,
                          unsigned seed = 1) {
  std::mt19937_64 bits(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<double> frequencies(3 * dimension);
  for (double& f : frequencies) f = frequency * uniform(bits);
  Planted planted{dimension, {}, std::vector<std::uint32_t>(count, 0)};
  for (std::size_t i = 0; i < count; ++i) {
    const double u = uniform(bits);
    const double v = uniform(bits);
    for (std::size_t d = 0; d < dimension; ++d) {
      const double phase = frequencies[3 * d] * u + frequencies[3 * d + 1] * v + frequencies[3 * d + 2];
      planted.values.push_back(static_cast<float>(std::sin(phase)));
    }
  }
  return planted;
}

}  // namespace plumbline::compress
