// Lights in closed form against quadrature, known numbers and the furnace.
#include "prt/sh/analytic_lights.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "prt/sh/quadrature.hpp"
#include "prt/sh/rotation.hpp"
#include "prt/sh/zonal.hpp"
#include "reference/base/error.hpp"
#include "validation/tests/sh/rotations.hpp"

namespace plumbline::sh {
namespace {

using sh_test::largest_difference;
using sh_test::turn;

/// E(n)/pi of radiance coefficients: what a white surface sends on.
double exit_radiance(const std::vector<double>& radiance, const Vec3d& normal) {
  const int bands = bands_of(radiance.size(), "test");
  const std::vector<double> y = evaluate_basis(bands, normal);
  double sum = 0.0;
  for (int l = 0; l < bands; ++l) {
    for (int m = -l; m <= l; ++m) {
      const auto i = static_cast<std::size_t>(index(l, m));
      sum += clamped_cosine_factor(l) / kPi * radiance[i] * y[i];
    }
  }
  return sum;
}

std::vector<double> red(const ShRgb& light) {
  std::vector<double> result;
  for (const RgbD& c : light.coefficients) result.push_back(c.r);
  return result;
}

/// The contract of every light with radiance 1 everywhere: exit radiance 1 for every normal.
double furnace_error(const std::vector<double>& light) {
  double worst = 0.0;
  for (const Vec3d& n : {Vec3d(0.0, 0.0, 1.0), Vec3d(0.0, 1.0, 0.0), Vec3d(0.6, 0.0, -0.8)}) {
    worst = std::max(worst, std::abs(exit_radiance(light, n) - 1.0));
  }
  return worst;
}

TEST(HemisphereLight, PassesTheFurnaceWhereBothColoursAreOne) {
  for (const int bands : {1, 2, 3, 6, 20}) {
    const ShRgb light = hemisphere_light(bands, {RgbD(1.0), RgbD(1.0)}, Vec3d(1.0, 2.0, -3.0));
    EXPECT_LE(furnace_error(red(light)), 1e-14) << bands;
    EXPECT_LE(std::abs(light.coefficients[0].r - 3.5449077018110318), 1e-14);
  }
}

// One engine's hemisphere light: normalised to the directional light's contract, c_00 is 5.317 where it must be 3.545.
TEST(HemisphereLight, FurnaceCatchesAConstantOneAndAHalfTimesTooLarge) {
  std::vector<double> faulty = red(hemisphere_light(3, {RgbD(1.0), RgbD(1.0)}, Vec3d(0.0, 0.0, 1.0)));
  for (double& c : faulty) c *= 1.5;
  EXPECT_GT(furnace_error(faulty), 0.49);
}

// Facing a light that is 1 above and 0 below: 1/2 + (1/2) (2/3).
TEST(HemisphereLight, IsABlendOverTheWholeSphere) {
  const Vec3d up = glm::normalize(Vec3d(1.0, 2.0, -3.0));
  const ShRgb light = hemisphere_light(4, {RgbD(1.0, 2.0, 0.0), RgbD(0.0)}, 5.0 * up);
  EXPECT_LE(std::abs(exit_radiance(red(light), up) - 5.0 / 6.0), 1e-15);
  EXPECT_LE(std::abs(evaluate(light, up).g - 2.0), 1e-14);
  EXPECT_LE(std::abs(evaluate(light, -up).g), 1e-14);
}

TEST(SphereLight, IsTheCapItCovers) {
  EXPECT_LE(largest_difference(sphere_light(10, 2.0, 1.0), cap(10, kPi / 6.0)), 1e-15);
  EXPECT_THROW(static_cast<void>(sphere_light(3, 1.0, 1.0)), InputError);
  EXPECT_THROW(static_cast<void>(sphere_light(3, 1.0, 0.0)), InputError);
  EXPECT_THROW(static_cast<void>(sphere_light(3, std::nan(""), 0.1)), InputError);
}

// Radiance 1: E/pi facing it is sin^2 of the half angle as long as the horizon does not cut it; 20 bands hold it.
TEST(SphereLight, GivesTheKnownIrradiance) {
  const std::vector<double> light = red(lit(sphere_light(60, 2.0, 1.0), Vec3d(0.0, 3.0, 0.0), RgbD(1.0)));
  EXPECT_LE(std::abs(exit_radiance(light, Vec3d(0.0, 1.0, 0.0)) - 0.25), 2e-4);
}

TEST(DirectionalLight, IsAPulseOfIrradianceOne) {
  const Vec3d d = glm::normalize(Vec3d(1.0, 2.0, -3.0));
  const std::vector<double> pulse = red(lit(directional_light(6), d, RgbD(1.0)));
  EXPECT_LE(largest_difference(pulse, evaluate_basis(6, d)), 1e-15);
  // S4: scaled so that a facing white surface has exit radiance 1, 16 pi/17 at 3 bands and 32 pi/31 at 5.
  EXPECT_LE(
      std::abs(1.0 / exit_radiance(red(lit(directional_light(3), d, RgbD(1.0))), d) - 16.0 * kPi / 17.0),
      1e-13);
  EXPECT_LE(
      std::abs(1.0 / exit_radiance(red(lit(directional_light(5), d, RgbD(1.0))), d) - 32.0 * kPi / 31.0),
      1e-13);
}

// ---------------------------------------------------------------- spherical Gaussian

TEST(SphericalGaussian, HasTheKnownCoefficients) {
  const std::vector<double> k1{4.16597976253, 2.25876514473, .567254153358, .0943999223899};
  const std::vector<double> k4{24.1850594135, 31.4454280898, 23.6325320618, 13.0806985387};
  for (std::size_t l = 0; l < 4; ++l) {
    EXPECT_LE(std::abs(spherical_gaussian(4, 1.0)[l] * std::exp(1.0) - k1[l]), 6e-12) << l;
    EXPECT_LE(std::abs(spherical_gaussian(4, 4.0)[l] * std::exp(4.0) - k4[l]), 6e-11) << l;
  }
}

// 200 Gauss nodes in cos t from where exp(k (cos t - 1)) is 1e-20 to 1.
TEST(SphericalGaussian, AgreesWithQuadratureAtEverySharpness) {
  const GaussLegendre rule = gauss_legendre(200);
  for (const double k : {0.0, 1e-8, 0.01, 1.0, 20.0, 400.0, 1e4, 1e6, 0.9e8, 1.1e8, 1e12}) {
    const double range = k > 23.0 ? 46.0 / k : 2.0;
    std::vector<double> expected(20, 0.0);
    for (std::size_t n = 0; n < rule.nodes.size(); ++n) {
      const double fall = 0.5 * range * (1.0 + rule.nodes[n]);
      const std::vector<double> p = legendre(20, 1.0 - fall);
      for (std::size_t l = 0; l < 20; ++l) {
        const double scale = std::sqrt(kPi * (2.0 * static_cast<double>(l) + 1.0)) * 0.5 * range;
        expected[l] += scale * rule.weights[n] * std::exp(-k * fall) * p[l];
      }
    }
    const std::vector<double> zonal = spherical_gaussian(20, k);
    for (std::size_t l = 0; l < 20; ++l) {
      EXPECT_LE(std::abs(zonal[l] - expected[l]), 1e-12 * expected[0]) << k << " " << l;
    }
  }
  EXPECT_THROW(static_cast<void>(spherical_gaussian(3, -1.0)), InputError);
  EXPECT_THROW(static_cast<void>(spherical_gaussian(3, std::numeric_limits<double>::infinity())), InputError);
}

// ---------------------------------------------------------------- polygons

/// Integral over a flat triangle by the definition: d omega = |p . N| / |p|^3 dA, Gauss nodes in collapsed coordinates.
std::vector<double> triangle_by_quadrature(int bands, const Vec3d& a, const Vec3d& b, const Vec3d& c,
                                           int nodes) {
  const GaussLegendre rule = gauss_legendre(nodes);
  const Vec3d normal = glm::cross(b - a, c - a);
  std::vector<double> sum(static_cast<std::size_t>(bands * bands), 0.0);
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const double u = 0.5 + 0.5 * rule.nodes[i];
    for (std::size_t j = 0; j < rule.nodes.size(); ++j) {
      const double v = 0.5 + 0.5 * rule.nodes[j];
      const Vec3d p = a + u * ((1.0 - v) * (b - a) + v * (c - a));
      const double r = glm::length(p);
      const double weight = 0.25 * rule.weights[i] * rule.weights[j] * u * glm::dot(p, normal) / (r * r * r);
      const std::vector<double> y = evaluate_basis(bands, p / r);
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += weight * y[k];
    }
  }
  return sum;
}

const std::vector<Vec3d> kTriangle{{1.0, 0.0, 1.0}, {0.0, 1.0, 1.0}, {-1.0, -1.0, 2.0}};

// The last triangle's integrand peaks below the receiver: 160 nodes leave 1e-10 of it, 200 nothing above 1e-13.
TEST(PolygonLight, AgreesWithQuadratureTo30Bands) {
  const std::vector<std::vector<Vec3d>> triangles{
      kTriangle,
      {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}},        // edges on the axes' planes
      {{1.0, 0.2, -0.1}, {1.1, 0.3, 0.1}, {0.9, 0.1, 0.2}},       // small, beside the equator
      {{3.0, 0.0, -0.5}, {-2.0, 3.0, -0.5}, {-2.0, -3.0, -0.5}},  // around the pole, most of a hemisphere
  };
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const std::vector<double> expected =
        triangle_by_quadrature(30, triangles[i][0], triangles[i][1], triangles[i][2], i == 3 ? 200 : 90);
    EXPECT_LE(largest_difference(polygon_light(30, triangles[i]), expected), 1e-12) << i;
  }
}

