#include "prt/transfer/baked_file.hpp"

#include <fmt/format.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>

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

nlohmann::json describe(const Transfer& transfer) {
  nlohmann::json json = {{"version", kVersion},
                         {"bands", transfer.bands},
                         {"convention", sh::kConventionName},
                         {"transfer", std::string(to_string(transfer.kind))},
                         {"bounces", transfer.bounces},
                         {"channels", transfer.channels},
                         {"vertices", transfer.vertices},
                         {"samples", transfer.samples},
                         {"seed", transfer.seed},
                         {"compression", "none"},
                         {"componentType", "float32"}};
  json["hasStandardErrors"] = !transfer.standard_errors.empty();
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

Kind kind_of(const std::string& text, const std::string& file) {
  try {
    return kind_from_string(text);
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
  transfer.kind = kind_of(field<std::string>(json, "transfer", file), file);
  transfer.bounces = field<int>(json, "bounces", file);
  transfer.channels = field<int>(json, "channels", file);
  transfer.vertices = field<std::size_t>(json, "vertices", file);
  transfer.samples = field<std::int64_t>(json, "samples", file);
  transfer.seed = field<std::uint64_t>(json, "seed", file);
  if (transfer.bands < 1 || transfer.bands > sh::kMaxBands) {
    throw InputError(fmt::format("{}: bands: expected 1 to {}, got {}", file, sh::kMaxBands, transfer.bands));
  }
  if (transfer.channels != 1 && transfer.channels != 3)
    throw InputError(fmt::format("{}: channels: expected 1 or 3, got {}", file, transfer.channels));
  if (auto compressed = parse_compressed(json, bytes, scene.positions.size(), file, transfer)) {
    return {std::move(scene), std::move(transfer), std::move(compressed)};
  }
  // In units of one vertex, so that no hostile count can overflow.
  const auto per_vertex =
      static_cast<std::size_t>(sh::coefficient_count(transfer.bands) * transfer.channels) * sizeof(float);
  const std::size_t parts = field<bool>(json, "hasStandardErrors", file) ? 2 : 1;
  if (bytes.size() % (per_vertex * parts) != 0 || bytes.size() / (per_vertex * parts) != transfer.vertices) {
    throw InputError(
        fmt::format("{}: transfer of {} vertices x {} channels x {} bands does not fill its {} bytes", file,
                    transfer.vertices, transfer.channels, transfer.bands, bytes.size()));
  }
  const std::size_t size = per_vertex * transfer.vertices;
  transfer.coefficients.resize(size / sizeof(float));
  std::memcpy(transfer.coefficients.data(), bytes.data(), size);
  if (parts == 2) {
    transfer.standard_errors.resize(size / sizeof(float));
    std::memcpy(transfer.standard_errors.data(), bytes.data() + size, size);
  }
  return {std::move(scene), std::move(transfer)};
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
    bytes = compress::to_block(*baked.compressed);
  } else {
    append(bytes, baked.transfer.coefficients);
    append(bytes, baked.transfer.standard_errors);
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
