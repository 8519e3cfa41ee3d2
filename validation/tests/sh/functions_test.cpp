// Projection of functions: exact quadrature, and Monte Carlo whose error falls as its points promise.
#include "prt/sh/functions.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "prt/sh/basis.hpp"
#include "prt/sh/zonal.hpp"
#include "reference/base/error.hpp"

namespace plumbline::sh {
namespace {

/// The larger; NaN stays.
double worse(double a, double b) {
  return std::isnan(a) || a >= b ? a : b;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  if (a.size() != b.size()) return std::nan("");
  double result = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) result = worse(result, std::abs(a[i] - b[i]));
  return result;
}

SphereFunction sum_of(int bands, std::vector<double> coefficients) {
  return [bands, coefficients = std::move(coefficients)](const Vec3d& d) {
    const std::vector<double> y = evaluate_basis(bands, d);
    double sum = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i) sum += coefficients[i] * y[i];
    return sum;
  };
}

std::vector<double> some_coefficients(int bands) {
  std::vector<double> result;
  for (int i = 0; i < bands * bands; ++i) result.push_back(std::sin(1.0 + 3.0 * i));
  return result;
}

// n^2 nodes and n^2 terms of size 1, each rounded: about n roundings.
TEST(ShFunctions, QuadratureGivesABandLimitedFunctionBack) {
  for (const int bands : {1, 2, 5, 12}) {
    const std::vector<double> coefficients = some_coefficients(bands);
    EXPECT_LE(largest_difference(project_function(sum_of(bands, coefficients), bands), coefficients), 1e-13)
        << bands;
  }
}

TEST(ShFunctions, QuadratureTakesTheFunctionsBandsIntoAccount) {
  const std::vector<double> coefficients = some_coefficients(9);
  const std::vector<double> few(coefficients.begin(), coefficients.begin() + 16);
  EXPECT_LE(largest_difference(project_function(sum_of(9, coefficients), 4, 9), few), 1e-13);
  // Seen failing: the rule of 4 bands aliases what the function has of more.
  EXPECT_GT(largest_difference(project_function(sum_of(9, coefficients), 4), few), 1e-3);
}

TEST(ShFunctions, RefuseWhatIsNotFiniteOrOutOfRange) {
  const auto nan = [](const Vec3d&) { return std::numeric_limits<double>::quiet_NaN(); };
  const auto one = [](const Vec3d&) { return 1.0; };
  EXPECT_THROW((void)project_function(nan, 3), InputError);
  EXPECT_THROW((void)project_function(one, 5, 4), InputError);
  EXPECT_THROW((void)project_function(one, 0), InputError);
  EXPECT_THROW((void)estimate_projection(nan, 3, {}), InputError);
  MonteCarloSettings settings;
  settings.replicates = 1;
  EXPECT_THROW((void)estimate_projection(one, 3, settings), InputError);
  settings.replicates = 2;
  settings.samples = 0;
  EXPECT_THROW((void)estimate_projection(one, 3, settings), InputError);
}

// ---------------------------------------------------------------- Monte Carlo

constexpr int kBands = 4;

const Vec3d kAxis = glm::normalize(Vec3d(0.4, -0.5, 0.76));

/// Smooth, and has every coefficient.
double smooth(const Vec3d& d) {
  const double cosine = glm::dot(d, kAxis);
  return 1.0 + 2.0 * cosine + 1.5 * cosine * cosine + 0.7 * cosine * cosine * cosine;
}
std::vector<double> smooth_truth() {
  return project_function(smooth, kBands);
}

double root_mean_square(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

/// Root mean square error over all coefficients and several seeds.
double error_at(PointSet points, std::size_t samples) {
  constexpr std::uint64_t kSeeds = 8;
  const std::vector<double> truth = smooth_truth();
  double sum = 0.0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    MonteCarloSettings settings;
    settings.points = points;
    settings.samples = samples;
    settings.replicates = 4;
    settings.uniform = uniform_source(100 + seed);
    const double error = root_mean_square(estimate_projection(smooth, kBands, settings).coefficients, truth);
    sum += error * error;
  }
  return std::sqrt(sum / kSeeds);
}

/// Exponent of the error between 64 and 4096 points a replicate.
double slope(PointSet points) {
  return std::log(error_at(points, 4096) / error_at(points, 64)) / std::log(64.0);
}

// 8 seeds x 16 coefficients know each error to 1/sqrt(2 * 128) = 6 %, and the slope to 0.09/log(64) = 0.02.
TEST(ShMonteCarlo, ErrorOfIndependentPointsFallsAsTheRoot) {
  EXPECT_LE(std::abs(slope(PointSet::independent) + 0.5), 0.08);
}
// The points' map has a root at the poles, sqrt(1 - z^2), which is not smooth: of the N^-1 of smooth functions it leaves
// sqrt(log N)/N, by 1/(2 log N) = 0.08 to 0.12 less steep here.
TEST(ShMonteCarlo, ErrorOfStratifiedPointsFallsAsTheirNumber) {
  EXPECT_LE(std::abs(slope(PointSet::stratified) + 0.9), 0.08);
}
// For the same reason not N^-3/2, but steeper than any stratified set.
TEST(ShMonteCarlo, ErrorOfQuasiRandomPointsFallsFastest) {
  EXPECT_LE(slope(PointSet::quasi_random), -1.1);
}

