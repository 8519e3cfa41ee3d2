// validation/app/relight_gl.hpp: `plumbline relight --backend gl`.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "prt/relight/cpu.hpp"
#include "prt/sh/lighting.hpp"
#include "prt/transfer/baked_file.hpp"

namespace plumbline::app {

struct GlOptions {
  std::string context = "auto";
  std::string storage = "f32";
  std::string target = "f32";
  bool is_audited = false;
};
void add_gl_options(CLI::App& verb, GlOptions& options);
/// @throws InputError when they ask for something of OpenGL and the backend is another.
void require_valid(const GlOptions& options, const std::string& backend);

struct GlView {
  scene::Camera camera;
  relight::ViewSettings settings;
  std::function<Rgb(const Vec3&)> background;
};
struct GlRelit {
  std::vector<Rgb> unit_albedo_radiance;  // one a vertex
  std::optional<image::LayeredImage> image;
  nlohmann::json summary;  // which driver, and the seconds of each step
};
/// @throws InputError or DeviceError, one line, when OpenGL cannot do it.
[[nodiscard]] GlRelit relight_by_gl(const GlOptions& options, const transfer::Baked& baked,
                                    const sh::ShRgb& lighting, const std::optional<GlView>& view);

}  // namespace plumbline::app
