// validation/app/relight_backend.hpp: what a picture of `plumbline relight` shows.
#pragma once

#include <functional>

#include "prt/relight/cpu.hpp"

namespace plumbline::app {

struct View {
  scene::Camera camera;
  relight::ViewSettings settings;
  std::function<Rgb(const Vec3&)> background;
};
}  // namespace plumbline::app
