#include "prt/sh/product.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "prt/sh/basis.hpp"
#include "prt/sh/quadrature.hpp"
#include "prt/sh/zonal.hpp"
#include "reference/base/error.hpp"

namespace plumbline::sh {
namespace {

std::vector<double> random_vector(int bands, unsigned seed) {
  std::mt19937 bits(seed);
  std::vector<double> result(static_cast<std::size_t>(coefficient_count(bands)));
  for (double& value : result) value = static_cast<double>(bits()) / 2147483648.0 - 1.0;
  return result;
}

std::vector<float> to_float(const std::vector<double>& values) {
  return {values.begin(), values.end()};
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) sum += a[i] * b[i];
  return sum;
}

/// Projection of the pointwise product onto `result_bands`, by a rule exact for it.
std::vector<double> product_by_quadrature(const std::vector<double>& a, const std::vector<double>& b,
                                          int bands, int result_bands) {
  const Basis<double> basis(std::max(bands, result_bands));
  std::vector<double> y(static_cast<std::size_t>(basis.coefficient_count()));
  std::vector<double> result(static_cast<std::size_t>(coefficient_count(result_bands)), 0.0);
  for (const SphereNode& node : sphere_quadrature((2 * bands + result_bands) / 2 + 1)) {
    basis.evaluate(node.direction.x, node.direction.y, node.direction.z, y);
    const double value = node.weight * dot(a, y) * dot(b, y);
    for (std::size_t i = 0; i < result.size(); ++i) result[i] += value * y[i];
  }
  return result;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return std::numeric_limits<double>::infinity();
  double result = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double difference = std::abs(a[i] - b[i]);
    if (!(difference <= result)) result = difference;
  }
  return result;
}

/// sum_jk |G_ijk a_j b_k|: what rounding errors of a product are relative to.
std::vector<double> sum_of_magnitudes(const std::vector<double>& a, const std::vector<double>& b, int bands) {
  std::vector<double> result(a.size(), 0.0);
  const int count = coefficient_count(bands);
  for (int i = 0; i < count; ++i) {
    for (int j = 0; j < count; ++j) {
      const double pair = std::abs(a[static_cast<std::size_t>(i)] * b[static_cast<std::size_t>(j)]);
      for (int k = 0; k < count; ++k)
        result[static_cast<std::size_t>(k)] += std::abs(tripling_coefficient(i, j, k)) * pair;
    }
  }
  return result;
}

using Product = std::vector<double> (*)(const std::vector<double>&, const std::vector<double>&);

double largest_error(Product multiply_under_test, int bands) {
  double worst = 0.0;
  for (unsigned seed = 0; seed < 8; ++seed) {
    const std::vector<double> a = random_vector(bands, 2 * seed + 1);
    const std::vector<double> b = random_vector(bands, 2 * seed + 2);
    const double error =
        largest_difference(multiply_under_test(a, b), product_by_quadrature(a, b, bands, bands));
    if (!(error <= worst)) worst = error;
  }
  return worst;
}

TEST(ShTripling, HasTheKnownValues) {
  const auto at = [](int l1, int m1, int l2, int m2, int l3, int m3) {
    return tripling_coefficient(index(l1, m1), index(l2, m2), index(l3, m3));
  };
  EXPECT_LE(std::abs(at(0, 0, 0, 0, 0, 0) - 0.282094791774), 5e-13);
  EXPECT_LE(std::abs(at(1, 0, 1, 0, 2, 0) - 0.252313252202), 5e-13);
  EXPECT_LE(std::abs(at(2, 0, 2, 0, 2, 0) - 0.180223751573), 5e-13);
  EXPECT_LE(std::abs(at(2, 2, 2, 2, 2, 0) + 0.180223751573), 5e-13);
  EXPECT_LE(std::abs(at(2, 1, 2, 1, 2, 2) - 0.156078347227), 5e-13);
}

TEST(ShTripling, HasTheKnownCounts) {
  const std::array<std::size_t, 5> unique{4, 25, 77, 238, 549};
  const std::array<std::size_t, 5> all{10, 83, 353, 1158, 2907};
  for (int bands = 2; bands <= 6; ++bands) {
    const auto n = static_cast<std::size_t>(bands - 2);
    const std::vector<Tripling> list = tripling_coefficients(bands);
    EXPECT_EQ(list.size(), unique[n]);
    std::size_t count = 0;
    for (const Tripling& t : list) {
      const bool all_equal = t.i == t.k;
      const bool two_equal = t.i == t.j || t.j == t.k;
      count += all_equal ? 1 : two_equal ? 3 : 6;
    }
    EXPECT_EQ(count, all[n]);
  }
}

