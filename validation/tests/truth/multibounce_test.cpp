#include "validation/truth/multibounce.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

#include "reference/base/error.hpp"
#include "validation/tests/truth/quadrature.hpp"
#include "validation/truth/irradiance.hpp"

namespace plumbline::truth {
namespace {

constexpr double kDegree = kPi / 180.0;
constexpr double kTight = 1e-11;

/// A spherical cavity z_low < z < z_high of radius R, lit symmetrically about z: the integral equation
/// E = direct + rho int E kernel dA on Gauss nodes in z (Archimedes: dA = R dz dphi), iterated.
struct Cavity {
  double radius = 1.0;
  double z_low = -1.0;
  double z_high = 1.0;
  double albedo = 0.0;
};

/// Irradiance on the nodes of gauss(count) from low to high after bounces 0..N.
std::vector<double> iterate_cavity(const Cavity& cavity, const Rule& rule,
                                   const std::function<double(double z)>& direct, int bounces) {
  const std::size_t n = rule.nodes.size();
  const auto z = [&](std::size_t i) { return cavity.z_low + (cavity.z_high - cavity.z_low) * rule.nodes[i]; };
  const auto point = [&](double height, double azimuth) {
    const double r = std::sqrt(cavity.radius * cavity.radius - height * height);
    return Vec3d(r * std::cos(azimuth), r * std::sin(azimuth), height);
  };
  std::vector<std::vector<double>> weights(n, std::vector<double>(n));
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3d from = point(z(i), 0.0);
    for (std::size_t j = 0; j < n; ++j) {
      const double ring = integrate_turn(8, [&](double p) {
        const Vec3d to = point(z(j), p);
        return kernel(from, -from / cavity.radius, to, -to / cavity.radius);
      });
      weights[i][j] = cavity.radius * ring * rule.weights[j] * (cavity.z_high - cavity.z_low);
    }
  }
  std::vector<double> total(n);
  std::vector<double> last(n);
  for (std::size_t i = 0; i < n; ++i) last[i] = total[i] = direct(z(i));
  for (int k = 0; k < bounces; ++k) {
    std::vector<double> next(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) next[i] += cavity.albedo * weights[i][j] * last[j];
      total[i] += next[i];
    }
    last = next;
  }
  return total;
}

TEST(TruthMultibounce, PublishedNumbersToAllDigits) {
  expect_digits(enclosure_radiance(1.0, 0.8), "5.00000000000");
  expect_digits(enclosure_radiance(1.0, 0.8, 7), "4.32891136");  // emission and 8 reflections
  expect_digits(white_furnace_transfer(), "0.282094791774");
  expect_digits(sphere_point_light_radiance(kPi, 0.0, 1.0, 1.0, 0.5), "1.00000000000");
  expect_digits(sphere_indirect_irradiance(4.0 * kPi, 1.0, 0.5), "1.00000000000");
  expect_digits(sphere_point_light_radiance(1.0, 0.5, 1.0, -1.0, 0.5), "0.229890473355");
  expect_digits(sphere_point_light_radiance(1.0, 0.5, 1.0, 1.0, 0.5), "0.795774715459");
  expect_digits(cavity_irradiance(kPi / 2.0, 0.8, 1.0), "2.61799387799");
  expect_digits(0.8 / kPi * cavity_irradiance(kPi / 2.0, 0.8, 1.0), "0.666666666667");
  expect_digits(cavity_irradiance(kPi / 2.0, 1.0, 1.0) / kPi, "1.00000000000");
  expect_digits(bowl_indirect_irradiance(1.0, 0.8), "0.333333333333");
  expect_digits(bowl_indirect_irradiance(1.0, 0.8, 1), "0.2");
  expect_digits(bowl_indirect_irradiance(1.0, 0.8, 2), "0.28");
  expect_digits(dihedral_irradiances(90.0 * kDegree, 0.8, 0.8, 1.0).first, "2.61799387799");
  expect_digits(dihedral_irradiances(60.0 * kDegree, 0.8, 0.8, 1.0).first, "1.96349540849");
  expect_digits(dihedral_irradiances(120.0 * kDegree, 0.8, 0.8, 1.0).second, "2.94524311274");
  expect_digits(dihedral_irradiances(90.0 * kDegree, 0.5, 0.8, 1.0).first, "2.44346095279");
  expect_digits(dihedral_irradiances(90.0 * kDegree, 0.5, 0.8, 1.0).second, "2.18166156499");
  expect_digits(concentric_spheres_radiosity(1.0, 2.0, {1.0, 0.0}, {0.5, 0.8}).first, "1.33333333333");
  expect_digits(concentric_spheres_radiosity(1.0, 2.0, {1.0, 0.0}, {0.5, 0.8}).second, "0.666666666667");
  expect_digits(parallel_plates_radiosity({1.0, 0.0}, {0.5, 0.8}).first, "1.66666666667");
  expect_digits(parallel_plates_radiosity({1.0, 0.0}, {0.5, 0.8}).second, "1.33333333333");
  expect_digits(neumann_term(kPi / 2.0, 0.8, 0.5, 2), "0.251327412287");
  expect_digits(finite_corner_form_factor(1000.0, 1.0), "0.499431690424");
  expect_digits(corner_direct_transfer({0, 0, 1}, {0, 1, 0})[0], "0.141047395887");
  const ThreeBands corner = corner_transfer({0, 0, 1}, {0, 1, 0}, 0.8, 0.8);
  expect_digits(corner[0], "0.235078993145");
  expect_digits(corner[1], "-0.200990089");
  expect_digits(corner[2], "0.243263540");
}

