#include "validation/app/common.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <mutex>

#include "prt/sh/lighting.hpp"
#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/integrate/path.hpp"
#include "reference/scene/ground.hpp"
#include "reference/scene/load.hpp"

namespace plumbline::app {

void add_scene_options(CLI::App& verb, SceneOptions& options) {
  verb.add_option("SCENE", options.source,
                  "a .gltf, .glb, .obj or .ply file, or builtin:NAME (see `plumbline scenes`)")
      ->required();
  add_mesh_options(verb, options);
}

void add_mesh_options(CLI::App& verb, SceneOptions& options) {
  verb.add_option(
          "--crease", options.crease_deg,
          "where a mesh has no normals, smooth edges up to this angle in degrees (0 = flat, 180 = all)")
      ->check(CLI::Range(0.0F, 180.0F));
  verb.add_flag("--ground", options.has_ground, "put a gray ground under the scene");
}

void add_camera_option(CLI::App& verb, SceneOptions& options) {
  verb.add_option("--camera", options.camera,
                  "name of the scene's camera (default: its first, else framed automatically)");
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
  verb.add_option("--env-layout", options.layout,
                  "how an image maps to directions (default: by its aspect ratio)")
      ->check(CLI::IsMember({"auto", "lat-long", "angular-map", "cube"}));
  add_lookup_option(verb, options);
  verb.add_option("--rotate-env", options.rotation_deg,
                  "turn the environment about world X, then Y, then Z, degrees: X,Y,Z")
      ->delimiter(',')
      ->expected(3);
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
  if (std::filesystem::path(options.source).extension() == ".json") {
    result = sh::band_limited_environment(sh::read_coefficients(options.source), options.source);
  } else {
    result = light::load_environment(options.source, layout_of(options.layout));
  }
  if (options.lookup == "bilinear") result.lookup = light::Lookup::bilinear;
  if (result.negative_texels > 0)
    warn(fmt::format("{}: {} negative texels set to 0", options.source, result.negative_texels));
  if (options.rotation_deg.empty()) return result;
  const Vec3 degrees(options.rotation_deg[0], options.rotation_deg[1], options.rotation_deg[2]);
  if (!is_finite(degrees)) throw InputError("--rotate-env: expected three finite angles in degrees");
  return light::rotated(std::move(result), degrees);
}

Size parse_size(const std::string& text) {
  Size size;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%dx%d%c", &size.width, &size.height, &rest) != 2 || size.width < 1 ||
      size.height < 1) {
    throw InputError(fmt::format("--size: expected WIDTHxHEIGHT with positive numbers, got {}", text));
  }
  return size;
}

int parse_bounces(const std::string& text) {
  if (text == "all") return integrate::kAllBounces;
  int bounces = -1;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%d%c", &bounces, &rest) != 1 || bounces < 0) {
    throw InputError(fmt::format("--bounces: expected 0, 1, 2, ... or all, got {}", text));
  }
  return bounces;
}

std::string bounces_text(int bounces) {
  return bounces == integrate::kAllBounces ? "all" : std::to_string(bounces);
}

void write_output(const std::string& destination, const std::string& text) {
  if (destination == "-") {
    std::fwrite(text.data(), 1, text.size(), stdout);
    std::fflush(stdout);
  } else {
    write_text_atomically(destination, text);
  }
}

nlohmann::json number(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0.0 ? "inf" : "-inf";
  return value;
}

void write_json(const std::string& destination, const nlohmann::json& json) {
  if (!destination.empty()) write_output(destination, json.dump(2) + "\n");
}

void warn(const std::string& message) {
  fmt::print(stderr, "plumbline: warning: {}\n", message);
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
    fmt::print(stderr, "\r{} [{:=<{}}{: <{}}] {:3.0f} % {:6.1f} s left ", title, "", filled, "",
               kWidth - filled, 100.0 * fraction, left);
    if (is_end) fmt::print(stderr, "\r{: <80}\r", "");
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
