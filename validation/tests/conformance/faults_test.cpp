// Every seeded fault is caught and named; the right implementation passes; a judge with a fault of its own is noticed.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "validation/conformance/adapters/plumbline_sh.hpp"
#include "validation/conformance/faults/catalogue.hpp"

namespace plumbline::conformance {
namespace {

constexpr int kBands = 6;

std::string told(const std::vector<Judged>& results) {
  std::string text;
  for (const Judged& r : results)
    text += r.finding.family + ": " + r.finding.name + ": " + std::to_string(r.finding.measured) + ": " +
            r.cause + "\n";
  return text;
}

TEST(Conformance, OurOwnLibraryPassesEveryCheck) {
  for (const int bands : {1, 2, 3, kBands}) {
    for (const Check& check : all_checks()) {
      ASSERT_TRUE(check.applies(plumbline_sh())) << check.operation << ": we offer every operation";
      for (const Judged& result : run_check(check, plumbline_sh(), bands))
        EXPECT_EQ(result.finding.verdict, checks::Verdict::pass) << bands << " bands: " << told({result});
    }
  }
}

TEST(SeededFaults, EachIsCaughtByTheExpectedCheckWithTheExpectedCause) {
  std::set<std::string> names;
  for (const Fault& fault : all_faults()) {
    EXPECT_TRUE(names.insert(fault.name).second) << fault.name << " is there twice";
    const Kill kill = judge_fault(fault, kBands);
    EXPECT_TRUE(kill.is_caught) << fault.name << " (" << fault.wrong << ") survives";
    EXPECT_TRUE(kill.is_named) << fault.name << " (" << fault.wrong << "): expected " << fault.check
                               << " to say '" << fault.cause << "'\n"
                               << told(kill.failures);
  }
  EXPECT_GE(names.size(), 80U);
}

Fault fault_named(const std::string& name) {
  for (const Fault& fault : all_faults())
    if (name == fault.name) return fault;
  ADD_FAILURE() << "no fault " << name;
  return {};
}

// A judge whose comparisons are false for NaN lets a NaN through, and the catalogue shows it by a survivor.
TEST(JudgeMutants, AComparisonBlindToNanLetsAFaultSurvive) {
  constexpr Ruler kBlind{[](double so_far, double error) { return error > so_far ? error : so_far; },
                         [](double error, double bound) { return !(error > bound); }};
  const Fault fault = fault_named("NAN");
  EXPECT_TRUE(judge_fault(fault, kBands).is_named);
  EXPECT_FALSE(judge_fault(fault, kBands, kBlind).is_caught);
}

TEST(JudgeMutants, AMetricThatSkipsInfinityLetsAFaultSurvive) {
  constexpr Ruler kSkips{
      [](double so_far, double error) { return std::isinf(error) || error <= so_far ? so_far : error; },
      [](double error, double bound) { return error <= bound; }};
  const Fault fault = fault_named("M23");
  EXPECT_TRUE(judge_fault(fault, kBands).is_named);
  EXPECT_FALSE(judge_fault(fault, kBands, kSkips).is_caught);
}

TEST(JudgeMutants, AJudgeThatAcceptsEverythingKillsNothing) {
  constexpr Ruler kYes{[](double, double) { return 0.0; }, [](double, double) { return true; }};
  EXPECT_FALSE(judge_fault(fault_named("M4"), kBands, kYes).is_caught);
}

TEST(Ruler, NanIsTheLargestErrorAndNeverAccepted) {
  const Ruler& ruler = right_ruler();
  EXPECT_TRUE(std::isnan(ruler.worse(1.0, std::nan(""))));
  EXPECT_TRUE(std::isnan(ruler.worse(std::nan(""), 1.0)));
  EXPECT_EQ(ruler.worse(1.0, 2.0), 2.0);
  EXPECT_EQ(ruler.worse(2.0, 1.0), 2.0);
  EXPECT_FALSE(ruler.accepts(std::nan(""), 1.0));
  EXPECT_FALSE(ruler.accepts(HUGE_VAL, 1.0));
  EXPECT_TRUE(ruler.accepts(1.0, 1.0));
}

}  // namespace
}  // namespace plumbline::conformance
