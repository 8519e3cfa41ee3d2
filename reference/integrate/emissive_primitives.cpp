#include "reference/integrate/emissive_primitives.hpp"

#include <limits>

#include "reference/light/shape_sampling.hpp"
#include "reference/trace/analytic.hpp"

namespace plumbline::integrate {
namespace {

// A shadow ray ends at its length in float along its direction in float: 6e-8 of the length off each, more than
// the surface's own clearance when the receiver is far. The end is lifted by four units of it.
void clear_ray_rounding(trace::SurfacePoint& point, double distance) {
  constexpr double kRelativeError = 4.0 * static_cast<double>(std::numeric_limits<float>::epsilon());
  point.clearance += static_cast<float>(kRelativeError * distance);
}

/// The sphere with this surface number; null for a disc.
const scene::Sphere* sphere_of(const scene::Scene& scene, std::uint32_t surface) {
  const std::size_t primitive = surface - scene.triangles.size();
  return primitive < scene.spheres.size() ? &scene.spheres[primitive] : nullptr;
}

const scene::Disc& disc_of(const scene::Scene& scene, std::uint32_t surface) {
  return scene.discs[surface - scene.triangles.size() - scene.spheres.size()];
}

double area_of(const scene::Scene& scene, std::uint32_t surface) {
  const scene::Sphere* sphere = sphere_of(scene, surface);
  return sphere != nullptr ? scene::area(*sphere) : scene::area(disc_of(scene, surface));
}

bool is_drawn_by_cone(const scene::Sphere& sphere, const scene::Material& material) {
  return scene::is_complete(sphere) && !sphere.is_inward && !material.is_double_sided;
}

trace::SurfacePoint drawn_by_area(const scene::Scene& scene, std::uint32_t surface, const Vec2& u) {
  if (const scene::Sphere* sphere = sphere_of(scene, surface)) {
    const Vec3d axis = glm::normalize(Vec3d(sphere->keep_axis));
    const Vec3d n = light::sample_cap(axis, static_cast<double>(sphere->keep_min_cosine), u);
    return trace::point_on(*sphere, trace::sphere_coordinates(n));
  }
  return trace::point_on(disc_of(scene, surface), Vec2(light::sample_unit_disc(u)));
}

std::optional<EmitterSample> sample_by_cone(const scene::Sphere& sphere, const Vec3& receiver, const Vec2& u,
                                            const Rgb& radiance) {
  const Vec3d centre(sphere.centre);
  const std::optional<light::ShapeSample> sample =
      light::sample_sphere(centre, static_cast<double>(sphere.radius), Vec3d(receiver), u);
  if (!sample) return std::nullopt;
  const Vec3d n = glm::normalize(Vec3d(receiver) + sample->distance * sample->direction - centre);
  trace::SurfacePoint point = trace::point_on(sphere, trace::sphere_coordinates(n));
  clear_ray_rounding(point, sample->distance);
  return EmitterSample{Vec3(sample->direction), point, sample->pdf, radiance};
}

}  // namespace

std::optional<EmitterSample> sample_primitive(const scene::Scene& scene, std::uint32_t surface,
                                              const Vec3& receiver, const Vec2& u) {
  const scene::Material& material = scene::material_of(scene, surface);
  const scene::Sphere* sphere = sphere_of(scene, surface);
  if (sphere != nullptr && is_drawn_by_cone(*sphere, material)) {
    return sample_by_cone(*sphere, receiver, u, material.emission);
  }
  trace::SurfacePoint point = drawn_by_area(scene, surface, u);
  const Vec3d offset = Vec3d(point.position) - Vec3d(receiver);
  const double distance = glm::length(offset);
  if (!(distance > 0.0)) return std::nullopt;
  const Vec3d direction = offset / distance;
  const double cosine = -glm::dot(Vec3d(point.geometric_normal), direction);
  if (!(cosine > 0.0) && !(material.is_double_sided && cosine < 0.0)) return std::nullopt;
  if (cosine < 0.0) {
    point.geometric_normal = -point.geometric_normal;
    point.shading_normal = -point.shading_normal;
  }
  clear_ray_rounding(point, distance);
  const double pdf = light::solid_angle_pdf(1.0 / area_of(scene, surface), distance, cosine);
  return EmitterSample{Vec3(direction), point, pdf, material.emission};
}

double primitive_pdf(const scene::Scene& scene, std::uint32_t surface, const trace::SurfacePoint& point,
                     float distance, const Vec3& direction) {
  const double length = distance;
  const scene::Sphere* sphere = sphere_of(scene, surface);
  if (sphere != nullptr && is_drawn_by_cone(*sphere, scene::material_of(scene, surface))) {
    const Vec3d receiver = Vec3d(point.position) - length * Vec3d(direction);
    return light::sphere_pdf(static_cast<double>(sphere->radius),
                             glm::length(receiver - Vec3d(sphere->centre)));
  }
  const double cosine = -glm::dot(Vec3d(point.geometric_normal), Vec3d(direction));
  return light::solid_angle_pdf(1.0 / area_of(scene, surface), length, cosine);
}

LightBounds primitive_bounds(const scene::Scene& scene, std::uint32_t surface) {
  const scene::Material& material = scene::material_of(scene, surface);
  const double brightness = max_component(material.emission);
  if (const scene::Sphere* sphere = sphere_of(scene, surface)) {
    const scene::Extent box = scene::extent(*sphere);
    const Vec3d any_axis(0.0, 1.0, 0.0);
    return {box.low, box.high, any_axis, -1.0, false, 0.25 * scene::area(*sphere) * brightness};
  }
  const scene::Disc& disc = disc_of(scene, surface);
  const scene::Extent box = scene::extent(disc);
  return {box.low,
          box.high,
          glm::normalize(Vec3d(disc.normal)),
          1.0,
          material.is_double_sided,
          scene::area(disc) * brightness};
}

}  // namespace plumbline::integrate
