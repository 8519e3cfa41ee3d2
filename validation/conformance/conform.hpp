// validation/conformance/conform.hpp: judges an implementation in child processes, and the report of it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "validation/conformance/check.hpp"
#include "validation/conformance/faults/catalogue.hpp"
#include "validation/report/report.hpp"

namespace plumbline::conformance {

struct Request {
  std::string library;    // path
  int bands = 6;          // 1 … 20
  double seconds = 20.0;  // for each check
  std::function<void(double fraction)> progress;
};

/// A finding with the times of the operation it is about.
struct Line {
  Judged judged;
  std::optional<double> nanoseconds;      // theirs
  std::optional<double> our_nanoseconds;  // ours
};
struct Verdict {
  std::string name;        // what the implementation calls itself; empty when it could not be asked
  std::string convention;  // as declared, in words
  std::vector<Line> lines;
  std::vector<std::string> not_offered;  // operations without a function
};

/// Loads the library in a child process for every check. What the library does to a child (crash, hang, exit, lie
/// about its struct) is a failing line. @throws InputError when there is no such file or it is no shared library
[[nodiscard]] Verdict conform(const Request& request);

/// The table for a terminal: operation and check, bands, error, bound, verdict, nanoseconds; causes below each failure.
[[nodiscard]] std::string to_text(const Verdict& verdict);
/// Findings, the table, the convention.
[[nodiscard]] report::Report to_report(const Verdict& verdict);

/// Every fault under every check of its operation.
[[nodiscard]] std::vector<Kill> kill_matrix(const std::vector<Fault>& faults, int bands,
                                            const std::function<void(double)>& progress);
/// Fault by check ("x": rejects, "N": rejects and names the cause), and the score.
[[nodiscard]] std::string to_text(const std::vector<Kill>& kills);
[[nodiscard]] report::Report to_report(const std::vector<Kill>& kills);

}  // namespace plumbline::conformance
