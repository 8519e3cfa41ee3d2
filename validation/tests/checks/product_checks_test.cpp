#include "validation/checks/product_checks.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "prt/sh/basis.hpp"
#include "prt/sh/exponential.hpp"
#include "prt/sh/logarithm.hpp"
#include "prt/sh/product.hpp"
#include "validation/checks/exponential_study.hpp"
#include "validation/checks/suite.hpp"

namespace plumbline::checks {
namespace {

using Vector = std::vector<double>;

Vector our_product(const Vector& a, const Vector& b) {
  return sh::product(a, b);
}

TEST(ProductChecks, PassOurOwn) {
  for (int bands = 2; bands <= 8; ++bands) EXPECT_LE(product_deviation(our_product, bands), 1e-13);
  EXPECT_LE(constant_exponential_deviation([](const Vector& f) { return sh::exponential(f); }, 4), 1e-14);
  EXPECT_LE(constant_logarithm_deviation([](const Vector& f) { return sh::logarithm(f).coefficients; }, 4),
            1e-14);
  EXPECT_LE(series_limit_deviation([](const Vector& f) { return sh::exponential_series(f, 30); }, 4), 1e-12);
}

// A published product of two bands confused y w, z w and w w.
TEST(ProductChecks, SeeConfusedCrossTerms) {
  const auto product = [](const Vector& a, const Vector& b) {
    Vector c = sh::product(a, b);
    c[1] = sh::tripling_coefficient(0, 0, 0) * (a[1] * b[0] + a[0] * b[2]);
    return c;
  };
  EXPECT_GT(product_deviation(product, 2), 0.05);
}

TEST(ProductChecks, SeeOneWrongConstant) {
  const auto product = [](const Vector& a, const Vector& b) {
    Vector c = sh::product(a, b);
    c[20] += 1e-5 * a[6] * b[6];
    return c;
  };
  EXPECT_GT(product_deviation(product, 5), 1e-7);
}

TEST(ProductChecks, SeeAWrongMean) {  // sqrt(4 / pi) for sqrt(4 pi)
  const auto exponential = [](const Vector& f) {
    Vector hat = f;
    hat[0] = 0.0;
    Vector result = sh::exponential(hat);
    for (double& value : result) value *= std::exp(f[0] / std::sqrt(4.0 / kPi));
    return result;
  };
  EXPECT_GT(constant_exponential_deviation(exponential, 4), 0.1);
}

TEST(ProductChecks, SeeAnIntegerDivision) {  // 1 / k of integers ends the series after f
  const auto exponential = [](const Vector& f) { return sh::exponential_series(f, 1); };
  EXPECT_GT(series_limit_deviation(exponential, 4), 0.01);
  EXPECT_GT(constant_exponential_deviation(exponential, 4), 0.1);
}

TEST(ProductChecks, SeeAWrongLogarithm) {
  const auto decimal = [](const Vector& f) {
    Vector result = sh::logarithm(f).coefficients;
    for (double& value : result) value /= std::log(10.0);
    return result;
  };
  EXPECT_GT(constant_logarithm_deviation(decimal, 4), 0.1);
}

TEST(ProductChecks, NanIsNoPass) {
  const auto nothing = [](const Vector& f) { return Vector(f.size(), std::nan("")); };
  EXPECT_TRUE(std::isnan(constant_exponential_deviation(nothing, 4)));
  EXPECT_TRUE(std::isnan(constant_logarithm_deviation(nothing, 4)));
  EXPECT_TRUE(std::isnan(series_limit_deviation(nothing, 4)));
  EXPECT_TRUE(std::isnan(product_deviation([&](const Vector& a, const Vector&) { return nothing(a); }, 4)));
}

TEST(ExponentialStudy, CoversEveryAngleAndUpTo100Spheres) {
  const std::vector<StudyCase> singles = study_single_spheres(3);
  ASSERT_EQ(singles.size(), 45U);
  EXPECT_EQ(singles.front().parameter, 1.0);
  EXPECT_EQ(singles.back().parameter, 89.0);
  const std::vector<StudyCase> many = study_accumulations(3, 1, 1);
  ASSERT_EQ(many.size(), 7U);
  EXPECT_EQ(many.back().parameter, 100.0);
  for (const StudyCase& one : many) EXPECT_EQ(one.errors.size(), exponential_methods().size());
}

TEST(ExponentialStudy, SameSeedGivesTheSameNumbers) {
  const std::vector<StudyCase> one = study_accumulations(3, 1, 7);
  const std::vector<StudyCase> same = study_accumulations(3, 1, 7);
  const std::vector<StudyCase> other = study_accumulations(3, 1, 8);
  EXPECT_EQ(one[3].magnitude, same[3].magnitude);
  EXPECT_EQ(one[3].product_visibility_error, same[3].product_visibility_error);
  EXPECT_NE(one[3].magnitude, other[3].magnitude);
}

TEST(ExponentialFamily, HasNoFailureAndShowsTheStudy) {
  Suite suite;
  suite.bands = {3};
  report::Report report;
  check_exponential(suite, report);
  EXPECT_GE(report.findings.size(), 20U);
  for (const Finding& finding : report.findings)
    EXPECT_EQ(report::verdict(finding), Verdict::pass) << finding.name << " " << finding.measured;
  EXPECT_EQ(report.charts.size(), 4U);  // 3 bands and the papers' 4
  EXPECT_EQ(report.tables.size(), 11U);
}

}  // namespace
}  // namespace plumbline::checks
