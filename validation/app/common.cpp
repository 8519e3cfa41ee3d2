#include "validation/app/common.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <mutex>

#include "prt/sh/lighting.hpp"
#include "reference/base/error.hpp"
#include "reference/base/text.hpp"
#include "reference/integrate/path.hpp"
#include "reference/scene/ground.hpp"
#include "reference/scene/load.hpp"
#include "reference/scene/text.hpp"
#include "validation/app/options.hpp"

namespace plumbline::app {

void add_scene_options(CLI::App& verb, SceneOptions& options) {
  verb.add_option("SCENE", options.source,
                  "a .gltf, .glb, .obj or .ply file, or builtin:NAME (see `plumbline scenes`)")
      ->required();
  add_mesh_options(verb, options);
}

void add_mesh_options(CLI::App& verb, SceneOptions& options) {
  add_number(
      verb, "--crease", [&options](double degrees) { options.crease_deg = static_cast<float>(degrees); },
      "an angle from 0 to 180 degrees", [](double degrees) { return degrees >= 0.0 && degrees <= 180.0; },
      "where a mesh has no normals, smooth edges up to this angle in degrees (0 = flat, 180 = all)");
  verb.add_flag("--ground", options.has_ground, "put a gray ground under the scene");
}

void add_camera_option(CLI::App& verb, std::string& camera) {
  verb.add_option("--camera", camera,
                  "name of the scene's camera (default: its first, else framed automatically)");
}

const scene::Camera& camera_of(const scene::Scene& scene, const std::string& name) {
  try {
    return scene::find_camera(scene, name);
  } catch (const InputError& error) {
    throw InputError(std::string("--camera: ") + error.what());
  }
}

scene::Scene load(const SceneOptions& options) {
  scene::Scene result = scene::load_scene(options.source, {options.crease_deg});
  if (result.dropped_degenerate > 0) {
    warn(fmt::format("{}: left out {} triangles without area", options.source, result.dropped_degenerate));
  }
  return options.has_ground ? scene::with_ground(std::move(result)) : result;
}

void add_light_options(CLI::App& verb, LightOptions& options, bool is_required) {
  auto* env = verb.add_option("--env", options.source,
                              "environment: an image (EXR, HDR, ...), builtin:NAME, or SH coefficients "
                              "(.json of `plumbline project`)");
  if (is_required) env->required();
  add_light_modifiers(verb, options);
}

void add_light_modifiers(CLI::App& verb, LightOptions& options) {
  verb.add_option("--env-layout", options.layout,
                  "how an image maps to directions (default: by its aspect ratio)")
      ->check(CLI::IsMember({"auto", "lat-long", "angular-map", "cube"}));
  add_lookup_option(verb, options);
  add_angles(verb, "--rotate-env", options.rotation_deg,
             "turn the environment about world X, then Y, then Z, degrees: X,Y,Z");
}

void add_lookup_option(CLI::App& verb, LightOptions& options) {
  verb.add_option("--env-lookup", options.lookup,
                  "how an image is read between texel centres: by nearest texel (default) or bilinear")
      ->check(CLI::IsMember({"nearest", "bilinear"}));
}

namespace {

light::EnvironmentLayout layout_of(const std::string& text) {
  if (text == "lat-long") return light::EnvironmentLayout::lat_long;
  if (text == "angular-map") return light::EnvironmentLayout::angular_map;
  if (text == "cube") return light::EnvironmentLayout::cube;
  return light::EnvironmentLayout::automatic;
}

}  // namespace

light::Environment load(const LightOptions& options) {
  if (options.source.empty()) return {"none", light::ConstantSky{}, {}, glm::mat3(1.0F), 0};
  light::Environment result;
  if (lower_case_extension(options.source) == ".json") {
    result = sh::band_limited_environment(sh::read_coefficients(options.source), options.source);
  } else {
    result = light::load_environment(options.source, layout_of(options.layout));
  }
  if (options.lookup == "bilinear") result.lookup = light::Lookup::bilinear;
  if (result.negative_texels > 0)
    warn(fmt::format("{}: {} negative texels set to 0", options.source, result.negative_texels));
  if (options.rotation_deg.empty()) return result;
  const Vec3 degrees(options.rotation_deg[0], options.rotation_deg[1], options.rotation_deg[2]);
  return light::rotated(std::move(result), degrees);
}

std::string command_text(const LightOptions& options) {
  std::string text;
  if (!options.source.empty()) text += " --env " + quoted(options.source);
  if (options.layout != "auto") text += " --env-layout " + options.layout;
  if (options.lookup != "nearest") text += " --env-lookup " + options.lookup;
  const std::vector<float>& angles = options.rotation_deg;
  if (!angles.empty()) text += fmt::format(" --rotate-env {},{},{}", angles[0], angles[1], angles[2]);
  return text;
}

Size parse_size(const std::string& text) {
  const std::size_t cross = std::min(text.find('x'), text.size());
  const auto side = [](const std::string& word) {
    const auto number = scene::parse_integer(word);
    return number && *number >= 1 && *number <= kMaxSide ? static_cast<int>(*number) : 0;
  };
  const Size size{side(text.substr(0, cross)), side(text.substr(std::min(cross + 1, text.size())))};
  if (size.width > 0 && size.height > 0) return size;
  throw InputError(fmt::format("--size: expected WIDTHxHEIGHT, each from 1 to {}, got {}", kMaxSide,
                               quoted(one_line(text))));
}

int parse_bounces(const std::string& text) {
  if (text == "all") return integrate::kAllBounces;
  const auto number = scene::parse_integer(text);
  if (number && *number >= 0 && *number < integrate::kAllBounces) return static_cast<int>(*number);
  throw InputError(fmt::format("--bounces: expected 0, 1, 2, ... or all, got {}", quoted(one_line(text))));
}

std::string bounces_text(int bounces) {
  return bounces == integrate::kAllBounces ? "all" : std::to_string(bounces);
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::function<void(double)> progress_bar(const std::string& title) {
  if (::isatty(STDERR_FILENO) == 0) return {};
  struct State {
    std::mutex mutex;
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
    std::chrono::steady_clock::time_point shown{};
    double best = 0.0;
  };
  auto state = std::make_shared<State>();
  return [state, title](double fraction) {
    const std::lock_guard lock(state->mutex);
    const auto now = std::chrono::steady_clock::now();
    const bool is_end = fraction >= 1.0;
    if (fraction < state->best || (!is_end && now - state->shown < std::chrono::milliseconds(100))) return;
    state->best = fraction;
    state->shown = now;
    const double elapsed = std::chrono::duration<double>(now - state->start).count();
    const double left = fraction > 0.0 ? elapsed * (1.0 - fraction) / fraction : 0.0;
    constexpr int kWidth = 30;
    const int filled = static_cast<int>(fraction * kWidth);
    std::string line = fmt::format("\r{} [{:=<{}}{: <{}}] {:3.0f} % {:6.1f} s left ", title, "", filled, "",
                                   kWidth - filled, 100.0 * fraction, left);
    if (is_end) line += fmt::format("\r{: <80}\r", "");
    std::fputs(line.c_str(), stderr);  // whether anybody sees it does not matter
    std::fflush(stderr);
  };
}

std::string quoted(const std::string& word) {
  if (!word.empty() &&
      word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./:=,+") ==
          std::string::npos) {
    return word;
  }
  std::string result = "'";
  for (const char c : word) result += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return result + "'";
}

}  // namespace plumbline::app
