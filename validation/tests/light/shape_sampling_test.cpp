// Densities against quadrature, samples against densities, and estimates of irradiance against closed forms.
#include "reference/light/shape_sampling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "validation/metrics/statistics.hpp"
#include "validation/truth/irradiance.hpp"

namespace plumbline::light {
namespace {

constexpr double kSignificance = 1e-4;  // of all the random tests of a family together

struct Ball {
  Vec3d centre;
  double radius;
};

/// Far, middling, touching, tiny and huge; away from the origin too.
std::vector<Ball> balls() {
  return {{{0, 0, 3}, 1.0},     {{1, 2, -2}, 0.5},     {{0, 1.001, 0}, 1.0},
          {{30, -40, 0}, 0.05}, {{0, -1e4, 1e3}, 9e3}, {{1e-3, 2e-3, 2e-3}, 1e-3}};
}

class Numbers {
 public:
  explicit Numbers(std::uint32_t seed) : random_(seed) {}
  Vec2 pair() {
    const float x = uniform_(random_);
    return {x, uniform_(random_)};
  }

 private:
  std::mt19937 random_;
  std::uniform_real_distribution<float> uniform_{0.0F, 1.0F};
};

Vec3d around(const Vec3d& axis, double cosine, double azimuth) {
  const Vec3d aside = std::abs(axis.x) < 0.8 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
  const Vec3d u = glm::normalize(glm::cross(axis, aside));
  const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
  return cosine * axis + sine * (std::cos(azimuth) * u + std::sin(azimuth) * glm::cross(axis, u));
}

// Midpoint rule in 1 - cos from the axis to a little beyond the cone; the density has one jump, at its rim, so
// the error is at most one cell's share.
double integral_over_directions(const Ball& ball, const std::function<double(const Vec3d&)>& pdf) {
  constexpr int kRings = 4000;
  const double distance = glm::length(ball.centre);
  const double sine = ball.radius / distance;
  const double limit = 1.1 * sine * sine / (1.0 + std::sqrt(1.0 - sine * sine));
  double sum = 0.0;
  for (int i = 0; i < kRings; ++i) {
    const double cosine = 1.0 - limit * (i + 0.5) / kRings;
    sum += pdf(around(ball.centre / distance, std::max(-1.0, cosine), 0.1 + i));
  }
  return sum * 2.0 * kPi * limit / kRings;
}

TEST(SphereSampling, DensityIntegratesToOne) {
  for (const Ball& ball : balls()) {
    const auto pdf = [&](const Vec3d& w) { return sphere_pdf(ball.centre, ball.radius, Vec3d(0.0), w); };
    EXPECT_NEAR(integral_over_directions(ball, pdf), 1.0, 1.0 / 3000.0) << ball.radius;
    const auto too_large = [&](const Vec3d& w) { return 1.01 * pdf(w); };  // planted fault
    EXPECT_GT(std::abs(integral_over_directions(ball, too_large) - 1.0), 1.0 / 3000.0);
  }
}

TEST(SphereSampling, DensityKeepsItsDigitsForTheSmallestCone) {
  // 1/(2 pi (1 - cos a)) -> 1/(pi a^2) for small a: R/d = 1e-9 is far below what 1 - cos in double could hold.
  EXPECT_NEAR(sphere_pdf(1e-9, 1.0) * kPi * 1e-18, 1.0, 1e-12);
  EXPECT_NEAR(sphere_pdf(1.0, 1.0 + 1e-12) * 2.0 * kPi, 1.0,
              2e-6);  // half of all directions, sqrt(2e-12) short
}

TEST(SphereSampling, EverySampleMeetsTheSphereWhereItSaysWithTheDensityOfItsDirection) {
  for (const Ball& ball : balls()) {
    Numbers numbers(5);
    for (int i = 0; i < 5000; ++i) {
      const auto sample = sample_sphere(ball.centre, ball.radius, Vec3d(0.0), numbers.pair());
      ASSERT_TRUE(sample.has_value());
      EXPECT_NEAR(glm::length(sample->direction), 1.0, 1e-14);
      const double distance = glm::length(ball.centre);
      // At the rim a double's last digit of sin^2 moves the point by sqrt(1e-16) d along the ray.
      EXPECT_NEAR(glm::length(sample->distance * sample->direction - ball.centre), ball.radius,
                  1e-7 * distance);
      const double pdf = sphere_pdf(ball.centre, ball.radius * (1.0 + 1e-12), Vec3d(0.0), sample->direction);
      EXPECT_NEAR(pdf / sample->pdf, 1.0, 1e-5);
    }
  }
}

TEST(SphereSampling, FromInsideOrOnTheSurfaceThereIsNone) {
  for (const double distance : {0.0, 0.5, 1.0}) {
    const Vec3d centre(0.0, distance, 0.0);
    EXPECT_FALSE(sample_sphere(centre, 1.0, Vec3d(0.0), Vec2(0.3F)).has_value());
    EXPECT_EQ(sphere_pdf(centre, 1.0, Vec3d(0.0), Vec3d(0, 1, 0)), 0.0);
    EXPECT_EQ(sphere_pdf(1.0, distance), 0.0);
  }
  EXPECT_EQ(sphere_pdf(Vec3d(0, 3, 0), 1.0, Vec3d(0.0), Vec3d(0, -1, 0)), 0.0) << "behind";
}

constexpr int kRings = 12;
constexpr int kSectors = 16;
using Bins = std::vector<double>;

/// Where a direction lies in the cone: ring by 1 - cos, sector by azimuth; the last bin is "outside".
std::size_t bin_of(const Ball& ball, const Vec3d& direction) {
  const double distance = glm::length(ball.centre);
  const Vec3d axis = ball.centre / distance;
  const double sine = ball.radius / distance;
  const double limit = sine * sine / (1.0 + std::sqrt(1.0 - sine * sine));
  const double s = glm::length(glm::cross(axis, direction));
  const double one_minus_cos = glm::dot(axis, direction) > 0.0
                                   ? s * s / (1.0 + std::sqrt(std::max(0.0, 1.0 - s * s)))
                                   : 1.0 - glm::dot(axis, direction);
  const double ring = one_minus_cos / limit * kRings;
  if (!(ring < kRings + 1e-6)) return kRings * kSectors;
  const Vec3d aside = std::abs(axis.x) < 0.8 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
  const Vec3d u = glm::normalize(glm::cross(axis, aside));
  const double azimuth = std::atan2(glm::dot(direction, glm::cross(axis, u)), glm::dot(direction, u));
  const int sector = std::min(kSectors - 1, static_cast<int>((azimuth / (2.0 * kPi) + 0.5) * kSectors));
  return static_cast<std::size_t>(std::min(kRings - 1, static_cast<int>(ring)) * kSectors + sector);
}

double p_of_counts(const Ball& ball, const std::function<Vec3d(const Vec2&)>& draw) {
  constexpr int kSamples = 200000;
  Bins counts(kRings * kSectors + 1, 0.0);
  Numbers numbers(17);
  for (int i = 0; i < kSamples; ++i) counts[bin_of(ball, draw(numbers.pair()))] += 1.0;
  Bins expected(counts.size(), static_cast<double>(kSamples) / (kRings * kSectors));
  expected.back() = 0.0;
  if (counts.back() > 0.0) return 0.0;
  counts.pop_back();
  expected.pop_back();
  return metrics::chi_squared(counts, expected).p;
}

TEST(SphereSampling, DirectionsAreUniformInTheCone) {
  const double significance = metrics::sidak(kSignificance, balls().size());
  for (const Ball& ball : balls()) {
    const auto draw = [&](const Vec2& u) {
      return sample_sphere(ball.centre, ball.radius, Vec3d(0.0), u)->direction;
    };
    EXPECT_GE(p_of_counts(ball, draw), significance) << ball.radius;
    const auto skewed = [&](const Vec2& u) { return draw({std::pow(u.x, 1.05F), u.y}); };  // planted fault
    EXPECT_LT(p_of_counts(ball, skewed), significance) << ball.radius;
    const auto to_area = [&](const Vec2& u) {  // planted fault: uniform over the visible area, not the angle
      const Vec3d n = sample_cap(glm::normalize(-ball.centre), ball.radius / glm::length(ball.centre), u);
      return glm::normalize(ball.centre + ball.radius * n);
    };
    EXPECT_LT(p_of_counts(ball, to_area), significance) << ball.radius;
  }
}

/// Mean over samples of cos/pdf: irradiance from a shape of radiance 1.
template <class Draw>
metrics::Estimate irradiance(const Vec3d& normal, const Draw& draw, double planted = 1.0) {
  metrics::RunningMoments moments;
  Numbers numbers(23);
  for (int i = 0; i < 400000; ++i) {
    const std::optional<ShapeSample> sample = draw(numbers.pair());
    moments.add(sample ? std::max(0.0, glm::dot(normal, sample->direction)) / (planted * sample->pdf) : 0.0);
  }
  return moments.estimate();
}

void expect_agrees(const metrics::Estimate& estimate, double truth, bool is_right) {
  const bool agrees = std::abs(estimate.mean - truth) <= 4.0 * estimate.standard_error + 1e-7 * truth &&
                      estimate.standard_error <= 0.002 * truth;
  EXPECT_EQ(agrees, is_right) << estimate.mean << " +- " << estimate.standard_error << ", truth " << truth;
}

TEST(SphereSampling, GivesTheIrradianceOfASphere) {
  struct Case {
    double radius, height, lateral;
  };
  for (const Case& c :
       {Case{1, 1, 1}, Case{1, 2, 0}, Case{1, 2, 1}, Case{1, 1.0001, 0.1}, Case{1e-3, 5, 4}}) {
    const Vec3d centre(c.lateral, c.height, 0.0);
    const auto draw = [&](const Vec2& u) { return sample_sphere(centre, c.radius, Vec3d(0.0), u); };
    const double truth = truth::sphere_irradiance(c.radius, c.height, c.lateral, 1.0);
    expect_agrees(irradiance({0, 1, 0}, draw), truth, true);
    expect_agrees(irradiance({0, 1, 0}, draw, 1.01), truth, false);
  }
  // D5: a cap of 30 degrees, 45 degrees off the normal
  const Vec3d centre = 2.0 * Vec3d(std::sqrt(0.5), std::sqrt(0.5), 0.0);
  const auto draw = [&](const Vec2& u) { return sample_sphere(centre, 1.0, Vec3d(0.0), u); };
  expect_agrees(irradiance({0, 1, 0}, draw), truth::cap_irradiance(kPi / 6.0, kPi / 4.0, 1.0), true);
}

TEST(DiscSampling, GivesTheIrradianceOfADisc) {
  for (const auto& [x, planted] : {std::pair(1.0, 1.01), std::pair(0.0, 0.99), std::pair(3.0, 1.01)}) {
    const Vec3d centre(x, 2.0, 0.0);
    const auto draw = [&](const Vec2& u) { return sample_disc_from(centre, {0, -1, 0}, 1.0, Vec3d(0.0), u); };
    const double truth = kPi * truth::disc_form_factor(1.0, 2.0, x);
    expect_agrees(irradiance({0, 1, 0}, draw), truth, true);
    expect_agrees(irradiance({0, 1, 0}, draw, planted), truth, false);
  }
}

TEST(DiscSampling, DensityIntegratesToOneAndIsThatOfTheSamples) {
  const Vec3d centre(1.0, 2.0, -0.5);
  const Vec3d normal = glm::normalize(Vec3d(1.0, -2.0, 0.5));
  const auto integral =
      [&](double factor) {  // over the sphere of directions, midpoint rule on 1 - z and azimuth
        constexpr int kSide = 1500;
        double sum = 0.0;
        for (int i = 0; i < kSide; ++i) {
          for (int k = 0; k < 2 * kSide; ++k) {
            const double z = 1.0 - 2.0 * (i + 0.5) / kSide;
            const Vec3d w = around({0, 1, 0}, z, kPi * (k + 0.5) / kSide);
            sum += factor * disc_pdf(centre, normal, 0.8, Vec3d(0.0), w);
          }
        }
        return sum * 2.0 * kPi / (static_cast<double>(kSide) * kSide);
      };
  EXPECT_NEAR(integral(1.0), 1.0, 2e-3);  // the jump at the rim: its length over the cells' size
  EXPECT_GT(std::abs(integral(1.01) - 1.0), 2e-3);
  Numbers numbers(3);
  for (int i = 0; i < 5000; ++i) {
    const auto sample = sample_disc_from(centre, normal, 0.8, Vec3d(0.0), numbers.pair());
    ASSERT_TRUE(sample.has_value());
    const double pdf = disc_pdf(centre, normal, 0.8 * (1.0 + 1e-12), Vec3d(0.0), sample->direction);
    EXPECT_NEAR(pdf / sample->pdf, 1.0, 1e-9);
  }
  EXPECT_FALSE(sample_disc_from({0, 0, 2}, {0, 1, 0}, 1.0, Vec3d(0.0), Vec2(0.3F)).has_value()) << "edge-on";
  EXPECT_EQ(disc_pdf({0, 0, 2}, {0, 1, 0}, 1.0, Vec3d(0.0), {0, 0, 1}), 0.0);
  EXPECT_EQ(disc_pdf({0, 2, 0}, {0, 1, 0}, 1.0, Vec3d(0.0), {0, -1, 0}), 0.0) << "behind";
}

// Moments: of a cap z is uniform in [c, 1], so E[z] = (1 + c)/2; of a unit disc E[r^2] = 1/2.
TEST(AreaSampling, HasTheMomentsOfTheShape) {
  const Vec3d axis = glm::normalize(Vec3d(1.0, -2.0, 0.5));
  for (const double least : {-1.0, 0.0, 0.7}) {
    metrics::RunningMoments height;
    Numbers numbers(7);
    for (int i = 0; i < 200000; ++i) {
      const Vec3d n = sample_cap(axis, least, numbers.pair());
      ASSERT_GE(glm::dot(n, axis), least - 1e-12);
      height.add(glm::dot(n, axis));
    }
    EXPECT_LE(std::abs(height.estimate().mean - 0.5 * (1.0 + least)), 4.0 * height.estimate().standard_error);
  }
  metrics::RunningMoments squared;
  metrics::RunningMoments sideways;
  Numbers numbers(9);
  for (int i = 0; i < 200000; ++i) {
    const Vec3d p = sample_disc(axis, 1.0, numbers.pair());
    ASSERT_LE(std::abs(glm::dot(p, axis)), 1e-12);
    squared.add(glm::dot(p, p));
    sideways.add(p.x);
  }
  EXPECT_LE(std::abs(squared.estimate().mean - 0.5), 4.0 * squared.estimate().standard_error);
  EXPECT_LE(std::abs(sideways.estimate().mean), 4.0 * sideways.estimate().standard_error);
}

}  // namespace
}  // namespace plumbline::light
