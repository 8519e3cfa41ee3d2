#include "validation/truth/irradiance.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "reference/base/error.hpp"
#include "validation/tests/truth/quadrature.hpp"

namespace plumbline::truth {
namespace {

constexpr double kDegree = kPi / 180.0;
constexpr double kTight = 1e-11;  // Gauss and trapezoid on analytic integrands: rounding of ~1e4 terms
const Vec3d kZ(0.0, 0.0, 1.0);

/// int over the hemisphere about `normal` of L(w) (w.normal).
template <class Radiance>
double hemisphere(const Vec3d& normal, const Radiance& radiance) {
  const Rule rule = gauss(24);
  const Vec3d side = std::abs(normal.z) < 0.9 ? kZ : Vec3d(1.0, 0.0, 0.0);
  const Vec3d t = glm::normalize(glm::cross(side, normal));
  const Vec3d b = glm::cross(normal, t);
  return integrate(rule, 0.0, 1.0, [&](double c) {
    const double s = std::sqrt(1.0 - c * c);
    return c * integrate_turn(48, [&](double p) {
             return radiance(normal * c + (t * std::cos(p) + b * std::sin(p)) * s);
           });
  });
}

/// Receiver n = (sin b, 0, cos b): int of L(w) (w.n) over the part of its hemisphere between azimuths `from`
/// and `to` about the y axis, counted from the horizon: (0, pi - b) is sky, (-b, 0) ground.
template <class Radiance>
double lune(double tilt, double from, double to, const Radiance& radiance) {
  const Rule rule = gauss(40);
  const Vec3d n(std::sin(tilt), 0.0, std::cos(tilt));
  return integrate(rule, 0.0, kPi, [&](double alpha) {
    return std::sin(alpha) * integrate(rule, from, to, [&](double beta) {
             const Vec3d w(std::sin(alpha) * std::cos(beta), std::cos(alpha),
                           std::sin(alpha) * std::sin(beta));
             return radiance(w) * glm::dot(w, n);
           });
  });
}

/// Form factor of the parallelogram corner + u, v (each in 0..1), seen from the origin with normal +z.
double parallelogram(const Vec3d& corner, const Vec3d& u, const Vec3d& v, int count = 60) {
  const Rule rule = gauss(count);
  const Vec3d area = glm::cross(u, v);
  const Vec3d facing = glm::dot(area, corner) < 0.0 ? area : -area;
  return integrate(rule, 0.0, 1.0, [&](double s) {
    return integrate(rule, 0.0, 1.0,
                     [&](double t) { return kernel(Vec3d(0.0), kZ, corner + u * s + v * t, facing); });
  });
}

/// Form factor of a disc parallel to the xy plane.
double disc(double radius, double height, double lateral) {
  return integrate(gauss(60), 0.0, radius, [&](double r) {
    return r * integrate_turn(256, [&](double p) {
             const Vec3d to(lateral + r * std::cos(p), r * std::sin(p), height);
             return kernel(Vec3d(0.0), kZ, to, -kZ);
           });
  });
}

TEST(TruthIrradiance, PublishedNumbersToAllDigits) {
  expect_digits(uniform_sky_irradiance(1.0), "3.14159265359");
  expect_digits(tilted_receiver_irradiance(60.0 * kDegree, 0.0, 1.0), "2.35619449019");
  expect_digits(tilted_receiver_irradiance(60.0 * kDegree, 0.3, 1.0), "2.59181393921");
  expect_digits(cap_solid_angle(0.2665 * kDegree), "6.79670235728e-5");
  expect_digits(cap_irradiance(30.0 * kDegree, 45.0 * kDegree, 1.0), "0.555360367270");
  expect_digits(cap_irradiance(30.0 * kDegree, 0.0, 1.0), "0.785398163397");
  expect_digits(sun_radiance(0.2665 * kDegree, 1.0), "14713.0969712");
  expect_digits(point_light_irradiance(1.0, 2.0, 1.0), "0.178885438200");
  expect_digits(disc_form_factor(1.0, 2.0, 1.0), "0.146446609407");
  expect_digits(disc_form_factor(1.0, 2.0, 0.0), "0.2");
  expect_digits(corner_rectangle_form_factor(1.0, 1.0, 1.0), "0.138531605995");
  expect_digits(centred_rectangle_form_factor(2.0, 2.0, 1.0), "0.554126423980");
  expect_digits(perpendicular_rectangle_form_factor(1.0, 1.0, 1.0), "0.0557341970026");
  expect_digits(wall_sky_view(1.0, 1.0), "0.853553390593");
  expect_digits(sphere_sky_view(1.0, 1.0, 1.0), "0.646446609407");
  expect_digits(sphere_sky_view(1.0, 2.0, 0.0), "0.75");
  expect_digits(sphere_sky_view(1.0, 2.0, 1.0), "0.821114561800");
  expect_digits(sphere_flux_on_plane(1.0, 1.0), "19.7392088022");
  expect_digits(coaxial_discs_form_factor(1.0, 1.0, 1.0), "0.381966011250");
  expect_digits(opposite_rectangles_form_factor(1.0, 1.0, 1.0), "0.199824895698");
  expect_digits(adjacent_rectangles_form_factor(1.0, 1.0, 1.0), "0.200043776075");
  expect_digits(sphere_to_disc_form_factor(1.0, 1.0), "0.146446609407");
  expect_digits(overcast_irradiance(0.0, 1.0), "2.44346095279");
  expect_digits(overcast_irradiance(kPi / 2.0, 1.0), "0.968043220043");
  expect_digits(overcast_irradiance(kPi / 2.0, 1.0) / overcast_irradiance(0.0, 1.0), "0.396177");
  expect_digits(linear_environment_irradiance(1.0, 1.0, 0.5), "4.18879020479");
  expect_digits(axis_power_irradiance(2, 0.5), "0.981747704247");
  expect_digits(axis_power_irradiance(4, 1.0), "1.04719755120");
  const std::array<Vec3d, 3> triangle = {Vec3d(1, 0, 1), Vec3d(0, 1, 1), Vec3d(-1, -1, 2)};
  expect_digits(polygon_irradiance(triangle, kZ, 1.0), "0.687617388735");
  expect_digits(triangle_solid_angle(triangle[0], triangle[1], triangle[2]), "0.748996398184");
}

TEST(TruthIrradiance, SkiesMatchQuadratureAtAnyTilt) {
  const auto one = [](const Vec3d&) { return 1.0; };
  const auto overcast = [](const Vec3d& w) { return (1.0 + 2.0 * w.z) / 3.0; };
  EXPECT_LE(std::abs(hemisphere(kZ, one) - uniform_sky_irradiance(1.0)), kTight);
  for (const double tilt : {0.0, 0.3, 1.0, kPi / 2.0, 2.0, 3.0, kPi}) {
    const double sky = lune(tilt, 0.0, kPi - tilt, one);
    const double ground = 0.3 * lune(tilt, -tilt, 0.0, one);
    EXPECT_LE(std::abs(tilted_receiver_irradiance(tilt, 0.0, 2.0) - 2.0 * sky), kTight) << tilt;
    EXPECT_LE(std::abs(tilted_receiver_irradiance(tilt, 0.3, 1.0) - sky - ground), kTight) << tilt;
    const double cie = lune(tilt, 0.0, kPi - tilt, overcast);
    EXPECT_LE(std::abs(overcast_irradiance(tilt, 3.0) - 3.0 * cie), kTight) << tilt;
  }
}

TEST(TruthIrradiance, CapMatchesQuadrature) {
  const Rule rule = gauss(30);
  for (const auto& [a, angle] : {std::pair(0.2, 0.0), {0.5, 0.4}, {0.6, 0.9}, {0.7, kPi / 2.0 - 0.7}}) {
    const Vec3d axis(std::sin(angle), 0.0, std::cos(angle));
    const Vec3d side(std::cos(angle), 0.0, -std::sin(angle));
    double solid_angle = 0.0;
    const double irradiance = integrate(rule, 0.0, a, [&](double g) {
      return std::sin(g) * integrate_turn(32, [&](double p) {
               return glm::dot(axis * std::cos(g) + side * (std::sin(g) * std::cos(p)), kZ);
             });
    });
    solid_angle = 2.0 * kPi * integrate(rule, 0.0, a, [](double g) { return std::sin(g); });
    EXPECT_LE(std::abs(cap_irradiance(a, angle, 1.0) - irradiance), kTight) << a << ' ' << angle;
    EXPECT_LE(std::abs(cap_solid_angle(a) - solid_angle), kTight) << a;
    EXPECT_LE(std::abs(cap_irradiance(a, 0.0, sun_radiance(a, 2.0)) - 2.0), kTight) << a;
  }
}

TEST(TruthIrradiance, BandLimitedEnvironmentsMatchQuadrature) {
  for (const double angle : {0.0, 0.4, 60.0 * kDegree, 2.0, 3.0}) {
    const Vec3d n(std::sin(angle), 0.0, std::cos(angle));
    for (int k = 0; k <= 4; ++k) {
      const double expected = hemisphere(n, [k](const Vec3d& w) { return std::pow(w.z, k); });
      EXPECT_LE(std::abs(axis_power_irradiance(k, n.z) - expected), kTight) << k << ' ' << angle;
    }
    const double expected = hemisphere(n, [](const Vec3d& w) { return 0.7 - 1.3 * w.z; });
    EXPECT_LE(std::abs(linear_environment_irradiance(0.7, -1.3, n.z) - expected), kTight) << angle;
  }
  for (const int k : {0, 2, 4}) {
    EXPECT_LE(std::abs(axis_power_irradiance(k, 1.0) - 2.0 * kPi / (k + 2)), kTight) << k;
  }
}

TEST(TruthIrradiance, PointLightSendsHalfItsFluxThroughThePlane) {
  const double height = 1.7;  // x = h tan t: x dx = h^2 tan t / cos^2 t dt
  const double flux = integrate(gauss(40), 0.0, kPi / 2.0, [&](double t) {
    const double x = height * std::tan(t);
    const double jacobian = height * height * std::tan(t) / (std::cos(t) * std::cos(t));
    return 2.0 * kPi * point_light_irradiance(3.0, height, x) * jacobian;
  });
  EXPECT_LE(std::abs(flux - 2.0 * kPi * 3.0), kTight * flux);
}

TEST(TruthIrradiance, DiscMatchesQuadrature) {
  for (const auto& [r, h, x] :
       {std::array{1.0, 2.0, 1.0}, {1.0, 1.0, 0.0}, {2.0, 1.0, 1.5}, {0.5, 1.0, 3.0}}) {
    EXPECT_LE(std::abs(disc_form_factor(r, h, x) - disc(r, h, x)), kTight) << r << ' ' << h << ' ' << x;
  }
}

TEST(TruthIrradiance, RectanglesMatchQuadrature) {
  for (const auto& [a, b, c] : {std::array{1.0, 1.0, 1.0}, {2.0, 0.5, 1.0}, {1.0, 3.0, 1.5}}) {
    const double parallel = parallelogram({0.0, 0.0, c}, {a, 0.0, 0.0}, {0.0, b, 0.0});
    EXPECT_LE(std::abs(corner_rectangle_form_factor(a, b, c) - parallel), kTight) << a;
    const double centred = parallelogram({-a / 2.0, -b / 2.0, c}, {a, 0.0, 0.0}, {0.0, b, 0.0});
    EXPECT_LE(std::abs(centred_rectangle_form_factor(a, b, c) - centred), kTight) << a;
    const double upright = parallelogram({c, 0.0, 0.0}, {0.0, 0.0, a}, {0.0, b, 0.0});
    EXPECT_LE(std::abs(perpendicular_rectangle_form_factor(a, b, c) - upright), kTight) << a;
  }
}

/// Cosine-weighted (`cosine`) or plain solid angle of a triangle, by the map (s, t) -> a + s (b - a + t (c -
/// b)).
double triangle_quadrature(const std::array<Vec3d, 3>& v, bool cosine) {
  const Rule rule = gauss(60);
  const Vec3d area = glm::cross(v[1] - v[0], v[2] - v[0]);
  return integrate(rule, 0.0, 1.0, [&](double s) {
    return s * integrate(rule, 0.0, 1.0, [&](double t) {
             const Vec3d p = v[0] + s * (v[1] - v[0] + t * (v[2] - v[1]));
             const double d = glm::length(p);
             return std::abs(glm::dot(area, p)) / (d * d * d) * (cosine ? p.z / d : 1.0);
           });
  });
}

TEST(TruthIrradiance, PolygonsMatchQuadrature) {
  const std::array<std::array<Vec3d, 3>, 2> triangles = {
      {{Vec3d(1, 0, 1), Vec3d(0, 1, 1), Vec3d(-1, -1, 2)},
       {Vec3d(2, 1, 0), Vec3d(1, 3, 1), Vec3d(-1, 2, 0.5)}}};
  for (const auto& t : triangles) {
    const double expected = triangle_quadrature(t, true);
    EXPECT_LE(std::abs(polygon_irradiance(t, kZ, 1.0) - expected), kTight);
    EXPECT_LE(std::abs(polygon_irradiance(std::array{t[2], t[1], t[0]}, kZ, 1.0) - expected), kTight);
    EXPECT_LE(std::abs(triangle_solid_angle(t[0], t[1], t[2]) - triangle_quadrature(t, false)), kTight);
  }
  const std::array<Vec3d, 4> rectangle = {Vec3d(0, 0, 1.5), Vec3d(2, 0, 1.5), Vec3d(2, 1, 1.5),
                                          Vec3d(0, 1, 1.5)};
  EXPECT_LE(std::abs(polygon_irradiance(rectangle, kZ, 1.0) - kPi * corner_rectangle_form_factor(2, 1, 1.5)),
            kTight);
}

TEST(TruthIrradiance, ClippingKeepsWhatIsAboveTheHorizon) {
  const std::array<Vec3d, 4> upright = {Vec3d(1, -2, -1), Vec3d(1, 2, -1), Vec3d(1, 2, 3), Vec3d(1, -2, 3)};
  EXPECT_THROW((void)polygon_irradiance(upright, kZ, 1.0), InputError);
  const double expected = 2.0 * kPi * perpendicular_rectangle_form_factor(3.0, 2.0, 1.0);
  EXPECT_LE(std::abs(polygon_irradiance(clip_to_horizon(upright, kZ), kZ, 1.0) - expected), kTight);
  const std::array<Vec3d, 3> below = {Vec3d(1, 0, -1), Vec3d(0, 1, -1), Vec3d(1, 1, -2)};
  EXPECT_TRUE(clip_to_horizon(below, kZ).empty());
}

// In azimuth p from the wall's foot the horizon is at elevation g with tan g = (h/d) cos p; above it,
// int cos sin = cos^2(g)/2. The dihedral's far face is such a wall of infinite height, tilted.
TEST(TruthIrradiance, WallAndDihedralMatchQuadrature) {
  const Rule rule = gauss(80);
  for (const double h : {0.0, 0.5, 1.0, 3.0}) {
    const double open = kPi / 2.0;  // the half turn away from the wall
    const double seen = integrate(rule, -kPi / 2.0, kPi / 2.0, [&](double p) {
      const double tangent = h * std::cos(p);
      return 0.5 / (1.0 + tangent * tangent);
    });
    EXPECT_LE(std::abs(wall_sky_view(h, 1.0) - (open + seen) / kPi), 1e-10) << h;
  }
  for (const double opening : {0.4, 60.0 * kDegree, 1.5, 2.0, 3.0}) {
    // The face rises at `opening` from the x axis: tan g = cos p tan(opening), on its own side only.
    const double slope = std::tan(opening);
    const double whole = opening > kPi / 2.0 ? kPi / 2.0 : 0.0;
    const double part = integrate(rule, -kPi / 2.0, kPi / 2.0, [&](double p) {
      const double tangent = std::abs(slope) * std::cos(p);
      const double above = 0.5 / (1.0 + tangent * tangent);
      return opening > kPi / 2.0 ? above : 0.5 - above;
    });
    EXPECT_LE(std::abs(dihedral_sky_view(opening) - (whole + part) / kPi), 1e-9) << opening;
  }
}

TEST(TruthIrradiance, SphereMatchesItsVisibleCapAndItsFlux) {
  for (const auto& [radius, h, x] : {std::array{1.0, 1.0, 1.0}, {1.0, 2.0, 0.0}, {0.7, 1.2, 2.5}}) {
    // Area integral over the cap that the receiver sees: points R u, u.c > R/d with c towards the receiver.
    const double d = std::hypot(h, x);
    const Vec3d centre(x, 0.0, h);
    const Vec3d c = -centre / d;
    const Vec3d side(c.z, 0.0, -c.x);
    const double seen = integrate(gauss(60), radius / d, 1.0, [&, radius = radius](double mu) {
      const double s = std::sqrt(1.0 - mu * mu);
      return integrate_turn(64, [&, radius = radius](double p) {
        const Vec3d u = c * mu + (side * std::cos(p) + Vec3d(0.0, std::sin(p), 0.0)) * s;
        return radius * radius * kernel(Vec3d(0.0), kZ, centre + radius * u, u);
      });
    });
    EXPECT_LE(std::abs(sphere_irradiance(radius, h, x, 1.0) - kPi * seen), kTight) << x;
    EXPECT_LE(std::abs(sphere_sky_view(radius, h, x) - (1.0 - seen)), kTight) << x;
  }
  const double flux = integrate(gauss(40), 0.0, kPi / 2.0, [](double t) {  // x = h tan t, h = 1.5
    const double jacobian = 2.25 * std::tan(t) / (std::cos(t) * std::cos(t));
    return 2.0 * kPi * sphere_irradiance(1.2, 1.5, 1.5 * std::tan(t), 2.0) * jacobian;
  });
  EXPECT_LE(std::abs(sphere_flux_on_plane(1.2, 2.0) - flux), kTight * flux);
}

TEST(TruthIrradiance, CoaxialDiscsMatchQuadrature) {
  const Rule rule = gauss(40);
  for (const auto& [r1, r2, h] : {std::array{1.0, 1.0, 1.0}, {0.5, 2.0, 1.0}, {2.0, 0.5, 1.5}}) {
    const double sum = integrate(rule, 0.0, r1, [&, r2 = r2, h = h](double a) {
      return 2.0 * kPi * a * integrate(rule, 0.0, r2, [&](double b) {
               return b * integrate_turn(128, [&](double p) {
                        const Vec3d to(b * std::cos(p) - a, b * std::sin(p), h);
                        return kernel(Vec3d(0.0), kZ, to, -kZ);
                      });
             });
    });
    EXPECT_LE(std::abs(coaxial_discs_form_factor(r1, r2, h) - sum / (kPi * r1 * r1)), kTight) << r1;
    const double there = r1 * r1 * coaxial_discs_form_factor(r1, r2, h);
    EXPECT_LE(std::abs(there - r2 * r2 * coaxial_discs_form_factor(r2, r1, h)), kTight) << "reciprocity";
  }
}

// The four-fold integral over two opposite rectangles depends on differences only: each difference u occurs
// with weight a - |u|.
TEST(TruthIrradiance, OppositeRectanglesMatchQuadrature) {
  const Rule rule = gauss(60);
  for (const auto& [a, b, c] : {std::array{1.0, 1.0, 1.0}, {2.0, 0.5, 1.0}, {1.0, 3.0, 2.0}}) {
    const double sum = 4.0 * integrate(rule, 0.0, a, [&, a = a, b = b, c = c](double u) {
                         return (a - u) * integrate(rule, 0.0, b, [&](double v) {
                                  const double d2 = u * u + v * v + c * c;
                                  return (b - v) * c * c / (kPi * d2 * d2);
                                });
                       });
    EXPECT_LE(std::abs(opposite_rectangles_form_factor(a, b, c) - sum / (a * b)), kTight) << a;
  }
}

// Along the common edge only the difference u matters (weight l - |u|, twice). The integrand x y/(x^2 + y^2 +
// u^2)^2 is singular at the origin; each of the three pyramids of the box over the faces x, y, u = max is
// mapped to a cube with a Jacobian s^2 that cancels it.
TEST(TruthIrradiance, AdjacentRectanglesMatchQuadrature) {
  const Rule rule = gauss(40);
  for (const auto& [l, w, h] : {std::array{1.0, 1.0, 1.0}, {1.0, 2.0, 0.7}, {2.0, 0.6, 1.0}}) {
    double sum = 0.0;
    for (int pyramid = 0; pyramid < 3; ++pyramid) {
      sum += integrate(rule, 0.0, 1.0, [&, l = l, w = w, h = h](double s) {
        return integrate(rule, 0.0, 1.0, [&](double a) {
          return integrate(rule, 0.0, 1.0, [&](double b) {
            const Vec3d unit = pyramid == 0 ? Vec3d(1, a, b) : pyramid == 1 ? Vec3d(a, 1, b) : Vec3d(a, b, 1);
            const Vec3d p = unit * Vec3d(w, h, l);  // direction; the point is s p
            const double p2 = glm::dot(p, p);
            return (l - s * p.z) * p.x * p.y / (kPi * p2 * p2) * w * h * l;
          });
        });
      });
    }
    EXPECT_LE(std::abs(adjacent_rectangles_form_factor(l, w, h) - 2.0 * sum / (l * w)), 1e-9) << l;
    EXPECT_LE(
        std::abs(w * adjacent_rectangles_form_factor(l, w, h) - h * adjacent_rectangles_form_factor(l, h, w)),
        kTight)
        << "reciprocity";
  }
  const double closure =
      4.0 * adjacent_rectangles_form_factor(1, 1, 1) + opposite_rectangles_form_factor(1, 1, 1);
  EXPECT_LE(std::abs(closure - 1.0), kTight);
}

TEST(TruthIrradiance, SphereToDiscMatchesQuadratureOverTheDisc) {
  const double radius = 0.4;  // of the sphere: any, as long as it clears the disc
  for (const auto& [r, h] : {std::pair(1.0, 1.0), {3.0, 0.5}}) {
    const double flux = integrate(gauss(80), 0.0, r, [&, h = h](double x) {
      return 2.0 * kPi * x * sphere_irradiance(radius, h, x, 1.0);
    });
    const double emitted = kPi * 4.0 * kPi * radius * radius;
    EXPECT_LE(std::abs(sphere_to_disc_form_factor(r, h) - flux / emitted), kTight) << r;
  }
}

TEST(TruthIrradiance, KernelInsideASphereIsConstant) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const auto direction = [&] {
    return glm::normalize(Vec3d(normal(random), normal(random), normal(random)));
  };
  for (int i = 0; i < 100; ++i) {
    const Vec3d a = direction();
    const Vec3d b = direction();
    const double exact = inside_sphere_form_factor(1.0, 2.5);
    const double d2 = glm::dot(a - b, a - b);
    EXPECT_LE(std::abs(kernel(2.5 * a, -a, 2.5 * b, -b) - exact), 1e-14 / d2) << "pair " << i;
  }
}

TEST(TruthIrradiance, RefusesArgumentsOutsideItsRange) {
  EXPECT_THROW((void)cap_irradiance(0.6, 1.2, 1.0), InputError);
  EXPECT_THROW((void)sphere_sky_view(1.0, 0.9, 0.0), InputError);
  EXPECT_THROW((void)tilted_receiver_irradiance(-0.1, 0.0, 1.0), InputError);
  EXPECT_THROW((void)axis_power_irradiance(5, 1.0), InputError);
  EXPECT_THROW((void)wall_sky_view(1.0, 0.0), InputError);
  EXPECT_THROW((void)point_light_irradiance(1.0, std::nan(""), 0.0), InputError);
}

}  // namespace
}  // namespace plumbline::truth