// The truth of Lambert's formula: solid angle and vector irradiance are the first four coefficients.
TEST(PolygonLight, FirstTwoDegreesAreLambertsFormula) {
  const std::vector<double> light = polygon_light(2, kTriangle);
  EXPECT_LE(std::abs(light[0] - 0.748996398184 / std::sqrt(4.0 * kPi)), 1e-12);
  Vec3d vector(0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d a = glm::normalize(kTriangle[i]);
    const Vec3d b = glm::normalize(kTriangle[(i + 1) % 3]);
    vector += 0.5 * std::acos(glm::dot(a, b)) * glm::normalize(glm::cross(a, b));
  }
  EXPECT_LE(std::abs(vector.z - 0.687617388735), 1e-12);
  const double scale = std::sqrt(3.0 / (4.0 * kPi));
  EXPECT_LE(std::abs(light[1] + scale * vector.y), 1e-14);
  EXPECT_LE(std::abs(light[2] - scale * vector.z), 1e-14);
  EXPECT_LE(std::abs(light[3] + scale * vector.x), 1e-14);
}

TEST(PolygonLight, AddsUpAndTurnsWithItsVertices) {
  const std::vector<Vec3d> concave{{2.0, 0.0, 1.0}, {0.3, 0.3, 1.0}, {0.0, 2.0, 1.0}, {-1.0, -1.0, 1.0}};
  const std::vector<double> whole = polygon_light(20, concave);
  const std::vector<double> first = polygon_light(20, std::vector<Vec3d>{concave[0], concave[1], concave[3]});
  const std::vector<double> second =
      polygon_light(20, std::vector<Vec3d>{concave[1], concave[2], concave[3]});
  std::vector<double> sum;
  for (std::size_t i = 0; i < whole.size(); ++i) sum.push_back(first[i] + second[i]);
  EXPECT_LE(largest_difference(whole, sum), 1e-14);

  const glm::dmat3 r = turn(Vec3d(1.0, -2.0, 0.5), 2.0);
  std::vector<Vec3d> turned;
  for (const Vec3d& v : concave) turned.push_back(7.0 * (r * v));
  EXPECT_LE(largest_difference(polygon_light(20, turned), rotate(whole, r)), 1e-13);

  const std::vector<Vec3d> reversed(concave.rbegin(), concave.rend());
  std::vector<double> negative = polygon_light(20, reversed);
  for (double& c : negative) c *= -1.0;
  EXPECT_LE(largest_difference(negative, whole), 1e-14);
}

