#include "prt/sh/convention.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>
#include <set>

#include "prt/sh/quadrature.hpp"
#include "reference/base/error.hpp"
#include "validation/tests/sh/oracle.hpp"

namespace plumbline::sh {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

ShRgb random_light(int bands, unsigned seed) {
  std::mt19937 bits(seed);
  const auto uniform = [&bits] { return static_cast<double>(bits()) / 2147483648.0 - 1.0; };
  ShRgb light{bands, {}};
  for (int i = 0; i < coefficient_count(bands); ++i) {
    const double r = uniform();
    const double g = uniform();
    light.coefficients.emplace_back(r, g, uniform());
  }
  return light;
}

double largest(const std::vector<RgbD>& values) {
  double result = 0.0;
  for (const RgbD& v : values) result = std::max({result, std::abs(v.r), std::abs(v.g), std::abs(v.b)});
  return result;
}

bool has_bands(const KnownConvention& known, int bands) {
  const bool is_packed =
      known.convention.layout == Layout::packed || known.convention.layout == Layout::packed_square;
  return bands <= known.max_bands && (!is_packed || bands == 3);
}

/// How far the coefficients are from those of `light`, relative to its largest; lost degrees must be 0.
double fault_of_round_trip(const ShRgb& light, const Converted& back) {
  if (back.ours.coefficients.size() != light.coefficients.size()) return kNaN;
  std::vector<RgbD> differences;
  for (int l = 0; l < light.bands; ++l) {
    const bool is_lost = std::count(back.lost_degrees.begin(), back.lost_degrees.end(), l) > 0;
    for (int m = -l; m <= l; ++m) {
      const auto i = static_cast<std::size_t>(index(l, m));
      differences.push_back(back.ours.coefficients[i] - (is_lost ? RgbD(0.0) : light.coefficients[i]));
    }
  }
  return largest(differences) / largest(light.coefficients);
}

// ---------------------------------------------------------------- axes

TEST(ShSignedAxes, AreAGroupOf48HalfOfWhichMirror) {
  const std::vector<SignedAxes> all = all_signed_axes();
  ASSERT_EQ(all.size(), 48U);
  EXPECT_EQ(all[0], SignedAxes{});
  std::set<std::string> names;
  int mirrored = 0;
  const Vec3d d(0.1, 0.2, 0.3);
  for (const SignedAxes& axes : all) {
    names.insert(to_string(axes));
    mirrored += is_mirrored(axes) ? 1 : 0;
    EXPECT_EQ(apply(inverse(axes), apply(axes, d)), d) << to_string(axes);
    const Vec3d x = apply(axes, {1.0, 0.0, 0.0});
    const Vec3d y = apply(axes, {0.0, 1.0, 0.0});
    const Vec3d z = apply(axes, {0.0, 0.0, 1.0});
    EXPECT_EQ(glm::dot(glm::cross(x, y), z) < 0.0, is_mirrored(axes)) << to_string(axes);
    for (const SignedAxes& next : all) {
      EXPECT_EQ(apply(combined(axes, next), d), apply(next, apply(axes, d)));
    }
  }
  EXPECT_EQ(names.size(), 48U);
  EXPECT_EQ(mirrored, 24);
}

// ---------------------------------------------------------------- round trips

TEST(ShConvention, EveryKnownOneBringsEveryBandBackOrSaysWhichAreLost) {
  int tested = 0;
  for (const KnownConvention& known : known_conventions()) {
    if (known.convention.functions != Functions::sphere) continue;
    for (int bands = 1; bands <= 6; ++bands) {
      if (!has_bands(known, bands)) continue;
      const ShRgb light = random_light(bands, 7U);
      const std::vector<double> values = from_ours(light, known.convention);
      EXPECT_EQ(values.size(), value_count(known.convention, bands)) << known.name;
      EXPECT_EQ(bands_of_count(known.convention, values.size()), bands) << known.name;
      const Converted back = to_ours(values, known.convention, bands);
      // At most 2 x 72 nodes of products of 36 terms: 1e-14 leaves a factor of 5 over their rounding.
      EXPECT_LE(fault_of_round_trip(light, back), 1e-14) << known.name << " " << bands;
      ++tested;
    }
  }
  EXPECT_GE(tested, 120);
}

TEST(ShConvention, ARoundTripThroughAnotherConventionIsSeen) {
  const ShRgb light = random_light(3, 7U);
  for (const char* other : {"threejs", "filament-shader", "e3nn-integral", "arkit-irradiance"}) {
    const Converted back = to_ours(from_ours(light, known_convention("google").convention),
                                   known_convention(other).convention, 3);
    EXPECT_GE(fault_of_round_trip(light, back), 0.1) << other;
  }
}

TEST(ShConvention, AllAxesArrangementsAndLayoutsComeBack) {
  const ShRgb light = random_light(4, 3U);
  for (const Arrangement arrangement :
       {Arrangement::ascending, Arrangement::descending, Arrangement::xyz, Arrangement::zero_first}) {
    std::set<int> places;
    for (int l = 0; l < 6; ++l) {
      for (int m = -l; m <= l; ++m) places.insert(position(arrangement, l, m));
    }
    EXPECT_EQ(places.size(), 36U) << to_string(arrangement);
    EXPECT_EQ(*places.rbegin(), 35) << to_string(arrangement);
    for (const Layout layout :
         {Layout::interleaved, Layout::planar, Layout::rgba, Layout::splat, Layout::cosine_sine}) {
      for (const SignedAxes& axes : all_signed_axes()) {
        Convention convention;
        convention.arrangement = arrangement;
        convention.layout = layout;
        convention.axes = axes;
        EXPECT_LE(fault_of_round_trip(light, to_ours(from_ours(light, convention), convention, 4)), 1e-14);
      }
    }
  }
}

TEST(ShConvention, IrradianceLosesTheOddDegreesAboveOne) {
  const ShRgb light = random_light(7, 5U);
  const Convention irradiance = known_convention("filament-irradiance").convention;
  const Converted back = to_ours(from_ours(light, irradiance), irradiance, 7);
  EXPECT_EQ(back.lost_degrees, (std::vector<int>{3, 5}));
  EXPECT_LE(fault_of_round_trip(light, back), 1e-14);
  EXPECT_TRUE(to_ours(from_ours(light, {}), {}, 7).lost_degrees.empty());
}

// ---------------------------------------------------------------- two lights everybody can project

// Five decimals, for a directional light of irradiance 1 from (2, 3, 6)/7 and for radiance 1 everywhere; without
// the Condon-Shortley sign.
struct Probe {
  const char* name;
  double uniform;
  std::array<double, 9> delta;
};
const std::array<Probe, 4> kProbes{{
    {"threejs", 3.54491, {.28209, .20940, .41880, .13960, .13378, .40134, .37976, .26756, -.05574}},
    {"filament-irradiance-no-mirror",
     11.13666,
     {.88623, .43857, .87714, .29238, .10507, .31522, .29826, .21014, -.04378}},
    {"flutter", 3.54491, {.28209, .13960, .27920, .09307, .03345, .10034, .09494, .06689, -.01394}},
    {"filament-shader-no-mirror",
     1.0,
     {.07958, .06821, .13642, .04547, .03654, .10962, .02994, .07308, -.00761}},
}};

ShRgb uniform_light(int bands) {
  ShRgb light{bands, std::vector<RgbD>(static_cast<std::size_t>(coefficient_count(bands)), RgbD(0.0))};
  light.coefficients[0] = RgbD(std::sqrt(4.0 * kPi));
  return light;
}
ShRgb delta_light(int bands) {
  ShRgb light{bands, {}};
  for (const double y : evaluate_basis(bands, Vec3d(2.0, 3.0, 6.0) / 7.0)) light.coefficients.emplace_back(y);
  return light;
}

TEST(ShConvention, ReproducesTheProbesOfEveryQuantity) {
  constexpr double kRounding = 0.51e-5;
  for (const Probe& probe : kProbes) {
    Convention convention = known_convention(probe.name).convention;
    EXPECT_NEAR(from_ours(uniform_light(3), convention)[0], probe.uniform, kRounding) << probe.name;
    const bool is_turned = convention.sign == Sign::condon_shortley;
    const std::vector<double> values = from_ours(delta_light(3), convention);
    for (std::size_t i = 0; i < 9; ++i) {
      const bool is_odd = i == 1 || i == 3 || i == 5 || i == 7;
      EXPECT_NEAR(values[3 * i], is_turned && is_odd ? -probe.delta[i] : probe.delta[i], kRounding)
          << probe.name << " " << i;
    }
  }
}

TEST(ShConvention, ReproducesTheProbesThatAreScaledRadiance) {
  constexpr double kRounding = 0.51e-5;
  const auto delta = [](const Convention& c, std::size_t i) { return from_ours(delta_light(3), c)[i]; };
  const Convention godot = known_convention("godot-probe").convention;
  EXPECT_NEAR(from_ours(uniform_light(3), godot)[0], 1.12838, kRounding);
  EXPECT_NEAR(delta(godot, 4 * 5), .40134 / kPi, kRounding);
  const Convention geodesy = known_convention("geodesy").convention;
  EXPECT_NEAR(from_ours(uniform_light(3), geodesy)[0], 1.0, kRounding);
  EXPECT_NEAR(delta(geodesy, 3 * 5), .40134 / std::sqrt(4.0 * kPi), kRounding);
  Convention mean;
  mean.quantity = Quantity::radiance_over_4pi;
  EXPECT_NEAR(from_ours(uniform_light(3), mean)[0], .28209, kRounding);
}

// ---------------------------------------------------------------- refusals

TEST(ShConvention, RefusesWhatItCannotRead) {
  const Convention ours;
  EXPECT_THROW((void)to_ours(std::vector<double>(26), ours, 3), InputError);
  EXPECT_THROW((void)to_ours(std::vector<double>(27), ours, 0), InputError);
  std::vector<double> with_nan(27, 1.0);
  with_nan[5] = kNaN;
  EXPECT_THROW((void)to_ours(with_nan, ours, 3), InputError);
  for (const char* name : {"bakinglab-h4", "habel-h6", "probulator-h4", "godot-lightmap"}) {
    const Convention& half = known_convention(name).convention;
    const std::vector<double> values = from_ours(random_light(5, 2U), half);
    EXPECT_EQ(values.size(), value_count(half, 5));
    EXPECT_THROW((void)to_ours(values, half, 2), InputError) << name;
    EXPECT_FALSE(bands_of_count(half, values.size()).has_value());
  }
  EXPECT_THROW((void)known_convention("nobody's"), InputError);
}

TEST(ShConvention, RefusesWhatItCannotWrite) {
  EXPECT_THROW((void)from_ours(random_light(4, 1U), known_convention("unity").convention), InputError);
  EXPECT_THROW((void)from_ours(random_light(2, 1U), known_convention("unity-shader").convention), InputError);
  EXPECT_THROW((void)from_ours(ShRgb{3, std::vector<RgbD>(8)}, {}), InputError);
  EXPECT_THROW((void)from_ours(ShRgb{1, {RgbD(0.0, kNaN, 0.0)}}, {}), InputError);
  EXPECT_THROW((void)from_ours(ShRgb{1, {RgbD(0.0)}}, known_convention("godot-lightmap").convention),
               InputError);
  Convention bad_axes;
  bad_axes.axes.axis = {0, 0, 2};
  EXPECT_THROW((void)from_ours(random_light(2, 1U), bad_axes), InputError);
  Convention two_factors;
  two_factors.quantity = Quantity::custom;
  two_factors.factors = {1.0, 2.0};
  EXPECT_NO_THROW((void)from_ours(random_light(2, 1U), two_factors));
  EXPECT_THROW((void)from_ours(random_light(3, 1U), two_factors), InputError);
  EXPECT_THROW((void)coefficient_factor({}, 2, 3), InputError);
}

TEST(ShConvention, KnownNamesAreOneWordEachOnce) {
  std::set<std::string> names;
  for (const KnownConvention& known : known_conventions()) {
    EXPECT_TRUE(names.insert(known.name).second) << known.name;
    EXPECT_EQ(known.name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-"), std::string::npos);
    EXPECT_FALSE(known.project.empty() || known.where.empty()) << known.name;
    EXPECT_EQ(&known_convention(known.name), &known);
  }
  EXPECT_EQ(known_conventions().front().name, "plumbline");
}

}  // namespace
}  // namespace plumbline::sh