// The published vectors are for irradiance (pi times ours) and without the Condon-Shortley sign.
TEST(TruthMultibounce, CornerTransferMatchesPublishedVectors) {
  const Vec3d floor(0.0, 0.0, 1.0);
  const Vec3d wall(0.0, 1.0, 0.0);
  const auto check = [](const ThreeBands& ours, const std::array<const char*, 9>& published) {
    for (int l = 0; l <= 2; ++l) {
      for (int m = -l; m <= l; ++m) {
        const auto i = static_cast<std::size_t>(l * (l + 1) + m);
        SCOPED_TRACE(testing::Message() << "l=" << l << " m=" << m);
        expect_digits((m % 2 == 0 ? 1.0 : -1.0) * kPi * ours[i], published[i]);
      }
    }
  };
  check(corner_direct_transfer(floor, wall),
        {".443113463", ".325735008", ".511663354", "0.000000000", "0.000000000", ".429042765", ".247707956",
         "0.000000000", "0.000000000"});
  check(corner_direct_transfer(wall, floor),
        {".443113463", ".511663354", ".325735008", "0.000000000", "0.000000000", ".429042765", "-.123853978",
         "0.000000000", "-.214521383"});
  check(corner_transfer(floor, wall, 0.8, 0.8),
        {".738522438", ".631428988", ".764234949", "0.000000000", "0.000000000", ".715071276", ".235912339",
         "0.000000000", "-.102153039"});
}

TEST(TruthMultibounce, NeumannTermsAddUpToTheClosedForm) {
  for (const double albedo : {0.0, 0.3, 0.8, 1.0}) {
    double sum = 0.0;
    for (int k = 0; k <= 8; ++k) {
      sum += neumann_term(kPi / 2.0, albedo, 0.5, k);
      EXPECT_LE(std::abs(neumann_sum(kPi / 2.0, albedo, 0.5, k) - sum), kTight) << albedo << ' ' << k;
      const double all = neumann_sum(kPi / 2.0, albedo, 0.5, kAllBounces);
      EXPECT_LE(std::abs(sum + neumann_remainder(kPi / 2.0, albedo, 0.5, k) - all), kTight)
          << albedo << ' ' << k;
    }
  }
}

