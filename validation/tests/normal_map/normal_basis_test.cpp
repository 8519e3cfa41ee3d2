// prt/normal_map/normal_basis: the SVD against integrals done by hand.
#include "prt/normal_map/normal_basis.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "reference/base/error.hpp"

namespace plumbline::normal_map {
namespace {

// Eigenvalues of [[a, d, e], [d, b, f], [e, f, c]]: the trigonometric roots of the characteristic cubic.
std::vector<double> eigenvalues(double a, double b, double c, double d, double e, double f) {
  const double q = (a + b + c) / 3.0;
  const double off = d * d + e * e + f * f;
  const double p = std::sqrt(((a - q) * (a - q) + (b - q) * (b - q) + (c - q) * (c - q) + 2.0 * off) / 6.0);
  const double determinant =
      (a - q) * ((b - q) * (c - q) - f * f) - d * (d * (c - q) - f * e) + e * (d * f - (b - q) * e);
  const double angle = std::acos(std::clamp(determinant / (2.0 * p * p * p), -1.0, 1.0)) / 3.0;
  std::vector<double> roots(3);
  for (int k = 0; k < 3; ++k) {
    roots[static_cast<std::size_t>(k)] = q + 2.0 * p * std::cos(angle + 2.0 * std::numbers::pi * k / 3.0);
  }
  return roots;
}

/// Half-sphere integrals of products of two spherical harmonics with the same m, done by hand: m = 0 (degrees 00, 11, 22, 01,
/// 12, 02), |m| = 1 (degrees 11, 22, 12), |m| = 2. Different m do not mix.
struct HalfIntegrals {
  double m0[6];
  double m1[3];
  double m2;
};
// Functions of equal parity in z: half of the sphere's integral, 1/2 or 0. The others from int_0^1 z (3z^2 - 1) = 1/4, …
const HalfIntegrals kUniform = {{0.5, 0.5, 0.5, std::sqrt(3.0) / 4.0, std::sqrt(15.0) / 16.0, 0.0},
                                {0.5, 0.5, std::sqrt(45.0) / 16.0},
                                0.5};
const HalfIntegrals kCosine = {
    {1.0 / 4.0, 3.0 / 8.0, 5.0 / 16.0, std::sqrt(3.0) / 6.0, std::sqrt(15.0) / 15.0, std::sqrt(5.0) / 16.0},
    {3.0 / 16.0, 5.0 / 16.0, 1.0 / std::sqrt(20.0)},
    5.0 / 32.0};

/// Shares of the squared singular values, descending, with degree l scaled by `factors`.
std::vector<double> shares(const HalfIntegrals& h, const double (&factors)[3]) {
  const auto [k0, k1, k2] = factors;
  std::vector<double> all = eigenvalues(h.m0[0] * k0 * k0, h.m0[1] * k1 * k1, h.m0[2] * k2 * k2,
                                        h.m0[3] * k0 * k1, h.m0[5] * k0 * k2, h.m0[4] * k1 * k2);
  const double a = h.m1[0] * k1 * k1;
  const double b = h.m1[1] * k2 * k2;
  const double root = std::hypot(0.5 * (a - b), h.m1[2] * k1 * k2);
  for (const double sign : {-1.0, 1.0}) all.insert(all.end(), 2, 0.5 * (a + b) + sign * root);
  all.insert(all.end(), 2, h.m2 * k2 * k2);
  std::sort(all.begin(), all.end(), std::greater<>());
  double sum = 0.0;
  for (const double value : all) sum += value;
  for (double& value : all) value /= sum;
  return all;
}

constexpr double kLambert[3] = {1.0, 2.0 / 3.0, 1.0 / 4.0};

double largest_share_error(NormalWeight weight, const std::vector<double>& expected) {
  const NormalBasis basis = make_normal_basis(weight);
  double largest = 0.0;
  double before = 0.0;
  for (int k = 1; k <= 9; ++k) {
    const double kept = energy_kept(basis, k);
    const double error = std::abs(kept - before - expected[static_cast<std::size_t>(k - 1)]);
    if (!(error <= largest)) largest = error;
    before = kept;
  }
  return largest;
}

TEST(NormalBasis, EnergiesAreThoseOfTheIntegralsDoneByHand) {
  EXPECT_LE(largest_share_error(NormalWeight::uniform, shares(kUniform, kLambert)), 1e-14);
  EXPECT_LE(largest_share_error(NormalWeight::cosine, shares(kCosine, kLambert)), 1e-14);
  // The comparison fails for a basis that is not convolved, and for the other weight.
  EXPECT_GE(largest_share_error(NormalWeight::uniform, shares(kUniform, {1.0, 1.0, 1.0})), 0.1);
  EXPECT_GE(largest_share_error(NormalWeight::uniform, shares(kCosine, kLambert)), 0.05);
}

// Sloan, "Practical PRT", SIGGRAPH 2005: 93.9/96.4 % and 98.7/99.3 %.
TEST(NormalBasis, KeepsThePublishedEnergyWithFourAndSixTerms) {
  const NormalBasis uniform = make_normal_basis(NormalWeight::uniform);
  const NormalBasis cosine = make_normal_basis(NormalWeight::cosine);
  EXPECT_NEAR(energy_kept(uniform, 4), 0.939, 0.002);
  EXPECT_NEAR(energy_kept(cosine, 4), 0.964, 0.002);
  EXPECT_NEAR(energy_kept(uniform, 6), 0.987, 0.002);
  EXPECT_NEAR(energy_kept(cosine, 6), 0.993, 0.002);
  EXPECT_DOUBLE_EQ(energy_kept(uniform, 9), 1.0);
}

TEST(NormalBasis, NineTermsAreTheNormalDirectionMatrix) {
  const NormalBasis basis = make_normal_basis(NormalWeight::cosine);
  for (const Vec3d normal : {Vec3d(0.0, 0.0, 1.0), Vec3d(0.6, -0.48, 0.64), Vec3d(0.0, -1.0, 0.0)}) {
    std::array<double, 9> u{};
    evaluate_normal_functions(basis, normal, u);
    const Quadratic row = reflected(normal);
    for (std::size_t j = 0; j < 9; ++j) {
      double sum = 0.0;
      for (std::size_t k = 0; k < 9; ++k) sum += u[k] * light_row(basis, static_cast<int>(k))[j];
      EXPECT_NEAR(sum, row[j], 1e-13);
    }
  }
}

// A constant light of radiance 1 has l_00 = sqrt(4 pi): a white surface reflects 1, whatever its normal.
TEST(NormalBasis, ReflectsAConstantLightWhole) {
  EXPECT_NEAR(reflected({0.6, -0.48, 0.64})[0] * std::sqrt(4.0 * kPi), 1.0, 1e-15);
}

TEST(NormalBasis, RefusesTermsThatThereAreNot) {
  const NormalBasis basis = make_normal_basis(NormalWeight::uniform);
  EXPECT_THROW((void)energy_kept(basis, 0), InputError);
  EXPECT_THROW((void)energy_kept(basis, 10), InputError);
  EXPECT_THROW((void)light_row(basis, 9), InputError);
  std::array<double, 10> too_many{};
  EXPECT_THROW(evaluate_normal_functions(basis, {0.0, 0.0, 1.0}, too_many), InputError);
}

}  // namespace
}  // namespace plumbline::normal_map
