// reference/integrate/render.hpp: path-traced images.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "reference/image/image.hpp"
#include "reference/integrate/film.hpp"
#include "reference/integrate/path.hpp"
#include "reference/integrate/world.hpp"
#include "reference/scene/camera.hpp"

namespace plumbline::integrate {

/// Layers beyond mean, standard error and sample count.
struct Layers {
  bool emission = false;
  bool bounces = false;
  bool albedo = false;
  bool normal = false;
  bool position = false;
  bool depth = false;
  bool direct = false;    // bounce 0
  bool indirect = false;  // all further bounces together
  bool halves = false;    // means `a` and `b` of the even and of the odd randomisations; needs 2 samples
};

/// Part `index` of `count`: every count-th 16 x 16 tile.
struct Shard {
  int index = 0;
  int count = 1;
};

/// Called now and then, from any thread, with the fraction done in [0, 1].
using Progress = std::function<void(double fraction)>;

struct RenderSettings {
  int width = 256;
  int height = 256;
  int samples_per_pixel = 64;  // of a run without target_error and max_seconds
  std::optional<double>
      target_error;  // relative: root of the mean squared standard error over the mean radiance
  std::optional<double> max_seconds;
  int max_bounces = kAllBounces;
  int randomisations = kRandomisations;  // independent sequences a pixel and round, 2 … 32: film.hpp
  std::uint64_t seed = 0;
  int threads = 0;  // 0 = all there are; never changes the result
  Shard shard;
  bool is_background_visible = true;  // false: camera rays that meet nothing are black
  Layers layers;
  Progress progress;
};

enum class StopReason { samples, target_error, max_seconds };

struct RenderResult {
  image::LayeredImage image;  // channels as in CONVENTIONS.md#images; no attributes yet
  std::int64_t samples_per_pixel = 0;
  double relative_error = 0.0;  // as defined at target_error
  double mean_radiance = 0.0;
  double seconds = 0.0;  // tracing only
  StopReason stop = StopReason::samples;
};

/// Box filter of one pixel. With bounce layers and a bounce limit above 15, terms from 16 on are summed in
/// `bounceRest`. With target_error or max_seconds the image is made in rounds of growing size, the decision
/// after each taken on the image's error.
/// @throws InputError for sizes or counts below 1, a shard out of range, a shard together with
/// target_error / max_seconds, or halves of a single sample.
[[nodiscard]] RenderResult render(const World& world, const scene::Camera& camera,
                                  const RenderSettings& settings);

}  // namespace plumbline::integrate
