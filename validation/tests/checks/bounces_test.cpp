// The family "bounces": our bakers pass, a plain one passes, and every seeded mistake of light transport is caught.
#include "validation/checks/bounces.hpp"

#include <gtest/gtest.h>

#include <set>

#include "validation/conformance/faults/transport_faults.hpp"

namespace plumbline::conformance {
namespace {

checks::Budget budget() {
  checks::Budget result;
  result.seed = 3;
  return result;
}

const TransportTrial& trial() {
  static const TransportTrial kTrial = prepare_trial(budget());
  return kTrial;
}

std::string told(const checks::Finding& finding) {
  return finding.name + ": " + checks::to_string(finding.verdict) + " " + std::to_string(finding.measured) +
         " +- " + std::to_string(finding.uncertainty) + " against " + std::to_string(finding.bound) + ". " +
         finding.detail;
}

// At a test's few samples a check may be unable to tell; it may not say that something is wrong.
void expect_nothing_wrong(const checks::TermsBaker& baker) {
  std::size_t passed = 0;
  for (const checks::Finding& finding : run_trial(trial(), baker)) {
    EXPECT_NE(finding.verdict, checks::Verdict::fail) << told(finding);
    if (finding.verdict == checks::Verdict::pass) ++passed;
  }
  EXPECT_GE(passed, 10U) << baker.name;
}

TEST(Bounces, OurWalksPass) {
  expect_nothing_wrong(checks::traced_terms());
}

TEST(Bounces, PlainWalksPass) {
  expect_nothing_wrong(plain_terms());
}

TEST(Bounces, EveryTransportFaultIsCaughtByTheNamedCheck) {
  std::set<std::string> names;
  for (const TransportFault& fault : seeded_transport_faults()) {
    EXPECT_TRUE(names.insert(fault.name).second) << fault.name << " is there twice";
    std::string caught;
    bool is_named = false;
    for (const checks::Finding& finding : run_trial(trial(), fault.baker)) {
      if (finding.verdict != checks::Verdict::fail) continue;
      caught += finding.name + "\n";
      is_named = is_named || finding.name.starts_with(fault.check);
    }
    EXPECT_TRUE(is_named) << fault.name << " (" << fault.wrong << "): expected " << fault.check
                          << "; caught by\n"
                          << caught;
  }
  EXPECT_GE(names.size(), 18U);
}

}  // namespace
}  // namespace plumbline::conformance