// Six faces of a cube cover the sphere once: sqrt(4 pi) y_00 and nothing else. Faces reach below every horizon.
TEST(PolygonLight, CubeAroundTheReceiverIsTheWholeSphere) {
  std::vector<double> sum(900, 0.0);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Vec3d n(0.0);
      Vec3d u(0.0);
      Vec3d v(0.0);
      n[axis] = side;
      u[(axis + 1) % 3] = side;
      v[(axis + 2) % 3] = 1.0;
      const std::vector<double> face =
          polygon_light(30, std::vector<Vec3d>{n - u - v, n + u - v, n + u + v, n - u + v});
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += face[i];
    }
  }
  EXPECT_LE(std::abs(sum[0] - std::sqrt(4.0 * kPi)), 1e-13);
  sum[0] = 0.0;
  EXPECT_LE(largest_difference(sum, std::vector<double>(900)), 1e-13);
}

TEST(PolygonLight, TinyPolygonsAreTheirSolidAngleTimesTheBasis) {
  const Vec3d centre(1.0, 2.0, 2.0);  // at distance 3
  const Vec3d u = glm::normalize(glm::cross(centre, Vec3d(0.0, 0.0, 1.0)));
  const Vec3d v = glm::normalize(glm::cross(centre, u));
  constexpr double kSide = 1e-5;
  const std::vector<Vec3d> square{centre, centre + kSide * u, centre + kSide * (u + v), centre + kSide * v};
  const std::vector<double> light = polygon_light(5, square);
  const std::vector<double> y = evaluate_basis(5, glm::normalize(centre + 0.5 * kSide * (u + v)));
  const double omega = kSide * kSide / 9.0;
  for (std::size_t i = 0; i < y.size(); ++i) EXPECT_LE(std::abs(light[i] / omega - y[i]), 1e-5) << i;
}

