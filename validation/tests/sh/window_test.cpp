// The certified minimum and the automatic window.
#include "prt/sh/window.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "prt/sh/analytic_lights.hpp"
#include "prt/sh/rotation.hpp"
#include "prt/sh/zonal.hpp"
#include "reference/base/error.hpp"
#include "validation/tests/sh/oracle.hpp"
#include "validation/tests/sh/rotations.hpp"

namespace plumbline::sh {
namespace {

using sh_test::random_rotation;
using sh_test::random_vector;
using sh_test::turn;
using sh_test::Uniform;

ShRgb grey(const std::vector<double>& f) {
  return lit(f, RgbD(1.0));
}

TEST(MinimumOnSphere, IsThatOfClosedForms) {
  // 2 + z has its minimum 1 at -z; z^2 - 1/3 on the equator, a whole ring of them.
  const std::vector<double> tilt{2.0 * std::sqrt(4.0 * kPi), 0.0, std::sqrt(4.0 * kPi / 3.0), 0.0};
  const SphereMinimum linear = minimum_on_sphere(tilt, 1e-6);
  EXPECT_LE(linear.lower_bound, 1.0);
  EXPECT_GE(linear.value, 1.0 - 1e-15);
  EXPECT_LE(linear.value - linear.lower_bound, 1e-6);
  EXPECT_LE(linear.direction.z, -0.999);
  std::vector<double> ring(9, 0.0);
  ring[6] = 2.0 / 3.0 * std::sqrt(4.0 * kPi / 5.0);
  const SphereMinimum equator = minimum_on_sphere(rotate(ring, turn(Vec3d(1.0, 2.0, 3.0), 0.5)), 1e-5);
  EXPECT_LE(equator.lower_bound, -1.0 / 3.0 + 1e-14);
  EXPECT_GE(equator.value, -1.0 / 3.0 - 1e-14);
  EXPECT_LE(equator.value - equator.lower_bound, 1e-5);
}

// No sampled direction may be below the proved bound, and the bound must be close to the best sample.
TEST(MinimumOnSphere, IsBelowEverySampleAndCloseToTheLeast) {
  const std::vector<Vec3d> directions = sh_test::directions(20000, 60);
  for (const int bands : {2, 3, 5, 8}) {
    const std::vector<double> f = random_vector(bands, 61);
    const SphereMinimum minimum = minimum_on_sphere(f, 1e-4);
    EXPECT_LE(minimum.value - minimum.lower_bound, 1e-4) << bands;
    const ShRgb function = grey(f);
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3d& d : directions) least = std::min(least, evaluate(function, d).r);
    EXPECT_LE(minimum.lower_bound, least) << bands;
    // 20000 samples leave no gap wider than 0.05 rad: within l^2 0.05^2 / 2 of the minimum, relative to its size.
    EXPECT_LE(least - minimum.value, 0.5 * bands * bands * 0.0025 * 2.0 * bands) << bands;
  }
}

// A needle that sampling would miss: f is 1 but for a dip below 0 at one point, 40 bands.
TEST(MinimumOnSphere, FindsANarrowDip) {
  const Vec3d where = glm::normalize(Vec3d(0.123, -0.456, 0.789));
  std::vector<double> f = rotate_zonal(spherical_gaussian(40, 150.0), where);
  for (double& c : f) c *= -1.01;
  f[0] += std::sqrt(4.0 * kPi);
  const SphereMinimum minimum = minimum_on_sphere(f, 1e-3);
  const double depth = evaluate(grey(f), where).r;
  EXPECT_LT(depth, 0.0);
  EXPECT_LE(minimum.lower_bound, depth);
  EXPECT_LE(minimum.value, depth + 1e-3);
  EXPECT_GT(glm::dot(minimum.direction, where), 0.999);
  EXPECT_FALSE(is_certainly_at_least(f, 0.0));
  EXPECT_TRUE(is_certainly_at_least(f, -0.1));
}

TEST(MinimumOnSphere, TakesConstantsAndRefusesBrokenNumbers) {
  EXPECT_EQ(minimum_on_sphere(std::vector<double>(16), 1e-6).value, 0.0);
  EXPECT_TRUE(is_certainly_at_least(std::vector<double>(16), 0.0));
  EXPECT_THROW(static_cast<void>(minimum_on_sphere({1.0, std::nan(""), 0.0, 0.0}, 1e-6)), InputError);
  EXPECT_THROW(static_cast<void>(minimum_on_sphere({1.0, 2.0}, 1e-6)), InputError);
  EXPECT_THROW(static_cast<void>(minimum_on_sphere({1.0}, 0.0)), InputError);
}

/// A small sun in a dim sky: rings.
ShRgb sun(int bands, const Vec3d& direction) {
  ShRgb light = lit(cap(bands, 0.05), direction, RgbD(1000.0, 800.0, 500.0));
  light.coefficients[0] += RgbD(0.1, 0.2, 0.3) * std::sqrt(4.0 * kPi);
  return light;
}

TEST(AutomaticWindow, LiftsTheLightAboveZeroAndNoFurther) {
  for (const int bands : {3, 5, 8}) {
    const ShRgb light = sun(bands, Vec3d(1.0, 2.0, -0.5));
    const AutomaticWindow window = automatic_window(light);
    EXPECT_GT(window.lambda, 0.0);
    EXPECT_GE(window.lower_bound, -1e-6 * 1000.0) << bands;
    for (const Vec3d& d : sh_test::directions(2000, 62)) {
      const RgbD radiance = evaluate(window.function, d);
      EXPECT_GE(std::min(radiance.r, std::min(radiance.g, radiance.b)), 0.0) << bands;
    }
    // A little less is not enough.
    const ShRgb less = windowed(light, Window::laplacian, 0.99 * window.lambda);
    double least = std::numeric_limits<double>::infinity();
    for (int channel = 0; channel < 3; ++channel) {
      std::vector<double> f;
      for (const RgbD& c : less.coefficients) f.push_back(c[channel]);
      least = std::min(least, minimum_on_sphere(f, 1e-3).value);
    }
    EXPECT_LT(least, 0.0) << bands;
    EXPECT_GT(window.relative_change, 0.0);
    EXPECT_LT(window.relative_change, 1.0);
    EXPECT_EQ(window.function.coefficients[0], light.coefficients[0]);
  }
}

TEST(AutomaticWindow, LeavesAloneWhatIsNotNegative) {
  const ShRgb light = hemisphere_light(5, {RgbD(2.0), RgbD(0.5)}, Vec3d(0.0, 1.0, 0.0));
  const AutomaticWindow window = automatic_window(light);
  EXPECT_EQ(window.lambda, 0.0);
  EXPECT_EQ(window.relative_change, 0.0);
  EXPECT_EQ(window.function.coefficients, light.coefficients);
  const AutomaticWindow dark = automatic_window(ShRgb{3, std::vector<RgbD>(9, RgbD(0.0))});
  EXPECT_EQ(dark.lambda, 0.0);
}

TEST(AutomaticWindow, DoesNotDependOnHowTheLightIsTurned) {
  const ShRgb light = sun(5, Vec3d(1.0, 2.0, -0.5));
  const double lambda = automatic_window(light).lambda;
  Uniform uniform(63);
  for (int i = 0; i < 5; ++i) {
    const double turned = automatic_window(rotate(light, random_rotation(uniform))).lambda;
    EXPECT_LE(std::abs(turned / lambda - 1.0), 2e-3) << i;  // each is known to a thousandth
  }
}

/// A widespread choice of lambda: so that the mean squared Laplacian falls to half. `first_order(l)` is where the sum
/// over m starts: -l, or the -1 of one implementation.
template <class FirstOrder>
double lambda_for_half_the_laplacian(const std::vector<double>& f, const FirstOrder& first_order) {
  const auto energy = [&](double lambda) {
    double sum = 0.0;
    for (int l = 1; l < 5; ++l) {
      const double a = l * l * (l + 1.0) * (l + 1.0);
      for (int m = first_order(l); m <= l; ++m) {
        const double c = f[static_cast<std::size_t>(index(l, m))];
        sum += a * c * c / ((1.0 + lambda * a) * (1.0 + lambda * a));
      }
    }
    return sum;
  };
  double low = 0.0;
  double high = 1e3;
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (energy(middle) > 0.5 * energy(0.0) ? low : high) = middle;
  }
  return high;
}

