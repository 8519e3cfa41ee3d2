#include "validation/truth/irradiance.hpp"

#include <algorithm>
#include <cmath>

#include "validation/truth/require.hpp"

namespace plumbline::truth {
namespace {

constexpr double kRounding = 1e-12;  // slack for angles and heights that are computed, not typed

double squared(double x) {
  return x * x;
}

}  // namespace

double uniform_sky_irradiance(double radiance) {
  return kPi * radiance;
}

// The receiver sees the sky in the part of its hemisphere above the horizon. Its projection on the receiver's
// plane is half a disc plus half an ellipse of semi-axes 1 and cos b (Nusselt): pi/2 + pi cos b/2. The rest
// of the disc is ground of radiance g L.
double tilted_receiver_irradiance(double tilt, double ground_albedo, double radiance) {
  require(tilt >= 0.0 && tilt <= kPi, "tilted_receiver_irradiance", "0 <= tilt <= pi", tilt);
  return kPi * radiance * ((1.0 + std::cos(tilt)) + ground_albedo * (1.0 - std::cos(tilt))) / 2.0;
}

double cap_solid_angle(double half_angle) {
  require(half_angle >= 0.0 && half_angle <= kPi, "cap_solid_angle", "0 <= half_angle <= pi", half_angle);
  return 4.0 * kPi * squared(std::sin(half_angle / 2.0));
}

// The cap's vector irradiance lies along its axis by symmetry and has the length of E for a receiver that
// faces it: 2 pi int_0^a cos sin = pi sin^2 a. While no part is below the horizon, E = vector . n.
double cap_irradiance(double half_angle, double angle, double radiance) {
  require(half_angle >= 0.0 && angle >= 0.0 && half_angle + angle <= kPi / 2.0 + kRounding, "cap_irradiance",
          "half_angle, angle >= 0 and half_angle + angle <= pi/2", half_angle + angle);
  return kPi * radiance * squared(std::sin(half_angle)) * std::cos(angle);
}

double sun_radiance(double half_angle, double irradiance) {
  require(half_angle > 0.0 && half_angle <= kPi / 2.0, "sun_radiance", "0 < half_angle <= pi/2", half_angle);
  return irradiance / (kPi * squared(std::sin(half_angle)));
}

// The 1/3 part is a uniform sky. For 2/3 cos t: with the lune's edge as polar axis (angle alpha) and azimuth
// beta from the horizon, w.z = sin alpha sin beta and w.n = sin alpha sin(beta + b), 0 <= beta <= pi - b, so
//   int (w.z)(w.n) dw = int sin^3 alpha dalpha  int sin beta sin(beta + b) dbeta
//                     = 4/3 . [(pi - b) cos b + sin b]/2.
double overcast_irradiance(double tilt, double zenith_radiance) {
  require(tilt >= 0.0 && tilt <= kPi, "overcast_irradiance", "0 <= tilt <= pi", tilt);
  const double uniform = kPi * (1.0 + std::cos(tilt)) / 2.0;
  const double cosine = 2.0 / 3.0 * ((kPi - tilt) * std::cos(tilt) + std::sin(tilt));
  return zenith_radiance / 3.0 * (uniform + 2.0 * cosine);
}

double linear_environment_irradiance(double a, double b, double n_z) {
  return kPi * a + 2.0 * kPi / 3.0 * b * n_z;
}

// (w.z)^k as a sum of Legendre polynomials, degree l times the clamped cosine's factor A_l = pi, 2 pi/3,
// pi/4, 0, -pi/24 (Funk-Hecke): z^2 = 1/3 + 2/3 P2, z^3 = 3/5 P1 + 2/5 P3, z^4 = 1/5 + 4/7 P2 + 8/35 P4.
double axis_power_irradiance(int power, double n_z) {
  require(power >= 0 && power <= 4, "axis_power_irradiance", "power in 0..4", power);
  const double z2 = n_z * n_z;
  const double p2 = (3.0 * z2 - 1.0) / 2.0;
  const double p4 = (35.0 * z2 * z2 - 30.0 * z2 + 3.0) / 8.0;
  switch (power) {
    case 0:
      return kPi;
    case 1:
      return 2.0 * kPi / 3.0 * n_z;
    case 2:
      return kPi / 4.0 * (1.0 + z2);
    case 3:
      return 2.0 * kPi / 5.0 * n_z;
    default:
      return kPi * (1.0 / 5.0 + p2 / 7.0 - p4 / 105.0);
  }
}

double point_light_irradiance(double radiant_intensity, double height, double lateral) {
  require(height > 0.0, "point_light_irradiance", "height > 0", height);
  return radiant_intensity * height / std::pow(height * height + lateral * lateral, 1.5);
}

// The root is rewritten as sqrt((x^2 + h^2 - r^2)^2 + 4 r^2 h^2): no cancellation near the axis.
double disc_form_factor(double radius, double height, double lateral) {
  require(radius >= 0.0, "disc_form_factor", "radius >= 0", radius);
  require(height > 0.0, "disc_form_factor", "height > 0", height);
  const double excess = lateral * lateral + height * height - radius * radius;
  return (1.0 - excess / std::hypot(excess, 2.0 * radius * height)) / 2.0;
}

double corner_rectangle_form_factor(double a, double b, double height) {
  require(height > 0.0, "corner_rectangle_form_factor", "height > 0", height);
  const double root_a = std::hypot(1.0, a / height);
  const double root_b = std::hypot(1.0, b / height);
  const double first = a / height / root_a * std::atan(b / height / root_a);
  const double second = b / height / root_b * std::atan(a / height / root_b);
  return (first + second) / (2.0 * kPi);
}

double centred_rectangle_form_factor(double a, double b, double height) {
  return 4.0 * corner_rectangle_form_factor(a / 2.0, b / 2.0, height);
}

double perpendicular_rectangle_form_factor(double height, double width, double distance) {
  require(distance > 0.0, "perpendicular_rectangle_form_factor", "distance > 0", distance);
  const double slant = std::hypot(height, distance);
  return (std::atan(width / distance) - distance / slant * std::atan(width / slant)) / (2.0 * kPi);
}

// Stokes' theorem turns the cosine-weighted solid angle into a line integral over the outline; on the sphere
// each edge is an arc of a great circle, which adds its length times the cosine between its plane's normal
// and n.
double polygon_irradiance(std::span<const Vec3d> vertices, const Vec3d& normal, double radiance) {
  require(vertices.size() >= 3, "polygon_irradiance", "at least 3 vertices",
          static_cast<double>(vertices.size()));
  double sum = 0.0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec3d& a = vertices[i];
    const Vec3d& b = vertices[(i + 1) % vertices.size()];
    const double height = glm::dot(a, normal);
    require(height >= -kRounding * glm::length(a), "polygon_irradiance", "v.n >= 0", height);
    const Vec3d turn = glm::cross(a, b);
    const double sine = glm::length(turn);  // times |a||b|
    if (sine == 0.0) continue;              // an edge in line with the receiver adds nothing
    sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(turn, normal) / sine;
  }
  return radiance / 2.0 * std::abs(sum);
}

