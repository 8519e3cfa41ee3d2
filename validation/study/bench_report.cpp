#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "reference/integrate/path.hpp"
#include "validation/report/text.hpp"
#include "validation/study/bench.hpp"

namespace plumbline::study {
namespace {

using report::format_number;

nlohmann::json number(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : value > 0.0 ? "inf" : "-inf";
}

std::string bounces_text(int bounces) {
  return bounces == integrate::kAllBounces ? "all" : std::to_string(bounces);
}

std::vector<std::string> names_in(const std::vector<Budget>& all) {
  std::vector<std::string> names;
  for (const Budget& budget : all)
    if (std::find(names.begin(), names.end(), budget.method) == names.end()) names.push_back(budget.method);
  return names;
}

/// The method the others are measured by: the last one asked for that ran, so that "path,cycles" says how many times Cycles.
std::string base_of(const Plan& plan, const std::vector<Budget>& all) {
  const std::vector<std::string> names = names_in(all);
  for (auto method = plan.methods.rbegin(); method != plan.methods.rend(); ++method)
    if (std::find(names.begin(), names.end(), *method) != names.end()) return *method;
  return "";
}

std::string interval_text(double value, double low, double high) {
  if (std::isnan(low) || std::isnan(high))
    return fmt::format("{} (one repetition: no interval)", format_number(value));
  return fmt::format("{} [{}, {}]", format_number(value), format_number(low), format_number(high));
}

std::vector<report::Headline> headlines(const std::vector<Budget>& all, const std::vector<Ratio>& ratios) {
  std::vector<report::Headline> result;
  if (!ratios.empty()) {
    const auto least = std::min_element(ratios.begin(), ratios.end(),
                                        [](const Ratio& a, const Ratio& b) { return a.ratio < b.ratio; });
    result.push_back(
        {fmt::format("{} against {}, least of all budgets", least->method, least->base),
         fmt::format("{:.2f} ×", least->ratio),
         fmt::format("efficiency 1 / (relMSE × seconds) at {} samples a pixel; more is better", least->spp)});
  }
  for (const std::string& name : names_in(all)) {
    const auto best = std::max_element(all.begin(), all.end(), [&](const Budget& a, const Budget& b) {
      if ((a.method == name) != (b.method == name)) return b.method == name;
      return a.spp < b.spp;
    });
    result.push_back(
        {fmt::format("{}, {} samples a pixel", name, best->spp),
         fmt::format("{} in {}", format_number(best->relmse), report::format_seconds(best->seconds)),
         "relMSE and tracing time; less is better"});
  }
  return result;
}

report::Series series_of(const std::vector<Budget>& all, const std::string& name) {
  report::Series series;
  series.name = name;
  bool has_intervals = true;
  for (const Budget& budget : all) {
    if (budget.method != name) continue;
    series.x.push_back(budget.seconds);
    series.y.push_back(budget.relmse);
    series.y_low.push_back(budget.relmse_low);
    series.y_high.push_back(budget.relmse_high);
    has_intervals = has_intervals && budget.relmse_low > 0.0;  // a logarithmic axis has no place for others
  }
  if (!has_intervals) series.y_low = series.y_high = {};
  return series;
}

/// The fitted power law over the times the method was seen at.
std::optional<report::Series> fitted_series(const std::vector<Budget>& all, const std::string& name) {
  const std::optional<PowerLaw> law = fit(all, name);
  if (!law) return std::nullopt;
  const report::Series seen = series_of(all, name);
  report::Series series;
  series.name = fmt::format("{}: slope {:.2f}", name, law->slope);
  series.is_reference = true;
  const auto [first, last] = std::minmax_element(seen.x.begin(), seen.x.end());
  for (const double seconds : {*first, *last}) {
    series.x.push_back(seconds);
    series.y.push_back(law->factor * std::pow(seconds, law->slope));
  }
  return series;
}

report::Series front_series(std::vector<Budget> all) {
  std::sort(all.begin(), all.end(), [](const Budget& a, const Budget& b) { return a.seconds < b.seconds; });
  report::Series series;
  series.name = "Pareto front";
  series.is_reference = true;
  for (const Budget& budget : all) {
    if (!budget.is_on_front) continue;
    series.x.push_back(budget.seconds);
    series.y.push_back(budget.relmse);
  }
  return series;
}

report::Chart error_chart(const std::vector<Budget>& all) {
  report::Chart chart;
  chart.title = "Error against time";
  chart.caption =
      "relMSE = mean (v - r)² / (r² + 0.01) over pixels and channels, the reference's own error taken off; "
      "95 % intervals. Further left "
      "and further down is better. Slope -1 is what independent samples give. Nothing lies below and left of "
      "the Pareto front.";
  chart.x_label = "seconds of tracing";
  chart.y_label = "relMSE";
  chart.is_x_log = chart.is_y_log = true;
  for (const std::string& name : names_in(all)) chart.series.push_back(series_of(all, name));
  for (const std::string& name : names_in(all))
    if (auto fitted = fitted_series(all, name)) chart.series.push_back(std::move(*fitted));
  chart.series.push_back(front_series(all));
  return chart;
}

report::Table budget_table(const std::vector<Budget>& all) {
  report::Table table{"Budgets", "Means over the repetitions; efficiency = 1 / (relMSE × seconds).", {}, {}};
  table.columns = {"method",        "samples a pixel", "repetitions", "seconds",
                   "relMSE [95 %]", "efficiency",      "Pareto front"};
  for (const Budget& b : all) {
    table.rows.push_back({b.method, std::to_string(b.spp), std::to_string(b.repetitions),
                          format_number(b.seconds), interval_text(b.relmse, b.relmse_low, b.relmse_high),
                          format_number(b.efficiency), b.is_on_front ? "yes" : "no"});
  }
  return table;
}

report::Table ratio_table(const std::vector<Ratio>& ratios) {
  report::Table table{
      "Efficiency ratios",
      "At equal samples a pixel, run after run in turn: geometric mean over the repetitions, 95 % interval.",
      {"methods", "samples a pixel", "ratio [95 %]"},
      {}};
  for (const Ratio& r : ratios)
    table.rows.push_back(
        {r.method + " / " + r.base, std::to_string(r.spp), interval_text(r.ratio, r.low, r.high)});
  return table;
}

report::Table skipped_table(const std::vector<Skipped>& skipped) {
  report::Table table{"Skipped", "Asked for, but not there.", {"method", "runs", "reason"}, {}};
  for (const Skipped& one : skipped) table.rows.push_back({one.method, std::to_string(one.runs), one.reason});
  return table;
}

double mean_value(const image::Image& image) {
  RgbD sum(0.0);
  for (const Rgb& pixel : image.pixels) sum += RgbD(pixel);
  return (sum.x + sum.y + sum.z) / (3.0 * static_cast<double>(image.pixels.size()));
}

report::Gallery gallery_of(const Outcome& outcome) {
  report::Gallery gallery;
  gallery.title = "Images";
  gallery.caption =
      "The reference, and the largest budget of each method. All must look the same but for noise.";
  const image::Image reference = mean_of(outcome.reference);
  const double mean = mean_value(reference);
  // The mean a little above middle gray, in the slider's quarter stops.
  if (mean > 0.0)
    gallery.exposure_stops =
        static_cast<float>(std::clamp(std::round(4.0 * std::log2(0.35 / mean)) / 4.0, -10.0, 10.0));
  gallery.entries.push_back({"reference", reference});
  for (const auto& [name, halved] : outcome.renderers)
    gallery.entries.push_back({name + ", long", mean_of(halved)});
  for (const auto& [name, picture] : outcome.last_images) {
    gallery.entries.push_back({name, picture});
    gallery.errors.push_back(
        report::error_map(name + ": |error|", reference, picture, 0.2 * std::max(mean, 1e-6), "radiance"));
  }
  if (outcome.agreement) {
    gallery.errors.push_back({fmt::format("z of 16 × 16 tiles, {}: blue = darker, red = brighter",
                                          outcome.agreement->findings.front().name.substr(
                                              0, outcome.agreement->findings.front().name.find(" /"))),
                              outcome.agreement->z_map,
                              kFullZ,
                              "standard errors, either way",
                              {}});
  }
  return gallery;
}

/// The reference's own error is taken off, but its noise stays: a reference must be clearly better than what it judges.
checks::Finding reference_finding(const Outcome& outcome, const std::vector<Budget>& all) {
  double least = std::numeric_limits<double>::infinity();
  for (const Budget& budget : all) least = std::min(least, budget.relmse);
  checks::Finding finding;
  finding.family = "reference";
  finding.name = "own relMSE over the least relMSE measured";
  const double own = own_relmse(outcome.reference);
  finding.measured = own == 0.0 ? 0.0 : own / least;
  finding.bound = 0.25;
  const bool is_good = finding.measured >= 0.0 && finding.measured <= finding.bound;
  finding.verdict =
      is_good && outcome.has_reference_halves ? checks::Verdict::pass : checks::Verdict::inconclusive;
  finding.source = "a quarter: then the reference's noise moves a relMSE by far less than the image's own";
  finding.detail =
      outcome.has_reference_halves
          ? fmt::format("own relMSE {:.3g} from independent halves; more --reference-spp lowers it",
                        own_relmse(outcome.reference))
          : "the file has no independent halves: its own error is unknown and was not taken off";
  return finding;
}

}  // namespace

report::Report make_report(const Task& task, const Plan& plan, const Outcome& outcome) {
  const std::vector<Budget> all = budgets(outcome.runs);
  const std::vector<Ratio> all_ratios = ratios(outcome.runs, base_of(plan, all));
  report::Report page;
  page.title = "Run time against error: " + plan.scene;
  page.summary = fmt::format(
      "{} at {}x{} pixels, {} indirect bounces, {} threads; runs in turn, held against a long reference.",
      fmt::join(names_in(all), ", "), task.width, task.height, bounces_text(task.max_bounces), task.threads);
  page.settings = {{"scene", plan.scene},
                   {"environment", plan.environment},
                   {"size", fmt::format("{}x{}", task.width, task.height)},
                   {"indirect bounces", bounces_text(task.max_bounces)},
                   {"threads", std::to_string(task.threads)},
                   {"repetitions", std::to_string(plan.repetitions)},
                   {"reference", plan.reference_file
                                     ? plan.reference_file->string()
                                     : fmt::format("{} samples a pixel in each of two halves of each method",
                                                   plan.reference_spp)},
                   {"seed", std::to_string(plan.seed)}};
  page.headlines = headlines(all, all_ratios);
  page.galleries = {gallery_of(outcome)};
  page.charts = {error_chart(all)};
  if (!all_ratios.empty()) page.tables.push_back(ratio_table(all_ratios));
  page.tables.push_back(budget_table(all));
  if (!outcome.skipped.empty()) page.tables.push_back(skipped_table(outcome.skipped));
  if (outcome.agreement) page.findings = outcome.agreement->findings;
  page.findings.push_back(reference_finding(outcome, all));
  return page;
}

nlohmann::json to_json(const Task& task, const Plan& plan, const Outcome& outcome) {
  using Json = nlohmann::json;
  Json out = {{"runs", Json::array()},
              {"budgets", Json::array()},
              {"ratios", Json::array()},
              {"slopes", Json::object()},
              {"skipped", Json::array()}};
  for (const Run& run : outcome.runs) {
    out["runs"].push_back({{"method", run.method},
                           {"scene", plan.scene},
                           {"environment", plan.environment},
                           {"seconds", run.seconds},
                           {"relmse", number(run.relmse)},
                           {"efficiency", number(efficiency(run.relmse, run.seconds))},
                           {"spp", run.spp},
                           {"seed", run.seed},
                           {"width", task.width},
                           {"height", task.height},
                           {"bounces", bounces_text(task.max_bounces)},
                           {"threads", task.threads},
                           {"repetition", run.repetition}});
  }
  const std::vector<Budget> all = budgets(outcome.runs);
  for (const Budget& b : all) {
    out["budgets"].push_back({{"method", b.method},
                              {"spp", b.spp},
                              {"repetitions", b.repetitions},
                              {"seconds", b.seconds},
                              {"relmse", number(b.relmse)},
                              {"relmse_low", number(b.relmse_low)},
                              {"relmse_high", number(b.relmse_high)},
                              {"efficiency", number(b.efficiency)},
                              {"is_on_front", b.is_on_front}});
  }
  for (const Ratio& r : ratios(outcome.runs, base_of(plan, all))) {
    out["ratios"].push_back({{"method", r.method},
                             {"base", r.base},
                             {"spp", r.spp},
                             {"ratio", number(r.ratio)},
                             {"low", number(r.low)},
                             {"high", number(r.high)}});
  }
  for (const std::string& name : names_in(all))
    if (const auto law = fit(all, name)) out["slopes"][name] = law->slope;
  for (const Skipped& one : outcome.skipped)
    out["skipped"].push_back({{"method", one.method}, {"reason", one.reason}, {"runs", one.runs}});
  out["reference"] = {{"own_relmse", number(own_relmse(outcome.reference))},
                      {"has_halves", outcome.has_reference_halves},
                      {"samples_per_half", plan.reference_file ? Json(nullptr) : Json(plan.reference_spp)},
                      {"renderers", Json::array()}};
  for (const auto& [name, halved] : outcome.renderers) out["reference"]["renderers"].push_back(name);
  return out;
}

}  // namespace plumbline::study
