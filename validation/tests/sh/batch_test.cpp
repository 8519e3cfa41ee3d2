// The batch basis on every instruction set of this machine: against quadruple precision, the single-direction basis and
// itself.
#include "prt/sh/batch.hpp"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <functional>

#include "reference/base/error.hpp"
#include "validation/tests/sh/oracle.hpp"

namespace plumbline::sh {
namespace {

template <class Real>
struct Arrays {
  std::vector<Real> x, y, z;
  explicit Arrays(const std::vector<Vec3d>& directions) {
    for (const Vec3d& d : directions) {
      x.push_back(static_cast<Real>(d.x));
      y.push_back(static_cast<Real>(d.y));
      z.push_back(static_cast<Real>(d.z));
    }
  }
  [[nodiscard]] Directions<Real> spans() const { return {x, y, z}; }
  [[nodiscard]] std::size_t size() const { return x.size(); }
  [[nodiscard]] Vec3d direction(std::size_t k) const { return Vec3d(x[k], y[k], z[k]); }
};

template <class Real>
std::vector<Real> evaluated(int bands, const Arrays<Real>& in, int threads = 1) {
  std::vector<Real> values(in.size() * static_cast<std::size_t>(bands * bands));
  BatchBasis<Real>(bands).evaluate(in.spans(), values, threads);
  return values;
}

template <class Real>
std::vector<Real> row(const std::vector<Real>& values, int bands, std::size_t k) {
  const auto size = static_cast<std::ptrdiff_t>(bands * bands);
  const auto first = values.begin() + static_cast<std::ptrdiff_t>(k) * size;
  return {first, first + size};
}

/// The larger; NaN stays.
double worse(double a, double b) {
  return std::isnan(a) || a >= b ? a : b;
}

template <class Real>
double largest_error(int bands, int count) {
  const Arrays<Real> in(sh_test::directions(count, 7));
  const std::vector<Real> values = evaluated(bands, in);
  double error = 0.0;
  for (std::size_t k = 0; k < in.size(); ++k) {
    const std::vector<sh_test::Quad> truth = sh_test::evaluate(bands, in.direction(k));
    const std::vector<Real> y = row(values, bands, k);
    for (std::size_t i = 0; i < y.size(); ++i) {
      error = worse(error, std::abs(static_cast<double>(sh_test::Quad(y[i]) - truth[i])));
    }
  }
  return error;
}

template <class Real>
double largest_pair_error(int bands, double largest_angle) {
  const Arrays<Real> in(sh_test::polar_directions(largest_angle));
  const std::vector<Real> values = evaluated(bands, in);
  double error = 0.0;
  for (std::size_t k = 0; k < in.size(); ++k) {
    error = worse(error, sh_test::pair_error<Real>(bands, in.direction(k), row(values, bands, k)));
  }
  return error;
}

/// Runs `check` with each instruction set that the machine has.
void on_every_instruction_set(const std::function<void()>& check) {
  for (const auto& [set, name] : {std::pair{HWY_AVX3, "AVX-512"}, std::pair{HWY_AVX2, "AVX2"},
                                  std::pair{HWY_SSSE3, "SSSE3"}, std::pair{HWY_SCALAR, "scalar"}}) {
    if (set != HWY_SCALAR && (hwy::SupportedTargets() & set) == 0) continue;
    SCOPED_TRACE(name);
    hwy::GetChosenTarget().Update(set);
    check();
  }
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

// The bounds are the accuracy the header states.
TEST(ShBatch, IsAccurateInDouble) {
  on_every_instruction_set([] {
    EXPECT_LE(largest_error<double>(5, 200), 3e-15);
    EXPECT_LE(largest_error<double>(6, 200), 3e-15);
    EXPECT_LE(largest_error<double>(20, 50), 4e-14);
    EXPECT_LE(largest_error<double>(64, 5), 2e-13);
  });
  EXPECT_LE(largest_error<double>(200, 2), 2e-13);
}
TEST(ShBatch, IsAccurateInFloat) {
  on_every_instruction_set([] {
    EXPECT_LE(largest_error<float>(5, 1000), 7e-7);
    EXPECT_LE(largest_error<float>(6, 1000), 7e-7);
    EXPECT_LE(largest_error<float>(10, 300), 2.5e-6);
    EXPECT_LE(largest_error<float>(20, 50), 1e-5);
    EXPECT_LE(largest_error<float>(64, 5), 3e-5);
  });
}

TEST(ShBatch, PairsKeepTheirDigitsAtThePoles) {
  on_every_instruction_set([] {
    EXPECT_LE(largest_pair_error<double>(5, 0.1), 3e-14);
    EXPECT_LE(largest_pair_error<double>(20, 0.1), 3e-14);
    EXPECT_LE(largest_pair_error<float>(5, 0.1), 1e-6);
    EXPECT_LE(largest_pair_error<float>(10, 0.1), 1e-6);
  });
  EXPECT_LE(largest_pair_error<double>(200, 0.01), 3e-14);
}

// Each is within the accuracy of its header of the truth.
TEST(ShBatch, AgreesWithTheSingleDirectionBasis) {
  const Arrays<double> in(sh_test::directions(37, 3));
  on_every_instruction_set([&] {
    for (int bands = 1; bands <= 12; ++bands) {
      const Basis<double> basis(bands);
      const std::vector<double> values = evaluated(bands, in);
      std::vector<double> expected(static_cast<std::size_t>(bands * bands));
      for (std::size_t k = 0; k < in.size(); ++k) {
        basis.evaluate(in.x[k], in.y[k], in.z[k], expected);
        for (std::size_t i = 0; i < expected.size(); ++i) {
          ASSERT_LE(std::abs(values[k * expected.size() + i] - expected[i]), 1e-15 * bands)
              << bands << " " << i;
        }
      }
    }
  });
}

template <class Real>
void expect_one_layout_as_the_other(int bands, int count) {
  const Arrays<Real> in(sh_test::directions(count, 5));
  const BatchBasis<Real> basis(bands);
  std::vector<Real> blocked(blocked_size(bands, in.size()));
  basis.evaluate_blocked(in.spans(), blocked);
  const std::vector<Real> rows = evaluated(bands, in);
  const auto size = static_cast<std::size_t>(bands * bands);
  for (std::size_t k = 0; k < in.size(); ++k) {
    for (std::size_t i = 0; i < size; ++i) {
      ASSERT_EQ(rows[k * size + i], blocked[blocked_index(bands, k, i)]) << bands << " " << k << " " << i;
    }
  }
}
TEST(ShBatch, BothLayoutsHoldTheSameBits) {
  on_every_instruction_set([] {
    for (int bands = 1; bands <= 9; ++bands) {
      for (const int count : {1, 15, 16, 17, 100}) {
        expect_one_layout_as_the_other<float>(bands, count);
        expect_one_layout_as_the_other<double>(bands, count);
      }
    }
    expect_one_layout_as_the_other<float>(300, 3);
  });
}

TEST(ShBatch, BitsDependNeitherOnThreadsNorOnThePlace) {
  const Arrays<float> in(sh_test::directions(10000, 9));
  for (const int bands : {3, 7}) {
    const std::vector<float> once = evaluated(bands, in, 1);
    EXPECT_EQ(once, evaluated(bands, in, 3));
    for (const std::size_t k : {std::size_t{17}, std::size_t{9999}}) {
      EXPECT_EQ(evaluated(bands, Arrays<float>({in.direction(k)})), row(once, bands, k));
    }
  }
}

// The sum of squares is n^2 / (4 pi); each band's share is off by about l roundings of the direction's length.
TEST(ShBatch, IsFiniteInFloatAtAnyNumberOfBands) {
  std::vector<Vec3d> directions = sh_test::directions(4, 13);
  for (const double angle : {0.0, 1e-30, 1e-8, 1e-3, 0.05, 0.3, 0.5 * kPi, kPi}) {
    directions.emplace_back(std::sin(angle), 0.0, std::cos(angle));
    directions.emplace_back(0.0, -std::sin(angle), -std::cos(angle));
  }
  const Arrays<float> in(directions);
  for (const int bands : {20, 64, 65, 200, 256, 257}) {
    const std::vector<float> values = evaluated(bands, in);
    for (std::size_t k = 0; k < in.size(); ++k) {
      double sum = 0.0;
      for (const float value : row(values, bands, k)) sum += static_cast<double>(value) * value;
      EXPECT_LE(std::abs(sum * 4.0 * kPi / (bands * bands) - 1.0), 2.0 * bands * 1.2e-7) << bands << " " << k;
    }
  }
}

TEST(ShBatch, ANaNStaysWithItsDirection) {
  Arrays<float> in(sh_test::directions(20, 2));
  in.y[5] = std::nanf("");
  for (const int bands : {5, 8}) {
    const std::vector<float> values = evaluated(bands, in);
    for (std::size_t k = 0; k < in.size(); ++k) {
      EXPECT_EQ(std::isnan(row(values, bands, k).back()), k == 5) << k;
    }
  }
}

// ---------------------------------------------------------------- functions

ShRgb some_function(int bands) {
  ShRgb result{bands, {}};
  for (int i = 0; i < bands * bands; ++i) {
    result.coefficients.emplace_back(std::sin(1.0 + i), std::cos(2.0 * i), 1.0 / (1.0 + i));
  }
  return result;
}

template <class Real>
double largest_sum_error(int bands) {
  const ShRgb function = some_function(bands);
  const Arrays<Real> in(sh_test::directions(77, 21));
  std::vector<Real> r(in.size()), g(in.size()), b(in.size());
  BatchFunction<Real>(function).evaluate(in.spans(), {r, g, b});
  double size = 0.0;
  for (const RgbD& c : function.coefficients) size += c.r * c.r;
  double error = 0.0;
  for (std::size_t k = 0; k < in.size(); ++k) {
    const RgbD expected = evaluate(function, in.direction(k));
    error = worse(error, std::abs(r[k] - expected.r));
    error = worse(error, std::abs(g[k] - expected.g));
    error = worse(error, std::abs(b[k] - expected.b));
  }
  return error / (std::sqrt(size) * std::numeric_limits<Real>::epsilon());
}

// n^2 terms of size about n / sqrt(4 pi n^2) = 0.3 each of the root of the summed squares; their roundings add up to at
// most n times that, and the basis itself is off by about n roundings.
TEST(ShBatch, SumsAreThoseOfTheBasis) {
  on_every_instruction_set([] {
    for (const int bands : {1, 2, 3, 4, 5, 6, 7, 10, 21}) {
      EXPECT_LE(largest_sum_error<double>(bands), 2.0 * bands) << bands;
      EXPECT_LE(largest_sum_error<float>(bands), 2.0 * bands) << bands;
    }
  });
  EXPECT_LE(largest_sum_error<float>(300), 600.0);
}

TEST(ShBatch, SumsAreTheSameForAnyNumberOfThreads) {
  const Arrays<float> in(sh_test::directions(10001, 9));
  const BatchFunction<float> function(some_function(5));
  std::vector<float> one[3], more[3];
  for (std::size_t c = 0; c < 3; ++c) one[c].resize(in.size()), more[c].resize(in.size());
  function.evaluate(in.spans(), {one[0], one[1], one[2]}, 1);
  function.evaluate(in.spans(), {more[0], more[1], more[2]}, 4);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(one[c], more[c]);
}

TEST(ShBatch, RefusesWhatDoesNotFit) {
  EXPECT_THROW(BatchBasis<float>(0), InputError);
  EXPECT_THROW(BatchFunction<float>(ShRgb{3, std::vector<RgbD>(8)}), InputError);
  const BatchBasis<double> basis(3);
  const std::vector<double> two(2), three(3);
  std::vector<double> values(26);
  EXPECT_THROW(basis.evaluate({three, three, two}, values), InputError);
  EXPECT_THROW(basis.evaluate({three, three, three}, values), InputError);
  EXPECT_THROW(basis.evaluate_blocked({three, three, three}, values), InputError);
  std::vector<double> out(3), shorter(2);
  EXPECT_THROW(BatchFunction<double>(some_function(3)).evaluate({three, three, three}, {out, shorter, out}),
               InputError);
}

}  // namespace
}  // namespace plumbline::sh