std::vector<Vec3d> clip_to_horizon(std::span<const Vec3d> vertices, const Vec3d& normal) {
  std::vector<Vec3d> kept;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec3d& a = vertices[i];
    const Vec3d& b = vertices[(i + 1) % vertices.size()];
    const double height_a = glm::dot(a, normal);
    const double height_b = glm::dot(b, normal);
    if (height_a >= 0.0) kept.push_back(a);
    if ((height_a >= 0.0) == (height_b >= 0.0)) continue;
    Vec3d crossing = a + (b - a) * (height_a / (height_a - height_b));
    crossing -= normal * glm::dot(crossing, normal);  // on the horizon to rounding
    kept.push_back(crossing);
  }
  return kept;
}

double triangle_solid_angle(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const double la = glm::length(a);
  const double lb = glm::length(b);
  const double lc = glm::length(c);
  const double volume = std::abs(glm::dot(a, glm::cross(b, c)));
  const double denominator = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
  return 2.0 * std::atan2(volume, denominator);
}

// Sky directions project (Nusselt) on a half disc and the half of an ellipse, as for a tilted receiver: the
// wall's upper edge is a great circle, tilted by atan(h/d).
double wall_sky_view(double height, double distance) {
  require(height >= 0.0, "wall_sky_view", "height >= 0", height);
  require(distance > 0.0, "wall_sky_view", "distance > 0", distance);
  return (1.0 + distance / std::hypot(height, distance)) / 2.0;
}

