// Analytic lights: closed forms, and what they promise a white surface.
#include <algorithm>
#include <cmath>

#include "validation/checks/sh_checks.hpp"
#include "validation/conformance/check.hpp"
#include "validation/conformance/diagnosis.hpp"
#include "validation/conformance/truths.hpp"

namespace plumbline::conformance {
namespace {

constexpr const char* kDirectional = "light directional";
constexpr const char* kCone = "light cone";
constexpr const char* kSphere = "light sphere";
constexpr const char* kHemisphere = "light hemisphere";
constexpr double kDegree = kPi / 180.0;

/// E/pi at a surface that faces `d`.
double facing_exit_radiance(int bands, const Values& light, const Vec3d& d) {
  const Values y = truths::basis(bands, d);
  double sum = 0.0;
  for (int l = 0; l < bands; ++l)
    for (std::size_t i = static_cast<std::size_t>(l * l); i < static_cast<std::size_t>((l + 1) * (l + 1));
         ++i)
      sum += truths::cosine_factor(l) * y[i] * light[i];
  return sum / kPi;
}

/// Scaled as the implementation says its directional lights and cones are.
Values in_unit(const Context& context, Values light, const Vec3d& d) {
  if (context.subject.raw().light_unit != PLUMBLINE_LIGHT_FACING_ONE) return light;
  const double factor = 1.0 / facing_exit_radiance(context.bands, light, d);
  for (double& v : light) v *= factor;
  return light;
}

Values cone(int bands, const Vec3d& d, double half_angle) {
  const double half_sine = std::sin(0.5 * half_angle);
  return truths::about_axis(truths::zonal_integral(bands, 2.0 * half_sine * half_sine, 0), d);
}

std::vector<Judged> directional(const Context& context) {
  Pairs pairs;
  const std::vector<Vec3d> directions = checks::probe_directions();
  for (const Vec3d& d : directions)
    pairs.add(in_unit(context, truths::basis(context.bands, d), d),
              must(context.subject.light_directional(context.bands, d), "a unit direction"));
  return {judged_directions(
      context, {kDirectional, "y_lm(d)", "A pulse of the declared unit; rounding", context.bands}, directions,
      pairs, 8.0 * pairs.scale() * rounding(context, context.bands), 1e-5)};
}

std::vector<Judged> cones(const Context& context) {
  Pairs pairs;
  const Vec3d d(2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0);
  for (const double degrees : {0.2665, 5.0, 30.0, 90.0, 135.0, 180.0}) {
    const double angle = degrees * kDegree;
    Values expected = in_unit(context, cone(context.bands, d, angle), d);
    Values answer = must(context.subject.light_cone(context.bands, d, angle), "a half angle in (0, pi]");
    // Relative to each one's own size: the sun must keep its digits.
    const double size = std::abs(expected[0]);
    for (double& v : expected) v /= size;
    for (double& v : answer) v /= size;
    pairs.add(expected, answer);
  }
  return {judged_coefficients(
      context,
      {kCone, "caps from 0.27 to 180 degrees", "Exact quadrature of the cap; rounding", context.bands}, pairs,
      64.0 * pairs.scale() * rounding(context, context.bands), 1e-5)};
}

std::vector<Judged> spheres(const Context& context) {
  Pairs pairs;
  for (const double distance : {1.5, 10.0, 1000.0}) {
    const Vec3d d(-6.0 / 7.0, 2.0 / 7.0, 3.0 / 7.0);
    const double sine = 1.0 / distance;
    const double width = sine * sine / (1.0 + std::sqrt(1.0 - sine * sine));
    Values expected = truths::about_axis(truths::zonal_integral(context.bands, width, 0), d);
    Values answer = must(context.subject.light_sphere(context.bands, 2.0 * distance * d, 2.0),
                         "a sphere that does not hold the origin");
    const double size = std::abs(expected[0]);
    for (double& v : expected) v /= size;
    for (double& v : answer) v /= size;
    pairs.add(expected, answer);
  }
  return {judged_coefficients(context,
                              {kSphere, "near and far", "The cap with sin a = r/d; rounding", context.bands},
                              pairs, 64.0 * pairs.scale() * rounding(context, context.bands), 1e-5)};
}

/// Bands 0 and 1 are fixed by the irradiance, even bands above must vanish, odd ones above cannot be seen.
std::vector<Judged> hemisphere(const Context& context) {
  Pairs pairs;
  const Vec3d up(0.48, 0.6, -0.64);
  const double white = std::sqrt(4.0 * kPi);
  for (const auto& [top, bottom] : {std::pair{1.0, 1.0}, std::pair{1.0, 0.0}, std::pair{0.25, 3.0}}) {
    Values zonal(static_cast<std::size_t>(context.bands), 0.0);
    zonal[0] = white * 0.5 * (top + bottom);
    if (context.bands > 1) zonal[1] = std::sqrt(3.0 * kPi) / 2.0 * (top - bottom);
    Values answer = must(context.subject.light_hemisphere(context.bands, up, top, bottom), "two radiances");
    for (int l = 3; l < context.bands; l += 2)
      std::fill(answer.begin() + l * l, answer.begin() + (l + 1) * (l + 1), 0.0);
    pairs.add(truths::about_axis(zonal, up), answer);
  }
  return {judged_coefficients(context,
                              {kHemisphere, "promised exit radiance",
                               "E = pi (bottom + (top - bottom)(1 + n.up)/2); rounding", context.bands},
                              pairs, 64.0 * pairs.scale() * rounding(context, context.bands), 1e-5)};
}

bool has_directional(const Implementation& i) {
  return i.light_directional != nullptr;
}
bool has_cone(const Implementation& i) {
  return i.light_cone != nullptr;
}
bool has_sphere(const Implementation& i) {
  return i.light_sphere != nullptr;
}
bool has_hemisphere(const Implementation& i) {
  return i.light_hemisphere != nullptr;
}

}  // namespace

std::vector<Check> light_checks() {
  return {{kDirectional, "y_lm(d)", has_directional, true, directional},
          {kCone, "caps from 0.27 to 180 degrees", has_cone, true, cones},
          {kSphere, "near and far", has_sphere, true, spheres},
          {kHemisphere, "promised exit radiance", has_hemisphere, true, hemisphere}};
}

}  // namespace plumbline::conformance
