#include "prt/sh/logarithm.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "prt/sh/basis.hpp"
#include "prt/sh/zonal.hpp"
#include "reference/base/error.hpp"

namespace plumbline::sh {
namespace {

const double kRoot = std::sqrt(4.0 * kPi);

std::vector<double> linear_function(int bands, double a, double b) {  // a + b z
  std::vector<double> f(static_cast<std::size_t>(coefficient_count(bands)), 0.0);
  f[0] = a * kRoot;
  f[2] = b * std::sqrt(4.0 * kPi / 3.0);
  return f;
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

TEST(ShLogarithm, OfAConstantIsExact) {
  for (const double a : {-2.5, -1.0, 0.0, 0.5, 3.0}) {
    const Logarithm log = logarithm(linear_function(4, std::exp(a), 0.0));
    EXPECT_LE(distance(log.coefficients, linear_function(4, a, 0.0)), 1e-14);
    EXPECT_EQ(log.clipped, 0);
    EXPECT_EQ(log.eigenvalues, 16);
  }
}

// log(exp f) is f only in the limit of many bands: the residual must fall, and it is not 0.
TEST(ShLogarithm, OfTheExponentialTendsToTheFunction) {
  std::vector<double> residuals;
  for (int bands = 2; bands <= 8; ++bands) {
    const std::vector<double> f = linear_function(bands, -1.0, 0.7);
    const Logarithm log = logarithm(exponential_by_quadrature(f).coefficients);
    EXPECT_EQ(log.clipped, 0);
    residuals.push_back(distance(log.coefficients, f));
  }
  EXPECT_GT(residuals.front(), 1e-3);
  for (std::size_t i = 1; i < residuals.size(); ++i) EXPECT_LT(residuals[i], residuals[i - 1]);
  EXPECT_LE(residuals.back(), 1e-6);
}

TEST(ShLogarithm, MatchesThePointwiseLogarithmOfASmoothFunction) {
  const std::vector<double> g = linear_function(8, 1.0, 0.4);
  const Logarithm oracle = logarithm_by_quadrature(g);
  EXPECT_EQ(oracle.clipped, 0);
  EXPECT_LE(std::abs(oracle.smallest - 0.6), 1e-3);
  EXPECT_LE(distance(logarithm(g).coefficients, oracle.coefficients), 1e-5);
}

// log x and log(1 + h) h with a missing sign: seen by the constant.
TEST(ShLogarithm, ConstantSeesAForgottenOne) {
  const std::vector<double> g = linear_function(4, 2.0, 0.0);
  std::vector<double> wrong = logarithm(g).coefficients;  // q(D) applied to g in place of g - 1
  for (double& value : wrong) value *= 2.0 / (2.0 - 1.0);
  EXPECT_GT(distance(wrong, linear_function(4, std::log(2.0), 0.0)), 0.1);
}

TEST(ShLogarithm, ZonalFormMatchesTheGeneralOne) {
  for (int bands = 1; bands <= 6; ++bands) {
    for (const double radius : {0.05, 0.6, 1.3}) {
      const std::vector<double> zonal = sphere_visibility(bands, radius);
      const Vec3d axis = glm::normalize(Vec3d(1.0, -2.0, 0.5));
      const Logarithm one = zonal_logarithm(zonal);
      const Logarithm other = logarithm(rotate_zonal(zonal, axis));
      EXPECT_LE(distance(rotate_zonal(one.coefficients, axis), other.coefficients), 1e-10) << bands;
      EXPECT_LE(std::abs(one.energy - other.energy), 1e-10);
    }
  }
}

TEST(ShLogarithm, SaysHowMuchItClipped) {
  EXPECT_EQ(logarithm(linear_function(4, 1.0, 0.5)).clipped, 0);
  const Logarithm part = logarithm(linear_function(4, 0.2, 1.0));
  EXPECT_GT(part.clipped, 0);
  EXPECT_LT(part.clipped, 16);
  EXPECT_LT(part.smallest, 0.0);
  EXPECT_GT(part.energy, 0.1);
  EXPECT_LT(part.energy, 0.9);
  const Logarithm all = logarithm(linear_function(4, -1.0, 0.0));
  EXPECT_EQ(all.clipped, 16);
  EXPECT_LE(std::abs(all.energy - 1.0), 1e-14);
  for (const double value : all.coefficients) EXPECT_TRUE(std::isfinite(value));
  const Logarithm points = logarithm_by_quadrature(linear_function(4, 0.2, 1.0));
  EXPECT_LE(std::abs(points.energy - (1.0 - 0.2 + kDefaultFloor) / 2.0), 0.01);  // z < floor - 0.2
}

// All eigenvalues are 0: log(floor) (0 - 1)/(floor - 1).
TEST(ShLogarithm, OfZeroIsTheFloors) {
  const Logarithm log = logarithm(std::vector<double>(16, 0.0), 0.01);
  EXPECT_EQ(log.clipped, 16);
  EXPECT_LE(distance(log.coefficients, linear_function(4, std::log(0.01) / 0.99, 0.0)), 1e-13);
}

TEST(ShLogarithm, TakesEveryScale) {
  for (const double scale : {1e-30, 1e30}) {
    const Logarithm log = logarithm(linear_function(4, scale, 0.5 * scale), 1e-40);
    EXPECT_EQ(log.clipped, 0);
    const Logarithm unit = logarithm(linear_function(4, 1.0, 0.5), 1e-40);
    std::vector<double> expected = unit.coefficients;
    expected[0] += std::log(scale) * kRoot;
    EXPECT_LE(distance(log.coefficients, expected), 1e-11);
  }
}

TEST(ShLogarithm, RefusesWhatHasNone) {
  const std::vector<double> g = linear_function(3, 1.0, 0.0);
  EXPECT_THROW(static_cast<void>(logarithm(g, 0.0)), InputError);
  EXPECT_THROW(static_cast<void>(logarithm(g, -1.0)), InputError);
  EXPECT_THROW(static_cast<void>(logarithm(g, std::numeric_limits<double>::quiet_NaN())), InputError);
  EXPECT_THROW(static_cast<void>(logarithm(std::vector<double>(5, 1.0))), InputError);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    std::vector<double> spoilt = g;
    spoilt[4] = bad;
    EXPECT_THROW(static_cast<void>(logarithm(spoilt)), InputError);
    EXPECT_THROW(static_cast<void>(logarithm_by_quadrature(spoilt)), InputError);
    EXPECT_THROW(static_cast<void>(zonal_logarithm({1.0, bad})), InputError);
  }
}

TEST(ShLogarithm, SphereVisibilityIsOneOutsideTheCone) {
  const std::vector<double> zonal = sphere_visibility(4, 0.5);
  EXPECT_LE(std::abs(zonal[0] / kRoot - (1.0 - 0.5 * (1.0 - std::cos(0.5)))), 1e-15);
  EXPECT_THROW(static_cast<void>(sphere_visibility(4, 0.0)), InputError);
}

}  // namespace
}  // namespace plumbline::sh
