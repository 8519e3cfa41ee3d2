// reference/light/shape_sampling.hpp: directions towards spheres and discs, and the densities they have.
// Pure geometry in double: what shines, what hides it and which side is dark is for the caller to know.
#pragma once

#include <optional>

#include "reference/base/vector.hpp"

namespace plumbline::light {

/// A point of a shape as seen from a receiver.
struct ShapeSample {
  Vec3d direction{0.0};  // unit, from the receiver
  double distance = 0.0;
  double pdf = 0.0;  // per solid angle at the receiver [sr^-1], > 0
};

/// Uniform in solid angle over the cone under which a sphere is seen, sin(alpha) = radius/distance: density
/// 1/(2 pi (1 - cos alpha)), the same for all directions, and every one of them meets the sphere (in front).
/// Exact for any distance: 1 - cos alpha keeps its digits for the smallest cone, and a receiver next to the
/// surface sees half the sphere of directions. None for a receiver on the surface or inside: there every
/// direction meets the sphere, and sampling its area (sample_sphere_area) or the receiver's own cosine serves.
/// u in [0, 1)^2. (Shirley, Wang & Zimmerman, "Monte Carlo techniques for direct lighting calculations", ACM TOG
/// 15(1), 1996.)
[[nodiscard]] std::optional<ShapeSample> sample_sphere(const Vec3d& centre, double radius,
                                                       const Vec3d& receiver, const Vec2& u);
/// Its density for a direction (unit); 0 when the direction misses the sphere or the receiver is not outside.
[[nodiscard]] double sphere_pdf(const Vec3d& centre, double radius, const Vec3d& receiver,
                                const Vec3d& direction);
/// The same for a direction that is known to meet the sphere, by the distance of its centre alone.
[[nodiscard]] double sphere_pdf(double radius, double distance_to_centre);

/// Unit direction from the centre to a point drawn uniformly by area on the part n.axis >= min_cosine of a
/// sphere; axis unit, min_cosine in [-1, 1), u in [0, 1)^2. Density 1/(2 pi R^2 (1 - min_cosine)) per area.
[[nodiscard]] Vec3d sample_cap(const Vec3d& axis, double min_cosine, const Vec2& u);

/// A point of the unit disc drawn uniformly by area, by the concentric map, which keeps strata together (Shirley &
/// Chiu, "A low distortion map between disk and square", 1997).
[[nodiscard]] glm::dvec2 sample_unit_disc(const Vec2& u);

/// A point of a disc drawn uniformly by area: its offset from the centre; normal unit, u in [0, 1)^2. Density
/// 1/(pi R^2) per area.
[[nodiscard]] Vec3d sample_disc(const Vec3d& normal, double radius, const Vec2& u);

/// Density per area into density per solid angle: p d^2/|cos|, where cos is between the surface's normal and the
/// direction to the receiver; 0 where it is seen edge-on.
[[nodiscard]] double solid_angle_pdf(double area_pdf, double distance, double cos_surface);

/// sample_disc seen from a receiver, with its density per solid angle; none when the receiver lies in the disc's
/// plane.
[[nodiscard]] std::optional<ShapeSample> sample_disc_from(const Vec3d& centre, const Vec3d& normal,
                                                          double radius, const Vec3d& receiver,
                                                          const Vec2& u);
/// Its density for a direction (unit); 0 when the direction misses the disc.
[[nodiscard]] double disc_pdf(const Vec3d& centre, const Vec3d& normal, double radius, const Vec3d& receiver,
                              const Vec3d& direction);

}  // namespace plumbline::light
