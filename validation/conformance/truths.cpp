#include "validation/conformance/truths.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "prt/sh/quadrature.hpp"
#include "validation/checks/sh_checks.hpp"

namespace plumbline::conformance::truths {
namespace {

std::size_t size_of(int bands) {
  return static_cast<std::size_t>(bands) * static_cast<std::size_t>(bands);
}

int bands_of(const Values& coefficients) {
  return static_cast<int>(std::lround(std::sqrt(static_cast<double>(coefficients.size()))));
}

void add_scaled(Values& sum, const Values& values, double factor) {
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += factor * values[i];
}

glm::dmat3 turn(double angle_rad, const Vec3d& axis) {
  return glm::dmat3(glm::rotate(glm::dmat4(1.0), angle_rad, glm::normalize(axis)));
}

}  // namespace

Values basis(int bands, const Vec3d& direction) {
  return checks::textbook_basis(bands, direction);
}

double value(const Values& coefficients, const Vec3d& direction) {
  const Values y = basis(bands_of(coefficients), direction);
  double sum = 0.0;
  for (std::size_t i = 0; i < y.size(); ++i) sum += y[i] * coefficients[i];
  return sum;
}

Values projected(int bands, const Function& f, int exact_bands) {
  Values sum(size_of(bands), 0.0);
  for (const sh::SphereNode& node : sh::sphere_quadrature(std::max(bands, exact_bands)))
    add_scaled(sum, basis(bands, node.direction), node.weight * f(node.direction));
  return sum;
}

Values zonal_integral(int bands, double width, int power) {
  const sh::GaussLegendre rule = sh::gauss_legendre(bands / 2 + power / 2 + 2);
  Values sum(static_cast<std::size_t>(bands), 0.0);
  for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
    const double z = 1.0 - 0.5 * width * (1.0 + rule.nodes[k]);
    const Values y = basis(bands, {std::sqrt(std::max(0.0, (1.0 - z) * (1.0 + z))), 0.0, z});
    for (int l = 0; l < bands; ++l)
      sum[static_cast<std::size_t>(l)] += 2.0 * kPi * 0.5 * width * rule.weights[k] * std::pow(z, power) *
                                          y[static_cast<std::size_t>(l * (l + 1))];
  }
  return sum;
}

double cosine_factor(int degree) {
  const Values zonal = zonal_integral(degree + 1, 1.0, 1);
  return std::sqrt(4.0 * kPi / (2.0 * degree + 1.0)) * zonal.back();
}

Values about_axis(const Values& zonal, const Vec3d& axis) {
  const auto bands = static_cast<int>(zonal.size());
  Values result = basis(bands, axis);
  for (int l = 0; l < bands; ++l)
    for (std::size_t i = size_of(l); i < size_of(l + 1); ++i)
      result[i] *= std::sqrt(4.0 * kPi / (2.0 * l + 1.0)) * zonal[static_cast<std::size_t>(l)];
  return result;
}

Values rotated(int bands, const Values& coefficients, const glm::dmat3& rotation) {
  return projected(
      bands, [&](const Vec3d& w) { return value(coefficients, glm::transpose(rotation) * w); }, bands);
}

Values product(int bands, const Values& a, const Values& b) {
  return projected(
      bands, [&](const Vec3d& w) { return value(a, w) * value(b, w); }, 2 * bands);
}

Values composed(int bands, const Values& a, const std::function<double(double)>& g) {
  return projected(
      bands, [&](const Vec3d& w) { return g(value(a, w)); }, std::max(24, 3 * bands));
}

Vec3d lat_long_centre(int width, int height, double x, double y) {
  const double phi = 2.0 * kPi * ((x + 0.5) / width - 0.5);
  const double theta = kPi * (y + 0.5) / height;
  return {std::cos(phi) * std::sin(theta), std::cos(theta), std::sin(phi) * std::sin(theta)};
}

Values lat_long_texel(int bands, int width, int height, double x, double y) {
  static const sh::GaussLegendre kRule = sh::gauss_legendre(10);
  Values sum(size_of(bands), 0.0);
  for (std::size_t i = 0; i < kRule.nodes.size(); ++i) {
    for (std::size_t j = 0; j < kRule.nodes.size(); ++j) {
      const double row = y + 0.5 * kRule.nodes[j];
      const double area = kPi / height * 2.0 * kPi / width * std::sin(kPi * (row + 0.5) / height);
      add_scaled(sum, basis(bands, lat_long_centre(width, height, x + 0.5 * kRule.nodes[i], row)),
                 0.25 * kRule.weights[i] * kRule.weights[j] * area);
    }
  }
  return sum;
}

Vec3d cube_direction(int face, double s, double t) {
  const std::array<Vec3d, 6> directions{Vec3d{1, -t, -s}, Vec3d{-1, -t, s}, Vec3d{s, 1, t},
                                        Vec3d{s, -1, -t}, Vec3d{s, -t, 1},  Vec3d{-s, -t, -1}};
  return glm::normalize(directions.at(static_cast<std::size_t>(face)));
}

Values cube_texel(int bands, int size, int face, double x, double y) {
  static const sh::GaussLegendre kRule = sh::gauss_legendre(12);
  Values sum(size_of(bands), 0.0);
  for (std::size_t i = 0; i < kRule.nodes.size(); ++i) {
    for (std::size_t j = 0; j < kRule.nodes.size(); ++j) {
      const double s = (2.0 * x + 1.0 + kRule.nodes[i]) / size - 1.0;
      const double t = (2.0 * y + 1.0 + kRule.nodes[j]) / size - 1.0;
      const double area = 1.0 / (size * static_cast<double>(size)) / std::pow(1.0 + s * s + t * t, 1.5);
      add_scaled(sum, basis(bands, cube_direction(face, s, t)), kRule.weights[i] * kRule.weights[j] * area);
    }
  }
  return sum;
}

double polynomial_sky(const Vec3d& w) {
  return 2.0 + 0.3 * w.x - 0.5 * w.y + 0.7 * w.z + 0.4 * w.x * w.x - 0.3 * w.y * w.y + 0.25 * w.x * w.y -
         0.35 * w.x * w.z + 0.2 * w.y * w.z;
}

Values some_values(std::size_t count, unsigned seed) {
  Values result;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = std::sin(12.9898 * static_cast<double>(i + 1) + 78.233 * (seed + 1.0)) * 43758.5453;
    result.push_back(2.0 * (x - std::floor(x)) - 1.0);
  }
  return result;
}

std::vector<glm::dmat3> rotations() {
  std::vector<glm::dmat3> result{turn(0.7, {1, 2, 3}), turn(-2.1, {-3, 1, 2}), turn(1.3, {0.2, -1, 0.5})};
  result.push_back(turn(kPi / 2.0, {0, 0, 1}));
  result.push_back(turn(kPi / 2.0, {1, 0, 0}));
  result.emplace_back(1.0);
  for (const Vec3d& axis : {Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}})
    result.push_back(turn(kPi, axis));
  for (const double beta : {0.0, 1e-8, kPi, kPi - 1e-8})
    result.push_back(turn(0.4, {0, 0, 1}) * turn(beta, {0, 1, 0}) * turn(-1.1, {0, 0, 1}));
  return result;
}

}  // namespace plumbline::conformance::truths