// The list is found by its selection rules; here every place of the tensor is asked.
TEST(ShTripling, ListLeavesNothingOut) {
  constexpr int kBands = 5;
  std::vector<Tripling> list;
  for (int i = 0; i < coefficient_count(kBands); ++i) {
    for (int j = i; j < coefficient_count(kBands); ++j) {
      for (int k = j; k < coefficient_count(kBands); ++k) {
        const double value = tripling_coefficient(i, j, k);
        if (value != 0.0) list.push_back({i, j, k, value});
        EXPECT_EQ(value, tripling_coefficient(k, i, j));
        EXPECT_EQ(value, tripling_coefficient(j, i, k));
      }
    }
  }
  const auto by_place = [](const Tripling& p, const Tripling& q) {
    return std::array{p.i, p.j, p.k} < std::array{q.i, q.j, q.k};
  };
  std::vector<Tripling> found = tripling_coefficients(kBands);
  std::sort(found.begin(), found.end(), by_place);
  ASSERT_EQ(found.size(), list.size());
  for (std::size_t n = 0; n < list.size(); ++n) {
    EXPECT_EQ(found[n].i, list[n].i);
    EXPECT_EQ(found[n].j, list[n].j);
    EXPECT_EQ(found[n].k, list[n].k);
    EXPECT_EQ(found[n].value, list[n].value);
  }
}

// y_i y_j of degrees a and b has all its energy in degrees up to a + b: sum_k G_ijk^2 is the integral of
// y_i^2 y_j^2, which sum_k G_iik G_jjk gives too. Degrees of 15 reach the table's end. The sums have at most
// 124 terms; each G is good to an ulp of itself and G^2 < 1.
TEST(ShTripling, KeepsItsDigitsAtTheLargestDegrees) {
  for (const auto& [i, j] : {std::pair{index(15, 3), index(14, 9)}, std::pair{index(15, -15), index(15, 15)},
                             std::pair{index(15, 0), index(15, 0)}, std::pair{index(15, -8), index(12, 7)}}) {
    double squares = 0.0;
    double mixed = 0.0;
    for (int k = 0; k < coefficient_count(31); ++k) {
      squares += std::pow(tripling_coefficient(i, j, k), 2);
      mixed += tripling_coefficient(i, i, k) * tripling_coefficient(j, j, k);
    }
    EXPECT_LE(std::abs(squares - mixed), 1e-14 * squares);
  }
}

TEST(ShTripling, RefusesWhatItDoesNotReach) {
  EXPECT_THROW(static_cast<void>(tripling_coefficient(-1, 0, 0)), InputError);
  EXPECT_THROW(static_cast<void>(tripling_coefficient(0, kMaxProductBands * kMaxProductBands, 0)),
               InputError);
  EXPECT_THROW(static_cast<void>(tripling_coefficients(0)), InputError);
  EXPECT_THROW(static_cast<void>(tripling_coefficients(kMaxProductBands + 1)), InputError);
}

TEST(ShProduct, MatchesQuadrature) {
  for (int bands = 1; bands <= 8; ++bands) EXPECT_LE(largest_error(product, bands), 1e-13) << bands;
}

// A published product of two bands once had its cross terms y w, z w and w w confused (w the constant).
std::vector<double> product_with_confused_cross_terms(const std::vector<double>& a,
                                                      const std::vector<double>& b) {
  std::vector<double> c = product(a, b);
  const double g = tripling_coefficient(0, 0, 0);
  c[1] = g * (a[1] * b[0] + a[0] * b[2]);
  return c;
}

std::vector<double> product_with_one_wrong_sign(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> c = product(a, b);
  const double g = tripling_coefficient(index(1, -1), index(1, 1), index(2, -2));
  c[4] -= 2.0 * g * (a[1] * b[3] + a[3] * b[1]);
  return c;
}

TEST(ShProduct, QuadratureSeesPlantedFaults) {
  EXPECT_GT(largest_error(product_with_confused_cross_terms, 2), 0.05);
  EXPECT_GT(largest_error(product_with_one_wrong_sign, 3), 0.05);
}

