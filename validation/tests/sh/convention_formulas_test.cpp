// What others publish, written out, on a light whose radiance and irradiance are closed forms: the convention's
// numbers put into its owner's own formula must give back the light. Nothing here reads the table of factors.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "prt/sh/convention.hpp"
#include "prt/sh/quadrature.hpp"
#include "validation/tests/sh/oracle.hpp"

namespace plumbline::sh {
namespace {

// L(w) = scale (1 + b w + g (w q)^2), per channel another scale.
const Vec3d kLinear(0.3, -0.5, 0.2);
const Vec3d kAxis = Vec3d(1.0, 4.0, 8.0) / 9.0;
constexpr double kQuadratic = 0.7;
const RgbD kScale(1.0, 0.5, 2.0);

double radiance_at(const Vec3d& w) {
  return 1.0 + glm::dot(kLinear, w) + kQuadratic * glm::dot(w, kAxis) * glm::dot(w, kAxis);
}
/// a + b w.z gives pi a + (2 pi/3) b n.z, (w.z)^2 gives (pi/4)(1 + n.z^2).
double irradiance_at(const Vec3d& n) {
  return kPi + 2.0 * kPi / 3.0 * glm::dot(kLinear, n) +
         kQuadratic * kPi / 4.0 * (1.0 + glm::dot(n, kAxis) * glm::dot(n, kAxis));
}

/// The light's coefficients in our convention.
ShRgb light() {
  ShRgb result{3, std::vector<RgbD>(9, RgbD(0.0))};
  for (const SphereNode& node : sphere_quadrature(3)) {
    const std::vector<double> y = evaluate_basis(3, node.direction);
    for (std::size_t i = 0; i < 9; ++i) {
      result.coefficients[i] += node.weight * radiance_at(node.direction) * y[i] * kScale;
    }
  }
  return result;
}

std::vector<double> values_of(const char* name) {
  return from_ours(light(), known_convention(name).convention);
}

using Channel = std::array<double, 9>;
using Formula = std::function<double(const Channel& c, const Vec3d& d)>;

Channel row_channel(const std::vector<double>& v, std::size_t channel, std::size_t stride = 3) {
  Channel c{};
  for (std::size_t i = 0; i < 9; ++i) c[i] = v[stride * i + channel];
  return c;
}
Channel planar_channel(const std::vector<double>& v, std::size_t channel) {
  Channel c{};
  for (std::size_t i = 0; i < 9; ++i) c[i] = v[9 * channel + i];
  return c;
}

enum class Answer { radiance, irradiance, irradiance_over_pi };

/// Largest deviation from the light over directions and channels.
double fault(const std::array<Channel, 3>& channels, Answer answer, const Formula& formula) {
  double worst = 0.0;
  for (const Vec3d& d : sh_test::directions(20, 4)) {
    const double radiance = answer == Answer::radiance ? radiance_at(d) : irradiance_at(d);
    const double expected = answer == Answer::irradiance_over_pi ? radiance / kPi : radiance;
    for (std::size_t c = 0; c < 3; ++c) {
      const double scale = kScale[static_cast<glm::length_t>(c)];
      const double difference = std::abs(formula(channels[c], d) - scale * expected);
      if (!(difference <= worst)) worst = difference;
    }
  }
  return worst;
}

double fault_of_rows(const char* name, Answer answer, const Formula& formula, std::size_t stride = 3) {
  const std::vector<double> v = values_of(name);
  return fault({row_channel(v, 0, stride), row_channel(v, 1, stride), row_channel(v, 2, stride)}, answer,
               formula);
}
double fault_of_planes(const char* name, Answer answer, const Formula& formula) {
  const std::vector<double> v = values_of(name);
  return fault({planar_channel(v, 0), planar_channel(v, 1), planar_channel(v, 2)}, answer, formula);
}

constexpr double kExact = 1e-13;
/// Formulas with constants of six digits: nine terms, each off by 5e-7 times a coefficient below 10, doubled
/// for 2 c.
constexpr double kSixDigits = 9 * 2 * 5e-7 * 10;

/// Unity's SphericalHarmonicsL2.Evaluate, Filament's irradiance(): bare polynomials.
double polynomial(const Channel& c, const Vec3d& n) {
  return c[0] + c[1] * n.y + c[2] * n.z + c[3] * n.x + c[4] * n.x * n.y + c[5] * n.y * n.z +
         c[6] * (3.0 * n.z * n.z - 1.0) + c[7] * n.z * n.x + c[8] * (n.x * n.x - n.y * n.y);
}

/// The functions with six digits as engines print them, all signs positive.
double with_constants(const Channel& c, const Vec3d& d) {
  return 0.282095 * c[0] + 0.488603 * (c[1] * d.y + c[2] * d.z + c[3] * d.x) +
         1.092548 * (c[4] * d.x * d.y + c[5] * d.y * d.z + c[7] * d.x * d.z) +
         0.315392 * c[6] * (3.0 * d.z * d.z - 1.0) + 0.546274 * c[8] * (d.x * d.x - d.y * d.y);
}
/// With the Condon-Shortley sign.
double with_signed_constants(const Channel& c, const Vec3d& d) {
  return 0.282095 * c[0] + 0.488603 * (-c[1] * d.y + c[2] * d.z - c[3] * d.x) +
         1.092548 * (c[4] * d.x * d.y - c[5] * d.y * d.z - c[7] * d.x * d.z) +
         0.315392 * c[6] * (3.0 * d.z * d.z - 1.0) + 0.546274 * c[8] * (d.x * d.x - d.y * d.y);
}
/// Ramamoorthi & Hanrahan 2001, equation 13, with their five constants.
double five_constants(const Channel& c, const Vec3d& n) {
  return 0.429043 * c[8] * (n.x * n.x - n.y * n.y) + 0.743125 * c[6] * n.z * n.z + 0.886227 * c[0] -
         0.247708 * c[6] + 2.0 * 0.429043 * (c[4] * n.x * n.y + c[7] * n.x * n.z + c[5] * n.y * n.z) +
         2.0 * 0.511664 * (c[3] * n.x + c[1] * n.y + c[2] * n.z);
}
/// What Godot's shader does with its probe buffer: A_l and the constants, 0.886227 = pi 0.282095, …
double godot_probe(const Channel& c, const Vec3d& n) {
  return 0.886227 * c[0] + 2.0 * 0.511664 * (c[1] * n.y + c[2] * n.z + c[3] * n.x) +
         2.0 * 0.429043 * (c[4] * n.x * n.y + c[5] * n.y * n.z + c[7] * n.x * n.z) +
         0.429043 * c[8] * (n.x * n.x - n.y * n.y) + c[6] * (0.743125 * n.z * n.z - 0.247708);
}
Formula in_mirrored_x(const Formula& formula) {
  return [formula](const Channel& c, const Vec3d& d) { return formula(c, {-d.x, d.y, d.z}); };
}

TEST(ShConventionFormula, PolynomialsOfUnityAndFilamentGiveIrradianceOverPi) {
  EXPECT_LE(fault_of_planes("unity", Answer::irradiance_over_pi, polynomial), kExact);
  EXPECT_LE(fault_of_rows("filament-shader-no-mirror", Answer::irradiance_over_pi, polynomial), kExact);
  EXPECT_LE(fault_of_rows("filament-shader", Answer::irradiance_over_pi, in_mirrored_x(polynomial)), kExact);
  EXPECT_GE(fault_of_rows("filament-shader", Answer::irradiance_over_pi, polynomial), 0.01);
  EXPECT_GE(fault_of_rows("unity", Answer::irradiance_over_pi, polynomial), 0.01);
  EXPECT_GE(fault_of_planes("unity", Answer::irradiance, polynomial), 0.01);
}

TEST(ShConventionFormula, FiveConstantsGiveIrradianceFromRadiance) {
  EXPECT_LE(fault_of_rows("ramamoorthi", Answer::irradiance, five_constants), kSixDigits);
  EXPECT_LE(fault_of_rows("threejs", Answer::irradiance, five_constants), kSixDigits);
  EXPECT_GE(fault_of_rows("google", Answer::irradiance, five_constants), 0.01);
  EXPECT_GE(fault_of_rows("flutter", Answer::irradiance, five_constants), 0.01);
}

TEST(ShConventionFormula, PositiveFunctionsGiveWhatIsStored) {
  for (const char* name : {"threejs", "probulator", "bakinglab-old", "ext-ibl-flutter", "webxr-radiance"}) {
    EXPECT_LE(fault_of_rows(name, Answer::radiance, with_constants), kSixDigits) << name;
    EXPECT_GE(fault_of_rows(name, Answer::radiance, with_signed_constants), 0.01) << name;
  }
  EXPECT_LE(fault_of_rows("flutter", Answer::irradiance_over_pi, with_constants), kSixDigits);
  EXPECT_LE(fault_of_rows("webxr-irradiance", Answer::irradiance, with_constants), kSixDigits * kPi);
  EXPECT_LE(fault_of_planes("arkit-radiance", Answer::radiance, with_constants), kSixDigits);
  EXPECT_LE(fault_of_rows("godot-probe", Answer::irradiance_over_pi, godot_probe, 4), kSixDigits);
}

TEST(ShConventionFormula, CondonShortleyFunctionsGiveWhatIsStored) {
  for (const char* name :
       {"plumbline", "google", "cmft", "sloan", "webxr-radiance-cs", "openxr-android-radiance-cs"}) {
    EXPECT_LE(fault_of_rows(name, Answer::radiance, with_signed_constants), kSixDigits) << name;
    EXPECT_GE(fault_of_rows(name, Answer::radiance, with_constants), 0.01) << name;
  }
  EXPECT_LE(fault_of_planes("directxmath", Answer::radiance, with_signed_constants), kSixDigits);
  for (const char* name : {"filament-irradiance-no-mirror", "ext-ibl-babylon"}) {
    EXPECT_LE(fault_of_rows(name, Answer::irradiance, with_signed_constants), kSixDigits * kPi) << name;
  }
  EXPECT_LE(fault_of_rows("filament-irradiance", Answer::irradiance, in_mirrored_x(with_signed_constants)),
            kSixDigits * kPi);
}

/// Seven vectors of four, as a shader reads them.
double packed_fault(const char* name, const std::function<double(double z)>& third) {
  const std::vector<double> v = values_of(name);
  EXPECT_EQ(v.size(), 28U);
  std::array<Channel, 3> numbers{};  // of each channel: A, B, C
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < 4; ++i) {
      numbers[c][i] = v[4 * c + i];
      numbers[c][4 + i] = v[12 + 4 * c + i];
    }
    numbers[c][8] = v[24 + c];
  }
  return fault(numbers, Answer::irradiance_over_pi, [&third](const Channel& s, const Vec3d& n) {
    return s[0] * n.x + s[1] * n.y + s[2] * n.z + s[3] + s[4] * n.x * n.y + s[5] * n.y * n.z +
           s[6] * third(n.z) + s[7] * n.z * n.x + s[8] * (n.x * n.x - n.y * n.y);
  });
}

