#include "prt/sh/basis.hpp"

#include <gtest/gtest.h>

#include <boost/math/special_functions/spherical_harmonic.hpp>
#include <functional>

#include "prt/sh/quadrature.hpp"
#include "reference/base/error.hpp"
#include "validation/tests/sh/oracle.hpp"

namespace plumbline::sh {
namespace {

/// The larger; NaN stays.
double worse(double a, double b) {
  return std::isnan(a) || a >= b ? a : b;
}

/// Largest absolute error over `count` uniform directions, against quadruple precision.
template <class Real>
double largest_error(int bands, int count) {
  const Basis<Real> basis(bands);
  std::vector<Real> values(static_cast<std::size_t>(basis.coefficient_count()));
  double error = 0.0;
  for (const Vec3d& d : sh_test::directions(count, 7)) {
    const auto x = static_cast<Real>(d.x);
    const auto y = static_cast<Real>(d.y);
    const auto z = static_cast<Real>(d.z);
    basis.evaluate(x, y, z, values);
    const std::vector<sh_test::Quad> truth = sh_test::evaluate(bands, Vec3d(x, y, z));
    for (std::size_t i = 0; i < values.size(); ++i) {
      error = worse(error, std::abs(static_cast<double>(sh_test::Quad(values[i]) - truth[i])));
    }
  }
  return error;
}

// The bounds are the accuracy the header states.
TEST(ShBasis, IsAccurateInDouble) {
  EXPECT_LE(largest_error<double>(6, 1000), 3e-15);
  EXPECT_LE(largest_error<double>(20, 200), 4e-14);
  EXPECT_LE(largest_error<double>(64, 20), 2e-13);
  EXPECT_LE(largest_error<double>(200, 4), 2e-13);
}
TEST(ShBasis, IsAccurateInFloat) {
  EXPECT_LE(largest_error<float>(5, 1000), 7e-7);
  EXPECT_LE(largest_error<float>(6, 1000), 7e-7);
  EXPECT_LE(largest_error<float>(10, 1000), 2.5e-6);
  EXPECT_LE(largest_error<float>(20, 200), 1e-5);
  EXPECT_LE(largest_error<float>(64, 20), 3e-5);
}

TEST(ShBasis, AgreesWithBoost) {
  constexpr int kBands = 12;
  // Boost takes angles: a rounding of the angle moves a function of degree l by about l roundings of its
  // size.
  constexpr double kTolerance = 1e-13;
  for (const Vec3d& d : sh_test::directions(20, 3)) {
    const std::vector<double> values = evaluate_basis(kBands, d);
    const double theta = std::acos(d.z);
    const double phi = std::atan2(d.y, d.x);
    for (int l = 0; l < kBands; ++l) {
      for (int m = -l; m <= l; ++m) {
        const auto n = static_cast<unsigned>(l);
        const int k = std::abs(m);
        const double part = m < 0 ? boost::math::spherical_harmonic_i(n, k, theta, phi)
                                  : boost::math::spherical_harmonic_r(n, k, theta, phi);
        const double expected = m == 0 ? part : std::sqrt(2.0) * part;
        EXPECT_LE(std::abs(values[static_cast<std::size_t>(index(l, m))] - expected), kTolerance)
            << "l=" << l << " m=" << m;
      }
    }
  }
}

TEST(ShBasis, FirstFunctionsHaveTheStatedSigns) {
  const double x = 0.48;
  const double y = 0.6;
  const double z = 0.64;
  const double k1 = std::sqrt(3.0 / (4.0 * kPi));
  const double k2 = std::sqrt(15.0 / (4.0 * kPi));
  const std::vector<double> expected{std::sqrt(1.0 / (4.0 * kPi)),
                                     -k1 * y,
                                     k1 * z,
                                     -k1 * x,
                                     k2 * x * y,
                                     -k2 * y * z,
                                     std::sqrt(5.0 / (16.0 * kPi)) * (3.0 * z * z - 1.0),
                                     -k2 * x * z,
                                     0.5 * k2 * (x * x - y * y)};
  const std::vector<double> values = evaluate_basis(3, Vec3d(x, y, z));
  for (std::size_t i = 0; i < 9; ++i) EXPECT_LE(std::abs(values[i] - expected[i]), 1e-15) << "i=" << i;
}

TEST(ShBasis, StraightLineCodeMatchesTheRecurrence) {
  for (int bands = 1; bands <= 11; ++bands) {
    for (const Vec3d& d : sh_test::directions(50, 5)) {
      const std::vector<double> fast = evaluate_basis(bands, d);
      const std::vector<double> slow = evaluate_basis_by_recurrence(bands, d);
      ASSERT_EQ(fast.size(), slow.size());
      for (std::size_t i = 0; i < fast.size(); ++i) {
        // Each is within 1e-15 of the truth per degree.
        EXPECT_LE(std::abs(fast[i] - slow[i]), 2e-15 * bands) << "bands=" << bands << " i=" << i;
      }
    }
  }
}

TEST(ShBasis, FewerBandsAreAPrefixOfMore) {
  const Vec3d d = sh_test::directions(1, 9).front();
  const std::vector<double> many = evaluate_basis(30, d);
  for (const int bands : {1, 3, 5, 8, 10, 20}) {
    const std::vector<double> few = evaluate_basis(bands, d);
    for (std::size_t i = 0; i < few.size(); ++i) EXPECT_LE(std::abs(few[i] - many[i]), 2e-14) << bands;
  }
}

TEST(ShBasis, SumOfSquaresIsTheSameEverywhere) {
  for (const int bands : {1, 3, 5, 9, 40}) {
    for (const Vec3d& d : sh_test::directions(20, 11)) {
      double sum = 0.0;
      for (const double value : evaluate_basis(bands, d)) sum += value * value;
      EXPECT_LE(std::abs(sum / (bands * bands / (4.0 * kPi)) - 1.0), 1e-13) << "bands=" << bands;
    }
  }
}

/// Largest error of a +-m pair over its size, near both poles, of what `evaluate` gives for a direction.
template <class Real>
double largest_pair_error(int bands, double largest_angle,
                          const std::function<std::vector<Real>(const Vec3d&)>& evaluate) {
  double result = 0.0;
  for (const Vec3d& exact : sh_test::polar_directions(largest_angle)) {
    const Vec3d d(static_cast<Real>(exact.x), static_cast<Real>(exact.y), static_cast<Real>(exact.z));
    result = worse(result, sh_test::pair_error<Real>(bands, d, evaluate(d)));
  }
  return result;
}

template <class Real>
std::function<std::vector<Real>(const Vec3d&)> basis_at(int bands) {
  return [basis = Basis<Real>(bands)](const Vec3d& d) {
    std::vector<Real> values(static_cast<std::size_t>(basis.coefficient_count()));
    basis.evaluate(static_cast<Real>(d.x), static_cast<Real>(d.y), static_cast<Real>(d.z), values);
    return values;
  };
}

TEST(ShBasis, PairsKeepTheirDigitsAtThePoles) {
  EXPECT_LE(largest_pair_error<double>(5, 0.1, basis_at<double>(5)), 3e-14);
  EXPECT_LE(largest_pair_error<double>(10, 0.1, basis_at<double>(10)), 3e-14);
  EXPECT_LE(largest_pair_error<double>(20, 0.1, basis_at<double>(20)), 3e-14);
  EXPECT_LE(largest_pair_error<float>(5, 0.1, basis_at<float>(5)), 1e-6);
  EXPECT_LE(largest_pair_error<float>(10, 0.1, basis_at<float>(10)), 1e-6);
}
// At 0.1 rad the first zeros of 25 bands and more pass through; further in there are none up to 200.
TEST(ShBasis, PairsKeepTheirDigitsAtThePolesTo200Bands) {
  EXPECT_LE(largest_pair_error<double>(200, 0.01, basis_at<double>(200)), 3e-14);
}

/// The textbook's q_l = a z q_(l-1) - b q_(l-2), which takes z for what it is.
std::vector<double> evaluate_by_powers_of_z(int bands, const Vec3d& d) {
  std::vector<double> values(static_cast<std::size_t>(bands * bands));
  double start = std::sqrt(1.0 / (4.0 * kPi));
  double re = 1.0;
  double im = 0.0;
  for (int m = 0; m < bands; ++m) {
    if (m > 0) {
      const double next = d.y * im - d.x * re;
      im = -d.x * im - d.y * re;
      re = next;
      start *= std::sqrt((2.0 * m + 1.0) / (2.0 * m)) * (m == 1 ? std::sqrt(2.0) : 1.0);
    }
    double previous = 0.0;
    double q = start;
    for (int l = m; l < bands; ++l) {
      if (l > m) {
        const double gap = static_cast<double>(l) * l - static_cast<double>(m) * m;
        const double below = (l - 1.0) * (l - 1.0) - static_cast<double>(m) * m;
        const double b = l == m + 1 ? 0.0 : std::sqrt((2.0 * l + 1.0) / (2.0 * l - 3.0) * below / gap);
        const double next = std::sqrt((4.0 * l * l - 1.0) / gap) * d.z * q - b * previous;
        previous = q;
        q = next;
      }
      values[static_cast<std::size_t>(index(l, m))] = q * re;
      if (m > 0) values[static_cast<std::size_t>(index(l, -m))] = q * im;
    }
  }
  return values;
}
TEST(ShBasis, ThePairCheckSeesTheRoundingOfZ) {
  const auto faulty = [](const Vec3d& d) { return evaluate_by_powers_of_z(200, d); };
  EXPECT_GT(largest_pair_error<double>(200, 0.01, faulty), 3e-13);
}

/// Largest deviation from the identity of the Gram matrix of the functions m >= 0 of each m, by Gauss nodes in z; the
/// azimuth integrates to pi (2 pi at m = 0).
double polar_gram_deviation(int bands, const std::function<std::vector<double>(const Vec3d&)>& basis) {
  const GaussLegendre rule = gauss_legendre(bands);
  std::vector<std::vector<double>> rows;
  for (const double z : rule.nodes) rows.push_back(basis(Vec3d(std::sqrt((1.0 - z) * (1.0 + z)), 0.0, z)));
  double result = 0.0;
  for (int m = 0; m < bands; ++m) {
    for (int l = m; l < bands; ++l) {
      for (int k = m; k <= l; ++k) {
        double sum = 0.0;
        for (std::size_t j = 0; j < rows.size(); ++j) {
          sum += rule.weights[j] * rows[j][static_cast<std::size_t>(index(l, m))] *
                 rows[j][static_cast<std::size_t>(index(k, m))];
        }
        result = worse(result, std::abs((m > 0 ? kPi : 2.0 * kPi) * sum - (l == k ? 1.0 : 0.0)));
      }
    }
  }
  return result;
}
TEST(ShBasis, IsOrthonormalTo200Bands) {
  EXPECT_LE(polar_gram_deviation(200, basis_at<double>(200)), 1e-12);
}
TEST(ShBasis, TheGramMatrixSeesAWrongDigit) {
  const auto faulty = [basis = basis_at<double>(20)](const Vec3d& d) {
    std::vector<double> values = basis(d);
    values[static_cast<std::size_t>(index(19, 7))] *= 1.0 + 2e-12;
    return values;
  };
  EXPECT_GT(polar_gram_deviation(20, faulty), 1e-12);
}

template <class Real>
void expect_finite(int bands) {
  const Basis<Real> basis(bands);
  std::vector<Real> values(static_cast<std::size_t>(basis.coefficient_count()));
  std::vector<Vec3d> directions = sh_test::directions(5, 13);
  for (const double angle : {0.0, 1e-30, 1e-8, 1e-3, 0.05, 0.3, 0.5 * kPi, kPi}) {
    directions.emplace_back(std::sin(angle), 0.0, std::cos(angle));
    directions.emplace_back(0.0, -std::sin(angle), -std::cos(angle));
  }
  for (const Vec3d& d : directions) {
    basis.evaluate(static_cast<Real>(d.x), static_cast<Real>(d.y), static_cast<Real>(d.z), values);
    double sum = 0.0;
    for (const Real value : values) sum += static_cast<double>(value) * static_cast<double>(value);
    // The sum of squares is n^2 / (4 pi); z's rounding near a pole costs l^2/2 roundings of each y_l0, and
    // the whole sphere's rounding of |d| costs l.
    const double expected = static_cast<double>(bands) * bands / (4.0 * kPi);
    const double rounding = static_cast<double>(std::numeric_limits<Real>::epsilon());
    EXPECT_LE(std::abs(sum / expected - 1.0), 2.0 * bands * bands * rounding)
        << d.x << " " << d.y << " " << d.z;
  }
}
TEST(ShBasis, IsFiniteTo200BandsInFloat) {
  expect_finite<float>(64);
  expect_finite<float>(200);
}
TEST(ShBasis, IsFiniteTo1000BandsInDouble) {
  expect_finite<double>(kMaxBands);
}

TEST(ShBasis, RefusesBandsOutOfRangeAndShortOutput) {
  for (const int bands : {-1, 0, kMaxBands + 1}) EXPECT_THROW(Basis<float>{bands}, InputError);
  const Basis<double> basis(4);
  std::vector<double> values(15);
  EXPECT_THROW(basis.evaluate(0.0, 0.0, 1.0, values), InputError);
}

}  // namespace
}  // namespace plumbline::sh
