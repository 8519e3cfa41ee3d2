// prt/relight/cpu.hpp: light times transfer, on the CPU.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "prt/relight/transfer_blocks.hpp"
#include "prt/sh/lighting.hpp"
#include "prt/transfer/transfer.hpp"
#include "reference/image/exr.hpp"
#include "reference/scene/camera.hpp"
#include "reference/scene/scene.hpp"

namespace plumbline::relight {

/// Exit radiance for unit albedo at every vertex: sum_i T_i l_i, one dot product a channel. May be negative:
/// a band-limited light is. Lighting with more bands than the transfer is truncated to the transfer's.
///
/// The light is rounded to float and products are summed in float: within (n^2 + 1) 2^-24 sum_i |T_i l_i| of the
/// exact sum, below 1e-38 aside. NaN and Inf of a transfer vector stay at their vertex. Same bits for any number of
/// threads (0 = all), and on every machine that has, or has not, fused multiply-adds.
/// @param out  one place a vertex
/// @throws InputError when the lighting has fewer bands than the transfer, or for another number of places
void unit_albedo_exit_radiance(const TransferBlocks& transfer, const sh::ShRgb& lighting, std::span<Rgb> out,
                               int threads = 0);
/// The same for a single light: brings the transfer into blocks first, which takes longer than the sums.
[[nodiscard]] std::vector<Rgb> unit_albedo_exit_radiance(const transfer::Transfer& transfer,
                                                         const sh::ShRgb& lighting, int threads = 0);

struct ViewSettings {
  int width = 256;
  int height = 256;
  int grid = 4;  // grid x grid rays a pixel, at the centres of equal cells
  int threads = 0;
};
/// @throws InputError unless there is at least one pixel with one ray.
void require_valid(const ViewSettings& settings);
/// A view's channels from its parts: what is seen, the background in it, the albedo. `grid` as in ViewSettings.
[[nodiscard]] image::LayeredImage view_layers(const image::Image& mean, const image::Image& background,
                                              const image::Image& albedo, int grid);

/// The scene through a camera: vertex values interpolated over each triangle times the albedo of the point,
/// box filter of one pixel, `background` where nothing is met (none: black). Channels as in
/// CONVENTIONS.md#images: R G B, samples, emission (the background), albedo. A single-sided surface is black
/// from behind, and so is a double-sided one: the bake knows the front only.
[[nodiscard]] image::LayeredImage render_view(const scene::Scene& scene,
                                              const std::vector<Rgb>& unit_albedo_radiance,
                                              const scene::Camera& camera, const ViewSettings& settings,
                                              const std::function<Rgb(const Vec3& direction)>& background);

}  // namespace plumbline::relight