TEST(PolygonLight, TakesRepeatedVerticesAndRefusesWhatHasNoDirection) {
  std::vector<Vec3d> doubled = kTriangle;
  doubled.insert(doubled.begin(), kTriangle[0]);
  EXPECT_LE(largest_difference(polygon_light(5, doubled), polygon_light(5, kTriangle)), 1e-15);
  // Its plane passes through the receiver: it covers nothing.
  const std::vector<double> edge_on =
      polygon_light(5, std::vector<Vec3d>{{1.0, 0.0, 0.0}, {2.0, 1.0, 0.0}, {2.0, -1.0, 0.0}});
  EXPECT_LE(largest_difference(edge_on, std::vector<double>(25)), 1e-15);
  const double nan = std::nan("");
  using Vertices = std::vector<Vec3d>;
  for (const Vertices& bad : {Vertices{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}},
                              Vertices{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 0.0}},
                              Vertices{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, nan, 1.0}},
                              Vertices{{1.0, 0.0, 0.0}, {-2.0, 0.0, 0.0}, {0.0, 0.0, 1.0}}}) {
    EXPECT_THROW(static_cast<void>(polygon_light(3, bad)), InputError);
  }
}

TEST(EmissivePolygon, EmitsFromItsFrontOnly) {
  // Counterclockwise seen from +z: emits upwards.
  const std::vector<Vec3d> ground{{-1.0, -1.0, 0.0}, {1.0, -1.0, 0.0}, {1.0, 1.0, 0.0}};
  const Vec3d above(0.2, -0.3, 1.0);
  const Vec3d below(0.2, -0.3, -1.0);
  const ShRgb front = emissive_polygon(6, above, ground, RgbD(1.0, 2.0, 3.0));
  EXPECT_GT(front.coefficients[0].r, 0.1);
  EXPECT_EQ(front.coefficients[0].g, 2.0 * front.coefficients[0].r);
  EXPECT_GT(evaluate(front, Vec3d(0.0, 0.0, -1.0)).r, 0.5);
  for (const RgbD& c : emissive_polygon(6, below, ground, RgbD(1.0)).coefficients) EXPECT_EQ(c, RgbD(0.0));
  const ShRgb back = emissive_polygon(6, below, ground, RgbD(1.0), EmittingSides::both);
  EXPECT_LE(std::abs(back.coefficients[0].r - front.coefficients[0].r), 1e-15);
  EXPECT_THROW(static_cast<void>(emissive_polygon(3, above, ground, RgbD(std::nan("")))), InputError);
}

TEST(Lit, RefusesAnAxisWithoutLengthAndBrokenRadiance) {
  EXPECT_THROW(static_cast<void>(lit(directional_light(3), Vec3d(0.0), RgbD(1.0))), InputError);
  EXPECT_THROW(static_cast<void>(lit(directional_light(3), Vec3d(0.0, std::nan(""), 1.0), RgbD(1.0))),
               InputError);
  EXPECT_THROW(
      static_cast<void>(lit(directional_light(3), Vec3d(0.0, 0.0, 1.0), RgbD(1.0, std::nan(""), 1.0))),
      InputError);
  EXPECT_THROW(static_cast<void>(lit(std::vector<double>(3), RgbD(1.0))), InputError);
  // Directions whose squares overflow or vanish are directions all the same.
  const ShRgb far = lit(directional_light(3), Vec3d(0.0, 1e300, 1e300), RgbD(1e30));
  const ShRgb near = lit(directional_light(3), Vec3d(0.0, 1e-300, 1e-300), RgbD(1e30));
  for (std::size_t i = 0; i < 9; ++i)
    EXPECT_LE(std::abs(far.coefficients[i].r - near.coefficients[i].r), 1e15);
}

}  // namespace
}  // namespace plumbline::sh
