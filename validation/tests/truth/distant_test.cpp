#include "validation/truth/distant.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "reference/base/error.hpp"
#include "validation/tests/truth/quadrature.hpp"
#include "validation/truth/irradiance.hpp"

namespace plumbline::truth {
namespace {

constexpr double kTight = 1e-11;

TEST(TruthDistant, DiscsMatchQuadrature) {
  const Vec3d axis = glm::normalize(Vec3d(1.0, -2.0, 0.5));
  const Vec3d side = glm::normalize(glm::cross(axis, Vec3d(0, 1, 0)));
  const Vec3d third = glm::cross(axis, side);
  for (const double a : {0.3, 1.2, 2.5}) {
    Vec3d sum(0.0);
    for (int c = 0; c < 3; ++c) {
      sum[c] = 3.0 * integrate(gauss(30), 0.0, a, [&](double t) {
                 return std::sin(t) * integrate_turn(16, [&](double p) {
                          return (axis * std::cos(t) +
                                  (side * std::cos(p) + third * std::sin(p)) * std::sin(t))[c];
                        });
               });
    }
    EXPECT_LE(glm::length(sum - disc_vector_irradiance(axis, a, 3.0)), kTight) << a;
  }
  expect_digits(disc_vector_irradiance({0, 1, 0}, kPi / 6.0, 1.0).y, "0.785398163397");
}

// E(n) - E(-n) is the vector irradiance along n: the cap at 45 degrees is wholly above one side.
TEST(TruthDistant, DifferenceOfOppositeReceiversIsTheCapsIrradiance) {
  const Vec3d axis(std::sin(kPi / 4.0), 0.0, std::cos(kPi / 4.0));
  EXPECT_LE(
      std::abs(disc_vector_irradiance(axis, kPi / 6.0, 1.0).z - cap_irradiance(kPi / 6.0, kPi / 4.0, 1.0)),
      kTight);
}

TEST(TruthDistant, LatLongMomentsMatchQuadrature) {
  const int width = 3;
  const int height = 2;
  const std::vector<double> texels = {1.0, 0.0, 4.0, 2.5, 7.0, 0.5};
  DistantMoments sum;
  const Rule rule = gauss(20);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const double radiance = texels[static_cast<std::size_t>(row * width + column)];
      for (int c = -1; c < 3; ++c) {
        const double part = integrate(rule, 0.0, 1.0, [&](double v) {
          const double t = kPi * (row + v) / height;
          return std::sin(t) * integrate(rule, 0.0, 1.0, [&](double u) {
                   const double p = 2.0 * kPi * ((column + u) / width - 0.5);
                   const Vec3d w(std::sin(t) * std::cos(p), std::cos(t), std::sin(t) * std::sin(p));
                   return c < 0 ? 1.0 : w[c];
                 });
        });
        const double value = radiance * part * kPi / height * 2.0 * kPi / width;
        (c < 0 ? sum.flux : sum.vector[c]) += value;
      }
    }
  }
  const DistantMoments closed = lat_long_moments(texels, width, height);
  EXPECT_LE(std::abs(closed.flux - sum.flux), 10.0 * kTight);
  EXPECT_LE(glm::length(closed.vector - sum.vector), 10.0 * kTight);
  EXPECT_THROW((void)lat_long_moments(texels, 2, 2), InputError);
}

// The share of image points whose ray meets the sphere: in polar coordinates of the image plane the edge is where the
// discriminant (d.c)^2 - d.d (c.c - R^2) changes its sign.
TEST(TruthDistant, SilhouetteIsWhereRaysMeetTheSphere) {
  for (const auto& [radius, distance, fov] : {std::array{1.0, 3.0, kPi / 3.0}, {0.5, 0.9, 2.0}}) {
    double inside = 0.0;
    double outside = std::tan(fov / 2.0);
    for (int step = 0; step < 60; ++step) {
      const double r = 0.5 * (inside + outside);
      const double along = distance * distance;
      const bool meets = along - (1.0 + r * r) * (distance * distance - radius * radius) > 0.0;
      (meets ? inside : outside) = r;
    }
    const double side = 2.0 * std::tan(fov / 2.0);
    EXPECT_LE(
        std::abs(sphere_silhouette_share(radius, distance, fov) - kPi * inside * inside / (side * side)),
        kTight);
  }
  expect_digits(sphere_silhouette_share(1.0, 3.0, kPi / 3.0), "0.294524311274");
  EXPECT_THROW((void)sphere_silhouette_share(1.0, 1.1, kPi / 3.0), InputError);  // cut by the border
}

TEST(TruthDistant, MomentsMatchQuadrature) {
  const Rule rule = gauss(20);
  const auto cosine = [&](int power) {  // density cos/pi
    return 2.0 * integrate(rule, 0.0, 1.0, [&](double c) { return std::pow(c, power + 1); });
  };
  EXPECT_LE(std::abs(cosine(1) - kCosineMeanCosine), kTight);
  EXPECT_LE(std::abs(cosine(2) - kCosineMeanSquaredCosine), kTight);
  EXPECT_LE(std::abs((1.0 - cosine(2)) / 2.0 - kCosineMeanSquaredTangent), kTight);
  EXPECT_LE(std::abs(integrate(rule, 0.0, 1.0, [](double c) { return c; }) - kUniformMeanCosine), kTight);
  EXPECT_LE(std::abs(integrate(rule, 0.0, 1.0, [](double c) { return c * c; }) - kUniformMeanSquaredCosine),
            kTight);
  const double product = integrate(rule, 0.0, 1.0, [](double c) {
    const double s2 = 1.0 - c * c;
    return s2 * s2 * integrate_turn(16, [](double p) { return std::pow(std::cos(p) * std::sin(p), 2.0); });
  });
  EXPECT_LE(std::abs(product / (2.0 * kPi) - kUniformMeanProduct), kTight);
}

TEST(TruthDistant, EvenPowersTowardsTheirAxis) {  // L = z^k: 2 pi int c^(k+1) = 2 pi/(k + 2)
  for (const int k : {0, 2, 4, 6, 8}) {
    const double expected =
        2.0 * kPi * integrate(gauss(20), 0.0, 1.0, [k](double c) { return std::pow(c, k + 1); });
    EXPECT_LE(std::abs(2.0 * kPi / (k + 2) - expected), kTight) << k;
  }
}

}  // namespace
}  // namespace plumbline::truth
