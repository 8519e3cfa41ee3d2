#include "validation/report/report.hpp"

#include <cmath>

namespace plumbline::report {

checks::Verdict verdict(const checks::Finding& finding) {
  const bool is_number = std::isfinite(finding.measured) && !std::isnan(finding.uncertainty) &&
                         !std::isnan(finding.bound) && !std::isnan(finding.expected);
  return finding.verdict == checks::Verdict::pass && !is_number ? checks::Verdict::fail : finding.verdict;
}

checks::Verdict verdict(const Report& report) {
  bool is_unsure = report.findings.empty();
  for (const checks::Finding& finding : report.findings) {
    const checks::Verdict one = verdict(finding);
    if (one == checks::Verdict::fail) return one;
    if (one == checks::Verdict::inconclusive) is_unsure = true;
  }
  return is_unsure ? checks::Verdict::inconclusive : checks::Verdict::pass;
}

}  // namespace plumbline::report
