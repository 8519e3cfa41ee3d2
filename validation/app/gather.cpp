// plumbline gather: irradiance at points or vertices.
#include <fmt/format.h>

#include "reference/base/error.hpp"
#include "reference/integrate/gather.hpp"
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
};

/// What is written beside the irradiance, and where it is measured.
struct Target {
  std::vector<PointAndNormal> shown;
  std::vector<trace::SurfacePoint> points;
};

Target vertices_of(const scene::Scene& scene) {
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

integrate::GatherSettings settings_of(const Options& options) {
  integrate::GatherSettings settings;
  settings.samples = options.samples;
  settings.max_bounces = parse_bounces(options.bounces);
  settings.seed = options.seed;
  settings.threads = options.threads;
  settings.progress = progress_bar("gather");
  return settings;
}

int run(const Options& options) {
  if (options.is_vertices == !options.points.empty())
    throw InputError("gather: give either --points FILE.csv or --vertices");
  const integrate::GatherSettings settings = settings_of(options);
  require_destinations({{"-o", options.output, ""}, {"--json", options.json, ""}});
  Target target;
  if (!options.is_vertices) target = points_of(options.points);
  const integrate::World world(load(options.scene), load(options.light));
  if (options.is_vertices) target = vertices_of(world.scene);
  const auto estimates = integrate::gather_irradiance(world, target.points, settings);
  write_output(options.output, csv_of(target, estimates));
  write_json(options.json, {{"output", options.output},
                            {"points", estimates.size()},
                            {"samples", options.samples},
                            {"bounces", bounces_text(settings.max_bounces)},
                            {"seed", options.seed}});
  return kSuccess;
}

}  // namespace

void register_gather(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* verb =
      app.add_subcommand("gather", "irradiance and its standard error at points or at all vertices");
  add_scene_options(*verb, options->scene);
  add_light_options(*verb, options->light, false);
  verb->add_option("--points", options->points, "CSV of x,y,z,nx,ny,nz");
  verb->add_flag("--vertices", options->is_vertices, "at every vertex of the scene, in its order");
  add_output(*verb, options->output, "CSV to write, or - for standard output")->required();
  add_whole_number(*verb, "--samples,--spp", options->samples, {1}, "paths a point (default 1024)");
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
