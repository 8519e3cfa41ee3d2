#include "reference/integrate/meeting.hpp"

namespace plumbline::integrate {

std::optional<Meeting> meet(const World& world, const trace::Ray& ray) {
  const std::optional<trace::Hit> hit = world.caster.closest_hit(ray);
  if (!hit) return std::nullopt;
  const trace::SurfaceHit seen = world.surfaces.hit(*hit, ray.direction);
  Meeting meeting{seen.point, Rgb(0.0F), Rgb(0.0F), hit->triangle, hit->distance};
  const trace::SurfaceTable::Surface& surface = world.surfaces.surface(hit->triangle);
  if (seen.is_front || surface.is_double_sided) {
    meeting.albedo = world.surfaces.albedo(*hit);
    meeting.emission = surface.emission;
  }
  return meeting;
}

bool is_visible(const World& world, const trace::SurfacePoint& point, const Vec3& direction, float distance) {
  return !world.caster.is_occluded({trace::ray_origin(point, direction), direction, distance});
}

bool is_mutually_visible(const World& world, const trace::SurfacePoint& a, const trace::SurfacePoint& b) {
  const Vec3 between = b.position - a.position;
  const Vec3 origin = trace::ray_origin(a, between);
  const Vec3 segment = trace::ray_origin(b, -between) - origin;
  const float length = glm::length(segment);
  return !world.caster.is_occluded({origin, segment / length, length});
}

double emitter_pdf(const World& world, const Receiver& receiver, const Meeting& meeting,
                   const Vec3& direction) {
  return world.emitters.pdf(receiver, meeting.triangle, meeting.point, meeting.distance, direction);
}

}  // namespace plumbline::integrate
