#include "prt/sh/identify.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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

}  // namespace
}  // namespace plumbline::sh
