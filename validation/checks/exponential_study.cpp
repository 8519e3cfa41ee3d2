#include "validation/checks/exponential_study.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "prt/sh/basis.hpp"
#include "prt/sh/exponential.hpp"
#include "prt/sh/logarithm.hpp"
#include "prt/sh/quadrature.hpp"
#include "prt/sh/zonal.hpp"

namespace plumbline::checks {
namespace {

using Vector = std::vector<double>;

struct Method {
  std::string name;
  Vector (*apply)(const Vector&);
  double largest;  // |f^| it takes
  int (*products)(int squarings);
};

const std::vector<Method>& methods() {
  constexpr double kAny = sh::kLargestMagnitude;
  static const std::vector<Method> all = {
      {"linear", sh::exponential_linear, sh::kLargestTabled, [](int) { return 0; }},
      {"hybrid", sh::exponential_hybrid, kAny, [](int p) { return p; }},
      {"squared series", sh::exponential, kAny, [](int p) { return p + 1; }},
      {"series to 9", [](const Vector& f) { return sh::exponential_series(f, 9); }, kAny,
       [](int) { return 8; }},
      {"isolated series to 2", [](const Vector& f) { return sh::exponential_isolated(f, 2); }, kAny,
       [](int) { return 1; }},
      {"isolated series to 9", [](const Vector& f) { return sh::exponential_isolated(f, 9); }, kAny,
       [](int) { return 8; }},
      {"matrix", sh::exponential_of_matrix, kAny, [](int) { return 0; }},
  };
  return all;
}

double rms_difference(const Vector& a, const Vector& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / (4.0 * kPi));
}

int squarings_for(double magnitude) {
  int squarings = 0;
  for (; magnitude > sh::kScaledMagnitude; ++squarings) magnitude *= 0.5;
  return squarings;
}

/// @param visibility  the product of the visibilities themselves, projected
StudyCase study(const Vector& f, const Vector& visibility) {
  StudyCase result;
  result.magnitude = sh::magnitude_without_mean(f);
  const Vector truth = sh::exponential_by_quadrature(f).coefficients;
  result.oracle_visibility_error = rms_difference(truth, visibility);
  for (const Method& method : methods()) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    if (result.magnitude > method.largest) {
      result.errors.push_back({nan, 0});
      result.visibility_errors.push_back(nan);
      continue;
    }
    const Vector approximation = method.apply(f);
    result.errors.push_back(
        {rms_difference(approximation, truth), method.products(squarings_for(result.magnitude))});
    result.visibility_errors.push_back(rms_difference(approximation, visibility));
  }
  const double mean = std::exp(f[0] / std::sqrt(4.0 * kPi));
  double inner = 0.0;
  for (std::size_t i = 1; i < f.size(); ++i) inner += truth[i] * f[i];
  result.best_a = truth[0] / (mean * std::sqrt(4.0 * kPi));
  result.best_b = inner / (mean * result.magnitude * result.magnitude);
  return result;
}

struct Sphere {
  Vec3d axis{0.0};
  double radius_rad = 0.0;
};

Sphere draw_sphere(std::mt19937_64& bits) {
  const auto uniform = [&bits] { return (static_cast<double>(bits() >> 11U) + 0.5) * 0x1p-53; };
  const double z = 2.0 * uniform() - 1.0;
  const double phi = 2.0 * kPi * uniform();
  const double radius = std::sqrt((1.0 - z) * (1.0 + z));
  return {Vec3d(radius * std::cos(phi), radius * std::sin(phi), z), (3.0 + 20.0 * uniform()) * kPi / 180.0};
}

/// Projection of "no sphere in this direction". The edges make the quadrature err by about 1e-3.
Vector project_visibility(int bands, const std::vector<Sphere>& spheres) {
  constexpr int kNodes = 64;
  const sh::Basis<double> basis(bands);
  Vector y(static_cast<std::size_t>(basis.coefficient_count()));
  Vector result(y.size(), 0.0);
  for (const sh::SphereNode& node : sh::sphere_quadrature(kNodes)) {
    bool is_visible = true;
    for (const Sphere& sphere : spheres)
      is_visible &= glm::dot(sphere.axis, node.direction) < std::cos(sphere.radius_rad);
    if (!is_visible) continue;
    basis.evaluate(node.direction.x, node.direction.y, node.direction.z, y);
    for (std::size_t i = 0; i < y.size(); ++i) result[i] += node.weight * y[i];
  }
  return result;
}

StudyCase study_spheres(int bands, const std::vector<Sphere>& spheres) {
  Vector log(static_cast<std::size_t>(sh::coefficient_count(bands)), 0.0);
  Vector multiplied;
  for (const Sphere& sphere : spheres) {
    const Vector visibility = sh::sphere_visibility(bands, sphere.radius_rad);
    const Vector one = sh::rotate_zonal(sh::zonal_logarithm(visibility).coefficients, sphere.axis);
    for (std::size_t i = 0; i < log.size(); ++i) log[i] += one[i];
    const Vector turned = sh::rotate_zonal(visibility, sphere.axis);
    multiplied = multiplied.empty() ? turned : sh::product(multiplied, turned);
  }
  const Vector visibility = project_visibility(bands, spheres);
  StudyCase result = study(log, visibility);
  result.product_visibility_error = rms_difference(multiplied, visibility);
  result.parameter = static_cast<double>(spheres.size());
  return result;
}

}  // namespace

const std::vector<std::string>& exponential_methods() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> result;
    for (const Method& method : methods()) result.push_back(method.name);
    return result;
  }();
  return names;
}

std::vector<StudyCase> study_single_spheres(int bands) {
  std::vector<StudyCase> cases;
  for (int degrees = 1; degrees < 90; degrees += 2) {
    const Vector zonal = sh::sphere_visibility(bands, degrees * kPi / 180.0);
    const sh::Logarithm log = sh::zonal_logarithm(zonal);
    const Vec3d axis(0.0, 0.0, 1.0);
    StudyCase one = study(sh::rotate_zonal(log.coefficients, axis), sh::rotate_zonal(zonal, axis));
    one.parameter = degrees;
    one.clipped = log.clipped;
    one.clipped_energy = log.energy;
    cases.push_back(one);
  }
  return cases;
}

std::vector<StudyCase> study_accumulations(int bands, int trials, std::uint64_t seed) {
  std::vector<StudyCase> cases;
  std::mt19937_64 bits(seed);
  for (const int count : {1, 2, 5, 10, 20, 50, 100}) {
    for (int trial = 0; trial < trials; ++trial) {
      std::vector<Sphere> spheres;
      for (int s = 0; s < count; ++s) spheres.push_back(draw_sphere(bits));
      cases.push_back(study_spheres(bands, spheres));
    }
  }
  return cases;
}

double overall_error(const std::vector<StudyCase>& cases, std::size_t index) {
  double sum = 0.0;
  for (const StudyCase& one : cases) sum += one.errors[index].error * one.errors[index].error;
  return std::sqrt(sum / static_cast<double>(cases.size()));
}

double round_trip_residual(int bands) {
  Vector f(static_cast<std::size_t>(sh::coefficient_count(bands)), 0.0);
  f[0] = -std::sqrt(4.0 * kPi);
  if (bands > 1) f[2] = 0.7 * std::sqrt(4.0 * kPi / 3.0);
  const Vector back = sh::logarithm(sh::exponential_by_quadrature(f).coefficients).coefficients;
  return rms_difference(back, f) / rms_difference(f, Vector(f.size(), 0.0));
}

}  // namespace plumbline::checks
