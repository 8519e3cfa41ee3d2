// sh::Rotation and the other methods against quadrature, closed forms, group laws and planted faults.
#include "prt/sh/rotation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "prt/sh/quadrature.hpp"
#include "prt/sh/rotation_methods.hpp"
#include "prt/sh/zonal.hpp"
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

std::vector<double> applied(const Rotation& rotation, const std::vector<double>& in) {
  std::vector<double> out(in.size());
  rotation.apply(in, out);
  return out;
}

TEST(ShRotation, MatchesReprojectionAtHardAndRandomRotations) {
  const std::vector<double> f = random_vector(20, 1);
  std::vector<glm::dmat3> rotations = hard_rotations();
  Uniform uniform(2);
  for (int i = 0; i < 20; ++i) rotations.push_back(random_rotation(uniform));
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    const std::vector<double> truth = rotate_by_projection(f, rotations[i]);
    EXPECT_LE(largest_difference(rotate(f, rotations[i]), truth), 1e-12) << i;
  }
}

// The cheap form for many rotations: both sides at one point. f'(w) = f(R^-1 w).
TEST(ShRotation, RotatedFunctionIsTheFunctionOfTheRotatedDirection) {
  constexpr int kBands = 20;
  const std::vector<double> f = random_vector(kBands, 3);
  Uniform uniform(4);
  const Basis<double> basis(kBands);
  std::vector<double> here(f.size());
  std::vector<double> there(f.size());
  double worst = 0.0;
  for (int i = 0; i < 10000; ++i) {
    const glm::dmat3 r = random_rotation(uniform);
    const Vec3d w = glm::normalize(Vec3d(uniform(), uniform(), uniform() + 1e-3));
    const Vec3d back = glm::normalize(glm::transpose(r) * w);
    basis.evaluate(w.x, w.y, w.z, here);
    basis.evaluate(back.x, back.y, back.z, there);
    // y(R^-1 w) = D^T y(w): one vector each way checks the whole of D against the definition.
    std::vector<double> turned(f.size());
    Rotation(r, kBands).apply_inverse(here, turned);
    worst = std::max(worst, largest_difference(turned, there));
  }
  EXPECT_LE(worst, 1e-12);
}

// |D^T D - 1|, and D(a) D(b) = D(ab), both through vectors: 10^4 pairs of 20 bands.
TEST(ShRotation, ComposesAndKeepsAnglesBetweenFunctions) {
  constexpr int kBands = 20;
  const std::vector<double> f = random_vector(kBands, 5);
  Uniform uniform(6);
  double worst_product = 0.0;
  double worst_inverse = 0.0;
  for (int i = 0; i < 10000; ++i) {
    const glm::dmat3 a = random_rotation(uniform);
    const glm::dmat3 b = random_rotation(uniform);
    const std::vector<double> once = rotate(f, b);
    worst_product = std::max(worst_product, largest_difference(rotate(once, a), rotate(f, a * b)));
    std::vector<double> back(f.size());
    Rotation(b, kBands).apply_inverse(once, back);
    worst_inverse = std::max(worst_inverse, largest_difference(back, f));
  }
  EXPECT_LE(worst_product, 1e-12);
  EXPECT_LE(worst_inverse, 1e-12);
}

TEST(ShRotation, ComposesAtHardRotations) {
  const std::vector<double> f = random_vector(20, 7);
  const std::vector<glm::dmat3> rotations = hard_rotations();
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    const glm::dmat3& a = rotations[i];
    const glm::dmat3& b = rotations[(7 * i + 3) % rotations.size()];
    EXPECT_LE(largest_difference(rotate(rotate(f, b), a), rotate(f, a * b)), 1e-12) << i;
  }
}

