// plumbline render: a path-traced image with its standard error.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>

#include "reference/base/error.hpp"
#include "reference/base/text.hpp"
#include "reference/image/exr.hpp"
#include "reference/integrate/render.hpp"
#include "reference/integrate/shards.hpp"
#include "reference/scene/text.hpp"
#include "validation/app/options.hpp"
#include "validation/app/verbs.hpp"

namespace plumbline::app {
namespace {

constexpr int kMostShards = 1 << 20;

struct Options {
  SceneOptions scene;
  LightOptions light;
  std::string output;
  int spp = 64;
  double target_error = 0.0;
  double max_seconds = 0.0;
  std::string bounces = "all";
  std::string size = "256x256";
  std::uint64_t seed = 0;
  int randomisations = integrate::kRandomisations;
  std::string shard;  // empty: the whole image
  int threads = 0;
  std::string layers;
  std::string json;
  CLI::Option* has_spp = nullptr;
  CLI::Option* has_target = nullptr;
  CLI::Option* has_seconds = nullptr;
};

/// `all` means all that there can be: a single sample has no halves.
integrate::Layers parse_layers(const std::string& list, bool can_be_halved) {
  integrate::Layers layers;
  if (list.empty()) return layers;
  for (const std::string_view word : split(list, ',')) {
    const bool is_all = word == "all";
    if (!is_all && word != "emission" && word != "bounces" && word != "albedo" && word != "normal" &&
        word != "position" && word != "depth" && word != "direct" && word != "indirect" && word != "halves") {
      throw InputError(
          fmt::format("--layers: expected emission, bounces, direct, indirect, halves, albedo, normal, "
                      "position, depth or all, got {}",
                      quoted(one_line(word))));
    }
    layers.emission |= is_all || word == "emission";
    layers.bounces |= is_all || word == "bounces";
    layers.albedo |= is_all || word == "albedo";
    layers.normal |= is_all || word == "normal";
    layers.position |= is_all || word == "position";
    layers.depth |= is_all || word == "depth";
    layers.direct |= is_all || word == "direct";
    layers.indirect |= is_all || word == "indirect";
    layers.halves |= word == "halves" || (is_all && can_be_halved);
  }
  return layers;
}

integrate::Shard parse_shard(const std::string& text) {
  const std::size_t slash = std::min(text.find('/'), text.size());
  const auto index = scene::parse_integer(text.substr(0, slash));
  const auto count = scene::parse_integer(text.substr(std::min(slash + 1, text.size())));
  const bool is_valid = index && count && *index >= 0 && *index < *count && *count <= kMostShards;
  if (!is_valid) {
    throw InputError(fmt::format("--shard: expected i/N with 0 <= i < N <= {}, got {}", kMostShards,
                                 quoted(one_line(text))));
  }
  return {static_cast<int>(*index), static_cast<int>(*count)};
}

integrate::RenderSettings settings_of(const Options& options) {
  integrate::RenderSettings settings;
  const Size size = parse_size(options.size);
  settings.width = size.width;
  settings.height = size.height;
  settings.samples_per_pixel = options.spp;
  if (options.has_target->count() > 0) settings.target_error = options.target_error;
  if (options.has_seconds->count() > 0) settings.max_seconds = options.max_seconds;
  const bool is_progressive = settings.target_error || settings.max_seconds;
  if (options.has_spp->count() > 0 && is_progressive) {
    throw InputError("--spp: give either a sample count or --target-error / --max-seconds");
  }
  settings.max_bounces = parse_bounces(options.bounces);
  settings.seed = options.seed;
  settings.randomisations = options.randomisations;
  settings.threads = options.threads;
  if (!options.shard.empty()) settings.shard = parse_shard(options.shard);
  if (settings.shard.count > 1 && is_progressive) {
    throw InputError(
        "--shard: a part cannot know the whole image's error or share its time: give --spp instead of "
        "--target-error / --max-seconds");
  }
  settings.layers = parse_layers(
      options.layers, settings.samples_per_pixel > 1 || settings.target_error || settings.max_seconds);
  settings.progress = progress_bar("render");
  return settings;
}

// What makes the image again: no output name, threads or shard, so that merged shards equal the single run
// bit for bit.
std::string reproducing_command(const Options& o, const integrate::RenderResult& result) {
  std::string command = fmt::format("plumbline render {}", quoted(o.scene.source));
  if (o.scene.crease_deg > 0.0F) command += fmt::format(" --crease {}", o.scene.crease_deg);
  if (o.scene.has_ground) command += " --ground";
  if (!o.scene.camera.empty()) command += " --camera " + quoted(o.scene.camera);
  command += command_text(o.light);
  if (o.has_target->count() > 0 && o.has_seconds->count() == 0) {
    command += fmt::format(" --target-error {}", o.target_error);
  } else if (o.has_seconds->count() > 0) {
    command += fmt::format(" --max-seconds {}", o.max_seconds);
    if (o.has_target->count() > 0) command += fmt::format(" --target-error {}", o.target_error);
  } else {
    command += fmt::format(" --spp {}", result.samples_per_pixel);
  }
  command += fmt::format(" --bounces {} --size {} --seed {}", o.bounces, o.size, o.seed);
  if (o.randomisations != integrate::kRandomisations)
    command += fmt::format(" --randomisations {}", o.randomisations);
  if (!o.layers.empty()) command += " --layers " + o.layers;
  return command;
}

const char* stop_text(integrate::StopReason stop) {
  switch (stop) {
    case integrate::StopReason::samples:
      return "samples";
    case integrate::StopReason::target_error:
      return "target-error";
    case integrate::StopReason::max_seconds:
      return "max-seconds";
  }
  return "?";
}

void set_attributes(image::LayeredImage& image, const Options& options, const integrate::World& world,
                    const integrate::RenderSettings& settings, const integrate::RenderResult& result,
                    const std::string& camera) {
  image.attributes = {{"plumbline.version", PLUMBLINE_VERSION},
                      {"plumbline.scene", options.scene.source},
                      {"plumbline.sceneHash", scene::fingerprint(world.scene)},
                      {"plumbline.environment", world.environment.name},
                      {"plumbline.environmentLookup", options.light.lookup},
                      {"plumbline.camera", camera},
                      {"plumbline.seed", std::to_string(settings.seed)},
                      {"plumbline.randomisations", std::to_string(settings.randomisations)},
                      {"plumbline.samplesPerPixel", std::to_string(result.samples_per_pixel)},
                      {"plumbline.bounces", bounces_text(settings.max_bounces)},
                      {"plumbline.command", reproducing_command(options, result)}};
  if (!options.shard.empty()) {
    image.attributes[integrate::kShardAttribute] =
        fmt::format("{}/{}", settings.shard.index, settings.shard.count);
  }
}

void report(const Options& options, const integrate::RenderSettings& settings,
            const integrate::RenderResult& result) {
  if (options.json != "-") {
    say(
        fmt::format("{}: {} samples a pixel, mean radiance {:.6g}, relative standard error {:.3g}, {:.2f} s, "
                    "stopped by {}",
                    options.output, result.samples_per_pixel, result.mean_radiance, result.relative_error,
                    result.seconds, stop_text(result.stop)));
  }
  const std::map<std::string, std::string>& attributes = result.image.attributes;
  write_json(options.json, {{"output", options.output},
                            {"scene", options.scene.source},
                            {"scene_hash", attributes.at("plumbline.sceneHash")},
                            {"environment", attributes.at("plumbline.environment")},
                            {"environment_lookup", options.light.lookup},
                            {"width", settings.width},
                            {"height", settings.height},
                            {"samples_per_pixel", result.samples_per_pixel},
                            {"relative_error", number(result.relative_error)},
                            {"mean_radiance", number(result.mean_radiance)},
                            {"bounces", bounces_text(settings.max_bounces)},
                            {"seed", settings.seed},
                            {"randomisations", settings.randomisations},
                            {"seconds", result.seconds},
                            {"stop", stop_text(result.stop)},
                            {"command", attributes.at("plumbline.command")}});
}

int run(const Options& options) {
  const integrate::RenderSettings settings = settings_of(options);
  require_destinations({{"-o", options.output, ".exr"}, {"--json", options.json, ""}});
  const integrate::World world(load(options.scene), load(options.light));
  const scene::Camera& camera = camera_of(world.scene, options.scene.camera);
  if (world.is_sky_black && world.emitters.is_empty() && world.scene.lights.empty()) {
    warn("no light: the scene has no emitter and no --env was given, the image is black");
  }
  integrate::RenderResult result = integrate::render(world, camera, settings);
  set_attributes(result.image, options, world, settings, result, camera.name);
  image::write_exr(options.output, result.image);
  if (result.samples_per_pixel < 2)
    warn("a single sample has no standard error: the stderr layers are infinite");
  report(options, settings, result);
  return kSuccess;
}

}  // namespace

void register_render(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("render", "path-trace an image; every pixel with its standard error");
  add_scene_options(*verb, options->scene);
  add_light_options(*verb, options->light, false);
  add_output(*verb, options->output, "layered OpenEXR image to write")->required();
  options->has_spp = add_whole_number(*verb, "--spp", options->spp, {1}, "samples a pixel (default 64)");
  options->has_target = add_positive(
      *verb, "--target-error", options->target_error,
      "stop when the root of the mean squared standard error over the mean radiance is this small");
  options->has_seconds =
      add_positive(*verb, "--max-seconds", options->max_seconds, "stop after this time, whatever the error");
  add_bounces(*verb, options->bounces);
  add_size(*verb, options->size);
  add_camera_option(*verb, options->scene.camera);
  add_seed(*verb, options->seed);
  verb->add_option("--randomisations", options->randomisations,
                   "Independent point sequences a pixel, 2 to 32. Fewer are longer and converge faster; the "
                   "standard error then "
                   "rests on fewer degrees of freedom")
      ->capture_default_str();
  verb->add_option("--shard", options->shard,
                   "render part i of N (i/N); `plumbline merge` puts the parts together");
  add_threads(*verb, options->threads);
  verb->add_option(
      "--layers", options->layers,
      "further layers: emission (light seen directly), bounces (bounce0 ...), direct (= bounce0), "
      "indirect (bounces 1 and more), halves (a, b: means of two independent halves of the "
      "samples), albedo, normal, position, depth; a list with commas, or all");
  add_json(*verb, options->json, "a summary");
  verb->footer("Example: plumbline render builtin:cornell -o cornell.exr --spp 256 --layers bounces");
  on_chosen(*verb, options, chosen, &run);
}

}  // namespace plumbline::app
