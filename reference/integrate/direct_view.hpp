// reference/integrate/direct_view.hpp: what a pixel sees of the lights themselves.
#pragma once

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

/// Whether the pixel is crossed by the edge of something bright: 4 x 4 fixed probing rays from edge to edge differ by a standard deviation of more
/// than a tenth of their mean. The samples of the image have no say in it, so that the answer may decide how the pixel is
/// sampled without a bias.
[[nodiscard]] bool is_emission_uneven(const World& world, const PixelView& view);

/// Rays that an uneven pixel spends on emission for each of its samples.
inline constexpr std::uint32_t kEmissionSplits = 16;

/// Mean emission over kEmissionSplits points of the pixel, the points of one sequence over all its samples. The edge of a lamp of
/// radiance 17 in a dark room is otherwise half of an image's noise (measured: Cornell box, 64 samples), for want of rays
/// that cost a hundredth of a path's.
[[nodiscard]] RgbD split_emission(const World& world, const PixelView& view, Sampler& sampler);

}  // namespace plumbline::integrate
