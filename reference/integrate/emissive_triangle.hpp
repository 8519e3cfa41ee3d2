// reference/integrate/emissive_triangle.hpp: light drawn from one emissive triangle, and the density of that.
#pragma once

#include <cstdint>
#include <optional>

#include "reference/integrate/emitter_sample.hpp"
#include "reference/integrate/light_tree.hpp"
#include "reference/scene/scene.hpp"

namespace plumbline::integrate {

/// One emissive triangle, ready to be sampled.
struct EmissiveTriangle {
  Vec3 corners[3];
  Vec3 normal{0.0F};  // geometric, unit
  Rgb radiance{0.0F};
  bool is_double_sided = false;
  double area = 0.0;
  Vec3d centre{0.0};             // of the corners' box
  double near_squared = 0.0;     // squared distance from there below which it may be drawn by solid angle
  double resolved_height = 0.0;  // over its plane, above which a receiver is surely on its side
};
[[nodiscard]] EmissiveTriangle make_emissive_triangle(const scene::Scene& scene, std::uint32_t triangle);
[[nodiscard]] LightBounds light_bounds(const EmissiveTriangle& triangle);

/// A point of the triangle as seen from `receiver`; pdf as if no other light could have been chosen. Uniform by solid
/// angle where the triangle is near (within three of its radii), else uniform by area, which then differs little: no
/// density grows with 1/d^2. Also by area what is near but edge-on: below 1e-6 sr, or within rounding of the plane, where
/// even the side is unknown. Receiver and triangle alone decide. None when the point shows its dark back or is seen
/// edge-on. u in [0, 1)^2.
[[nodiscard]] std::optional<EmitterSample> sample_triangle(const EmissiveTriangle& triangle,
                                                           const Vec3& receiver, const Vec2& u);

/// The density of that per solid angle [sr^-1] for a point `distance` away that shows |cos| = cos_emitter.
[[nodiscard]] double triangle_pdf(const EmissiveTriangle& triangle, const Vec3& receiver, double distance,
                                  double cos_emitter);

}  // namespace plumbline::integrate
