// plumbline inspect: what a baked file holds.
#include <fmt/format.h>

#include "prt/transfer/baked_file.hpp"
#include "reference/base/error.hpp"
#include "validation/app/verbs.hpp"

namespace plumbline::app {
namespace {

struct Options {
  std::string input;
  std::vector<std::size_t> vertices;
  std::string json;
};

nlohmann::json vectors_of(const transfer::Transfer& transfer, const std::vector<std::size_t>& vertices) {
  nlohmann::json result = nlohmann::json::object();
  for (const std::size_t v : vertices) {
    if (v >= transfer.vertices)
      throw InputError(fmt::format("--vertices: expected 0 to {}, got {}", transfer.vertices - 1, v));
    nlohmann::json rows = nlohmann::json::array();
    for (int c = 0; c < 3; ++c) {
      const std::span<const float> row = transfer.vector(v, c);
      rows.push_back(std::vector<float>(row.begin(), row.end()));
    }
    result[std::to_string(v)] = std::move(rows);
  }
  return result;
}

int run(const Options& options) {
  const transfer::Baked baked = transfer::load_baked(options.input);
  const transfer::Transfer& transfer = baked.transfer;
  const std::size_t bytes =
      transfer.vertices == 0 ? 0 : transfer.coefficients.size() * sizeof(float) / transfer.vertices;
  if (options.json != "-") {
    fmt::print(
        "{}: {} transfer, {} bands, {} bounces, {} vertices, {} channel(s), {} bytes a vertex, {} directions "
        "a vertex\n",
        options.input, to_string(transfer.kind), transfer.bands, transfer.bounces, transfer.vertices,
        transfer.channels, bytes, transfer.samples);
  }
  write_json(options.json, {{"bands", transfer.bands},
                            {"transfer", std::string(to_string(transfer.kind))},
                            {"bounces", transfer.bounces},
                            {"vertices", transfer.vertices},
                            {"triangles", baked.scene.triangles.size()},
                            {"channels", transfer.channels},
                            {"bytes_per_vertex", bytes},
                            {"compression", "none"},
                            {"samples", transfer.samples},
                            {"seed", transfer.seed},
                            {"transfer_vectors", vectors_of(transfer, options.vertices)}});
  return kSuccess;
}

}  // namespace

void register_inspect(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("inspect", "what a baked file holds");
  verb->add_option("BAKED", options->input, "file written by `plumbline bake`")->required();
  verb->add_option("--vertices", options->vertices, "vertices whose transfer vectors to give: I,J,...")
      ->delimiter(',');
  verb->add_option("--json", options->json, "write everything to this file, or - for standard output");
  verb->footer("Example: plumbline inspect plaza.prt.glb --vertices 0,17 --json -");
  verb->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace plumbline::app