TEST(ShConventionFormula, PackedVectorsGiveIrradianceOverPi) {
  const auto square = [](double z) { return z * z; };
  const auto legendre = [](double z) { return 3.0 * z * z - 1.0; };
  EXPECT_LE(packed_fault("unity-shader", square), kExact);
  EXPECT_LE(packed_fault("unity-shader-old", legendre), kExact);
  EXPECT_GE(packed_fault("unity-shader-old", square), 0.01);
}

TEST(ShConventionFormula, SplatsAddHalf) {
  const std::vector<double> v = values_of("3dgs");
  std::array<Channel, 3> channels{};
  for (std::size_t c = 0; c < 3; ++c) {
    channels[c][0] = v[c];
    for (std::size_t i = 1; i < 9; ++i) channels[c][i] = v[3 + 8 * c + i - 1];
  }
  const auto colour = [](const Channel& c, const Vec3d& d) { return 0.5 + with_signed_constants(c, d); };
  EXPECT_LE(fault(channels, Answer::radiance, colour), kSixDigits);
  EXPECT_GE(fault(channels, Answer::radiance, with_signed_constants), 0.01);
}

// ---------------------------------------------------------------- other normalisations

/// Sum of c[0][l][m] N P_lm cos(m phi) + c[1][l][m] N P_lm sin(m phi), P_lm without the Condon-Shortley sign (as
/// std::assoc_legendre).
double geodesic_fault(const char* name, const std::function<double(int l, int m)>& normalization) {
  const std::vector<double> v = values_of(name);
  EXPECT_EQ(v.size(), 54U);
  double worst = 0.0;
  for (const Vec3d& d : sh_test::directions(20, 4)) {
    double sum = 0.0;
    for (unsigned l = 0; l < 3; ++l) {
      for (unsigned m = 0; m <= l; ++m) {
        const double phi = std::atan2(d.y, d.x);
        const double p =
            normalization(static_cast<int>(l), static_cast<int>(m)) * std::assoc_legendre(l, m, d.z);
        sum += p * (v[3 * l + m] * std::cos(m * phi) + v[9 + 3 * l + m] * std::sin(m * phi));
      }
    }
    const double difference = std::abs(sum - radiance_at(d));
    if (!(difference <= worst)) worst = difference;
  }
  return worst;
}

