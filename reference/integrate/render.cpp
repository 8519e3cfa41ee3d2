#include "reference/integrate/render.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "reference/base/error.hpp"
#include "reference/base/parallel.hpp"
#include "reference/integrate/allocation.hpp"
#include "reference/integrate/direct_view.hpp"
#include "reference/integrate/film.hpp"
#include "reference/integrate/shards.hpp"

namespace plumbline::integrate {
namespace {

constexpr int kTile = 16;
constexpr std::size_t kBounceLayers = 16;  // bounce0 … bounce15, the rest together
constexpr int kMaxSide = 1 << 15;

/// Per-pixel sums of everything that has no standard error of its own.
struct Extras {
  RgbD emission{0.0};
  RgbD albedo{0.0};
  Vec3d normal{0.0};
  Vec3d position{0.0};
  double depth = 0.0;
  std::int64_t hits = 0;
  std::int64_t samples = 0;
};

/// Sums of the samples of even and of odd randomisations: randomisations are independent, so the halves are.
struct Halves {
  RgbD sums[2] = {RgbD(0.0), RgbD(0.0)};
  std::int64_t samples[2] = {0, 0};
};

struct Film {
  int width = 0;
  int height = 0;
  std::vector<RgbEstimate> radiance;
  std::vector<Extras> extras;                  // empty when no layer needs it
  std::vector<std::vector<RgbD>> bounce_sums;  // [layer][pixel]
  std::vector<RgbD> direct_sums;               // this and the next two are empty unless asked for
  std::vector<RgbD> indirect_sums;
  std::vector<Halves> halves;
};

struct Tile {
  int x0, y0, x1, y1;
};

std::vector<Tile> tiles_of(const RenderSettings& settings) {
  std::vector<Tile> tiles;
  int number = 0;
  for (int y = 0; y < settings.height; y += kTile) {
    for (int x = 0; x < settings.width; x += kTile) {
      if (number++ % settings.shard.count != settings.shard.index) continue;
      tiles.push_back({x, y, std::min(x + kTile, settings.width), std::min(y + kTile, settings.height)});
    }
  }
  return tiles;
}

bool needs_extras(const Layers& layers) {
  return layers.emission || layers.albedo || layers.normal || layers.position || layers.depth;
}

std::size_t bounce_layers(const RenderSettings& settings) {
  if (!settings.layers.bounces) return 0;
  if (settings.max_bounces >= static_cast<int>(kBounceLayers)) return kBounceLayers + 1;
  return static_cast<std::size_t>(settings.max_bounces) + 1;
}

Film make_film(const RenderSettings& settings) {
  const auto pixels = static_cast<std::size_t>(settings.width) * static_cast<std::size_t>(settings.height);
  Film film;
  film.width = settings.width;
  film.height = settings.height;
  film.radiance.resize(pixels);
  if (needs_extras(settings.layers)) film.extras.resize(pixels);
  film.bounce_sums.assign(bounce_layers(settings), std::vector<RgbD>(pixels, RgbD(0.0)));
  if (settings.layers.direct) film.direct_sums.assign(pixels, RgbD(0.0));
  if (settings.layers.indirect) film.indirect_sums.assign(pixels, RgbD(0.0));
  if (settings.layers.halves) film.halves.resize(pixels);
  return film;
}

void add_extras(Extras& extras, const CameraSample& sample, const RgbD& emission) {
  ++extras.samples;
  extras.emission += emission;
  extras.albedo += RgbD(sample.albedo);
  if (!sample.is_hit) return;
  ++extras.hits;
  extras.normal += Vec3d(sample.point.shading_normal);
  extras.position += Vec3d(sample.point.position);
  extras.depth += static_cast<double>(sample.distance);
}

void add_bounces(const BounceTerms& terms, std::size_t pixel, Film& film) {
  for (std::size_t k = 0; k < terms.size(); ++k) {
    if (!film.bounce_sums.empty())
      film.bounce_sums[std::min(k, film.bounce_sums.size() - 1)][pixel] += terms[k];
    std::vector<RgbD>& sums = k == 0 ? film.direct_sums : film.indirect_sums;
    if (!sums.empty()) sums[pixel] += terms[k];
  }
}

void add_half(Halves& halves, std::uint32_t randomisation, const RgbD& value) {
  halves.sums[randomisation % 2] += value;
  ++halves.samples[randomisation % 2];
}

void render_pixel(const World& world, const scene::Camera& camera, const RenderSettings& settings, int round,
                  int samples, int x, int y, BounceTerms& terms, Film& film) {
  const std::size_t pixel =
      static_cast<std::size_t>(y) * static_cast<std::size_t>(film.width) + static_cast<std::size_t>(x);
  const PixelView view{camera.eye, scene::image_plane(camera, film.width, film.height), x, y,
                       settings.is_background_visible};
  const RgbD share = emission_share(world, view, settings.max_bounces, settings.seed, pixel);
  const bool is_split = share != RgbD(0.0);
  RandomisedMean mean(samples, settings.randomisations);
  for (int s = 0; s < samples; ++s) {
    const SamplePlace place = sample_place(round, samples, s, settings.randomisations);
    Sampler sampler(settings.seed, pixel, place.randomisation, place.index);
    const Vec2 jitter = sampler.next_2d();
    const Vec3 direction =
        scene::ray_direction(view.plane, static_cast<float>(x) + jitter.x, static_cast<float>(y) + jitter.y);
    CameraSample seen = sample_radiance(world, {camera.eye, direction}, settings.max_bounces, sampler, terms);
    if (!seen.is_hit && !settings.is_background_visible) seen.emission = Rgb(0.0F);
    RgbD emission(seen.emission);
    if (is_split) emission += share * (split_emission(world, view, sampler) - emission);
    RgbD sum = emission;
    for (const RgbD& term : terms) sum += term;
    mean.add(s, sum);
    if (!film.extras.empty()) add_extras(film.extras[pixel], seen, emission);
    if (!film.halves.empty()) add_half(film.halves[pixel], place.randomisation, sum);
    add_bounces(terms, pixel, film);
  }
  film.radiance[pixel] = combined(film.radiance[pixel], mean.estimate());
}

/// Samples of each pixel of a round: `samples` where they are dealt evenly, about that many on average elsewhere.
struct Round {
  int number = 0;
  int samples = 0;
  Allocation allocation;

