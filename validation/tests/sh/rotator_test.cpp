// sh::Rotator and apply_to_many against the double matrices and quadrature.
#include "prt/sh/rotator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "prt/sh/rotation_methods.hpp"
#include "reference/base/error.hpp"
#include "validation/tests/sh/rotations.hpp"

namespace plumbline::sh {
namespace {

using sh_test::hard_rotations;
using sh_test::largest_difference;
using sh_test::random_rotation;
using sh_test::random_vector;
using sh_test::turn;
using sh_test::Uniform;

std::vector<float> as_float(const std::vector<double>& v) {
  std::vector<float> result;
  for (const double x : v) result.push_back(static_cast<float>(x));
  return result;
}
std::vector<double> as_double(const std::vector<float>& v) {
  return {v.begin(), v.end()};
}

/// Turns about z, tilted by 1e-8 … 0.1: where Euler angles are nearly singular and thresholds bite.
std::vector<glm::dmat3> nearly_about_z() {
  std::vector<glm::dmat3> result;
  Uniform uniform(31);
  for (double tilt = 1e-8; tilt < 0.1; tilt *= 1.7) {
    for (const double flip : {0.0, kPi}) {
      const Vec3d axis(uniform(), uniform(), 1e-3 * uniform());
      result.push_back(turn(axis, flip + tilt) * turn(Vec3d(0.0, 0.0, 1.0), kPi * uniform()));
    }
  }
  return result;
}

/// Largest error over many rotations, each of a new function with coefficients in [-1, 1].
double worst_error(const Rotator<float>& rotator, int random_rotations) {
  std::vector<glm::dmat3> rotations = hard_rotations();
  for (const glm::dmat3& r : nearly_about_z()) rotations.push_back(r);
  Uniform uniform(32);
  for (int i = 0; i < random_rotations; ++i) rotations.push_back(random_rotation(uniform));
  double worst = 0.0;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    const std::vector<float> f = as_float(random_vector(rotator.bands(), static_cast<unsigned>(i)));
    std::vector<float> turned(f.size());
    rotator.apply(rotations[i], f, turned);
    const double error = largest_difference(as_double(turned), rotate(as_double(f), rotations[i]));
    worst = std::isnan(worst) || worst >= error ? worst : error;
  }
  return worst;
}

// Bounds: the goals this library sets itself, 1e-6 for the few bands that are turned every frame.
TEST(ShRotator, FloatIsGoodForEveryRotation) {
  for (int bands = 1; bands <= 6; ++bands) {
    const double error = worst_error(Rotator<float>(bands), 20000);
    RecordProperty("worst_" + std::to_string(bands), std::to_string(error * 1e9) + "e-9");
    EXPECT_LE(error, 3e-6) << bands;
  }
  for (const int bands : {7, 8, 9, 10, 20}) {
    const double error = worst_error(Rotator<float>(bands), 1000);
    RecordProperty("worst_" + std::to_string(bands), std::to_string(error * 1e9) + "e-9");
    EXPECT_LE(error, 3e-6) << bands;
  }
}

TEST(ShRotator, DoubleAgreesWithTheMatricesForEveryRotation) {
  for (const int bands : {1, 2, 5, 20, 40}) {
    const Rotator<double> rotator(bands);
    const std::vector<double> f = random_vector(bands, 33);
    std::vector<double> turned(f.size());
    std::vector<glm::dmat3> rotations = hard_rotations();
    for (const glm::dmat3& r : nearly_about_z()) rotations.push_back(r);
    for (std::size_t i = 0; i < rotations.size(); ++i) {
      rotator.apply(rotations[i], f, turned);
      EXPECT_LE(largest_difference(turned, rotate(f, rotations[i])), 1e-12) << bands << " " << i;
    }
  }
}

TEST(ShRotator, AgreesWithReprojection) {
  const glm::dmat3 r = turn(Vec3d(1.0, -2.0, 0.5), 2.0);
  for (const int bands : {2, 3, 4, 5, 6, 7, 8, 9}) {
    const std::vector<double> f = random_vector(bands, 34);
    std::vector<float> turned(f.size());
    Rotator<float>(bands).apply(r, as_float(f), turned);
    EXPECT_LE(largest_difference(as_double(turned), rotate_by_projection(f, r)), 2e-6) << bands;
  }
}

TEST(ShRotator, InputAndOutputMayBeTheSame) {
  const glm::dmat3 r = turn(Vec3d(1.0, -2.0, 0.5), 2.0);
  for (const int bands : {1, 2, 3, 5, 8, 12}) {
    std::vector<float> f = as_float(random_vector(bands, 35));
    std::vector<float> turned(f.size());
    const Rotator<float> rotator(bands);
    rotator.apply(r, f, turned);
    rotator.apply(r, f, f);
    EXPECT_EQ(f, turned) << bands;
  }
}

TEST(ShRotator, WritesNothingBehindItsOutput) {
  for (const int bands : {2, 3, 4, 5, 6, 7, 8, 9}) {
    const auto size = static_cast<std::size_t>(bands * bands);
    std::vector<float> room(size + 16, 7.0F);
    const std::vector<float> f = as_float(random_vector(bands, 36));
    Rotator<float>(bands).apply(turn(Vec3d(1.0, 2.0, 3.0), 1.0), f, std::span(room).first(size));
    for (std::size_t i = size; i < room.size(); ++i) EXPECT_EQ(room[i], 7.0F) << bands;
  }
}

TEST(ShRotator, BadNumbersSpreadThroughTheirDegreeOnly) {
  for (const int bands : {5, 6, 12}) {
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
      std::vector<float> f = as_float(random_vector(bands, 37));
      f[static_cast<std::size_t>(index(3, 1))] = bad;
      Rotator<float>(bands).apply(turn(Vec3d(1.0, 2.0, 3.0), 1.0), f, f);
      for (int l = 0; l < bands; ++l) {
        bool is_all_finite = true;
        for (int m = -l; m <= l; ++m)
          is_all_finite &= std::isfinite(f[static_cast<std::size_t>(index(l, m))]);
        EXPECT_EQ(is_all_finite, l != 3) << bands << " " << l;
      }
    }
  }
}