double factorial(int n) {
  return std::tgamma(n + 1.0);
}
double schmidt(int l, int m) {
  return std::sqrt((m == 0 ? 1.0 : 2.0) * factorial(l - m) / factorial(l + m));
}

TEST(ShConventionFormula, GeodesyGivesTheRadianceBack) {
  const auto four_pi = [](int l, int m) { return std::sqrt(2.0 * l + 1.0) * schmidt(l, m); };
  const auto ortho = [&](int l, int m) { return four_pi(l, m) / std::sqrt(4.0 * kPi); };
  EXPECT_LE(geodesic_fault("shtools", four_pi), kExact);
  EXPECT_LE(geodesic_fault("shtools-ortho", ortho), kExact);
  EXPECT_LE(geodesic_fault("shtools-schmidt", schmidt), kExact);
  EXPECT_LE(geodesic_fault("shtools-unnorm", [](int, int) { return 1.0; }), kExact);
  EXPECT_GE(geodesic_fault("shtools-ortho", four_pi), 0.01);
}

/// Integral of the first channel's radiance times a function.
double integral(const std::function<double(const Vec3d&)>& function) {
  double sum = 0.0;
  for (const SphereNode& node : sphere_quadrature(4)) {
    sum += node.weight * radiance_at(node.direction) * function(node.direction);
  }
  return sum;
}