  [[nodiscard]] int samples_of(std::size_t pixel, int randomisations) const {
    return allocation.is_uniform() ? samples : allocation.samples(pixel, samples, randomisations);
  }
};

void render_round(const World& world, const scene::Camera& camera, const RenderSettings& settings,
                  const Round& round, const std::function<void(double)>& progress, Film& film) {
  const std::vector<Tile> tiles = tiles_of(settings);
  std::atomic<std::size_t> done{0};
  parallel_for(tiles.size(), settings.threads, [&](std::size_t t) {
    BounceTerms terms;
    for (int y = tiles[t].y0; y < tiles[t].y1; ++y) {
      for (int x = tiles[t].x0; x < tiles[t].x1; ++x) {
        const auto pixel =
            static_cast<std::size_t>(y) * static_cast<std::size_t>(film.width) + static_cast<std::size_t>(x);
        const int samples = round.samples_of(pixel, settings.randomisations);
        render_pixel(world, camera, settings, round.number, samples, x, y, terms, film);
      }
    }
    if (progress) progress(static_cast<double>(done.fetch_add(1) + 1) / static_cast<double>(tiles.size()));
  });
}

void require_valid(const RenderSettings& s) {
  if (s.width < 1 || s.height < 1 || s.width > kMaxSide || s.height > kMaxSide) {
    throw InputError(
        fmt::format("size: expected 1x1 to {}x{}, got {}x{}", kMaxSide, kMaxSide, s.width, s.height));
  }
  if (s.samples_per_pixel < 1)
    throw InputError(fmt::format("samples per pixel: expected at least 1, got {}", s.samples_per_pixel));
  if (s.layers.halves && s.samples_per_pixel < 2 && !s.target_error && !s.max_seconds)
    throw InputError("halves: expected at least 2 samples per pixel, got 1");
  if (s.randomisations < kLeastRandomisations || s.randomisations > kMostRandomisations) {
    throw InputError(fmt::format("randomisations: expected {} to {}, got {}", kLeastRandomisations,
                                 kMostRandomisations, s.randomisations));
  }
  if (s.max_bounces < 0) throw InputError(fmt::format("bounces: expected 0 or more, got {}", s.max_bounces));
  if (s.target_error && !(*s.target_error > 0.0))
    throw InputError(fmt::format("target error: expected > 0, got {}", *s.target_error));
  if (s.max_seconds && !(*s.max_seconds > 0.0))
    throw InputError(fmt::format("seconds: expected > 0, got {}", *s.max_seconds));
  if (s.shard.count < 1 || s.shard.index < 0 || s.shard.index >= s.shard.count) {
    throw InputError(
        fmt::format("shard: expected i/N with 0 <= i < N, got {}/{}", s.shard.index, s.shard.count));
  }
  if (s.shard.count > 1 && (s.target_error || s.max_seconds)) {
    throw InputError(
        "shard: a part cannot know the whole image's error or share its time; give a sample count instead");
  }
}

/// Writes one layer: `value_of(pixel)` gives its three components.
template <class ValueOf>
void put_layer(image::LayeredImage& out, const std::string& layer, const char* components, std::size_t pixels,
               const ValueOf& value_of) {
  for (int c = 0; c < 3; ++c) {
    std::vector<float>& channel = out.channels[layer + components[c]];
    channel.resize(pixels);
    for (std::size_t p = 0; p < pixels; ++p) channel[p] = static_cast<float>(value_of(p)[c]);
  }
}

// Pixels outside the shard have no samples (and a point that no ray hit no normal): 0, not 0 / 0.
double divisor(std::int64_t count) {
  return std::max(1.0, static_cast<double>(count));
}

/// What the surfaces look like: averages over the samples, or over those that hit something.
void put_extras(const Film& film, const Layers& layers, image::LayeredImage& out) {
  const std::vector<Extras>& extras = film.extras;
  const std::size_t pixels = extras.size();
  const auto samples = [&](std::size_t p) { return divisor(extras[p].samples); };
  const auto hits = [&](std::size_t p) { return divisor(extras[p].hits); };
  if (layers.emission)
    put_layer(out, "emission.", "RGB", pixels, [&](auto p) { return extras[p].emission / samples(p); });
  if (layers.albedo)
    put_layer(out, "albedo.", "RGB", pixels, [&](auto p) { return extras[p].albedo / samples(p); });
  if (layers.normal)
    put_layer(out, "normal.", "XYZ", pixels, [&](auto p) { return extras[p].normal / hits(p); });
  if (layers.position)
    put_layer(out, "position.", "XYZ", pixels, [&](auto p) { return extras[p].position / hits(p); });
  if (!layers.depth) return;
  std::vector<float>& depth = out.channels["depth"];
  for (std::size_t p = 0; p < pixels; ++p) depth.push_back(static_cast<float>(extras[p].depth / hits(p)));
}

/// The light's own parts: by bounces, and by halves of the samples.
void put_parts(const Film& film, image::LayeredImage& out) {
  const std::size_t pixels = film.radiance.size();
  const auto put_sums = [&](const std::string& layer, const std::vector<RgbD>& sums) {
    if (sums.empty()) return;
    put_layer(out, layer, "RGB", pixels, [&](auto p) { return sums[p] / divisor(film.radiance[p].samples); });
  };
  for (std::size_t k = 0; k < film.bounce_sums.size(); ++k) {
    put_sums(k < kBounceLayers ? fmt::format("bounce{}.", k) : "bounceRest.", film.bounce_sums[k]);
  }
  put_sums("direct.", film.direct_sums);
  put_sums("indirect.", film.indirect_sums);
  if (film.halves.empty()) return;
  for (std::size_t half = 0; half < 2; ++half) {
    put_layer(out, half == 0 ? "a." : "b.", "RGB", pixels,
              [&](auto p) { return film.halves[p].sums[half] / divisor(film.halves[p].samples[half]); });
  }
}

image::LayeredImage develop(const Film& film, const RenderSettings& settings) {
  image::LayeredImage out{film.width, film.height, {}, {}};
  const std::size_t pixels = film.radiance.size();
  put_layer(out, "", "RGB", pixels, [&](auto p) { return film.radiance[p].mean; });
  put_layer(out, "stderr.", "RGB", pixels, [&](auto p) { return film.radiance[p].standard_error; });
  std::vector<float>& samples = out.channels["samples"];
  for (const RgbEstimate& estimate : film.radiance) samples.push_back(static_cast<float>(estimate.samples));
  put_parts(film, out);
  if (!film.extras.empty()) put_extras(film, settings.layers, out);
  return out;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double mean_samples(const Film& film) {
  double sum = 0.0;
  double pixels = 0.0;
  for (const RgbEstimate& estimate : film.radiance) {
    sum += static_cast<double>(estimate.samples);
    pixels += estimate.samples > 0 ? 1.0 : 0.0;
  }
  return sum / std::max(pixels, 1.0);
}

/// The image so far, and what is known of it.
struct Progressive {
  Film film;
  RenderResult result;
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
  double spent_samples = 0.0;  // a pixel, those of the pilot included

  void add_round(const World& world, const scene::Camera& camera, const RenderSettings& settings,
                 const Round& round, const std::function<void(double)>& progress) {
    const double before = mean_samples(film);
    render_round(world, camera, settings, round, progress, film);
    const OverallError error = overall_error(film.radiance);
    const double after = mean_samples(film);
    spent_samples += after - before;
    result.samples_per_pixel = std::llround(after);
    result.relative_error = error.relative;
    result.mean_radiance = error.mean;
    result.seconds = seconds_since(start);
  }
};

/// Mean samples of the next round: towards the target, at most three times what there is, within the time left; 0 = stop.
int next_round(const RenderSettings& settings, const Progressive& image) {
  const std::int64_t done = image.result.samples_per_pixel;
  // Without a target there is always more to do.
  double wanted = settings.target_error
                      ? samples_towards(*settings.target_error, done, image.result.relative_error)
                      : samples_towards(1.0, done, std::numeric_limits<double>::infinity());
  if (settings.max_seconds) {
    const double rate = image.spent_samples / std::max(image.result.seconds, 1e-6);
    const double affordable = std::floor((*settings.max_seconds - image.result.seconds) * rate);
    if (affordable < 2.0) return 0;  // a round of one sample would have no standard error
    wanted = std::min(wanted, affordable);
  }
  return static_cast<int>(wanted);
}

void report_progress(const RenderSettings& settings, const RenderResult& result) {
  if (!settings.progress) return;
  const double by_time = settings.max_seconds ? result.seconds / *settings.max_seconds : 0.0;
  const double ratio = settings.target_error ? *settings.target_error / result.relative_error : 0.0;
  settings.progress(std::min(1.0, std::max(by_time, ratio * ratio)));
}

// Towards a target error the first round is a pilot: it says where the noise is, and is then left out of the image
// (Allocation says why) unless no time is left for another. What a later round adds is decided on the whole image's error alone,
// to which one pixel contributes next to nothing.
void render_progressively(const World& world, const scene::Camera& camera, const RenderSettings& settings,
                          Progressive& image) {
  Round round{0, settings.max_seconds ? 2 : std::max(kRandomisations, settings.randomisations), {}};
  bool is_pilot = settings.target_error.has_value();
  while (round.samples > 0) {
    image.add_round(world, camera, settings, round, {});
    report_progress(settings, image.result);
    if (settings.target_error && image.result.relative_error <= *settings.target_error && !is_pilot) {
      image.result.stop = StopReason::target_error;
      return;
    }
    image.result.stop = StopReason::max_seconds;
    const int samples = next_round(settings, image);
    const bool is_enough = image.result.samples_per_pixel >= kRandomisations;
    if (is_pilot && samples > 0 && is_enough) {
      is_pilot = false;
      round.allocation = Allocation(image.film.radiance, settings.width, settings.height);
      image.film = make_film(settings);
      image.result.samples_per_pixel = 0;
    }
    round.samples = samples;
    ++round.number;
  }
}

}  // namespace

RenderResult render(const World& world, const scene::Camera& camera, const RenderSettings& settings) {
  require_valid(settings);
  Progressive image{make_film(settings), {}};
  if (settings.target_error || settings.max_seconds) {
    render_progressively(world, camera, settings, image);
  } else {
    image.add_round(world, camera, settings, {0, settings.samples_per_pixel, {}}, settings.progress);
  }
  image.result.image = develop(image.film, settings);
  return std::move(image.result);
}

}  // namespace plumbline::integrate
