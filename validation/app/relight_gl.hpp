// validation/app/relight_gl.hpp: `plumbline relight --backend gl`.
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "prt/sh/lighting.hpp"
#include "prt/transfer/baked_file.hpp"
#include "validation/app/relight_backend.hpp"

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

/// A context with the baked scene uploaded. The baked scene must outlive it.
class GlRelighter {
 public:
  /// @throws InputError or DeviceError, one line, when OpenGL cannot do it.
  GlRelighter(const GlOptions& options, const transfer::Baked& baked);
  ~GlRelighter();
  GlRelighter(const GlRelighter&) = delete;
  GlRelighter& operator=(const GlRelighter&) = delete;

  /// Exit radiance for unit albedo, one a vertex.
  [[nodiscard]] std::vector<Rgb> relight(const sh::ShRgb& lighting);
  /// Under the light of the last relight().
  [[nodiscard]] image::LayeredImage picture(const View& view);
  /// Which driver, the seconds of each step of the first picture, and the audit that was asked for: the last call.
  [[nodiscard]] nlohmann::json summary(const sh::ShRgb& lighting, const std::optional<View>& view);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline::app
