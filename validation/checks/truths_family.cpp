// The family `truths` of plumbline validate: runs the cases and the calibrations, and reports both.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "validation/checks/suite.hpp"
#include "validation/checks/truths.hpp"
#include "validation/checks/truths_calibration.hpp"
#include "validation/checks/truths_images.hpp"
#include "validation/metrics/statistics.hpp"

namespace plumbline::checks {
namespace {

void announce(const Suite& suite, const std::string& what) {
  if (suite.announce) suite.announce("truths: " + what);
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// ---------------------------------------------------------------- the cases
report::Forest::Row row(const Finding& finding) {
  return {finding.name, finding.measured, finding.measured - finding.uncertainty,
          finding.measured + finding.uncertainty, finding.verdict};
}

/// One plot for all cases with the tier's margin; one in units of their own margins for the others.
std::vector<report::Forest> forests(const std::vector<Finding>& findings, double margin_percent) {
  report::Forest common;
  common.title = "Bias of the path tracer against every closed form";
  common.caption = fmt::format(
      "Relative bias with its 95 % interval; the band is the margin of +-{:g} %. A case passes when its "
      "interval at the "
      "family-wise significance, which is wider, lies inside the band.",
      margin_percent);
  common.unit = "%";
  common.band = margin_percent;
  report::Forest own;
  own.title = "Cases with margins of their own";
  own.caption =
      "Single late bounces, whose paths are rare, and cases without noise, which are held against rounding: "
      "bias as a "
      "share of each one's margin (see Checks for the numbers).";
  own.unit = "of the margin";
  own.band = 1.0;
  for (const Finding& finding : findings) {
    if (finding.bound == margin_percent) {
      common.rows.push_back(row(finding));
      continue;
    }
    Finding share = finding;
    share.measured /= finding.bound;
    share.uncertainty /= finding.bound;
    own.rows.push_back(row(share));
  }
  std::vector<report::Forest> result = {common};
  if (!own.rows.empty()) result.push_back(own);
  return result;
}

void add_case_headline(const std::vector<Finding>& findings, double margin_percent, report::Report& report) {
  double worst = 0.0;
  double widest = 0.0;
  std::size_t passed = 0;
  std::string where;
  for (const Finding& finding : findings) {
    passed += finding.verdict == Verdict::pass ? 1U : 0U;
    if (finding.bound != margin_percent) continue;
    widest = std::max(widest, finding.uncertainty);
    if (!(std::abs(finding.measured) <= worst)) {
      worst = std::abs(finding.measured);
      where = finding.name;
    }
  }
  report.headlines.push_back(
      {"path tracer against closed forms", fmt::format("{} of {} equal", passed, findings.size()),
       fmt::format(
           "within ±{:g} %, shown by two one-sided tests; largest bias {:.3f} % ({}), widest 95 % interval "
           "±{:.3f} %",
           margin_percent, worst, where, widest)});
  report.data["truths"]["largest_bias_percent"] = worst;
  report.data["truths"]["widest_interval_percent"] = widest;
}

void run_cases(const Suite& suite, const std::vector<TruthCase>& cases, report::Report& report) {
  std::vector<Finding> findings;
  for (const TruthCase& one : cases) {
    announce(suite, one.name);
    const TruthResult result = run_truth(one, suite.budget, cases.size());
    findings.push_back(result.finding);
    report.data["truths"]["cases"][one.name] = {
        {"truth", one.truth},
        {"mean", result.measurement.mean},
        {"standard_error", result.measurement.standard_error},
        {"degrees_of_freedom", result.measurement.degrees_of_freedom},
        {"paths", static_cast<std::int64_t>(result.plan.effort.samples) * result.plan.effort.copies},
        {"margin", result.plan.margin},
        {"seconds", result.finding.seconds}};
  }
  const double margin_percent = 100.0 * tier_margin(suite.budget.tier);
  add_case_headline(findings, margin_percent, report);
  for (report::Forest& forest : forests(findings, margin_percent))
    report.forests.push_back(std::move(forest));
  for (Finding& finding : findings) report.findings.push_back(std::move(finding));
}

// ---------------------------------------------------------------- p values
report::Chart histogram(const PValues& p, const Flatness& f) {
  constexpr int kBins = 20;
  report::Series bars;
  bars.name = "p values";
  bars.is_bars = true;
  std::vector<double> counts(kBins, 0.0);
  for (const double value : p.values)
    counts[static_cast<std::size_t>(std::clamp(static_cast<int>(value * kBins), 0, kBins - 1))] += 1.0;
  for (int i = 0; i < kBins; ++i) {
    bars.x.push_back((i + 0.5) / kBins);
    bars.y.push_back(counts[static_cast<std::size_t>(i)]);
  }
  const double expected = static_cast<double>(p.values.size()) / kBins;
  report::Chart chart;
  chart.title = "p values of all cases and seeds";
  chart.caption = fmt::format(
      "Flat if means and standard errors are both right: {} cases x {} seeds. Kolmogorov-Smirnov distance "
      "{:.4f} (p = "
      "{:.2g}); {} below 0.01, expected {:.0f} (p = {:.2g}).",
      p.cases, p.seeds, f.distance.statistic, f.distance.p, f.below,
      0.01 * static_cast<double>(p.values.size()), f.below_p);
  chart.x_label = "p";
  chart.y_label = "estimates";
  chart.series = {bars, {"expected", {0.0, 1.0}, {expected, expected}, {}, {}, true}};
  return chart;
}

Finding flat_finding(const std::string& name, double p, double significance, const std::string& detail) {
  Finding finding;
  finding.family = "truths";
  finding.name = "p values / " + name;
  finding.measured = p;
  finding.bound = metrics::sidak(significance, 2);
  finding.source = "two tests of uniformity at the family's significance; p must not be below";
  finding.detail = detail;
  finding.verdict = p >= finding.bound ? Verdict::pass : Verdict::fail;
  return finding;
}

void run_p_values(const Suite& suite, const std::vector<TruthCase>& cases, report::Report& report) {
  announce(suite, "p values");
  const auto start = std::chrono::steady_clock::now();
  const bool is_nightly = suite.budget.tier == Tier::nightly;
  PValueBudget budget;
  budget.samples = is_nightly ? 1 << 14 : 1 << 10;
  budget.seeds = is_nightly ? 64 : 32;
  budget.seed = suite.budget.seed;
  budget.threads = suite.budget.threads;
  const PValues p = p_values(cases, budget);
  const Flatness f = flatness(p);
  report.charts.push_back(histogram(p, f));
  report.data["truths"]["p_values"] = {{"values", p.values.size()},
                                       {"ks", f.distance.statistic},
                                       {"ks_p", f.distance.p},
                                       {"below_0.01", f.below},
                                       {"below_0.01_p", f.below_p}};
  report.findings.push_back(
      flat_finding("Kolmogorov-Smirnov", f.distance.p, suite.budget.significance,
                   fmt::format("{} values, distance {:.4f}.", p.values.size(), f.distance.statistic)));
  report.findings.push_back(flat_finding("count below 0.01", f.below_p, suite.budget.significance,
                                         fmt::format("{} of {}.", f.below, p.values.size())));
  for (std::size_t i = report.findings.size() - 2; i < report.findings.size(); ++i)
    report.findings[i].seconds = 0.5 * seconds_since(start);
}

// ---------------------------------------------------------------- power and false alarms
Finding power_finding(const PowerPoint& point) {
  Finding finding;
  finding.family = "truths";
  finding.name = point.bias == 0.0
                     ? "false alarms / " + point.estimator
                     : fmt::format("power / {} with a bias of {:g} %", point.estimator, 100.0 * point.bias);
  finding.measured = point.measured.value;
  finding.uncertainty = 0.5 * (point.measured.high - point.measured.low);
  finding.expected = point.stated;
  finding.bound = std::max(point.measured.high - point.stated_low, point.stated_high - point.measured.low);
  finding.source = "exact binomial interval of the measured rate, and the stated rate's own";
  finding.detail =
      fmt::format("Found {:.1f} % [{:.1f}, {:.1f}], stated {:.1f} % [{:.1f}, {:.1f}].",
                  100.0 * point.measured.value, 100.0 * point.measured.low, 100.0 * point.measured.high,
                  100.0 * point.stated, 100.0 * point.stated_low, 100.0 * point.stated_high);
  finding.verdict = agrees(point) ? Verdict::pass : Verdict::fail;
  return finding;
}

report::Chart power_chart(const std::vector<PowerPoint>& points, std::size_t seeds) {
  report::Chart chart;
  chart.title = "Power: how often an injected bias is found";
  chart.caption = fmt::format(
      "Marks: measured over {} seeds a point, exact intervals. Dashed: stated (noncentral t). Good: they "
      "agree.",
      seeds);
  chart.x_label = "injected bias [%]";
  chart.y_label = "share found";
  chart.is_x_log = true;
  for (const PowerPoint& point : points) {
    if (point.bias == 0.0) continue;
    auto found = std::find_if(chart.series.begin(), chart.series.end(),
                              [&](const report::Series& s) { return s.name == point.estimator; });
    if (found == chart.series.end()) {
      chart.series.push_back({point.estimator, {}, {}, {}, {}});
      chart.series.push_back({"stated, " + point.estimator, {}, {}, {}, {}, true});
      found = chart.series.end() - 2;
    }
    found->x.push_back(100.0 * point.bias);
    found->y.push_back(point.measured.value);
    found->y_low.push_back(point.measured.low);
    found->y_high.push_back(point.measured.high);
    (found + 1)->x.push_back(100.0 * point.bias);
    (found + 1)->y.push_back(point.stated);
  }
  return chart;
}

report::Table power_table(const std::vector<PowerPoint>& points) {
  report::Table table;
  table.title = "Power and false alarms";
  table.caption = "Each estimate tested alone at significance 0.01; intervals are exact binomial ones.";
  table.columns = {"estimator", "injected bias", "found", "interval", "stated"};
  for (const PowerPoint& point : points) {
    table.rows.push_back(
        {point.estimator, fmt::format("{:g} %", 100.0 * point.bias),
         fmt::format("{:.1f} %", 100.0 * point.measured.value),
         fmt::format("[{:.1f}, {:.1f}] %", 100.0 * point.measured.low, 100.0 * point.measured.high),
         fmt::format("{:.1f} %", 100.0 * point.stated)});
  }
  return table;
}

const TruthCase& find_case(const std::vector<TruthCase>& cases, const std::string& name) {
  return *std::find_if(cases.begin(), cases.end(), [&](const TruthCase& one) { return one.name == name; });
}

void run_power(const Suite& suite, const std::vector<TruthCase>& cases, report::Report& report) {
  constexpr double kFoundWell = 0.003;
  announce(suite, "power and false alarms");
  PowerBudget budget;
  budget.seed = suite.budget.seed;
  budget.threads = suite.budget.threads;
  std::vector<std::string> names = {"D09_CornerRectangle", "D20_OvercastHorizontal"};
  if (suite.budget.tier == Tier::nightly) names.insert(names.end(), {"M09_Dihedral90", "M04_SouthPole"});
  std::vector<PowerPoint> points;
  for (const std::string& name : names) {
    const auto start = std::chrono::steady_clock::now();
    const TruthCase& one = find_case(cases, name);
    std::vector<PowerPoint> curve = power_curve(one, kFoundWell, budget);
    PowerPoint between = false_alarms_between_runs(one, 256, budget);
    between.estimator += ", two runs";
    curve.push_back(between);
    for (const PowerPoint& point : curve) {
      report.findings.push_back(power_finding(point));
      report.findings.back().seconds = seconds_since(start) / static_cast<double>(curve.size());
      report.data["truths"]["power"].push_back({{"estimator", point.estimator},
                                                {"bias", point.bias},
                                                {"found", point.measured.value},
                                                {"low", point.measured.low},
                                                {"high", point.measured.high},
                                                {"stated", point.stated}});
    }
    points.insert(points.end(), curve.begin(), curve.end());
  }
  report.charts.push_back(power_chart(points, budget.seeds));
  report.tables.push_back(power_table(points));
}

}  // namespace

void check_truths(const Suite& suite, report::Report& report) {
  const std::vector<TruthCase> cases = truth_cases();
  run_cases(suite, cases, report);
  run_p_values(suite, cases, report);
  run_power(suite, cases, report);
  for (Finding& finding : check_truth_images(suite.budget)) {
    announce(suite, finding.name);
    report.findings.push_back(std::move(finding));
  }
}

}  // namespace plumbline::checks
