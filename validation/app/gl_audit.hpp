// validation/app/gl_audit.hpp: `plumbline relight --gl-audit`.
#pragma once

#include <nlohmann/json.hpp>

#include "prt/relight/gl/context.hpp"
#include "prt/sh/lighting.hpp"
#include "prt/transfer/baked_file.hpp"
#include "reference/scene/camera.hpp"

namespace plumbline::app {

/// {"agreement": the image against the CPU's sample by sample, "storage": the error of each way to store transfer, "targets":
/// the largest radiance before Inf}. The image has one sample a pixel.
[[nodiscard]] nlohmann::json gl_audit(const relight::gl::Context& context, const transfer::Baked& baked,
                                      const sh::ShRgb& lighting, const scene::Camera& camera, int width,
                                      int height);

}  // namespace plumbline::app
