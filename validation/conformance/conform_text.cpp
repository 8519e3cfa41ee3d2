// What `plumbline conform` shows: tables for a terminal, and reports.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "validation/conformance/conform.hpp"
#include "validation/report/text.hpp"

namespace plumbline::conformance {
namespace {

std::string time_text(const Line& line) {
  if (!line.nanoseconds) return "-";
  const std::string theirs = fmt::format("{:.4g}", *line.nanoseconds);
  if (!line.our_nanoseconds) return theirs;
  return fmt::format("{} ({:.2g} x ours)", theirs, *line.nanoseconds / *line.our_nanoseconds);
}

std::string bands_text(int bands) {
  return bands > 0 ? std::to_string(bands) : "-";
}

/// The finding's name without the bands, which have a column.
std::string check_text(const Judged& judged) {
  const std::string suffix = fmt::format(" / {} bands", judged.bands);
  const std::string& name = judged.finding.name;
  return name.ends_with(suffix) ? name.substr(0, name.size() - suffix.size()) : name;
}

/// Columns as wide as their widest cell.
std::string aligned(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i + 1 < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i)
      text += i + 1 < row.size() ? fmt::format("{:<{}}  ", row[i], widths[i]) : row[i];
    while (text.ends_with(' ')) text.pop_back();
    text += '\n';
  }
  return text;
}

struct Counts {
  std::size_t passed = 0;
  std::size_t failed = 0;
  std::size_t undecided = 0;
};

Counts counted(const Verdict& verdict) {
  Counts counts;
  for (const Line& line : verdict.lines) {
    switch (report::verdict(line.judged.finding)) {
      case checks::Verdict::pass:
        ++counts.passed;
        break;
      case checks::Verdict::fail:
        ++counts.failed;
        break;
      case checks::Verdict::inconclusive:
        ++counts.undecided;
    }
  }
  return counts;
}

std::string list(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text;
}

const std::vector<std::string>& columns() {
  static const std::vector<std::string> kColumns{"operation", "check",   "bands",      "error",
                                                 "bound",     "verdict", "ns per call"};
  return kColumns;
}

std::vector<std::string> cells(const Line& line) {
  const checks::Finding& f = line.judged.finding;
  return {f.family,
          check_text(line.judged),
          bands_text(line.judged.bands),
          report::format_interval(f.measured, f.uncertainty),
          report::format_number(f.bound),
          checks::to_string(report::verdict(f)),
          time_text(line)};
}

/// Faults as rows, checks that reject any as columns.
struct Matrix {
  std::vector<std::string> checks;
  std::vector<std::set<std::string>> rows;
};

std::string place_of(const Judged& judged) {
  return judged.finding.family + ": " + check_text(judged);
}

Matrix matrix_of(const std::vector<Kill>& kills) {
  Matrix matrix;
  for (const Kill& kill : kills) {
    std::set<std::string> row;
    for (const Judged& failure : kill.failures) {
      const std::string place = place_of(failure);
      row.insert(place);
      if (std::find(matrix.checks.begin(), matrix.checks.end(), place) == matrix.checks.end())
        matrix.checks.push_back(place);
    }
    matrix.rows.push_back(std::move(row));
  }
  return matrix;
}

std::string named_cause(const Kill& kill) {
  for (const Judged& failure : kill.failures) {
    const std::string place = failure.finding.family + ": " + failure.finding.name;
    if (place.starts_with(kill.fault->check) && failure.cause.find(kill.fault->cause) != std::string::npos)
      return failure.cause;
  }
  return kill.failures.empty() ? "" : kill.failures.front().cause;
}

const char* outcome(const Kill& kill) {
  return kill.is_named ? "named" : kill.is_caught ? "caught" : "SURVIVES";
}

struct Score {
  std::size_t caught = 0;
  std::size_t named = 0;
};
Score score_of(const std::vector<Kill>& kills) {
  Score score;
  for (const Kill& kill : kills) {
    score.caught += kill.is_caught ? 1U : 0U;
    score.named += kill.is_named ? 1U : 0U;
  }
  return score;
}

}  // namespace

std::string to_text(const Verdict& verdict) {
  std::string text;
  if (!verdict.name.empty()) text = fmt::format("{}\n{}\n\n", verdict.name, verdict.convention);
  std::vector<std::vector<std::string>> rows{columns()};
  for (const Line& line : verdict.lines) rows.push_back(cells(line));
  text += aligned(rows);
  for (const Line& line : verdict.lines) {
    const checks::Finding& f = line.judged.finding;
    if (report::verdict(f) == checks::Verdict::pass) continue;
    text += fmt::format("\n{}: {}: {}\n  {}\n", checks::to_string(report::verdict(f)), f.family, f.name,
                        f.detail);
  }
  if (!verdict.not_offered.empty())
    text += fmt::format("\nnot offered, not judged: {}\n", list(verdict.not_offered));
  const Counts counts = counted(verdict);
  return text + fmt::format("\n{} checks: {} passed, {} failed, {} inconclusive\n", verdict.lines.size(),
                            counts.passed, counts.failed, counts.undecided);
}

