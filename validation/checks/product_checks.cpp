#include "validation/checks/product_checks.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "prt/sh/basis.hpp"
#include "prt/sh/exponential.hpp"
#include "prt/sh/quadrature.hpp"

namespace plumbline::checks {
namespace {

using Vector = std::vector<double>;

/// The larger; NaN stays.
double worse(double a, double b) {
  return std::isnan(a) || a >= b ? a : b;
}

Vector random_vector(int bands, unsigned seed) {
  std::mt19937 bits(seed);
  Vector result(static_cast<std::size_t>(sh::coefficient_count(bands)));
  for (double& value : result) value = static_cast<double>(bits()) / 2147483648.0 - 1.0;
  return result;
}

double dot(const Vector& a, const Vector& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

double largest_difference(const Vector& a, const Vector& b) {
  if (a.size() != b.size()) return std::nan("");
  double result = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) result = worse(result, std::abs(a[i] - b[i]));
  return result;
}

/// a b y_i has degree 3 (bands - 1): exact with 3 bands / 2 Gauss nodes.
Vector product_by_quadrature(const Vector& a, const Vector& b, int bands) {
  const sh::Basis<double> basis(bands);
  Vector y(a.size());
  Vector result(a.size(), 0.0);
  for (const sh::SphereNode& node : sh::sphere_quadrature(3 * bands / 2 + 1)) {
    basis.evaluate(node.direction.x, node.direction.y, node.direction.z, y);
    const double value = node.weight * dot(a, y) * dot(b, y);
    for (std::size_t i = 0; i < y.size(); ++i) result[i] += value * y[i];
  }
  return result;
}

Vector constant(int bands, double value) {
  Vector f(static_cast<std::size_t>(sh::coefficient_count(bands)), 0.0);
  f[0] = value * std::sqrt(4.0 * kPi);
  return f;
}

}  // namespace

double product_deviation(const ProductUnderTest& product, int bands) {
  double result = 0.0;
  for (unsigned seed = 0; seed < 8; ++seed) {
    const Vector a = random_vector(bands, 2 * seed + 1);
    const Vector b = random_vector(bands, 2 * seed + 2);
    result = worse(result, largest_difference(product(a, b), product_by_quadrature(a, b, bands)));
  }
  if (bands < 3) return result;
  Vector f = constant(bands, 1.0);
  f[2] = std::sqrt(4.0 * kPi / 3.0);
  Vector expected = constant(bands, 4.0 / 3.0);
  expected[2] = 2.0 * std::sqrt(4.0 * kPi / 3.0);
  expected[6] = 2.0 / 3.0 * std::sqrt(4.0 * kPi / 5.0);
  return worse(result, largest_difference(product(f, f), expected));
}

double constant_exponential_deviation(const FunctionUnderTest& exponential, int bands) {
  double result = 0.0;
  for (const double a : {-20.0, -3.0, -0.1, 0.0, 0.5, 2.0, 10.0}) {
    const double error = largest_difference(exponential(constant(bands, a)), constant(bands, std::exp(a)));
    result = worse(result, error / (std::exp(a) * std::sqrt(4.0 * kPi)));
  }
  return result;
}

double constant_logarithm_deviation(const FunctionUnderTest& logarithm, int bands) {
  double result = 0.0;
  for (const double a : {-2.5, -0.5, 0.0, 1.0, 5.0}) {
    const double error = largest_difference(logarithm(constant(bands, std::exp(a))), constant(bands, a));
    result = worse(result, error / (std::max(1.0, std::abs(a)) * std::sqrt(4.0 * kPi)));
  }
  return result;
}

double series_limit_deviation(const FunctionUnderTest& exponential, int bands) {
  double result = 0.0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    Vector f = random_vector(bands, seed);
    const double factor = 1.0 / sh::magnitude_without_mean(f);
    for (double& value : f) value *= factor;
    const Vector expected = sh::exponential_of_matrix(f);
    result = worse(result, largest_difference(exponential(f), expected) / std::sqrt(dot(expected, expected)));
  }
  return result;
}

}  // namespace plumbline::checks
