// plumbline gather: irradiance at points or vertices.
#include <fmt/format.h>

#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/integrate/gather.hpp"
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

Target target_of(const Options& options, const scene::Scene& scene) {
  Target target;
  if (options.is_vertices) {
    target.points = trace::vertex_points(scene);
    for (std::size_t v = 0; v < scene.positions.size(); ++v)
      target.shown.push_back({scene.positions[v], scene.normals[v]});
    return target;
  }
  target.shown = read_points(options.points);
  for (const PointAndNormal& point : target.shown)
    target.points.push_back(trace::free_point(point.position, point.normal));
  return target;
}

std::string csv_of(const Target& target, const std::vector<integrate::RgbEstimate>& estimates) {
  std::string text = "x,y,z,nx,ny,nz,E_r,E_g,E_b,stderr_r,stderr_g,stderr_b\n";
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    const PointAndNormal& at = target.shown[i];
    const integrate::RgbEstimate& e = estimates[i];
    text += fmt::format("{},{},{},{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", at.position.x,
                        at.position.y, at.position.z, at.normal.x, at.normal.y, at.normal.z, e.mean.x,
                        e.mean.y, e.mean.z, e.standard_error.x, e.standard_error.y, e.standard_error.z);
  }
  return text;
}

int run(const Options& options) {
  if (options.is_vertices == !options.points.empty())
    throw InputError("gather: give either --points FILE.csv or --vertices");
  integrate::GatherSettings settings;
  settings.samples = options.samples;
  settings.max_bounces = parse_bounces(options.bounces);
  settings.seed = options.seed;
  settings.threads = options.threads;
  settings.progress = progress_bar("gather");
  if (options.output != "-") require_writable(options.output);
  const integrate::World world(load(options.scene), load(options.light));
  const Target target = target_of(options, world.scene);
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
  verb->add_option("-o,--output", options->output, "CSV to write, or - for standard output")->required();
  verb->add_option("--samples,--spp", options->samples, "paths a point (default 1024)");
  verb->add_option("--bounces", options->bounces,
                   "indirect bounces: 0 = direct light only, all = no limit (default)");
  verb->add_option("--seed", options->seed, "same seed, same bits");
  verb->add_option("--threads", options->threads, "0 = all; never changes the result")
      ->check(CLI::Range(0, 4096));
  verb->add_option("--json", options->json, "write a summary to this file, or - for standard output");
  verb->footer(
      "Example: plumbline gather builtin:sphere-on-plane --env builtin:overcast --vertices -o "
      "irradiance.csv");
  verb->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace plumbline::app
