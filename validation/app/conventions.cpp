// plumbline conventions: the spherical-harmonic conventions of others.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prt/sh/convention.hpp"
#include "prt/sh/identify.hpp"
#include "validation/app/options.hpp"
#include "validation/app/verbs.hpp"

namespace plumbline::app {
namespace {

struct Options {
  bool is_markdown = false;
  LightOptions light;
  std::string json;
};

/// A Markdown table's columns; each a function of a row.
struct Column {
  const char* title;
  std::string (*text)(const sh::KnownConvention& known);
};

std::string normalization_of(const sh::KnownConvention& known) {
  const sh::Convention& c = known.convention;
  return c.functions == sh::Functions::sphere ? to_string(c.normalization, c.role) : to_string(c.functions);
}
std::string notes_of(const sh::KnownConvention& known) {
  std::string text = known.notes;
  if (known.unstated.empty()) return text;
  if (!text.empty()) text += "; ";
  return text + "its source leaves open: " + known.unstated;
}

constexpr std::array kColumns{
    Column{"name", [](const sh::KnownConvention& k) { return "`" + k.name + "`"; }},
    Column{"who", [](const sh::KnownConvention& k) { return k.project; }},
    Column{"where", [](const sh::KnownConvention& k) { return k.where; }},
    Column{"arrangement", [](const sh::KnownConvention& k) { return to_string(k.convention.arrangement); }},
    Column{"sign", [](const sh::KnownConvention& k) { return to_string(k.convention.sign); }},
    Column{"axes", [](const sh::KnownConvention& k) { return to_string(k.convention.axes); }},
    Column{"normalisation", normalization_of},
    Column{"of", [](const sh::KnownConvention& k) { return to_string(k.convention.quantity); }},
    Column{"layout", [](const sh::KnownConvention& k) { return to_string(k.convention.layout); }},
    Column{"notes", notes_of},
};

std::string markdown() {
  std::string text = "|";
  for (const Column& column : kColumns) text += fmt::format(" {} |", column.title);
  text += "\n|";
  for (std::size_t i = 0; i < kColumns.size(); ++i) text += " --- |";
  text += "\n";
  for (const sh::KnownConvention& known : sh::known_conventions()) {
    text += "|";
    for (const Column& column : kColumns) {
      const std::string cell = column.text(known);
      text += cell.empty() ? " |" : " " + cell + " |";
    }
    text += "\n";
  }
  return text;
}

std::string listing() {
  std::string text;
  for (const sh::KnownConvention& known : sh::known_conventions()) {
    const sh::Convention& c = known.convention;
    text += fmt::format("{:<30} {}: {}\n{:<30} {}; {}; axes {}; {} of {}; {}\n", known.name, known.project,
                        known.where, "", to_string(c.arrangement), to_string(c.sign), to_string(c.axes),
                        normalization_of(known), to_string(c.quantity), to_string(c.layout));
    const std::string notes = notes_of(known);
    if (!notes.empty()) text += fmt::format("{:<30} {}\n", "", notes);
  }
  return text;
}

nlohmann::json json_listing() {
  nlohmann::json rows = nlohmann::json::array();
  for (const sh::KnownConvention& known : sh::known_conventions()) {
    nlohmann::json row = nlohmann::json::object();
    for (const Column& column : kColumns) row[column.title] = column.text(known);
    row["name"] = known.name;
    row["max_bands"] = known.max_bands;
    rows.push_back(std::move(row));
  }
  return {{"conventions", rows}};
}

// ---------------------------------------------------------------- each of them written and recognised again

struct Recognition {
  std::string verdict;  // "right" or what is wrong
  std::size_t equal = 0;
  double residual = 0.0;
  double next_residual = 0.0;
  double log10_odds = 0.0;
};

/// The light in a known convention, rounded to single precision, put before identify.
Recognition recognised(const sh::KnownConvention& known, const sh::ShRgb& light) {
  constexpr int kBands = 3;
  const auto count = static_cast<std::ptrdiff_t>(sh::coefficient_count(kBands));
  const sh::ShRgb low{kBands, {light.coefficients.begin(), light.coefficients.begin() + count}};
  const bool is_half = known.convention.functions != sh::Functions::sphere;
  std::vector<double> values = sh::from_ours(is_half ? light : low, known.convention);
  for (double& v : values) v = static_cast<double>(static_cast<float>(v));
  const sh::Identification answer = sh::identify(values, light);
  const sh::Candidate& best = answer.ranking.front();
  Recognition result;
  const bool is_named = std::find(best.known.begin(), best.known.end(), known.name) != best.known.end();
  if (answer.verdict != sh::Verdict::identified) {
    result.verdict = answer.verdict == sh::Verdict::undecided ? "undecided" : "unexplained";
  } else {
    result.verdict = is_named ? "right" : "WRONG";
  }
  result.equal = best.known.size();
  result.residual = best.residual;
  if (answer.ranking.size() > 1) {
    result.next_residual = answer.ranking[1].residual;
    result.log10_odds = answer.ranking[1].log_odds_behind_best / std::log(10.0);
  }
  return result;
}

int report_recognition(const Options& options) {
  constexpr int kBandsOfLight = 20;
  const sh::ShRgb light = sh::project_radiance(load(options.light), kBandsOfLight);
  std::string text = fmt::format("{:<30} {:<12} {:>10} {:>10} {:>10} {:>12}\n", "convention", "identify",
                                 "same as", "residual", "the next", "log10 odds");
  nlohmann::json rows = nlohmann::json::array();
  int code = kSuccess;
  for (const sh::KnownConvention& known : sh::known_conventions()) {
    const Recognition r = recognised(known, light);
    if (r.verdict != "right") code = kCheckFailed;
    text += fmt::format("{:<30} {:<12} {:>10} {:>10.1e} {:>10.1e} {:>12.1f}\n", known.name, r.verdict,
                        r.equal, r.residual, r.next_residual, r.log10_odds);
    rows.push_back({{"name", known.name},
                    {"identify", r.verdict},
                    {"same_numbers", r.equal},
                    {"residual", number(r.residual)},
                    {"next_residual", number(r.next_residual)},
                    {"log10_odds", number(r.log10_odds)}});
  }
  if (options.json != "-") write_output("-", text);
  write_json(options.json, {{"conventions", rows}});
  return code;
}

int run(const Options& options) {
  require_destinations({{"--json", options.json, ""}});
  if (!options.light.source.empty()) return report_recognition(options);
  if (options.json != "-") write_output("-", options.is_markdown ? markdown() : listing());
  write_json(options.json, json_listing());
  return kSuccess;
}

}  // namespace

void register_conventions(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("conventions", "list the spherical-harmonic conventions of others");
  verb->add_flag("--markdown", options->is_markdown, "as the table of CONVENTIONS.md");
  add_light_options(*verb, options->light, false);
  add_json(*verb, options->json, "the list");
  verb->footer(
      "With --env: whether identify recognises each, from that light in single precision; exit code 1 when "
      "not.\n"
      "Write coefficients in one of them: plumbline project ENV --bands 3 --convention NAME\n"
      "Find out which one coefficients are in: plumbline identify COEFFS.json --env ENV\n"
      "Example: plumbline conventions");
  on_chosen(*verb, options, chosen, &run);
}

}  // namespace plumbline::app