TEST(ShRotation, TracesAreTheCharactersOfTheAngle) {
  for (const double angle : {kPi / 2.0, kPi / 3.0, 2.5}) {
    const Rotation rotation(turn(Vec3d(1.0, -2.0, 0.5), angle), 20);
    for (int l = 0; l < 20; ++l) {
      double trace = 0.0;
      for (int m = -l; m <= l; ++m) {
        trace += rotation.band(l)[static_cast<std::size_t>((m + l) * (2 * l + 1) + m + l)];
      }
      EXPECT_LE(std::abs(trace - std::sin((l + 0.5) * angle) / std::sin(0.5 * angle)), 1e-12) << l;
    }
  }
  // 90 degrees: 1, 1, -1, -1, 1, ... from degree 0 on.
  const Rotation quarter(turn(Vec3d(0.0, 1.0, 0.0), kPi / 2.0), 5);
  const std::vector<double> expected{1.0, 1.0, -1.0, -1.0, 1.0};
  for (int l = 0; l < 5; ++l) {
    double trace = 0.0;
    for (int m = 0; m <= 2 * l; ++m) trace += quarter.band(l)[static_cast<std::size_t>(m * (2 * l + 2))];
    EXPECT_LE(std::abs(trace - expected[static_cast<std::size_t>(l)]), 1e-14) << l;
  }
}

TEST(ShRotation, KeepsTheEnergyOfEachBand) {
  const std::vector<double> f = random_vector(20, 8);
  for (const glm::dmat3& r : hard_rotations()) {
    const std::vector<double> turned = rotate(f, r);
    for (int l = 0; l < 20; ++l) {
      double before = 0.0;
      double after = 0.0;
      for (int m = -l; m <= l; ++m) {
        const auto i = static_cast<std::size_t>(index(l, m));
        before += f[i] * f[i];
        after += turned[i] * turned[i];
      }
      EXPECT_LE(std::abs(after - before), 1e-12 * before) << l;
    }
  }
}

TEST(ShRotation, TurnsAZonalFunctionToItsAxis) {
  const std::vector<double> zonal = cap(20, 0.4);
  const std::vector<double> up = rotate_zonal(zonal, Vec3d(0.0, 0.0, 1.0));
  Uniform uniform(9);
  for (int i = 0; i < 20; ++i) {
    const glm::dmat3 r = random_rotation(uniform);
    EXPECT_LE(largest_difference(rotate(up, r), rotate_zonal(zonal, r[2])), 1e-13) << i;
  }
  // y_20 from +z to +x: -1/2 y_20 + sqrt(3)/2 y_22.
  const std::vector<double> y20{0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0};
  const std::vector<double> turned = rotate(y20, turn(Vec3d(0.0, 1.0, 0.0), kPi / 2.0));
  EXPECT_LE(std::abs(turned[6] + 0.5), 1e-15);
  EXPECT_LE(std::abs(turned[8] - std::sqrt(3.0) / 2.0), 1e-15);
}

TEST(ShRotation, IdentityChangesNothing) {
  const std::vector<double> f = random_vector(20, 10);
  EXPECT_LE(largest_difference(rotate(f, glm::dmat3(1.0)), f), 1e-14);
}

// ---------------------------------------------------------------- planted faults: each must be seen

/// What MatchesReprojection would report for an implementation `faulty(f, r)`.
template <class Faulty>
double reprojection_error(const Faulty& faulty) {
  const std::vector<double> f = random_vector(6, 11);
  Uniform uniform(12);
  double worst = 0.0;
  for (int i = 0; i < 5; ++i) {
    const glm::dmat3 r = random_rotation(uniform);
    worst = std::max(worst, largest_difference(faulty(f, r), rotate_by_projection(f, r)));
  }
  return worst;
}

TEST(ShRotation, ReprojectionCatchesTransposedMatrices) {
  const auto faulty = [](const std::vector<double>& f, const glm::dmat3& r) {
    return rotate(f, glm::transpose(r));
  };
  EXPECT_GT(reprojection_error(faulty), 0.1);
}

// Right in one sign convention, used in the other: both ways around, odd m change sign.
TEST(ShRotation, ReprojectionCatchesTheOtherSignConvention) {
  const auto flipped = [](std::vector<double> f) {
    for (int l = 0; l < 6; ++l) {
      for (int m = -l; m <= l; ++m) {
        if (m % 2 != 0) f[static_cast<std::size_t>(index(l, m))] *= -1.0;
      }
    }
    return f;
  };
  const auto faulty = [&](const std::vector<double>& f, const glm::dmat3& r) {
    return flipped(rotate(flipped(f), r));
  };
  EXPECT_GT(reprojection_error(faulty), 0.1);
}

