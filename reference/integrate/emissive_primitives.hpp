// reference/integrate/emissive_primitives.hpp: light drawn from one exact sphere or disc, and the density of that.
#pragma once

#include <cstdint>
#include <optional>

#include "reference/integrate/emitter_sample.hpp"
#include "reference/integrate/light_tree.hpp"
#include "reference/scene/scene.hpp"
#include "reference/trace/surface_point.hpp"

namespace plumbline::integrate {

/// A point of the surface with this number (scene.hpp), which is no triangle, seen from `receiver`; pdf as if no
/// other light could have been chosen. A complete sphere that shines outward alone is drawn uniformly in its cone;
/// everything else (cavities, cut and double-sided spheres, discs) uniformly by area: which of the two it is
/// depends on the surface only, never on where a rounded receiver seems to be. None when the point shows its dark
/// side or is seen edge-on, and from inside a sphere that shines outward. u in [0, 1)^2.
[[nodiscard]] std::optional<EmitterSample> sample_primitive(const scene::Scene& scene, std::uint32_t surface,
                                                            const Vec3& receiver, const Vec2& u);

/// The density of that for what was met: `point`, turned to the receiver, `distance` away along `direction`
/// (unit, from the receiver).
[[nodiscard]] double primitive_pdf(const scene::Scene& scene, std::uint32_t surface,
                                   const trace::SurfacePoint& point, float distance, const Vec3& direction);

/// What a light tree knows of it; strength 0 where it does not emit. Of spheres the strength is that of their mean shadow,
/// a quarter of the area.
[[nodiscard]] LightBounds primitive_bounds(const scene::Scene& scene, std::uint32_t surface);

}  // namespace plumbline::integrate
