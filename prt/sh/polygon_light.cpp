// Polygons as lights: polygon_light() and emissive_polygon() of analytic_lights.hpp.
#include <array>
#include <cmath>
#include <string>

#include "prt/sh/analytic_lights.hpp"
#include "prt/sh/direction.hpp"
#include "prt/sh/rotator.hpp"
#include "reference/base/error.hpp"

namespace plumbline::sh {
namespace {

/// An edge of the spherical polygon: part of a great circle.
struct Arc {
  RotationMatrix frame;  // x the first vertex, y ahead, z to the left of it (seen from outside the sphere)
  double angle = 0.0;    // length [rad], in (0, pi)
};

std::vector<Vec3d> unit_directions(std::span<const Vec3d> vertices) {
  if (vertices.size() < 3) {
    throw InputError("polygon_light: expected at least 3 vertices, got " + std::to_string(vertices.size()));
  }
  std::vector<Vec3d> result;
  for (const Vec3d& v : vertices) {
    result.push_back(unit_direction(v, "polygon_light: vertex " + std::to_string(result.size())));
  }
  return result;
}

/// Arcs of some length; repeated vertices make none.
std::vector<Arc> arcs_of(const std::vector<Vec3d>& directions) {
  std::vector<Arc> arcs;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const Vec3d& first = directions[i];
    const Vec3d& second = directions[(i + 1) % directions.size()];
    const Vec3d normal = glm::cross(first, second);
    const double sine = glm::length(normal);
    const double cosine = glm::dot(first, second);
    if (sine < 1e-15) {
      if (cosine > 0.0) continue;
      throw InputError("polygon_light: the edge from vertex " + std::to_string(i) +
                       " passes through the origin");
    }
    const Vec3d x = first;
    const Vec3d z = glm::normalize(normal - glm::dot(normal, x) * x);
    arcs.push_back({RotationMatrix(glm::dmat3(x, glm::cross(z, x), z)), std::atan2(sine, cosine)});
  }
  return arcs;
}

// van Oosterom & Strackee 1983, per triangle of the fan; the fan of a flat polygon lies in a half space, so that the
// signed angles add up without ever passing 2 pi.
double signed_solid_angle(const std::vector<Vec3d>& d) {
  double sum = 0.0;
  for (std::size_t i = 1; i + 1 < d.size(); ++i) {
    const double volume = glm::dot(d[0], glm::cross(d[i], d[i + 1]));
    const double scale = 1.0 + glm::dot(d[0], d[i]) + glm::dot(d[i], d[i + 1]) + glm::dot(d[i + 1], d[0]);
    sum += 2.0 * std::atan2(volume, scale);
  }
  return sum;
}

/// d y_lm / dz times l(l + 1)^-1 at the point +x of the equator, at index(l, m), m >= 0; zero for even l + m.
std::vector<double> equator_slopes(int bands) {
  const std::vector<double> y = evaluate_basis(bands, Vec3d(1.0, 0.0, 0.0));
  std::vector<double> slopes(y.size(), 0.0);
  for (int l = 1; l < bands; ++l) {
    for (int m = l - 1; m >= 0; m -= 2) {
      const double factor = std::sqrt((2.0 * l + 1.0) / (2.0 * l - 1.0) * (l - m) * (l + m));
      slopes[static_cast<std::size_t>(index(l, m))] =
          factor * y[static_cast<std::size_t>(index(l - 1, m))] / (l * (l + 1.0));
    }
  }
  return slopes;
}

/// The arc's part of the integrals, in its own frame.
std::vector<double> arc_integral(int bands, double angle, const std::vector<double>& slopes) {
  std::vector<double> result(slopes.size(), 0.0);
  for (int m = 0; m < bands; ++m) {
    const double half = std::sin(0.5 * m * angle);
    const double cosines = m > 0 ? std::sin(m * angle) / m : angle;  // integral of cos m phi over the arc
    const double sines = m > 0 ? 2.0 * half * half / m : 0.0;
    for (int l = m + 1; l < bands; l += 2) {
      const double slope = slopes[static_cast<std::size_t>(index(l, m))];
      result[static_cast<std::size_t>(index(l, m))] = slope * cosines;
      if (m > 0) result[static_cast<std::size_t>(index(l, -m))] = slope * sines;
    }
  }
  return result;
}

}  // namespace

// On the sphere the Laplacian of y_lm is -l(l + 1) y_lm, so by Green's formula, with n pointing into the region,
//
//   integral of y_lm over the region = 1/(l(l + 1)) * integral along the boundary of (n . grad y_lm) ds,  l >= 1.
//
// An edge is an arc of a great circle, n its constant normal. In the frame where the arc runs along the equator from +x
// towards +y, n = +z, and n . grad is d/dz of y_lm = q_l^m(z) (cos or sin) m phi there:
//
//   q_l^m'(0) = sqrt((2l + 1)/(2l - 1) (l^2 - m^2)) q_(l-1)^m(0),
//
// from (1 - z^2) P_l^m' = (l + m) P_(l-1)^m - l z P_l^m. What is left is the integral of cos m phi or sin m phi over
// 0 … angle. The result is turned from the edge's frame to the world. y_00 gets the solid angle.
std::vector<double> polygon_light(int bands, std::span<const Vec3d> vertices) {
  require_bands(bands);
  const std::vector<Vec3d> directions = unit_directions(vertices);
  const std::vector<double> slopes = equator_slopes(bands);
  std::vector<double> result(slopes.size(), 0.0);
  std::vector<double> turned(slopes.size());
  const Rotator<double> rotator(bands);
  for (const Arc& arc : arcs_of(directions)) {
    rotator.apply(arc.frame, arc_integral(bands, arc.angle, slopes), turned);
    for (std::size_t i = 1; i < result.size(); ++i) result[i] += turned[i];
  }
  result[0] = signed_solid_angle(directions) / std::sqrt(4.0 * kPi);
  return result;
}

ShRgb emissive_polygon(int bands, const Vec3d& receiver, std::span<const Vec3d> vertices,
                       const RgbD& radiance, EmittingSides sides) {
  std::vector<Vec3d> relative;
  for (const Vec3d& v : vertices) relative.push_back(v - receiver);
  std::vector<double> coefficients = polygon_light(bands, relative);
  // Counterclockwise from the front is clockwise on the sphere around a receiver in front, seen from its outside.
  const bool is_front = coefficients[0] < 0.0;
  const double sign = is_front ? -1.0 : sides == EmittingSides::both ? 1.0 : 0.0;
  for (double& c : coefficients) c *= sign;
  return lit(coefficients, radiance);
}

}  // namespace plumbline::sh
