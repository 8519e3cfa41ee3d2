#include "validation/report/report.hpp"

namespace plumbline::report {

checks::Verdict verdict(const Report& report) {
  bool is_unsure = report.findings.empty();
  for (const checks::Finding& finding : report.findings) {
    if (finding.verdict == checks::Verdict::fail) return checks::Verdict::fail;
    if (finding.verdict == checks::Verdict::inconclusive) is_unsure = true;
  }
  return is_unsure ? checks::Verdict::inconclusive : checks::Verdict::pass;
}

}  // namespace plumbline::report
