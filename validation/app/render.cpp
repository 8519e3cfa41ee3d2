// plumbline render: a path-traced image with its standard error.
#include <fmt/format.h>

#include <sstream>

#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/image/exr.hpp"
#include "reference/integrate/render.hpp"
#include "reference/integrate/shards.hpp"
#include "reference/scene/load.hpp"
#include "validation/app/verbs.hpp"

namespace plumbline::app {
namespace {

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
  std::string shard = "0/1";
  int threads = 0;
  std::string layers;
  std::string json;
  CLI::Option* has_spp = nullptr;
  CLI::Option* has_target = nullptr;
  CLI::Option* has_seconds = nullptr;
};

integrate::Layers parse_layers(const std::string& list) {
  integrate::Layers layers;
  std::stringstream words(list);
  for (std::string word; std::getline(words, word, ',');) {
    const bool is_all = word == "all";
    if (!is_all && word != "emission" && word != "bounces" && word != "albedo" && word != "normal" &&
        word != "position" && word != "depth") {
      throw InputError(fmt::format(
          "--layers: expected emission, bounces, albedo, normal, position, depth or all, got {}", word));
    }
    layers.emission |= is_all || word == "emission";
    layers.bounces |= is_all || word == "bounces";
    layers.albedo |= is_all || word == "albedo";
    layers.normal |= is_all || word == "normal";
    layers.position |= is_all || word == "position";
    layers.depth |= is_all || word == "depth";
  }
  return layers;
}

integrate::Shard parse_shard(const std::string& text) {
  integrate::Shard shard;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%d/%d%c", &shard.index, &shard.count, &rest) != 2) {
    throw InputError(fmt::format("--shard: expected i/N with 0 <= i < N, got {}", text));
  }
  return shard;
}

integrate::RenderSettings settings_of(const Options& options) {
  integrate::RenderSettings settings;
  const Size size = parse_size(options.size);
  settings.width = size.width;
  settings.height = size.height;
  settings.samples_per_pixel = options.spp;
  if (options.has_target->count() > 0) settings.target_error = options.target_error;
  if (options.has_seconds->count() > 0) settings.max_seconds = options.max_seconds;
  if (options.has_spp->count() > 0 && (settings.target_error || settings.max_seconds)) {
    throw InputError("--spp: give either a sample count or --target-error / --max-seconds");
  }
  settings.max_bounces = parse_bounces(options.bounces);
  settings.seed = options.seed;
  settings.threads = options.threads;
  settings.shard = parse_shard(options.shard);
  settings.layers = parse_layers(options.layers);
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
  if (!o.light.source.empty()) command += " --env " + quoted(o.light.source);
  if (o.light.layout != "auto") command += " --env-layout " + o.light.layout;
  if (o.light.lookup != "nearest") command += " --env-lookup " + o.light.lookup;
  if (!o.light.rotation_deg.empty()) {
    command += fmt::format(" --rotate-env {},{},{}", o.light.rotation_deg[0], o.light.rotation_deg[1],
                           o.light.rotation_deg[2]);
  }
  if (o.has_target->count() > 0 && o.has_seconds->count() == 0) {
    command += fmt::format(" --target-error {}", o.target_error);
  } else if (o.has_seconds->count() > 0) {
    command += fmt::format(" --max-seconds {}", o.max_seconds);
    if (o.has_target->count() > 0) command += fmt::format(" --target-error {}", o.target_error);
  } else {
    command += fmt::format(" --spp {}", result.samples_per_pixel);
  }
  command += fmt::format(" --bounces {} --size {} --seed {}", o.bounces, o.size, o.seed);
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
                      {"plumbline.samplesPerPixel", std::to_string(result.samples_per_pixel)},
                      {"plumbline.bounces", bounces_text(settings.max_bounces)},
                      {"plumbline.command", reproducing_command(options, result)}};
  if (settings.shard.count > 1) {
    image.attributes[integrate::kShardAttribute] =
        fmt::format("{}/{}", settings.shard.index, settings.shard.count);
  }
}

int run(const Options& options) {
  const integrate::RenderSettings settings = settings_of(options);
  require_writable(options.output);
  if (options.spp < 1) throw InputError(fmt::format("--spp: expected at least 1, got {}", options.spp));
  const integrate::World world(load(options.scene), load(options.light));
  const scene::Camera& camera = scene::find_camera(world.scene, options.scene.camera);
  if (world.is_sky_black && world.emitters.is_empty() && world.scene.lights.empty()) {
    warn("no light: the scene has no emitter and no --env was given, the image is black");
  }
  integrate::RenderResult result = integrate::render(world, camera, settings);
  set_attributes(result.image, options, world, settings, result, camera.name);
  image::write_exr(options.output, result.image);
  if (result.samples_per_pixel < 2)
    warn("a single sample has no standard error: the stderr layers are infinite");
  if (options.json != "-") {
    fmt::print(
        "{}: {} samples a pixel, mean radiance {:.6g}, relative standard error {:.3g}, {:.2f} s, stopped by "
        "{}\n",
        options.output, result.samples_per_pixel, result.mean_radiance, result.relative_error, result.seconds,
        stop_text(result.stop));
  }
  write_json(options.json, {{"output", options.output},
                            {"scene", options.scene.source},
                            {"scene_hash", result.image.attributes.at("plumbline.sceneHash")},
                            {"environment", world.environment.name},
                            {"environment_lookup", options.light.lookup},
                            {"width", settings.width},
                            {"height", settings.height},
                            {"samples_per_pixel", result.samples_per_pixel},
                            {"relative_error", number(result.relative_error)},
                            {"mean_radiance", number(result.mean_radiance)},
                            {"bounces", bounces_text(settings.max_bounces)},
                            {"seed", settings.seed},
                            {"seconds", result.seconds},
                            {"stop", stop_text(result.stop)},
                            {"command", result.image.attributes.at("plumbline.command")}});
  return kSuccess;
}

}  // namespace

void register_render(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("render", "path-trace an image; every pixel with its standard error");
  add_scene_options(*verb, options->scene);
  add_light_options(*verb, options->light, false);
  verb->add_option("-o,--output", options->output, "layered OpenEXR image to write")->required();
  options->has_spp = verb->add_option("--spp", options->spp, "samples a pixel (default 64)");
  options->has_target = verb->add_option(
      "--target-error", options->target_error,
      "stop when the root of the mean squared standard error over the mean radiance is this small");
  options->has_seconds =
      verb->add_option("--max-seconds", options->max_seconds, "stop after this time, whatever the error");
  verb->add_option("--bounces", options->bounces,
                   "indirect bounces: 0 = direct light only, all = no limit (default)");
  verb->add_option("--size", options->size, "image size WxH (default 256x256)");
  add_camera_option(*verb, options->scene);
  verb->add_option("--seed", options->seed, "same seed, same bits");
  verb->add_option("--shard", options->shard,
                   "render part i of N (i/N); `plumbline merge` puts the parts together");
  verb->add_option("--threads", options->threads, "0 = all; never changes the image")
      ->check(CLI::Range(0, 4096));
  verb->add_option("--layers", options->layers,
                   "further layers: emission,bounces,albedo,normal,position,depth or all");
  verb->add_option("--json", options->json, "write a summary to this file, or - for standard output");
  verb->footer("Example: plumbline render builtin:cornell -o cornell.exr --spp 256 --layers bounces");
  verb->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace plumbline::app
