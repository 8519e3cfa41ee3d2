// validation/app/relight_backend.hpp: what a backend of `plumbline relight` is asked for, and gives.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "prt/relight/cpu.hpp"

namespace plumbline::app {

struct View {
  scene::Camera camera;
  relight::ViewSettings settings;
  std::function<Rgb(const Vec3&)> background;
};
struct Relit {
  std::vector<Rgb> unit_albedo_radiance;     // one a vertex
  std::optional<image::LayeredImage> image;  // when a view was given
};

}  // namespace plumbline::app
