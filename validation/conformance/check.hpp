// validation/conformance/check.hpp: what a conformance check is, and what all of them share.
#pragma once

#include <string>
#include <vector>

#include "validation/checks/finding.hpp"
#include "validation/conformance/subject.hpp"

namespace plumbline::conformance {

/// Decides which numbers are too far apart. There is one right one; tests put faulty ones in its place to see that
/// the catalogue of faults notices.
struct Ruler {
  /// The larger error; NaN is larger than everything and stays.
  double (*worse)(double so_far, double error);
  /// Whether an error is within its bound; NaN is not.
  bool (*accepts)(double error, double bound);
};
[[nodiscard]] const Ruler& right_ruler();

/// A finding about an operation (its family).
struct Judged {
  checks::Finding finding;
  int bands = 0;      // 0: not about a number of bands
  std::string cause;  // the likely cause; empty unless it failed
};

struct Context {
  Subject& subject;
  int bands;  // to judge at
  const Ruler& ruler;
};

using Implementation = plumbline_implementation;

struct Check {
  const char* operation;  // "project lat-long": the finding's family
  const char* name;       // "radiance 1"
  bool (*applies)(const Implementation&);
  bool needs_convention;  // compares with values in Plumbline's convention
  std::vector<Judged> (*run)(const Context&);
};
/// All, in the order of the table.
[[nodiscard]] std::vector<Check> all_checks();

[[nodiscard]] std::vector<Check> basis_checks();
[[nodiscard]] std::vector<Check> projection_checks();
[[nodiscard]] std::vector<Check> rotation_checks();
[[nodiscard]] std::vector<Check> product_checks();
[[nodiscard]] std::vector<Check> lighting_checks();
[[nodiscard]] std::vector<Check> light_checks();
[[nodiscard]] std::vector<Check> sampling_checks();
[[nodiscard]] std::vector<Check> stress_checks();

/// Runs one check. A refusal, an exception, a misuse of arrays and a convention that is needed but unknown (then
/// taken from the basis functions where there are any) become findings.
[[nodiscard]] std::vector<Judged> run_check(const Check& check, const Implementation& implementation,
                                            int bands, const Ruler& ruler = right_ruler());

// ---------------------------------------------------------------- what the checks share

/// The answer, where the contract does not let the implementation refuse. @throws Refusal
struct Refusal {
  std::string what;
};
[[nodiscard]] Values must(const Answer& answer, const char* what);

/// Vectors that should be equal.
struct Pairs {
  std::vector<Values> expected;
  std::vector<Values> measured;
  void add(Values right, Values answer) {
    expected.push_back(std::move(right));
    measured.push_back(std::move(answer));
  }
  /// Largest difference by the ruler.
  [[nodiscard]] double error(const Ruler& ruler) const;
  /// Largest expected magnitude.
  [[nodiscard]] double scale() const;
};

struct Label {
  const char* operation;
  std::string name;
  std::string source;  // where the bound comes from
  int bands = 0;
};

/// An error against its bound, with a cause that is only asked for when it failed.
[[nodiscard]] Judged judged(const Context& context, const Label& label, double error, double bound,
                            const std::string& cause);
/// Vectors of n^2 coefficients; on failure the cause comes from diagnose() with this tolerance.
[[nodiscard]] Judged judged_coefficients(const Context& context, const Label& label, const Pairs& pairs,
                                         double bound, double tolerance);
/// Single values; the cause comes from diagnose_values().
[[nodiscard]] Judged judged_values(const Context& context, const Label& label, const Pairs& pairs,
                                   double bound, double tolerance);

/// Functions of a direction, one pair for each: where the errors are within 8 degrees of the poles alone, the cause says
/// so; else as judged_coefficients().
[[nodiscard]] Judged judged_directions(const Context& context, const Label& label,
                                       const std::vector<Vec3d>& directions, const Pairs& pairs, double bound,
                                       double tolerance);

/// What rounding may do to values of n bands: 4 n^2 roundings of the largest value sqrt((2n - 1)/4 pi). n steps of a
/// recurrence with up to 3 roundings each, and the rounding of the direction, all amplified by the functions' slope,
/// at most n times their size.
[[nodiscard]] double rounding(const Context& context, int bands);

}  // namespace plumbline::conformance
