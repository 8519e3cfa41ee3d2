#include "validation/checks/verdicts.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace plumbline::checks {
namespace {

const Label kLabel{"family", "name", "source", "detail"};

TEST(Verdicts, ErrorsAreHeldAgainstTheirBound) {
  EXPECT_EQ(judge_error(kLabel, 1e-13, 1e-12).verdict, Verdict::pass);
  EXPECT_EQ(judge_error(kLabel, 2e-12, 1e-12).verdict, Verdict::fail);
  EXPECT_EQ(judge_error(kLabel, NAN, 1e-12).verdict, Verdict::fail);
}

TEST(Verdicts, DeviationsPassFailOrAreUndecided) {
  const auto verdict = [](double mean, double standard_error, double allowance) {
    return judge_deviation(kLabel, {mean, standard_error}, allowance, 0.01, 1e-4).verdict;
  };
  EXPECT_EQ(verdict(0.001, 0.001, 0.0), Verdict::pass);
  EXPECT_EQ(verdict(0.005, 0.001, 0.0), Verdict::fail);         // z = 5 > 3.89
  EXPECT_EQ(verdict(0.005, 0.001, 0.002), Verdict::pass);       // known model error
  EXPECT_EQ(verdict(0.005, 0.01, 0.0), Verdict::inconclusive);  // could not have seen it
  EXPECT_EQ(verdict(NAN, 0.001, 0.0), Verdict::fail);
  EXPECT_EQ(verdict(0.0, NAN, 0.0), Verdict::fail);
}

TEST(Verdicts, TheLargestOfManyMayBeLarger) {
  EXPECT_EQ(judge_largest_z(kLabel, 4.5, 1, 0.0, 1e-4).verdict, Verdict::fail);
  EXPECT_EQ(judge_largest_z(kLabel, 4.5, 1000, 0.0, 1e-4).verdict, Verdict::pass);
  EXPECT_EQ(judge_largest_z(kLabel, 6.0, 1000, 0.0, 1e-4).verdict, Verdict::fail);
  EXPECT_EQ(judge_largest_z(kLabel, 6.0, 1000, 15.0, 1e-4).verdict, Verdict::pass);  // Student's t is wider
  EXPECT_EQ(judge_largest_z(kLabel, NAN, 10, 0.0, 1e-4).verdict, Verdict::fail);
  EXPECT_EQ(judge_largest_z(kLabel, 0.0, 0, 0.0, 1e-4).verdict, Verdict::inconclusive);
}

}  // namespace
}  // namespace plumbline::checks
