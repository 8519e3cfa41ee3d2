#include "validation/checks/sh_checks.hpp"

#include <array>
#include <cmath>

#include "prt/sh/quadrature.hpp"

namespace plumbline::checks {
namespace {

/// The larger; NaN stays.
double worse(double a, double b) {
  return std::isnan(a) || a >= b ? a : b;
}

std::size_t index(int l, int m) {
  return static_cast<std::size_t>(l * (l + 1) + m);
}

double legendre(int degree, double x) {
  double previous = 1.0;
  double current = x;
  if (degree == 0) return 1.0;
  for (int l = 2; l <= degree; ++l) {
    const double next = ((2.0 * l - 1.0) * x * current - (l - 1.0) * previous) / l;
    previous = current;
    current = next;
  }
  return current;
}

double largest_component(const RgbD& c) {
  return worse(worse(std::abs(c.r), std::abs(c.g)), std::abs(c.b));
}

double deviation_from(const std::vector<RgbD>& expected, const std::vector<RgbD>& measured) {
  if (measured.size() != expected.size()) return std::nan("");
  double result = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    result = worse(result, largest_component(measured[i] - expected[i]));
  }
  return result;
}

double white_error(const ProjectionUnderTest& project, const light::Environment& environment, int bands) {
  std::vector<RgbD> expected(static_cast<std::size_t>(bands * bands), RgbD(0.0));
  expected[0] = RgbD(std::sqrt(4.0 * kPi));
  return deviation_from(expected, project(environment, bands));
}

}  // namespace

std::vector<Vec3d> probe_directions() {
  std::vector<Vec3d> result{{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
  const double golden_angle = kPi * (3.0 - std::sqrt(5.0));
  constexpr int kCount = 64;
  for (int i = 0; i < kCount; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / kCount;
    const double radius = std::sqrt((1.0 - z) * (1.0 + z));
    result.emplace_back(radius * std::cos(golden_angle * i), radius * std::sin(golden_angle * i), z);
  }
  for (const double angle : {1e-1, 1e-3, 1e-6}) {
    result.emplace_back(0.6 * std::sin(angle), 0.8 * std::sin(angle), std::cos(angle));
    result.emplace_back(0.8 * std::sin(angle), -0.6 * std::sin(angle), -std::cos(angle));
  }
  return result;
}

// The definition: y_lm = sqrt(2) K_lm P_l^m(cos theta) cos(m phi), with the Condon-Shortley sign in P.
// Column by column, P_m^m = (-1)^m (2m - 1)!! sin^m, K_lm by its ratio from row to row.
std::vector<double> textbook_basis(int bands, const Vec3d& direction) {
  using Long = long double;
  const Long x = direction.x;
  const Long y = direction.y;
  const Long z = direction.z;
  const Long sine = std::hypot(x, y);
  const Long phi = std::atan2(y, x);
  constexpr Long kFourPi = 4.0L * std::numbers::pi_v<Long>;
  std::vector<double> values(static_cast<std::size_t>(bands * bands));
  Long diagonal = std::sqrt(1.0L / kFourPi);  // K_mm P_m^m but for the factor sqrt(2m + 1)
  for (int m = 0; m < bands; ++m) {
    if (m > 0) diagonal *= -sine * std::sqrt((2.0L * m - 1.0L) / (2.0L * m));
    Long previous = 0.0L;
    Long current = diagonal;  // sqrt((l - m)!/(l + m)!) P_l^m / sqrt(4 pi)
    for (int l = m; l < bands; ++l) {
      if (l > m) {
        const Long below = std::sqrt(static_cast<Long>((l - 1) * (l - 1) - m * m));
        const Long next = ((2.0L * l - 1.0L) * z * current - below * previous) /
                          std::sqrt(static_cast<Long>(l * l - m * m));
        previous = current;
        current = next;
      }
      const Long q = std::sqrt((2.0L * l + 1.0L) * (m > 0 ? 2.0L : 1.0L)) * current;
      values[index(l, m)] = static_cast<double>(q * std::cos(m * phi));
      if (m > 0) values[index(l, -m)] = static_cast<double>(q * std::sin(m * phi));
    }
  }
  return values;
}

GramDeviation gram_deviation(const BasisUnderTest& basis, int bands) {
  const auto size = static_cast<std::size_t>(bands * bands);
  std::vector<double> gram(size * size, 0.0);
  for (const sh::SphereNode& node : sh::sphere_quadrature(bands)) {
    const std::vector<double> y = basis(node.direction);
    if (y.size() < size) return {std::nan(""), 0, 0};
    for (std::size_t i = 0; i < size; ++i) {
      const double weighted = node.weight * y[i];
      for (std::size_t j = 0; j <= i; ++j) gram[i * size + j] += weighted * y[j];
    }
  }
  GramDeviation result;
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      const double error = std::abs(gram[i * size + j] - (i == j ? 1.0 : 0.0));
      if (error <= result.value) continue;
      if (std::isnan(result.value)) return result;
      result = {error, static_cast<int>(i), static_cast<int>(j)};
    }
  }
  return result;
}

