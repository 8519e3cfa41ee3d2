#include "reference/integrate/render.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>

#include "reference/base/error.hpp"
#include "reference/base/parallel.hpp"
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

void add_extras(Extras& extras, const CameraSample& sample) {
  ++extras.samples;
  extras.emission += RgbD(sample.emission);
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
  const scene::ImagePlane plane = scene::image_plane(camera, film.width, film.height);
  RandomisedMean mean(samples, settings.randomisations);
  for (int s = 0; s < samples; ++s) {
    const SamplePlace place = sample_place(round, samples, s, settings.randomisations);
    Sampler sampler(settings.seed, pixel, place.randomisation, place.index);
    const Vec2 jitter = sampler.next_2d();
    const Vec3 direction =
        scene::ray_direction(plane, static_cast<float>(x) + jitter.x, static_cast<float>(y) + jitter.y);
    CameraSample seen = sample_radiance(world, {camera.eye, direction}, settings.max_bounces, sampler, terms);
    if (!seen.is_hit && !settings.is_background_visible) seen.emission = Rgb(0.0F);
    RgbD sum(seen.emission);
    for (const RgbD& term : terms) sum += term;
    mean.add(s, sum);
    if (!film.extras.empty()) add_extras(film.extras[pixel], seen);
    if (!film.halves.empty()) add_half(film.halves[pixel], place.randomisation, sum);
    add_bounces(terms, pixel, film);
  }
  film.radiance[pixel] = combined(film.radiance[pixel], mean.estimate());
}

void render_round(const World& world, const scene::Camera& camera, const RenderSettings& settings, int round,
                  int samples, const std::function<void(double)>& progress, Film& film) {
  const std::vector<Tile> tiles = tiles_of(settings);
  std::atomic<std::size_t> done{0};
  parallel_for(tiles.size(), settings.threads, [&](std::size_t t) {
    BounceTerms terms;
    for (int y = tiles[t].y0; y < tiles[t].y1; ++y) {
      for (int x = tiles[t].x0; x < tiles[t].x1; ++x) {
        render_pixel(world, camera, settings, round, samples, x, y, terms, film);
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

/// Samples of the next round: towards the target, at most four times what there is, within the time left; 0 =
/// stop.
int next_round(const RenderSettings& settings, std::int64_t done, double relative_error, double seconds) {
  // Without a target there is always more to do.
  double wanted = settings.target_error ? samples_towards(*settings.target_error, done, relative_error)
                                        : samples_towards(1.0, done, std::numeric_limits<double>::infinity());
  if (settings.max_seconds) {
    const double rate = static_cast<double>(done) / std::max(seconds, 1e-6);
    const double affordable = std::floor((*settings.max_seconds - seconds) * rate);
    if (affordable < 2.0) return 0;  // a round of one sample would have no standard error
    wanted = std::min(wanted, affordable);
  }
  return static_cast<int>(wanted);
}

}  // namespace

RenderResult render(const World& world, const scene::Camera& camera, const RenderSettings& settings) {
  require_valid(settings);
  const auto start = std::chrono::steady_clock::now();
  Film film = make_film(settings);
  RenderResult result;
  const bool is_progressive = settings.target_error.has_value() || settings.max_seconds.has_value();
  int samples = is_progressive ? (settings.max_seconds ? 2 : kRandomisations) : settings.samples_per_pixel;
  for (int round = 0; samples > 0; ++round) {
    const auto progress = [&](double fraction) {
      if (settings.progress && !is_progressive) settings.progress(fraction);
    };
    render_round(world, camera, settings, round, samples, progress, film);
    result.samples_per_pixel += samples;
    result.seconds = seconds_since(start);
    const OverallError error = overall_error(film.radiance);
    result.relative_error = error.relative;
    result.mean_radiance = error.mean;
    if (!is_progressive) break;
    if (settings.target_error && error.relative <= *settings.target_error) {
      result.stop = StopReason::target_error;
      break;
    }
    result.stop = StopReason::max_seconds;
    samples = next_round(settings, result.samples_per_pixel, error.relative, result.seconds);
    if (settings.progress) {
      const double by_time = settings.max_seconds ? result.seconds / *settings.max_seconds : 0.0;
      const double ratio = settings.target_error ? *settings.target_error / error.relative : 0.0;
      settings.progress(std::min(1.0, std::max(by_time, ratio * ratio)));
    }
  }
  result.image = develop(film, settings);
  return result;
}

}  // namespace plumbline::integrate
