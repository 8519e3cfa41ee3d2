#include "prt/sh/zonal.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "prt/sh/basis.hpp"
#include "prt/sh/quadrature.hpp"
#include "reference/base/error.hpp"
#include "validation/tests/sh/oracle.hpp"

namespace plumbline::sh {
namespace {

/// Irradiance of a light of irradiance 1 from `light` on a surface facing `normal`, both truncated to
/// `bands`.
double delta_irradiance(int bands, const Vec3d& light, const Vec3d& normal) {
  const std::vector<double> y_light = evaluate_basis(bands, light);
  const std::vector<double> y_normal = evaluate_basis(bands, normal);
  double sum = 0.0;
  for (int l = 0; l < bands; ++l) {
    for (int m = -l; m <= l; ++m) {
      const auto i = static_cast<std::size_t>(index(l, m));
      sum += clamped_cosine_factor(l) * y_light[i] * y_normal[i];
    }
  }
  return sum;
}

TEST(ClampedCosine, HasTheKnownFactors) {
  const std::vector<double> expected{kPi, 2.0 * kPi / 3.0, kPi / 4.0, 0.0,         -kPi / 24.0,
                                     0.0, kPi / 64.0,      0.0,       -kPi / 128.0};
  for (std::size_t l = 0; l < expected.size(); ++l) {
    EXPECT_LE(std::abs(clamped_cosine_factor(static_cast<int>(l)) - expected[l]), 1e-15) << l;
  }
  EXPECT_THROW(static_cast<void>(clamped_cosine_factor(-1)), InputError);
}

TEST(ClampedCosine, HasTheKnownZonalCoefficients) {
  const std::vector<double> expected{.886226925453,  1.02332670795, .495415912201,  0.0, -.110778365682, 0.0,
                                     .0499271347096, 0.0,           -.0285469314212};
  const std::vector<double> zonal = clamped_cosine(9);
  ASSERT_EQ(zonal.size(), expected.size());
  for (std::size_t l = 0; l < expected.size(); ++l) EXPECT_LE(std::abs(zonal[l] - expected[l]), 6e-12) << l;
}

// The whole energy is the integral of max(0, z)^2, 2 pi / 3.
TEST(ClampedCosine, CapturesTheKnownEnergy) {
  const std::vector<double> zonal = clamped_cosine(7);
  double energy = 0.0;
  std::vector<double> captured;
  for (const double z : zonal) captured.push_back(energy += z * z / (2.0 * kPi / 3.0));
  EXPECT_LE(std::abs(captured[1] - 0.875), 1e-15);
  EXPECT_LE(std::abs(captured[2] - 0.9921875), 1e-15);
  EXPECT_LE(std::abs(captured[4] - 0.998046875), 1e-15);
  EXPECT_LE(std::abs(captured[6] - 0.9992370605), 1e-10);
}

TEST(ClampedCosine, TruncatedDeltaLightRingsAsItMust) {
  const Vec3d light = glm::normalize(Vec3d(1.0, -2.0, 0.5));
  const Vec3d across = glm::normalize(glm::cross(light, Vec3d(0.0, 0.0, 1.0)));
  EXPECT_LE(std::abs(delta_irradiance(3, light, light) - 17.0 / 16.0), 1e-14);
  EXPECT_LE(std::abs(delta_irradiance(5, light, light) - 31.0 / 32.0), 1e-14);
  EXPECT_LE(std::abs(delta_irradiance(7, light, light) - 261.0 / 256.0), 1e-14);
  EXPECT_LE(std::abs(delta_irradiance(9, light, light) - 505.0 / 512.0), 1e-14);
  EXPECT_LE(std::abs(delta_irradiance(3, light, across) - 0.09375), 1e-14);
  EXPECT_LE(std::abs(std::abs(delta_irradiance(5, light, across)) - 0.05859375), 1e-14);
  EXPECT_LE(std::abs(std::abs(delta_irradiance(7, light, across)) - 0.04272), 5e-6);
  double lowest = 1.0;
  for (int i = 0; i <= 1800; ++i) {
    const double angle = kPi * i / 1800.0;
    lowest = std::min(lowest, delta_irradiance(3, light, std::cos(angle) * light + std::sin(angle) * across));
  }
  EXPECT_LE(std::abs(lowest + 0.03958), 5e-6);
}

// A delta light's radiance scaled so that a facing surface has exit radiance 1 at albedo 1.
TEST(ClampedCosine, GivesTheDirectionalLightNormalisation) {
  const Vec3d up(0.0, 0.0, 1.0);
  EXPECT_LE(std::abs(kPi / delta_irradiance(3, up, up) - 2.95679308573), 5e-12);
  EXPECT_LE(std::abs(kPi / delta_irradiance(5, up, up) - 3.24293435209), 5e-12);
}

void expect_cap(double half_angle_rad, const std::vector<double>& expected, double relative) {
  const std::vector<double> zonal = cap(static_cast<int>(expected.size()), half_angle_rad);
  for (std::size_t l = 0; l < expected.size(); ++l) {
    EXPECT_LE(std::abs(zonal[l] - expected[l]), relative * std::abs(expected[l]) + 1e-15)
        << "l=" << l << " angle=" << half_angle_rad;
  }
}
TEST(Cap, HasTheKnownCoefficients) {
  expect_cap(kPi / 6.0,
             {.237463788986, .383747515480, .429042765405, .403001508580, .323786966186, .212409064572},
             3e-12);
  expect_cap(kPi / 2.0, {1.77245385091, 1.53499006192, 0.0, -.586184012479, 0.0, .367410273855}, 3e-12);
  expect_cap(.2665 * kPi / 180.0, {1.91731433623e-5, 3.32086788294e-5, 4.28717562575e-5, 5.07257230052e-5},
             1e-11);
}

TEST(Cap, KeepsItsDigitsForTinyDiscs) {
  // The limit: solid angle times y_l0(0), with a relative error of l(l+1) a^2 / 8.
  const double a = 1e-9;
  const std::vector<double> zonal = cap(20, a);
  for (int l = 0; l < 20; ++l) {
    const double expected = kPi * a * a * std::sqrt((2.0 * l + 1.0) / (4.0 * kPi));
    EXPECT_LE(std::abs(zonal[static_cast<std::size_t>(l)] / expected - 1.0), 1e-14) << l;
  }
}

TEST(Cap, IsTheWholeSphereAtPi) {
  const std::vector<double> zonal = cap(10, kPi);
  EXPECT_LE(std::abs(zonal[0] - std::sqrt(4.0 * kPi)), 1e-15);
  for (std::size_t l = 1; l < 10; ++l) EXPECT_LE(std::abs(zonal[l]), 1e-28) << l;
}

TEST(Cap, AndItsComplementAddUpToTheSphere) {
  const std::vector<double> near = cap(12, 0.4);
  const std::vector<double> rest = cap(12, kPi - 0.4);
  for (std::size_t l = 0; l < 12; ++l) {
    const double mirrored = l % 2 == 0 ? rest[l] : -rest[l];
    EXPECT_LE(std::abs(near[l] + mirrored - (l == 0 ? std::sqrt(4.0 * kPi) : 0.0)), 2e-15 * 12.0) << l;
  }
}

TEST(Cap, RefusesAnglesOutsideItsRange) {
  for (const double angle : {0.0, -1.0, 3.2, std::nan("")}) {
    EXPECT_THROW(static_cast<void>(cap(3, angle)), InputError) << angle;
  }
}

TEST(Legendre, MatchesTheFirstPolynomials) {
  const double x = 0.3;
  const std::vector<double> p = legendre(5, x);
  const std::vector<double> expected{1.0, x, 1.5 * x * x - 0.5, 2.5 * x * x * x - 1.5 * x,
                                     (35.0 * x * x * x * x - 30.0 * x * x + 3.0) / 8.0};
  ASSERT_EQ(p.size(), expected.size());
  for (std::size_t l = 0; l < 5; ++l) EXPECT_LE(std::abs(p[l] - expected[l]), 1e-15);
  EXPECT_TRUE(legendre(0, x).empty());
}

// f(w) = cap about d, projected by brute force on one function at a time.
TEST(RotateZonal, MatchesTheAdditionTheorem) {
  const std::vector<double> zonal{0.7, -0.4, 1.1, 0.2, 0.9};
  const Vec3d axis = glm::normalize(Vec3d(0.3, -0.8, 0.4));
  const std::vector<double> rotated = rotate_zonal(zonal, axis);
  for (const Vec3d& w : sh_test::directions(20, 3)) {
    const std::vector<double> y = evaluate_basis(5, w);
    const std::vector<double> p = legendre(5, glm::dot(axis, w));
    double value = 0.0;
    double expected = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i) value += rotated[i] * y[i];
    for (std::size_t l = 0; l < 5; ++l) {
      expected += zonal[l] * std::sqrt((2.0 * static_cast<double>(l) + 1.0) / (4.0 * kPi)) * p[l];
    }
    EXPECT_LE(std::abs(value - expected), 2e-15 * 25.0);
  }
}

TEST(RotateZonal, TurnsDegreeTwoFromZToX) {
  const std::vector<double> rotated = rotate_zonal({0.0, 0.0, 1.0}, Vec3d(1.0, 0.0, 0.0));
  EXPECT_LE(std::abs(rotated[6] + 0.5), 1e-15);
  EXPECT_LE(std::abs(rotated[8] - std::sqrt(3.0) / 2.0), 1e-15);
}

TEST(ClampedCosinePower, HasTheKnownMoments) {
  const std::vector<double> fifth{1.0 / 6.0, 1.0 / 7.0, 5.0 / 48.0, 4.0 / 63.0, 1.0 / 32.0};
  const std::vector<double> zonal = clamped_cosine_power(5, 5.0);
  for (std::size_t l = 0; l < fifth.size(); ++l) {
    const double scale = std::sqrt(kPi * (2.0 * static_cast<double>(l) + 1.0));
    EXPECT_LE(std::abs(zonal[l] / scale - fifth[l]), 1e-15) << l;
  }
  const std::vector<double> cosine = clamped_cosine(12);
  const std::vector<double> first = clamped_cosine_power(12, 1.0);
  const std::vector<double> hemisphere = cap(12, kPi / 2.0);
  const std::vector<double> zeroth = clamped_cosine_power(12, 0.0);
  for (std::size_t l = 0; l < cosine.size(); ++l) {
    EXPECT_LE(std::abs(first[l] - cosine[l]), 1e-15) << l;
    EXPECT_LE(std::abs(zeroth[l] - hemisphere[l]), 1e-14) << l;
  }
  EXPECT_THROW(static_cast<void>(clamped_cosine_power(3, -0.5)), InputError);
}

// The thesis's own formula at 2000 Gauss nodes in the angle, up to where it reaches 0.
TEST(FormFactorLobe, IsThatOfTheFormula) {
  const GaussLegendre rule = gauss_legendre(2000);
  for (const double theta : {1e-6, 0.1, 0.7, 1.5}) {
    const double s = std::sin(theta);
    std::vector<double> expected(12, 0.0);
    const double range = std::acos(s);
    for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
      const double a = 0.5 * range * (1.0 + rule.nodes[k]);
      const double lobe = std::max(0.0, std::sin(std::atan((1.0 - s * std::cos(a)) / (s * std::sin(a))) - a));
      const std::vector<double> p = legendre(12, std::cos(a));
      for (std::size_t l = 0; l < 12; ++l) {
        expected[l] += kPi * range * rule.weights[k] * std::sin(a) * lobe * p[l] *
                       std::sqrt((2.0 * static_cast<double>(l) + 1.0) / (4.0 * kPi));
      }
    }
    const double total = expected[0] * std::sqrt(4.0 * kPi);
    const std::vector<double> zonal = form_factor_lobe(12, theta);
    for (std::size_t l = 0; l < 12; ++l) {
      EXPECT_LE(std::abs(zonal[l] - expected[l] / total), 1e-9) << theta << " " << l;
    }
  }
}

TEST(FormFactorLobe, AveragesAConstantToItselfAndTendsToTheCosine) {
  for (const double theta : {1e-9, 0.3, 1.57}) {
    EXPECT_LE(std::abs(form_factor_lobe(8, theta)[0] * std::sqrt(4.0 * kPi) - 1.0), 1e-15) << theta;
  }
  const std::vector<double> small = form_factor_lobe(8, 1e-9);
  const std::vector<double> cosine = clamped_cosine(8);
  for (std::size_t l = 0; l < 8; ++l) EXPECT_LE(std::abs(small[l] - cosine[l] / kPi), 1e-8) << l;
  EXPECT_THROW(static_cast<void>(form_factor_lobe(3, 0.0)), InputError);
  EXPECT_THROW(static_cast<void>(form_factor_lobe(3, kPi / 2.0)), InputError);
}

}  // namespace
}  // namespace plumbline::sh
