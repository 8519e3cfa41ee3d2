#include "reference/integrate/emissive_triangle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "reference/light/spherical_triangle.hpp"

namespace plumbline::integrate {
namespace {

/// In radii of the triangle: from further away the squared distance varies by less than (4/2)^2 over it.
constexpr double kNear = 3.0;
/// A solid angle below this [sr] loses digits that its sampling needs: at 1e-6 ten are left.
constexpr double kSmallestSolidAngle = 1e-6;
/// Of the largest coordinate. Points of surfaces carry 8 float epsilons (surface_point.cpp), both sides their own.
constexpr double kResolved = 32.0 * static_cast<double>(std::numeric_limits<float>::epsilon());

/// A triangle to be drawn by solid angle, as a receiver sees it.
struct NearView {
  Vec3d a{0.0}, b{0.0}, c{0.0};  // corners relative to the receiver
  light::SphericalTriangle seen;
  bool is_front = false;
};

/// None where it is drawn by area.
std::optional<NearView> near_view(const EmissiveTriangle& triangle, const Vec3& receiver) {
  const Vec3d eye(receiver);
  const Vec3d offset = triangle.centre - eye;
  if (!(glm::dot(offset, offset) < triangle.near_squared)) return std::nullopt;
  NearView view{Vec3d(triangle.corners[0]) - eye,
                Vec3d(triangle.corners[1]) - eye,
                Vec3d(triangle.corners[2]) - eye,
                {},
                false};
  // a.(b x c) = a.N, where N = (b - a) x (c - a) has the length 2 area: the height over the plane, times that.
  const double volume = glm::dot(view.a, glm::cross(view.b - view.a, view.c - view.a));
  if (!(std::abs(volume) > 2.0 * triangle.area * triangle.resolved_height)) return std::nullopt;
  view.is_front = volume < 0.0;
  view.seen = light::spherical_triangle(view.a, view.b, view.c);
  if (!(view.seen.solid_angle > kSmallestSolidAngle)) return std::nullopt;
  return view;
}

/// Barycentric weights of the point in which a ray from the eye meets the plane: ratios of the volumes that the
/// direction spans with two corners each. What rounding puts outside is brought back to the edge.
std::optional<Vec3> weights_along(const NearView& view, const Vec3d& direction) {
  const double sign = view.is_front ? -1.0 : 1.0;
  const Vec3d volumes = sign * Vec3d(glm::dot(direction, glm::cross(view.b, view.c)),
                                     glm::dot(direction, glm::cross(view.c, view.a)),
                                     glm::dot(direction, glm::cross(view.a, view.b)));
  const Vec3d inside = glm::max(volumes, Vec3d(0.0));
  const double sum = inside.x + inside.y + inside.z;
  if (!(sum > 0.0)) return std::nullopt;
  return Vec3(inside / sum);
}

void turn_around(trace::SurfacePoint& point) {
  point.geometric_normal = -point.geometric_normal;
  point.shading_normal = -point.shading_normal;
}

std::optional<EmitterSample> sample_by_solid_angle(const EmissiveTriangle& triangle, const NearView& view,
                                                   const Vec2& u) {
  if (!view.is_front && !triangle.is_double_sided) return std::nullopt;
  const Vec3d direction = light::sample_spherical_triangle(view.seen, u);
  const std::optional<Vec3> weights = weights_along(view, direction);
  if (!weights) return std::nullopt;
  trace::SurfacePoint point = trace::point_on_plane(triangle.corners, *weights, triangle.normal);
  if (!view.is_front) turn_around(point);
  return EmitterSample{Vec3(direction), point, 1.0 / view.seen.solid_angle, triangle.radiance};
}

std::optional<EmitterSample> sample_by_area(const EmissiveTriangle& triangle, const Vec3& receiver,
                                            const Vec2& u) {
  // Fold the unit square along its diagonal by the square root (Turk 1990).
  const float root = std::sqrt(u.x);
  const Vec3 weights(1.0F - root, root * (1.0F - u.y), root * u.y);
  trace::SurfacePoint point = trace::point_on_plane(triangle.corners, weights, triangle.normal);
  const Vec3 offset = point.position - receiver;
  const float distance = glm::length(offset);
  if (!(distance > 0.0F)) return std::nullopt;
  const Vec3 direction = offset / distance;
  float cosine = -glm::dot(direction, triangle.normal);
  if (cosine < 0.0F && triangle.is_double_sided) {
    cosine = -cosine;
    turn_around(point);
  }
  if (!(cosine > 0.0F)) return std::nullopt;
  const double squared = static_cast<double>(distance) * static_cast<double>(distance);
  return EmitterSample{direction, point, squared / (triangle.area * static_cast<double>(cosine)),
                       triangle.radiance};
}

}  // namespace

EmissiveTriangle make_emissive_triangle(const scene::Scene& scene, std::uint32_t triangle) {
  const glm::uvec3 c = scene.triangles[triangle];
  const scene::Material& material = scene::material_of(scene, triangle);
  EmissiveTriangle result{{scene.positions[c.x], scene.positions[c.y], scene.positions[c.z]},
                          scene::geometric_normal(scene, triangle),
                          material.emission,
                          material.is_double_sided};
  const Vec3d a(result.corners[0]);
  result.area = 0.5 * glm::length(glm::cross(Vec3d(result.corners[1]) - a, Vec3d(result.corners[2]) - a));
  const LightBounds bounds = light_bounds(result);
  const Vec3d diagonal = bounds.high - bounds.low;
  result.centre = 0.5 * (bounds.low + bounds.high);
  result.near_squared = 0.25 * kNear * kNear * glm::dot(diagonal, diagonal);
  for (const Vec3& corner : result.corners) {
    result.resolved_height =
        std::max(result.resolved_height, kResolved * static_cast<double>(max_magnitude(corner)));
  }
  return result;
}

LightBounds light_bounds(const EmissiveTriangle& triangle) {
  const Vec3d a(triangle.corners[0]);
  const Vec3d b(triangle.corners[1]);
  const Vec3d c(triangle.corners[2]);
  return {glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c)),
          Vec3d(triangle.normal),      1.0,
          triangle.is_double_sided,    triangle.area * static_cast<double>(max_component(triangle.radiance))};
}

std::optional<EmitterSample> sample_triangle(const EmissiveTriangle& triangle, const Vec3& receiver,
                                             const Vec2& u) {
  const std::optional<NearView> view = near_view(triangle, receiver);
  return view ? sample_by_solid_angle(triangle, *view, u) : sample_by_area(triangle, receiver, u);
}

double triangle_pdf(const EmissiveTriangle& triangle, const Vec3& receiver, double distance,
                    double cos_emitter) {
  if (const std::optional<NearView> view = near_view(triangle, receiver)) return 1.0 / view->seen.solid_angle;
  if (!(cos_emitter > 0.0)) return 0.0;
  return distance * distance / (triangle.area * cos_emitter);  // p_w = p_A d^2 / cos
}

}  // namespace plumbline::integrate