// Six faces of a cube with the form factors of Howell's catalogue: radiosity by iteration.
TEST(TruthMultibounce, EnclosureMatchesTheRadiosityOfACube) {
  const double opposite = opposite_rectangles_form_factor(1.0, 1.0, 1.0);
  const double adjacent = adjacent_rectangles_form_factor(1.0, 1.0, 1.0);
  std::array<double, 6> radiance{};
  radiance.fill(1.0);
  for (int reflections = 1; reflections <= 40; ++reflections) {
    std::array<double, 6> next{};
    for (std::size_t i = 0; i < 6; ++i) {
      double received = 0.0;
      for (std::size_t j = 0; j < 6; ++j) {
        if (i != j) received += (i / 2 == j / 2 ? opposite : adjacent) * radiance[j];
      }
      next[i] = 1.0 + 0.8 * received;
    }
    radiance = next;
    EXPECT_LE(std::abs(enclosure_radiance(1.0, 0.8, reflections - 1) - radiance[3]), kTight) << reflections;
  }
  EXPECT_LE(std::abs(enclosure_radiance(1.0, 0.8, 199) - enclosure_radiance(1.0, 0.8)), kTight);
}

TEST(TruthMultibounce, SphereWithAPointLightSolvesItsIntegralEquation) {
  const Cavity sphere = {.radius = 1.5, .z_low = -1.5, .z_high = 1.5, .albedo = 0.5};
  const Rule rule = gauss(60);
  const double offset = 0.6;
  const auto direct = [&](double z) {
    const Vec3d wall(std::sqrt(2.25 - z * z), 0.0, z);
    const Vec3d way = Vec3d(0.0, 0.0, offset) - wall;
    return 2.0 * glm::dot(-wall / 1.5, way) / std::pow(glm::length(way), 3.0);
  };
  for (const int bounces : {0, 1, 3, 60}) {
    const std::vector<double> irradiance = iterate_cavity(sphere, rule, direct, bounces);
    for (std::size_t i = 0; i < rule.nodes.size(); i += 7) {
      const double c = 2.0 * rule.nodes[i] - 1.0;
      const Bounces limit = bounces == 60 ? kAllBounces : Bounces(bounces);
      const double expected = sphere_point_light_radiance(2.0, offset, 1.5, c, 0.5, limit);
      EXPECT_LE(std::abs(0.5 / kPi * irradiance[i] - expected), kTight) << bounces << ' ' << c;
    }
  }
}

/// Form factor from a wall point (height z) to the flat opening at height `rim` of a sphere of radius 1.
double opening_form_factor(double z, double rim) {
  const Vec3d from(std::sqrt(1.0 - z * z), 0.0, z);
  const double radius = std::sqrt(1.0 - rim * rim);
  return integrate(gauss(80), 0.0, radius, [&](double r) {
    return r * integrate_turn(256, [&](double p) {
             return kernel(from, -from, {r * std::cos(p), r * std::sin(p), rim}, {0.0, 0.0, -1.0});
           });
  });
}

TEST(TruthMultibounce, OpenCavitySolvesItsIntegralEquation) {
  const Rule rule = gauss(12);
  for (const double opening : {40.0 * kDegree, 90.0 * kDegree, 120.0 * kDegree}) {
    const double rim = std::cos(opening);
    const double share = (1.0 - rim) / 2.0;
    for (const double z : {-1.0, rim - 0.4}) {  // the sky's share is the same everywhere
      EXPECT_LE(std::abs(opening_form_factor(std::max(z, -1.0), rim) - share), 1e-9) << opening << ' ' << z;
    }
    const Cavity cavity = {.radius = 1.0, .z_low = -1.0, .z_high = rim, .albedo = 0.8};
    const auto direct = [&](double) { return kPi * share; };
    for (const int bounces : {0, 2, 150}) {
      const Bounces limit = bounces == 150 ? kAllBounces : Bounces(bounces);
      const double expected = cavity_irradiance(opening, 0.8, 1.0, limit);
      for (const double e : iterate_cavity(cavity, rule, direct, bounces)) {
        EXPECT_LE(std::abs(e - expected), kTight) << opening << ' ' << bounces;
      }
    }
  }
}

