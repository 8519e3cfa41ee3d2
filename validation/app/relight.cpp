// plumbline relight: a baked scene under a light.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>

#include "prt/relight/cluster_blocks.hpp"
#include "prt/relight/cpu.hpp"
#include "prt/transfer/baked_file.hpp"
#include "reference/base/error.hpp"
#include "validation/app/options.hpp"
#include "validation/app/points_csv.hpp"
#include "validation/app/relight_gl.hpp"
#include "validation/app/relight_light.hpp"
#include "validation/app/relight_sequence.hpp"
#include "validation/app/verbs.hpp"

namespace plumbline::app {
namespace {

struct Options {
  std::string input;
  LightOptions light;
  MixOptions mix;
  SequenceOptions sequence;
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
  std::string command = fmt::format("plumbline relight {}", quoted(o.input)) + command_text(o.light) +
                        command_text(o.mix) + command_text(o.sequence);
  if (!o.camera.empty()) command += " --camera " + quoted(o.camera);
  command += fmt::format(" --size {} --spp {} --backend {}", o.size, o.spp, o.backend);
  if (o.backend != "gl") return command;
  return command + fmt::format(" --gl-context {} --gl-storage {} --gl-target {}", o.gl.context, o.gl.storage,
                               o.gl.target);
}

View view_of(const Options& options, const transfer::Baked& baked, const TurnedLight& light) {
  const Size size = parse_size(options.size);
  return {camera_of(baked.scene, options.camera),
          {size.width, size.height, grid_of(options.spp), options.threads},
          light.background};
}

image::LayeredImage with_attributes(image::LayeredImage image, const Options& options,
                                    const transfer::Baked& baked, const std::string& environment) {
  image.attributes = {{"plumbline.version", PLUMBLINE_VERSION},
                      {"plumbline.baked", options.input},
                      {"plumbline.sceneHash", scene::fingerprint(baked.scene)},
                      {"plumbline.environment", environment},
                      {"plumbline.environmentLookup", options.light.lookup},
                      {"plumbline.bands", std::to_string(baked.transfer.bands)},
                      {"plumbline.transfer", std::string(to_string(baked.transfer.kind))},
                      {"plumbline.command", reproducing_command(options)}};
  return image;
}

/// What multiplies light and transfer: made once, asked for every frame.
class Relighter {
 public:
  Relighter(const Options& options, const transfer::Baked& baked) : baked_(baked), threads_(options.threads) {
    if (options.backend == "gl") {
      gl_ = std::make_unique<GlRelighter>(options.gl, baked);
    } else if (baked.compressed) {
      clusters_ = relight::make_cluster_blocks(*baked.compressed, baked.transfer);
    } else {
      blocks_ = relight::make_blocks(baked.transfer, threads_);
    }
  }
  /// Exit radiance for unit albedo at every vertex.
  [[nodiscard]] std::vector<Rgb> relight(const sh::ShRgb& lighting) {
    if (gl_) return gl_->relight(lighting);
    return clusters_ ? relight::unit_albedo_exit_radiance(*clusters_, lighting, threads_)
                     : of_blocks(lighting);
  }
  /// Under the light of the last relight(), whose result `radiance` is.
  [[nodiscard]] image::LayeredImage picture(const std::vector<Rgb>& radiance, const View& view) {
    if (gl_) return gl_->picture(view);
    return relight::render_view(baked_.scene, radiance, view.camera, view.settings, view.background);
  }
  /// Null unless OpenGL did it.
  [[nodiscard]] nlohmann::json summary(const sh::ShRgb& lighting, const std::optional<View>& view) {
    return gl_ ? gl_->summary(lighting, view) : nlohmann::json();
  }

 private:
  [[nodiscard]] std::vector<Rgb> of_blocks(const sh::ShRgb& lighting) const {
    std::vector<Rgb> result(baked_.transfer.vertices);
    relight::unit_albedo_exit_radiance(*blocks_, lighting, result, threads_);
    return result;
  }

