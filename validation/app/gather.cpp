// plumbline gather: irradiance or light probes at points or vertices.
#include <fmt/format.h>

#include "reference/base/error.hpp"
#include "reference/integrate/gather.hpp"
#include "validation/app/gather_output.hpp"
#include "validation/app/options.hpp"
#include "validation/app/points_csv.hpp"
#include "validation/app/verbs.hpp"

namespace plumbline::app {
namespace {

struct Options {
  SceneOptions scene;
  LightOptions light;
  std::string points;
  bool is_vertices = false;
  std::string output;
  int samples = 1024;
  std::string bounces = "all";
  std::uint64_t seed = 0;
  int threads = 0;
  std::string json;
  bool is_per_bounce = false;
  bool has_exit_radiance = false;
  int sh_bands = 0;  // 0 = irradiance
  double target_error = 0.0;
  CLI::Option* has_samples = nullptr;
  CLI::Option* has_target = nullptr;
};

/// What is written beside the irradiance, and where it is measured.
struct Target {
  std::vector<PointAndNormal> shown;
  std::vector<trace::SurfacePoint> points;
};

Target vertices_of(const scene::Scene& scene) {
  if (scene.positions.empty()) throw InputError("scene " + scene.name + ": has no vertices to gather at");
  Target target{{}, trace::vertex_points(scene)};
  for (std::size_t v = 0; v < scene.positions.size(); ++v) {
    target.shown.push_back({scene.positions[v], scene.normals[v]});
  }
  return target;
}

Target points_of(const std::string& path) {
  Target target{read_points(path), {}};
  for (const PointAndNormal& point : target.shown) {
    target.points.push_back(trace::free_point(point.position, point.normal));
  }
  return target;
}

std::string csv_of(const Target& target, const std::vector<integrate::RgbEstimate>& estimates) {
  std::string text = "x,y,z,nx,ny,nz,E_r,E_g,E_b,stderr_r,stderr_g,stderr_b\n";
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    text += csv_line(target.shown[i], estimates[i].mean, estimates[i].standard_error);
  }
  return text;
}

constexpr int kMaxPerBounce = 15;

void require_consistent(const Options& options, int max_bounces) {
  if (options.is_per_bounce && max_bounces > kMaxPerBounce) {
    throw InputError(fmt::format("--per-bounce: expected --bounces 0 to {}, got {}", kMaxPerBounce,
                                 bounces_text(max_bounces)));
  }
  if (options.has_exit_radiance && !options.is_vertices)
    throw InputError("--exit-radiance: needs --vertices: points have no albedo");
  if (options.sh_bands > 0 && (options.is_per_bounce || options.has_exit_radiance))
    throw InputError("--sh: writes coefficients of radiance, without --per-bounce or --exit-radiance");
  if (options.has_target->count() == 0) return;
  if (options.sh_bands > 0)
    throw InputError("--target-error: is for irradiance; give --sh a --samples count");
  if (options.has_samples->count() > 0)
    throw InputError("--samples: give either a sample count or --target-error");
}

/// The table of irradiance, and how many samples a point it took.
struct Table {
  std::string csv;
  std::int64_t samples = 0;
};

Table irradiance_table(const Options& options, const integrate::World& world, const Target& target,
                       const integrate::GatherSettings& settings) {
  std::vector<integrate::RgbEstimate> irradiance;
  std::vector<RgbColumn> further;
  if (options.is_per_bounce) {
    const auto estimates = integrate::gather_bounces(world, target.points, settings);
    for (const integrate::BouncesEstimate& estimate : estimates) irradiance.push_back(estimate.irradiance);
    further = bounce_columns(estimates);
  } else {
    irradiance = integrate::gather_irradiance(world, target.points, settings);
  }
  if (options.has_exit_radiance)
    further.push_back(reflected_column(scene::vertex_albedos(world.scene), irradiance));
  const std::string csv = csv_of(target, irradiance);
  return {further.empty() ? csv : with_columns(csv, further), irradiance.front().samples};
}

std::string probe_text(const Options& options, const integrate::World& world, const Target& target,
                       const integrate::GatherSettings& settings) {
  const auto probes =
      integrate::gather_probes(world, target.points, sh_functions(options.sh_bands), settings);
  return probes_json(options.sh_bands, target.shown, probes).dump(1) + "\n";
}

integrate::GatherSettings settings_of(const Options& options) {
  integrate::GatherSettings settings;
  settings.samples = options.samples;
  settings.max_bounces = parse_bounces(options.bounces);
  settings.seed = options.seed;
  settings.threads = options.threads;
  settings.progress = progress_bar("gather");
  if (options.has_target->count() > 0) settings.target_error = options.target_error;
  return settings;
}

int run(const Options& options) {
  if (options.is_vertices == !options.points.empty())
    throw InputError("gather: give either --points FILE.csv or --vertices");
  const integrate::GatherSettings settings = settings_of(options);
  require_consistent(options, settings.max_bounces);
  require_destinations({{"-o", options.output, ""}, {"--json", options.json, ""}});
  Target target;
  if (!options.is_vertices) target = points_of(options.points);
  const integrate::World world(load(options.scene), load(options.light));
  if (options.is_vertices) target = vertices_of(world.scene);
  Table table{{}, options.samples};
  if (options.sh_bands > 0) {
    table.csv = probe_text(options, world, target, settings);
  } else {
    table = irradiance_table(options, world, target, settings);
  }
  write_output(options.output, table.csv);
  write_json(options.json, {{"output", options.output},
                            {"points", target.points.size()},
                            {"samples", table.samples},
                            {"bounces", bounces_text(settings.max_bounces)},
                            {"seed", options.seed}});
  return kSuccess;
}

}  // namespace

void register_gather(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand(
      "gather", "irradiance, or SH light probes, with standard errors, at points or at all vertices");
  add_scene_options(*verb, options->scene);
  add_light_options(*verb, options->light, false);
  verb->add_option("--points", options->points, "CSV of x,y,z,nx,ny,nz");
  verb->add_flag("--vertices", options->is_vertices, "at every vertex of the scene, in its order");
  add_output(*verb, options->output, "CSV (--sh: JSON) to write, or - for standard output")->required();
  options->has_samples =
      add_whole_number(*verb, "--samples,--spp", options->samples, {1}, "paths a point (default 1024)");
  options->has_target = add_positive(
      *verb, "--target-error", options->target_error,
      "stop when the root of the mean squared standard error over the mean irradiance is this small");
  verb->add_flag(
      "--per-bounce", options->is_per_bounce,
      "add columns E0, stderr0, E1, ...: irradiance by number of bounces (needs --bounces 0 to 15)");
  verb->add_flag("--exit-radiance", options->has_exit_radiance,
                 "add columns L = albedo E / pi, the light each vertex reflects (with --vertices)");
  add_whole_number(
      *verb, "--sh", options->sh_bands, {1, kMaxProbeBands},
      "write JSON instead: spherical-harmonic coefficients of the radiance that arrives from all "
      "sides, n bands (\"order n\" in Sloan's papers)");
  add_bounces(*verb, options->bounces);
  add_seed(*verb, options->seed);
  add_threads(*verb, options->threads);
  add_json(*verb, options->json, "a summary");
  verb->footer(
      "Example: plumbline gather builtin:sphere-on-plane --env builtin:overcast --vertices -o "
      "irradiance.csv");
  on_chosen(*verb, options, chosen, &run);
}

}  // namespace plumbline::app
