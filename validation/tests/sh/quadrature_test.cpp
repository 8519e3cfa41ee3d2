#include "prt/sh/quadrature.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "reference/base/error.hpp"

namespace plumbline::sh {
namespace {

TEST(GaussLegendre, MatchesTheTabulatedRules) {
  const GaussLegendre two = gauss_legendre(2);
  EXPECT_LE(std::abs(two.nodes[1] - 1.0 / std::sqrt(3.0)), 2e-16);
  EXPECT_LE(std::abs(two.weights[0] - 1.0), 2e-16);
  const GaussLegendre three = gauss_legendre(3);
  EXPECT_EQ(three.nodes[1], 0.0);
  EXPECT_LE(std::abs(three.nodes[2] - std::sqrt(0.6)), 2e-16);
  EXPECT_LE(std::abs(three.weights[1] - 8.0 / 9.0), 2e-16);
  EXPECT_LE(std::abs(three.weights[0] - 5.0 / 9.0), 2e-16);
  // Abramowitz & Stegun, table 25.4, n = 12.
  const GaussLegendre twelve = gauss_legendre(12);
  EXPECT_LE(std::abs(twelve.nodes[11] - 0.981560634246719), 1e-15);
  EXPECT_LE(std::abs(twelve.weights[11] - 0.047175336386512), 1e-15);
}

TEST(GaussLegendre, IntegratesPowersExactly) {
  for (const int count : {1, 2, 3, 7, 16, 33}) {
    const GaussLegendre rule = gauss_legendre(count);
    for (int power = 0; power <= 2 * count - 1; ++power) {
      double sum = 0.0;
      for (std::size_t k = 0; k < rule.nodes.size(); ++k)
        sum += rule.weights[k] * std::pow(rule.nodes[k], power);
      const double expected = power % 2 == 1 ? 0.0 : 2.0 / (power + 1.0);
      // A sum of `count` terms whose magnitudes add up to at most 2.
      EXPECT_LE(std::abs(sum - expected), 1e-15 * count) << "count=" << count << " power=" << power;
    }
  }
}

TEST(GaussLegendre, IsNotExactBeyondItsDegree) {
  const GaussLegendre rule = gauss_legendre(3);
  double sum = 0.0;
  for (std::size_t k = 0; k < 3; ++k) sum += rule.weights[k] * std::pow(rule.nodes[k], 6);
  EXPECT_GE(std::abs(sum - 2.0 / 7.0), 0.01);
}

TEST(GaussLegendre, IsAscendingSymmetricAndSumsToTwoUpTo2000Nodes) {
  for (const int count : {1, 2, 5, 64, 501, 2000}) {
    const GaussLegendre rule = gauss_legendre(count);
    double sum = 0.0;
    const std::size_t size = rule.nodes.size();
    for (std::size_t k = 0; k < size; ++k) {
      sum += rule.weights[k];
      EXPECT_EQ(rule.nodes[k], -rule.nodes[size - 1 - k]);
      EXPECT_LE(std::abs(rule.nodes[k]), 1.0);
      EXPECT_TRUE(k == 0 || rule.nodes[k - 1] < rule.nodes[k]) << k;
    }
    EXPECT_LE(std::abs(sum - 2.0), 1e-14) << count;
  }
  EXPECT_THROW(static_cast<void>(gauss_legendre(0)), InputError);
}

TEST(SphereQuadrature, HasUnitDirectionsAndTheSpheresArea) {
  for (const int bands : {1, 2, 5, 20}) {
    double sum = 0.0;
    for (const SphereNode& node : sphere_quadrature(bands)) {
      EXPECT_LE(std::abs(glm::length(node.direction) - 1.0), 1e-15);
      EXPECT_GT(node.weight, 0.0);
      sum += node.weight;
    }
    EXPECT_LE(std::abs(sum - 4.0 * kPi), 1e-13) << bands;
  }
}

// integral of x^a y^b z^c = 4 pi (a-1)!! (b-1)!! (c-1)!! / (a+b+c+1)!! for even powers, else 0.
TEST(SphereQuadrature, IntegratesMonomialsUpToTwiceTheDegree) {
  const auto odd_factorial = [](int n) {
    double result = 1.0;
    for (int k = n; k > 1; k -= 2) result *= k;
    return result;
  };
  constexpr int kBands = 5;
  for (int a = 0; a <= 8; ++a) {
    for (int b = 0; a + b <= 8; ++b) {
      for (int c = 0; a + b + c <= 8; ++c) {
        double sum = 0.0;
        for (const SphereNode& node : sphere_quadrature(kBands)) {
          sum += node.weight * std::pow(node.direction.x, a) * std::pow(node.direction.y, b) *
                 std::pow(node.direction.z, c);
        }
        const bool is_odd = a % 2 == 1 || b % 2 == 1 || c % 2 == 1;
        const double expected = is_odd ? 0.0
                                       : 4.0 * kPi * odd_factorial(a - 1) * odd_factorial(b - 1) *
                                             odd_factorial(c - 1) / odd_factorial(a + b + c + 1);
        EXPECT_LE(std::abs(sum - expected), 1e-13) << a << b << c;
      }
    }
  }
}

}  // namespace
}  // namespace plumbline::sh
