#include "prt/sh/quadrature.hpp"

#include <cmath>
#include <string>

#include "prt/sh/basis.hpp"
#include "reference/base/error.hpp"

namespace plumbline::sh {
namespace {

struct LegendreValue {
  long double value = 0.0L;
  long double derivative = 0.0L;
};

/// P_n(x) and its derivative n (P_(n-1) - x P_n) / (1 - x^2), |x| < 1.
LegendreValue legendre_value(int n, long double x) {
  long double previous = 1.0L;
  long double current = x;
  for (int k = 2; k <= n; ++k) {
    const auto kk = static_cast<long double>(k);
    const long double next = ((2.0L * kk - 1.0L) * x * current - (kk - 1.0L) * previous) / kk;
    previous = current;
    current = next;
  }
  return {current, static_cast<long double>(n) * (previous - x * current) / ((1.0L - x) * (1.0L + x))};
}

}  // namespace

// Newton's method on P_n from Tricomi's x_k = (1 - (n - 1)/(8 n^3)) cos(pi (4k - 1)/(4n + 2)), whose error is
// O(n^-4): three steps reach the rounding of long double, which leaves the double results correct to their
// last bit or two (a plain double recurrence loses about n times that). Weights: 2 / ((1 - x^2) P_n'(x)^2).
GaussLegendre gauss_legendre(int count) {
  if (count < 1) throw InputError("gauss_legendre: expected at least 1 node, got " + std::to_string(count));
  const auto size = static_cast<std::size_t>(count);
  GaussLegendre rule{std::vector<double>(size), std::vector<double>(size)};
  if (count == 1) return {{0.0}, {2.0}};
  const auto n = static_cast<long double>(count);
  for (std::size_t k = 0; k < (size + 1) / 2; ++k) {
    const long double angle =
        std::numbers::pi_v<long double> * (4.0L * static_cast<long double>(k) + 3.0L) / (4.0L * n + 2.0L);
    long double x = (1.0L - (n - 1.0L) / (8.0L * n * n * n)) * std::cos(angle);
    const bool is_middle = 2 * k + 1 == size;
    if (is_middle) x = 0.0L;
    LegendreValue p = legendre_value(count, x);
    for (int step = 0; step < 4 && !is_middle; ++step) {
      x -= p.value / p.derivative;
      p = legendre_value(count, x);
    }
    const auto weight = static_cast<double>(2.0L / ((1.0L - x) * (1.0L + x) * p.derivative * p.derivative));
    rule.nodes[size - 1 - k] = static_cast<double>(x);
    rule.nodes[k] = -static_cast<double>(x);
    rule.weights[size - 1 - k] = weight;
    rule.weights[k] = weight;
  }
  if (size % 2 == 1) rule.nodes[size / 2] = 0.0;
  return rule;
}

// A product of two functions of n bands has degree 2n - 2 in z, which n Gauss nodes integrate, and
// frequencies up to 2n - 2 in azimuth, which 2n - 1 or more uniform nodes integrate.
std::vector<SphereNode> sphere_quadrature(int bands) {
  require_bands(bands);
  const GaussLegendre rule = gauss_legendre(bands);
  const int columns = 2 * bands;
  std::vector<SphereNode> nodes;
  nodes.reserve(rule.nodes.size() * static_cast<std::size_t>(columns));
  for (std::size_t row = 0; row < rule.nodes.size(); ++row) {
    const double z = rule.nodes[row];
    const double radius = std::sqrt((1.0 - z) * (1.0 + z));
    for (int column = 0; column < columns; ++column) {
      const double phi = 2.0 * kPi * (column + 0.5) / columns;
      nodes.push_back({Vec3d(radius * std::cos(phi), radius * std::sin(phi), z),
                       rule.weights[row] * 2.0 * kPi / columns});
    }
  }
  return nodes;
}

}  // namespace plumbline::sh
