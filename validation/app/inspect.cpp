// plumbline inspect: what a baked file holds.
#include <fmt/format.h>

#include <string_view>

#include "prt/transfer/baked_file.hpp"
#include "reference/base/error.hpp"
#include "reference/base/text.hpp"
#include "reference/scene/text.hpp"
#include "validation/app/compressed_json.hpp"
#include "validation/app/options.hpp"
#include "validation/app/verbs.hpp"

namespace plumbline::app {
namespace {

struct Options {
  std::string input;
  std::string vertices;  // "I,J,..."
  std::string json;
};

std::vector<std::size_t> requested(const Options& options, std::size_t count) {
  std::vector<std::size_t> vertices;
  if (options.vertices.empty()) return vertices;
  for (const std::string_view word : split(options.vertices, ',')) {
    const auto vertex = scene::parse_integer(word);
    if (!vertex || *vertex < 0 || static_cast<std::size_t>(*vertex) >= count) {
      throw InputError(fmt::format("--vertices: {}: expected numbers from 0 to {}, got {}", options.input,
                                   count - 1, quoted(one_line(word))));
    }
    vertices.push_back(static_cast<std::size_t>(*vertex));
  }
  return vertices;
}

/// Rows r, g, b of a vertex of one of the transfer's arrays.
nlohmann::json rows_of(const transfer::Transfer& transfer, const std::vector<float>& values,
                       std::size_t vertex) {
  nlohmann::json rows = nlohmann::json::array();
  for (int c = 0; c < 3; ++c) {
    const std::span<const float> row = transfer.row_of(values, vertex, c);
    rows.push_back(std::vector<float>(row.begin(), row.end()));
  }
  return rows;
}

nlohmann::json vectors_of(const transfer::Transfer& transfer, const std::vector<std::size_t>& vertices) {
  nlohmann::json result = nlohmann::json::object();
  for (const std::size_t v : vertices)
    result[std::to_string(v)] = rows_of(transfer, transfer.coefficients, v);
  return result;
}

/// By vertex a list of bounces, each with its rows r, g, b.
nlohmann::json terms_of(const transfer::Transfer& transfer, const std::vector<std::size_t>& vertices) {
  nlohmann::json result = nlohmann::json::object();
  for (const std::size_t v : vertices) {
    nlohmann::json terms = nlohmann::json::array();
    for (const transfer::Term& term : transfer.terms)
      terms.push_back(rows_of(transfer, term.coefficients, v));
    result[std::to_string(v)] = std::move(terms);
  }
  return result;
}

nlohmann::json description(const transfer::Baked& baked) {
  const transfer::Transfer& transfer = baked.transfer;
  const std::size_t bytes =
      transfer.vertices == 0 ? 0 : transfer.coefficients.size() * sizeof(float) / transfer.vertices;
  const bool is_endless = transfer.bounces == transfer::kAllBounces;
  nlohmann::json json = {{"bands", transfer.bands},
                         {"transfer", std::string(to_string(transfer.kind))},
                         {"bounces", is_endless ? nlohmann::json("all") : nlohmann::json(transfer.bounces)},
                         {"terms", transfer.terms.size()},
                         {"vertices", transfer.vertices},
                         {"triangles", baked.scene.triangles.size()},
                         {"channels", transfer.channels},
                         {"bytes_per_vertex", bytes},
                         {"compression", "none"},
                         {"samples", transfer.samples},
                         {"seed", transfer.seed}};
  if (transfer.kind == transfer::Kind::unshadowed) return json;
  json["sampling"] = std::string(to_string(transfer.method.sampling));
  json["directions"] = std::string(to_string(transfer.method.directions));
  if (transfer.target_error > 0.0) json["target_error"] = transfer.target_error;
  if (transfer.kind == transfer::Kind::interreflected) {
    json["solver"] = std::string(to_string(transfer.method.solver));
    json["remainder"] = transfer.remainder;
  }
  return json;
}

std::string text_of(const std::string& name, const nlohmann::json& json) {
  std::string text = name + "\n";
  for (const auto& [key, value] : json.items()) {
    if (value.is_object()) continue;
    text += fmt::format("  {:<18} {}\n", key, value.is_string() ? value.get<std::string>() : value.dump());
  }
  for (const auto& [vertex, rows] : json["transfer_vectors"].items()) {
    text += fmt::format("  vertex {}\n", vertex);
    for (std::size_t c = 0; c < rows.size(); ++c)
      text += fmt::format("    {} {}\n", "rgb"[c], rows[c].dump());
  }
  return text;
}

int run(const Options& options) {
  require_destinations({{"--json", options.json, ""}});
  const transfer::Baked baked = transfer::load_baked(options.input);
  nlohmann::json json = description(baked);
  if (baked.compressed) json.update(compressed_json(*baked.compressed));
  const std::vector<std::size_t> vertices = requested(options, baked.transfer.vertices);
  json["transfer_vectors"] = vectors_of(baked.transfer, vertices);
  if (!baked.transfer.terms.empty()) json["term_vectors"] = terms_of(baked.transfer, vertices);
  if (options.json != "-") write_output("-", text_of(options.input, json));
  write_json(options.json, json);
  return kSuccess;
}

}  // namespace

void register_inspect(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("inspect", "what a baked file holds");
  verb->add_option("BAKED", options->input, "file written by `plumbline bake`")->required();
  verb->add_option("--vertices", options->vertices, "vertices whose transfer vectors to give: I,J,...");
  add_json(*verb, options->json, "everything");
  verb->footer("Example: plumbline inspect plaza.prt.glb --vertices 0,17 --json -");
  on_chosen(*verb, options, chosen, &run);
}

}  // namespace plumbline::app
