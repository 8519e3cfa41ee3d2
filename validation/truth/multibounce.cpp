#include "validation/truth/multibounce.hpp"

#include <cmath>

#include "validation/truth/irradiance.hpp"
#include "validation/truth/require.hpp"

namespace plumbline::truth {
namespace {

void require_albedo(double albedo, const char* function) {
  require(albedo >= 0.0 && albedo <= 1.0, function, "0 <= albedo <= 1", albedo);
}

/// 1 + q + q^2 + ... for q < 1.
double geometric_limit(double ratio, const char* function) {
  require(ratio >= 0.0 && ratio < 1.0, function, "albedo x form factor < 1 for all bounces", ratio);
  return 1.0 / (1.0 - ratio);
}

/// 1 + q + ... + q^(terms-1), by Horner's scheme: q = 1 is no special case.
double geometric_partial_sum(double ratio, int terms, const char* function) {
  require(terms >= 0, function, "bounces >= 0", terms);
  double sum = 0.0;
  for (int k = 0; k < terms; ++k) sum = 1.0 + ratio * sum;
  return sum;
}

/// The first N + more terms for N bounces, or all.
double geometric_sum(double ratio, Bounces bounces, int more, const char* function) {
  if (!bounces) return geometric_limit(ratio, function);
  require(*bounces >= 0, function, "bounces >= 0", *bounces);
  return geometric_partial_sum(ratio, *bounces + more, function);
}

// Two surfaces that see each other alternate: s1 = d1 + g1 d2 + g1 g2 d1 + g1 g2 g1 d2 ..., where g1 takes
// light of the second surface to the first and g2 back. Returned are the weights of d1 and d2 in s1.
struct Weights {
  double own = 0.0;
  double other = 0.0;
};
Weights alternating_series(double g1, double g2, Bounces bounces, const char* function) {
  if (!bounces) {
    const double sum = geometric_limit(g1 * g2, function);
    return {sum, g1 * sum};
  }
  require(*bounces >= 0, function, "bounces >= 0", *bounces);
  return {geometric_partial_sum(g1 * g2, *bounces / 2 + 1, function),
          g1 * geometric_partial_sum(g1 * g2, (*bounces + 1) / 2, function)};
}

}  // namespace

double neumann_term(double direct, double albedo, double form_factor, int bounce) {
  require(bounce >= 0, "neumann_term", "bounce >= 0", bounce);
  return direct * std::pow(albedo * form_factor, bounce);
}

double neumann_sum(double direct, double albedo, double form_factor, Bounces bounces) {
  return direct * geometric_sum(albedo * form_factor, bounces, 1, "neumann_sum");
}

double neumann_remainder(double direct, double albedo, double form_factor, int bounces) {
  return neumann_term(direct, albedo, form_factor, bounces + 1) *
         geometric_limit(albedo * form_factor, "neumann_remainder");
}

// If all the walls have exit radiance L, every point receives pi L from every direction and L = L_e + rho L.
double enclosure_radiance(double emission, double albedo, Bounces bounces) {
  require_albedo(albedo, "enclosure_radiance");
  return emission * geometric_sum(albedo, bounces, 2, "enclosure_radiance");
}

// With exit radiance 1 everywhere, every point sees radiance 1 in every direction, sky or surface, and with
// albedo 1 sends out 1 again. The sky's only coefficient is l_00 = sqrt(4 pi).
double white_furnace_transfer() {
  return 1.0 / std::sqrt(4.0 * kPi);
}

// The kernel inside a sphere is constant (inside_sphere_form_factor): whatever the first reflection sends
// out, rho Phi, spreads evenly over 4 pi R^2, and so on.
double sphere_indirect_irradiance(double flux, double radius, double albedo, Bounces bounces) {
  require(radius > 0.0, "sphere_indirect_irradiance", "radius > 0", radius);
  require_albedo(albedo, "sphere_indirect_irradiance");
  return albedo * inside_sphere_form_factor(flux, radius) *
         geometric_sum(albedo, bounces, 0, "sphere_indirect_irradiance");
}

// Law of cosines for the distance d; the inward normal's cosine is (R - s c)/d.
double sphere_point_light_radiance(double radiant_intensity, double offset, double radius, double cos_angle,
                                   double albedo, Bounces bounces) {
  require(offset >= 0.0 && offset < radius, "sphere_point_light_radiance", "0 <= offset < radius", offset);
  const double squared_distance = radius * radius + offset * offset - 2.0 * radius * offset * cos_angle;
  const double direct =
      radiant_intensity * (radius - offset * cos_angle) / (squared_distance * std::sqrt(squared_distance));
  const double flux = 4.0 * kPi * radiant_intensity;
  return albedo / kPi * (direct + sphere_indirect_irradiance(flux, radius, albedo, bounces));
}

// The sky seen through the opening is as good as the missing cap with radiance L: form factor f from every
// point; the cavity sees itself with 1 - f.
double cavity_irradiance(double opening_half_angle, double albedo, double radiance, Bounces bounces) {
  require(opening_half_angle > 0.0 && opening_half_angle < kPi, "cavity_irradiance",
          "0 < opening_half_angle < pi", opening_half_angle);
  require_albedo(albedo, "cavity_irradiance");
  const double open = cap_solid_angle(opening_half_angle) / (4.0 * kPi);
  return neumann_sum(kPi * radiance * open, albedo, 1.0 - open, bounces);
}

// Flux pi R^2 E_a enters; the first reflection spreads rho pi R^2 E_a with the constant kernel 1/(4 pi R^2):
// rho E_a/4 everywhere; the bowl then sees itself with 1/2.
double bowl_indirect_irradiance(double aperture_irradiance, double albedo, Bounces bounces) {
  require_albedo(albedo, "bowl_indirect_irradiance");
  return aperture_irradiance * albedo / 4.0 *
         geometric_sum(albedo / 2.0, bounces, 0, "bowl_indirect_irradiance");
}

double dihedral_form_factor(double opening) {
  require(opening > 0.0 && opening <= kPi, "dihedral_form_factor", "0 < opening <= pi", opening);
  return 1.0 - dihedral_sky_view(opening);
}

// F does not depend on the place and the sky lights both faces evenly, so the exit radiance is constant on
// each face: E1 = e + F rho2 E2, E2 = e + F rho1 E1.
Pair dihedral_irradiances(double opening, double albedo1, double albedo2, double radiance, Bounces bounces) {
  const char* const name = "dihedral_irradiances";
  require_albedo(albedo1, name);
  require_albedo(albedo2, name);
  const double f = dihedral_form_factor(opening);
  const double direct = kPi * radiance * (1.0 - f);
  const Weights first = alternating_series(f * albedo2, f * albedo1, bounces, name);
  const Weights second = alternating_series(f * albedo1, f * albedo2, bounces, name);
  return {direct * (first.own + first.other), direct * (second.own + second.other)};
}

double finite_corner_form_factor(double reach, double distance) {
  require(reach > 0.0, "finite_corner_form_factor", "reach > 0", reach);
  return 2.0 * perpendicular_rectangle_form_factor(reach, reach, distance);
}

// All the inner sphere sends out reaches the outer one; of what the outer one sends out, q reaches the inner
// one (reciprocity: A1 = q A2) and the rest itself. Solved by elimination of B1.
Pair concentric_spheres_radiosity(double radius1, double radius2, const Pair& emitted, const Pair& albedo) {
  const char* const name = "concentric_spheres_radiosity";
  require(radius1 > 0.0 && radius1 < radius2, name, "0 < radius1 < radius2", radius1);
  require_albedo(albedo.first, name);
  require_albedo(albedo.second, name);
  const double q = (radius1 / radius2) * (radius1 / radius2);
  const double loss = 1.0 - albedo.second * (q * albedo.first + 1.0 - q);
  require(loss > 0.0, name, "some absorption", loss);
  const double second = (emitted.second + albedo.second * q * emitted.first) / loss;
  return {emitted.first + albedo.first * second, second};
}

Pair parallel_plates_radiosity(const Pair& emitted, const Pair& albedo) {
  require_albedo(albedo.first, "parallel_plates_radiosity");
  require_albedo(albedo.second, "parallel_plates_radiosity");
  const double sum = geometric_limit(albedo.first * albedo.second, "parallel_plates_radiosity");
  return {(emitted.first + albedo.first * emitted.second) * sum,
          (emitted.second + albedo.second * emitted.first) * sum};
}

namespace {

/// Moments of a function g on the sphere: int g, int g w, int g w w^T.
struct Moments {
  double zeroth = 0.0;
  Vec3d first{0.0};
  glm::dmat3 second{0.0};
};

// y_lm for l <= 2 are polynomials in the direction, so their integrals are combinations of moments. The signs
// are those of the Condon-Shortley phase: minus for odd m.
ThreeBands project_moments(const Moments& g) {
  const double c0 = std::sqrt(1.0 / (4.0 * kPi));
  const double c1 = std::sqrt(3.0 / (4.0 * kPi));
  const double c2 = std::sqrt(15.0 / (4.0 * kPi));
  const glm::dmat3& s = g.second;
  return {c0 * g.zeroth,
          -c1 * g.first.y,
          c1 * g.first.z,
          -c1 * g.first.x,
          c2 * s[0][1],
          -c2 * s[1][2],
          std::sqrt(5.0 / (16.0 * kPi)) * (3.0 * s[2][2] - g.zeroth),
          -c2 * s[0][2],
          c2 / 2.0 * (s[0][0] - s[1][1])};
}

}  // namespace

// With f = z', n_wall = y', t = f x n_wall = -x', the floor sees the quarter sphere y', z' > 0. In polar
// coordinates about z', azimuth p in (0, pi) from x':
//   int z' = pi/2;  int z' y' = 2/3, int z' z' = pi/3;
//   int z' x'^2 = int z' y'^2 = pi/8, int z'^3 = pi/4, int z'^2 y' = pi/8; odd in x' vanish.
ThreeBands corner_direct_transfer(const Vec3d& floor_normal, const Vec3d& wall_normal) {
  const double cosine = glm::dot(floor_normal, wall_normal);
  require(std::abs(cosine) <= 1e-6, "corner_direct_transfer", "perpendicular normals, |cosine| <= 1e-6",
          cosine);
  for (const double length : {glm::length(floor_normal), glm::length(wall_normal)}) {
    require(std::abs(length - 1.0) <= 1e-6, "corner_direct_transfer", "unit normals (to 1e-6)", length);
  }
  const Vec3d& f = floor_normal;
  const Vec3d& n = wall_normal;
  const Vec3d t = glm::cross(f, n);
  Moments g;
  g.zeroth = kPi / 2.0;
  g.first = 2.0 / 3.0 * n + kPi / 3.0 * f;
  g.second = kPi / 8.0 *
                 (glm::outerProduct(t, t) + glm::outerProduct(n, n) + glm::outerProduct(f, n) +
                  glm::outerProduct(n, f)) +
             kPi / 4.0 * glm::outerProduct(f, f);
  ThreeBands transfer = project_moments(g);
  for (double& value : transfer) value /= kPi;
  return transfer;
}

// A distant light gives every point of a face the same direct irradiance, and F = 1/2 whatever the place: the
// dihedral's argument with D1 . l and D2 . l in place of e.
ThreeBands corner_transfer(const Vec3d& floor_normal, const Vec3d& wall_normal, double floor_albedo,
                           double wall_albedo, Bounces bounces) {
  require_albedo(floor_albedo, "corner_transfer");
  require_albedo(wall_albedo, "corner_transfer");
  const ThreeBands floor = corner_direct_transfer(floor_normal, wall_normal);
  const ThreeBands wall = corner_direct_transfer(wall_normal, floor_normal);
  const Weights weights =
      alternating_series(0.5 * wall_albedo, 0.5 * floor_albedo, bounces, "corner_transfer");
  ThreeBands transfer{};
  for (std::size_t i = 0; i < transfer.size(); ++i) {
    transfer[i] = weights.own * floor[i] + weights.other * wall[i];
  }
  return transfer;
}

}  // namespace plumbline::truth
