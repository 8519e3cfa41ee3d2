// plumbline bake: transfer vectors of a scene's vertices.
#include <fmt/format.h>

#include <chrono>

#include "prt/sh/basis.hpp"
#include "prt/transfer/bake.hpp"
#include "prt/transfer/baked_file.hpp"
#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
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
  if (is_emissive)
    warn(
        "the scene's own lights are not part of the transfer: it holds the response to light from far away "
        "only");
}

int run(const Options& options) {
  transfer::BakeSettings settings;
  settings.bands = options.bands;
  settings.kind = transfer::kind_from_string(options.kind);
  settings.samples = options.samples;
  settings.seed = options.seed;
  settings.threads = options.threads;
  settings.progress = progress_bar("bake");
  require_writable(options.output);
  const auto start = std::chrono::steady_clock::now();
  transfer::Baked baked;
  sh::require_bands(settings.bands);
  baked.scene = load(options.scene);
  warn_of_lights(baked.scene);
  baked.transfer = transfer::bake(baked.scene, settings);
  transfer::save_baked(options.output, baked);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (options.json != "-") {
    fmt::print("{}: {} transfer, {} vertices x {} bands, {} directions a vertex, {:.2f} s\n", options.output,
               options.kind, baked.transfer.vertices, baked.transfer.bands, baked.transfer.samples, seconds);
  }
  write_json(options.json, {{"output", options.output},
                            {"transfer", options.kind},
                            {"bands", baked.transfer.bands},
                            {"bounces", baked.transfer.bounces},
                            {"vertices", baked.transfer.vertices},
                            {"samples", baked.transfer.samples},
                            {"seed", options.seed},
                            {"seconds", seconds}});
  return kSuccess;
}

}  // namespace

void register_bake(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("bake", "precompute how every vertex responds to distant light");
  add_scene_options(*verb, options->scene);
  verb->add_option("-o,--output", options->output, "baked file (.prt.glb) to write; any glTF viewer opens it")
      ->required();
  verb->add_option("--bands", options->bands, "n bands: n^2 coefficients a vertex")->required();
  verb->add_option("--transfer", options->kind, "unshadowed (closed form) or shadowed (default)")
      ->check(CLI::IsMember({"unshadowed", "shadowed", "interreflected"}));
  verb->add_option("--samples", options->samples, "directions a vertex (default 1024)");
  verb->add_option("--seed", options->seed, "same seed, same bits");
  verb->add_option("--threads", options->threads, "0 = all; never changes the result")
      ->check(CLI::Range(0, 4096));
  verb->add_option("--json", options->json, "write a summary to this file, or - for standard output");
  verb->footer("Example: plumbline bake builtin:plaza -o plaza.prt.glb --bands 5 --samples 1024");
  verb->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace plumbline::app
