// plumbline validate: an accuracy report.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/scene/load.hpp"
#include "validation/app/machine.hpp"
#include "validation/app/verbs.hpp"
#include "validation/checks/suite.hpp"
#include "validation/report/report.hpp"

namespace plumbline::app {
namespace {

struct Options {
  std::vector<std::string> scenes;
  SceneOptions scene;  // what all scenes share
  std::vector<std::string> environments;
  LightOptions light;  // what all environments share
  std::vector<int> bands = {3, 5};
  std::vector<std::string> families;
  std::string output;
  std::string junit;
  std::string json;
  std::string size = "384x288";
  std::string tier = "quick";
  checks::Budget budget;
};

std::string reproducing_command(const Options& o) {
  std::string command = "plumbline validate";
  for (const std::string& scene : o.scenes) command += " " + quoted(scene);
  if (o.scene.crease_deg > 0.0F) command += fmt::format(" --crease {}", o.scene.crease_deg);
  if (o.scene.has_ground) command += " --ground";
  for (const std::string& environment : o.environments) command += " --env " + quoted(environment);
  if (o.light.lookup != "nearest") command += " --env-lookup " + o.light.lookup;
  command += " --bands";
  for (const int bands : o.bands) command += fmt::format(" {}", bands);
  if (!o.families.empty()) command += fmt::format(" --checks {}", fmt::join(o.families, ","));
  if (o.tier != "quick") command += " --tier " + o.tier;
  command +=
      fmt::format(" --size {} --spp {} --samples {} --gather-samples {} --seed {}", o.size,
                  o.budget.image_samples, o.budget.bake_samples, o.budget.gather_samples, o.budget.seed);
  return command + " -o " + quoted(o.output);
}

checks::Suite make_suite(const Options& options) {
  checks::Suite suite;
  for (const int bands : options.bands) {
    if (bands < 1 || bands > 30)
      throw InputError(fmt::format("--bands: expected 1 to 30 for a validation, got {}", bands));
    suite.bands.push_back(bands);
  }
  std::sort(suite.bands.begin(), suite.bands.end());
  suite.bands.erase(std::unique(suite.bands.begin(), suite.bands.end()), suite.bands.end());
  for (const std::string& source : options.scenes) {
    SceneOptions one = options.scene;
    one.source = source;
    suite.scenes.push_back({checks::short_name(source), load(one), one.camera});
    (void)scene::find_camera(suite.scenes.back().scene, one.camera);
  }
  for (const std::string& source : options.environments) {
    LightOptions one = options.light;
    one.source = source;
    suite.environments.push_back(load(one));
  }
  suite.budget = options.budget;
  suite.budget.tier = options.tier == "nightly" ? checks::Tier::nightly : checks::Tier::quick;
  const Size size = parse_size(options.size);
  suite.budget.width = size.width;
  suite.budget.height = size.height;
  suite.announce = [](const std::string& what) { fmt::print(stderr, "plumbline: {}\n", what); };
  return suite;
}

bool is_chosen(const Options& options, const checks::Family& family) {
  if (options.families.empty()) return !family.is_only_when_named;
  return std::find(options.families.begin(), options.families.end(), family.name) != options.families.end();
}

report::Report start_report(const Options& options) {
  report::Report report;
  report.title = "Plumbline accuracy report";
  report.summary =
      "Precomputed radiance transfer held against path tracing and closed forms. Every number carries its "
      "uncertainty, every bound its source.";
  report.date = now_utc();
  report.version = PLUMBLINE_VERSION;
  report.command = reproducing_command(options);
  report.machine = machine();
  const checks::Budget& b = options.budget;
  report.settings = {{"seed", std::to_string(b.seed)},
                     {"tier", options.tier},
                     {"significance of each statistical test, its many values together",
                      fmt::format("{:g}", b.significance)},
                     {"lookup of environment images", options.light.lookup},
                     {"image", options.size},
                     {"paths a pixel", std::to_string(b.image_samples)},
                     {"directions a vertex (bake)", std::to_string(b.bake_samples)},
                     {"paths a vertex (truth)", std::to_string(b.gather_samples)}};
  return report;
}

void print_summary(const report::Report& report, const std::filesystem::path& page) {
  for (const report::Headline& headline : report.headlines)
    fmt::print("{}: {}\n", headline.label, headline.value);
  std::map<std::string, int> counts;
  for (const checks::Finding& finding : report.findings) {
    ++counts[checks::to_string(report::verdict(finding))];
    if (report::verdict(finding) != checks::Verdict::pass) {
      fmt::print("{}: {}: {}: measured {:.4g} +- {:.2g}, bound {:.4g}\n",
                 checks::to_string(report::verdict(finding)), finding.family, finding.name, finding.measured,
                 finding.uncertainty, finding.bound);
    }
  }
  fmt::print("{} checks: {} passed, {} failed, {} inconclusive\n", report.findings.size(), counts["pass"],
             counts["fail"], counts["inconclusive"]);
  fmt::print("report: {}\n", page.string());
}

int run(const Options& options) {
  const checks::Suite suite = make_suite(options);
  const std::filesystem::path folder(options.output);
  make_folder(folder, "report.html");
  report::Report report = start_report(options);
  for (const checks::Family& family : checks::families()) {
    if (!is_chosen(options, family)) continue;
    const auto start = std::chrono::steady_clock::now();
    const std::size_t before = report.findings.size();
    family.run(suite, report);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const auto added = static_cast<double>(std::max<std::size_t>(1, report.findings.size() - before));
    for (std::size_t i = before; i < report.findings.size(); ++i) {
      if (report.findings[i].seconds == 0.0) report.findings[i].seconds = seconds / added;  // not timed alone
    }
  }
  const std::string json = report::to_json(report).dump(2) + "\n";
  write_text_atomically(folder / "report.json", json);
  write_text_atomically(folder / "junit.xml", report::to_junit(report));
  write_text_atomically(folder / "report.html", report::to_html(report));
  if (!options.junit.empty()) write_text_atomically(options.junit, report::to_junit(report));
  if (!options.json.empty()) write_output(options.json, json);
  if (options.json != "-") print_summary(report, folder / "report.html");
  return report::verdict(report) == checks::Verdict::fail ? kCheckFailed : kSuccess;
}

}  // namespace

void register_validate(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* verb =
      app.add_subcommand("validate", "accuracy report: SH, transfer and images held against the truth");
  verb->add_option("SCENE", options->scenes, "scenes to judge (default: builtin:plaza)");
  add_mesh_options(*verb, options->scene);
  add_camera_option(*verb, options->scene.camera);
  verb->add_option("--env", options->environments,
                   "environments to judge under (default: builtin:two-lobes)");
  add_lookup_option(*verb, options->light);
  verb->add_option("--bands", options->bands, "band counts to judge (default: 3 5)")->delimiter(',');
  std::vector<std::string> names;
  for (const checks::Family& family : checks::families()) names.push_back(family.name);
  verb->add_option(
          "--checks", options->families,
          fmt::format("families to run: {} (default: all but bounces and truths)", fmt::join(names, ",")))
      ->delimiter(',')
      ->check(CLI::IsMember(names));
  verb->add_option("--tier", options->tier,
                   "quick: biases of 0.5 % would show; nightly: of 0.1 % (default: quick)")
      ->check(CLI::IsMember({"quick", "nightly"}));
  verb->add_option("-o,--output", options->output, "folder for report.html, report.json and junit.xml")
      ->required();
  verb->add_option("--junit", options->junit, "write the JUnit XML here too");
  verb->add_option("--json", options->json, "write the numbers here too, or - for standard output");
  verb->add_option("--size", options->size, "image size WxH (default 384x288)");
  verb->add_option("--spp", options->budget.image_samples,
                   "paths a pixel of the reference images (default 64)")
      ->check(CLI::Range(2, 1 << 20));
  verb->add_option("--samples", options->budget.bake_samples,
                   "directions a vertex of the bake (default 1024)")
      ->check(CLI::Range(32, 1 << 24));
  verb->add_option("--gather-samples", options->budget.gather_samples,
                   "paths a vertex of the vertex truth (default 128)")
      ->check(CLI::Range(32, 1 << 24));
  verb->add_option("--seed", options->budget.seed, "same seed, same numbers");
  verb->add_option("--threads", options->budget.threads, "0 = all; never changes the numbers")
      ->check(CLI::Range(0, 4096));
  verb->footer("Example: plumbline validate builtin:plaza --env builtin:sun-sky --bands 3 5 -o report");
  verb->callback([options, &chosen] {
    chosen = [options] {
      if (options->scenes.empty()) options->scenes = {"builtin:plaza"};
      if (options->environments.empty()) options->environments = {"builtin:two-lobes"};
      return run(*options);
    };
  });
}

}  // namespace plumbline::app
