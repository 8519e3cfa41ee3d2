// The path tracer against every closed form of light transport, at the quick tier: equal within half a per cent, shown
// by two one-sided tests. The same verdict refuses every estimate made 1 % larger or smaller, and NaN.
#include "validation/checks/truths.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "reference/base/error.hpp"

namespace plumbline::checks {
namespace {

// All but three whose spread asks for minutes: late bounces on their own. `validate --checks truths` has them.
const std::vector<TruthCase>& cases() {
  static const std::vector<TruthCase> quick = [] {
    std::vector<TruthCase> all = truth_cases();
    std::erase_if(all, [](const TruthCase& one) {
      return one.name == "M16_FurnaceBounce8Alone" || one.name == "M16_FurnaceBounce4Alone" ||
             one.name == "M16_CornerRemainder";
    });
    return all;
  }();
  return quick;
}

class ClosedForm : public testing::TestWithParam<std::size_t> {};

Verdict verdict_of(const TruthCase& one, const TruthResult& result, double factor) {
  Measurement m = result.measurement;
  m.mean *= factor;
  m.standard_error *= std::abs(factor);
  return judge_truth(one, result.plan, m).verdict;
}

TEST_P(ClosedForm, HoldsWithinHalfAPercent) {
  const TruthCase& one = cases()[GetParam()];
  const TruthResult result = run_truth(one, Budget{}, cases().size());
  EXPECT_EQ(result.finding.verdict, Verdict::pass)
      << result.finding.measured << " +- " << result.finding.uncertainty << " %. " << result.finding.detail;
  RecordProperty("bias_per_cent", std::to_string(result.finding.measured));
  // 1 % of the truth, in units of what the case is relative to; late bounces have wider margins.
  const double step = 0.01 * one.margin_factor;
  EXPECT_EQ(verdict_of(one, result, NAN), Verdict::fail);
  for (const double sign : {-1.0, 1.0}) {
    TruthResult moved = result;
    const double scale = one.scale != 0.0 ? one.scale : one.truth;
    moved.measurement.mean += sign * step * scale;
    EXPECT_EQ(verdict_of(one, moved, 1.0), Verdict::fail) << sign;
  }
}

std::string name_of(const testing::TestParamInfo<std::size_t>& one) {
  return cases()[one.param].name;
}
INSTANTIATE_TEST_SUITE_P(Truths, ClosedForm, testing::Range<std::size_t>(0, cases().size()), name_of);

}  // namespace
}  // namespace plumbline::checks
