#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <string>
#include <string_view>

#include "validation/report/html_parts.hpp"
#include "validation/report/text.hpp"

namespace plumbline::report::html {
namespace {

using Rows = std::vector<std::vector<std::string>>;

// "0.31 % ± 0.04 %", "-3", "NaN", "1.2e-5 s": what a reader compares down a column.
bool is_numeric(std::string_view cell) {
  if (cell == "NaN" || cell == "inf" || cell == "-inf") return true;
  for (const std::string_view sign : {"+", "-", "±", "−", "<", ">", " "}) {
    if (cell.substr(0, sign.size()) == sign) cell.remove_prefix(sign.size());
  }
  return !cell.empty() && std::isdigit(static_cast<unsigned char>(cell.front())) != 0;
}

std::optional<checks::Verdict> verdict_word(std::string_view cell) {
  for (const checks::Verdict verdict :
       {checks::Verdict::pass, checks::Verdict::fail, checks::Verdict::inconclusive}) {
    if (cell == checks::to_string(verdict)) return verdict;
  }
  return std::nullopt;
}

std::string cell(const std::string& text) {
  const std::optional<checks::Verdict> word = verdict_word(text);
  const std::string content = word ? badge(*word) : escape_markup(text);
  return fmt::format("<td{}>{}</td>", is_numeric(text) ? " class=\"number\"" : "", content);
}

// A heading stands over its column: flush right where the first cell that is not empty holds a number.
std::string heading(const std::string& text, std::size_t column, const Rows& rows) {
  const auto is_filled = [&](const auto& row) { return column < row.size() && !row[column].empty(); };
  const auto first = std::find_if(rows.begin(), rows.end(), is_filled);
  const bool is_number = first != rows.end() && is_numeric((*first)[column]);
  return fmt::format("<th scope=\"col\"{}>{}</th>", is_number ? " class=\"number\"" : "",
                     escape_markup(text));
}

std::string value_at(const std::vector<double>& values, std::size_t i) {
  return i < values.size() ? format_number(values[i]) : "";
}

std::string numbers(const Chart& chart) {
  Rows rows;
  bool has_interval = false;
  for (const Series& series : chart.series) {
    has_interval = has_interval || !series.y_low.empty() || !series.y_high.empty();
    for (std::size_t i = 0; i < std::max(series.x.size(), series.y.size()); ++i) {
      rows.push_back({series.name, value_at(series.x, i), value_at(series.y, i), value_at(series.y_low, i),
                      value_at(series.y_high, i)});
    }
  }
  if (rows.empty()) return "<p class=\"note\">This chart has no points.</p>\n";
  std::vector<std::string> columns = {"series", chart.x_label, chart.y_label, "low", "high"};
  if (!has_interval) {
    columns.resize(3);
    for (std::vector<std::string>& row : rows) row.resize(3);
  }
  return "<details open><summary>Numbers</summary>\n" + table(columns, rows, chart.title) + "</details>\n";
}

std::string caption_of(const std::string& text) {
  return text.empty() ? "" : "<p class=\"caption\">" + escape_markup(text) + "</p>\n";
}

}  // namespace

std::string table(const std::vector<std::string>& columns, const Rows& rows, const std::string& name) {
  std::size_t width = columns.size();
  for (const std::vector<std::string>& row : rows) width = std::max(width, row.size());
  std::string head;
  for (std::size_t i = 0; i < width; ++i) head += heading(i < columns.size() ? columns[i] : "", i, rows);
  std::string body;
  for (const std::vector<std::string>& row : rows) {
    body += "<tr>";
    for (std::size_t i = 0; i < width; ++i) body += cell(i < row.size() ? row[i] : "");
    body += "</tr>\n";
  }
  return fmt::format(
      "<div class=\"scroll\" role=\"region\" tabindex=\"0\" "
      "aria-label=\"{}\"><table>\n<thead><tr>{}</tr></thead>\n"
      "<tbody>\n{}</tbody></table></div>\n",
      escape_attribute(name), head, body);
}

std::string charts(const Report& report) {
  std::string body;
  for (std::size_t i = 0; i < report.charts.size(); ++i) {
    const Chart& chart = report.charts[i];
    body += fmt::format(
        "<figure class=\"chart\" data-chart=\"{}\">\n<figcaption><h3>{}</h3>\n{}</figcaption>\n"
        "<div class=\"plot\"><canvas role=\"img\" aria-label=\"Chart: {}. The numbers are in the table below "
        "it.\">"
        "</canvas></div>\n<p class=\"note omitted\" hidden></p>\n{}</figure>\n",
        i, escape_markup(chart.title), caption_of(chart.caption), escape_attribute(chart.title),
        numbers(chart));
  }
  return body.empty() ? "" : section("charts", "Charts", "<div class=\"charts\">\n" + body + "</div>\n");
}

std::string tables(const Report& report) {
  std::string body;
  for (const Table& one : report.tables) {
    body += fmt::format("<div class=\"table\">\n<h3>{}</h3>\n{}{}</div>\n", escape_markup(one.title),
                        caption_of(one.caption), table(one.columns, one.rows, one.title));
  }
  return section("tables", "Tables", body);
}

}  // namespace plumbline::report::html
