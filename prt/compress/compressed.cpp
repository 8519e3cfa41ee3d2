#include "prt/compress/compressed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "prt/sh/basis.hpp"
#include "reference/base/error.hpp"
#include "reference/base/parallel.hpp"

namespace plumbline::compress {
namespace {

template <class Integer>
Integer read_integer(std::span<const std::uint8_t> plane, std::size_t i) {
  Integer value = 0;
  std::memcpy(&value, plane.data() + i * sizeof(Integer), sizeof(Integer));
  return value;
}

void require(bool is_right, const std::string& where, const std::string& what) {
  if (!is_right) throw InputError(fmt::format("{}: compressed transfer: {}", where, what));
}

bool are_finite(const std::vector<float>& values) {
  return std::all_of(values.begin(), values.end(), [](float x) { return std::isfinite(x); });
}

}  // namespace

std::string_view to_string(Method method) {
  switch (method) {
    case Method::vq:
      return "vq";
    case Method::pca:
      return "pca";
    case Method::cpca:
      return "cpca";
  }
  return "?";
}

Method method_from_string(std::string_view text) {
  for (const Method method : {Method::vq, Method::pca, Method::cpca}) {
    if (text == to_string(method)) return method;
  }
  throw InputError(fmt::format("compression: expected vq, pca or cpca, got {}", text));
}

std::size_t plane_size(std::size_t vertices, int bits) {
  return bits == 4 ? (vertices + 1) / 2 : vertices * static_cast<std::size_t>(bits / 8);
}

std::size_t label_size(int clusters) {
  return clusters <= 1 ? 0 : clusters <= 256 ? 1 : 2;
}

float code_of(std::span<const std::uint8_t> plane, int bits, std::size_t vertex) {
  switch (bits) {
    case 4: {
      const int nibble = (plane[vertex / 2] >> (vertex % 2 * 4)) & 15;
      return static_cast<float>(nibble < 8 ? nibble : nibble - 16);
    }
    case 8:
      return static_cast<float>(read_integer<std::int8_t>(plane, vertex));
    case 16:
      return static_cast<float>(read_integer<std::int16_t>(plane, vertex));
    default: {
      float value = 0.0F;
      std::memcpy(&value, plane.data() + vertex * sizeof(float), sizeof(float));
      return value;
    }
  }
}

std::span<const std::uint8_t> plane_of(const Compressed& compressed, std::size_t component) {
  std::size_t first = 0;
  for (std::size_t k = 0; k < component; ++k) first += plane_size(compressed.vertices, compressed.bits[k]);
  return std::span<const std::uint8_t>(compressed.codes)
      .subspan(first, plane_size(compressed.vertices, compressed.bits[component]));
}

double bytes_per_vertex(std::size_t vertices, std::size_t dimension, int clusters,
                        const std::vector<int>& bits) {
  if (vertices == 0) return 0.0;
  const auto c = static_cast<std::size_t>(clusters);
  std::size_t bytes = c * (bits.size() + 1) * dimension * sizeof(float) + vertices * label_size(clusters);
  for (const int b : bits) bytes += plane_size(vertices, b);
  return static_cast<double>(bytes) / static_cast<double>(vertices);
}

double bytes_per_vertex(const Compressed& compressed) {
  return bytes_per_vertex(compressed.vertices, compressed.dimension, compressed.clusters, compressed.bits);
}

std::vector<float> decode(const Compressed& compressed) {
  const std::size_t dimension = compressed.dimension;
  const std::size_t components = compressed.components();
  std::vector<float> values(compressed.vertices * dimension);
  std::vector<std::span<const std::uint8_t>> planes;
  for (std::size_t k = 0; k < components; ++k) planes.push_back(plane_of(compressed, k));
  std::vector<double> sum(dimension);
  for (std::size_t v = 0; v < compressed.vertices; ++v) {
    const std::size_t cluster = compressed.labels[v];
    std::copy_n(compressed.means.data() + cluster * dimension, dimension, sum.begin());
    for (std::size_t k = 0; k < components; ++k) {
      const double code = code_of(planes[k], compressed.bits[k], v);
      const float* axis = compressed.axes.data() + (cluster * components + k) * dimension;
      for (std::size_t i = 0; i < dimension; ++i) sum[i] += code * static_cast<double>(axis[i]);
    }
    for (std::size_t i = 0; i < dimension; ++i) values[v * dimension + i] = static_cast<float>(sum[i]);
  }
  return values;
}

void validate(const Compressed& compressed, const std::string& where) {
  const auto clusters = static_cast<std::size_t>(std::max(compressed.clusters, 0));
  const std::size_t components = compressed.components();
  require(compressed.clusters >= 1 && compressed.clusters <= kMaxClusters, where,
          fmt::format("clusters: expected 1 to {}, got {}", kMaxClusters, compressed.clusters));
  require(compressed.dimension >= 1 && components <= compressed.dimension, where,
          fmt::format("{} components for vectors of {} numbers", components, compressed.dimension));
  require(compressed.method != Method::pca || clusters == 1, where, "pca has one cluster");
  require(compressed.method != Method::vq || components == 0, where, "vq has no components");
  std::size_t codes = 0;
  for (const int bits : compressed.bits) {
    require(bits == 4 || bits == 8 || bits == 16 || bits == 32, where,
            fmt::format("bits: expected 4, 8, 16 or 32, got {}", bits));
    codes += plane_size(compressed.vertices, bits);
  }
  require(compressed.means.size() == clusters * compressed.dimension &&
              compressed.axes.size() == clusters * components * compressed.dimension &&
              compressed.labels.size() == compressed.vertices && compressed.codes.size() == codes,
          where, "sizes do not agree");
  for (std::size_t v = 0; v < compressed.vertices; ++v) {
    require(compressed.labels[v] < clusters, where,
            fmt::format("vertex {} is in cluster {} of {}", v, compressed.labels[v], clusters));
  }
  require(are_finite(compressed.means) && are_finite(compressed.axes), where, "a number is not finite");
  for (std::size_t k = 0; k < components; ++k) {
    if (compressed.bits[k] != 32) continue;
    for (std::size_t v = 0; v < compressed.vertices; ++v) {
      require(std::isfinite(code_of(plane_of(compressed, k), 32, v)), where,
              fmt::format("weight {} of vertex {} is not finite", k, v));
    }
  }
}

Vectors vectors_of(const transfer::Transfer& transfer) {
  return {transfer.coefficients,
          static_cast<std::size_t>(transfer.channels * sh::coefficient_count(transfer.bands))};
}

double relative_error(const Vectors& exact, const Vectors& other) {
  double sum = 0.0;
  for (std::size_t i = 0; i < exact.values.size(); ++i) {
    const double difference = static_cast<double>(exact.values[i]) - static_cast<double>(other.values[i]);
    sum += difference * difference;
  }
  return sum == 0.0 ? 0.0 : std::sqrt(sum / sum_of_squares(exact));
}

double bake_relative_error(const transfer::Transfer& transfer) {
  if (transfer.standard_errors.empty()) return 0.0;
  const Vectors errors{transfer.standard_errors, 1};
  const double sum = sum_of_squares(errors);
  return sum == 0.0 ? 0.0 : std::sqrt(sum / sum_of_squares(vectors_of(transfer)));
}

}  // namespace plumbline::compress