// (1 + z)^2 and (a + b z)^2 in closed form.
TEST(ShProduct, SquaresALinearFunction) {
  const double root = std::sqrt(4.0 * kPi);
  std::vector<double> f(9, 0.0);
  f[0] = root;
  f[2] = std::sqrt(4.0 * kPi / 3.0);
  const std::vector<double> c = product(f, f);
  EXPECT_LE(std::abs(c[0] - 4.72654360241), 5e-12);
  EXPECT_LE(std::abs(c[2] - 4.09330683179), 5e-12);
  EXPECT_LE(std::abs(c[6] - 1.05688727936), 5e-12);
  for (const std::size_t i : {1UL, 3UL, 4UL, 5UL, 7UL, 8UL}) EXPECT_EQ(c[i], 0.0);
  const double a = -0.3;
  const double b = 2.5;
  const std::vector<double> g{root * a, 0.0, b * f[2], 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  const std::vector<double> d = product(g, g);
  EXPECT_LE(std::abs(d[0] - root * (a * a + b * b / 3.0)), 1e-14);
  EXPECT_LE(std::abs(d[2] - 2.0 * a * b * std::sqrt(4.0 * kPi / 3.0)), 1e-14);
  EXPECT_LE(std::abs(d[6] - 2.0 / 3.0 * b * b * std::sqrt(4.0 * kPi / 5.0)), 1e-14);
}

TEST(ShProduct, ByAConstantScales) {
  for (int bands = 1; bands <= 10; ++bands) {
    const std::vector<double> a = random_vector(bands, 5);
    std::vector<double> two(a.size(), 0.0);
    two[0] = 2.0 * std::sqrt(4.0 * kPi);
    const std::vector<double> c = product(a, two);
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_LE(std::abs(c[i] - 2.0 * a[i]), 1e-15) << bands;
  }
}

// Coefficient 0 of the product is the inner product over sqrt(4 pi) (Parseval); a constant and the clamped
// cosine have the inner product pi.
TEST(ShProduct, MeanIsTheInnerProduct) {
  const std::vector<double> a = random_vector(6, 1);
  const std::vector<double> b = random_vector(6, 2);
  EXPECT_LE(std::abs(product(a, b)[0] * std::sqrt(4.0 * kPi) - dot(a, b)), 1e-14);
  std::vector<double> one(25, 0.0);
  one[0] = std::sqrt(4.0 * kPi);
  const std::vector<double> lobe = rotate_zonal(clamped_cosine(5), glm::normalize(Vec3d(1.0, 2.0, -3.0)));
  EXPECT_LE(std::abs(product(one, lobe)[0] * std::sqrt(4.0 * kPi) - kPi), 1e-14);
}

TEST(ShProduct, CommutesToTheLastBit) {
  for (int bands = 1; bands <= 8; ++bands) {
    const std::vector<double> a = random_vector(bands, 11);
    const std::vector<double> b = random_vector(bands, 12);
    EXPECT_EQ(product(a, b), product(b, a));
    EXPECT_EQ(product(to_float(a), to_float(b)), product(to_float(b), to_float(a)));
  }
}

TEST(ShProduct, SquareIsTheProductWithItselfToTheLastBit) {
  for (int bands = 1; bands <= 8; ++bands) {
    const std::vector<double> a = random_vector(bands, 21);
    EXPECT_EQ(square(a), product(a, a));
    EXPECT_EQ(square(to_float(a)), product(to_float(a), to_float(a)));
  }
}

TEST(ShProduct, MatrixIsSymmetricAndMultiplies) {
  for (int bands = 1; bands <= 8; ++bands) {
    const std::vector<double> f = random_vector(bands, 31);
    const std::vector<double> g = random_vector(bands, 32);
    const std::vector<double> matrix = product_matrix(f);
    const std::size_t n = f.size();
    std::vector<double> applied(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        EXPECT_EQ(matrix[i * n + j], matrix[j * n + i]);
        applied[i] += matrix[i * n + j] * g[j];
      }
    }
    EXPECT_LE(largest_difference(applied, product(f, g)), 1e-13) << bands;
  }
}

TEST(ShProduct, WithoutTruncationLosesNothing) {
  for (int bands = 1; bands <= 6; ++bands) {
    const std::vector<double> a = random_vector(bands, 41);
    const std::vector<double> b = random_vector(bands, 42);
    const std::vector<double> full = full_product(a, b);
    EXPECT_LE(largest_difference(full, product_by_quadrature(a, b, bands, 2 * bands - 1)), 1e-13) << bands;
    for (const Vec3d& d : {Vec3d(0.0, 0.0, 1.0), Vec3d(0.6, -0.8, 0.0), glm::normalize(Vec3d(1, 2, -2))}) {
      const double pointwise = dot(a, evaluate_basis(bands, d)) * dot(b, evaluate_basis(bands, d));
      EXPECT_LE(std::abs(dot(full, evaluate_basis(2 * bands - 1, d)) - pointwise), 1e-12) << bands;
    }
    const std::vector<double> truncated = product(a, b);
    const std::vector<double> head(full.begin(), full.begin() + static_cast<std::ptrdiff_t>(a.size()));
    EXPECT_LE(largest_difference(truncated, head), 1e-13);
  }
}

