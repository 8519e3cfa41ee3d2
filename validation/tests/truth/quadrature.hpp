// validation/tests/truth/quadrature.hpp: the second opinion on every closed form: plain numerical
// integration.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "reference/base/vector.hpp"

namespace plumbline::truth {

/// Gauss-Legendre nodes and weights on [0, 1] by Newton's method from Chebyshev's estimate.
struct Rule {
  std::vector<double> nodes;
  std::vector<double> weights;
};

inline Rule gauss(int count) {
  Rule rule;
  for (int i = 0; i < count; ++i) {
    double x = std::cos(kPi * (i + 0.75) / (count + 0.5));
    double slope = 1.0;
    for (int step = 0; step < 50; ++step) {
      double p = 1.0;
      double before = 0.0;
      for (int n = 1; n <= count; ++n) {
        const double next = ((2 * n - 1) * x * p - (n - 1) * before) / n;
        before = p;
        p = next;
      }
      slope = count * (x * p - before) / (x * x - 1.0);
      const double change = p / slope;
      x -= change;
      if (std::abs(change) < 1e-15) break;
    }
    rule.nodes.push_back((1.0 + x) / 2.0);
    rule.weights.push_back(1.0 / ((1.0 - x * x) * slope * slope));
  }
  return rule;
}

template <class Function>
double integrate(const Rule& rule, double low, double high, const Function& f) {
  double sum = 0.0;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    sum += rule.weights[i] * f(low + (high - low) * rule.nodes[i]);
  }
  return sum * (high - low);
}

/// Trapezoidal rule over a full turn, nodes at half steps: converges exponentially for smooth periodic f.
template <class Function>
double integrate_turn(int count, const Function& f) {
  double sum = 0.0;
  for (int i = 0; i < count; ++i) sum += f(2.0 * kPi * (i + 0.5) / count);
  return sum * 2.0 * kPi / count;
}

/// What a small patch of area 1 at `to` sends to a receiver at `from`: cos cos'/(pi d^2).
inline double kernel(const Vec3d& from, const Vec3d& normal, const Vec3d& to, const Vec3d& patch_normal) {
  const Vec3d way = to - from;
  const double d2 = glm::dot(way, way);
  return glm::dot(normal, way) * -glm::dot(patch_normal, way) / (kPi * d2 * d2);
}

/// Equal to every digit that a published number shows: half a unit of its last place (and 1e-15 for
/// rounding).
inline void expect_digits(double value, const std::string& published) {
  const double expected = std::stod(published);
  const std::size_t exponent_at = published.find('e');
  const std::string mantissa = published.substr(0, exponent_at);
  const std::size_t point = mantissa.find('.');
  const auto decimals = point == std::string::npos ? 0 : static_cast<int>(mantissa.size() - point) - 1;
  const int exponent = exponent_at == std::string::npos ? 0 : std::stoi(published.substr(exponent_at + 1));
  const double tolerance = 0.5 * std::pow(10.0, exponent - decimals) * (1.0 + 1e-3) + 1e-15;
  EXPECT_LE(std::abs(value - expected), tolerance) << value << " against " << published;
}

}  // namespace plumbline::truth
