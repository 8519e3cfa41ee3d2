// validation/checks/finding.hpp: what a check returns.
#pragma once

#include <cstdint>
#include <string>

namespace plumbline::checks {

enum class Verdict { pass, fail, inconclusive };

[[nodiscard]] constexpr const char* to_string(Verdict verdict) {
  return verdict == Verdict::pass ? "pass" : verdict == Verdict::fail ? "fail" : "inconclusive";
}

/// A failed check is data. `bound` comes from arithmetic or a cited figure (said in `source`), never from the
/// output.
struct Finding {
  std::string family;  // "gram-matrix", "projection", "transfer", "image", ...
  std::string name;    // "<case> / <quantity>", unique within the family
  double measured = 0.0;
  double uncertainty = 0.0;  // half width of the 95 % interval; 0 = deterministic
  double bound = 0.0;        // |measured - expected| or measured is held against this
  double expected = 0.0;     // 0 when `measured` is itself an error
  std::string unit;          // "" for pure numbers
  Verdict verdict = Verdict::inconclusive;
  std::string source;  // where the bound comes from, one line
  std::string detail;  // what to read off it, one line
  double seconds = 0.0;
  std::uint64_t seed = 0;
};

}  // namespace plumbline::checks