double dihedral_sky_view(double opening) {
  require(opening >= 0.0 && opening <= kPi, "dihedral_sky_view", "0 <= opening <= pi", opening);
  return (1.0 - std::cos(opening)) / 2.0;
}

// A sphere is a cap with sin a = R/d and cosine h/d to its centre, d^2 = h^2 + x^2; it is wholly above the
// horizon exactly when h >= R.
double sphere_sky_view(double radius, double height, double lateral) {
  return 1.0 - sphere_irradiance(radius, height, lateral, 1.0) / kPi;
}

double sphere_irradiance(double radius, double height, double lateral, double radiance) {
  require(radius >= 0.0, "sphere_irradiance", "radius >= 0", radius);
  require(height >= radius && height > 0.0, "sphere_irradiance", "height >= radius, > 0", height);
  const double squared_distance = height * height + lateral * lateral;
  return kPi * radiance * height * radius * radius / (squared_distance * std::sqrt(squared_distance));
}

double sphere_flux_on_plane(double radius, double radiance) {
  return 2.0 * kPi * kPi * radius * radius * radiance;
}

// The smaller root is taken as product over larger root: no cancellation for small discs.
double coaxial_discs_form_factor(double radius1, double radius2, double distance) {
  require(radius1 > 0.0, "coaxial_discs_form_factor", "radius1 > 0", radius1);
  require(radius2 >= 0.0, "coaxial_discs_form_factor", "radius2 >= 0", radius2);
  require(distance > 0.0, "coaxial_discs_form_factor", "distance > 0", distance);
  const double product = squared(radius2 / radius1);
  const double sum = 1.0 + squared(distance / radius1) + product;
  return 2.0 * product / (sum + std::sqrt(sum * sum - 4.0 * product));
}

double opposite_rectangles_form_factor(double a, double b, double distance) {
  require(a > 0.0 && b > 0.0, "opposite_rectangles_form_factor", "a, b > 0", std::min(a, b));
  require(distance > 0.0, "opposite_rectangles_form_factor", "distance > 0", distance);
  const double x = a / distance;
  const double y = b / distance;
  const double root_x = std::hypot(1.0, x);
  const double root_y = std::hypot(1.0, y);
  const double logarithm = std::log(root_x * root_y / std::sqrt(1.0 + x * x + y * y));
  const double arcs = x * root_y * std::atan(x / root_y) + y * root_x * std::atan(y / root_x) -
                      x * std::atan(x) - y * std::atan(y);
  return 2.0 / (kPi * x * y) * (logarithm + arcs);
}

double adjacent_rectangles_form_factor(double edge, double depth, double height) {
  require(edge > 0.0 && depth > 0.0 && height > 0.0, "adjacent_rectangles_form_factor",
          "edge, depth, height > 0", std::min({edge, depth, height}));
  const double w = depth / edge;
  const double h = height / edge;
  const double w2 = w * w;
  const double h2 = h * h;
  const double s = w2 + h2;
  const double logarithms = std::log((1.0 + w2) * (1.0 + h2) / (1.0 + s)) +
                            w2 * std::log(w2 * (1.0 + s) / ((1.0 + w2) * s)) +
                            h2 * std::log(h2 * (1.0 + s) / ((1.0 + h2) * s));
  const double arcs =
      w * std::atan(1.0 / w) + h * std::atan(1.0 / h) - std::sqrt(s) * std::atan(1.0 / std::sqrt(s));
  return (arcs + logarithms / 4.0) / (kPi * w);
}

// By reciprocity, the sphere's flux through the disc; a uniform sphere sends the same flux into every solid
// angle seen from its centre: the disc's share of 4 pi, (1 - cos)/2.
double sphere_to_disc_form_factor(double radius, double distance) {
  require(radius >= 0.0, "sphere_to_disc_form_factor", "radius >= 0", radius);
  require(distance > 0.0, "sphere_to_disc_form_factor", "distance > 0", distance);
  return (1.0 - distance / std::hypot(radius, distance)) / 2.0;
}

// Both cosines on a chord of length d are d/(2R): cos cos/(pi d^2) = 1/(4 pi R^2) for every pair of points.
double inside_sphere_form_factor(double area, double radius) {
  require(radius > 0.0, "inside_sphere_form_factor", "radius > 0", radius);
  return area / (4.0 * kPi * radius * radius);
}

}  // namespace plumbline::truth