  const transfer::Baked& baked_;
  int threads_;
  std::unique_ptr<GlRelighter> gl_;
  std::optional<relight::ClusterBlocks> clusters_;
  std::optional<relight::TransferBlocks> blocks_;
};

/// Means over all frames, and what the backend says of itself.
struct Outcome {
  std::string environment;
  double projection_seconds = 0.0;  // of the light, once
  double relight_seconds = 0.0;     // a frame: turning and mixing the light, sums at the vertices
  double frame_seconds = 0.0;       // a frame with its picture, files written
  nlohmann::json gl;
};

Outcome relight_frames(const Options& options, const transfer::Baked& baked) {
  Outcome outcome;
  const auto start = std::chrono::steady_clock::now();
  const ProjectedLight light =
      load_projected(options.light, options.mix, baked.transfer.bands, options.threads);
  outcome.environment = light.environment.name;
  outcome.projection_seconds = seconds_since(start);
  Relighter relighter(options, baked);
  Strip strip(options.sequence, parse_size(options.size));
  const int frames = options.sequence.frames;
  const int count = std::max(1, frames);
  const bool is_pictured =
      !options.output.empty() || !options.sequence.strip.empty() || options.gl.is_audited;
  for (int frame = 0; frame < count; ++frame) {
    const auto frame_start = std::chrono::steady_clock::now();
    const TurnedLight turned = light_turned(light, degrees_of_frame(options.light, frame, frames));
    const std::vector<Rgb> radiance = relighter.relight(turned.coefficients);
    outcome.relight_seconds += seconds_since(frame_start) / count;
    std::optional<View> view;
    if (is_pictured) {
      view = view_of(options, baked, turned);
      const image::LayeredImage picture =
          with_attributes(relighter.picture(radiance, *view), options, baked, outcome.environment);
      strip.add(picture);
      if (!options.output.empty())
        write_picture(frame_path(options.output, frame, frames), picture, options.sequence.exposure_stops);
    }
    outcome.frame_seconds += seconds_since(frame_start) / count;
    if (!options.vertices.empty()) write_output(options.vertices, csv_of(baked.scene, radiance));
    if (frame + 1 == count) outcome.gl = relighter.summary(turned.coefficients, view);
  }
  strip.write();
  return outcome;
}

/// Refuses before the work what could not be written, or makes no sense.
void require_sense(const Options& options) {
  require_valid(options.gl, options.backend);
  if (options.output.empty() && options.vertices.empty() && options.sequence.strip.empty() &&
      !options.gl.is_audited)
    throw InputError("relight: nothing to do: give -o OUT.exr, --strip OUT.png or --vertices OUT.csv");
  if (options.sequence.frames > 0 && !options.vertices.empty())
    throw InputError("--vertices: of one light only: leave out --frames");
  const Destination vertices{"--vertices", options.vertices, ""};
  const Destination json{"--json", options.json, ""};
  require_destinations({vertices, json});
  const Destination strip{"--strip", options.sequence.strip, ".png"};
  for (const Destination& picture :
       picture_destinations(options.output, options.sequence, parse_size(options.size)))
    require_destinations({picture, strip, vertices, json});
}

int run(const Options& options) {
  require_sense(options);
  const transfer::Baked baked = transfer::load_baked(options.input);
  (void)camera_of(baked.scene, options.camera);
  const Outcome outcome = relight_frames(options, baked);
  nlohmann::json json = {{"input", options.input},
                         {"environment", outcome.environment},
                         {"environment_lookup", options.light.lookup},
                         {"bands", baked.transfer.bands},
                         {"transfer", std::string(to_string(baked.transfer.kind))},
                         {"backend", options.backend},
                         {"vertices", baked.transfer.vertices},
                         {"frames", std::max(1, options.sequence.frames)},
                         {"seconds_lighting", outcome.projection_seconds + outcome.relight_seconds},
                         {"seconds_projection", outcome.projection_seconds},
                         {"seconds_relight", outcome.relight_seconds},
                         {"seconds_frame", outcome.frame_seconds}};
  if (!options.mix.source.empty()) {
    json["mixed_in"] = options.mix.source;
    json["mix_weight"] = options.mix.weight;
  }
  if (!outcome.gl.is_null()) json["gl"] = outcome.gl;
  write_json(options.json, json);
  return kSuccess;
}

}  // namespace

void register_relight(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("relight", "show a baked scene under a light");
  verb->add_option("BAKED", options->input, "file written by `plumbline bake`")->required();
  add_light_options(*verb, options->light, true);
  add_mix_option(*verb, options->mix);
  add_sequence_options(*verb, options->sequence);
  add_camera_option(*verb, options->camera);
  add_size(*verb, options->size);
  add_whole_number(*verb, "--spp", options->spp, {1, 4096},
                   "camera rays a pixel, rounded up to a square number (default 16)");
  verb->add_option("--backend", options->backend, "what multiplies light and transfer")
      ->check(CLI::IsMember({"cpu", "gl"}));
  add_gl_options(*verb, options->gl);
  add_threads(*verb, options->threads);
  add_output(*verb, options->output, "OpenEXR image to write, or a PNG");
  verb->add_option("--vertices", options->vertices,
                   "CSV of irradiance E and exit radiance L at every vertex, or - for standard output");
  add_json(*verb, options->json, "a summary");
  verb->footer("Example: plumbline relight plaza.prt.glb --env builtin:sun-sky -o plaza.exr --size 512x512");
  on_chosen(*verb, options, chosen, &run);
}

}  // namespace plumbline::app
