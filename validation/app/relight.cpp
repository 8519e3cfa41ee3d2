// plumbline relight: a baked scene under a light.
#include <fmt/format.h>

#include <chrono>

#include "prt/relight/cpu.hpp"
#include "prt/transfer/baked_file.hpp"
#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/image/exr.hpp"
#include "reference/scene/load.hpp"
#include "validation/app/verbs.hpp"

namespace plumbline::app {
namespace {

struct Options {
  std::string input;
  LightOptions light;
  std::string camera;
  std::string size = "256x256";
  std::string backend = "cpu";
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

std::vector<Rgb> vertex_albedos(const scene::Scene& scene) {
  std::vector<Rgb> albedos(scene.positions.size(), Rgb(0.0F));
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    const Vec2 corners[3] = {{0.0F, 0.0F}, {1.0F, 0.0F}, {0.0F, 1.0F}};
    for (int k = 0; k < 3; ++k) albedos[scene.triangles[t][k]] = scene::albedo_at(scene, t, corners[k]);
  }
  return albedos;
}

std::string csv_of(const scene::Scene& scene, const std::vector<Rgb>& unit_albedo_radiance) {
  std::string text = "x,y,z,nx,ny,nz,E_r,E_g,E_b,L_r,L_g,L_b\n";
  const std::vector<Rgb> albedos = vertex_albedos(scene);
  for (std::size_t v = 0; v < unit_albedo_radiance.size(); ++v) {
    const Vec3 p = scene.positions[v];
    const Vec3 n = scene.normals[v];
    const RgbD irradiance = RgbD(unit_albedo_radiance[v]) * kPi;
    const Rgb radiance = albedos[v] * unit_albedo_radiance[v];
    text +=
        fmt::format("{},{},{},{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", p.x, p.y, p.z, n.x, n.y,
                    n.z, irradiance.x, irradiance.y, irradiance.z, radiance.x, radiance.y, radiance.z);
  }
  return text;
}

int run(const Options& options) {
  if (options.output.empty() && options.vertices.empty())
    throw InputError("relight: nothing to do: give -o OUT.exr or --vertices OUT.csv");
  const Size size = parse_size(options.size);
  if (options.spp < 1 || options.spp > 4096)
    throw InputError(fmt::format("--spp: expected 1 to 4096, got {}", options.spp));
  for (const std::string& path : {options.output, options.vertices}) {
    if (!path.empty() && path != "-") require_writable(path);
  }
  const transfer::Baked baked = transfer::load_baked(options.input);
  const light::Environment environment = load(options.light);
  const auto start = std::chrono::steady_clock::now();
  const sh::ShRgb lighting = sh::project_radiance(environment, baked.transfer.bands);
  const std::vector<Rgb> radiance = relight::unit_albedo_exit_radiance(baked.transfer, lighting);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!options.vertices.empty()) write_output(options.vertices, csv_of(baked.scene, radiance));
  if (!options.output.empty()) {
    const relight::ViewSettings view{size.width, size.height, grid_of(options.spp), options.threads};
    image::LayeredImage image =
        relight::render_view(baked.scene, radiance, scene::find_camera(baked.scene, options.camera), view,
                             [&](const Vec3& direction) { return light::radiance(environment, direction); });
    image.attributes = {{"plumbline.version", PLUMBLINE_VERSION},
                        {"plumbline.baked", options.input},
                        {"plumbline.sceneHash", scene::fingerprint(baked.scene)},
                        {"plumbline.environment", environment.name},
                        {"plumbline.environmentLookup", options.light.lookup},
                        {"plumbline.bands", std::to_string(baked.transfer.bands)},
                        {"plumbline.transfer", std::string(to_string(baked.transfer.kind))}};
    image::write_exr(options.output, image);
  }
  write_json(options.json, {{"input", options.input},
                            {"environment", environment.name},
                            {"environment_lookup", options.light.lookup},
                            {"bands", baked.transfer.bands},
                            {"transfer", std::string(to_string(baked.transfer.kind))},
                            {"backend", options.backend},
                            {"vertices", baked.transfer.vertices},
                            {"seconds_lighting", seconds}});
  return kSuccess;
}

}  // namespace

void register_relight(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("relight", "show a baked scene under a light");
  verb->add_option("BAKED", options->input, "file written by `plumbline bake`")->required();
  add_light_options(*verb, options->light, true);
  verb->add_option("--camera", options->camera, "name of the scene's camera (default: its first)");
  verb->add_option("--size", options->size, "image size WxH (default 256x256)");
  verb->add_option("--spp", options->spp, "camera rays a pixel, rounded up to a square number (default 16)");
  verb->add_option("--backend", options->backend, "what multiplies light and transfer")
      ->check(CLI::IsMember({"cpu"}));
  verb->add_option("--threads", options->threads, "0 = all; never changes the image")
      ->check(CLI::Range(0, 4096));
  verb->add_option("-o,--output", options->output, "OpenEXR image to write");
  verb->add_option("--vertices", options->vertices,
                   "CSV of irradiance E and exit radiance L at every vertex, or - for standard output");
  verb->add_option("--json", options->json, "write a summary to this file, or - for standard output");
  verb->footer("Example: plumbline relight plaza.prt.glb --env builtin:sun-sky -o plaza.exr --size 512x512");
  verb->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace plumbline::app
