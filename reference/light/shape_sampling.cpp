#include "reference/light/shape_sampling.hpp"

#include <algorithm>
#include <cmath>

namespace plumbline::light {
namespace {

struct Axes {
  Vec3d u;
  Vec3d v;
};

// Duff et al., "Building an orthonormal basis, revisited", JCGT 6(1), 2017.
Axes axes_about(const Vec3d& n) {
  const double sign = std::copysign(1.0, n.z);
  const double a = -1.0 / (sign + n.z);
  const double b = n.x * n.y * a;
  return {Vec3d(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), Vec3d(b, sign + n.y * n.y * a, -n.y)};
}

/// The direction with the given 1 - cos to the axis. Not by cos itself: of a cone of half-angle a it keeps no
/// digits below a = 1e-8, 1 - cos keeps them all.
Vec3d at_angle(const Vec3d& axis, double one_minus_cos, double azimuth) {
  const double sine = std::sqrt(std::max(0.0, one_minus_cos * (2.0 - one_minus_cos)));
  const Axes axes = axes_about(axis);
  return glm::normalize((1.0 - one_minus_cos) * axis + sine * std::cos(azimuth) * axes.u +
                        sine * std::sin(azimuth) * axes.v);
}

// 1 - cos alpha with sin alpha = s: 1 - sqrt(1 - s^2) = s^2/(1 + sqrt(1 - s^2)), where 1 - s^2 = (1 - s)(1 + s) keeps
// its digits for a receiver that touches the sphere.
double cone_one_minus_cos(double radius, double distance) {
  const double sine = radius / distance;
  const double cosine = std::sqrt(std::max(0.0, (distance - radius) / distance * (1.0 + sine)));
  return sine * sine / (1.0 + cosine);
}

}  // namespace

double sphere_pdf(double radius, double distance_to_centre) {
  if (!(distance_to_centre > radius)) return 0.0;
  return 1.0 / (2.0 * kPi * cone_one_minus_cos(radius, distance_to_centre));
}

std::optional<ShapeSample> sample_sphere(const Vec3d& centre, double radius, const Vec3d& receiver,
                                         const Vec2& u) {
  const Vec3d to_centre = centre - receiver;
  const double distance = glm::length(to_centre);
  if (!(distance > radius)) return std::nullopt;
  const double limit = cone_one_minus_cos(radius, distance);
  const double height = static_cast<double>(u.x) * limit;
  const Vec3d direction = at_angle(to_centre / distance, height, 2.0 * kPi * static_cast<double>(u.y));
  // The nearer of the two crossings: d cos - sqrt(R^2 - d^2 sin^2). At the rim rounding may leave the root below 0.
  const double sine_squared = height * (2.0 - height);
  const double half_chord = std::sqrt(std::max(0.0, radius * radius - distance * distance * sine_squared));
  return ShapeSample{direction, distance * (1.0 - height) - half_chord, 1.0 / (2.0 * kPi * limit)};
}

// sin of the angle to the axis from the cross product, which keeps its digits for a far sphere.
double sphere_pdf(const Vec3d& centre, double radius, const Vec3d& receiver, const Vec3d& direction) {
  const Vec3d to_centre = centre - receiver;
  if (!(glm::dot(to_centre, direction) > 0.0)) return 0.0;
  if (!(glm::length(glm::cross(to_centre, direction)) <= radius)) return 0.0;
  return sphere_pdf(radius, glm::length(to_centre));
}

Vec3d sample_cap(const Vec3d& axis, double min_cosine, const Vec2& u) {
  return at_angle(axis, static_cast<double>(u.x) * (1.0 - min_cosine), 2.0 * kPi * static_cast<double>(u.y));
}

glm::dvec2 sample_unit_disc(const Vec2& u) {
  const glm::dvec2 p = 2.0 * glm::dvec2(u) - 1.0;
  if (p.x == 0.0 && p.y == 0.0) return glm::dvec2(0.0);
  const bool is_wide = std::abs(p.x) > std::abs(p.y);
  const double radius = is_wide ? p.x : p.y;
  const double angle = is_wide ? kPi / 4.0 * (p.y / p.x) : kPi / 2.0 - kPi / 4.0 * (p.x / p.y);
  return radius * glm::dvec2(std::cos(angle), std::sin(angle));
}

Vec3d sample_disc(const Vec3d& normal, double radius, const Vec2& u) {
  const glm::dvec2 p = radius * sample_unit_disc(u);
  const Axes axes = axes_about(normal);
  return p.x * axes.u + p.y * axes.v;
}

double solid_angle_pdf(double area_pdf, double distance, double cos_surface) {
  const double cosine = std::abs(cos_surface);
  return cosine > 0.0 ? area_pdf * distance * distance / cosine : 0.0;
}

std::optional<ShapeSample> sample_disc_from(const Vec3d& centre, const Vec3d& normal, double radius,
                                            const Vec3d& receiver, const Vec2& u) {
  const Vec3d offset = centre + sample_disc(normal, radius, u) - receiver;
  const double distance = glm::length(offset);
  // Not dot(normal, offset): the plane's distance is that of its centre, and keeps its digits for a flat view.
  const double height = glm::dot(normal, centre - receiver);
  if (!(std::abs(height) > 0.0)) return std::nullopt;
  const double pdf = solid_angle_pdf(1.0 / (kPi * radius * radius), distance, height / distance);
  return ShapeSample{offset / distance, distance, pdf};
}

double disc_pdf(const Vec3d& centre, const Vec3d& normal, double radius, const Vec3d& receiver,
                const Vec3d& direction) {
  const double cosine = glm::dot(normal, direction);
  const double distance = glm::dot(normal, centre - receiver) / cosine;
  if (!(distance > 0.0)) return 0.0;  // behind, or not a number: in the plane
  const Vec3d from_centre = receiver + distance * direction - centre;
  if (!(glm::dot(from_centre, from_centre) <= radius * radius)) return 0.0;
  return solid_angle_pdf(1.0 / (kPi * radius * radius), distance, cosine);
}

}  // namespace plumbline::light
