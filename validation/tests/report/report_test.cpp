#include "validation/report/report.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <regex>

#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "validation/report/html_parts.hpp"
#include "validation/tests/report/sample_report.hpp"

namespace plumbline::report {
namespace {

using checks::Finding;
using checks::Verdict;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr const char* kHostile = "<script>alert('x')</script>&\"{{json}}\x01\xFF";

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t result = 0;
  for (std::size_t i = text.find(part); i != std::string::npos; i = text.find(part, i + part.size()))
    ++result;
  return result;
}

Finding finding(Verdict verdict, double measured = 0.5) {
  return {"family", "case / quantity", measured, 0.1, 1.0, 0.0, "", verdict, "source", "detail", 0.25, 7};
}

Report with(std::vector<Finding> findings) {
  Report report;
  report.title = "title";
  report.findings = std::move(findings);
  return report;
}

Report hostile() {
  Report report = with({finding(Verdict::fail)});
  report.title = report.summary = report.date = report.version = report.command = kHostile;
  report.machine = {{kHostile, kHostile}};
  report.settings = {{kHostile, kHostile}};
  report.headlines = {{kHostile, kHostile, kHostile}};
  const image::Image8 dot{1, 1, {1, 2, 3}};
  report.galleries = {
      {kHostile, kHostile, {{kHostile, image::make_image(1, 1)}}, {{kHostile, dot, 1.0, kHostile, dot}}}};
  report.charts = {{kHostile, kHostile, kHostile, kHostile, false, false, {{kHostile, {1}, {1}, {}, {}}}}};
  report.tables = {{kHostile, kHostile, {kHostile}, {{kHostile}}}};
  report.data = {{kHostile, kHostile}};
  Finding& one = report.findings.front();
  one.family = one.name = one.unit = one.source = one.detail = kHostile;
  return report;
}

// A minimal check of well-formedness: tags nest and close, attributes are quoted, no bare & or <.
std::string xml_fault(const std::string& xml) {
  static const std::regex tag(
      R"(^<(/?)([A-Za-z]+)((?:\s+[A-Za-z]+="(?:[^<&"]|&(?:#\d+|amp|lt|gt|quot);)*")*)(/?)>)");
  static const std::regex text(R"(^(?:[^<&]|&(?:#\d+|amp|lt|gt|quot);)+)");
  std::vector<std::string> open;
  auto at = xml.cbegin() + static_cast<std::ptrdiff_t>(xml.find("?>") + 2);
  for (std::smatch match; at != xml.cend(); at += match.length()) {
    if (std::regex_search(at, xml.cend(), match, text)) continue;
    if (!std::regex_search(at, xml.cend(), match, tag))
      return "near: " + std::string(at, std::min(at + 40, xml.cend()));
    if (match[1].length() == 0 && match[4].length() == 0) open.push_back(match[2]);
    if (match[1].length() == 0) continue;
    if (open.empty() || open.back() != match[2]) return "closes: " + match[2].str();
    open.pop_back();
  }
  return open.empty() ? "" : "left open: " + open.back();
}

// ---------------------------------------------------------------- verdict
TEST(Report, WithoutFindingsIsInconclusive) {
  EXPECT_EQ(verdict(Report{}), Verdict::inconclusive);
  EXPECT_TRUE(contains(to_html(Report{}), "nothing was checked"));
}

TEST(Report, OneFailureOutweighsTheRest) {
  EXPECT_EQ(verdict(with({finding(Verdict::pass)})), Verdict::pass);
  EXPECT_EQ(verdict(with({finding(Verdict::pass), finding(Verdict::inconclusive)})), Verdict::inconclusive);
  EXPECT_EQ(verdict(with({finding(Verdict::inconclusive), finding(Verdict::fail), finding(Verdict::pass)})),
            Verdict::fail);
}

TEST(Report, APassWithoutNumbersIsAFailure) {
  for (const double broken : {kNaN, kInf, -kInf})
    EXPECT_EQ(verdict(finding(Verdict::pass, broken)), Verdict::fail);
  Finding no_bound = finding(Verdict::pass);
  no_bound.bound = kNaN;
  EXPECT_EQ(verdict(no_bound), Verdict::fail);
  EXPECT_EQ(verdict(finding(Verdict::inconclusive, kNaN)), Verdict::inconclusive);
  EXPECT_EQ(verdict(with({finding(Verdict::pass), finding(Verdict::pass, kNaN)})), Verdict::fail);
}

// ---------------------------------------------------------------- JSON
TEST(ReportJson, HoldsEveryPartAndSurvivesARoundTrip) {
  const nlohmann::json json = nlohmann::json::parse(to_json(sample_report()).dump());
  for (const char* key : {"title", "summary", "verdict", "date", "version", "command", "machine", "settings",
                          "headlines", "galleries", "charts", "tables", "findings", "data"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
  EXPECT_EQ(json["verdict"], "fail");
  EXPECT_EQ(json["settings"]["seed"], "17");
  EXPECT_EQ(json["findings"].size(), 12U);
  EXPECT_EQ(json["charts"][0]["series"][2]["is_reference"], true);
  EXPECT_EQ(json["galleries"][0]["errors"][0]["scale"], 0.5);
  EXPECT_FALSE(contains(json.dump(), "base64"));
}

TEST(ReportJson, FindingsKeepAllTheirNumbers) {
  const nlohmann::json json = to_json(with({finding(Verdict::pass)}))["findings"][0];
  const nlohmann::json expected = {
      {"family", "family"}, {"name", "case / quantity"}, {"measured", 0.5}, {"uncertainty", 0.1},
      {"bound", 1.0},       {"expected", 0.0},           {"unit", ""},      {"verdict", "pass"},
      {"source", "source"}, {"detail", "detail"},        {"seconds", 0.25}, {"seed", 7}};
  EXPECT_EQ(json, expected);
}

TEST(ReportJson, NonFiniteNumbersAreWordsEverywhere) {
  Report report = with({finding(Verdict::pass, kNaN)});
  report.charts = {{"t", "", "x", "y", false, false, {{"s", {1, 2}, {kInf, -kInf}, {}, {}}}}};
  report.data = {{"nested", {1.5, kNaN, {{"deep", -kInf}}}}};
  const nlohmann::json json = to_json(report);
  EXPECT_EQ(json["findings"][0]["measured"], "nan");
  EXPECT_EQ(json["findings"][0]["verdict"], "fail");
  EXPECT_EQ(json["charts"][0]["series"][0]["y"], nlohmann::json::array({"inf", "-inf"}));
  EXPECT_EQ(json["data"]["nested"][1], "nan");
  EXPECT_EQ(json["data"]["nested"][2]["deep"], "-inf");
  EXPECT_FALSE(contains(json.dump(), "null"));
}

TEST(ReportJson, KeepsBothValuesOfARepeatedSetting) {
  Report report;
  report.settings = {{"seed", "1"}, {"seed", "2"}};
  EXPECT_EQ(to_json(report)["settings"]["seed"], "1, 2");
}

TEST(ReportJson, WritesTextThatIsNoUtf8) {
  EXPECT_NO_THROW((void)to_json(hostile()).dump());
}

// ---------------------------------------------------------------- JUnit
TEST(ReportJunit, CountsAndMessages) {
  const std::string xml =
      to_junit(with({finding(Verdict::pass), finding(Verdict::fail), finding(Verdict::inconclusive)}));
  EXPECT_EQ(xml_fault(xml), "");
  EXPECT_TRUE(contains(
      xml, R"(<testsuite name="title" tests="3" failures="1" errors="0" skipped="1" time="0.750000">)"));
  EXPECT_EQ(count(xml, R"(<testcase classname="family" name="case / quantity" time="0.250000")"), 3U);
  EXPECT_TRUE(contains(xml, R"(<failure message="measured 0.50 ± 0.10, bound 1: detail">)"));
  EXPECT_TRUE(contains(xml, R"(<skipped message="inconclusive: measured)"));
}

TEST(ReportJunit, NaNIsAFailureWhateverTheCheckSaid) {
  const std::string xml = to_junit(with({finding(Verdict::pass, kNaN)}));
  EXPECT_TRUE(contains(xml, R"(failures="1")"));
  EXPECT_TRUE(contains(xml, "measured NaN"));
}

TEST(ReportJunit, IsWellFormedForHostileText) {
  const std::string xml = to_junit(hostile());
  EXPECT_EQ(xml_fault(xml), "");
  EXPECT_FALSE(contains(xml, "<script>"));
  EXPECT_FALSE(contains(xml, "\x01"));
}

TEST(ReportJunit, TheCheckOfWellFormednessSeesFaults) {
  EXPECT_NE(xml_fault("<?xml?><a><b></a></b>"), "");
  EXPECT_NE(xml_fault("<?xml?><a>"), "");
  EXPECT_NE(xml_fault("<?xml?><a b=\"<\"/>"), "");
  EXPECT_NE(xml_fault("<?xml?><a>&</a>"), "");
  EXPECT_EQ(xml_fault("<?xml?><a b=\"&lt;\">x</a>"), "");
}

// ---------------------------------------------------------------- HTML
// Anything a browser would fetch: src, href, url(), @import with something else than data: or an anchor.
std::vector<std::string> fetched(const std::string& html) {
  static const std::regex reference(
      R"re((?:\s(?:src|href|srcset|poster|action)\s*=\s*["']?|url\(\s*["']?|@import\s)(?!data:|#)([^"'\s)>]{1,60}))re");
  std::vector<std::string> found;
  for (std::sregex_iterator i(html.begin(), html.end(), reference), end; i != end; ++i)
    found.push_back((*i)[1]);
  return found;
}

// The page without its scripts, whose text is code and not markup.
std::string markup_of(const std::string& html) {
  std::string result;
  std::size_t at = 0;
  for (std::size_t open = html.find("<script"); open != std::string::npos; open = html.find("<script", at)) {
    result += html.substr(at, open - at);
    at = html.find("</script>", open) + 9;
  }
  return result + html.substr(at);
}

TEST(ReportHtml, FetchesNothing) {
  EXPECT_EQ(fetched(markup_of(to_html(sample_report()))), std::vector<std::string>());
  EXPECT_EQ(fetched("<img src=\"https://x/y.png\"> <a href='z'> url(http://q)").size(), 3U);
}

TEST(ReportHtml, CarriesEverythingInside) {
  const std::string html = to_html(sample_report());
  EXPECT_TRUE(contains(html, "Chart.js v"));
  EXPECT_TRUE(contains(html, "Permission is hereby granted"));
  EXPECT_EQ(count(html, "data-radiance=\""), 3U);
  EXPECT_EQ(count(html, "<img src=\"data:image/png;base64,"), 5U);  // 3 previews, 1 error map, its ramp
  EXPECT_EQ(count(html, "<canvas role=\"img\""), 2U);
  EXPECT_EQ(count(html, "<tr id=\"finding-"), 12U);
  EXPECT_LT(html.size(), 2'000'000U);
}

TEST(ReportHtml, PutsFailuresFirst) {
  const std::string html = to_html(sample_report());
  EXPECT_LT(html.find("id=\"attention\""), html.find("id=\"headlines\""));
  EXPECT_LT(html.find(">transfer</span>"), html.find(">image</span>"));
  EXPECT_LT(html.find(">image</span>"), html.find(">gram-matrix</span>"));
  EXPECT_LT(html.find("<tr id=\"finding-5\""), html.find("<tr id=\"finding-4\""));
}

TEST(ReportHtml, EscapesAllText) {
  const std::string html = to_html(hostile());
  EXPECT_FALSE(contains(html, "<script>alert"));
  EXPECT_FALSE(contains(html, "alert('x')</script>"));
  EXPECT_FALSE(contains(html, "\x01"));
  EXPECT_TRUE(contains(html, "&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt;&amp;&quot;{{json}}"));
  EXPECT_EQ(count(html, "<script"), count(html, "</script>"));
  EXPECT_EQ(count(html, "<script"), 3U);
}

TEST(ReportHtml, ShowsNaNAsNaNAndNotAsAPass) {
  const std::string html = to_html(with({finding(Verdict::pass, kNaN)}));
  EXPECT_FALSE(contains(html, "badge pass"));
  EXPECT_TRUE(contains(html, "NaN ± 0.1"));
  EXPECT_TRUE(contains(html, "counted as failed"));
}

TEST(ReportHtml, ToleratesEmptyParts) {
  Report report;
  report.charts = {{"no series", "", "x", "y", true, true, {}},
                   {"empty series", "", "x", "y", false, false, {{"s", {}, {}, {}, {}}}},
                   {"uneven", "", "x", "y", false, false, {{"s", {1, 2, 3}, {1}, {0}, {}}}}};
  report.galleries = {{"empty", "", {}, {}}, {"no pixels", "", {{"none", {}}}, {{"none", {}, 1.0, ""}}}};
  report.tables = {{"no rows", "", {"a"}, {}}, {"uneven rows", "", {"a"}, {{"1", "2"}, {}}}};
  report.headlines = {{"", "", ""}};
  const std::string html = to_html(report);
  EXPECT_EQ(count(html, "This chart has no points"), 2U);
  EXPECT_TRUE(contains(html, "No pictures."));
  EXPECT_EQ(count(html, "No picture."), 2U);
}

TEST(ReportHtml, RefusesPicturesThatAreNotTheirSize) {
  Report report;
  report.galleries = {{"g", "", {{"short", {2, 2, {Rgb(0.0F)}}}}, {}}};
  EXPECT_THROW((void)to_html(report), InputError);
  Gallery errors_only{"g", "", {}, {}};
  errors_only.errors.resize(1);
  errors_only.errors[0].image = image::Image8{2, 2, {0, 0, 0}};
  report.galleries.assign(1, errors_only);
  EXPECT_THROW((void)to_html(report), InputError);
}

TEST(ReportHtml, IntervalBarsSayWhereTheValueLies) {
  Finding one = finding(Verdict::pass, 3.5);
  one.expected = 3.0;
  EXPECT_TRUE(contains(html::interval_bar(one), "50 % of bound"));
  EXPECT_TRUE(
      contains(html::interval_bar(one), "<circle class=\"mark\" cx=\"128.1\""));  // 100 + 90 * 0.5 / 1.6
  one.measured = 30.0;
  EXPECT_FALSE(contains(html::interval_bar(one), "<circle"));
  one.bound = 0.0;
  EXPECT_TRUE(contains(html::interval_bar(one), "beyond any bound"));
  one.measured = one.expected;
  EXPECT_TRUE(contains(html::interval_bar(one), "exact"));
  one.measured = kNaN;
  EXPECT_TRUE(contains(html::interval_bar(one), ">NaN</text>"));
}

// For looking at: open the file in a browser.
TEST(ReportHtml, WritesTheDemonstration) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "plumbline_report_demo.html";
  write_text_atomically(path, to_html(sample_report()));
  EXPECT_GT(std::filesystem::file_size(path), 200'000U);
}

}  // namespace
}  // namespace plumbline::report
