// validation/study/method.hpp: the ways to make an image that are timed against each other.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "reference/image/image.hpp"
#include "reference/integrate/world.hpp"
#include "reference/scene/camera.hpp"
#include "validation/study/reference_image.hpp"

namespace plumbline::study {

/// What all methods are given.
struct Task {
  std::shared_ptr<const integrate::World>
      world;  // its environment is constant, or a lat-long image without rotation and suns
  scene::Camera camera;
  int width = 256;
  int height = 256;
  int max_bounces = 8;
  int threads = 0;  // above 0
};

struct Rendered {
  image::Image image;
  double seconds = 0.0;  // tracing only: no start, no loading, no building of hierarchies and tables
};

/// One way, ready for a task. Equal seeds give equal images, different ones independent images.
struct Method {
  std::string name;
  std::function<Rendered(int spp, std::uint64_t seed)> render;
  /// `spp` samples in two independent halves.
  std::function<Halved(int spp, std::uint64_t seed)> render_halves;
};

/// A way that is known, and whether it is there.
struct MethodEntry {
  std::string name;
  std::string description;
  /// Why it cannot be used here and for this task; empty when it can.
  std::function<std::string(const Task& task)> reason_against;
  std::function<Method(const Task& task)> make;
};
/// "path" (integrate::render) and "cycles" (Blender's).
[[nodiscard]] const std::vector<MethodEntry>& methods();
/// @throws InputError listing the names there are.
[[nodiscard]] const MethodEntry& find_method(const std::string& name);

/// The light as all methods can hold it: a constant, or a lat-long image. Other environments (suns, rotations, analytic functions,
/// cube and angular maps) are averaged into one of 1024 x 512 texels, nearest lookup, negative radiance set to 0.
struct SharedLight {
  light::Environment environment;
  bool is_resampled = false;
};
[[nodiscard]] SharedLight shared_light(const light::Environment& environment);

}  // namespace plumbline::study
