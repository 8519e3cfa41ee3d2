#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "validation/report/html_parts.hpp"
#include "validation/report/text.hpp"

namespace plumbline::report::html {
namespace {

// One picture a row, all on one axis: rows stay text, and lines up with its picture at any width.
constexpr double kReach = 1.6;  // of the band
constexpr double kMiddle = 150.0;
constexpr double kHalfWidth = 140.0;

double position(const Forest& forest, double value) {
  return kMiddle + kHalfWidth * std::clamp(value / forest.band, -kReach, kReach) / kReach;
}

bool is_outside(const Forest& forest, double value) {
  return !(std::abs(value) <= kReach * forest.band);
}

std::string arrow(double x, double direction) {
  return fmt::format(R"(<path class="mark" d="M{0:.1f} 5L{1:.1f} 10L{0:.1f} 15Z"/>)", x - 6.0 * direction, x);
}

std::string mark(const Forest& forest, const Forest::Row& row) {
  if (!std::isfinite(row.value))
    return R"(<text class="mark" x="150" y="15" text-anchor="middle">NaN</text>)";
  std::string result;
  if (std::isfinite(row.low) && std::isfinite(row.high) && row.high > row.low) {
    result = fmt::format(R"(<path class="interval" d="M{0:.2f} 10H{1:.2f}M{0:.2f} 6V14M{1:.2f} 6V14"/>)",
                         position(forest, row.low), position(forest, row.high));
  }
  if (is_outside(forest, row.value))
    return result + arrow(position(forest, row.value), row.value > 0.0 ? 1.0 : -1.0);
  return result +
         fmt::format(R"(<circle class="mark" cx="{:.2f}" cy="10" r="3"/>)", position(forest, row.value));
}

std::string picture(const Forest& forest, const Forest::Row& row) {
  const double low = position(forest, -forest.band);
  const double high = position(forest, forest.band);
  return fmt::format(
      "<svg viewBox=\"0 0 300 20\" class=\"{}\" aria-hidden=\"true\"><rect class=\"band\" x=\"{:.2f}\" "
      "y=\"0\" "
      "width=\"{:.2f}\" height=\"20\"/><path class=\"edge\" d=\"M{:.2f} 0V20M150 0V20M{:.2f} "
      "0V20\"/>{}</svg>",
      checks::to_string(row.verdict), low, high - low, low, high, mark(forest, row));
}

std::string axis(const Forest& forest) {
  std::string ticks;
  for (const double share : {-1.0, 0.0, 1.0}) {
    const std::string sign = share > 0.0 ? "+" : "";
    ticks += fmt::format(R"(<text x="{:.2f}" y="13" text-anchor="middle">{}{} {}</text>)",
                         position(forest, share * forest.band), sign, format_number(share * forest.band),
                         escape_markup(forest.unit));
  }
  return "<svg viewBox=\"0 0 300 18\" class=\"axis\" aria-hidden=\"true\">" + ticks + "</svg>";
}

std::string row_markup(const Forest& forest, const Forest::Row& row) {
  return fmt::format(
      "<tr><th scope=\"row\">{}</th><td class=\"bar\">{}</td><td class=\"number\">{} "
      "{}</td><td>{}</td></tr>\n",
      escape_markup(row.name), picture(forest, row), format_interval(row.value, 0.5 * (row.high - row.low)),
      escape_markup(forest.unit), badge(row.verdict));
}

}  // namespace

std::string forests(const Report& report) {
  std::string body;
  for (const Forest& forest : report.forests) {
    std::string rows;
    for (const Forest::Row& row : forest.rows) rows += row_markup(forest, row);
    const std::string caption =
        forest.caption.empty() ? "" : "<p class=\"caption\">" + escape_markup(forest.caption) + "</p>\n";
    body += fmt::format(
        "<div class=\"table forest\">\n<h3>{}</h3>\n{}<table><thead><tr><th scope=\"col\">case</th>"
        "<th scope=\"col\">{}</th><th scope=\"col\" class=\"number\">measured</th><th "
        "scope=\"col\">verdict</th>"
        "</tr></thead>\n<tbody>\n{}</tbody></table></div>\n",
        escape_markup(forest.title), caption, axis(forest), rows);
  }
  return section("forests", "Intervals", body);
}

}  // namespace plumbline::report::html
