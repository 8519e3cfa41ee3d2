#include <fmt/format.h>

#include <map>
#include <string>
#include <string_view>

#include "validation/report/assets.hpp"
#include "validation/report/html_parts.hpp"
#include "validation/report/report.hpp"
#include "validation/report/text.hpp"

namespace plumbline::report {
namespace html {

std::string badge(checks::Verdict verdict) {
  const char* symbol = verdict == checks::Verdict::pass ? "✓" : verdict == checks::Verdict::fail ? "✕" : "?";
  const char* word = checks::to_string(verdict);
  return fmt::format(R"(<span class="badge {0}"><span aria-hidden="true">{1}</span> {0}</span>)", word,
                     symbol);
}

std::string section(const std::string& anchor, const std::string& heading, const std::string& body) {
  if (body.empty()) return {};
  return fmt::format(
      "<section id=\"{0}\" aria-labelledby=\"{0}-heading\">\n<h2 "
      "id=\"{0}-heading\">{1}</h2>\n{2}</section>\n",
      anchor, heading, body);
}

}  // namespace html

namespace {

using Parts = std::map<std::string, std::string, std::less<>>;

// Replaces each {{name}} once; what is put in is not searched again, so that no text can name a part.
std::string fill(std::string_view page, const Parts& parts) {
  std::string result;
  for (;;) {
    const std::size_t open = page.find("{{");
    const std::size_t close = open == std::string_view::npos ? open : page.find("}}", open);
    if (close == std::string_view::npos) return result.append(page);
    result.append(page.substr(0, open))
        .append(parts.at(std::string(page.substr(open + 2, close - open - 2))));
    page.remove_prefix(close + 2);
  }
}

// JSON inside a script element must not hold "</script>" or "<!--".
std::string for_script(const nlohmann::json& value) {
  std::string result;
  for (const char c : value.dump()) c == '<' ? void(result.append("\\u003c")) : result.push_back(c);
  return result;
}

std::string paragraph(const std::string& css_class, const std::string& text) {
  return text.empty() ? "" : fmt::format("<p class=\"{}\">{}</p>\n", css_class, escape_markup(text));
}

std::string verdict_line(const Report& report) {
  std::size_t failed = 0;
  std::size_t undecided = 0;
  for (const checks::Finding& finding : report.findings) {
    failed += verdict(finding) == checks::Verdict::fail ? 1U : 0U;
    undecided += verdict(finding) == checks::Verdict::inconclusive ? 1U : 0U;
  }
  const std::size_t all = report.findings.size();
  std::string text = fmt::format("{} of {} checks within their bounds", all - failed - undecided, all);
  if (failed > 0) text += fmt::format(", {} failed", failed);
  if (undecided > 0) text += fmt::format(", {} could not be decided", undecided);
  if (all == 0) text = "nothing was checked";
  return fmt::format("<p class=\"verdict-line\">{} <span>{}</span></p>", html::badge(verdict(report)), text);
}

std::string headlines(const Report& report) {
  std::string cards;
  for (const Headline& headline : report.headlines) {
    cards += "<div class=\"card\">\n" + paragraph("label", headline.label) +
             paragraph("value", headline.value) + paragraph("caption", headline.caption) + "</div>\n";
  }
  return cards.empty()
             ? ""
             : html::section("headlines", "At a glance", "<div class=\"cards\">\n" + cards + "</div>\n");
}

template <class Pairs>
std::string definitions(const std::string& heading, const Pairs& pairs) {
  std::string rows;
  for (const auto& [name, value] : pairs) {
    rows += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", escape_markup(name), escape_markup(value));
  }
  return rows.empty() ? ""
                      : fmt::format("<div class=\"facts\"><h3>{}</h3>\n<dl>\n{}</dl></div>\n", heading, rows);
}

std::string provenance(const Report& report) {
  std::string body = definitions("Settings", report.settings) + definitions("Machine", report.machine);
  if (!body.empty()) body = "<div class=\"fact-columns\">\n" + body + "</div>\n";
  if (!report.command.empty()) {
    body += "<h3>Reproduce</h3>\n<div class=\"command\"><pre tabindex=\"0\"><code>" +
            escape_markup(report.command) +
            "</code></pre><button type=\"button\" data-copy hidden>Copy</button></div>\n";
  }
  body +=
      "<p class=\"controls\" data-save hidden><button type=\"button\">Save the numbers as "
      "JSON</button></p>\n";
  return html::section("provenance", "How this was made", body);
}

std::string contents(const Parts& parts) {
  constexpr std::pair<const char*, const char*> kEntries[] = {
      {"galleries", "Images"}, {"forests", "Intervals"}, {"charts", "Charts"},
      {"tables", "Tables"},    {"findings", "Checks"},   {"provenance", "Settings"}};
  std::string links;
  for (const auto& [part, word] : kEntries) {
    if (!parts.at(part).empty()) links += fmt::format("<a href=\"#{}\">{}</a>\n", part, word);
  }
  return "<nav aria-label=\"Contents\">\n" + links + "</nav>";
}

std::string footer(const Report& report) {
  const std::string separator = report.date.empty() || report.version.empty() ? "" : " · ";
  const std::string version = report.version.empty() ? "" : "Plumbline " + escape_markup(report.version);
  return version + separator + escape_markup(report.date);
}

}  // namespace

std::string to_html(const Report& report) {
  Parts parts = {{"title", escape_markup(report.title)},
                 {"version", escape_attribute(report.version)},
                 {"css", std::string(assets::page_css())},
                 {"js", std::string(assets::page_js())},
                 {"chart_js", std::string(assets::chart_js())},
                 {"chart_js_licence", std::string(assets::chart_js_licence())},
                 {"json", for_script(to_json(report))},
                 {"verdict", verdict_line(report)},
                 {"summary", paragraph("summary", report.summary)},
                 {"attention", html::attention(report)},
                 {"headlines", headlines(report)},
                 {"galleries", html::galleries(report)},
                 {"forests", html::forests(report)},
                 {"charts", html::charts(report)},
                 {"tables", html::tables(report)},
                 {"findings", html::findings(report)},
                 {"provenance", provenance(report)},
                 {"footer", footer(report)}};
  parts["contents"] = contents(parts);
  return fill(assets::page_html(), parts);
}

}  // namespace plumbline::report
