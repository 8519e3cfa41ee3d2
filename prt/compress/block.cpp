#include "prt/compress/block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "reference/base/error.hpp"

namespace plumbline::compress {
namespace {

constexpr const char* kIterative = "iterative";
constexpr const char* kStatic = "static";

template <class Value>
Value member(const nlohmann::json& json, const char* name, const std::string& file) {
  try {
    return json.at(name).get<Value>();
  } catch (const nlohmann::json::exception&) {
    throw InputError(
        fmt::format("{}: compressed transfer: \"{}\" is missing or has the wrong type", file, name));
  }
}

double error_of(const nlohmann::json& json, const char* name, const std::string& file) {
  const auto value = member<double>(json, name, file);
  if (!(value >= 0.0) || !std::isfinite(value)) {
    throw InputError(
        fmt::format("{}: compressed transfer: {}: expected 0 or more, got {}", file, name, value));
  }
  return value;
}

Method method_of(const std::string& text, const std::string& file) {
  try {
    return method_from_string(text);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file, error.what()));
  }
}

bool is_iterative(const nlohmann::json& json, const std::string& file) {
  const auto clustering = member<std::string>(json, "clustering", file);
  if (clustering != kIterative && clustering != kStatic) {
    throw InputError(fmt::format("{}: compressed transfer: clustering: expected {} or {}, got {}", file,
                                 kStatic, kIterative, clustering));
  }
  return clustering == kIterative;
}

/// Ranges of what sizes are computed from. With clusters <= 65536 and at most `dimension` components nothing overflows.
void require_ranges(const Compressed& compressed, const std::string& file) {
  const auto refuse = [&](const std::string& what) {
    throw InputError(fmt::format("{}: compressed transfer: {}", file, what));
  };
  if (compressed.clusters < 1 || compressed.clusters > kMaxClusters) {
    refuse(fmt::format("clusters: expected 1 to {}, got {}", kMaxClusters, compressed.clusters));
  }
  if (compressed.dimension > kMaxDimension) {
    refuse(fmt::format("{} numbers a vertex are more than {}", compressed.dimension, kMaxDimension));
  }
  if (compressed.components() > compressed.dimension) {
    refuse(fmt::format("{} components for vectors of {} numbers", compressed.components(),
                       compressed.dimension));
  }
  for (const int bits : compressed.bits) {
    if (bits != 4 && bits != 8 && bits != 16 && bits != 32)
      refuse(fmt::format("bits: expected 4, 8, 16 or 32, got {}", bits));
  }
}

template <class Value>
const char* take(const char* from, std::vector<Value>& to, std::size_t count) {
  to.resize(count);
  std::memcpy(to.data(), from, count * sizeof(Value));
  return from + count * sizeof(Value);
}

const char* take_labels(const char* from, Compressed& compressed) {
  const std::size_t size = label_size(compressed.clusters);
  if (size == 2) return take(from, compressed.labels, compressed.vertices);
  std::vector<std::uint8_t> small(compressed.vertices, 0);
  if (size == 1) from = take(from, small, compressed.vertices);
  compressed.labels.assign(small.begin(), small.end());
  return from;
}

template <class Value>
void append(std::string& bytes, const std::vector<Value>& values) {
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
}

}  // namespace

void describe_block(const Compressed& compressed, nlohmann::json& json) {
  json["compression"] = std::string(to_string(compressed.method));
  json["clustering"] = compressed.is_iterative ? kIterative : kStatic;
  json["clusters"] = compressed.clusters;
  json["components"] = compressed.components();
  json["bits"] = compressed.bits;
  json["relativeError"] = compressed.relative_error;
  json["clusteringRelativeError"] = compressed.clustering_relative_error;
  json["bakeRelativeError"] = compressed.bake_relative_error;
  json["hasStandardErrors"] = false;
  json.erase("terms");
}

std::string to_block(const Compressed& compressed) {
  std::string bytes;
  append(bytes, compressed.means);
  append(bytes, compressed.axes);
  if (label_size(compressed.clusters) == 2) append(bytes, compressed.labels);
  if (label_size(compressed.clusters) == 1) {
    std::transform(compressed.labels.begin(), compressed.labels.end(), std::back_inserter(bytes),
                   [](std::uint16_t label) { return static_cast<char>(label); });
  }
  append(bytes, compressed.codes);
  return bytes;
}

Compressed parse_block(const nlohmann::json& json, const std::string& bytes, std::size_t vertices,
                       std::size_t dimension, const std::string& file) {
  Compressed compressed;
  compressed.method = method_of(member<std::string>(json, "compression", file), file);
  compressed.is_iterative = is_iterative(json, file);
  compressed.vertices = vertices;
  compressed.dimension = dimension;
  compressed.clusters = member<int>(json, "clusters", file);
  compressed.bits = member<std::vector<int>>(json, "bits", file);
  compressed.relative_error = error_of(json, "relativeError", file);
  compressed.clustering_relative_error = error_of(json, "clusteringRelativeError", file);
  compressed.bake_relative_error = error_of(json, "bakeRelativeError", file);
  require_ranges(compressed, file);
  if (member<std::size_t>(json, "components", file) != compressed.components()) {
    throw InputError(fmt::format("{}: compressed transfer: \"components\" and \"bits\" do not agree", file));
  }
  const auto clusters = static_cast<std::size_t>(compressed.clusters);
  std::size_t codes = 0;
  for (const int bits : compressed.bits) codes += plane_size(vertices, bits);
  const std::size_t constants = clusters * dimension * (compressed.components() + 1) * sizeof(float);
  const std::size_t expected = constants + vertices * label_size(compressed.clusters) + codes;
  if (bytes.size() != expected) {
    throw InputError(
        fmt::format("{}: compressed transfer: expected {} bytes, got {}", file, expected, bytes.size()));
  }
  const char* at = take(bytes.data(), compressed.means, clusters * dimension);
  at = take(at, compressed.axes, clusters * compressed.components() * dimension);
  at = take_labels(at, compressed);
  take(at, compressed.codes, codes);
  validate(compressed, file);
  return compressed;
}

}  // namespace plumbline::compress