BasisDeviation basis_deviation(const BasisUnderTest& basis, int bands) {
  BasisDeviation result;
  for (const Vec3d& direction : probe_directions()) {
    const std::vector<double> truth = textbook_basis(bands, direction);
    const std::vector<double> y = basis(direction);
    if (y.size() < truth.size()) return {std::nan(""), 0, direction};
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const double error = std::abs(y[i] - truth[i]);
      if (error <= result.value) continue;
      result = {error, static_cast<int>(i), direction};
      if (std::isnan(error)) return result;
    }
  }
  return result;
}

double addition_theorem_deviation(const BasisUnderTest& basis, int bands) {
  const std::vector<Vec3d> directions = probe_directions();
  double result = 0.0;
  for (std::size_t k = 1; k < directions.size(); ++k) {
    const Vec3d& a = directions[k - 1];
    const Vec3d& b = directions[k];
    const std::vector<double> ya = basis(a);
    const std::vector<double> yb = basis(b);
    for (int l = 0; l < bands; ++l) {
      double sum = 0.0;
      for (int m = -l; m <= l; ++m) sum += ya.at(index(l, m)) * yb.at(index(l, m));
      const double expected = (2.0 * l + 1.0) / (4.0 * kPi) * legendre(l, glm::dot(a, b));
      result = worse(result, std::abs(sum - expected));
    }
  }
  return result;
}

double clamped_cosine_factor_error(const std::function<double(int)>& factor, int degrees) {
  const sh::GaussLegendre rule = sh::gauss_legendre(degrees / 2 + 2);
  double result = 0.0;
  for (int l = 0; l < degrees; ++l) {
    double integral = 0.0;
    for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
      const double z = 0.5 * (1.0 + rule.nodes[k]);
      integral += 0.5 * rule.weights[k] * z * legendre(l, z);
    }
    result = worse(result, std::abs(factor(l) - 2.0 * kPi * integral));
  }
  return result;
}

double white_projection_error(const ProjectionUnderTest& project, int bands) {
  light::Environment white;
  white.name = "white";
  white.sky = light::ConstantSky{Rgb(1.0F)};
  return white_error(project, white, bands);
}

double white_image_projection_error(const ProjectionUnderTest& project, int bands) {
  light::Environment white;
  white.name = "white image";
  white.sky = light::LatLongSky{image::make_image(32, 16, Rgb(1.0F))};
  return white_error(project, white, bands);
}

