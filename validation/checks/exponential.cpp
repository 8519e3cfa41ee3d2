#include "prt/sh/exponential.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "prt/sh/logarithm.hpp"
#include "prt/sh/product.hpp"
#include "validation/checks/exponential_study.hpp"
#include "validation/checks/product_checks.hpp"
#include "validation/checks/suite.hpp"
#include "validation/checks/verdicts.hpp"

namespace plumbline::checks {
namespace {

constexpr int kTrials = 4;            // draws of each number of blockers
constexpr int kPaperBands = 4;        // what the papers use
constexpr int kLeastRecommended = 3;  // bands: at 2 the hybrid method errs less
constexpr int kMostBands = 8;         // of the study
constexpr double kPaperLimit = 4.8;
constexpr std::size_t kLinear = 0;
constexpr std::size_t kHybrid = 1;
constexpr std::size_t kRecommended = 2;

using Vector = std::vector<double>;

void check_products(report::Report& report) {
  constexpr std::array<std::size_t, 5> kCounts{10, 83, 353, 1158, 2907};
  for (int bands = 2; bands <= 8; ++bands) {
    const auto multiply = [](const Vector& a, const Vector& b) { return sh::product(a, b); };
    report.findings.push_back(
        judge_error({"exponential", fmt::format("{} bands / product", bands),
                     "Exact quadrature; rounding of n^5 / 3 terms",
                     "Largest coefficient error for factors in [-1, 1], and (1 + z)^2 in closed form."},
                    product_deviation(multiply, bands), 1e-13));
    if (bands > 6) continue;
    double count = 0.0;
    for (const sh::Tripling& t : sh::tripling_coefficients(bands))
      count += t.i == t.k ? 1.0 : t.i == t.j || t.j == t.k ? 3.0 : 6.0;
    const auto expected = static_cast<double>(kCounts[static_cast<std::size_t>(bands - 2)]);
    report.findings.push_back(
        judge_error({"exponential", fmt::format("{} bands / tripling coefficients that are not 0", bands),
                     fmt::format("Selection rules of the Wigner 3j symbols: {}", expected),
                     "Difference to the known count."},
                    std::abs(count - expected), 0.0));
  }
}

void check_constants(int bands, report::Report& report) {
  const std::string n = fmt::format("{} bands", bands);
  double exponential = 0.0;
  const std::array<Vector (*)(const Vector&), 4> methods{sh::exponential_linear, sh::exponential_hybrid,
                                                         [](const Vector& f) { return sh::exponential(f); },
                                                         sh::exponential_of_matrix};
  for (const auto& method : methods)
    exponential = std::max(exponential, constant_exponential_deviation(method, bands));
  report.findings.push_back(
      judge_error({"exponential", n + " / exp of a constant", "e^a exactly; rounding of a <= 20",
                   "Relative, the worst of four methods. Sees a wrong factor between f_0 and the mean."},
                  exponential, 1e-14));
  report.findings.push_back(judge_error(
      {"exponential", n + " / log of a constant", "a exactly; rounding", "Relative to max(1, |a|)."},
      constant_logarithm_deviation([](const Vector& f) { return sh::logarithm(f).coefficients; }, bands),
      1e-14));
  report.findings.push_back(judge_error(
      {"exponential", n + " / limit of the series", "exp(M_f) 1 by eigenvectors; remainder below 4^31 / 31!",
       "The isolated series to degree 30. Sees wrong coefficients of the series."},
      series_limit_deviation([](const Vector& f) { return sh::exponential_isolated(f, 30); }, bands), 1e-12));
}

std::string number(double value) {
  return std::isnan(value) ? "refuses" : fmt::format("{:.4f}", value);
}

/// The mean of cases with one parameter.
struct Row {
  double parameter = 0.0;
  double magnitude = 0.0;
  std::vector<double> errors;
  std::vector<double> visibility_errors;
  double oracle = 0.0;
  double products = 0.0;
};

std::vector<Row> average(const std::vector<StudyCase>& cases) {
  std::vector<Row> rows;
  std::size_t end = 0;
  for (std::size_t begin = 0; begin < cases.size(); begin = end) {
    Row row{cases[begin].parameter,
            0.0,
            Vector(exponential_methods().size(), 0.0),
            Vector(exponential_methods().size(), 0.0),
            0.0,
            0.0};
    for (end = begin; end < cases.size() && cases[end].parameter == row.parameter; ++end) {
    }
    const double weight = 1.0 / static_cast<double>(end - begin);
    for (std::size_t c = begin; c < end; ++c) {
      row.magnitude += weight * cases[c].magnitude;
      row.oracle += weight * cases[c].oracle_visibility_error;
      row.products += weight * cases[c].product_visibility_error;
      for (std::size_t m = 0; m < row.errors.size(); ++m) {
        row.errors[m] += weight * cases[c].errors[m].error;
        row.visibility_errors[m] += weight * cases[c].visibility_errors[m];
      }
    }
    rows.push_back(row);
  }
  return rows;
}

report::Table error_table(const std::string& title, const std::string& parameter,
                          const std::vector<Row>& rows) {
  report::Table table;
  table.title = title;
  table.caption =
      "Root mean square over the sphere of exp(f) minus the exact exponential, projected; a visibility lies "
      "between 0 "
      "and 1. Lower is better.";
  table.columns = {parameter, "|f^|"};
  for (const std::string& name : exponential_methods()) table.columns.push_back(name);
  for (const Row& row : rows) {
    std::vector<std::string> cells{fmt::format("{:g}", row.parameter), fmt::format("{:.2f}", row.magnitude)};
    for (const double error : row.errors) cells.push_back(number(error));
    table.rows.push_back(cells);
  }
  return table;
}

report::Table visibility_table(int bands, const std::vector<Row>& rows) {
  report::Table table;
  table.title = fmt::format("From spheres to visibility, {} bands", bands);
  table.caption =
      "Root mean square error of the whole way, sum of logarithms and exponential, against the visibility of "
      "the same "
      "spheres projected exactly. 'exact exp' shows what the logarithm has lost; 'SH products' multiplies "
      "the "
      "visibilities one by one instead (equation 3.23).";
  table.columns = {"spheres", "|f^|", "exact exp", "squared series", "hybrid", "linear", "SH products"};
  for (const Row& row : rows) {
    table.rows.push_back({fmt::format("{:g}", row.parameter), fmt::format("{:.2f}", row.magnitude),
                          number(row.oracle), number(row.visibility_errors[kRecommended]),
                          number(row.visibility_errors[kHybrid]), number(row.visibility_errors[kLinear]),
                          number(row.products)});
  }
  return table;
}

report::Chart error_chart(int bands, const std::string& title, const std::string& x_label, bool is_x_log,
                          const std::vector<Row>& rows) {
  report::Chart chart;
  chart.title = fmt::format("{}, {} bands", title, bands);
  chart.caption = "Error of each way to exponentiate, against the exact exponential. Lower is better.";
  chart.x_label = x_label;
  chart.y_label = "root mean square error";
  chart.is_x_log = is_x_log;
  chart.is_y_log = true;
  for (std::size_t m = 0; m < exponential_methods().size(); ++m) {
    report::Series series{exponential_methods()[m], {}, {}, {}, {}, false};
    for (const Row& row : rows) {
      if (std::isnan(row.errors[m])) continue;
      series.x.push_back(row.parameter);
      series.y.push_back(std::max(row.errors[m], 1e-6));
    }
    chart.series.push_back(series);
  }
  return chart;
}

/// How well blockers agree on a and b at one magnitude: each case contributes its own best factors.
report::Table agreement_table(int bands, const std::vector<StudyCase>& singles,
                              const std::vector<StudyCase>& many) {
  report::Table table;
  table.title = fmt::format("Do blockers of one |f^| agree on a and b? {} bands", bands);
  table.caption =
      "Equation 3.30 tabulates a and b by |f^| alone; the thesis finds that good for |f^| < 4.8. Largest "
      "difference "
      "between the best factors of a blocker (equation 3.29) and the tabulated ones.";
  table.columns = {"|f^|", "blockers", "largest |a - table|", "largest |b - table|"};
  const sh::LinearTable& factors = sh::linear_table(bands);
  for (const auto& [low, high] :
       {std::pair{0.0, 0.5}, {0.5, 1.0}, {1.0, 2.4}, {2.4, kPaperLimit}, {kPaperLimit, 8.0}}) {
    int count = 0;
    double a = 0.0;
    double b = 0.0;
    for (const std::vector<StudyCase>* cases : {&singles, &many}) {
      for (const StudyCase& one : *cases) {
        if (one.magnitude < low || one.magnitude >= high) continue;
        const auto place = static_cast<std::size_t>(std::lround(one.magnitude / factors.step));
        ++count;
        a = std::max(a, std::abs(one.best_a - factors.a[place]));
        b = std::max(b, std::abs(one.best_b - factors.b[place]));
      }
    }
    table.rows.push_back({fmt::format("{:g} to {:g}", low, high), fmt::format("{}", count),
                          fmt::format("{:.3f}", a), fmt::format("{:.3f}", b)});
  }
  return table;
}

report::Table clipping_table(int bands, const std::vector<StudyCase>& singles) {
  report::Table table;
  table.title = fmt::format("What the logarithm of a sphere's visibility clips, {} bands", bands);
  table.caption =
      fmt::format("Eigenvalues of the product matrix below the floor {} are raised to it (equation 3.34).",
                  sh::kDefaultFloor);
  table.columns = {"angular radius [degrees]", "clipped eigenvalues", "their share of the sphere", "|f^|",
                   "error of exact exp(log)"};
  for (const StudyCase& one : singles) {
    if (static_cast<int>(one.parameter) % 10 != 5) continue;
    table.rows.push_back({fmt::format("{:g}", one.parameter), fmt::format("{} of {}", one.clipped, bands),
                          fmt::format("{:.3f}", one.clipped_energy), fmt::format("{:.2f}", one.magnitude),
                          number(one.oracle_visibility_error)});
  }
  return table;
}

double largest_magnitude(const std::vector<StudyCase>& cases) {
  double result = 0.0;
  for (const StudyCase& one : cases) result = std::max(result, one.magnitude);
  return result;
}

double mean_products(const std::vector<StudyCase>& cases, std::size_t method) {
  double sum = 0.0;
  for (const StudyCase& one : cases) sum += one.errors[method].products;
  return sum / static_cast<double>(cases.size());
}

/// What each method costs and what it errs.
report::Table choice_table(int bands, const std::vector<StudyCase>& singles,
                           const std::vector<StudyCase>& many) {
  report::Table table;
  table.title = fmt::format("Which exponential to use, {} bands", bands);
  table.caption =
      "Root mean square error over all cases, and SH products taken on average: nearly all of the time. "
      "'matrix' takes "
      "an eigen-analysis instead. Single spheres show how the methods err; their visibility is known without "
      "any.";
  table.columns = {"method", "error, one sphere", "error, 1 to 100 spheres", "products, one sphere",
                   "products, 1 to 100 spheres"};
  for (std::size_t m = 0; m < exponential_methods().size(); ++m) {
    table.rows.push_back({exponential_methods()[m], number(overall_error(singles, m)),
                          number(overall_error(many, m)), fmt::format("{:.1f}", mean_products(singles, m)),
                          fmt::format("{:.1f}", mean_products(many, m))});
  }
  return table;
}

/// The recommendation must hold where it is given, for accumulated spheres: one product more must buy something.
void judge_recommendation(int bands, const std::vector<StudyCase>& cases, report::Report& report) {
  const double recommended = overall_error(cases, kRecommended);
  const double hybrid = overall_error(cases, kHybrid);
  report.findings.push_back(judge_error(
      {"exponential", fmt::format("{} bands / recommended method on 1 to 100 spheres", bands),
       "Its error over the hybrid method's must not exceed 1: that is the reason to recommend it",
       fmt::format("Root mean square error {:.4f} against {:.4f}, {:.1f} SH products against {:.1f}.",
                   recommended, hybrid, mean_products(cases, kRecommended), mean_products(cases, kHybrid))},
      recommended / hybrid, 1.0));
}

void study_bands(const Suite& suite, int bands, report::Report& report) {
  if (suite.announce) suite.announce(fmt::format("exponentials of {} bands", bands));
  const std::vector<StudyCase> singles = study_single_spheres(bands);
  const std::vector<StudyCase> many = study_accumulations(bands, kTrials, suite.budget.seed);
  if (bands >= kLeastRecommended) judge_recommendation(bands, many, report);
  const std::vector<Row> single_rows = average(singles);
  const std::vector<Row> many_rows = average(many);
  report.charts.push_back(
      error_chart(bands, "Exponential of one sphere", "angular radius [degrees]", false, single_rows));
  report.charts.push_back(error_chart(bands, "Exponential of many spheres", "spheres", true, many_rows));
  report.tables.push_back(choice_table(bands, singles, many));
  report.tables.push_back(
      error_table(fmt::format("Exponentials of accumulated spheres, {} bands", bands), "spheres", many_rows));
  report.tables.push_back(visibility_table(bands, many_rows));
  report.tables.push_back(agreement_table(bands, singles, many));
  report.tables.push_back(clipping_table(bands, singles));
  if (bands == kPaperBands) {
    report.headlines.push_back(
        {"largest |f^| of one sphere's log visibility", fmt::format("{:.2f}", largest_magnitude(singles)),
         fmt::format("at {} bands; the thesis gives 4.8 as the limit of its linear method", bands)});
  }
}

}  // namespace

void check_exponential(const Suite& suite, report::Report& report) {
  check_products(report);
  std::vector<int> counts{kPaperBands};
  for (const int bands : suite.bands) {
    if (bands >= 2 && bands <= kMostBands) counts.push_back(bands);
  }
  std::sort(counts.begin(), counts.end());
  counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
  for (const int bands : counts) {
    check_constants(bands, report);
    study_bands(suite, bands, report);
  }
  report::Table residuals;
  residuals.title = "log(exp f) is f only in the limit";
  residuals.caption =
      "f = 0.7 z - 1, its exact exponential projected to n bands, and the logarithm of that. Relative.";
  residuals.columns = {"bands", "|log(exp f) - f| / |f|"};
  for (int bands = 2; bands <= kMostBands; ++bands)
    residuals.rows.push_back({fmt::format("{}", bands), fmt::format("{:.2e}", round_trip_residual(bands))});
  report.tables.push_back(residuals);
}

}  // namespace plumbline::checks
