#include "prt/sh/exponential.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "prt/sh/basis.hpp"
#include "prt/sh/logarithm.hpp"
#include "prt/sh/zonal.hpp"
#include "reference/base/error.hpp"

namespace plumbline::sh {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
const double kRoot = std::sqrt(4.0 * kPi);

using Method = std::vector<double> (*)(const std::vector<double>&);

std::vector<double> long_series(const std::vector<double>& f) {
  return exponential_series(f, 60);
}
std::vector<double> long_isolated(const std::vector<double>& f) {
  return exponential_isolated(f, 30);
}
std::vector<double> by_quadrature(const std::vector<double>& f) {
  return exponential_by_quadrature(f).coefficients;
}

/// Random f with |f^| = magnitude and this f_0.
std::vector<double> random_vector(int bands, unsigned seed, double magnitude, double mean) {
  std::mt19937 bits(seed);
  std::vector<double> f(static_cast<std::size_t>(coefficient_count(bands)));
  for (double& value : f) value = static_cast<double>(bits()) / 2147483648.0 - 1.0;
  const double factor = magnitude / magnitude_without_mean(f);
  for (double& value : f) value *= factor;
  f[0] = mean;
  return f;
}

std::vector<double> constant(int bands, double value) {
  std::vector<double> f(static_cast<std::size_t>(coefficient_count(bands)), 0.0);
  f[0] = value * kRoot;
  return f;
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return kInfinity;
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

/// Largest relative error over constants a: exp must be e^a.
double constant_error(Method method) {
  double worst = 0.0;
  for (const double a : {-20.0, -3.0, -0.1, 0.0, 0.5, 2.0, 10.0}) {
    const std::vector<double> expected = constant(4, std::exp(a));
    const double error = distance(method(constant(4, a)), expected) / expected[0];
    if (!(error <= worst)) worst = error;
  }
  return worst;
}

// An argument of 20 rounded to a relative 2^-53 moves e^a by 20 * 2^-53.
TEST(ShExponential, OfAConstantIsExact) {
  for (const Method method : {Method(exponential), Method(exponential_hybrid), Method(exponential_linear),
                              Method(long_isolated), Method(exponential_of_matrix)}) {
    EXPECT_LE(constant_error(method), 1e-14);
  }
  EXPECT_LE(constant_error(by_quadrature), 1e-12);
  EXPECT_LE(distance(long_series(constant(4, 2.0)), constant(4, std::exp(2.0))), 1e-13);
}

// Two faults of published code: sqrt(4 / pi) for sqrt(4 pi), and the coefficients 1 / k! built from an integer
// 1 / k, which end the series after f.
std::vector<double> with_the_wrong_mean(const std::vector<double>& f) {
  std::vector<double> hat = f;
  hat[0] = 0.0;
  std::vector<double> result = exponential(hat);
  for (double& value : result) value *= std::exp(f[0] / std::sqrt(4.0 / kPi));
  return result;
}

std::vector<double> with_integer_division(const std::vector<double>& f) {
  std::vector<double> sum = constant(4, 1.0);
  std::vector<double> power = sum;
  for (int k = 1; k <= 9; ++k) {
    power = product(power, f);
    for (double& value : power) value *= 1 / k;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += power[i];
  }
  return sum;
}

TEST(ShExponential, ConstantsAndTheMatrixSeePlantedFaults) {
  EXPECT_GT(constant_error(with_the_wrong_mean), 0.1);
  const std::vector<double> f = random_vector(4, 1, 1.5, -1.0);
  EXPECT_LE(distance(exponential_series(f, 9), exponential_of_matrix(f)), 0.01);
  EXPECT_GT(distance(with_integer_division(f), exponential_of_matrix(f)), 0.1);
}

TEST(ShExponential, OfZeroIsOne) {
  for (int bands = 2; bands <= 6; ++bands) {
    const std::vector<double> zero(static_cast<std::size_t>(coefficient_count(bands)), 0.0);
    EXPECT_EQ(exponential(zero), constant(bands, 1.0));
    EXPECT_EQ(exponential_hybrid(zero), constant(bands, 1.0));
    EXPECT_EQ(exponential_linear(zero), constant(bands, 1.0));
  }
}

// The remainder of the series after 40 terms is below |M|^41 / 41!, |M| <= |f^| n / sqrt(4 pi) < 5.
TEST(ShExponential, SeriesTendsToTheMatrixExponential) {
  for (int bands = 2; bands <= 6; ++bands) {
    const std::vector<double> f = random_vector(bands, 7, 2.0, -1.0);
    EXPECT_LE(distance(exponential_isolated(f, 40), exponential_of_matrix(f)), 1e-12) << bands;
    EXPECT_LE(distance(exponential_series(f, 60), exponential_of_matrix(f)), 1e-12) << bands;
  }
}

// exp(c z): 2 pi integral e^(c z) y_l0(z) dz in closed form for l = 0, 1.
TEST(ShExponential, OracleMatchesAClosedForm) {
  for (const double c : {-6.0, -1.0, 0.3, 4.0}) {
    std::vector<double> f(16, 0.0);
    f[2] = c * std::sqrt(4.0 * kPi / 3.0);
    const Reprojected result = exponential_by_quadrature(f);
    const double mean = 2.0 * std::sinh(c) / c;
    const double first = 2.0 * std::cosh(c) / c - 2.0 * std::sinh(c) / (c * c);
    EXPECT_LE(std::abs(result.coefficients[0] - 2.0 * kPi / kRoot * mean), 1e-12 * mean);
    EXPECT_LE(std::abs(result.coefficients[2] - 2.0 * kPi * std::sqrt(3.0) / kRoot * first), 1e-12 * mean);
    EXPECT_LE(result.uncertainty, 1e-10 * mean);
  }
}

// With ever smaller f every method is 1 + f + f * f / 2 + O(f^3); the linear one lacks the quadratic term, and
// interpolates a = 1 + |f^|^2 / 8 pi in its first step: off by at most |f^| step / 8 pi, sqrt(4 pi) of that in a 1.
TEST(ShExponential, MethodsAgreeForSmallFunctions) {
  for (int bands = 2; bands <= 6; ++bands) {
    const std::vector<double> f = random_vector(bands, 3, 0.01, 0.0);
    const std::vector<double> truth = by_quadrature(f);
    const double largest = 0.01 * bands / kRoot;  // |f| <= |f^| |y|, |y|^2 = n^2 / 4 pi
    EXPECT_LE(distance(exponential(f), truth), 0.01 * largest * largest);
    EXPECT_LE(distance(exponential_hybrid(f), truth),
              0.01 * largest + 0.15 * 0.01 * linear_table(bands).step);
  }
}

TEST(ShExponential, HybridIsTheLinearMethodWhileItNeedsNoSquaring) {
  const std::vector<double> f = random_vector(4, 5, 0.99 * kScaledMagnitude, -2.0);
  EXPECT_EQ(exponential_hybrid(f), exponential_linear(f));
}

TEST(ShExponential, HybridSquaresTheLinearMethod) {
  const std::vector<double> f = random_vector(4, 6, 3.0 * kScaledMagnitude, -2.0);
  std::vector<double> quarter = f;
  for (double& value : quarter) value *= 0.25;
  EXPECT_EQ(exponential_hybrid(f), square(square(exponential_linear(quarter))));
}

// Two different routes to the mean of eq. 3.29: zonal in the library, over the whole sphere here.
TEST(ShExponential, TableIsTheMeanOfTheBestFactors) {
  const LinearTable& table = linear_table(4);
  EXPECT_EQ(table.a.front(), 1.0);
  EXPECT_EQ(table.b.front(), 1.0);
  const std::size_t place = 40;
  const double m = static_cast<double>(place) * table.step;
  double a = 0.0;
  double b = 0.0;
  for (int degrees = 1; degrees < 90; degrees += 2) {
    const std::vector<double> zonal =
        zonal_logarithm(sphere_visibility(4, degrees * kPi / 180.0)).coefficients;
    std::vector<double> f = rotate_zonal(zonal, Vec3d(0.0, 0.6, -0.8));
    f[0] = 0.0;
    const double factor = m / magnitude_without_mean(f);
    for (double& value : f) value *= factor;
    const std::vector<double> e = by_quadrature(f);
    double inner = 0.0;
    for (std::size_t i = 1; i < f.size(); ++i) inner += e[i] * f[i];
    a += e[0] / kRoot / 45.0;
    b += inner / (m * m) / 45.0;
  }
  EXPECT_LE(std::abs(table.a[place] - a), 1e-10 * a);
  EXPECT_LE(std::abs(table.b[place] - b), 1e-10 * b);
}

TEST(ShExponential, RecommendedMethodBeatsTheHybridOnManySpheres) {
  std::mt19937 bits(4);
  const auto uniform = [&bits] { return (static_cast<double>(bits()) + 0.5) / 4294967296.0; };
  double scaled = 0.0;
  double hybrid = 0.0;
  for (int trial = 0; trial < 10; ++trial) {
    std::vector<double> f(16, 0.0);
    for (int blocker = 0; blocker < 30; ++blocker) {
      const Vec3d axis = glm::normalize(Vec3d(uniform() - 0.5, uniform() - 0.5, uniform() - 0.5));
      const double radius = (3.0 + 20.0 * uniform()) * kPi / 180.0;
      const std::vector<double> log =
          rotate_zonal(zonal_logarithm(sphere_visibility(4, radius)).coefficients, axis);
      for (std::size_t i = 0; i < f.size(); ++i) f[i] += log[i];
    }
    const std::vector<double> truth = by_quadrature(f);
    scaled += distance(exponential(f), truth);
    hybrid += distance(exponential_hybrid(f), truth);
  }
  EXPECT_LT(scaled, hybrid);
}

// Of a function that is nowhere above 0 exp is at most 1: sphere logs grow without end, results do not.
TEST(ShExponential, StaysFiniteForManyBlockers) {
  const std::vector<double> one =
      rotate_zonal(zonal_logarithm(sphere_visibility(4, 0.5)).coefficients, Vec3d(0.0, 1.0, 0.0));
  for (const double count : {1.0, 10.0, 1e3, 1e6}) {
    std::vector<double> f = one;
    for (double& value : f) value *= count;
    f[0] -= 4.0 * magnitude_without_mean(f);
    for (const double value : exponential(f)) EXPECT_TRUE(std::isfinite(value));
    for (const double value : exponential_hybrid(f)) EXPECT_TRUE(std::isfinite(value));
  }
}

TEST(ShExponential, SaysNoWhereItCannotAnswer) {
  std::vector<double> f = random_vector(4, 9, 0.5, 0.0);
  f[0] = 1e4;
  for (const Method method : {Method(exponential), Method(exponential_hybrid), Method(exponential_linear),
                              Method(long_isolated), Method(exponential_of_matrix), Method(by_quadrature)}) {
    EXPECT_THROW(static_cast<void>(method(f)), InputError);
    EXPECT_THROW(static_cast<void>(method(std::vector<double>(5, 0.0))), InputError);
    EXPECT_THROW(static_cast<void>(method({})), InputError);
    for (const double bad : {kNaN, kInfinity, -kInfinity}) {
      for (const std::size_t place : {0UL, 7UL}) {
        std::vector<double> spoilt(16, 0.0);
        spoilt[place] = bad;
        EXPECT_THROW(static_cast<void>(method(spoilt)), InputError);
      }
    }
  }
  EXPECT_THROW(static_cast<void>(exponential_linear(random_vector(4, 9, 8.1, 0.0))), InputError);
  EXPECT_THROW(static_cast<void>(exponential(random_vector(4, 9, 1e12, -1e13))), InputError);
  EXPECT_THROW(static_cast<void>(exponential(random_vector(4, 9, 1e30, 0.0))), InputError);
  EXPECT_THROW(static_cast<void>(exponential_isolated(std::vector<double>(16, 0.0), -1)), InputError);
  EXPECT_THROW(static_cast<void>(linear_table(0)), InputError);
}

// Scales at the edges of double: |f^| must neither overflow nor vanish in its squares.
TEST(ShExponential, MagnitudeHoldsAtEveryScale) {
  for (const double scale : {1e-310, 1e-200, 1e-30, 1.0, 1e30, 1e300}) {
    const std::vector<double> f{123.0, 3.0 * scale, 0.0, 4.0 * scale};
    EXPECT_LE(std::abs(magnitude_without_mean(f) / scale - 5.0), scale < 1e-300 ? 1e-8 : 1e-14);
  }
  const double denormal = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(magnitude_without_mean({0.0, denormal, 0.0, 0.0}), denormal);
  EXPECT_EQ(exponential({0.0, denormal, 0.0, 0.0}), (std::vector<double>{kRoot, denormal, 0.0, 0.0}));
}

struct Blocks {
  std::vector<float> packed;
  std::vector<std::vector<double>> vectors;
};

Blocks make_blocks(int bands, std::size_t blocks) {
  const auto count = static_cast<std::size_t>(coefficient_count(bands));
  Blocks result;
  result.packed.resize(blocks * count * kProductLanes);
  for (std::size_t v = 0; v < blocks * kProductLanes; ++v) {
    std::vector<double> f = random_vector(bands, static_cast<unsigned>(v + 1),
                                          7.0 * static_cast<double>(v % kProductLanes) / kProductLanes, -4.0);
    for (std::size_t i = 0; i < count; ++i) {
      const auto rounded = static_cast<float>(f[i]);
      f[i] = static_cast<double>(rounded);
      result.packed[(v / kProductLanes * count + i) * kProductLanes + v % kProductLanes] = rounded;
    }
    result.vectors.push_back(f);
  }
  return result;
}

// Up to 3 squarings of about 100 operations each, each doubling the error before it: 2^3 * 4 * 100 * 2^-24 of the
// largest value met, which is below 4 sqrt(4 pi) here.
TEST(ShExponential, BlocksMatchSingles) {
  for (int bands = 2; bands <= 6; ++bands) {
    const auto count = static_cast<std::size_t>(coefficient_count(bands));
    const Blocks in = make_blocks(bands, 2);
    std::vector<float> scaled(in.packed.size());
    std::vector<float> hybrid(in.packed.size());
    EXPECT_EQ(exponential_blocks(bands, in.packed, scaled), 0U);
    EXPECT_EQ(exponential_hybrid_blocks(bands, in.packed, hybrid), 0U);
    for (std::size_t v = 0; v < in.vectors.size(); ++v) {
      const std::vector<double> expected = exponential(in.vectors[v]);
      const std::vector<double> expected_hybrid = exponential_hybrid(in.vectors[v]);
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t at = (v / kProductLanes * count + i) * kProductLanes + v % kProductLanes;
        EXPECT_LE(std::abs(static_cast<double>(scaled[at]) - expected[i]), 2e-4 * 14.0) << bands;
        EXPECT_LE(std::abs(static_cast<double>(hybrid[at]) - expected_hybrid[i]), 2e-4 * 14.0) << bands;
      }
    }
  }
}

TEST(ShExponential, BlocksCountAndContainWhatIsNotFinite) {
  const Blocks in = make_blocks(4, 1);
  std::vector<float> clean(in.packed.size());
  ASSERT_EQ(exponential_blocks(4, in.packed, clean), 0U);
  std::vector<float> spoilt = in.packed;
  spoilt[0 * kProductLanes + 2] = std::numeric_limits<float>::infinity();
  spoilt[5 * kProductLanes + 4] = std::numeric_limits<float>::quiet_NaN();
  spoilt[3 * kProductLanes + 6] = 1e30F;
  spoilt[0 * kProductLanes + 8] = 1000.0F;  // e^282 is beyond float
  for (const auto method : {exponential_blocks, exponential_hybrid_blocks}) {
    std::vector<float> out(spoilt.size());
    EXPECT_EQ(method(4, spoilt, out), 4U);
    for (std::size_t lane = 0; lane < kProductLanes; ++lane) {
      const bool is_bad = lane == 2 || lane == 4 || lane == 6 || lane == 8;
      bool is_finite = true;
      for (std::size_t i = 0; i < 16; ++i) is_finite &= std::isfinite(out[i * kProductLanes + lane]);
      EXPECT_EQ(is_finite, !is_bad) << lane;
      if (method == exponential_blocks && !is_bad) {
        for (std::size_t i = 0; i < 16; ++i)
          EXPECT_EQ(out[i * kProductLanes + lane], clean[i * kProductLanes + lane]);
      }
    }
  }
  EXPECT_THROW(static_cast<void>(exponential_blocks(7, in.packed, clean)), InputError);
  EXPECT_THROW(static_cast<void>(exponential_blocks(5, in.packed, clean)), InputError);
}

TEST(ShExponential, FloatFormIsTheRoundedDoubleForm) {
  const std::vector<double> f = random_vector(4, 8, 3.0, -2.0);
  const std::vector<float> narrow(f.begin(), f.end());
  const std::vector<double> expected = exponential_hybrid(std::vector<double>(narrow.begin(), narrow.end()));
  const std::vector<float> result = exponential_hybrid(narrow);
  for (std::size_t i = 0; i < f.size(); ++i) EXPECT_EQ(result[i], static_cast<float>(expected[i]));
  std::vector<float> bright(16, 0.0F);
  bright[0] = 1000.0F;
  EXPECT_THROW(static_cast<void>(exponential_hybrid(bright)), InputError);
}

}  // namespace
}  // namespace plumbline::sh
