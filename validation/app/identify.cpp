// plumbline identify: which spherical-harmonic convention coefficients are in.
#include "prt/sh/identify.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "reference/base/error.hpp"
#include "validation/app/csv_table.hpp"
#include "validation/app/numbers_json.hpp"
#include "validation/app/options.hpp"
#include "validation/app/verbs.hpp"

namespace plumbline::app {
namespace {

struct Options {
  std::string input;
  LightOptions light;
  std::string directions;
  std::string json;
};

// ---------------------------------------------------------------- what was projected

/// Directional lights: c_lm = sum of irradiance times y_lm(direction).
sh::ShRgb light_of_directions(const std::string& path, int bands) {
  sh::ShRgb light{bands,
                  std::vector<RgbD>(static_cast<std::size_t>(sh::coefficient_count(bands)), RgbD(0.0))};
  for (const CsvRow& row : read_csv(path, {"x", "y", "z", "r", "g", "b"}, "directions")) {
    const std::vector<double>& v = row.values;
    const Vec3d direction(v[0], v[1], v[2]);
    const double length = glm::length(direction);
    if (!(length > 0.0 && std::isfinite(length)))
      throw InputError(row.where + ": the direction has no length");
    const std::vector<double> y = sh::evaluate_basis(bands, direction / length);
    for (std::size_t i = 0; i < y.size(); ++i) light.coefficients[i] += y[i] * RgbD(v[3], v[4], v[5]);
  }
  return light;
}

sh::ShRgb light_of(const Options& options, const std::vector<double>& values) {
  int bands = 1;
  for (const sh::Split& split : sh::splits_of(values.size())) bands = std::max(bands, split.bands);
  if (!options.directions.empty()) return light_of_directions(options.directions, bands);
  // Functions on a hemisphere see all bands: more of them for numbers that could be theirs.
  constexpr int kBandsForFew = 20;
  const bool is_half_possible = sh::is_half_count(values.size());
  return sh::project_radiance(load(options.light), is_half_possible ? std::max(bands, kBandsForFew) : bands);
}

// ---------------------------------------------------------------- words

std::string scaling_of(const sh::Convention& c) {
  return c.functions == sh::Functions::sphere ? to_string(c.normalization, c.role) : to_string(c.functions);
}

std::string layout_of(const sh::Candidate& candidate, const sh::Convention& reading) {
  const bool is_list = candidate.is_one_channel && reading.layout == sh::Layout::planar;
  return is_list ? "one channel" : to_string(reading.layout);
}

std::string quantity_of(const sh::Candidate& candidate, const sh::Convention& reading) {
  std::string text = to_string(reading.quantity);
  if (!reading.factors.empty())
    text = fmt::format("L times {:.5g} by degree", fmt::join(reading.factors, ", "));
  if (candidate.scale != 1.0) text += fmt::format(", all times {:.6g}", candidate.scale);
  return text;
}

/// A scale that somebody forgot or applied twice.
std::string remark_on_scale(double scale) {
  const std::array<std::pair<double, const char*>, 8> familiar{{{kPi, "pi"},
                                                                {1.0 / kPi, "1/pi"},
                                                                {4.0 * kPi, "4 pi"},
                                                                {0.25 / kPi, "1/(4 pi)"},
                                                                {2.0 * kPi, "2 pi"},
                                                                {0.5 / kPi, "1/(2 pi)"},
                                                                {2.0, "2"},
                                                                {0.5, "1/2"}}};
  constexpr double kNear = 1e-3;
  for (const auto& [value, name] : familiar) {
    if (std::abs(scale / value - 1.0) <= kNear) return fmt::format("the scale is {}", name);
  }
  return "";
}

std::string names_of(const std::vector<std::string>& names) {
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "));
}

std::string reading_line(const sh::Candidate& candidate, const sh::Convention& reading) {
  return fmt::format("{}; {} with axes {}; {} of {}; {}", to_string(reading.arrangement),
                     to_string(reading.sign), to_string(reading.axes), scaling_of(reading),
                     quantity_of(candidate, reading), layout_of(candidate, reading));
}

std::string odds_text(double log_odds) {
  if (log_odds <= 0.0) return "best";
  return fmt::format("odds 1 : 10^{:.1f}", log_odds / std::log(10.0));
}

std::string ranking_text(const sh::Identification& answer) {
  std::string text;
  for (std::size_t i = 0; i < answer.ranking.size(); ++i) {
    const sh::Candidate& candidate = answer.ranking[i];
    text += fmt::format("  {}. residual {:.2g}, {}: {}\n     {}\n", i + 1, candidate.residual,
                        odds_text(candidate.log_odds_behind_best),
                        candidate.known.empty() ? "no known project" : names_of(candidate.known),
                        reading_line(candidate, candidate.readings.front()));
  }
  return text;
}

std::string answer_text(const sh::Candidate& best) {
  constexpr std::size_t kShownReadings = 4;
  const sh::Convention& first = best.readings.front();
  std::string text;
  const auto add = [&text](const char* name, const std::string& value) {
    text += fmt::format("  {:<14} {}\n", name, value);
  };
  if (best.bands > 0) add("bands", std::to_string(best.bands));
  add("arrangement", to_string(first.arrangement));
  add("sign", to_string(first.sign));
  add("axes", fmt::format("{} (their x, y, z in yours{})", to_string(first.axes),
                          is_mirrored(first.axes) ? "; mirrored" : ""));
  add("normalisation", scaling_of(first));
  add("quantity", quantity_of(best, first));
  add("layout", layout_of(best, first));
  add("known as", names_of(best.known));
  const std::string remark = remark_on_scale(best.scale);
  if (!remark.empty()) add("note", remark);
  for (std::size_t i = 1; i < std::min(best.readings.size(), kShownReadings); ++i) {
    add(i == 1 ? "the same as" : "", reading_line(best, best.readings[i]));
  }
  if (best.readings.size() > kShownReadings) {
    add("", fmt::format("and {} more readings that give the same numbers for every light",
                        best.readings.size() - kShownReadings));
  }
  return text;
}

std::string verdict_text(const Options& options, const Numbers& numbers, const sh::Identification& answer) {
  std::string text = fmt::format("{}: {} numbers: ", options.input, numbers.values.size());
  switch (answer.verdict) {
    case sh::Verdict::identified:
      text += "identified\n" + answer_text(answer.ranking.front());
      break;
    case sh::Verdict::undecided:
      text += fmt::format("cannot be decided: {} conventions fit equally well\n", answer.tied);
      for (const std::string& line : answer.undecided) text += "  undecided: " + line + "\n";
      for (const std::string& line : answer.would_decide) text += "  would decide " + line + "\n";
      break;
    case sh::Verdict::unexplained:
      text += "no convention explains them: these are not coefficients of that light, or not its bands\n";
      break;
  }
  text += "the nearest:\n" + ranking_text(answer);
  if (!numbers.stated_convention.empty()) text += "the file says: " + numbers.stated_convention + "\n";
  return text;
}

nlohmann::json reading_json(const sh::Candidate& candidate, const sh::Convention& reading) {
  nlohmann::json json = {{"arrangement", to_string(reading.arrangement)},
                         {"sign", to_string(reading.sign)},
                         {"axes", to_string(reading.axes)},
                         {"mirrored", is_mirrored(reading.axes)},
                         {"normalisation", scaling_of(reading)},
                         {"quantity", to_string(reading.quantity)},
                         {"layout", layout_of(candidate, reading)}};
  if (!reading.factors.empty()) json["factors"] = reading.factors;
  return json;
}

const char* name_of(sh::Verdict verdict) {
  if (verdict == sh::Verdict::identified) return "identified";
  return verdict == sh::Verdict::undecided ? "undecided" : "unexplained";
}

nlohmann::json answer_json(const sh::Identification& answer) {
  nlohmann::json ranking = nlohmann::json::array();
  for (const sh::Candidate& candidate : answer.ranking) {
    nlohmann::json readings = nlohmann::json::array();
    constexpr std::size_t kMostReadings = 100;
    for (std::size_t i = 0; i < std::min(candidate.readings.size(), kMostReadings); ++i) {
      readings.push_back(reading_json(candidate, candidate.readings[i]));
    }
    ranking.push_back({{"known", candidate.known},
                       {"bands", candidate.bands},
                       {"scale", number(candidate.scale)},
                       {"residual", number(candidate.residual)},
                       {"log10_odds_behind_best", number(candidate.log_odds_behind_best / std::log(10.0))},
                       {"readings", readings},
                       {"reading_count", candidate.readings.size()}});
  }
  return {{"verdict", name_of(answer.verdict)},
          {"tied", answer.tied},
          {"undecided", answer.undecided},
          {"would_decide", answer.would_decide},
          {"ranking", ranking}};
}

// ---------------------------------------------------------------- without a light

std::string split_name(const sh::Bound& bound) {
  const bool is_list = bound.is_one_channel && bound.convention.layout == sh::Layout::planar;
  return fmt::format("{} bands, {}", bound.bands,
                     is_list ? "one channel" : to_string(bound.convention.layout));
}

/// One line for what is possible and one for what is excluded, for each way to split the numbers.
std::string bounds_text(const std::vector<sh::Bound>& bounds) {
  std::vector<std::string> names;
  std::map<std::string, std::array<std::string, 2>> lines;
  for (const sh::Bound& bound : bounds) {
    const std::string name = split_name(bound);
    if (!lines.contains(name)) names.push_back(name);
    const sh::Convention& c = bound.convention;
    std::string& line = lines[name][bound.is_excluded ? 1 : 0];
    line += fmt::format("{}{} of {} ({:.3g} at degree {})", line.empty() ? "" : ", ",
                        to_string(c.normalization, c.role), to_string(c.quantity), bound.ratio, bound.degree);
  }
  std::string text;
  for (const std::string& name : names) {
    const auto& [possible, excluded] = lines[name];
    text += fmt::format("  {}\n    possible: {}\n    excluded: {}\n", name,
                        possible.empty() ? "none" : possible, excluded.empty() ? "none" : excluded);
  }
  return text;
}

int report_bounds(const Options& options, const Numbers& numbers) {
  const std::vector<sh::Bound> bounds = sh::passive_bounds(numbers.values);
  std::string text = fmt::format(
      "{}: {} numbers: cannot be decided without the light (--env or --directions)\n"
      "Bounds for a light that is nowhere negative, whatever its scale, sign and axes; above 1 is "
      "impossible:\n{}",
      options.input, numbers.values.size(), bounds_text(bounds));
  nlohmann::json rows = nlohmann::json::array();
  for (const sh::Bound& bound : bounds) {
    rows.push_back({{"normalisation", to_string(bound.convention.normalization, bound.convention.role)},
                    {"quantity", to_string(bound.convention.quantity)},
                    {"layout", to_string(bound.convention.layout)},
                    {"one_channel", bound.is_one_channel},
                    {"bands", bound.bands},
                    {"degree", bound.degree},
                    {"ratio", number(bound.ratio)},
                    {"excluded", bound.is_excluded}});
  }
  text +=
      "Numbers alone never tell the Condon-Shortley sign from half a turn about z, mirrored or exchanged "
      "axes,\n"
      "radiance from radiance/pi, irradiance E from E/pi, or other scales.\n";
  if (options.json != "-") write_output("-", text);
  write_json(options.json, {{"verdict", "undecided"}, {"bounds", rows}});
  return kCheckFailed;
}

int run(const Options& options) {
  require_destinations({{"--json", options.json, ""}});
  const Numbers numbers = read_numbers(options.input);
  const std::string fault = sh::fault_of_count(numbers.values.size());
  if (!fault.empty()) throw InputError(options.input + ": " + fault);
  if (options.light.source.empty() && options.directions.empty()) return report_bounds(options, numbers);
  const sh::Identification answer = sh::identify(numbers.values, light_of(options, numbers.values));
  if (options.json != "-") write_output("-", verdict_text(options, numbers, answer));
  write_json(options.json, answer_json(answer));
  return answer.verdict == sh::Verdict::identified ? kSuccess : kCheckFailed;
}

}  // namespace

void register_identify(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("identify", "which spherical-harmonic convention coefficients are in");
  verb->add_option("COEFFS", options->input,
                   "JSON: a list of numbers nested in any way, or an object with \"coefficients\"")
      ->required();
  add_light_options(*verb, options->light, false);
  CLI::Option* directions =
      verb->add_option("--directions", options->directions,
                       "CSV file, a line x,y,z,r,g,b a directional light: towards it, and its irradiance");
  directions->excludes(verb->get_option("--env"));
  add_json(*verb, options->json, "the answer");
  verb->footer(
      "Tells arrangement, sign, axes (48 signed permutations), normalisation, quantity and layout, with the "
      "three\n"
      "nearest conventions and the odds against each. Exit code 1 when the light cannot tell: it says what "
      "would.\n"
      "Best: let your code project one directional light from (2, 3, 6)/7 with irradiance 1, 2, 3, and give\n"
      "`echo 2,3,6,1,2,3 > d.csv` as --directions. Without a light only bounds on the numbers are checked.\n"
      "Example: plumbline identify coefficients.json --env sky.exr");
  on_chosen(*verb, options, chosen, &run);
}

}  // namespace plumbline::app
