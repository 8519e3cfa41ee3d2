// plumbline bake: transfer vectors of a scene's vertices.
#include <fmt/format.h>

#include <chrono>

#include "prt/transfer/bake.hpp"
#include "prt/transfer/baked_file.hpp"
#include "validation/app/options.hpp"
#include "validation/app/verbs.hpp"

namespace plumbline::app {
namespace {

struct Options {
  SceneOptions scene;
  std::string output;
  int bands = 5;
  std::string kind = "shadowed";
  int samples = 1024;
  std::uint64_t seed = 0;
  int threads = 0;
  std::string json;
};

void warn_of_lights(const scene::Scene& scene) {
  bool is_emissive = !scene.lights.empty();
  for (const scene::Material& material : scene.materials) is_emissive |= !is_black(material.emission);
  if (is_emissive) {
    warn(
        "the scene's own lights are not part of the transfer: it holds the response to light from far away "
        "only");
  }
}

transfer::BakeSettings settings_of(const Options& options) {
  transfer::BakeSettings settings;
  settings.bands = options.bands;
  settings.kind = transfer::kind_from_string(options.kind);
  settings.samples = options.samples;
  settings.seed = options.seed;
  settings.threads = options.threads;
  settings.progress = progress_bar("bake");
  return settings;
}

void report(const Options& options, const transfer::Transfer& transfer, double seconds) {
  if (options.json != "-") {
    say(fmt::format("{}: {} transfer, {} vertices x {} bands, {} directions a vertex, {:.2f} s",
                    options.output, options.kind, transfer.vertices, transfer.bands, transfer.samples,
                    seconds));
  }
  write_json(options.json, {{"output", options.output},
                            {"transfer", options.kind},
                            {"bands", transfer.bands},
                            {"bounces", transfer.bounces},
                            {"vertices", transfer.vertices},
                            {"samples", transfer.samples},
                            {"seed", options.seed},
                            {"seconds", seconds}});
}

int run(const Options& options) {
  const transfer::BakeSettings settings = settings_of(options);
  require_destinations({{"-o", options.output, ".glb"}, {"--json", options.json, ""}});
  const auto start = std::chrono::steady_clock::now();
  transfer::Baked baked;
  baked.scene = load(options.scene);
  warn_of_lights(baked.scene);
  baked.transfer = transfer::bake(baked.scene, settings);
  transfer::save_baked(options.output, baked);
  report(options, baked.transfer, seconds_since(start));
  return kSuccess;
}

}  // namespace

void register_bake(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("bake", "precompute how every vertex responds to distant light");
  add_scene_options(*verb, options->scene);
  add_output(*verb, options->output, "baked file (.prt.glb) to write; any glTF viewer opens it")->required();
  add_bands(*verb, options->bands, "n bands: n^2 coefficients a vertex");
  verb->add_option("--transfer", options->kind, "unshadowed (closed form) or shadowed (default)")
      ->check(CLI::IsMember({"unshadowed", "shadowed", "interreflected"}));
  add_whole_number(*verb, "--samples", options->samples, {1}, "directions a vertex (default 1024)");
  add_seed(*verb, options->seed);
  add_threads(*verb, options->threads);
  add_json(*verb, options->json, "a summary");
  verb->footer("Example: plumbline bake builtin:plaza -o plaza.prt.glb --bands 5 --samples 1024");
  on_chosen(*verb, options, chosen, &run);
}

}  // namespace plumbline::app