TEST(ShRotator, ScalesWithItsInput) {
  const glm::dmat3 r = turn(Vec3d(1.0, 2.0, 3.0), 1.0);
  for (const int bands : {5, 12}) {
    const Rotator<float> rotator(bands);
    const std::vector<float> f = as_float(random_vector(bands, 38));
    std::vector<float> expected(f.size());
    rotator.apply(r, f, expected);
    // Powers of two: bit for bit, as long as nothing is denormal.
    for (const float scale : {0x1p100F, 0x1p-80F}) {
      std::vector<float> scaled = f;
      for (float& x : scaled) x *= scale;
      rotator.apply(r, scaled, scaled);
      for (std::size_t i = 0; i < f.size(); ++i) {
        EXPECT_LE(std::abs(scaled[i] / scale - expected[i]), 1e-6F) << scale;
      }
    }
    std::vector<float> zero(f.size());
    rotator.apply(r, zero, zero);
    for (const float x : zero) EXPECT_EQ(x, 0.0F);
    // Denormal numbers are multiples of 2^-149: their rounding is a matter of tens of these.
    std::vector<float> denormal = f;
    for (float& x : denormal) x *= 0x1p-140F;
    rotator.apply(r, denormal, denormal);
    for (std::size_t i = 0; i < f.size(); ++i) {
      EXPECT_LE(std::abs(denormal[i] * 0x1p100F - expected[i] * 0x1p-40F), 100 * 0x1p-49F);
    }
  }
}

TEST(ShRotator, RefusesWrongLengthsAndWhatIsNoRotation) {
  std::vector<float> f(25);
  std::vector<float> room(24);
  const Rotator<float> rotator(5);
  EXPECT_THROW(rotator.apply(glm::dmat3(1.0), f, room), InputError);
  EXPECT_THROW(rotator.apply(glm::dmat3(1.0), room, f), InputError);
  EXPECT_THROW(rotator.apply(glm::dmat3(2.0), f, f), InputError);
  EXPECT_THROW(Rotator<double>(0), InputError);
  EXPECT_THROW(Rotator<float>(kMaxBands + 1), InputError);
}

TEST(ShRotator, ManyFunctionsAtOnce) {
  const glm::dmat3 r = turn(Vec3d(1.0, 2.0, 3.0), 1.0);
  for (const int bands : {1, 3, 5, 12}) {
    for (const std::size_t count :
         {std::size_t{0}, std::size_t{1}, std::size_t{7}, std::size_t{16}, std::size_t{100}}) {
      const auto size = static_cast<std::size_t>(bands * bands);
      std::vector<float> in(size * count);
      std::vector<float> out(size * count);
      for (std::size_t v = 0; v < count; ++v) {
        const std::vector<double> f = random_vector(bands, static_cast<unsigned>(40 + v));
        for (std::size_t i = 0; i < size; ++i) in[i * count + v] = static_cast<float>(f[i]);
      }
      apply_to_many(Rotation(r, bands), count, in, out);
      for (std::size_t v = 0; v < count; ++v) {
        std::vector<double> one;
        std::vector<double> turned;
        for (std::size_t i = 0; i < size; ++i) one.push_back(static_cast<double>(in[i * count + v]));
        for (std::size_t i = 0; i < size; ++i) turned.push_back(static_cast<double>(out[i * count + v]));
        EXPECT_LE(largest_difference(turned, rotate(one, r)), 1e-6) << bands << " " << count << " " << v;
      }
    }
  }
  std::vector<float> wrong(24);
  EXPECT_THROW(apply_to_many(Rotation(r, 5), 1, wrong, wrong), InputError);
}

}  // namespace
}  // namespace plumbline::sh
