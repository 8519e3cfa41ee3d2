// plumbline bake: transfer vectors of a scene's vertices.
#include <fmt/format.h>

#include <chrono>

#include "prt/transfer/bake.hpp"
#include "prt/transfer/baked_file.hpp"
#include "prt/transfer/plan.hpp"
#include "reference/base/error.hpp"
#include "reference/trace/surface_point.hpp"
#include "validation/app/options.hpp"
#include "validation/app/verbs.hpp"

namespace plumbline::app {
namespace {

struct Options {
  SceneOptions scene;
  std::string output;
  int bands = 5;
  std::string kind = "shadowed";
  std::string bounces;
  std::string solver = "traced";
  std::string sampling = "qmc";
  std::string directions = "per-vertex";
  int kept_terms = 0;
  int samples = 0;  // 0: not asked for
  double target_error = 0.0;
  bool is_explaining = false;
  bool is_skipping = true;
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

/// Bounces asked of a transfer that has none are a misunderstanding.
void refuse_bounces(const std::string& kind, const std::string& bounces) {
  if (kind == "interreflected" || bounces.empty() || bounces == "0") return;
  throw InputError(fmt::format("--bounces: {} transfer has none; add --transfer interreflected", kind));
}

transfer::BakeSettings settings_of(const Options& options) {
  transfer::BakeSettings settings;
  settings.bands = options.bands;
  settings.kind = transfer::kind_from_string(options.kind);
  settings.target_error = options.target_error;
  settings.samples = options.samples > 0 ? options.samples : options.target_error > 0.0 ? 256 : 1024;
  settings.is_skipping = options.is_skipping;
  settings.method = {transfer::solver_from_string(options.solver),
                     transfer::sampling_from_string(options.sampling),
                     transfer::direction_sets_from_string(options.directions)};
  refuse_bounces(options.kind, options.bounces);
  settings.max_bounces = parse_bounces(options.bounces.empty() ? "all" : options.bounces);
  settings.kept_terms = options.kept_terms;
  settings.seed = options.seed;
  settings.threads = options.threads;
  settings.progress = progress_bar("bake");
  return settings;
}

nlohmann::json bounces_json(int bounces) {
  return bounces == transfer::kAllBounces ? nlohmann::json("all") : nlohmann::json(bounces);
}

nlohmann::json plan_json(const transfer::Plan& plan) {
  nlohmann::json skips = nlohmann::json::array();
  for (const transfer::Skip& skip : plan.skips) {
    skips.push_back(
        {{"skip", skip.what}, {"where", skip.where}, {"because", skip.why}, {"change", skip.change}});
  }
  return skips;
}

nlohmann::json summary(const Options& options, const transfer::Plan& plan, const transfer::Transfer& transfer,
                       double seconds) {
  nlohmann::json json = {{"output", options.output},      {"transfer", options.kind},
                         {"bands", transfer.bands},       {"bounces", bounces_json(transfer.bounces)},
                         {"channels", transfer.channels}, {"terms", transfer.terms.size()},
                         {"vertices", transfer.vertices}, {"samples", transfer.samples},
                         {"seed", options.seed},          {"seconds", seconds},
                         {"plan", plan_json(plan)}};
  if (transfer.kind == transfer::Kind::unshadowed) return json;
  json["mean_samples"] = transfer.mean_samples;
  if (options.target_error > 0.0) {
    json["target_error"] = options.target_error;
    json["vertices_above_target"] = transfer.above_target;
  }
  json["sampling"] = options.sampling;
  json["directions"] = options.directions;
  if (transfer.kind == transfer::Kind::interreflected) {
    json["solver"] = options.solver;
    json["remainder"] = transfer.remainder;
  }
  return json;
}

void report(const Options& options, const transfer::Plan& plan, const transfer::Transfer& transfer,
            double seconds) {
  if (transfer.above_target > 0) {
    warn(fmt::format("{} of {} vertices are above the target error after {} directions",
                     transfer.above_target, transfer.vertices, transfer.samples));
  }
  if (options.json != "-") {
    say(fmt::format("{}: {} transfer, {} vertices x {} bands, {:.0f} directions a vertex, {:.2f} s",
                    options.output, options.kind, transfer.vertices, transfer.bands, transfer.mean_samples,
                    seconds));
  }
  write_json(options.json, summary(options, plan, transfer, seconds));
}

int run(const Options& options) {
  const transfer::BakeSettings settings = settings_of(options);
  require_destinations({{"-o", options.output, ".glb"}, {"--json", options.json, ""}});
  const auto start = std::chrono::steady_clock::now();
  transfer::Baked baked;
  baked.scene = load(options.scene);
  warn_of_lights(baked.scene);
  scene::refuse_primitives(baked.scene, "transfer");
  const transfer::Plan plan = transfer::make_plan(baked.scene, trace::vertex_points(baked.scene), settings);
  if (options.is_explaining && options.json != "-") write_output("-", to_text(plan));
  baked.transfer = transfer::bake(baked.scene, settings, plan);
  transfer::save_baked(options.output, baked);
  report(options, plan, baked.transfer, seconds_since(start));
  return kSuccess;
}

void add_transfer_options(CLI::App& verb, Options& options) {
  verb.add_option("--transfer", options.kind,
                  "unshadowed (closed form), shadowed (default) or interreflected")
      ->check(CLI::IsMember({"unshadowed", "shadowed", "interreflected"}));
  verb.add_option("--bounces", options.bounces, "of interreflected transfer: 0, 1, 2, ... or all (default)");
  verb.add_option(
          "--solver", options.solver,
          "traced (default): unbiased on any mesh; iterative: less noise, interpolates between vertices")
      ->check(CLI::IsMember({"traced", "iterative"}));
  verb.add_option("--sampling", options.sampling,
                  "qmc (default: shifted lattice), cosine (stratified) or uniform (stratified sphere)")
      ->check(CLI::IsMember({"qmc", "cosine", "uniform"}));
  verb.add_option("--directions", options.directions,
                  "per-vertex (default: errors of neighbours are independent) or shared by all vertices")
      ->check(CLI::IsMember({"per-vertex", "shared"}));
}

}  // namespace

void register_bake(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("bake", "precompute how every vertex responds to distant light");
  add_scene_options(*verb, options->scene);
  add_output(*verb, options->output, "baked file (.prt.glb) to write; any glTF viewer opens it")->required();
  add_bands(*verb, options->bands, "n bands: n^2 coefficients a vertex");
  add_transfer_options(*verb, *options);
  add_whole_number(*verb, "--samples", options->samples, {1},
                   "directions a vertex (default 1024; with --target-error 256 to begin with)");
  add_positive(*verb, "--target-error", options->target_error,
               "draw at every vertex until its error is this, relative to an unshadowed vector");
  verb->add_flag("--explain", options->is_explaining, "say what the plan skips, and why");
  verb->add_flag("!--no-skip", options->is_skipping, "do what the plan would skip too");
  add_whole_number(*verb, "--keep-terms", options->kept_terms, {0},
                   "keep the first N bounces apart, direct light first (default 0)");
  add_seed(*verb, options->seed);
  add_threads(*verb, options->threads);
  add_json(*verb, options->json, "a summary");
  verb->footer(
      "Example: plumbline bake builtin:plaza -o plaza.prt.glb --bands 5 --transfer interreflected --bounces "
      "3");
  on_chosen(*verb, options, chosen, &run);
}

}  // namespace plumbline::app
