#include "validation/conformance/conform.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "reference/base/error.hpp"
#include "validation/conformance/adapters/plumbline_sh.hpp"
#include "validation/conformance/child.hpp"
#include "validation/conformance/library.hpp"
#include "validation/conformance/timing.hpp"
#include "validation/report/text.hpp"

namespace plumbline::conformance {
namespace {

using nlohmann::json;

// CBOR, for JSON's text has no NaN.
std::string packed(const json& value) {
  const std::vector<std::uint8_t> bytes = json::to_cbor(value);
  return {bytes.begin(), bytes.end()};
}
json unpacked(const std::string& text) {
  return json::from_cbor(text.begin(), text.end());
}

json to_json(const Judged& judged) {
  const checks::Finding& f = judged.finding;
  return {{"family", f.family},
          {"name", f.name},
          {"measured", f.measured},
          {"bound", f.bound},
          {"unit", f.unit},
          {"verdict", static_cast<int>(f.verdict)},
          {"source", f.source},
          {"detail", f.detail},
          {"seed", f.seed},
          {"seconds", f.seconds},
          {"bands", judged.bands},
          {"cause", judged.cause},
          {"uncertainty", f.uncertainty}};
}

Judged judged_from(const json& value) {
  Judged judged;
  checks::Finding& f = judged.finding;
  f.family = value.at("family");
  f.name = value.at("name");
  f.measured = value.at("measured");
  f.uncertainty = value.at("uncertainty");
  f.bound = value.at("bound");
  f.unit = value.at("unit");
  f.verdict = static_cast<checks::Verdict>(value.at("verdict").get<int>());
  f.source = value.at("source");
  f.detail = value.at("detail");
  f.seed = value.at("seed");
  f.seconds = value.at("seconds");
  judged.bands = value.at("bands");
  judged.cause = value.at("cause");
  return judged;
}

Judged failure(const std::string& operation, const std::string& name, const std::string& cause) {
  Judged judged;
  judged.finding.family = operation;
  judged.finding.name = name;
  judged.finding.measured = std::numeric_limits<double>::quiet_NaN();
  judged.finding.verdict = checks::Verdict::fail;
  judged.finding.source = "Contract of the interface";
  judged.finding.detail = cause;
  judged.cause = cause;
  return judged;
}

// ---------------------------------------------------------------- in the child
const plumbline_implementation& loaded(const std::string& library) {
  const Loaded result = load_library(library);
  if (result.implementation == nullptr) throw InputError(result.fault);
  return *result.implementation;
}

/// What the library says about itself, and which checks apply.
std::string introduce(const std::string& library) {
  const Loaded result = load_library(library);
  json answer{{"fault", report::clean_text(result.fault)}, {"checks", json::array()}};
  if (result.implementation != nullptr) {
    answer["name"] = report::clean_text(result.implementation->name);
    answer["convention"] = to_string(result.implementation->convention);
    for (const Check& check : all_checks()) answer["checks"].push_back(check.applies(*result.implementation));
  }
  return packed(answer);
}

std::string judge(const std::string& library, const Check& check, int bands) {
  json answer = json::array();
  for (const Judged& judged : run_check(check, loaded(library), bands)) answer.push_back(to_json(judged));
  return packed(answer);
}

std::string time(const std::string& library, const std::string& operation, int bands) {
  const plumbline_implementation& theirs = loaded(library);
  const int usable = std::min({bands, theirs.max_bands, Border(theirs.convention, 1).usable_bands(bands)});
  json answer = json::array();
  for (const auto& ns :
       {nanoseconds(theirs, operation, usable), nanoseconds(plumbline_sh(), operation, usable)})
    answer.push_back(ns ? json(*ns) : json());
  return packed(answer);
}

// ---------------------------------------------------------------- in the parent
/// A whole answer, or none where the child's fate or nonsense came instead.
std::optional<json> answer_of(const ChildResult& child) {
  if (!child.is_complete) return std::nullopt;
  try {
    return unpacked(child.text);
  } catch (const json::exception&) {
    return std::nullopt;
  }
}

std::string fate_of(const ChildResult& child) {
  return child.fate.empty() ? "spoils the judge's memory" : child.fate;
}

void append_lines(Verdict& verdict, const Request& request, const Check& check) {
  const ChildResult child =
      run_in_child([&] { return judge(request.library, check, request.bands); }, request.seconds);
  const std::optional<json> answer = answer_of(child);
  if (!answer) {
    verdict.lines.push_back({failure(check.operation, check.name, fate_of(child)), {}, {}});
    return;
  }
  for (const json& one : *answer) verdict.lines.push_back({judged_from(one), {}, {}});
}

void append_times(Verdict& verdict, const Request& request) {
  std::map<std::string, json> times;
  for (Line& line : verdict.lines) {
    const std::string& operation = line.judged.finding.family;
    if (!times.contains(operation)) {
      const ChildResult child =
          run_in_child([&] { return time(request.library, operation, request.bands); }, request.seconds);
      times[operation] = answer_of(child).value_or(json{nullptr, nullptr});
    }
    const json& pair = times[operation];
    if (pair.size() != 2) continue;
    if (pair[0].is_number()) line.nanoseconds = pair[0].get<double>();
    if (pair[1].is_number()) line.our_nanoseconds = pair[1].get<double>();
  }
}

Verdict introduced(const Request& request, std::vector<bool>& applies) {
  Verdict verdict;
  const ChildResult child = run_in_child([&] { return introduce(request.library); }, request.seconds);
  const std::optional<json> answer = answer_of(child);
  if (!answer) {
    verdict.lines.push_back({failure("library", "load", fate_of(child)), {}, {}});
    return verdict;
  }
  const std::string fault = answer->at("fault");
  if (fault.starts_with("cannot be loaded")) throw InputError(fmt::format("{}: {}", request.library, fault));
  if (!fault.empty()) {
    verdict.lines.push_back({failure("library", "struct", fault), {}, {}});
    return verdict;
  }
  verdict.name = answer->at("name");
  verdict.convention = answer->at("convention");
  for (const json& one : answer->at("checks")) applies.push_back(one.get<bool>());
  return verdict;
}

}  // namespace

Verdict conform(const Request& request) {
  if (!std::filesystem::is_regular_file(request.library))
    throw InputError(fmt::format("{}: {}", request.library,
                                 std::filesystem::exists(request.library) ? "not a file" : "no such file"));
  std::vector<bool> applies;
  Verdict verdict = introduced(request, applies);
  const std::vector<Check> checks = all_checks();
  std::vector<std::string> offered;
  for (std::size_t i = 0; i < applies.size(); ++i) {
    const std::string operation = checks[i].operation;
    if (applies[i]) {
      append_lines(verdict, request, checks[i]);
      offered.push_back(operation);
    } else if (std::find(verdict.not_offered.begin(), verdict.not_offered.end(), operation) ==
               verdict.not_offered.end()) {
      verdict.not_offered.push_back(operation);
    }
    if (request.progress)
      request.progress(static_cast<double>(i + 1) / static_cast<double>(applies.size() + 4));
  }
  std::erase_if(verdict.not_offered, [&](const std::string& operation) {
    return std::find(offered.begin(), offered.end(), operation) != offered.end();
  });
  if (!applies.empty() && offered.empty())
    verdict.lines.push_back(
        {failure("library", "functions", "offers no function: nothing to judge"), {}, {}});
  append_times(verdict, request);
  if (request.progress) request.progress(1.0);
  return verdict;
}

std::vector<Kill> kill_matrix(const std::vector<Fault>& faults, int bands,
                              const std::function<void(double)>& progress) {
  std::vector<Kill> kills;
  for (const Fault& fault : faults) {
    kills.push_back(judge_fault(fault, bands));
    if (progress) progress(static_cast<double>(kills.size()) / static_cast<double>(faults.size()));
  }
  return kills;
}

}  // namespace plumbline::conformance
