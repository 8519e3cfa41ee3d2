#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/base/text.hpp"
#include "validation/regression/baseline.hpp"

namespace plumbline::regression {
namespace {

using nlohmann::json;

constexpr const char* kFormat = "plumbline baseline 1";

json json_of(const checks::Finding& f) {
  return {{"family", f.family},
          {"name", f.name},
          {"measured", f.measured},
          {"uncertainty", f.uncertainty},
          {"bound", f.bound},
          {"unit", f.unit},
          {"verdict", checks::to_string(f.verdict)}};
}

checks::Verdict verdict_of(const std::string& text) {
  for (const auto verdict : {checks::Verdict::pass, checks::Verdict::fail, checks::Verdict::inconclusive}) {
    if (text == checks::to_string(verdict)) return verdict;
  }
  throw InputError(
      fmt::format("verdict: expected pass, fail or inconclusive, got \"{}\"", one_line(text, 40)));
}

checks::Finding finding_of(const json& j) {
  checks::Finding f;
  f.family = j.at("family").get<std::string>();
  f.name = j.at("name").get<std::string>();
  f.measured = j.at("measured").get<double>();
  f.uncertainty = j.at("uncertainty").get<double>();
  f.bound = j.at("bound").get<double>();
  f.unit = j.at("unit").get<std::string>();
  f.verdict = verdict_of(j.at("verdict").get<std::string>());
  return f;
}

Quantity quantity_of(const json& j) {
  return {j.at("name").get<std::string>(), j.at("mean").get<double>(), j.at("standard_error").get<double>(),
          j.at("count").get<std::size_t>(), j.at("tolerance").get<double>()};
}

Baseline baseline_of(const json& j) {
  if (j.at("format") != kFormat) throw InputError(fmt::format("format: expected \"{}\"", kFormat));
  Baseline result;
  result.command = j.at("command").get<std::string>();
  result.seed = j.at("seed").get<std::uint64_t>();
  result.machine = j.at("machine").get<std::map<std::string, std::string>>();
  for (const json& one : j.at("findings")) result.findings.push_back(finding_of(one));
  for (const json& one : j.at("quantities")) result.quantities.push_back(quantity_of(one));
  for (const json& one : j.at("times"))
    result.times.push_back({one.at("name").get<std::string>(), one.at("seconds").get<std::vector<double>>()});
  for (const json& one : j.at("history")) {
    result.history.push_back({one.at("date").get<std::string>(), one.at("version").get<std::string>(),
                              one.at("reason").get<std::string>()});
  }
  return result;
}

}  // namespace

Baseline read_baseline(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  try {
    return baseline_of(json::parse(text));
  } catch (const std::exception& error) {  // of the JSON library, or one of ours above
    throw InputError(fmt::format("{}: no baseline: {}", path.string(), one_line(error.what())));
  }
}

std::string to_json(const Baseline& baseline) {
  json j = {{"format", kFormat},           {"command", baseline.command}, {"seed", baseline.seed},
            {"machine", baseline.machine}, {"findings", json::array()},   {"quantities", json::array()},
            {"times", json::array()},      {"history", json::array()}};
  for (const checks::Finding& f : baseline.findings) j["findings"].push_back(json_of(f));
  for (const Quantity& q : baseline.quantities) {
    j["quantities"].push_back({{"name", q.name},
                               {"mean", q.mean},
                               {"standard_error", q.standard_error},
                               {"count", q.count},
                               {"tolerance", q.tolerance}});
  }
  for (const KernelTimes& t : baseline.times)
    j["times"].push_back({{"name", t.name}, {"seconds", t.seconds}});
  for (const Revision& r : baseline.history)
    j["history"].push_back({{"date", r.date}, {"version", r.version}, {"reason", r.reason}});
  return j.dump(1, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace plumbline::regression
