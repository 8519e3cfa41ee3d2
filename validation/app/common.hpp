// validation/app/common.hpp: what several verbs share: scenes, lights, outputs, progress.
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "reference/light/environment.hpp"
#include "reference/scene/scene.hpp"
#include "validation/app/output.hpp"

namespace plumbline::app {

/// Exit codes of the command.
enum ExitCode : int { kSuccess = 0, kCheckFailed = 1, kBadInput = 2, kInternal = 3 };

/// A verb registers itself: options on a subcommand and a callback that does the work and returns an exit
/// code.
using Action = std::function<int()>;
using Register = void (*)(CLI::App& app, Action& chosen);

/// SCENE, --crease, --ground, --camera.
struct SceneOptions {
  std::string source;
  float crease_deg = 0.0F;
  bool has_ground = false;
  std::string camera;
};
void add_scene_options(CLI::App& verb, SceneOptions& options);
/// Only what changes how a mesh is loaded.
void add_mesh_options(CLI::App& verb, SceneOptions& options);
/// --camera; see camera_of.
void add_camera_option(CLI::App& verb, std::string& camera);
/// Loads and warns (on stderr) of triangles left out.
[[nodiscard]] scene::Scene load(const SceneOptions& options);

/// The camera of that name, or the scene's first. @throws InputError naming --camera
[[nodiscard]] const scene::Camera& camera_of(const scene::Scene& scene, const std::string& name);

/// --env, --env-layout, --env-lookup, --rotate-env.
struct LightOptions {
  std::string source;
  std::string layout = "auto";
  std::string lookup = "nearest";
  std::vector<float> rotation_deg;
};
void add_light_options(CLI::App& verb, LightOptions& options, bool is_required);
/// --env-layout, --env-lookup and --rotate-env alone.
void add_light_modifiers(CLI::App& verb, LightOptions& options);
/// Only --env-lookup.
void add_lookup_option(CLI::App& verb, LightOptions& options);
/// An image, a builtin:NAME, or a .json of SH coefficients (then the band-limited light itself); black when
/// nothing was asked for. Warns (on stderr) of negative texels that were set to 0.
[[nodiscard]] light::Environment load(const LightOptions& options);

/// The options as words of a shell command, each with a blank in front.
[[nodiscard]] std::string command_text(const LightOptions& options);

/// "WxH", both from 1 to kMaxSide. @throws InputError
inline constexpr int kMaxSide = 32768;
struct Size {
  int width = 256;
  int height = 256;
};
[[nodiscard]] Size parse_size(const std::string& text);
/// "all" or a number >= 0. @throws InputError
[[nodiscard]] int parse_bounces(const std::string& text);
[[nodiscard]] std::string bounces_text(int bounces);

[[nodiscard]] double seconds_since(std::chrono::steady_clock::time_point start);

/// A bar with the time left on standard error when that is a terminal; otherwise nothing. Safe to call from
/// many threads.
[[nodiscard]] std::function<void(double fraction)> progress_bar(const std::string& title);

/// The value as one shell word.
[[nodiscard]] std::string quoted(const std::string& word);

}  // namespace plumbline::app