TEST(ShProduct, ZonalPathMatchesTheGeneralOne) {
  for (int bands = 1; bands <= 8; ++bands) {
    const std::vector<double> zonal = clamped_cosine(bands);
    const std::vector<double> f = random_vector(bands, 51);
    std::vector<double> general(f.size(), 0.0);
    for (int l = 0; l < bands; ++l)
      general[static_cast<std::size_t>(index(l, 0))] = zonal[static_cast<std::size_t>(l)];
    EXPECT_LE(largest_difference(zonal_product(zonal, f), product(general, f)), 1e-13) << bands;
  }
}

// Against the same product in double, of the same float numbers. Each coefficient is a sum of rounded terms:
// the error is below (operations on the way) * 2^-24 * sum |G a b|; no way is longer than 100 operations.
TEST(ShProduct, FloatKeepsItsDigits) {
  for (int bands = 2; bands <= 6; ++bands) {
    for (unsigned seed = 0; seed < 50; ++seed) {
      const std::vector<float> a = to_float(random_vector(bands, 100 + seed));
      const std::vector<float> b = to_float(random_vector(bands, 200 + seed));
      const std::vector<double> wide_a(a.begin(), a.end());
      const std::vector<double> wide_b(b.begin(), b.end());
      const std::vector<float> c = product(a, b);
      const std::vector<double> exact = product(wide_a, wide_b);
      const std::vector<double> magnitude = sum_of_magnitudes(wide_a, wide_b, bands);
      for (std::size_t i = 0; i < c.size(); ++i) {
        EXPECT_LE(std::abs(static_cast<double>(c[i]) - exact[i]), 100.0 * 0x1p-24 * magnitude[i]) << bands;
      }
    }
  }
}

TEST(ShProduct, BlocksGiveTheSameBitsAsSingles) {
  for (int bands = 1; bands <= 8; ++bands) {
    const auto count = static_cast<std::size_t>(coefficient_count(bands));
    constexpr std::size_t kBlocks = 3;
    std::vector<float> a(kBlocks * count * kProductLanes);
    std::vector<float> b(a.size());
    std::vector<float> c(a.size());
    std::vector<float> squares(a.size());
    std::vector<std::vector<float>> pairs_a;
    std::vector<std::vector<float>> pairs_b;
    const auto place = [count](std::size_t pair, std::size_t i) {
      return (pair / kProductLanes * count + i) * kProductLanes + pair % kProductLanes;
    };
    for (std::size_t pair = 0; pair < kBlocks * kProductLanes; ++pair) {
      pairs_a.push_back(to_float(random_vector(bands, static_cast<unsigned>(1000 + pair))));
      pairs_b.push_back(to_float(random_vector(bands, static_cast<unsigned>(2000 + pair))));
      for (std::size_t i = 0; i < count; ++i) {
        a[place(pair, i)] = pairs_a[pair][i];
        b[place(pair, i)] = pairs_b[pair][i];
      }
    }
    multiply_blocks(bands, a, b, c);
    square_blocks(bands, a, squares);
    for (std::size_t pair = 0; pair < pairs_a.size(); ++pair) {
      const std::vector<float> single = product(pairs_a[pair], pairs_b[pair]);
      const std::vector<float> single_square = square(pairs_a[pair]);
      for (std::size_t i = 0; i < count; ++i) {
        EXPECT_EQ(c[place(pair, i)], single[i]);
        EXPECT_EQ(squares[place(pair, i)], single_square[i]);
      }
    }
  }
}