TEST(ShConventionFormula, AmbisonicsWeighsWithItsOwnFunctions) {
  const std::vector<double> n3d = values_of("n3d");
  const std::vector<double> sn3d = values_of("sn3d");
  // ACN 0 W, 1 Y, 2 Z, 3 X, 4 V, 6 R; SN3D of first degree is the direction itself.
  EXPECT_NEAR(sn3d[0], integral([](const Vec3d&) { return 1.0; }), 1e-12);
  EXPECT_NEAR(sn3d[3], integral([](const Vec3d& d) { return d.y; }), 1e-12);
  EXPECT_NEAR(sn3d[6], integral([](const Vec3d& d) { return d.z; }), 1e-12);
  EXPECT_NEAR(sn3d[9], integral([](const Vec3d& d) { return d.x; }), 1e-12);
  EXPECT_NEAR(sn3d[12], integral([](const Vec3d& d) { return std::sqrt(3.0) * d.x * d.y; }), 1e-12);
  EXPECT_NEAR(sn3d[18], integral([](const Vec3d& d) { return 1.5 * d.z * d.z - 0.5; }), 1e-12);
  for (std::size_t i = 0; i < 9; ++i) {
    const double l = i == 0 ? 0.0 : (i < 4 ? 1.0 : 2.0);
    EXPECT_NEAR(n3d[3 * i], std::sqrt(2.0 * l + 1.0) * sn3d[3 * i], 1e-12) << i;
  }
}

