#include "prt/transfer/baked_file.hpp"

#include <fmt/format.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "prt/compress/block.hpp"
#include "prt/sh/basis.hpp"
#include "prt/sh/lighting.hpp"
#include "reference/base/error.hpp"
#include "reference/scene/load.hpp"
#include "reference/scene/save_gltf.hpp"

namespace plumbline::transfer {
namespace {

constexpr const char* kExtension = "PLUMBLINE_precomputed_radiance_transfer";
constexpr int kVersion = 1;

void append(std::string& bytes, const std::vector<float>& values) {
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
}

nlohmann::json bounces_json(int bounces) {
  return bounces == kAllBounces ? nlohmann::json("all") : nlohmann::json(bounces);
}

/// How it was computed: nothing that reading depends on.
void describe_method(const Transfer& transfer, nlohmann::json& json) {
  json["sampling"] = std::string(to_string(transfer.method.sampling));
  json["directions"] = std::string(to_string(transfer.method.directions));
  if (transfer.kind == Kind::interreflected) json["solver"] = std::string(to_string(transfer.method.solver));
  if (transfer.target_error > 0.0) json["targetError"] = transfer.target_error;
  if (transfer.above_target > 0) json["aboveTarget"] = transfer.above_target;
  if (transfer.remainder > 0.0) json["remainder"] = transfer.remainder;
}

nlohmann::json describe(const Transfer& transfer) {
  nlohmann::json json = {{"version", kVersion},
                         {"bands", transfer.bands},
                         {"convention", sh::kConventionName},
                         {"transfer", std::string(to_string(transfer.kind))},
                         {"bounces", bounces_json(transfer.bounces)},
                         {"channels", transfer.channels},
                         {"vertices", transfer.vertices},
                         {"samples", transfer.samples},
                         {"seed", transfer.seed},
                         {"compression", "none"},
                         {"componentType", "float32"}};
  json["hasStandardErrors"] = !transfer.standard_errors.empty();
  if (!transfer.terms.empty()) json["terms"] = transfer.terms.size();
  if (transfer.kind != Kind::unshadowed) describe_method(transfer, json);
  return json;
}

// Reads a JSON field of the right type, or says which one is wrong.
template <class Value>
Value field(const nlohmann::json& json, const char* name, const std::string& file) {
  const auto found = json.find(name);
  if (found == json.end()) throw InputError(fmt::format("{}: {}: lacks \"{}\"", file, kExtension, name));
  try {
    return found->get<Value>();
  } catch (const nlohmann::json::exception&) {
    throw InputError(fmt::format("{}: {}: \"{}\" has the wrong type", file, kExtension, name));
  }
}

template <class Value>
Value field_or(const nlohmann::json& json, const char* name, const Value& fallback, const std::string& file) {
  return json.contains(name) ? field<Value>(json, name, file) : fallback;
}

/// from_string(text), with the file named where it refuses.
template <class Choice>
Choice choice_of(Choice (*from_string)(std::string_view), const std::string& text, const std::string& file) {
  try {
    return from_string(text);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", file, error.what()));
  }
}

void require_vertices(const Transfer& transfer, std::size_t scene_vertices, const std::string& file) {
  if (transfer.vertices == scene_vertices) return;
  throw InputError(
      fmt::format("{}: the transfer has {} vertices, the scene {}", file, transfer.vertices, scene_vertices));
}

void require_same_shape(const compress::Compressed& compressed, const Transfer& transfer,
                        const std::string& file) {
  if (compressed.vertices == transfer.vertices &&
      compressed.vertices * compressed.dimension == transfer.coefficients.size()) {
    return;
  }
  throw InputError(
      fmt::format("{}: the compressed transfer has {} vertices of {} numbers, the transfer {} numbers in all",
                  file, compressed.vertices, compressed.dimension, transfer.coefficients.size()));
}

/// Reads a compressed transfer where there is one; whether the vertices are the scene's is checked before, because a few bytes can
/// stand for any number of them.
std::optional<compress::Compressed> parse_compressed(const nlohmann::json& json, const std::string& bytes,
                                                     std::size_t scene_vertices, const std::string& file,
                                                     Transfer& transfer) {
  if (json["compression"] == "none") return std::nullopt;
  require_vertices(transfer, scene_vertices, file);
  const auto dimension = static_cast<std::size_t>(sh::coefficient_count(transfer.bands) * transfer.channels);
  auto compressed = compress::parse_block(json, bytes, transfer.vertices, dimension, file);
  transfer.coefficients = compress::decode(compressed);
  return compressed;
}

int parse_bounces(const nlohmann::json& json, const std::string& file) {
  const auto found = json.find("bounces");
  if (found != json.end() && *found == "all") return kAllBounces;
  const int bounces = field<int>(json, "bounces", file);
  if (bounces < 0) throw InputError(fmt::format("{}: bounces: expected 0 or more, got {}", file, bounces));
  return bounces;
}

/// What describe_method() wrote, as far as it is there.
void parse_method(const nlohmann::json& json, const std::string& file, Transfer& transfer) {
  const Method usual;
  transfer.method.solver = choice_of(
      solver_from_string, field_or(json, "solver", std::string(to_string(usual.solver)), file), file);
  transfer.method.sampling = choice_of(
      sampling_from_string, field_or(json, "sampling", std::string(to_string(usual.sampling)), file), file);
  transfer.method.directions =
      choice_of(direction_sets_from_string,
                field_or(json, "directions", std::string(to_string(usual.directions)), file), file);
  transfer.target_error = field_or(json, "targetError", 0.0, file);
  transfer.above_target = field_or(json, "aboveTarget", std::size_t{0}, file);
  transfer.remainder = field_or(json, "remainder", 0.0, file);
}

/// Takes the next `size` numbers off the data.
std::vector<float> next_numbers(const std::string& bytes, std::size_t size, std::size_t& offset) {
  std::vector<float> numbers(size);
  std::memcpy(numbers.data(), bytes.data() + offset, size * sizeof(float));
  offset += size * sizeof(float);
  return numbers;
}

/// Blocks of [vertex][channel][coefficient], one after the other: coefficients, their standard errors, the terms' likewise.
void parse_data(const nlohmann::json& json, const std::string& bytes, const std::string& file,
                Transfer& transfer) {
  const bool has_errors = field<bool>(json, "hasStandardErrors", file);
  const auto terms = field_or(json, "terms", std::size_t{0}, file);
  // In units of one vertex and of blocks, so that no hostile count can overflow.
  const auto per_vertex =
      static_cast<std::size_t>(sh::coefficient_count(transfer.bands) * transfer.channels) * sizeof(float) *
      (has_errors ? 2 : 1);
  const std::size_t rows = bytes.size() / per_vertex;
  const bool is_whole = bytes.size() % per_vertex == 0 && terms < rows + 1 && rows % (terms + 1) == 0;
  if (!is_whole || rows / (terms + 1) != transfer.vertices) {
    throw InputError(fmt::format(
        "{}: transfer of {} vertices x {} channels x {} bands x {} terms does not fill its {} bytes", file,
        transfer.vertices, transfer.channels, transfer.bands, terms, bytes.size()));
  }
  const std::size_t size = transfer.vertices * per_vertex / sizeof(float) / (has_errors ? 2 : 1);
  std::size_t offset = 0;
  transfer.coefficients = next_numbers(bytes, size, offset);
  if (has_errors) transfer.standard_errors = next_numbers(bytes, size, offset);
  for (std::size_t k = 0; k < terms; ++k) {
    Term& term = transfer.terms.emplace_back();
    term.coefficients = next_numbers(bytes, size, offset);
    if (has_errors) term.standard_errors = next_numbers(bytes, size, offset);
  }
}

Baked parse(const nlohmann::json& json, const std::string& bytes, scene::Scene scene,
            const std::string& file) {
  const int version = field<int>(json, "version", file);
  if (version != kVersion)
    throw InputError(fmt::format("{}: transfer version {}, this program reads {}", file, version, kVersion));
  const auto convention = field<std::string>(json, "convention", file);
  if (convention != sh::kConventionName)
    throw InputError(fmt::format("{}: unknown SH convention \"{}\"", file, convention));
  (void)field<std::string>(json, "compression", file);
  Transfer transfer;
  transfer.bands = field<int>(json, "bands", file);
  transfer.kind = choice_of(kind_from_string, field<std::string>(json, "transfer", file), file);
  transfer.bounces = parse_bounces(json, file);
  transfer.channels = field<int>(json, "channels", file);
  transfer.vertices = field<std::size_t>(json, "vertices", file);
  transfer.samples = field<std::int64_t>(json, "samples", file);
  transfer.seed = field<std::uint64_t>(json, "seed", file);
  if (transfer.bands < 1 || transfer.bands > sh::kMaxBands) {
    throw InputError(fmt::format("{}: bands: expected 1 to {}, got {}", file, sh::kMaxBands, transfer.bands));
  }
  if (transfer.channels != 1 && transfer.channels != 3)
    throw InputError(fmt::format("{}: channels: expected 1 or 3, got {}", file, transfer.channels));
  parse_method(json, file, transfer);
  if (auto compressed = parse_compressed(json, bytes, scene.positions.size(), file, transfer)) {
    return {std::move(scene), std::move(transfer), std::move(compressed)};
  }
  parse_data(json, bytes, file, transfer);
  return {std::move(scene), std::move(transfer), std::nullopt};
}

}  // namespace

void save_baked(const std::filesystem::path& path, const Baked& baked) {
  validate(baked.transfer, path.string());
  require_vertices(baked.transfer, baked.scene.positions.size(), path.string());
  nlohmann::json json = describe(baked.transfer);
  std::string bytes;
  if (baked.compressed) {
    compress::validate(*baked.compressed, path.string());
    require_same_shape(*baked.compressed, baked.transfer, path.string());
    compress::describe_block(*baked.compressed, json);
    json.erase("terms");  // the sum alone is compressed
    bytes = compress::to_block(*baked.compressed);
  } else {
    append(bytes, baked.transfer.coefficients);
    append(bytes, baked.transfer.standard_errors);
    for (const Term& term : baked.transfer.terms) {
      append(bytes, term.coefficients);
      append(bytes, term.standard_errors);
    }
  }
  scene::save_glb(baked.scene, path, {{kExtension, std::move(json), std::move(bytes)}});
}

Baked load_baked(const std::filesystem::path& path) {
  const std::string file = path.string();
  const std::optional<scene::GlbExtension> extension = scene::read_glb_extension(path, kExtension);
  if (!extension) throw InputError(file + ": holds no baked transfer (write one with `plumbline bake`)");
  Baked baked = parse(extension->json, extension->bytes, scene::load_scene(file), file);
  validate(baked.transfer, file);
  require_vertices(baked.transfer, baked.scene.positions.size(), file);
  return baked;
}

}  // namespace plumbline::transfer
