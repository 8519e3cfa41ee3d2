// plumbline conform: judges somebody else's implementation.
#include <fmt/format.h>

#include <memory>

#include "reference/base/error.hpp"
#include "validation/app/options.hpp"
#include "validation/app/verbs.hpp"
#include "validation/conformance/conform.hpp"
#include "validation/conformance/exchange.hpp"

namespace plumbline::app {
namespace {

struct Options {
  std::string library;
  std::string export_folder;
  std::string import_folder;
  bool is_faults = false;
  int bands = 6;
  double seconds = 20.0;
  std::string json;
  std::string html;
  std::string junit;
};

void write_reports(const Options& options, report::Report report, const std::string& what) {
  report.version = PLUMBLINE_VERSION;
  report.command = fmt::format("plumbline conform {} --bands {}", what, options.bands);
  if (!options.json.empty()) write_output(options.json, report::to_json(report).dump(2) + "\n");
  if (!options.html.empty()) write_output(options.html, report::to_html(report));
  if (!options.junit.empty()) write_output(options.junit, report::to_junit(report));
}

int finish(const Options& options, const report::Report& report, const std::string& what,
           const std::string& text) {
  write_reports(options, report, what);
  if (options.json != "-" && options.junit != "-" && options.html != "-") write_output("-", text);
  return report::verdict(report) == checks::Verdict::fail ? kCheckFailed : kSuccess;
}

int run_faults(const Options& options) {
  const std::vector<conformance::Fault> faults = conformance::all_faults();
  const std::vector<conformance::Kill> kills =
      conformance::kill_matrix(faults, options.bands, progress_bar("judging faults"));
  return finish(options, conformance::to_report(kills), "--faults", conformance::to_text(kills));
}

int run_import(const Options& options) {
  const conformance::Verdict verdict = conformance::judge_answers(options.import_folder);
  return finish(options, conformance::to_report(verdict), "--import " + quoted(options.import_folder),
                conformance::to_text(verdict));
}

int run_library(const Options& options) {
  const conformance::Verdict verdict =
      conformance::conform({options.library, options.bands, options.seconds, progress_bar("judging")});
  return finish(options, conformance::to_report(verdict), quoted(options.library),
                conformance::to_text(verdict));
}

int run(const Options& options) {
  const int asked = (options.library.empty() ? 0 : 1) + (options.export_folder.empty() ? 0 : 1) +
                    (options.import_folder.empty() ? 0 : 1) + (options.is_faults ? 1 : 0);
  if (asked != 1) throw InputError("conform: expected one of LIBRARY, --export, --import and --faults");
  require_destinations(
      {{"--json", options.json, ""}, {"--html", options.html, ""}, {"--junit", options.junit, ""}});
  if (options.is_faults) return run_faults(options);
  if (!options.import_folder.empty()) return run_import(options);
  if (options.export_folder.empty()) return run_library(options);
  conformance::write_questions(options.export_folder, options.bands);
  say(fmt::format("questions: {}; answer as README.txt there says, then: plumbline conform --import {}",
                  options.export_folder, quoted(options.export_folder)));
  return kSuccess;
}

}  // namespace

void register_conform(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("conform", "judges another implementation of spherical harmonics");
  verb->add_option(
      "LIBRARY", options->library,
      "a shared library that exports plumbline_conformance_entry (validation/conformance/README.md)");
  verb->add_option("--export", options->export_folder, "write questions for an engine that cannot be linked")
      ->type_name("DIR");
  verb->add_option("--import", options->import_folder, "judge the answers in a folder of --export")
      ->type_name("DIR");
  verb->add_flag("--faults", options->is_faults,
                 "judge the catalogue of seeded faults: which check rejects which");
  add_whole_number(*verb, "--bands", options->bands, {1, 20}, "number of bands to judge at (default 6)");
  add_positive(*verb, "--seconds", options->seconds, "time limit for each check (default 20)");
  add_json(*verb, options->json, "findings and table");
  verb->add_option("--html", options->html, "write the report as one HTML page")->type_name("FILE");
  verb->add_option("--junit", options->junit, "write the findings as JUnit XML")->type_name("FILE");
  verb->footer("Example: plumbline conform build/conformance/libgsl_conformance.so --html gsl.html");
  on_chosen(*verb, options, chosen, run);
}

}  // namespace plumbline::app
