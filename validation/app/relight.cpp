// plumbline relight: a baked scene under a light.
#include <fmt/format.h>

#include <chrono>

#include "prt/relight/cluster_blocks.hpp"
#include "prt/relight/cpu.hpp"
#include "prt/transfer/baked_file.hpp"
#include "reference/base/error.hpp"
#include "reference/image/exr.hpp"
#include "validation/app/options.hpp"
#include "validation/app/points_csv.hpp"
#include "validation/app/relight_gl.hpp"
#include "validation/app/verbs.hpp"

namespace plumbline::app {
namespace {

struct Options {
  std::string input;
  LightOptions light;
  std::string camera;
  std::string size = "256x256";
  std::string backend = "cpu";
  GlOptions gl;
  int spp = 16;
  int threads = 0;
  std::string output;
  std::string vertices;
  std::string json;
};

int grid_of(int spp) {
  int grid = 1;
  while (grid * grid < spp) ++grid;
  return grid;
}

std::string csv_of(const scene::Scene& scene, const std::vector<Rgb>& unit_albedo_radiance) {
  std::string text = "x,y,z,nx,ny,nz,E_r,E_g,E_b,L_r,L_g,L_b\n";
  const std::vector<Rgb> albedos = scene::vertex_albedos(scene);
  for (std::size_t v = 0; v < unit_albedo_radiance.size(); ++v) {
    const RgbD irradiance = RgbD(unit_albedo_radiance[v]) * kPi;
    text += csv_line({scene.positions[v], scene.normals[v]}, irradiance,
                     RgbD(albedos[v] * unit_albedo_radiance[v]));
  }
  return text;
}

// What makes the image again: no output names and no threads.
std::string reproducing_command(const Options& o) {
  std::string command = fmt::format("plumbline relight {}", quoted(o.input)) + command_text(o.light);
  if (!o.camera.empty()) command += " --camera " + quoted(o.camera);
  command += fmt::format(" --size {} --spp {} --backend {}", o.size, o.spp, o.backend);
  if (o.backend != "gl") return command;
  return command + fmt::format(" --gl-context {} --gl-storage {} --gl-target {}", o.gl.context, o.gl.storage,
                               o.gl.target);
}

GlView view_of(const Options& options, const transfer::Baked& baked, const light::Environment& environment) {
  const Size size = parse_size(options.size);
  return {camera_of(baked.scene, options.camera),
          {size.width, size.height, grid_of(options.spp), options.threads},
          [&](const Vec3& direction) { return light::radiance(environment, direction); }};
}

void write_view(const Options& options, const transfer::Baked& baked, const light::Environment& environment,
                image::LayeredImage image) {
  image.attributes = {{"plumbline.version", PLUMBLINE_VERSION},
                      {"plumbline.baked", options.input},
                      {"plumbline.sceneHash", scene::fingerprint(baked.scene)},
                      {"plumbline.environment", environment.name},
                      {"plumbline.environmentLookup", options.light.lookup},
                      {"plumbline.bands", std::to_string(baked.transfer.bands)},
                      {"plumbline.transfer", std::string(to_string(baked.transfer.kind))},
                      {"plumbline.command", reproducing_command(options)}};
  image::write_exr(options.output, image);
}

std::vector<Rgb> exit_radiance(const transfer::Baked& baked, const sh::ShRgb& lighting, int threads) {
  if (!baked.compressed) return relight::unit_albedo_exit_radiance(baked.transfer, lighting);
  return relight::unit_albedo_exit_radiance(relight::make_cluster_blocks(*baked.compressed, baked.transfer),
                                            lighting, threads);
}

int run(const Options& options) {
  require_valid(options.gl, options.backend);
  if (options.output.empty() && options.vertices.empty() && !options.gl.is_audited)
    throw InputError("relight: nothing to do: give -o OUT.exr or --vertices OUT.csv");
  (void)parse_size(options.size);  // refuse it before the work
  require_destinations(
      {{"-o", options.output, ".exr"}, {"--vertices", options.vertices, ""}, {"--json", options.json, ""}});
  const transfer::Baked baked = transfer::load_baked(options.input);
  (void)camera_of(baked.scene, options.camera);
  const light::Environment environment = load(options.light);
  const auto start = std::chrono::steady_clock::now();
  const sh::ShRgb lighting = sh::project_radiance(environment, baked.transfer.bands);
  std::vector<Rgb> radiance;
  std::optional<image::LayeredImage> image;
  nlohmann::json gl;
  std::optional<GlView> view;
  if (!options.output.empty() || options.gl.is_audited) view = view_of(options, baked, environment);
  if (options.backend == "gl") {
    GlRelit relit = relight_by_gl(options.gl, baked, lighting, view);
    radiance = std::move(relit.unit_albedo_radiance);
    image = std::move(relit.image);
    gl = std::move(relit.summary);
  } else {
    radiance = exit_radiance(baked, lighting, options.threads);
  }
  const double seconds = seconds_since(start);
  if (view && !image)
    image = relight::render_view(baked.scene, radiance, view->camera, view->settings, view->background);
  if (!options.output.empty()) write_view(options, baked, environment, *std::move(image));
  if (!options.vertices.empty()) write_output(options.vertices, csv_of(baked.scene, radiance));
  nlohmann::json summary = {{"input", options.input},
                            {"environment", environment.name},
                            {"environment_lookup", options.light.lookup},
                            {"bands", baked.transfer.bands},
                            {"transfer", std::string(to_string(baked.transfer.kind))},
                            {"backend", options.backend},
                            {"vertices", baked.transfer.vertices},
                            {"seconds_lighting", seconds}};
  if (!gl.is_null()) summary["gl"] = gl;
  write_json(options.json, summary);
  return kSuccess;
}

}  // namespace

void register_relight(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("relight", "show a baked scene under a light");
  verb->add_option("BAKED", options->input, "file written by `plumbline bake`")->required();
  add_light_options(*verb, options->light, true);
  add_camera_option(*verb, options->camera);
  add_size(*verb, options->size);
  add_whole_number(*verb, "--spp", options->spp, {1, 4096},
                   "camera rays a pixel, rounded up to a square number (default 16)");
  verb->add_option("--backend", options->backend, "what multiplies light and transfer")
      ->check(CLI::IsMember({"cpu", "gl"}));
  add_gl_options(*verb, options->gl);
  add_threads(*verb, options->threads);
  add_output(*verb, options->output, "OpenEXR image to write");
  verb->add_option("--vertices", options->vertices,
                   "CSV of irradiance E and exit radiance L at every vertex, or - for standard output");
  add_json(*verb, options->json, "a summary");
  verb->footer("Example: plumbline relight plaza.prt.glb --env builtin:sun-sky -o plaza.exr --size 512x512");
  on_chosen(*verb, options, chosen, &run);
}

}  // namespace plumbline::app