TEST(ShRotation, ReprojectionCatchesTheWrongOrderOfComposition) {
  const glm::dmat3 a = turn(Vec3d(1.0, 0.0, 0.0), 0.3);
  const auto faulty = [&](const std::vector<double>& f, const glm::dmat3& r) {
    return rotate(rotate(f, a), r * glm::transpose(a));
  };
  const auto swapped = [&](const std::vector<double>& f, const glm::dmat3& r) {
    return rotate(rotate(f, r * glm::transpose(a)), a);
  };
  EXPECT_LE(reprojection_error(faulty), 1e-13);
  EXPECT_GT(reprojection_error(swapped), 0.1);
}

// One sign inside one degree (sh-lib's rows m = +-3 of degree 4): keeps the energy, fails the definition.
TEST(ShRotation, ReprojectionCatchesOneWrongRow) {
  const auto faulty = [](const std::vector<double>& f, const glm::dmat3& r) {
    std::vector<double> turned = rotate(f, r);
    turned[static_cast<std::size_t>(index(4, 3))] *= -1.0;
    return turned;
  };
  EXPECT_GT(reprojection_error(faulty), 0.01);
}

// ---------------------------------------------------------------- what is taken and what is refused

TEST(ShRotation, RefusesWhatIsNoRotation) {
  const std::vector<double> f = random_vector(3, 13);
  const double nan = std::nan("");
  const double inf = std::numeric_limits<double>::infinity();
  glm::dmat3 mirror(1.0);
  mirror[0].x = -1.0;
  glm::dmat3 shear(1.0);
  shear[1].x = 2e-4;
  glm::dmat3 broken(1.0);
  broken[2].y = nan;
  glm::dmat3 infinite(1.0);
  infinite[2].y = inf;
  for (const glm::dmat3& m : {mirror, shear, broken, infinite, glm::dmat3(0.0), glm::dmat3(1.01)}) {
    EXPECT_THROW(static_cast<void>(rotate(f, m)), InputError);
  }
  EXPECT_THROW(static_cast<void>(rotate(std::vector<double>(5), glm::dmat3(1.0))), InputError);
  EXPECT_THROW(static_cast<void>(rotate(std::vector<double>(), glm::dmat3(1.0))), InputError);
  EXPECT_THROW(static_cast<void>(rotate(ShRgb{3, std::vector<RgbD>(4)}, glm::dmat3(1.0))), InputError);
  EXPECT_THROW(Rotation(glm::dmat3(1.0), 0), InputError);
  EXPECT_THROW(static_cast<void>(Rotation(glm::dmat3(1.0), 3).band(3)), InputError);
  std::vector<double> room(4);
  EXPECT_THROW(Rotation(glm::dmat3(1.0), 3).apply(f, room), InputError);
  EXPECT_THROW(Rotation(glm::dmat3(1.0), 3).apply_inverse(f, room), InputError);
}

TEST(ShRotation, TakesAFloatMatrixAsTheNearestRotation) {
  Uniform uniform(14);
  for (int i = 0; i < 100; ++i) {
    const glm::dmat3 r = random_rotation(uniform);
    const RotationMatrix nearest{glm::dmat3(glm::mat3(r))};
    const glm::dmat3 gram = glm::transpose(nearest.matrix()) * nearest.matrix();
    for (int j = 0; j < 3; ++j) {
      EXPECT_LE(glm::length(gram[j] - glm::dmat3(1.0)[j]), 1e-15);
      EXPECT_LE(glm::length(nearest.matrix()[j] - r[j]), 2e-7);
    }
  }
}

TEST(ShRotation, DividesTheLengthOfAQuaternionOut) {
  const glm::dquat q(0.3, -0.5, 0.7, 0.2);
  const glm::dmat3 expected = rotation_from_quaternion(q).matrix();
  for (const double scale : {-1.0, 3.0, 1e-200, 1e200}) {
    const glm::dmat3 r = rotation_from_quaternion(q * scale).matrix();
    for (int j = 0; j < 3; ++j) EXPECT_LE(glm::length(r[j] - expected[j]), 1e-15) << scale;
  }
  EXPECT_THROW(static_cast<void>(rotation_from_quaternion(glm::dquat(0.0, 0.0, 0.0, 0.0))), InputError);
  EXPECT_THROW(static_cast<void>(rotation_from_quaternion(glm::dquat(1.0, std::nan(""), 0.0, 0.0))),
               InputError);
}

