// Zonal fits: planted lobes come back, errors are what is left, and turn with the function.
#include "prt/sh/zonal_fit.hpp"

#include <gtest/gtest.h>

#include "prt/sh/rotation.hpp"
#include "prt/sh/zonal.hpp"
#include "reference/base/error.hpp"
#include "validation/tests/sh/rotations.hpp"

namespace plumbline::sh {
namespace {

using sh_test::largest_difference;
using sh_test::random_vector;
using sh_test::turn;

double norm(const std::vector<double>& f) {
  double sum = 0.0;
  for (const double x : f) sum += x * x;
  return std::sqrt(sum);
}

double relative_difference(const std::vector<double>& fit, const std::vector<double>& f) {
  std::vector<double> rest;
  for (std::size_t i = 0; i < f.size(); ++i) rest.push_back(f[i] - fit[i]);
  return norm(rest) / norm(f);
}

std::vector<ZonalLobe> planted(std::size_t count) {
  const std::vector<ZonalLobe> all{{glm::normalize(Vec3d(1.0, 2.0, 3.0)), clamped_cosine(6)},
                                   {glm::normalize(Vec3d(-2.0, 0.5, 0.3)), cap(6, 0.5)},
                                   {glm::normalize(Vec3d(0.2, -1.0, -0.9)), clamped_cosine_power(6, 8.0)}};
  return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count)};
}

TEST(ZonalFit, FindsPlantedLobes) {
  for (const std::size_t count : {1U, 2U, 3U}) {
    const std::vector<double> f = sum_of_lobes(planted(count));
    const ZonalFit fit = fit_zonal(f, static_cast<int>(count));
    EXPECT_LE(fit.relative_error, 1e-7) << count;
    EXPECT_LE(relative_difference(sum_of_lobes(fit.lobes), f), 1e-7) << count;
  }
}

TEST(ZonalFit, ReportsTheErrorThatIsThere) {
  const std::vector<double> f = random_vector(5, 50);
  double previous = 1.0;
  for (int lobes = 1; lobes <= 5; ++lobes) {
    const ZonalFit fit = fit_zonal(f, lobes);
    EXPECT_EQ(fit.lobes.size(), static_cast<std::size_t>(lobes));
    EXPECT_LE(std::abs(relative_difference(sum_of_lobes(fit.lobes), f) - fit.relative_error), 1e-12) << lobes;
    EXPECT_LT(fit.relative_error, previous) << lobes;
    previous = fit.relative_error;
  }
  // A fit with the wrong axis is seen: the error of the closest lobe about another axis is far larger.
  const std::vector<double> lobe = sum_of_lobes(planted(1));
  const ZonalLobe wrong = closest_lobe(lobe, Vec3d(1.0, 0.0, 0.0));
  EXPECT_GT(relative_difference(sum_of_lobes(std::vector<ZonalLobe>{wrong}), lobe), 0.1);
}

// Least squares: the closest lobe about an axis leaves a rest that no change of its coefficients can shorten.
TEST(ZonalFit, ClosestLobeIsClosest) {
  const std::vector<double> f = random_vector(4, 51);
  const Vec3d axis = glm::normalize(Vec3d(0.3, -0.4, 0.9));
  const ZonalLobe lobe = closest_lobe(f, axis);
  const double best = relative_difference(sum_of_lobes(std::vector<ZonalLobe>{lobe}), f);
  for (std::size_t l = 0; l < 4; ++l) {
    for (const double change : {-0.01, 0.01}) {
      ZonalLobe other = lobe;
      other.zonal[l] += change;
      EXPECT_GT(relative_difference(sum_of_lobes(std::vector<ZonalLobe>{other}), f), best) << l;
    }
  }
}

TEST(ZonalFit, RefinementIsNoWorseThanOneLobeAfterTheOther) {
  const std::vector<double> f = sum_of_lobes(planted(3));
  std::vector<double> rest = f;
  for (int lobe = 0; lobe < 3; ++lobe) {
    const ZonalFit one = fit_zonal(rest, 1);
    const std::vector<double> part = sum_of_lobes(one.lobes);
    for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= part[i];
  }
  EXPECT_GT(norm(rest) / norm(f), 1e-3);
  EXPECT_LE(fit_zonal(f, 3).relative_error, norm(rest) / norm(f));
}

TEST(ZonalFit, OfATurnedFunctionIsTheTurnedFit) {
  const std::vector<double> f = sum_of_lobes(planted(2));
  const glm::dmat3 r = turn(Vec3d(1.0, -2.0, 0.5), 2.0);
  EXPECT_LE(fit_zonal(rotate(f, r), 2).relative_error, 1e-7);
}

TEST(ZonalFit, IsTheSameEachTime) {
  const std::vector<double> f = random_vector(5, 52);
  EXPECT_EQ(sum_of_lobes(fit_zonal(f, 3).lobes), sum_of_lobes(fit_zonal(f, 3).lobes));
}

TEST(ZonalFit, TakesExtremesAndRefusesBrokenNumbers) {
  EXPECT_EQ(fit_zonal(std::vector<double>(16), 2).relative_error, 0.0);
  EXPECT_LE(fit_zonal(std::vector<double>{3.0}, 2).relative_error, 1e-15);
  for (const double scale : {1e30, 1e-30}) {
    std::vector<double> f = sum_of_lobes(planted(1));
    for (double& x : f) x *= scale;
    EXPECT_LE(fit_zonal(f, 1).relative_error, 1e-7) << scale;
  }
  EXPECT_THROW(static_cast<void>(fit_zonal({1.0, std::nan(""), 0.0, 0.0}, 1)), InputError);
  EXPECT_THROW(static_cast<void>(fit_zonal({1.0, 2.0}, 1)), InputError);
  EXPECT_THROW(static_cast<void>(fit_zonal({1.0}, 0)), InputError);
  EXPECT_THROW(static_cast<void>(sum_of_lobes({})), InputError);
}

}  // namespace
}  // namespace plumbline::sh
