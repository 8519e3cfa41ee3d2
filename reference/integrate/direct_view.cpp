#include "reference/integrate/direct_view.hpp"

#include <algorithm>

namespace plumbline::integrate {
namespace {

constexpr int kProbes = 4;  // in each direction
constexpr double kUneven = 0.1;

constexpr int kProbeCount = kProbes * kProbes;
constexpr std::uint32_t kProbeRandomisation = 0xFFFFFFFFU;  // no sample of an image has it

Vec3 direction_through(const PixelView& view, const Vec2& at) {
  return scene::ray_direction(view.plane, static_cast<float>(view.x) + at.x,
                              static_cast<float>(view.y) + at.y);
}

// From edge to edge: a lamp that covers a sliver of the pixel covers one of its corners.
Vec2 probe(int i) {
  const auto at = [](int k) { return static_cast<float>(k) / static_cast<float>(kProbes - 1); };
  return {at(i % kProbes), at(i / kProbes)};
}

/// Nothing that a camera ray could meet shines.
bool is_all_dark(const World& world, const PixelView& view) {
  return world.emitters.is_empty() && (world.is_sky_black || !view.is_background_visible);
}

}  // namespace

Rgb emission_along(const World& world, const PixelView& view, const Vec3& direction) {
  const std::optional<trace::Hit> hit = world.caster.closest_hit({view.eye, direction});
  if (!hit) {
    return view.is_background_visible ? light::radiance(world.environment, direction) : Rgb(0.0F);
  }
  const trace::SurfaceTable::Surface& surface = world.surfaces.surface(hit->triangle);
  if (is_black(surface.emission) || surface.is_double_sided) return surface.emission;
  return world.surfaces.hit(*hit, direction).is_front ? surface.emission : Rgb(0.0F);
}

bool is_emission_uneven(const World& world, const PixelView& view) {
  if (is_all_dark(world, view)) return false;
  RgbD sum(0.0);
  RgbD squares(0.0);
  for (int i = 0; i < kProbeCount; ++i) {
    const RgbD emission(emission_along(world, view, direction_through(view, probe(i))));
    sum += emission;
    squares += emission * emission;
  }
  const RgbD mean = sum / static_cast<double>(kProbeCount);
  const RgbD variance = squares / static_cast<double>(kProbeCount) - mean * mean;
  const RgbD limit = kUneven * kUneven * mean * mean;
  return variance.r > limit.r || variance.g > limit.g || variance.b > limit.b;
}

RgbD split_emission(const World& world, const PixelView& view, Sampler& sampler) {
  const Sampler::Pair pair = sampler.next_pair();
  RgbD sum(0.0);
  for (std::uint32_t s = 0; s < kEmissionSplits; ++s) {
    sum +=
        RgbD(emission_along(world, view, direction_through(view, sampler.point(pair, s, kEmissionSplits))));
  }
  return sum / static_cast<double>(kEmissionSplits);
}

RgbD emission_share(const World& world, const PixelView& view, int max_bounces, std::uint64_t seed,
                    std::uint64_t pixel) {
  if (!is_emission_uneven(world, view)) return RgbD(0.0);
  RgbD emission_sum(0.0);
  RgbD light_sum(0.0);
  RgbD squares(0.0);
  RgbD products(0.0);
  BounceTerms terms;
  for (int i = 0; i < kProbeCount; ++i) {
    Sampler sampler(seed, pixel, kProbeRandomisation, static_cast<std::uint32_t>(i));
    const Vec3 direction = direction_through(view, probe(i));
    const CameraSample seen = sample_radiance(world, {view.eye, direction}, max_bounces, sampler, terms);
    const bool is_seen = seen.is_hit || view.is_background_visible;
    const RgbD emission = is_seen ? RgbD(seen.emission) : RgbD(0.0);
    RgbD light(0.0);
    for (const RgbD& term : terms) light += term;
    emission_sum += emission;
    light_sum += light;
    squares += emission * emission;
    products += emission * light;
  }
  const RgbD variance = squares - emission_sum * emission_sum / static_cast<double>(kProbeCount);
  const RgbD covariance = products - emission_sum * light_sum / static_cast<double>(kProbeCount);
  RgbD share(0.0);
  for (int c = 0; c < 3; ++c) {
    if (variance[c] > 0.0) share[c] = std::clamp(1.0 + covariance[c] / variance[c], 0.0, 1.0);
  }
  return share;
}

}  // namespace plumbline::integrate
