#include "validation/conformance/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>

#include "validation/checks/sh_checks.hpp"
#include "validation/conformance/diagnosis.hpp"

namespace plumbline::conformance {
namespace {

Judged failed(const Check& check, const std::string& name, const std::string& cause) {
  Judged result;
  result.finding.family = check.operation;
  result.finding.name = name;
  result.finding.measured = std::numeric_limits<double>::quiet_NaN();
  result.finding.verdict = checks::Verdict::fail;
  result.finding.source = "Contract of the interface";
  result.finding.detail = cause;
  result.cause = cause;
  return result;
}

Judged skipped(const Check& check, const std::string& reason) {
  Judged result = failed(check, check.name, "");
  result.finding.measured = 0.0;
  result.finding.verdict = checks::Verdict::inconclusive;
  result.finding.detail = reason;
  return result;
}

/// The declared convention, its unknown parts taken from the basis functions.
plumbline_convention completed_convention(const Implementation& implementation) {
  plumbline_convention declared = implementation.convention;
  if (Border(declared, 1).knows_basis() || implementation.evaluate_basis == nullptr ||
      implementation.max_bands < 3)
    return declared;
  plumbline_convention plain = own_convention();
  Subject subject(implementation, plain);
  const std::vector<Vec3d> directions = checks::probe_directions();
  const Answer values = subject.basis(3, directions);
  const auto found = values ? convention_of_basis(directions, *values) : std::nullopt;
  if (!found) return declared;
  const plumbline_convention asked = declared;
  declared = *found;
  declared.quantity = asked.quantity;
  declared.layout = asked.layout;
  return declared;
}

void append_misdeeds(const Check& check, const Subject& subject, std::vector<Judged>& results) {
  for (const std::string& misdeed : subject.misdeeds())
    results.push_back(failed(check, fmt::format("{} / arrays", check.name), misdeed));
}

}  // namespace

const Ruler& right_ruler() {
  static constexpr Ruler kRuler{
      [](double so_far, double error) {
        return std::isnan(so_far) || so_far >= error ? so_far : error;  // a NaN error is neither: taken
      },
      [](double error, double bound) { return error <= bound; }};
  return kRuler;
}

std::vector<Check> all_checks() {
  std::vector<Check> all;
  for (const auto part : {basis_checks, projection_checks, rotation_checks, product_checks, lighting_checks,
                          light_checks, sampling_checks, stress_checks}) {
    const std::vector<Check> checks = part();
    all.insert(all.end(), checks.begin(), checks.end());
  }
  return all;
}

std::vector<Judged> run_check(const Check& check, const Implementation& implementation, int bands,
                              const Ruler& ruler) {
  std::vector<Judged> results;
  try {
    const plumbline_convention convention = completed_convention(implementation);
    Subject subject(implementation, convention);
    const bool is_known = subject.border().knows_basis() &&
                          (convention.quantity != 0 || std::string(check.operation) == "evaluate basis");
    if (check.needs_convention && !is_known)
      return {skipped(check,
                      "needs the convention, which was not declared and could not be told from the basis: " +
                          to_string(convention))};
    const int usable =
        subject.border().usable_bands(std::clamp(bands, 1, std::max(1, implementation.max_bands)));
    try {
      results = check.run({subject, usable, ruler});
    } catch (const Refusal& refusal) {
      results.push_back(failed(check, check.name, refusal.what));
    }
    append_misdeeds(check, subject, results);
  } catch (const std::exception& error) {
    results.push_back(failed(check, check.name, std::string("throws an exception: ") + error.what()));
  } catch (...) {
    results.push_back(failed(check, check.name, "throws an exception"));
  }
  return results;
}

Values must(const Answer& answer, const char* what) {
  if (!answer) throw Refusal{fmt::format("refuses {}", what)};
  return *answer;
}

double Pairs::error(const Ruler& ruler) const {
  double result = 0.0;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    if (measured[k].size() != expected[k].size()) return std::numeric_limits<double>::quiet_NaN();
    for (std::size_t i = 0; i < expected[k].size(); ++i)
      result = ruler.worse(result, std::abs(measured[k][i] - expected[k][i]));
  }
  return result;
}

double Pairs::scale() const {
  double result = 0.0;
  for (const Values& v : expected)
    for (const double x : v) result = std::max(result, std::abs(x));
  return result;
}

Judged judged(const Context& context, const Label& label, double error, double bound,
              const std::string& cause) {
  Judged result;
  result.bands = label.bands;
  result.finding.family = label.operation;
  result.finding.name = label.bands > 0 ? fmt::format("{} / {} bands", label.name, label.bands) : label.name;
  result.finding.measured = error;
  result.finding.bound = bound;
  result.finding.source = label.source;
  const bool is_good = context.ruler.accepts(error, bound);
  result.finding.verdict = is_good ? checks::Verdict::pass : checks::Verdict::fail;
  if (!is_good) result.cause = result.finding.detail = cause;
  return result;
}

Judged judged_coefficients(const Context& context, const Label& label, const Pairs& pairs, double bound,
                           double tolerance) {
  const double error = pairs.error(context.ruler);
  const std::string cause = context.ruler.accepts(error, bound)
                                ? ""
                                : diagnose({label.bands, pairs.expected, pairs.measured, tolerance});
  return judged(context, label, error, bound, cause);
}

Judged judged_values(const Context& context, const Label& label, const Pairs& pairs, double bound,
                     double tolerance) {
  Values expected;
  Values measured;
  for (std::size_t k = 0; k < pairs.expected.size(); ++k) {
    expected.insert(expected.end(), pairs.expected[k].begin(), pairs.expected[k].end());
    measured.insert(measured.end(), pairs.measured[k].begin(), pairs.measured[k].end());
  }
  const double error = pairs.error(context.ruler);
  const std::string cause =
      context.ruler.accepts(error, bound) ? "" : diagnose_values(expected, measured, tolerance);
  return judged(context, label, error, bound, cause);
}

Judged judged_directions(const Context& context, const Label& label, const std::vector<Vec3d>& directions,
                         const Pairs& pairs, double bound, double tolerance) {
  Judged result = judged_coefficients(context, label, pairs, bound, tolerance);
  if (result.finding.verdict == checks::Verdict::pass || !std::isfinite(result.finding.measured))
    return result;
  constexpr double kNearPole = 0.99;
  Pairs elsewhere;
  for (std::size_t k = 0; k < directions.size(); ++k)
    if (std::abs(directions[k].z) < kNearPole) elsewhere.add(pairs.expected[k], pairs.measured[k]);
  if (!context.ruler.accepts(elsewhere.error(context.ruler), bound)) return result;
  result.cause =
      fmt::format("digits are lost near the poles and only there: error {:.2g}", result.finding.measured);
  result.finding.detail = result.cause;
  return result;
}

double rounding(const Context& context, int bands) {
  return 4.0 * bands * bands * std::sqrt((2.0 * bands - 1.0) / (4.0 * kPi)) * context.subject.epsilon();
}

}  // namespace plumbline::conformance