TEST(TruthMultibounce, SunlitBowlSolvesItsIntegralEquation) {
  const Cavity bowl = {.radius = 2.0, .z_low = -2.0, .z_high = 0.0, .albedo = 0.8};
  const Rule rule = gauss(20);
  const auto sun = [](double z) { return 3.0 * -z / 2.0; };
  for (const int bounces : {0, 1, 2, 80}) {
    const std::vector<double> irradiance = iterate_cavity(bowl, rule, sun, bounces);
    const Bounces limit = bounces == 80 ? kAllBounces : Bounces(bounces);
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
      const double indirect = irradiance[i] - sun(-2.0 + 2.0 * rule.nodes[i]);
      EXPECT_LE(std::abs(indirect - bowl_indirect_irradiance(3.0, 0.8, limit)), kTight) << bounces;
    }
  }
}

// Face points t (cos phi, sin phi) at any place y along the edge, receiver at distance d: integrating 1/r^4
// over y leaves t d sin^2(phi)/(2 a^3), a the distance in the plane across the edge; t = d u/(1 - u).
TEST(TruthMultibounce, DihedralFormFactorMatchesQuadratureAtAnyDistance) {
  const Rule rule = gauss(120);
  for (const double opening : {0.5, 60.0 * kDegree, 90.0 * kDegree, 120.0 * kDegree, 3.0}) {
    for (const double d : {0.1, 1.0, 20.0}) {
      const double sum = integrate(rule, 0.0, 1.0, [&](double u) {
        const double t = d * u / (1.0 - u);
        const double a2 = d * d + t * t - 2.0 * d * t * std::cos(opening);
        const double sine = std::sin(opening);
        return t * d * sine * sine / (2.0 * a2 * std::sqrt(a2)) * d / ((1.0 - u) * (1.0 - u));
      });
      EXPECT_LE(std::abs(dihedral_form_factor(opening) - sum), 1e-10) << opening << ' ' << d;
    }
  }
}

TEST(TruthMultibounce, DihedralMatchesTheIteratedPair) {
  for (const double opening : {60.0 * kDegree, 100.0 * kDegree}) {
    const double f = dihedral_form_factor(opening);
    const double direct = kPi * dihedral_sky_view(opening);
    Pair total = {direct, direct};
    Pair last = total;
    for (int bounces = 1; bounces <= 100; ++bounces) {
      last = {f * 0.8 * last.second, f * 0.5 * last.first};
      total = {total.first + last.first, total.second + last.second};
      const Pair closed = dihedral_irradiances(opening, 0.5, 0.8, 1.0, bounces);
      EXPECT_LE(std::abs(closed.first - total.first), kTight) << bounces;
      EXPECT_LE(std::abs(closed.second - total.second), kTight) << bounces;
    }
    const Pair all = dihedral_irradiances(opening, 0.5, 0.8, 1.0);
    EXPECT_LE(std::abs(all.first - total.first) + std::abs(all.second - total.second), kTight);
  }
}

TEST(TruthMultibounce, FiniteCornerMatchesQuadratureAndItsExpansion) {
  const Rule rule = gauss(100);
  const double reach = 3.0;  // wall |y| < reach, 0 < z < reach at x = 0; receiver at (d, 0, 0) with normal z
  for (const double d : {0.5, 1.0, 4.0}) {
    const double sum = integrate(rule, 0.0, reach, [&](double z) {
      return 2.0 * integrate(rule, 0.0, reach, [&](double y) {
               return kernel({d, 0.0, 0.0}, {0.0, 0.0, 1.0}, {0.0, y, z}, {1.0, 0.0, 0.0});
             });
    });
    EXPECT_LE(std::abs(finite_corner_form_factor(reach, d) - sum), 1e-10) << d;
  }
  const double step = 1e-4;
  const double slope = (0.5 - finite_corner_form_factor(1.0, step)) / step;
  EXPECT_LE(std::abs(slope - (1.0 / kPi + 0.25)), 1e-3);  // next term of the expansion: O(step)
  EXPECT_LE(std::abs(slope - 0.568), 1e-3);
}

