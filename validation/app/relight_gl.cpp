#include "validation/app/relight_gl.hpp"

#include <fmt/format.h>

#include <chrono>

#include "prt/relight/gl/renderer.hpp"
#include "reference/base/error.hpp"
#include "validation/app/gl_audit.hpp"
#include "validation/app/options.hpp"

namespace plumbline::app {

void add_gl_options(CLI::App& verb, GlOptions& options) {
  verb.add_option("--gl-context", options.context,
                  "with --backend gl: osmesa, egl (surfaceless), or auto: the first that there is")
      ->check(CLI::IsMember({"auto", "osmesa", "egl"}));
  verb.add_option("--gl-storage", options.storage, "with --backend gl: how transfer is stored")
      ->check(CLI::IsMember({"f32", "f16", "unorm16", "unorm8"}));
  verb.add_option("--gl-target", options.target, "with --backend gl: what the image is drawn into")
      ->check(CLI::IsMember({"f32", "f16"}));
  verb.add_flag(
      "--gl-audit", options.is_audited,
      "with --backend gl: add to --json how far the image is from the CPU's, what each storage costs, and "
      "the largest radiance that each target holds");
}

void require_valid(const GlOptions& options, const std::string& backend) {
  const GlOptions untouched;
  if (backend == "gl" || (options.context == untouched.context && options.storage == untouched.storage &&
                          options.target == untouched.target && !options.is_audited))
    return;
  throw InputError(fmt::format("relight: --gl-… options need --backend gl, got --backend {}", backend));
}

GlRelit relight_by_gl(const GlOptions& options, const transfer::Baked& baked, const sh::ShRgb& lighting,
                      const std::optional<GlView>& view) {
  using namespace relight::gl;
  const auto seconds = [](const Context& context, const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    context.gl().Finish();
    return seconds_since(start);
  };
  const auto start = std::chrono::steady_clock::now();
  const Context context(settings_from_environment(provider_from_string(options.context)));
  GlRelit result;
  result.summary = {{"driver", context.description()},
                    {"storage", options.storage},
                    {"target", options.target},
                    {"seconds_context", seconds_since(start)}};
  const RendererSettings settings{storage_from_string(options.storage), target_from_string(options.target)};
  std::optional<Renderer> renderer;
  result.summary["seconds_upload"] =
      seconds(context, [&] { renderer.emplace(context, baked.scene, baked.transfer, settings); });
  result.summary["sums"] = renderer->sums();
  result.summary["seconds_vertices"] = seconds(context, [&] { renderer->set_light(lighting); });
  result.unit_albedo_radiance = renderer->unit_albedo_exit_radiance();
  if (!view) return result;
  result.summary["seconds_image"] = seconds(context, [&] {
    result.image = render_view(*renderer, view->camera, view->settings, view->background);
  });
  // What an animation spends on a frame once everything is compiled and uploaded.
  result.summary["seconds_frame"] = seconds(context, [&] {
    renderer->set_light(lighting);
    renderer->draw(nullptr);
  });
  renderer.reset();
  if (options.is_audited) {
    result.summary["audit"] =
        gl_audit(context, baked, lighting, view->camera, view->settings.width, view->settings.height);
  }
  return result;
}

}  // namespace plumbline::app
