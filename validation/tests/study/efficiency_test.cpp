#include "validation/study/efficiency.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace plumbline::study {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

study::Run make_run(const char* method, int spp, int repetition, double seconds, double relmse) {
  return {method, spp, repetition, 0, seconds, relmse};
}

TEST(Efficiency, IsTheInverseOfErrorTimesTime) {
  EXPECT_DOUBLE_EQ(efficiency(1e-3, 4.0), 250.0);
  EXPECT_TRUE(std::isnan(efficiency(-1e-9, 4.0)));
  EXPECT_TRUE(std::isnan(efficiency(kNan, 4.0)));
  EXPECT_TRUE(std::isnan(efficiency(1e-3, 0.0)));
}

// Two values 1 and 3: mean 2, standard error 1, t(0.975, 1) = 12.7062 (any table).
TEST(Budgets, HoldMeansAndStudentIntervals) {
  const std::vector<study::Run> runs = {make_run("a", 16, 0, 1.0, 1.0), make_run("a", 16, 1, 3.0, 3.0)};
  const std::vector<Budget> all = budgets(runs);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].repetitions, 2);
  EXPECT_DOUBLE_EQ(all[0].seconds, 2.0);
  EXPECT_DOUBLE_EQ(all[0].relmse, 2.0);
  EXPECT_NEAR(all[0].relmse_high, 2.0 + 12.7062, 1e-4);
  EXPECT_DOUBLE_EQ(all[0].efficiency, 0.25);
}

TEST(Budgets, KnowWhoIsOnTheParetoFront) {
  const std::vector<study::Run> runs = {make_run("a", 1, 0, 1.0, 1.0), make_run("a", 2, 0, 2.0, 0.5),
                                        make_run("b", 1, 0, 1.5, 1.0), make_run("b", 2, 0, 3.0, 0.4)};
  const std::vector<Budget> all = budgets(runs);
  ASSERT_EQ(all.size(), 4U);
  EXPECT_TRUE(all[0].is_on_front);
  EXPECT_TRUE(all[1].is_on_front);
  EXPECT_FALSE(all[2].is_on_front);  // slower than the first and no better
  EXPECT_TRUE(all[3].is_on_front);
  EXPECT_TRUE(std::isnan(all[0].relmse_low));
}

TEST(Ratios, PairTheRepetitions) {
  // Whatever slows the machine in one repetition slows both: the ratio is 2 in each.
  const std::vector<study::Run> runs = {make_run("a", 16, 0, 1.0, 1e-3), make_run("b", 16, 0, 2.0, 1e-3),
                                        make_run("b", 16, 1, 9.0, 2e-3), make_run("a", 16, 1, 9.0, 1e-3)};
  const std::vector<Ratio> all = ratios(runs, "b");
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].method, "a");
  EXPECT_NEAR(all[0].ratio, 2.0, 1e-12);
  EXPECT_NEAR(all[0].low, 2.0, 1e-9);
  EXPECT_NEAR(all[0].high, 2.0, 1e-9);
}

TEST(Ratios, HaveNoIntervalFromOneRepetitionAndNoValueFromANegativeError) {
  const std::vector<study::Run> one = {make_run("a", 16, 0, 1.0, 1e-3), make_run("b", 16, 0, 1.0, 1e-3)};
  ASSERT_EQ(ratios(one, "b").size(), 1U);
  EXPECT_TRUE(std::isnan(ratios(one, "b")[0].low));
  const std::vector<study::Run> negative = {make_run("a", 16, 0, 1.0, -1e-3),
                                            make_run("b", 16, 0, 1.0, 1e-3)};
  EXPECT_TRUE(std::isnan(ratios(negative, "b")[0].ratio));
  EXPECT_TRUE(ratios(one, "c").empty()) << "there is no partner";
}

TEST(Fit, FindsThePowerLaw) {
  std::vector<study::Run> runs;
  for (const int spp : {1, 2, 4, 8})
    runs.push_back(make_run("a", spp, 0, 0.1 * spp, 3.0 * std::pow(0.1 * spp, -1.25)));
  const auto law = fit(budgets(runs), "a");
  ASSERT_TRUE(law);
  EXPECT_NEAR(law->slope, -1.25, 1e-12);
  EXPECT_NEAR(law->factor, 3.0, 1e-12);
  EXPECT_FALSE(fit(budgets(runs), "b"));
  EXPECT_FALSE(fit(std::vector<Budget>{budgets(runs)[0]}, "a"));
}

}  // namespace
}  // namespace plumbline::study