TEST(ShRotation, EulerAnglesGiveTheRotationBack) {
  std::vector<glm::dmat3> rotations = hard_rotations();
  Uniform uniform(15);
  for (int i = 0; i < 1000; ++i) rotations.push_back(random_rotation(uniform));
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    const glm::dmat3 r = rotation_from_euler(euler_of(RotationMatrix(rotations[i]))).matrix();
    for (int j = 0; j < 3; ++j) EXPECT_LE(glm::length(r[j] - rotations[i][j]), 2e-15) << i;
  }
  // gamma first, right-handed: a quarter turn about z takes x to y, then one about y takes z to x.
  const glm::dmat3 r = rotation_from_euler({0.0, kPi / 2.0, kPi / 2.0}).matrix();
  EXPECT_LE(glm::length(r * Vec3d(1.0, 0.0, 0.0) - Vec3d(0.0, 1.0, 0.0)), 1e-15);
  EXPECT_LE(glm::length(r * Vec3d(0.0, 0.0, 1.0) - Vec3d(1.0, 0.0, 0.0)), 1e-15);
  EXPECT_THROW(static_cast<void>(rotation_from_euler({0.0, std::nan(""), 0.0})), InputError);
}

// ---------------------------------------------------------------- the other methods

TEST(ShRotationMethods, FactorisationAgreesAtHardAndRandomRotations) {
  const std::vector<double> f = random_vector(20, 16);
  const ZxzxzRotator rotator(20);
  std::vector<glm::dmat3> rotations = hard_rotations();
  Uniform uniform(17);
  for (int i = 0; i < 1000; ++i) rotations.push_back(random_rotation(uniform));
  double worst = 0.0;
  for (const glm::dmat3& r : rotations) {
    worst = std::max(worst, largest_difference(rotator.apply(f, RotationMatrix(r)), rotate(f, r)));
  }
  EXPECT_LE(worst, 1e-12);
}

TEST(ShRotationMethods, TurnAboutZAgreesWithTheMatrix) {
  const std::vector<double> f = random_vector(20, 18);
  for (const double angle : {0.0, 1e-8, 0.7, -2.0, kPi}) {
    const std::vector<double> expected = rotate(f, turn(Vec3d(0.0, 0.0, 1.0), angle));
    EXPECT_LE(largest_difference(rotate_z(f, angle), expected), 1e-13) << angle;
  }
}

// Central differences: error h^2/6 l^3 + rounding/h, below 2e-7 for h = 1e-5 and 8 bands of numbers up to 1.
TEST(ShRotationMethods, DerivativeIsThatOfTheMatrix) {
  const std::vector<double> f = random_vector(8, 19);
  constexpr double kStep = 1e-5;
  for (const Vec3d& axis :
       {Vec3d(1.0, 0.0, 0.0), Vec3d(0.0, 1.0, 0.0), Vec3d(0.0, 0.0, 1.0), Vec3d(0.6, 0.0, -0.8)}) {
    const std::vector<double> ahead = rotate(f, turn(axis, kStep));
    const std::vector<double> behind = rotate(f, turn(axis, -kStep));
    std::vector<double> difference;
    for (std::size_t i = 0; i < f.size(); ++i) difference.push_back((ahead[i] - behind[i]) / (2.0 * kStep));
    EXPECT_LE(largest_difference(rotation_derivative(f, axis), difference), 2e-7);
  }
}

/// Worst relative L2 error of the Taylor method over the functions of the highest degree, where it is largest.
double taylor_error(int bands, double beta, int terms) {
  const glm::dmat3 r = turn(Vec3d(0.0, 1.0, 0.0), beta);
  double worst = 0.0;
  for (int m = -(bands - 1); m < bands; ++m) {
    std::vector<double> f(static_cast<std::size_t>(bands * bands));
    f[static_cast<std::size_t>(index(bands - 1, m))] = 1.0;
    const std::vector<double> truth = rotate(f, r);
    const std::vector<double> approximate = rotate_y_by_taylor(f, beta, terms);
    double square = 0.0;
    for (std::size_t i = 0; i < f.size(); ++i) {
      square += (truth[i] - approximate[i]) * (truth[i] - approximate[i]);
    }
    worst = std::max(worst, std::sqrt(square));
  }
  return worst;
}