/// Exponent of the error between 2^13 and 2^19 points, 8 replicates.
double late_slope(const UniformSource& uniform) {
  const std::vector<double> truth = smooth_truth();
  const auto error = [&](std::size_t samples) {
    MonteCarloSettings settings;
    settings.points = PointSet::independent;
    settings.samples = samples;
    settings.replicates = 8;
    settings.uniform = uniform;
    settings.threads = 0;
    return root_mean_square(estimate_projection(smooth, kBands, settings).coefficients, truth);
  };
  return std::log(error(std::size_t{1} << 19U) / error(std::size_t{1} << 13U)) / std::log(64.0);
}
// One seed and 16 coefficients know each error to 18 %, and the slope to 0.06. (rand() % 1000) / 1000 is too small by
// 1/2000 on average: its error stops falling there.
TEST(ShMonteCarlo, SlopeCatchesAGeneratorOfAThousandValues) {
  const UniformSource good = uniform_source(5);
  const UniformSource coarse = [good](std::uint64_t index) {
    return std::floor(good(index) * 1000.0) / 1000.0;
  };
  EXPECT_LE(std::abs(late_slope(good) + 0.5), 0.2);
  EXPECT_GT(std::abs(late_slope(coarse) + 0.5), 0.2);
}

/// Sum over the coefficients of the squared error in standard errors, over their number.
double squared_deviation(const MonteCarloProjection& estimate, const std::vector<double>& truth) {
  double sum = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double z = (estimate.coefficients[i] - truth[i]) / estimate.standard_errors[i];
    sum += z * z;
  }
  return sum / static_cast<double>(truth.size());
}

// Each term is Student's t of 63 degrees squared: mean 1.03, and 16 that depend on each other a little exceed 4 with a
// probability below 1e-6.
TEST(ShMonteCarlo, StandardErrorsAreThoseOfTheEstimate) {
  for (const PointSet points : {PointSet::independent, PointSet::stratified, PointSet::quasi_random}) {
    MonteCarloSettings settings;
    settings.points = points;
    settings.replicates = 64;
    settings.samples = 250;
    const MonteCarloProjection estimate = estimate_projection(smooth, kBands, settings);
    EXPECT_LE(squared_deviation(estimate, smooth_truth()), 4.0);
    EXPECT_GE(squared_deviation(estimate, smooth_truth()), 0.1);
    EXPECT_EQ(estimate.evaluations, 64U * (points == PointSet::stratified ? 15U * 16U : 250U));
    // Seen failing: a bias of five standard errors.
    MonteCarloProjection biased = estimate;
    for (std::size_t i = 0; i < biased.coefficients.size(); ++i)
      biased.coefficients[i] += 5.0 * biased.standard_errors[i];
    EXPECT_GT(squared_deviation(biased, smooth_truth()), 4.0);
  }
}

// The clamped cosine's closed form. Cosine-weighted points leave only y_lm to integrate, whose variance is smaller.
TEST(ShMonteCarlo, CosineWeightedPointsProjectTheClampedCosine) {
  const auto cosine = [](const Vec3d& d) { return std::max(0.0, d.z); };
  const std::vector<double> truth = rotate_zonal(clamped_cosine(kBands), Vec3d(0.0, 0.0, 1.0));
  MonteCarloSettings settings;
  settings.points = PointSet::independent;
  settings.replicates = 64;
  settings.samples = 1000;
  const MonteCarloProjection uniform = estimate_projection(cosine, kBands, settings);
  settings.density = DirectionDensity::cosine;
  const MonteCarloProjection weighted = estimate_projection(cosine, kBands, settings);
  double uniform_sum = 0.0;
  double weighted_sum = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    // c_00 itself has no variance at all: its integrand over the density is constant.
    EXPECT_LE(std::abs(weighted.coefficients[i] - truth[i]), 5.0 * weighted.standard_errors[i] + 1e-13) << i;
    uniform_sum += uniform.standard_errors[i] * uniform.standard_errors[i];
    weighted_sum += weighted.standard_errors[i] * weighted.standard_errors[i];
  }
  EXPECT_LE(weighted_sum, 0.5 * uniform_sum);
}

TEST(ShMonteCarlo, SameBitsForAnyNumberOfThreads) {
  MonteCarloSettings settings;
  settings.samples = 100;
  const MonteCarloProjection one = estimate_projection(smooth, kBands, settings);
  settings.threads = 3;
  const MonteCarloProjection three = estimate_projection(smooth, kBands, settings);
  EXPECT_EQ(one.coefficients, three.coefficients);
  EXPECT_EQ(one.standard_errors, three.standard_errors);
}

}  // namespace
}  // namespace plumbline::sh
