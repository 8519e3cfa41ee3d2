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

struct GlRelighter::Impl {
  GlOptions options;
  const transfer::Baked& baked;
  relight::gl::Context context;
  std::optional<relight::gl::Renderer> renderer;
  nlohmann::json summary;

  /// Runs it, and records the seconds of the first time under a name.
  void timed(const char* name, const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    context.gl().Finish();
    if (!summary.contains(name)) summary[name] = seconds_since(start);
  }
};

GlRelighter::GlRelighter(const GlOptions& options, const transfer::Baked& baked) {
  using namespace relight::gl;
  const auto start = std::chrono::steady_clock::now();
  impl_.reset(new Impl{options,
                       baked,
                       Context(settings_from_environment(provider_from_string(options.context))),
                       std::nullopt,
                       {}});
  impl_->summary = {{"driver", impl_->context.description()},
                    {"storage", options.storage},
                    {"target", options.target},
                    {"seconds_context", seconds_since(start)}};
  const RendererSettings settings{storage_from_string(options.storage), target_from_string(options.target)};
  impl_->timed("seconds_upload",
               [&] { impl_->renderer.emplace(impl_->context, baked.scene, baked.transfer, settings); });
  impl_->summary["sums"] = impl_->renderer->sums();
}

GlRelighter::~GlRelighter() = default;

std::vector<Rgb> GlRelighter::relight(const sh::ShRgb& lighting) {
  impl_->timed("seconds_vertices", [&] { impl_->renderer->set_light(lighting); });
  return impl_->renderer->unit_albedo_exit_radiance();
}

image::LayeredImage GlRelighter::picture(const View& view) {
  image::LayeredImage result;
  impl_->timed("seconds_image", [&] {
    result = relight::gl::render_view(*impl_->renderer, view.camera, view.settings, view.background);
  });
  return result;
}

nlohmann::json GlRelighter::summary(const sh::ShRgb& lighting, const std::optional<View>& view) {
  // What an animation spends on a frame once everything is compiled and uploaded.
  if (view) {
    impl_->timed("seconds_frame", [&] {
      impl_->renderer->set_light(lighting);
      impl_->renderer->draw(nullptr);
    });
  }
  impl_->renderer.reset();
  if (impl_->options.is_audited && view) {
    impl_->summary["audit"] = gl_audit(impl_->context, impl_->baked, lighting, view->camera,
                                       view->settings.width, view->settings.height);
  }
  return impl_->summary;
}

}  // namespace plumbline::app
