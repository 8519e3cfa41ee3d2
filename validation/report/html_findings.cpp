#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "validation/report/html_parts.hpp"
#include "validation/report/text.hpp"

namespace plumbline::report::html {
namespace {

using checks::Finding;
using checks::Verdict;

constexpr std::size_t kMostLinks = 8;

// Failures first, then the undecided.
int urgency(Verdict verdict) {
  return verdict == Verdict::fail ? 0 : verdict == Verdict::inconclusive ? 1 : 2;
}

std::string unit_of(const Finding& finding) {
  return finding.unit.empty() ? "" : " " + escape_markup(finding.unit);
}

// (measured - expected) / bound; a bound of 0 allows equality only.
double share_of_bound(const Finding& finding) {
  const double difference = finding.measured - finding.expected;
  return difference == 0.0 && finding.bound == 0.0 ? 0.0 : difference / finding.bound;
}

std::string share_text(const Finding& finding) {
  const double share = std::abs(share_of_bound(finding));
  if (!std::isfinite(share)) return std::isnan(share) ? "not a number" : "beyond any bound";
  if (share < 0.001) return share == 0.0 ? "exact" : "&lt; 0.1 % of bound";
  if (share >= 9.995) return fmt::format("{:.3g} × bound", share);
  return fmt::format("{:.{}f} % of bound", 100.0 * share, share < 0.0995 ? 1 : 0);
}

// ---------------------------------------------------------------- the bar
// In units of the bound from -kReach to kReach; what lies beyond ends in an arrow at the edge.
constexpr double kReach = 1.6;
constexpr double kHalfWidth = 90.0;
constexpr double kMiddle = 100.0;

double position(double share) {
  return kMiddle + kHalfWidth * std::clamp(share, -kReach, kReach) / kReach;
}

std::string arrow(double share) {
  const double tip = share > 0 ? kMiddle + kHalfWidth + 6 : kMiddle - kHalfWidth - 6;
  const double back = share > 0 ? tip - 8 : tip + 8;
  return fmt::format(R"(<path class="mark" d="M{0} 6L{1} 12L{0} 18Z"/>)", back, tip);
}

std::string mark(double share, double half_interval) {
  if (std::isnan(share)) return R"(<text class="mark" x="100" y="17" text-anchor="middle">NaN</text>)";
  std::string result;
  if (half_interval > 0.0) {
    result = fmt::format(R"(<path class="interval" d="M{0:.1f} 12H{1:.1f}M{0:.1f} 8V16M{1:.1f} 8V16"/>)",
                         position(share - half_interval), position(share + half_interval));
  }
  if (std::abs(share) > kReach) return result + arrow(share);
  return result + fmt::format(R"(<circle class="mark" cx="{:.1f}" cy="12" r="4"/>)", position(share));
}

// ---------------------------------------------------------------- the rows
std::string allowed(const Finding& finding) {
  const std::string centre = finding.expected == 0.0 ? "" : format_number(finding.expected) + " ";
  return centre + "± " + format_number(finding.bound) + unit_of(finding);
}

std::string small(const std::string& css_class, const std::string& text) {
  return text.empty() ? "" : fmt::format("<span class=\"{}\">{}</span>", css_class, text);
}

std::string origin(const Finding& finding) {
  std::string text = finding.source.empty() ? "" : "Bound: " + escape_markup(finding.source) + " · ";
  text += fmt::format("seed {} · {}", finding.seed, format_seconds(finding.seconds));
  return small("origin", text);
}

std::string refusal(const Finding& finding) {
  if (verdict(finding) == finding.verdict) return {};
  return small("detail", "The check said pass, but one of its numbers is not finite: counted as failed.");
}

std::string row(const Finding& finding, std::size_t index) {
  const Verdict shown = verdict(finding);
  return fmt::format(
      "<tr id=\"finding-{}\" class=\"{}\"><td>{}</td><th scope=\"row\">{}{}{}{}</th>"
      "<td class=\"number\" data-label=\"measured\">{}{}</td><td class=\"number\" "
      "data-label=\"allowed\">{}</td>"
      "<td class=\"bar\">{}{}</td></tr>\n",
      index, checks::to_string(shown), badge(shown), small("name", escape_markup(finding.name)),
      small("detail", escape_markup(finding.detail)), refusal(finding), origin(finding),
      format_interval(finding.measured, finding.uncertainty), unit_of(finding), allowed(finding),
      interval_bar(finding), small("share", share_text(finding)));
}

struct Family {
  std::string name;
  std::vector<std::size_t> members;  // indices into the findings, most urgent first
  std::size_t failed = 0;
  std::size_t undecided = 0;
};

// Most urgent family first, else in the order given.
std::vector<Family> families(const std::vector<Finding>& all) {
  std::vector<Family> result;
  for (std::size_t i = 0; i < all.size(); ++i) {
    auto family =
        std::find_if(result.begin(), result.end(), [&](const Family& f) { return f.name == all[i].family; });
    if (family == result.end()) family = result.insert(result.end(), Family{all[i].family, {}});
    family->members.push_back(i);
    family->failed += verdict(all[i]) == Verdict::fail ? 1U : 0U;
    family->undecided += verdict(all[i]) == Verdict::inconclusive ? 1U : 0U;
  }
  for (Family& family : result) {
    std::stable_sort(family.members.begin(), family.members.end(), [&](std::size_t a, std::size_t b) {
      return urgency(verdict(all[a])) < urgency(verdict(all[b]));
    });
  }
  const auto rank = [](const Family& f) { return f.failed > 0 ? 0 : f.undecided > 0 ? 1 : 2; };
  std::stable_sort(result.begin(), result.end(),
                   [&](const Family& a, const Family& b) { return rank(a) < rank(b); });
  return result;
}

std::string family_markup(const Family& family, const std::vector<Finding>& all) {
  std::string counts = fmt::format(
      "{} of {} passed", family.members.size() - family.failed - family.undecided, family.members.size());
  if (family.failed > 0) counts += fmt::format(", <strong class=\"fail\">{} failed</strong>", family.failed);
  if (family.undecided > 0) counts += fmt::format(", {} undecided", family.undecided);
  std::string rows;
  for (const std::size_t i : family.members) rows += row(all[i], i);
  return fmt::format(
      "<details class=\"family\" open><summary><span class=\"family-name\">{}</span> <span "
      "class=\"counts\">{}</span>"
      "</summary>\n<table class=\"findings\"><thead><tr><th scope=\"col\">verdict</th><th "
      "scope=\"col\">check</th>"
      "<th scope=\"col\" class=\"number\">measured</th><th scope=\"col\" class=\"number\">allowed</th>"
      "<th scope=\"col\">interval in the bound</th></tr></thead>\n<tbody>\n{}</tbody></table></details>\n",
      escape_markup(family.name), counts, rows);
}

constexpr const char* kIntroduction =
    "<p class=\"caption\">Each bar shows the measured value with its 95 % interval; the shaded band is what "
    "the bound "
    "allows, its middle line the expected value. Bounds come from arithmetic or a cited figure, never from "
    "the output.</p>\n"
    "<div class=\"controls filter\" hidden><label>Show <select><option value=\"\">all checks</option>"
    "<option value=\"fail\">failed</option><option value=\"inconclusive\">inconclusive</option>"
    "<option value=\"pass\">passed</option></select></label>"
    "<label>containing <input type=\"search\" placeholder=\"text\"></label><output></output></div>\n";

}  // namespace

std::string interval_bar(const Finding& finding) {
  const double share = share_of_bound(finding);
  const double half = finding.bound > 0.0 ? finding.uncertainty / finding.bound : 0.0;
  return fmt::format(
      "<svg viewBox=\"0 0 200 24\" class=\"{}\" role=\"img\" aria-label=\"{}\">"
      "<rect class=\"band\" x=\"{:.2f}\" y=\"3\" width=\"{:.2f}\" height=\"18\"/>"
      "<path class=\"edge\" d=\"M{:.2f} 3V21M100 3V21M{:.2f} 3V21\"/>{}</svg>",
      checks::to_string(verdict(finding)), share_text(finding), position(-1.0),
      position(1.0) - position(-1.0), position(-1.0), position(1.0), mark(share, half));
}

std::string attention(const Report& report) {
  std::string items;
  std::size_t count = 0;
  for (const Verdict wanted : {Verdict::fail, Verdict::inconclusive}) {
    for (std::size_t i = 0; i < report.findings.size(); ++i) {
      const Finding& finding = report.findings[i];
      if (verdict(finding) != wanted || ++count > kMostLinks) continue;
      items += fmt::format("<li>{} <a href=\"#finding-{}\">{}: {}</a> {}</li>\n", badge(wanted), i,
                           escape_markup(finding.family), escape_markup(finding.name),
                           small("detail", escape_markup(finding.detail)));
    }
  }
  if (items.empty()) return {};
  const std::size_t more = count > kMostLinks ? count - kMostLinks : 0;
  if (more > 0) items += fmt::format("<li><a href=\"#findings\">and {} more</a></li>\n", more);
  return section("attention", "Needs attention", "<ul class=\"attention\">\n" + items + "</ul>\n");
}

std::string findings(const Report& report) {
  std::string body;
  for (const Family& family : families(report.findings)) body += family_markup(family, report.findings);
  return body.empty() ? "" : section("findings", "Checks", kIntroduction + body);
}

}  // namespace plumbline::report::html