TEST(ShProduct, RefusesWrongSizes) {
  const std::vector<double> nine(9, 1.0);
  const std::vector<double> four(4, 1.0);
  const std::vector<double> five(5, 1.0);
  EXPECT_THROW(static_cast<void>(product(nine, four)), InputError);
  EXPECT_THROW(static_cast<void>(product(five, five)), InputError);
  EXPECT_THROW(static_cast<void>(product(std::vector<double>{}, {})), InputError);
  EXPECT_THROW(static_cast<void>(product_matrix(five)), InputError);
  EXPECT_THROW(static_cast<void>(zonal_product(four, nine)), InputError);
  EXPECT_THROW(static_cast<void>(full_product(std::vector<double>(400), std::vector<double>(400))),
               InputError);
  std::vector<float> block(4 * kProductLanes);
  EXPECT_THROW(multiply_blocks(0, block, block, block), InputError);
  EXPECT_THROW(multiply_blocks(3, block, block, block), InputError);
}

// Scaling both factors by a power of two scales the product by its square, to the last bit, as long as
// nothing leaves the range of normal numbers.
TEST(ShProduct, ScalesWithoutLoss) {
  const std::vector<double> a = random_vector(5, 61);
  const std::vector<double> b = random_vector(5, 62);
  const std::vector<double> c = product(a, b);
  for (const double scale : {0x1p100, 0x1p-100}) {
    std::vector<double> scaled_a = a;
    std::vector<double> scaled_b = b;
    for (double& value : scaled_a) value *= scale;
    for (double& value : scaled_b) value *= scale;
    const std::vector<double> scaled = product(scaled_a, scaled_b);
    for (std::size_t i = 0; i < c.size(); ++i) EXPECT_EQ(scaled[i], c[i] * scale * scale);
  }
}

// 1e30 squared leaves float: the answer is infinity (or NaN where infinities cancel), not a large number.
TEST(ShProduct, OverflowsToInfinityNotToANumber) {
  std::vector<float> a(25, 0.0F);
  a[7] = 1e30F;
  EXPECT_TRUE(std::isinf(product(a, a)[0]));
  a[7] = 1e-30F;
  EXPECT_EQ(product(a, a)[0], 0.0F);
  std::vector<double> wide(25, 0.0);
  wide[7] = 1e30;
  EXPECT_LE(std::abs(product(wide, wide)[0] - 1e60 / std::sqrt(4.0 * kPi)), 1e45);
}

// A denormal times the constant one must not be flushed to zero.
TEST(ShProduct, KeepsDenormals) {
  const double tiny = std::numeric_limits<double>::denorm_min() * 1000.0;
  for (int bands = 2; bands <= 8; ++bands) {
    std::vector<double> a(static_cast<std::size_t>(coefficient_count(bands)), 0.0);
    std::vector<double> one = a;
    one[0] = std::sqrt(4.0 * kPi);
    a[3] = tiny;
    const std::vector<double> c = product(a, one);
    EXPECT_LE(std::abs(c[3] - tiny), 4.0 * std::numeric_limits<double>::denorm_min());
    EXPECT_GT(c[3], 0.0);
  }
}

TEST(ShProduct, OneHotVectorsReadTheTensor) {
  for (const int bands : {3, 5, 7}) {
    const auto count = static_cast<std::size_t>(coefficient_count(bands));
    for (std::size_t i = 0; i < count; ++i) {
      std::vector<double> a(count, 0.0);
      std::vector<double> b(count, 0.0);
      a[i] = 1.0;
      b[(i * 7 + 2) % count] = 1.0;
      const std::vector<double> c = product(a, b);
      for (std::size_t k = 0; k < count; ++k) {
        const double expected = tripling_coefficient(
            static_cast<int>(i), static_cast<int>((i * 7 + 2) % count), static_cast<int>(k));
        EXPECT_LE(std::abs(c[k] - expected), 1e-16);
      }
    }
  }
}

TEST(ShProduct, OfZeroIsZero) {
  for (int bands = 1; bands <= 7; ++bands) {
    const std::vector<double> a = random_vector(bands, 71);
    const std::vector<double> zero(a.size(), 0.0);
    for (const double value : product(a, zero)) EXPECT_EQ(value, 0.0);
  }
}

TEST(ShProduct, NeverHidesNaNOrInfinity) {
  for (int bands = 1; bands <= 8; ++bands) {
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      std::vector<double> a = random_vector(bands, 81);
      const std::vector<double> b = random_vector(bands, 82);
      for (std::size_t i = 0; i < a.size(); ++i) {
        std::vector<double> spoilt = a;
        spoilt[i] = bad;
        const std::vector<double> c = product(spoilt, b);
        EXPECT_FALSE(std::isfinite(c[0]));
        EXPECT_FALSE(std::isfinite(c[i]));
      }
    }
  }
}

}  // namespace
}  // namespace plumbline::sh