template <class FirstOrder>
double spread_over_rotations(const FirstOrder& first_order) {
  const std::vector<double> f = random_vector(5, 64);
  Uniform uniform(65);
  const double lambda = lambda_for_half_the_laplacian(f, first_order);
  double worst = 0.0;
  for (int i = 0; i < 10; ++i) {
    const double turned = lambda_for_half_the_laplacian(rotate(f, random_rotation(uniform)), first_order);
    worst = std::max(worst, std::abs(turned / lambda - 1.0));
  }
  return worst;
}

TEST(AutomaticWindow, TurningCatchesABandSumThatStartsAtMinusOne) {
  EXPECT_LE(spread_over_rotations([](int l) { return -l; }), 1e-9);
  EXPECT_GT(spread_over_rotations([](int) { return -1; }), 0.05);
}

TEST(AutomaticWindow, ScalesWithTheLight) {
  const ShRgb light = sun(5, Vec3d(1.0, 2.0, -0.5));
  const double lambda = automatic_window(light).lambda;
  for (const double scale : {1e30, 1e-30}) {
    ShRgb scaled = light;
    for (RgbD& c : scaled.coefficients) c *= scale;
    EXPECT_LE(std::abs(automatic_window(scaled).lambda / lambda - 1.0), 2e-3) << scale;
  }
}

TEST(AutomaticWindow, RefusesWhatNoWindowCanLift) {
  ShRgb negative = sun(3, Vec3d(0.0, 1.0, 0.0));
  negative.coefficients[0].g = -1.0;
  EXPECT_THROW(static_cast<void>(automatic_window(negative)), InputError);
  EXPECT_THROW(static_cast<void>(automatic_window(sun(3, Vec3d(0.0, 1.0, 0.0)), 1e6)), InputError);
  ShRgb broken = sun(3, Vec3d(0.0, 1.0, 0.0));
  broken.coefficients[4].b = std::nan("");
  EXPECT_THROW(static_cast<void>(automatic_window(broken)), InputError);
  broken.coefficients.pop_back();
  EXPECT_THROW(static_cast<void>(automatic_window(broken)), InputError);
}

}  // namespace
}  // namespace plumbline::sh