// Outer to inner form factor by quadrature over the visible cap of the inner sphere, then fixed-point
// iteration.
TEST(TruthMultibounce, ConcentricSpheresMatchTheIteratedPair) {
  const double r1 = 0.8;
  const double r2 = 2.0;
  const double q = integrate(gauss(60), r1 / r2, 1.0, [&](double mu) {
    const double s = std::sqrt(1.0 - mu * mu);
    const Vec3d u(s, 0.0, mu);
    return 2.0 * kPi * r1 * r1 * kernel({0.0, 0.0, r2}, {0.0, 0.0, -1.0}, r1 * u, u);
  });
  EXPECT_LE(std::abs(q - r1 * r1 / (r2 * r2)), kTight);
  Pair b;
  for (int i = 0; i < 400; ++i) {
    b = {1.0 + 0.5 * b.second, 0.3 + 0.8 * (q * b.first + (1.0 - q) * b.second)};
  }
  const Pair closed = concentric_spheres_radiosity(r1, r2, {1.0, 0.3}, {0.5, 0.8});
  EXPECT_LE(std::abs(closed.first - b.first) + std::abs(closed.second - b.second), 1e-10);
}

TEST(TruthMultibounce, ParallelPlatesSolveTheirEquations) {
  const Pair b = parallel_plates_radiosity({1.0, 0.4}, {0.5, 0.8});
  EXPECT_LE(std::abs(b.first - (1.0 + 0.5 * b.second)), kTight);
  EXPECT_LE(std::abs(b.second - (0.4 + 0.8 * b.first)), kTight);
}

/// y_lm of three bands from the standard library's associated Legendre functions, which carry the
/// Condon-Shortley sign.
ThreeBands library_basis(const Vec3d& w) {
  const double theta = std::acos(w.z);
  const double phi = std::atan2(w.y, w.x);
  ThreeBands y{};
  for (int l = 0; l <= 2; ++l) {
    for (int m = -l; m <= l; ++m) {
      const auto degree = static_cast<unsigned>(l);
      const auto order = static_cast<unsigned>(std::abs(m));
      const double turn = m > 0 ? std::cos(m * phi) : m < 0 ? std::sin(-m * phi) : std::sqrt(0.5);
      y[static_cast<std::size_t>(l * (l + 1) + m)] =
          std::sqrt(2.0) * std::sph_legendre(degree, order, theta) * turn;
    }
  }
  return y;
}

/// (1/pi) int of y_i (w.f) over the quarter sphere w.f > 0, w.n > 0, by quadrature.
std::vector<double> quarter_sphere_projection(const Vec3d& f, const Vec3d& n) {
  const Vec3d t = glm::cross(f, n);
  std::vector<double> sum(9, 0.0);
  const Rule rule = gauss(30);
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    for (std::size_t j = 0; j < rule.nodes.size(); ++j) {
      const double theta = kPi / 2.0 * rule.nodes[i];
      const double phi = kPi * rule.nodes[j];
      const Vec3d w = f * std::cos(theta) + (t * std::cos(phi) + n * std::sin(phi)) * std::sin(theta);
      const double weight =
          kPi / 2.0 * kPi * rule.weights[i] * rule.weights[j] * std::sin(theta) * std::cos(theta);
      const ThreeBands y = library_basis(w);
      for (std::size_t k = 0; k < 9; ++k) sum[k] += weight / kPi * y[k];
    }
  }
  return sum;
}

