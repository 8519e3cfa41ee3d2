// validation/conformance/faults/transport_faults.hpp: known mistakes of light transport, each as a small baker that makes
// it, for the checks of validation/checks/bounces.hpp. Written anew from descriptions of defects in public code and published
// listings; they describe snapshots, not today's versions of what is named.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "validation/checks/bounces.hpp"

namespace plumbline::conformance {

struct TransportFault {
  std::string name;   // "T27", unique
  std::string wrong;  // what is wrong
  std::string check;  // how the name of the finding begins that must reject it
  checks::TermsBaker baker;
};

/// The plain baker that the faults are planted in: random walks, nothing else. The checks must pass it.
[[nodiscard]] checks::TermsBaker plain_terms();
[[nodiscard]] std::vector<TransportFault> seeded_transport_faults();

/// What a baker is held against: every case of the family that fits a test, traced once.
struct TransportTrial {
  std::vector<checks::BounceCase> cases;
  checks::TermsEffort effort;
  checks::TermsEffort corner_effort;
  checks::Budget budget;
};
[[nodiscard]] TransportTrial prepare_trial(const checks::Budget& budget);
/// All findings of one baker.
[[nodiscard]] std::vector<checks::Finding> run_trial(const TransportTrial& trial,
                                                     const checks::TermsBaker& baker);

}  // namespace plumbline::conformance
