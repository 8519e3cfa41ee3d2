// validation/checks/truths_scenes.hpp: the few shapes and lights that closed forms are about. Lengths in any unit, +Y up.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "reference/light/environment.hpp"
#include "reference/scene/scene.hpp"

namespace plumbline::checks {

/// A grey surface; returns its index.
std::uint32_t add_grey(scene::Scene& scene, double albedo, double emission = 0.0,
                       bool is_double_sided = false);

/// Flat, counter-clockwise as seen from the front.
void add_triangle(scene::Scene& scene, const Vec3d& a, const Vec3d& b, const Vec3d& c,
                  std::uint32_t material);
/// Corner, corner + u, corner + u + v, corner + v; front along u x v.
void add_quad(scene::Scene& scene, const Vec3d& corner, const Vec3d& u, const Vec3d& v,
              std::uint32_t material);

/// Part of a sphere that is left when a cap is cut off: where outward normal . axis >= min_cosine.
struct Kept {
  Vec3d axis{0.0, 1.0, 0.0};
  double min_cosine = -1.0;
};
enum class Front { outward, inward };
void add_sphere(scene::Scene& scene, const Vec3d& centre, double radius, Front front, std::uint32_t material,
                const Kept& kept = {});
void add_disc(scene::Scene& scene, const Vec3d& centre, const Vec3d& normal, double radius,
              std::uint32_t material);
/// Cube [0, size]^3 seen from inside.
void add_room(scene::Scene& scene, double size, std::uint32_t material);

/// What stands for an infinite plane, and where points look at it from. Seen from kNear the plane ends at an angle of
/// kNear/kFar = 1e-6: a form factor is off by at most 0.568 of that, a tenth of no margin in use.
inline constexpr double kFar = 1000.0;
inline constexpr double kNear = 1e-3;
inline constexpr double kEndOfPlane = 2e-6;  // relative, allowance for all the planes of a scene
/// y = 0, seen from above.
void add_ground(scene::Scene& scene, double albedo);
/// Floor along +x from the z axis, and a face turned up from it by `opening` [rad]; both seen from inside. In cells
/// that grow with their distance: floats resolve the neighbourhood of the edge only in triangles of small coordinates.
[[nodiscard]] scene::Scene dihedral(double opening, double floor_albedo, double wall_albedo);

/// A speck far below, so that there is something to trace against.
[[nodiscard]] scene::Scene nothing_in_the_way();

[[nodiscard]] light::Environment constant_sky(double radiance);
[[nodiscard]] light::Environment analytic_sky(std::function<double(const Vec3d& direction)> radiance);
[[nodiscard]] light::Environment lat_long_sky(const std::vector<double>& texels, int width, int height,
                                              light::Lookup lookup);
[[nodiscard]] light::SunDisc sun(const Vec3d& direction, double half_angle, double radiance);

/// (sin a, cos a, 0).
[[nodiscard]] Vec3d tilted(double angle);
/// Uniform on the unit sphere.
[[nodiscard]] Vec3d uniform_direction(double u, double v);

}  // namespace plumbline::checks
