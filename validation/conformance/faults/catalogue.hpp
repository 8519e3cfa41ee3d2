// validation/conformance/faults/catalogue.hpp: known mistakes, each as a small faulty implementation.
// Written anew from descriptions of defects in public code, published listings and issue reports; they describe
// snapshots, not today's versions of what is named.
#pragma once

#include <string>
#include <vector>

#include "validation/conformance/check.hpp"

namespace plumbline::conformance {

struct Fault {
  const char* name;   // "M4", unique
  const char* seen;   // where it was
  const char* wrong;  // what is wrong
  const char* check;  // "operation: check" that must reject it (the beginning of the finding's name)
  const char* cause;  // what the diagnosis must contain
  plumbline_implementation implementation;  // ours with one function replaced
};
/// Faults that run and return. The first is none: our own implementation would be `plumbline_sh()`.
[[nodiscard]] std::vector<Fault> all_faults();

[[nodiscard]] std::vector<Fault> basis_faults();
[[nodiscard]] std::vector<Fault> projection_faults();
[[nodiscard]] std::vector<Fault> operation_faults();
[[nodiscard]] std::vector<Fault> lighting_faults();
[[nodiscard]] std::vector<Fault> statistics_faults();

/// Mistakes of light transport: they need scenes, bounces or visibility and are judged elsewhere, not here.
struct UnjudgedFault {
  const char* name;
  const char* wrong;
};
[[nodiscard]] const std::vector<UnjudgedFault>& transport_faults();

/// One fault under every check.
struct Kill {
  const Fault* fault;
  std::vector<Judged> failures;  // findings that reject it
  bool is_caught = false;        // by any check
  bool is_named = false;         // by the expected check with the expected cause
};
[[nodiscard]] Kill judge_fault(const Fault& fault, int bands, const Ruler& ruler = right_ruler());

}  // namespace plumbline::conformance
