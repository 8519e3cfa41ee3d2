#include "validation/checks/truths_calibration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "validation/checks/truths_images.hpp"

namespace plumbline::checks {
namespace {

constexpr double kSignificance = 1e-4;  // of each test here; the seeds are fixed

TruthCase case_named(const std::string& name) {
  for (TruthCase& one : truth_cases()) {
    if (one.name == name) return one;
  }
  throw std::invalid_argument(name);
}

// ---------------------------------------------------------------- p values
TEST(TruthsCalibration, PValuesOfAllCasesAndSeedsAreFlat) {
  PValueBudget budget;
  budget.samples = 1 << 9;
  const PValues p = p_values(truth_cases(), budget);
  const Flatness f = flatness(p);
  EXPECT_GE(p.cases, 60U);
  EXPECT_EQ(p.values.size(), 32U * p.cases);
  EXPECT_TRUE(is_flat(f, kSignificance))
      << "distance " << f.distance.statistic << ", p " << f.distance.p << "; " << f.below << " of "
      << p.values.size() << " below 0.01, p " << f.below_p;
  RecordProperty("ks_p", std::to_string(f.distance.p));
  // A renderer that thinks its noise half as large again, or two thirds of what it is.
  EXPECT_FALSE(is_flat(flatness(with_error_factor(p, 1.5)), kSignificance));
  EXPECT_FALSE(is_flat(flatness(with_error_factor(p, 1.0 / 1.5)), kSignificance));
}

TEST(TruthsCalibration, ANaNAmongThePValuesIsFound) {
  PValues p = {std::vector<double>(1000), {}, {}, 1, 1000};
  for (std::size_t i = 0; i < p.values.size(); ++i) p.values[i] = (static_cast<double>(i) + 0.5) / 1000.0;
  EXPECT_TRUE(is_flat(flatness(p), kSignificance));
  p.values[7] = NAN;
  EXPECT_FALSE(is_flat(flatness(p), kSignificance));
}

// ---------------------------------------------------------------- power
TEST(TruthsCalibration, InjectedBiasesAreFoundAsOftenAsStated) {
  for (const char* const name : {"D09_CornerRectangle"}) {
    const std::vector<PowerPoint> curve = power_curve(case_named(name), 0.003, PowerBudget{});
    ASSERT_EQ(curve.size(), 5U);
    for (const PowerPoint& point : curve) {
      EXPECT_TRUE(agrees(point)) << name << ' ' << point.bias << ": found " << point.measured.value << " ["
                                 << point.measured.low << ", " << point.measured.high << "], stated "
                                 << point.stated;
    }
    EXPECT_GE(curve[2].stated, 0.8) << name;  // 0.3 %: 0.9 by the pilot's spread
    EXPECT_GE(curve[3].measured.low, 0.98) << name;
    EXPECT_GE(curve[4].measured.low, 0.98) << name;
  }
}

TEST(TruthsCalibration, TwoRunsOfTheSameAreToldApartNoOftenerThanClaimed) {
  for (const char* const name : {"D09_CornerRectangle", "M09_Dihedral90"}) {
    const PowerPoint alarms = false_alarms_between_runs(case_named(name), 256, PowerBudget{});
    EXPECT_TRUE(agrees(alarms)) << name << ' ' << alarms.measured.value;
  }
}

TEST(TruthsCalibration, ARateThatIsNotTheStatedOneIsRefused) {
  PowerPoint point;
  point.stated = point.stated_low = point.stated_high = 0.9;
  point.measured = metrics::proportion(900, 1000, kSignificance);
  EXPECT_TRUE(agrees(point));
  for (const std::size_t found : {800U, 960U}) {
    point.measured = metrics::proportion(found, 1000, kSignificance);
    EXPECT_FALSE(agrees(point)) << found;
  }
  point.measured.low = NAN;
  EXPECT_FALSE(agrees(point));
}

// ---------------------------------------------------------------- images
Values times(Values values, double factor) {
  for (metrics::Estimate& value : values) {
    value.mean *= factor;
    value.standard_error *= factor;
  }
  return values;
}

TEST(TruthsImages, ScaledCopiesGiveTheSameImage) {
  constexpr double kMargin = 0.02;  // what 32 samples a pixel can show
  const Budget budget;
  const Values one = scaled_image(1.0F, 32, budget, 1);
  for (const float scale : {1e-3F, 1e3F}) {
    const Values other = scaled_image(scale, 32, budget, scale < 1.0F ? 2 : 3);
    EXPECT_EQ(judge_values("tiles", one, other, kSignificance).verdict, Verdict::pass) << scale;
    const Finding mean = judge_mean("mean", one, other, kMargin, kSignificance);
    EXPECT_EQ(mean.verdict, Verdict::pass) << scale << ": " << mean.measured << " +- " << mean.uncertainty;
    for (const double factor : {0.95, 1.05, static_cast<double>(NAN)})
      EXPECT_EQ(judge_mean("mean", one, times(other, factor), kMargin, kSignificance).verdict, Verdict::fail)
          << factor;
    Values broken = other;
    broken[5].mean = NAN;
    EXPECT_EQ(judge_values("tiles", one, broken, kSignificance).verdict, Verdict::fail);
    broken = other;
    broken[5].mean += 20.0 * std::hypot(one[5].standard_error, other[5].standard_error);
    EXPECT_EQ(judge_values("tiles", one, broken, kSignificance).verdict, Verdict::fail);
  }
}

TEST(TruthsImages, ATinySunLeavesNoFireflies) {
  const SunImages sun = sun_images(Budget{}, 512);
  EXPECT_LE(sun.relative_error, 0.01);
  const Finding pixels = judge_values("pixels", sun.quick, sun.reference, kSignificance);
  EXPECT_EQ(pixels.verdict, Verdict::pass) << pixels.measured << " against " << pixels.bound;
  RecordProperty("kurtosis", std::to_string(sun.kurtosis));
  Values firefly = sun.quick;  // one path that met the sun by chance: 1e5/pi of a pixel's samples
  firefly[500].mean += 3e4 / static_cast<double>(sun.samples_per_pixel);
  EXPECT_EQ(judge_values("pixels", firefly, sun.reference, kSignificance).verdict, Verdict::fail);
}

}  // namespace
}  // namespace plumbline::checks
