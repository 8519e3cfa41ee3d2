// reference/integrate/direct_view.hpp: what a pixel sees of the lights themselves.
#pragma once

#include "reference/integrate/path.hpp"
#include "reference/integrate/sampler.hpp"
#include "reference/integrate/world.hpp"
#include "reference/scene/camera.hpp"

namespace plumbline::integrate {

/// One pixel of an image.
struct PixelView {
  Vec3 eye{0.0F};
  scene::ImagePlane plane;
  int x = 0;
  int y = 0;
  bool is_background_visible = true;
};

/// Emission along a camera ray: of the front of a surface (and the back of a double-sided one), or of the sky.
[[nodiscard]] Rgb emission_along(const World& world, const PixelView& view, const Vec3& direction);

/// Whether the pixel is crossed by the edge of something bright: 4 x 4 fixed probing rays from edge to edge differ by a standard
/// deviation of more than a tenth of their mean.
[[nodiscard]] bool is_emission_uneven(const World& world, const PixelView& view);

/// Rays that an uneven pixel spends on emission for each of its samples.
inline constexpr std::uint32_t kEmissionSplits = 16;

/// Mean emission over kEmissionSplits points of the pixel, the points of one sequence over all its samples. The edge of a lamp of
/// radiance 17 in a dark room is otherwise half of an image's noise (measured: Cornell box, 64 samples), for want of rays
/// that cost a hundredth of a path's.
[[nodiscard]] RgbD split_emission(const World& world, const PixelView& view, Sampler& sampler);

/// Part b of split_emission in a sample's light: e + t + b (split - e), with e the emission that the sample's own ray met and t the
/// light reflected where it met none. Any b is unbiased; the variance is least for b = 1 + Cov(t, e)/Var(e): 1 at the edge of a lamp
/// far brighter than what is beside it, 0 where both sides are equally bright, since there e + t does not vary at all.
/// Per colour channel, within [0, 1], from 16 paths of its own through the probes: the image's samples have no say in it. 0
/// everywhere unless the pixel is uneven.
[[nodiscard]] RgbD emission_share(const World& world, const PixelView& view, int max_bounces,
                                  std::uint64_t seed, std::uint64_t pixel);

}  // namespace plumbline::integrate