// One face +Z of radiance 1: c_00 = sqrt(4 pi)/6; c_10 = sqrt(3/4 pi) * 4/sqrt(2) atan(1/sqrt(2)); c_20 from
// the integral of z^2 over the face, 2 pi/9 + 4/(3 sqrt 3); l <= 2 has nothing else by the face's four-fold
// symmetry. The other faces follow by permuting the axes in y_1m ~ (-y, z, -x) and y_20 ~ (3 z^2 - 1)/2, y_22
// ~ sqrt(3)/2 (x^2 - y^2).
double cube_face_projection_error(const ProjectionUnderTest& project) {
  constexpr std::array<double, 6> kFaces{1.0, 2.0, 4.0, 8.0, 16.0, 32.0};  // +X -X +Y -Y +Z -Z
  light::Environment environment;
  environment.name = "six faces";
  light::CubeMapSky cube;
  for (std::size_t face = 0; face < 6; ++face) {
    cube.faces[face] = image::make_image(4, 4, Rgb(static_cast<float>(kFaces[face])));
  }
  environment.sky = cube;

  const double c00 = std::sqrt(4.0 * kPi) / 6.0;
  const double c10 = std::sqrt(3.0 / (4.0 * kPi)) * 4.0 / std::sqrt(2.0) * std::atan(1.0 / std::sqrt(2.0));
  const double square = 2.0 * kPi / 9.0 + 4.0 / (3.0 * std::sqrt(3.0));
  const double c20 = std::sqrt(5.0 / (16.0 * kPi)) * (3.0 * square - 4.0 * kPi / 6.0);
  const auto difference = [&](std::size_t axis) { return kFaces[2 * axis] - kFaces[2 * axis + 1]; };
  const auto sum = [&](std::size_t axis) { return kFaces[2 * axis] + kFaces[2 * axis + 1]; };
  std::vector<RgbD> expected(9, RgbD(0.0));
  expected[0] = RgbD(c00 * (sum(0) + sum(1) + sum(2)));
  expected[1] = RgbD(-c10 * difference(1));
  expected[2] = RgbD(c10 * difference(2));
  expected[3] = RgbD(-c10 * difference(0));
  expected[6] = RgbD(c20 * (sum(2) - 0.5 * (sum(0) + sum(1))));
  expected[8] = RgbD(c20 * std::sqrt(3.0) / 2.0 * (sum(0) - sum(1)));
  return deviation_from(expected, project(environment, 3));
}

// L = a + b . w + w^T Q w: E(n) = pi a + (2 pi/3) b . n + (pi/4) (trace Q + n^T Q n), from E = pi/4 (1 +
// n_z^2) for w_z^2 and, by turning the axes, for every w_u^2.
double polynomial_irradiance_error(const ProjectionUnderTest& project, const BasisUnderTest& basis,
                                   const std::function<double(int)>& factor) {
  const double a = 2.0;
  const Vec3d b(0.3, -0.5, 0.7);
  const glm::dmat3 q(0.4, 0.1, -0.2, 0.1, -0.3, 0.15, -0.2, 0.15, 0.25);
  light::Environment environment;
  environment.name = "polynomial";
  environment.sky = light::AnalyticSky{[=](const Vec3& direction) {
    const Vec3d w(direction);
    return Rgb(static_cast<float>(a + glm::dot(b, w) + glm::dot(w, q * w)));
  }};
  const std::vector<RgbD> lighting = project(environment, 3);
  if (lighting.size() != 9) return std::nan("");
  double result = 0.0;
  for (const Vec3d& n : probe_directions()) {
    const std::vector<double> y = basis(n);
    double irradiance = 0.0;
    for (int l = 0; l < 3; ++l) {
      for (int m = -l; m <= l; ++m) irradiance += factor(l) * lighting[index(l, m)].g * y.at(index(l, m));
    }
    const double trace = q[0][0] + q[1][1] + q[2][2];
    const double expected =
        kPi * a + 2.0 * kPi / 3.0 * glm::dot(b, n) + kPi / 4.0 * (trace + glm::dot(n, q * n));
    result = worse(result, std::abs(irradiance - expected));
  }
  return result;
}

}  // namespace plumbline::checks
