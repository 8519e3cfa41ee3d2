#include "reference/trace/analytic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumbline::trace {
namespace {

// How far the float position may lie from the surface: half a unit in the last place of each coordinate, 0.5 *
// sqrt(3) epsilon of the largest. The start of a ray is that position moved along the normal and rounded again:
// as much once more. Eight epsilon leave a factor of four, and scale with the coordinates alone.
constexpr float kRelativeError = 8.0F * std::numeric_limits<float>::epsilon();

float clearance(const Vec3& centre, float radius) {
  return kRelativeError * (max_magnitude(centre) + radius) + std::numeric_limits<float>::min();
}

double sign_of(double x) {
  return std::copysign(1.0, x);
}

// Octahedral map (Meyer et al., "On floating-point normal vectors", 2010): the unit sphere folded onto the square
// [-1, 1]^2. Two floats place the point to 1e-7 of the radius, and what is decoded is normalised in double, so
// the point stays exactly on the sphere.
Vec3d decoded(Vec2 coordinates) {
  const Vec3d folded(coordinates.x, coordinates.y, 0.0);
  Vec3d n(folded.x, folded.y, 1.0 - std::abs(folded.x) - std::abs(folded.y));
  if (n.z < 0.0) {
    n.x = (1.0 - std::abs(folded.y)) * sign_of(folded.x);
    n.y = (1.0 - std::abs(folded.x)) * sign_of(folded.y);
  }
  return glm::normalize(n);
}

bool is_kept(const scene::Sphere& sphere, const Vec3d& from_centre) {
  if (scene::is_complete(sphere)) return true;
  const Vec3d axis(sphere.keep_axis);
  return glm::dot(from_centre, axis) >=
         static_cast<double>(sphere.keep_min_cosine) * glm::length(from_centre) * glm::length(axis);
}

struct DiscFrame {
  Vec3d normal;
  Vec3d u;
  Vec3d v;
};

// Any two axes do; those of Duff et al., "Building an orthonormal basis, revisited", JCGT 6(1), 2017.
DiscFrame frame_of(const scene::Disc& disc) {
  const Vec3d n = glm::normalize(Vec3d(disc.normal));
  const double sign = sign_of(n.z);
  const double a = -1.0 / (sign + n.z);
  const double b = n.x * n.y * a;
  return {n, Vec3d(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), Vec3d(b, sign + n.y * n.y * a, -n.y)};
}

}  // namespace

Vec2 sphere_coordinates(const Vec3d& n) {
  const Vec3d p = n / (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
  if (p.z >= 0.0) return Vec2(glm::dvec2(p.x, p.y));
  return Vec2(glm::dvec2((1.0 - std::abs(p.y)) * sign_of(p.x), (1.0 - std::abs(p.x)) * sign_of(p.y)));
}

// |f + t d|^2 = R^2 with f = origin - centre. The discriminant by the distance of the line from the centre and not
// by b^2 - ac, which loses every digit for small, far spheres (Haines, Gunther & Akenine-Moller, "Precision
// improvements for ray/sphere intersection", Ray Tracing Gems, 2019): with h = -f.d / d.d the nearest point is f + h
// d, and the roots are h -+ sqrt((R^2 - |f + h d|^2) / d.d). The root nearer to the origin is taken from the product
// of both, c / d.d with c = (|f| - R)(|f| + R), so that it keeps its digits and its sign is that of c: on which side
// the ray starts decides what it can meet, not the rounding.
std::optional<Crossing> crossing(const scene::Sphere& sphere, const Vec3d& origin, const Vec3d& direction,
                                 double max_distance) {
  const double radius = sphere.radius;
  const Vec3d f = origin - Vec3d(sphere.centre);
  const double squared = glm::dot(direction, direction);
  const double middle = -glm::dot(f, direction) / squared;
  const double from_centre = glm::length(f);
  const double c = (from_centre - radius) * (from_centre + radius) / squared;
  if (c >= 0.0 && !(middle > 0.0)) return std::nullopt;
  const Vec3d nearest = f + middle * direction;
  const double half_chord_squared = (radius * radius - glm::dot(nearest, nearest)) / squared;
  if (c >= 0.0 && !(half_chord_squared >= 0.0)) return std::nullopt;
  const double far_root = middle + sign_of(middle) * std::sqrt(std::max(0.0, half_chord_squared));
  const double near_root = far_root == 0.0 ? 0.0 : c / far_root;
  for (const double t : {std::min(near_root, far_root), std::max(near_root, far_root)}) {
    if (!(t > 0.0 && t <= max_distance)) continue;
    const Vec3d met = f + t * direction;
    if (is_kept(sphere, met)) return Crossing{t, sphere_coordinates(glm::normalize(met))};
  }
  return std::nullopt;
}

std::optional<Crossing> crossing(const scene::Disc& disc, const Vec3d& origin, const Vec3d& direction,
                                 double max_distance) {
  const DiscFrame frame = frame_of(disc);
  const double radius = disc.radius;
  const Vec3d f = origin - Vec3d(disc.centre);
  const double t = -glm::dot(frame.normal, f) / glm::dot(frame.normal, direction);
  if (!(t > 0.0 && t <= max_distance)) return std::nullopt;  // also in the plane: infinite or not a number
  const Vec3d met = f + t * direction;
  const glm::dvec2 on_disc(glm::dot(met, frame.u), glm::dot(met, frame.v));
  if (!(glm::dot(on_disc, on_disc) <= radius * radius)) return std::nullopt;
  return Crossing{t, Vec2(on_disc / radius)};
}

SurfacePoint point_on(const scene::Sphere& sphere, Vec2 coordinates) {
  const Vec3d n = decoded(coordinates);
  const Vec3 front(sphere.is_inward ? -n : n);
  return {Vec3(Vec3d(sphere.centre) + static_cast<double>(sphere.radius) * n), front, front,
          clearance(sphere.centre, sphere.radius)};
}

SurfacePoint point_on(const scene::Disc& disc, Vec2 coordinates) {
  const DiscFrame frame = frame_of(disc);
  const glm::dvec2 at = static_cast<double>(disc.radius) * glm::dvec2(coordinates);
  const Vec3 front(frame.normal);
  return {Vec3(Vec3d(disc.centre) + at.x * frame.u + at.y * frame.v), front, front,
          clearance(disc.centre, disc.radius)};
}

SurfacePoint point_on_primitive(const scene::Scene& scene, std::uint32_t surface, Vec2 coordinates) {
  const std::size_t primitive = surface - scene.triangles.size();
  if (primitive < scene.spheres.size()) return point_on(scene.spheres[primitive], coordinates);
  return point_on(scene.discs[primitive - scene.spheres.size()], coordinates);
}

}  // namespace plumbline::trace