TEST(TruthMultibounce, CornerTransferMatchesQuadratureInAnyFrame) {
  const Vec3d tilted = glm::normalize(Vec3d(0.3, -0.7, 0.5));
  const Vec3d across = glm::normalize(glm::cross(tilted, Vec3d(1.0, 0.2, 0.0)));
  const std::array<std::array<Vec3d, 2>, 4> frames = {{{Vec3d(0, 0, 1), Vec3d(0, 1, 0)},
                                                       {Vec3d(0, 1, 0), Vec3d(0, 0, 1)},
                                                       {Vec3d(0, 1, 0), Vec3d(1, 0, 0)},
                                                       {tilted, across}}};
  for (const auto& [floor, wall] : frames) {
    const std::vector<double> d1 = quarter_sphere_projection(floor, wall);
    const std::vector<double> d2 = quarter_sphere_projection(wall, floor);
    const ThreeBands direct = corner_direct_transfer(floor, wall);
    std::vector<double> total = d1;  // bounces alternate between the faces
    double own = 1.0;
    for (int bounce = 0; bounce <= 60; ++bounce) {
      const ThreeBands closed = corner_transfer(floor, wall, 0.5, 0.8, bounce);
      for (std::size_t i = 0; i < 9; ++i)
        EXPECT_LE(std::abs(closed[i] - total[i]), kTight) << bounce << ' ' << i;
      own *= 0.5 * (bounce % 2 == 0 ? 0.8 : 0.5);
      for (std::size_t i = 0; i < 9; ++i) total[i] += own * (bounce % 2 == 0 ? d2[i] : d1[i]);
    }
    const ThreeBands all = corner_transfer(floor, wall, 0.5, 0.8);
    for (std::size_t i = 0; i < 9; ++i) {
      EXPECT_LE(std::abs(direct[i] - d1[i]), kTight) << i;
      EXPECT_LE(std::abs(all[i] - total[i]), kTight) << i;
    }
  }
}

TEST(TruthMultibounce, CornerTransferUnderAUniformSkyIsTheDihedral) {
  const ThreeBands t = corner_transfer({0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}, 0.5, 0.8);
  const double irradiance = kPi * t[0] * std::sqrt(4.0 * kPi);
  EXPECT_LE(std::abs(irradiance - dihedral_irradiances(kPi / 2.0, 0.5, 0.8, 1.0).first), kTight);
  const ThreeBands white = corner_transfer({0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}, 1.0, 1.0);
  EXPECT_LE(std::abs(white[0] - white_furnace_transfer()), kTight);
}

TEST(TruthMultibounce, RefusesWhatHasNoClosedForm) {
  EXPECT_THROW((void)enclosure_radiance(1.0, 1.0), InputError);
  EXPECT_THROW((void)enclosure_radiance(1.0, 1.2, 3), InputError);
  EXPECT_THROW((void)enclosure_radiance(1.0, 0.5, -1), InputError);
  EXPECT_THROW((void)sphere_point_light_radiance(1.0, 1.0, 1.0, 0.0, 0.5), InputError);
  EXPECT_THROW((void)corner_transfer({0, 0, 1}, {0, 1, 1}, 0.5, 0.5), InputError);
  EXPECT_THROW((void)concentric_spheres_radiosity(2.0, 1.0, {1.0, 0.0}, {0.5, 0.5}), InputError);
  EXPECT_THROW((void)concentric_spheres_radiosity(1.0, 2.0, {1.0, 0.0}, {1.0, 1.0}), InputError);
}

// The checks above must be able to fail: the commonest slips move the numbers far beyond the tolerances.
TEST(TruthMultibounce, UsualSlipsAreFarOutsideTheTolerances) {
  const double right = dihedral_irradiances(kPi / 2.0, 0.5, 0.8, 1.0).first;
  EXPECT_GT(std::abs(dihedral_irradiances(kPi / 2.0, 0.8, 0.5, 1.0).first - right), 0.1) << "albedos swapped";
  const ThreeBands t = corner_transfer({0.0, 0.0, 1.0}, {0.0, 1.0, 0.0}, 0.8, 0.8);
  EXPECT_GT(std::abs(2.0 * t[1]), 0.1) << "sign of m = -1";
  EXPECT_GT(std::abs(neumann_term(1.0, 0.8, 0.5, 1) - 0.8), 0.1) << "form factor left out";
}

}  // namespace
}  // namespace plumbline::truth