report::Report to_report(const Verdict& verdict) {
  report::Report report;
  report.title = fmt::format("Conformance of {}", verdict.name.empty() ? "a library" : verdict.name);
  report.summary =
      "A spherical-harmonics implementation held against definitions, closed forms and exact quadrature.";
  const Counts counts = counted(verdict);
  report.headlines = {
      {"checks passed", fmt::format("{} of {}", counts.passed, verdict.lines.size()), "all is good"}};
  if (!verdict.convention.empty()) report.settings.emplace_back("declared convention", verdict.convention);
  if (!verdict.not_offered.empty())
    report.settings.emplace_back("not offered, not judged", list(verdict.not_offered));
  report::Table table{
      "Operations", "Times are of one call, beside our own library's in the same process.", columns(), {}};
  for (const Line& line : verdict.lines) {
    report.findings.push_back(line.judged.finding);
    table.rows.push_back(cells(line));
  }
  report.tables.push_back(std::move(table));
  return report;
}

std::string to_text(const std::vector<Kill>& kills) {
  std::vector<std::vector<std::string>> rows{{"fault", "outcome", "checks that reject it", "cause given"}};
  for (const Kill& kill : kills)
    rows.push_back(
        {kill.fault->name, outcome(kill), std::to_string(kill.failures.size()), named_cause(kill)});
  std::string text = aligned(rows);
  const Matrix matrix = matrix_of(kills);
  text += "\nchecks, by the faults they reject:\n";
  for (const std::string& check : matrix.checks) {
    std::string names;
    for (std::size_t i = 0; i < kills.size(); ++i)
      if (matrix.rows[i].contains(check)) names += fmt::format(" {}", kills[i].fault->name);
    text += fmt::format("  {}:{}\n", check, names);
  }
  text += "\nlight transport, judged with scenes and not here:\n";
  for (const UnjudgedFault& fault : transport_faults())
    text += fmt::format("  {}: {}\n", fault.name, fault.wrong);
  const Score score = score_of(kills);
  return text + fmt::format("\n{} faults x {} checks: {} caught, {} with the expected check and cause\n",
                            kills.size(), matrix.checks.size(), score.caught, score.named);
}

report::Report to_report(const std::vector<Kill>& kills) {
  report::Report report;
  report.title = "Seeded faults";
  report.summary =
      "Known mistakes of public code, published listings and issue reports, each behind the conformance "
      "interface.";
  const Score score = score_of(kills);
  report.headlines = {{"faults caught", fmt::format("{} of {}", score.caught, kills.size()), "all is good"},
                      {"cause named", fmt::format("{} of {}", score.named, kills.size()), "all is good"}};
  report::Table causes{"Faults and the causes given",
                       "The cause is derived from the answers alone.",
                       {"fault", "seen in", "what is wrong", "outcome", "cause given"},
                       {}};
  const Matrix matrix = matrix_of(kills);
  report::Table table{"Kill matrix", "A dot where a check rejects a fault.", {"check"}, {}};
  for (const Kill& kill : kills) {
    causes.rows.push_back(
        {kill.fault->name, kill.fault->seen, kill.fault->wrong, outcome(kill), named_cause(kill)});
    table.columns.emplace_back(kill.fault->name);
    checks::Finding finding;
    finding.family = "seeded faults";
    finding.name = kill.fault->name;
    finding.measured = kill.is_named ? 0.0 : 1.0;
    finding.verdict = kill.is_named ? checks::Verdict::pass : checks::Verdict::fail;
    finding.source = "Every fault is caught, by the expected check, with the expected cause";
    finding.detail = named_cause(kill);
    report.findings.push_back(std::move(finding));
  }
  for (const std::string& check : matrix.checks) {
    std::vector<std::string> row{check};
    for (const auto& failures : matrix.rows) row.emplace_back(failures.contains(check) ? "●" : "");
    table.rows.push_back(std::move(row));
  }
  report::Table transport{"Light transport", "Judged with scenes, not here.", {"fault", "what is wrong"}, {}};
  for (const UnjudgedFault& fault : transport_faults()) transport.rows.push_back({fault.name, fault.wrong});
  report.tables = {std::move(causes), std::move(table), std::move(transport)};
  return report;
}

}  // namespace plumbline::conformance