TEST(ShConventionFormula, E3nnHasYAsPolarAxis) {
  const std::vector<double> norm = values_of("e3nn-norm");
  const std::vector<double> component = values_of("e3nn-component");
  const std::vector<double> whole = values_of("e3nn-integral");
  const double root3 = std::sqrt(3.0);
  const std::array<std::function<double(const Vec3d&)>, 9> functions{
      [](const Vec3d&) { return 1.0; },
      [](const Vec3d& d) { return d.x; },
      [](const Vec3d& d) { return d.y; },
      [](const Vec3d& d) { return d.z; },
      [&](const Vec3d& d) { return root3 * d.x * d.z; },
      [&](const Vec3d& d) { return root3 * d.x * d.y; },
      [](const Vec3d& d) { return d.y * d.y - 0.5 * (d.x * d.x + d.z * d.z); },
      [&](const Vec3d& d) { return root3 * d.y * d.z; },
      [&](const Vec3d& d) { return 0.5 * root3 * (d.z * d.z - d.x * d.x); }};
  for (std::size_t i = 0; i < 9; ++i) {
    const double l = i == 0 ? 0.0 : (i < 4 ? 1.0 : 2.0);
    const double expected = integral(functions[i]);
    EXPECT_NEAR(norm[3 * i], expected, 1e-12) << i;
    EXPECT_NEAR(component[3 * i], std::sqrt(2.0 * l + 1.0) * expected, 1e-12) << i;
    EXPECT_NEAR(whole[3 * i], std::sqrt((2.0 * l + 1.0) / (4.0 * kPi)) * expected, 1e-12) << i;
  }
}

// ---------------------------------------------------------------- hemispheres

TEST(ShConventionFormula, HBasisIsWhatItsPublishedMatrixMakesOfNineCoefficients) {
  const double r2 = std::sqrt(2.0);
  const double r32 = std::sqrt(1.5);
  const double r52 = std::sqrt(2.5);
  const double r152 = std::sqrt(7.5);
  const std::vector<double> c = values_of("google");
  const std::vector<double> h = values_of("bakinglab-h4");
  ASSERT_EQ(h.size(), 12U);
  EXPECT_NEAR(h[0], c[0] / r2 + 0.5 * r32 * c[6], 1e-13);
  EXPECT_NEAR(h[3], c[3] / r2 + 3.0 / 8.0 * r52 * c[15], 1e-13);
  EXPECT_NEAR(h[6], c[6] / (2.0 * r2) + 0.25 * r152 * c[18], 1e-13);
  EXPECT_NEAR(h[9], c[9] / r2 + 3.0 / 8.0 * r52 * c[21], 1e-13);
  const std::vector<double> six = values_of("habel-h6");
  ASSERT_EQ(six.size(), 18U);
  EXPECT_NEAR(six[3], -h[3], 1e-13);
  EXPECT_NEAR(six[12], c[12] / r2, 1e-13);  // xy, x^2 - y^2: half of the sphere's integral
  EXPECT_NEAR(six[15], c[24] / r2, 1e-13);
  EXPECT_NEAR(values_of("probulator-h4")[0], h[0] / r2, 1e-13);
}

TEST(ShConventionFormula, GodotsLightMapOfAWhiteSkyDecodesTo917) {
  const ShRgb white{1, {RgbD(std::sqrt(4.0 * kPi))}};
  const std::vector<double> v = from_ours(white, known_convention("godot-lightmap").convention);
  ASSERT_EQ(v.size(), 12U);
  EXPECT_NEAR(v[0], 0.25, 1e-14);
  EXPECT_NEAR(v[3], 0.5, 1e-14);
  EXPECT_NEAR(v[9], 0.5, 1e-14);
  EXPECT_NEAR(v[0] + (v[6] - 0.5) * 8.0 * v[0], 0.25 + 2.0 / 3.0, 1e-14);
}

}  // namespace
}  // namespace plumbline::sh
