// The SH checks pass our own code and catch planted faults.
#include "validation/checks/sh_checks.hpp"

#include <gtest/gtest.h>

#include "prt/sh/basis.hpp"
#include "prt/sh/lighting.hpp"
#include "prt/sh/zonal.hpp"

namespace plumbline::checks {
namespace {

BasisUnderTest ours(int bands) {
  return [basis = sh::Basis<double>(bands)](const Vec3d& d) {
    std::vector<double> values(static_cast<std::size_t>(basis.coefficient_count()));
    basis.evaluate(d.x, d.y, d.z, values);
    return values;
  };
}
std::vector<RgbD> project(const light::Environment& environment, int bands) {
  return sh::project_radiance(environment, bands).coefficients;
}

/// Our basis with something done to its values.
BasisUnderTest broken(int bands, const std::function<void(std::vector<double>&, const Vec3d&)>& fault) {
  return [basis = ours(bands), fault](const Vec3d& d) {
    std::vector<double> values = basis(d);
    fault(values, d);
    return values;
  };
}

// Bounds: rounding of 800 weighted products of size up to 20, and the accuracy stated in basis.hpp.
constexpr double kGramBound = 1e-12;
constexpr double kBasisBound = 1e-13;

TEST(ShChecks, PassOurBasis) {
  for (const int bands : {1, 3, 5, 6, 10, 20}) {
    EXPECT_LE(gram_deviation(ours(bands), bands).value, kGramBound) << bands;
    EXPECT_LE(basis_deviation(ours(bands), bands).value, kBasisBound) << bands;
    EXPECT_LE(addition_theorem_deviation(ours(bands), bands), 1e-12) << bands;
  }
}

TEST(ShChecks, GramMatrixCatchesAWrongConstant) {
  const auto scaled = broken(6, [](std::vector<double>& y, const Vec3d&) { y[12] *= std::sqrt(2.0); });
  const GramDeviation deviation = gram_deviation(scaled, 6);
  EXPECT_LE(std::abs(deviation.value - 1.0), 1e-12);
  EXPECT_EQ(deviation.row, 12);
  EXPECT_EQ(deviation.column, 12);
  // The published slip: l = 3, m = +-1 with sqrt(21/16 pi) for sqrt(21/32 pi).
  const auto slip = broken(6, [](std::vector<double>& y, const Vec3d&) {
    y[11] *= std::sqrt(2.0);
    y[13] *= std::sqrt(2.0);
  });
  EXPECT_GE(gram_deviation(slip, 6).value, 0.9);
  EXPECT_GE(addition_theorem_deviation(slip, 6), 0.1);
}

TEST(ShChecks, GramMatrixCatchesAMissingFactorAndASignInsideAFunction) {
  // l = 4, m = -1 without its z.
  const auto no_z = broken(6, [](std::vector<double>& y, const Vec3d& d) { y[19] /= d.z; });
  EXPECT_GE(gram_deviation(no_z, 6).value, 0.1);
  // 3 z^2 + 1 for 3 z^2 - 1.
  const auto plus =
      broken(3, [](std::vector<double>& y, const Vec3d&) { y[6] += 2.0 * std::sqrt(5.0 / (16.0 * kPi)); });
  EXPECT_GE(gram_deviation(plus, 3).value, 0.1);
}

// The Gram matrix of functions with flipped signs or in another order is still the unit matrix.
TEST(ShChecks, ValuesCatchSignsAndOrderWhichTheGramMatrixCannot) {
  const auto flipped = broken(4, [](std::vector<double>& y, const Vec3d&) {
    y[5] = -y[5];
    y[7] = -y[7];
  });
  EXPECT_LE(gram_deviation(flipped, 4).value, kGramBound);
  const BasisDeviation sign = basis_deviation(flipped, 4);
  EXPECT_GE(sign.value, 0.1);
  EXPECT_TRUE(sign.index == 5 || sign.index == 7);
  const auto swapped = broken(4, [](std::vector<double>& y, const Vec3d&) { std::swap(y[1], y[3]); });
  EXPECT_LE(gram_deviation(swapped, 4).value, kGramBound);
  EXPECT_GE(basis_deviation(swapped, 4).value, 0.1);
}

TEST(ShChecks, NanIsNeverGood) {
  const auto nan = broken(3, [](std::vector<double>& y, const Vec3d& d) {
    if (d.x > 0.5) y[2] = std::nan("");
  });
  EXPECT_TRUE(std::isnan(gram_deviation(nan, 3).value));
  EXPECT_TRUE(std::isnan(basis_deviation(nan, 3).value));
  EXPECT_TRUE(std::isnan(addition_theorem_deviation(nan, 3)));
  EXPECT_TRUE(std::isnan(clamped_cosine_factor_error([](int l) { return l == 2 ? std::nan("") : 0.0; }, 5)));
}

TEST(ShChecks, TooFewValuesAreNeverGood) {
  EXPECT_TRUE(std::isnan(gram_deviation(ours(2), 3).value));
  EXPECT_TRUE(std::isnan(basis_deviation(ours(2), 3).value));
}

TEST(ShChecks, ClampedCosineFactors) {
  EXPECT_LE(clamped_cosine_factor_error(sh::clamped_cosine_factor, 20), 1e-14);
  const auto no_pi = [](int l) { return sh::clamped_cosine_factor(l) / kPi; };
  EXPECT_GE(clamped_cosine_factor_error(no_pi, 3), 1.0);
  const auto wrong_sign = [](int l) { return std::abs(sh::clamped_cosine_factor(l)); };
  EXPECT_GE(clamped_cosine_factor_error(wrong_sign, 5), 0.1);
}

TEST(ShChecks, PassOurProjection) {
  EXPECT_LE(white_projection_error(project, 6), 1e-14);
  EXPECT_LE(white_image_projection_error(project, 6), 1e-13);
  EXPECT_LE(cube_face_projection_error(project),
            63.0 * 1e-9);  // the texel rule's 1e-9 on faces that add up to 63
  // The sky answers in float.
  EXPECT_LE(polynomial_irradiance_error(project, ours(3), sh::clamped_cosine_factor), 3e-6);
}

TEST(ShChecks, CatchProjectionFaults) {
  using Fault = std::function<void(std::vector<RgbD>&)>;
  const auto with = [](const Fault& fault) -> ProjectionUnderTest {
    return [fault](const light::Environment& environment, int bands) {
      std::vector<RgbD> c = project(environment, bands);
      fault(c);
      return c;
    };
  };
  const Fault no_four_pi = [](std::vector<RgbD>& c) {
    for (RgbD& value : c) value /= 4.0 * kPi;
  };
  EXPECT_GE(white_projection_error(with(no_four_pi), 3), 1.0);
  EXPECT_GE(white_image_projection_error(with(no_four_pi), 3), 1.0);
  const Fault no_phase = [](std::vector<RgbD>& c) {
    for (const std::size_t i : {1U, 3U, 5U, 7U}) c[i] = -c[i];
  };
  const Fault y_up = [](std::vector<RgbD>& c) { std::swap(c[1], c[2]); };
  const Fault mirrored = [](std::vector<RgbD>& c) { c[3] = -c[3]; };
  for (const Fault& fault : {no_phase, y_up, mirrored}) {
    EXPECT_GE(cube_face_projection_error(with(fault)), 1.0);
    EXPECT_GE(polynomial_irradiance_error(with(fault), ours(3), sh::clamped_cosine_factor), 0.1);
  }
  const auto no_pi = [](int l) { return sh::clamped_cosine_factor(l) / kPi; };
  EXPECT_GE(polynomial_irradiance_error(project, ours(3), no_pi), 0.1);
}

}  // namespace
}  // namespace plumbline::checks
