#include "reference/light/spherical_triangle.hpp"

#include <algorithm>
#include <cmath>

namespace plumbline::light {
namespace {

/// Unit, in the plane of `v` and `axis`, at right angles to `axis`; 0 where the two are parallel.
Vec3d perpendicular_part(const Vec3d& v, const Vec3d& axis) {
  const Vec3d part = v - glm::dot(v, axis) * axis;
  const double length = glm::length(part);
  return length > 0.0 ? part / length : Vec3d(0.0);
}

}  // namespace

SphericalTriangle spherical_triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  SphericalTriangle result{glm::normalize(a), glm::normalize(b), glm::normalize(c)};
  const double volume = std::abs(glm::dot(result.a, glm::cross(result.b, result.c)));
  const double sum =
      1.0 + glm::dot(result.a, result.b) + glm::dot(result.b, result.c) + glm::dot(result.c, result.a);
  result.solid_angle = 2.0 * std::atan2(volume, sum);
  return result;
}

// Arvo's two steps: a point C' of the edge AC such that A, B, C' has the share u.x of the solid angle, then a point P of
// the arc from B to C' whose height 1 - P.B is the share u.y of 1 - C'.B (the area of a thin lune grows with the height).
//
// Arvo finds C' from the angle at A, which slivers do not give well. Here it comes from the formula for the solid
// angle itself. With C' = cos(f) A + sin(f) T, T the unit vector at right angles to A towards C, K = |A.(B x T)|:
//   tan(w) = K sin f/[(1 + A.B)(1 + cos f) + (B.T) sin f],  2 w the solid angle of A, B, C'
//          = K t/[(1 + A.B) + (B.T) t],                      t = tan(f/2)
// so  t = x/y,  x = sin(w) (1 + A.B),  y = cos(w) K - sin(w) (B.T),
//   cos f = (y^2 - x^2)/(y^2 + x^2), sin f = 2 x y/(y^2 + x^2): no quotient of small numbers is left.
Vec3d sample_spherical_triangle(const SphericalTriangle& triangle, const Vec2& u) {
  const Vec3d& a = triangle.a;
  const Vec3d& b = triangle.b;
  // 1. C' on the edge from A to C. 1 + A.B = |A + B|^2/2 keeps its digits where A and B are nearly opposite.
  const Vec3d towards_c = perpendicular_part(triangle.c, a);
  const double half = 0.5 * triangle.solid_angle * static_cast<double>(u.x);
  const double k = std::abs(glm::dot(a, glm::cross(b, towards_c)));
  const double x = std::sin(half) * 0.5 * glm::dot(a + b, a + b);
  const double y = std::cos(half) * k - std::sin(half) * glm::dot(b, towards_c);
  const double scale = x * x + y * y;
  const Vec3d on_edge =
      scale > 0.0 ? ((y * y - x * x) * a + 2.0 * x * y * towards_c) / scale : Vec3d(triangle.c);
  // 2. P on the arc from B to C'; 1 - C'.B = |C' - B|^2/2.
  const double height = static_cast<double>(u.y) * 0.5 * glm::dot(on_edge - b, on_edge - b);
  const double sine = std::sqrt(std::max(0.0, height * (2.0 - height)));
  return glm::normalize((1.0 - height) * b + sine * perpendicular_part(on_edge, b));
}

}  // namespace plumbline::light
