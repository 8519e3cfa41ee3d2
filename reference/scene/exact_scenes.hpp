// reference/scene/exact_scenes.hpp: scenes of exact spheres and as good as infinite planes, for which the light
// is known in closed form.
#pragma once

#include "reference/scene/scene.hpp"

namespace plumbline::scene {

/// The inside of a sphere about the origin: radiance emission/(1 - albedo) everywhere.
struct SphereRoom {
  float radius = 1.0F;
  float albedo = 0.8F;
  float emission = 1.0F;  // radiance
};
[[nodiscard]] Scene make_sphere_room(const SphereRoom& room = {});

/// Spherical cavity about the origin, radius 1, front inside, whose opening about +Y has the given half-angle in
/// (0, pi). Under a uniform sky of radiance 1 the irradiance is pi f/(1 - albedo (1 - f)) at every point, with f
/// = (1 - cos a)/2. Half a sphere is a bowl.
[[nodiscard]] Scene make_cavity(double opening_half_angle_rad, float albedo);
[[nodiscard]] Scene make_bowl(float albedo = 0.8F);

/// Two spheres about the origin that face each other. Radiosities B of both: B1 = M1 + rho1 B2, B2 = M2 + rho2 (q
/// B1 + (1 - q) B2), q = (r1/r2)^2; radiance B/pi.
struct ConcentricSpheres {
  float inner_radius = 1.0F;
  float outer_radius = 2.0F;
  float inner_exitance = 1.0F;  // emitted, M [W m^-2]
  float outer_exitance = 0.0F;
  float inner_albedo = 0.5F;
  float outer_albedo = 0.8F;
};
[[nodiscard]] Scene make_concentric_spheres(const ConcentricSpheres& spheres = {});

/// A sphere at `height` above a plane (y = 0) that reaches 1000 to all sides. With a black sphere under a
/// uniform sky of radiance 1 the irradiance of the plane at a distance x from the foot is pi (1 - h R^2/(h^2 +
/// x^2)^(3/2)); as the only light, of radiance L, it gives pi L h R^2/(h^2 + x^2)^(3/2).
struct SphereOverPlane {
  float radius = 1.0F;
  float height = 1.0F;  // of the centre, >= radius
  float sphere_albedo = 0.0F;
  float sphere_emission = 0.0F;  // radiance
  float plane_albedo = 0.5F;
};
[[nodiscard]] Scene make_sphere_over_plane(const SphereOverPlane& shape = {});

}  // namespace plumbline::scene
