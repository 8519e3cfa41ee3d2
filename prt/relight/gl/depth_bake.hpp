// prt/relight/gl/depth_bake.hpp: shadowed transfer from depth maps, the "GPU simulator" of
// Kautz, Sloan & Lehtinen, "Precomputed Radiance Transfer: Theory and Practice", SIGGRAPH 2005 course.
#pragma once

#include <cstdint>
#include <vector>

#include "prt/relight/gl/context.hpp"
#include "prt/transfer/transfer.hpp"
#include "reference/scene/scene.hpp"
#include "reference/trace/ray_caster.hpp"

namespace plumbline::relight::gl {

struct DepthBakeSettings {
  int bands = 5;
  int directions = 1024;
  int resolution = 512;  // texels a side of a depth map, which spans the scene's bounding sphere
  double offset =
      2.0;  // towards the light, in texels: below it a surface shadows itself, above it shadows come loose
  std::uint64_t seed = 0;
};

/// `count` directions, uniform over the sphere, shared by all vertices.
[[nodiscard]] std::vector<Vec3d> shared_directions(int count, std::uint64_t seed);

/// T_i = (4 / N) sum_j y_i(w_j) V(w_j) max(0, n.w_j), where V asks an orthographic depth map seen from w_j, nearest texel;
/// summed in float, in the order of the directions. Kind::shadowed, gray, without standard errors.
/// @throws InputError for settings out of range or a scene with exact spheres or discs; DeviceError when the driver fails.
[[nodiscard]] transfer::Transfer bake_from_depth(const Context& context, const scene::Scene& scene,
                                                 const DepthBakeSettings& settings);

/// The same sum along the same directions with V from rays, in double: what depth maps are to be held against.
[[nodiscard]] transfer::Transfer bake_along(const scene::Scene& scene, const DepthBakeSettings& settings);

}  // namespace plumbline::relight::gl
