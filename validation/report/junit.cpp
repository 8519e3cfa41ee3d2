#include <fmt/format.h>

#include <cmath>
#include <string>

#include "validation/report/report.hpp"
#include "validation/report/text.hpp"

namespace plumbline::report {
namespace {

using checks::Finding;
using checks::Verdict;

std::string seconds(double value) {
  return fmt::format("{:.6f}", std::isfinite(value) && value > 0.0 ? value : 0.0);
}

std::string message(const Finding& finding) {
  const std::string expected =
      finding.expected == 0.0 ? "" : fmt::format(" from {}", format_number(finding.expected));
  const std::string unit = finding.unit.empty() ? "" : " " + finding.unit;
  return fmt::format("measured {}{}, bound {}{}{}{}", format_interval(finding.measured, finding.uncertainty),
                     unit, format_number(finding.bound), unit, expected,
                     finding.detail.empty() ? "" : ": " + finding.detail);
}

std::string origin(const Finding& finding) {
  return fmt::format("bound from: {}\nseed: {}\n", finding.source, finding.seed);
}

std::string test_case(const Finding& finding) {
  const std::string head =
      fmt::format(R"(    <testcase classname="{}" name="{}" time="{}")", escape_attribute(finding.family),
                  escape_attribute(finding.name), seconds(finding.seconds));
  const std::string attribute = escape_attribute(message(finding));
  switch (verdict(finding)) {
    case Verdict::pass:
      return head + "/>\n";
    case Verdict::fail:
      return fmt::format("{}>\n      <failure message=\"{}\">{}</failure>\n    </testcase>\n", head,
                         attribute, escape_markup(origin(finding)));
    case Verdict::inconclusive:
      break;
  }
  return fmt::format("{}>\n      <skipped message=\"inconclusive: {}\"/>\n    </testcase>\n", head,
                     attribute);
}

}  // namespace

std::string to_junit(const Report& report) {
  std::size_t failures = 0;
  std::size_t skipped = 0;
  double total = 0.0;
  std::string cases;
  for (const Finding& finding : report.findings) {
    failures += verdict(finding) == Verdict::fail ? 1U : 0U;
    skipped += verdict(finding) == Verdict::inconclusive ? 1U : 0U;
    if (std::isfinite(finding.seconds)) total += finding.seconds;
    cases += test_case(finding);
  }
  const std::string counts =
      fmt::format(R"(name="{}" tests="{}" failures="{}" errors="0" skipped="{}" time="{}")",
                  escape_attribute(report.title), report.findings.size(), failures, skipped, seconds(total));
  return fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites {0}>\n  <testsuite {0}>\n{1}  </testsuite>\n"
      "</testsuites>\n",
      counts, cases);
}

}  // namespace plumbline::report
