#include "prt/sh/identify.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "prt/sh/quadrature.hpp"
#include "reference/base/error.hpp"
#include "reference/image/file.hpp"
#include "reference/light/environment.hpp"

namespace plumbline::sh {
namespace {

constexpr const char* kWorlds = "/usr/share/blender/datafiles/studiolights/world/";
constexpr int kAllBands = 20;

light::Environment real_environment(const std::string& name) {
  return light::load_environment(kWorlds + name);
}
/// Projected once for all tests.
const ShRgb& city() {
  static const ShRgb light = project_radiance(real_environment("city.exr"), kAllBands);
  return light;
}

ShRgb first_bands(const ShRgb& light, int bands) {
  const auto count = static_cast<std::ptrdiff_t>(coefficient_count(bands));
  return {bands, {light.coefficients.begin(), light.coefficients.begin() + count}};
}

std::vector<double> in_float(std::vector<double> values) {
  for (double& v : values) v = static_cast<double>(static_cast<float>(v));
  return values;
}

bool takes_bands(const KnownConvention& known, int bands) {
  const bool is_packed =
      known.convention.layout == Layout::packed || known.convention.layout == Layout::packed_square;
  return bands <= known.max_bands && (!is_packed || bands == 3);
}

std::vector<double> values_of(const KnownConvention& known, const ShRgb& light, int bands) {
  const bool is_half = known.convention.functions != Functions::sphere;
  return in_float(from_ours(is_half ? light : first_bands(light, bands), known.convention));
}

/// What is wrong with an answer to numbers that are in a known convention; empty when nothing is. Not only the name
/// counts: the answer's own reading must give the light back.
std::string fault_of(const Identification& answer, const KnownConvention& known,
                     const std::vector<double>& values, const ShRgb& light) {
  if (answer.verdict != Verdict::identified) return "not identified";
  const Candidate& best = answer.ranking.front();
  if (std::find(best.known.begin(), best.known.end(), known.name) == best.known.end()) return "another name";
  if (!(answer.ranking.at(1).log_odds_behind_best >= kDecisiveLogOdds)) return "no margin";
  if (best.scale != 1.0) return "scaled";
  for (const Convention& reading : best.readings) {
    const ShRgb source = reading.functions == Functions::sphere ? first_bands(light, best.bands) : light;
    const std::vector<double> expected = from_ours(source, reading);
    double difference = 0.0;
    double size = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      difference = std::max(difference, std::abs(expected.at(i) - values[i]));
      size = std::max(size, std::abs(values[i]));
    }
    if (!(difference <= 1e-6 * size)) return "a reading that gives other numbers";
  }
  return "";
}

TEST(ShIdentify, IsRightOnEveryKnownConventionUnderARealSky) {
  for (const KnownConvention& known : known_conventions()) {
    const std::vector<double> values = values_of(known, city(), 3);
    EXPECT_EQ(fault_of(identify(values, city()), known, values, city()), "") << known.name;
  }
}

TEST(ShIdentify, IsRightFromTwoBandsToFive) {
  const ShRgb light = first_bands(city(), 5);
  for (const KnownConvention& known : known_conventions()) {
    if (known.convention.functions != Functions::sphere) continue;
    for (const int bands : {2, 4, 5}) {
      if (!takes_bands(known, bands)) continue;
      const std::vector<double> values = values_of(known, light, bands);
      EXPECT_EQ(fault_of(identify(values, light), known, values, light), "") << known.name << " " << bands;
    }
  }
}

TEST(ShIdentify, AWrongAnswerIsSeenByThisTestsOwnPredicate) {
  const ShRgb light = first_bands(city(), 3);
  for (const auto& [row, planted] :
       std::initializer_list<std::pair<const char*, const char*>>{{"google", "threejs"},
                                                                  {"unity", "filament-shader-no-mirror"},
                                                                  {"filament-shader", "google"},
                                                                  {"e3nn-norm", "sn3d"},
                                                                  {"arkit-radiance", "threejs"},
                                                                  {"flutter", "threejs"}}) {
    const KnownConvention& right = known_convention(row);
    const std::vector<double> values = values_of(right, light, 3);
    const Identification wrong = identify(values_of(known_convention(planted), light, 3), light);
    EXPECT_NE(fault_of(wrong, right, values, light), "") << row;
    Identification forged = wrong;  // the right name on the wrong readings
    forged.ranking.front().known.push_back(row);
    EXPECT_EQ(fault_of(forged, right, values, light), "a reading that gives other numbers") << row;
    Identification tied = identify(values, light);
    tied.ranking.at(1).log_odds_behind_best = 0.0;
    EXPECT_EQ(fault_of(tied, right, values, light), "no margin");
  }
}

// ---------------------------------------------------------------- what only the light can tell

ShRgb light_from(const std::function<double(const Vec3d&)>& radiance, int bands = 3) {
  ShRgb light{bands, std::vector<RgbD>(static_cast<std::size_t>(coefficient_count(bands)), RgbD(0.0))};
  for (const SphereNode& node : sphere_quadrature(bands)) {
    const std::vector<double> y = evaluate_basis(bands, node.direction);
    const RgbD value = node.weight * radiance(node.direction) * RgbD(1.0, 0.6, 0.3);
    for (std::size_t i = 0; i < y.size(); ++i) light.coefficients[i] += y[i] * value;
  }
  return light;
}

bool mentions(const std::vector<std::string>& lines, const std::string& word) {
  return std::any_of(lines.begin(), lines.end(),
                     [&](const std::string& line) { return line.find(word) != std::string::npos; });
}

TEST(ShIdentify, RefusesAConstantSkyOnEveryKnownConvention) {
  const ShRgb white = light_from([](const Vec3d&) { return 1.0; });
  for (const char* name :
       {"plumbline", "threejs", "unity", "filament-irradiance", "shtools", "godot-probe", "arkit-radiance"}) {
    const KnownConvention& known = known_convention(name);
    const std::vector<double> values = values_of(known, white, 3);
    const Identification answer = identify(values, white);
    EXPECT_EQ(answer.verdict, Verdict::undecided) << name;
    EXPECT_NE(fault_of(answer, known, values, white), "") << name;
    EXPECT_TRUE(mentions(answer.undecided, "sign and axes")) << name;
    EXPECT_TRUE(mentions(answer.undecided, "arrangement")) << name;
    EXPECT_TRUE(mentions(answer.would_decide, "(2, 3, 6)/7")) << name;
    EXPECT_TRUE(mentions(answer.would_decide, "degree 0 only")) << name;
  }
}

TEST(ShIdentify, StatesTheClassesThatAConstantSkyCannotTellApart) {
  const ShRgb white = light_from([](const Vec3d&) { return 1.0; });
  const Identification raw = identify(values_of(known_convention("threejs"), white, 3), white);
  EXPECT_TRUE(mentions(raw.undecided, "threejs"));  // radiance and E/pi share 3.545
  EXPECT_TRUE(mentions(raw.undecided, "flutter"));
  EXPECT_TRUE(mentions(raw.undecided, "radiance L"));
  EXPECT_TRUE(mentions(raw.undecided, "E/pi"));
  const Identification folded = identify(values_of(known_convention("filament-shader"), white, 3), white);
  EXPECT_TRUE(mentions(folded.undecided, "geodesy"));  // 4 pi normalised means and E/pi polynomials share 1
  EXPECT_TRUE(mentions(folded.undecided, "filament-shader-no-mirror"));
}

TEST(ShIdentify, NamesWhatALightThatIsRoundAboutZLeavesOpen) {
  const ShRgb cone = light_from([](const Vec3d& w) { return std::exp(2.0 * w.z); });
  const Identification answer = identify(values_of(known_convention("google"), cone, 3), cone);
  EXPECT_EQ(answer.verdict, Verdict::undecided);
  EXPECT_EQ(answer.tied % 8U, 0U);  // four quarter turns, each with a mirror
  EXPECT_TRUE(mentions(answer.undecided, "sign and axes"));
  EXPECT_TRUE(mentions(answer.undecided, "google"));
  EXPECT_TRUE(mentions(answer.undecided, "threejs"));
  EXPECT_FALSE(mentions(answer.undecided, "quantity"));
  EXPECT_FALSE(mentions(answer.undecided, "layout"));
  EXPECT_FALSE(mentions(answer.would_decide, "degree 0 only"));
}

TEST(ShIdentify, SignIsOpenWhereHalfATurnChangesNothing) {
  const ShRgb light =
      light_from([](const Vec3d& w) { return 2.0 + w.z + 0.9 * w.x * w.y + 0.4 * w.x * w.x; });
  const Identification answer = identify(values_of(known_convention("google"), light, 3), light);
  EXPECT_EQ(answer.verdict, Verdict::undecided);
  EXPECT_TRUE(mentions(answer.undecided, "threejs"));
  EXPECT_FALSE(mentions(answer.undecided, "arrangement"));
}

TEST(ShIdentify, GreyLightTellsEverythingButNothingMore) {
  ShRgb grey = first_bands(city(), 3);
  for (RgbD& c : grey.coefficients) c = RgbD(c.g);
  for (const char* name : {"unity", "threejs", "3dgs"}) {
    const KnownConvention& known = known_convention(name);
    const std::vector<double> values = values_of(known, grey, 3);
    EXPECT_EQ(fault_of(identify(values, grey), known, values, grey), "") << name;
  }
}

TEST(ShIdentify, OneDirectionalLightIsEnough) {
  ShRgb delta{3, {}};
  for (const double y : evaluate_basis(3, Vec3d(2.0, 3.0, 6.0) / 7.0))
    delta.coefficients.push_back(y * RgbD(1.0, 2.0, 3.0));
  for (const KnownConvention& known : known_conventions()) {
    if (known.convention.functions != Functions::sphere) continue;
    const std::vector<double> values = values_of(known, delta, 3);
    EXPECT_EQ(fault_of(identify(values, delta), known, values, delta), "") << known.name;
  }
  // Straight up, it tells little.
  ShRgb up{3, {}};
  for (const double y : evaluate_basis(3, {0.0, 0.0, 1.0})) up.coefficients.emplace_back(y);
  EXPECT_EQ(identify(values_of(known_convention("google"), up, 3), up).verdict, Verdict::undecided);
}

// ---------------------------------------------------------------- other skies, other axes, noise

TEST(ShIdentify, IsRightUnderOtherSkiesTurnedAnyWay) {
  for (const char* file : {"sunset.exr", "interior.exr", "night.exr"}) {
    const light::Environment turned = light::rotated(real_environment(file), {30.0F, 50.0F, -70.0F});
    const ShRgb light = project_radiance(turned, 3);
    for (const char* name : {"google", "threejs", "unity", "filament-shader", "e3nn-component", "sn3d"}) {
      const KnownConvention& known = known_convention(name);
      const std::vector<double> values = values_of(known, light, 3);
      EXPECT_EQ(fault_of(identify(values, light), known, values, light), "") << file << " " << name;
    }
  }
}

TEST(ShIdentify, FindsAll48AxesWithBothSignsAndEveryArrangement) {
  const ShRgb light = first_bands(city(), 3);
  for (const SignedAxes& axes : all_signed_axes()) {
    Convention convention;
    convention.axes = axes;
    convention.sign = axes.sign[0] > 0 ? Sign::positive : Sign::condon_shortley;
    convention.arrangement = axes.axis[0] == 0 ? Arrangement::descending : Arrangement::zero_first;
    const Identification answer = identify(from_ours(light, convention), light);
    ASSERT_EQ(answer.verdict, Verdict::identified) << to_string(axes);
    const std::vector<Convention>& readings = answer.ranking.front().readings;
    EXPECT_TRUE(std::any_of(readings.begin(), readings.end(), [&](const Convention& reading) {
      return reading.axes == axes && reading.sign == convention.sign &&
             reading.arrangement == convention.arrangement;
    })) << to_string(axes);
  }
}

/// Rounds to 11 bits, as half-precision floats do.
double in_half(double value) {
  if (value == 0.0) return 0.0;
  const double unit = std::ldexp(1.0, std::ilogb(value) - 10);
  return std::round(value / unit) * unit;
}

std::string name_of_best(const Identification& answer) {
  if (answer.verdict != Verdict::identified || answer.ranking.front().known.empty()) return "";
  return answer.ranking.front().known.front();
}

TEST(ShIdentify, SurvivesHalfPrecisionAndTheNoiseOfAThousandSamples) {
  const ShRgb light = first_bands(city(), 3);
  std::mt19937 bits(9U);
  for (const char* name :
       {"plumbline", "threejs", "unity", "filament-shader", "filament-irradiance", "shtools"}) {
    std::vector<double> values = values_of(known_convention(name), light, 3);
    double largest = 0.0;
    for (const double v : values) largest = std::max(largest, std::abs(v));
    std::vector<double> noisy = values;
    for (double& v : values) v = in_half(v);
    EXPECT_EQ(name_of_best(identify(values, light)), name);
    // Uniform in +-1.5 % of the largest: 0.9 % root mean square, what 10^3 samples of a soft sky leave.
    for (double& v : noisy) {
      if (v != 0.0) v += 0.015 * largest * (static_cast<double>(bits()) / 2147483648.0 - 1.0);
    }
    EXPECT_EQ(name_of_best(identify(noisy, light)), name);
  }
}

TEST(ShIdentify, ExplainsNothingByForce) {
  const ShRgb light = first_bands(city(), 3);
  const ShRgb white = light_from([](const Vec3d&) { return 1.0; });
  const KnownConvention& unity = known_convention("unity");
  EXPECT_EQ(identify(values_of(unity, white, 3), light).verdict, Verdict::unexplained);
  EXPECT_EQ(identify(values_of(unity, light, 3), white).verdict, Verdict::unexplained);
  std::mt19937 bits(3U);
  std::vector<double> values(27);
  for (double& v : values) v = static_cast<double>(bits()) / 4294967296.0;
  EXPECT_EQ(identify(values, light).verdict, Verdict::unexplained);
  const ShRgb other = project_radiance(real_environment("night.exr"), 3);
  EXPECT_EQ(identify(values_of(known_convention("google"), other, 3), light).verdict, Verdict::unexplained);
}

TEST(ShIdentify, FindsAScaleOrAWindow) {
  const ShRgb light = first_bands(city(), 4);
  std::vector<double> scaled = from_ours(light, known_convention("threejs").convention);
  for (double& v : scaled) v *= 2.5;
  const Identification bright = identify(scaled, light);
  EXPECT_EQ(name_of_best(bright), "threejs");
  EXPECT_NEAR(bright.ranking.front().scale, 2.5, 1e-12);
  const Identification soft = identify(
      from_ours(windowed(light, Window::laplacian, 0.005), known_convention("google").convention), light);
  ASSERT_EQ(soft.verdict, Verdict::identified);
  const Convention& reading = soft.ranking.front().readings.front();
  ASSERT_EQ(reading.quantity, Quantity::custom);
  EXPECT_EQ(reading.axes, SignedAxes{});
  for (int l = 0; l < 4; ++l) {
    EXPECT_NEAR(reading.factors.at(static_cast<std::size_t>(l)),
                window_factor(Window::laplacian, l, 4, 0.005), 1e-12);
  }
}

TEST(ShIdentify, TakesOneChannel) {
  const ShRgb light = first_bands(city(), 3);
  std::vector<double> green;
  for (const RgbD& c : light.coefficients) green.push_back(c.g);
  const Identification answer = identify(green, light);
  EXPECT_EQ(name_of_best(answer), "plumbline");
  EXPECT_TRUE(answer.ranking.front().is_one_channel);
  const std::vector<double> geodesic = from_ours(light, known_convention("shtools").convention);
  const Identification one = identify(std::span(geodesic).first(18), light);
  EXPECT_EQ(name_of_best(one), "shtools");
}

/// The H-basis of BakingLab by a sum over directions on a grid of its own, not from SH coefficients.
std::vector<double> h_basis_of(const light::Environment& sky) {
  std::array<RgbD, 4> h{};
  constexpr int kRows = 400;
  for (int i = 0; i < kRows; ++i) {
    for (int j = 0; j < 4 * kRows; ++j) {
      const double z = (i + 0.5) / kRows;
      const double phi = 2.0 * kPi * (j + 0.5) / (4 * kRows);
      const double r = std::sqrt(1.0 - z * z);
      const Vec3d w(r * std::cos(phi), r * std::sin(phi), z);
      const RgbD radiance = RgbD(light::radiance(sky, Vec3(w))) * (2.0 * kPi / (kRows * 4.0 * kRows));
      h[0] += radiance / std::sqrt(2.0 * kPi);
      h[1] -= radiance * std::sqrt(1.5 / kPi) * w.y;
      h[2] += radiance * std::sqrt(1.5 / kPi) * (2.0 * w.z - 1.0);
      h[3] -= radiance * std::sqrt(1.5 / kPi) * w.x;
    }
  }
  std::vector<double> values;
  for (const RgbD& v : h) values.insert(values.end(), {v.r, v.g, v.b});
  return values;
}

TEST(ShIdentify, TellsFunctionsOnAHemisphereFromTheTexelsThemselves) {
  const light::Environment soft = real_environment("sunset.exr");
  EXPECT_EQ(name_of_best(identify(h_basis_of(soft), project_radiance(soft, kAllBands))), "bakinglab-h4");
  // A sun of 34,000 needs more bands than that: the answer is that nothing can be said, and not a wrong one.
  const Identification hard = identify(h_basis_of(real_environment("city.exr")), city());
  EXPECT_EQ(hard.verdict, Verdict::undecided);
  EXPECT_EQ(hard.ranking.front().known.front(), "bakinglab-h4");
}

// ---------------------------------------------------------------- refusals and bounds

TEST(ShIdentify, RefusesWhatIsNoSet) {
  const ShRgb light = first_bands(city(), 3);
  EXPECT_NE(fault_of_count(10), "");
  EXPECT_EQ(fault_of_count(27), "");
  EXPECT_THROW((void)identify(std::vector<double>(10, 1.0), light), InputError);
  EXPECT_THROW((void)identify(std::vector<double>(75, 1.0), light), InputError);  // 5 bands of a light of 3
  std::vector<double> values(27, 1.0);
  values[4] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW((void)identify(values, light), InputError);
  EXPECT_THROW((void)passive_bounds(values), InputError);
  EXPECT_THROW((void)passive_bounds(std::vector<double>(10, 1.0)), InputError);
}

bool is_excluded(const std::vector<Bound>& bounds, Normalization normalization, Quantity quantity,
                 Layout layout) {
  for (const Bound& bound : bounds) {
    const Convention& c = bound.convention;
    const bool is_it = c.normalization == normalization && c.quantity == quantity && c.layout == layout;
    if (is_it && c.role == Role::expansion) return bound.is_excluded;
  }
  ADD_FAILURE() << "no such bound";
  return false;
}

TEST(ShIdentify, BoundsExcludeWhatNoLightCanBe) {
  // One directional light: radiance is at its bounds, 1; as irradiance it would be 3/2 and 4 times beyond.
  ShRgb delta{3, {}};
  for (const double y : evaluate_basis(3, Vec3d(2.0, 3.0, 6.0) / 7.0)) delta.coefficients.emplace_back(y);
  const std::vector<Bound> raw = passive_bounds(from_ours(delta, {}));
  EXPECT_FALSE(is_excluded(raw, Normalization::orthonormal, Quantity::radiance, Layout::interleaved));
  EXPECT_TRUE(is_excluded(raw, Normalization::orthonormal, Quantity::irradiance, Layout::interleaved));
  EXPECT_NEAR(raw.front().ratio, 1.0, 1e-12);
  const Convention folded = known_convention("filament-shader").convention;
  const std::vector<Bound> unity = passive_bounds(from_ours(delta, folded));
  EXPECT_FALSE(is_excluded(unity, Normalization::polynomial, Quantity::irradiance, Layout::interleaved));
  std::vector<double> broken = from_ours(delta, {});
  for (std::size_t i = 3; i < 12; ++i) broken[i] *= 1.01;
  EXPECT_TRUE(is_excluded(passive_bounds(broken), Normalization::orthonormal, Quantity::radiance,
                          Layout::interleaved));
  for (double& v : broken) v = -std::abs(v);
  for (const Bound& bound : passive_bounds(broken)) EXPECT_TRUE(bound.is_excluded);
}

TEST(ShIdentify, BoundsNeverExcludeTheTruth) {
  const ShRgb light = first_bands(city(), 5);
  for (const Quantity quantity : {Quantity::radiance, Quantity::irradiance}) {
    for (const Layout layout : {Layout::interleaved, Layout::planar, Layout::splat}) {
      Convention convention;
      convention.quantity = quantity;
      convention.layout = layout;
      EXPECT_FALSE(is_excluded(passive_bounds(from_ours(light, convention)), Normalization::orthonormal,
                               quantity, layout));
    }
  }
}

}  // namespace
}  // namespace plumbline::sh