// The generator's eigenvalues in degree l are i m, |m| <= l, so that the remainder after k terms is at most
// (l beta)^(k + 1) / (k + 1)!, and single coefficients lose no more than that.
TEST(ShRotationMethods, TaylorSeriesIsGoodForSmallAnglesOnly) {
  for (const int bands : {3, 5, 10}) {
    const int l = bands - 1;
    EXPECT_LE(taylor_error(bands, 0.39 / l, 2), 0.01) << bands;
    EXPECT_LE(taylor_error(bands, 0.18 / l, 2), 0.001) << bands;
    // The limit is no luxury: at five times the angle the error is tens of times as large.
    EXPECT_GT(taylor_error(bands, 2.0 / l, 2), 0.2) << bands;
    EXPECT_LE(taylor_error(bands, 1.0 / l, 16), 1e-14) << bands;
  }
  const std::vector<double> f = random_vector(5, 20);
  const glm::dmat3 r = turn(Vec3d(0.0, 0.0, 1.0), 2.0) * turn(Vec3d(0.0, 1.0, 0.0), 0.01);
  EXPECT_LE(largest_difference(rotate_by_taylor(f, RotationMatrix(r), 6), rotate(f, r)), 1e-13);
  EXPECT_THROW(static_cast<void>(rotate_y_by_taylor(f, 0.1, 0)), InputError);
}

// ---------------------------------------------------------------- stress

TEST(ShRotation, ScalesWithItsInput) {
  const std::vector<double> f = random_vector(6, 21);
  const glm::dmat3 r = turn(Vec3d(1.0, 2.0, 3.0), 0.8);
  const std::vector<double> expected = rotate(f, r);
  for (const double scale : {1e30, 1e-30, 0x1p-1000}) {
    std::vector<double> scaled = f;
    for (double& x : scaled) x *= scale;
    std::vector<double> turned = rotate(scaled, r);
    for (double& x : turned) x /= scale;
    EXPECT_LE(largest_difference(turned, expected), 1e-14) << scale;
  }
  // Denormal numbers are multiples of 2^-1074: each product and sum may be off by half of one.
  std::vector<double> denormal = f;
  for (double& x : denormal) x *= 0x1p-1060;
  const std::vector<double> turned = rotate(denormal, r);
  for (std::size_t i = 0; i < f.size(); ++i) {
    EXPECT_LE(std::abs(turned[i] * 0x1p1000 - expected[i] * 0x1p-60), 24 * 0x1p-74) << i;
  }
}

TEST(ShRotation, NotANumberSpreadsThroughItsDegreeOnly) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    std::vector<double> f = random_vector(6, 22);
    f[static_cast<std::size_t>(index(3, 1))] = bad;
    const std::vector<double> turned = rotate(f, turn(Vec3d(1.0, 2.0, 3.0), 0.8));
    for (int l = 0; l < 6; ++l) {
      for (int m = -l; m <= l; ++m) {
        EXPECT_EQ(std::isfinite(turned[static_cast<std::size_t>(index(l, m))]), l != 3) << l << " " << m;
      }
    }
  }
}

TEST(ShRotation, OneHotAndZeroVectorsStayInTheirDegree) {
  const Rotation rotation(turn(Vec3d(1.0, 2.0, 3.0), 0.8), 6);
  EXPECT_EQ(applied(rotation, std::vector<double>(36)), std::vector<double>(36));
  for (std::size_t hot = 0; hot < 36; ++hot) {
    std::vector<double> f(36);
    f[hot] = 1.0;
    const std::vector<double> turned = applied(rotation, f);
    for (std::size_t i = 0; i < 36; ++i) {
      const bool is_same_degree = std::floor(std::sqrt(i)) == std::floor(std::sqrt(hot));
      EXPECT_TRUE(is_same_degree || turned[i] == 0.0) << hot << " " << i;
    }
  }
}

TEST(ShRotation, TurnsEachChannelAlike) {
  ShRgb light{5, {}};
  const std::vector<double> f = random_vector(5, 23);
  for (const double x : f) light.coefficients.emplace_back(x, 2.0 * x, -x);
  const glm::dmat3 r = turn(Vec3d(1.0, 2.0, 3.0), 0.8);
  const std::vector<double> expected = rotate(f, r);
  const ShRgb turned = rotate(light, r);
  EXPECT_EQ(turned.bands, 5);
  for (std::size_t i = 0; i < f.size(); ++i) {
    EXPECT_EQ(turned.coefficients[i], RgbD(expected[i], 2.0 * expected[i], -expected[i]));
  }
}

}  // namespace
}  // namespace plumbline::sh
