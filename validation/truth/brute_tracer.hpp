// validation/truth/brute_tracer.hpp: a second opinion on global illumination, too simple to share the path
// tracer's mistakes: every ray tests every triangle, directions are uniform, light is met by chance only.
// In common with reference/integrate: the Scene value, light::radiance() and texture lookup; nothing else.
#pragma once

#include <array>
#include <cstdint>

#include "reference/light/environment.hpp"
#include "reference/scene/scene.hpp"
#include "validation/metrics/statistics.hpp"

namespace plumbline::truth {

struct BruteForceSettings {
  int samples = 1 << 16;  // paths, >= 2
  int max_bounces = 0;    // indirect bounces, 0 … 1000; 0 = direct light only
  std::uint64_t seed = 0;
};

/// Irradiance [W m^-2] at a point that belongs to no triangle, red, green, blue: light with up to max_bounces
/// bounces, surfaces as in CONVENTIONS.md#surfaces, all in double precision. The mean of independent paths,
/// with its standard error. A triangle nearer than 1e-9 of the scene's diagonal does not count, so a point
/// may lie on a surface.
/// @param normal  unit
/// @throws InputError for a setting out of range, a normal that is not unit, an invalid scene, and a scene
/// with punctual lights (without extent they are never met by chance) or with exact spheres or discs (it
/// knows triangles only).
/// Cost: samples x rays of a path x triangles, about 5 ns each.
[[nodiscard]] std::array<metrics::Estimate, 3> brute_force_irradiance(const scene::Scene& scene,
                                                                      const light::Environment& environment,
                                                                      const Vec3d& position,
                                                                      const Vec3d& normal,
                                                                      const BruteForceSettings& settings);

}  // namespace plumbline::truth
