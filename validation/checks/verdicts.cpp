#include "validation/checks/verdicts.hpp"

#include <fmt/format.h>

#include <cmath>

#include "validation/checks/case.hpp"

namespace plumbline::checks {
namespace {

Finding start(const Label& label) {
  Finding finding;
  finding.family = label.family;
  finding.name = label.name;
  finding.source = label.source;
  finding.detail = label.detail;
  return finding;
}

}  // namespace

std::string short_name(const std::string& path) {
  const std::size_t slash = path.find_last_of('/');
  return slash == std::string::npos ? path : path.substr(slash + 1);
}

Finding judge_error(const Label& label, double error, double bound) {
  Finding finding = start(label);
  finding.measured = error;
  finding.bound = bound;
  finding.verdict = error <= bound ? Verdict::pass : Verdict::fail;
  return finding;
}

Finding judge_deviation(const Label& label, const metrics::Estimate& deviation, double allowance,
                        double resolution, double significance) {
  constexpr double kPower = 0.9;
  Finding finding = start(label);
  finding.measured = deviation.mean;
  if (!std::isfinite(deviation.mean) || !(deviation.standard_error >= 0.0)) {
    finding.uncertainty = deviation.standard_error;
    finding.verdict = Verdict::fail;
    finding.detail += " Not a number.";
    return finding;
  }
  finding.uncertainty = metrics::two_sided_z(0.05) * deviation.standard_error;
  finding.bound = allowance + metrics::two_sided_z(significance) * deviation.standard_error;
  const double visible =
      allowance + metrics::detectable_shift(deviation.standard_error, significance, kPower);
  finding.detail += fmt::format(" Smallest deviation this test finds with probability {:.0f} %: {:.2g}.",
                                100.0 * kPower, visible);
  if (!(std::abs(deviation.mean) <= finding.bound)) {
    finding.verdict = Verdict::fail;
  } else {
    finding.verdict = visible <= resolution ? Verdict::pass : Verdict::inconclusive;
    if (finding.verdict == Verdict::inconclusive)
      finding.detail += fmt::format(" Wanted: {:.2g}. Use more samples.", resolution);
  }
  return finding;
}

Finding judge_largest_z(const Label& label, double largest_z, std::size_t count, double degrees_of_freedom,
                        double significance) {
  Finding finding = start(label);
  finding.measured = largest_z;
  if (count == 0) {
    finding.detail += " Nothing could be tested.";
    return finding;
  }
  const double each = metrics::sidak(significance, count);
  finding.bound =
      degrees_of_freedom > 0.0 ? metrics::two_sided_t(each, degrees_of_freedom) : metrics::two_sided_z(each);
  finding.unit = "standard errors";
  finding.verdict = largest_z <= finding.bound ? Verdict::pass : Verdict::fail;
  return finding;
}

}  // namespace plumbline::checks
