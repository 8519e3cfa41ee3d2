// Implementations in other conventions are judged as well as our own; undeclared ones are told from the basis.
#include "validation/conformance/border.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "validation/checks/sh_checks.hpp"
#include "validation/conformance/adapters/plumbline_sh.hpp"
#include "validation/conformance/check.hpp"
#include "validation/conformance/truths.hpp"

namespace plumbline::conformance {
namespace {

plumbline_convention positive_y_up() {
  plumbline_convention c = own_convention();
  c.index_order = PLUMBLINE_INDEX_ZERO_FIRST;
  c.sign = PLUMBLINE_SIGN_POSITIVE;
  c.norm = PLUMBLINE_NORM_FOUR_PI;
  c.axes[0] = 3;
  c.axes[1] = 1;
  c.axes[2] = 2;
  return c;
}

plumbline_convention unity_like() {
  plumbline_convention c = own_convention();
  c.sign = PLUMBLINE_SIGN_POSITIVE;
  c.norm = PLUMBLINE_NORM_POLYNOMIAL;
  c.quantity = PLUMBLINE_QUANTITY_IRRADIANCE_OVER_PI;
  c.layout = PLUMBLINE_LAYOUT_PLANAR;
  return c;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double result = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) result = std::max(result, std::abs(a[i] - b[i]));
  return a.size() == b.size() ? result : std::nan("");
}

TEST(Border, BringsCoefficientsThereAndBack) {
  for (const plumbline_convention& convention : {own_convention(), positive_y_up(), unity_like()}) {
    const Border border(convention, 3);
    const std::vector<double> c = truths::some_values(9, 1);
    const std::vector<double> t = truths::some_values(9, 2);
    EXPECT_LE(largest_difference(border.to_ours(3, border.to_theirs(3, c)), c), 1e-13);
    EXPECT_LE(largest_difference(border.dual_to_ours(3, border.dual_to_theirs(3, t)), t), 1e-13);
    double ours = 0.0;
    double theirs = 0.0;
    for (std::size_t i = 0; i < 9; ++i) {
      ours += c[i] * t[i];
      theirs += border.to_theirs(3, c)[i] * border.dual_to_theirs(3, t)[i];
    }
    EXPECT_NEAR(theirs, ours, 1e-13);
  }
}

// f(w) = sum c y is the same sum in any convention of radiance.
TEST(Border, TheFunctionStaysTheSame) {
  const Border border(positive_y_up(), 4);
  const std::vector<double> c = truths::some_values(16, 3);
  const std::vector<double> theirs = border.to_theirs(4, c);
  for (const Vec3d& d : checks::probe_directions()) {
    const std::vector<double> y = convention_basis(positive_y_up(), 4, d);
    double sum = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i) sum += theirs[i] * y[i];
    EXPECT_NEAR(sum, truths::value(c, d), 1e-13);
    EXPECT_LE(largest_difference(border.basis_to_ours(4, y), truths::basis(4, d)), 1e-13);
  }
}

TEST(Border, TellsTheConventionFromTheBasis) {
  const std::vector<Vec3d> directions = checks::probe_directions();
  for (plumbline_convention convention : {own_convention(), positive_y_up(), unity_like()}) {
    std::vector<double> values;
    for (const Vec3d& d : directions) {
      const std::vector<double> y = convention_basis(convention, 3, d);
      values.insert(values.end(), y.begin(), y.end());
    }
    const auto found = convention_of_basis(directions, values);
    ASSERT_TRUE(found.has_value());
    // Another convention may have the very same functions (a turn about z for a sign): those are what counts.
    for (const Vec3d& d : directions)
      EXPECT_LE(largest_difference(convention_basis(*found, 3, d), convention_basis(convention, 3, d)),
                1e-12);
    values[5] += 1.0;
    EXPECT_FALSE(convention_of_basis(directions, values).has_value());
  }
}

// ---------------------------------------------------------------- judged through the interface
int foreign_basis(std::int32_t bands, std::size_t count, const double* directions, double* values) {
  for (std::size_t k = 0; k < count; ++k, directions += 3)
    for (const double v :
         convention_basis(positive_y_up(), bands, {directions[0], directions[1], directions[2]}))
      *values++ = v;
  return 0;
}

int foreign_rotate(std::int32_t bands, const double* matrix, const double* in, double* out) {
  const Border border(positive_y_up(), bands);
  const auto count = static_cast<std::size_t>(bands * bands);
  std::vector<double> turned(count);
  const int status =
      plumbline_sh().rotate(bands, matrix, border.to_ours(bands, {in, in + count}).data(), turned.data());
  const std::vector<double> result = border.to_theirs(bands, turned);
  std::copy(result.begin(), result.end(), out);
  return status;
}

plumbline_implementation foreign(const plumbline_convention& declared) {
  plumbline_implementation result{};
  result.struct_size = sizeof(result);
  result.abi_version = PLUMBLINE_CONFORMANCE_VERSION;
  result.name = "foreign";
  result.precision = PLUMBLINE_PRECISION_DOUBLE;
  result.max_bands = 5;
  result.convention = declared;
  result.evaluate_basis = foreign_basis;
  result.rotate = foreign_rotate;
  return result;
}

int failures(const plumbline_implementation& implementation) {
  int count = 0;
  for (const Check& check : all_checks()) {
    if (!check.applies(implementation)) continue;
    for (const Judged& result : run_check(check, implementation, 5))
      count += result.finding.verdict == checks::Verdict::pass ? 0 : 1;
  }
  return count;
}

TEST(Conformance, AForeignConventionPassesWhenDeclared) {
  EXPECT_EQ(failures(foreign(positive_y_up())), 0);
}

TEST(Conformance, AnUndeclaredConventionIsToldFromTheBasis) {
  plumbline_convention unknown{};
  unknown.quantity = PLUMBLINE_QUANTITY_RADIANCE;
  EXPECT_EQ(failures(foreign(unknown)), 0);
}

TEST(Conformance, AWronglyDeclaredConventionFails) {
  EXPECT_GE(failures(foreign(own_convention())), 1);
}

TEST(Conformance, WhatNeedsAnUnknownConventionIsInconclusive) {
  plumbline_implementation implementation = foreign(plumbline_convention{});
  implementation.evaluate_basis = nullptr;
  bool is_seen = false;
  for (const Check& check : all_checks()) {
    if (!check.applies(implementation) || !check.needs_convention) continue;
    for (const Judged& result : run_check(check, implementation, 5)) {
      EXPECT_EQ(result.finding.verdict, checks::Verdict::inconclusive) << check.name;
      is_seen = true;
    }
  }
  EXPECT_TRUE(is_seen);
}

}  // namespace
}  // namespace plumbline::conformance
