#include "reference/integrate/direct_view.hpp"

namespace plumbline::integrate {
namespace {

constexpr int kProbes = 4;  // in each direction
constexpr double kUneven = 0.1;

Rgb emission_through(const World& world, const PixelView& view, float x, float y) {
  return emission_along(
      world, view,
      scene::ray_direction(view.plane, static_cast<float>(view.x) + x, static_cast<float>(view.y) + y));
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
  for (int i = 0; i < kProbes * kProbes; ++i) {
    // From edge to edge: a lamp that covers a sliver of the pixel covers one of its corners.
    const auto at = [](int k) { return static_cast<float>(k) / static_cast<float>(kProbes - 1); };
    const RgbD emission(emission_through(world, view, at(i % kProbes), at(i / kProbes)));
    sum += emission;
    squares += emission * emission;
  }
  constexpr double kCount = kProbes * kProbes;
  const RgbD mean = sum / kCount;
  const RgbD variance = squares / kCount - mean * mean;
  const RgbD limit = kUneven * kUneven * mean * mean;
  return variance.r > limit.r || variance.g > limit.g || variance.b > limit.b;
}

RgbD split_emission(const World& world, const PixelView& view, Sampler& sampler) {
  const Sampler::Pair pair = sampler.next_pair();
  RgbD sum(0.0);
  for (std::uint32_t s = 0; s < kEmissionSplits; ++s) {
    const Vec2 at = sampler.point(pair, s, kEmissionSplits);
    sum += RgbD(emission_through(world, view, at.x, at.y));
  }
  return sum / static_cast<double>(kEmissionSplits);
}

}  // namespace plumbline::integrate
