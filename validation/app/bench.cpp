// plumbline bench: run time against error, of this renderer and of others.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <thread>

#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/base/text.hpp"
#include "reference/image/file.hpp"
#include "reference/scene/text.hpp"
#include "validation/app/machine.hpp"
#include "validation/app/options.hpp"
#include "validation/app/verbs.hpp"
#include "validation/report/text.hpp"
#include "validation/study/bench.hpp"
#include "validation/study/preset.hpp"

namespace plumbline::app {
namespace {

constexpr int kMostSamples = 1 << 20;

struct Options {
  SceneOptions scene;
  LightOptions light;
  std::string preset;
  std::string methods = "path,cycles";
  std::string spp = "16,64,256";
  std::string size = "256x256";
  std::string bounces = "8";
  std::uint64_t seed = 0;
  int threads = 0;
  int repetitions = 3;
  std::string reference;
  int reference_spp = 1024;
  std::string output;
  std::string json;
  CLI::Option* has_reference_spp = nullptr;
};

std::vector<int> parse_spp(const std::string& text) {
  std::vector<int> list;
  for (const std::string_view word : split(text, ',')) {
    const auto value = scene::parse_integer(word);
    if (!value || *value < 1 || *value > kMostSamples) {
      throw InputError(fmt::format("--spp: expected whole numbers from 1 to {} with commas, got {}",
                                   kMostSamples, quoted(one_line(text))));
    }
    list.push_back(static_cast<int>(*value));
  }
  return list;
}

std::vector<std::string> parse_methods(const std::string& text) {
  std::vector<std::string> list;
  for (const std::string_view word : split(text, ',')) {
    const std::string name = one_line(word);
    (void)study::find_method(name);
    if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
  }
  return list;
}

/// What is rendered: a preset with its light, or a scene; the light of the command line counts in both cases.
struct Subject {
  scene::Scene scene;
  light::Environment environment;
  std::string scene_name;
  std::string environment_name;
};

Subject subject_of(const Options& options) {
  if (!options.preset.empty() && !options.scene.source.empty())
    throw InputError("SCENE and --preset exclude each other");
  LightOptions light_options = options.light;
  Subject subject;
  if (options.preset.empty()) {
    SceneOptions scene_options = options.scene;
    if (scene_options.source.empty()) scene_options.source = "builtin:cornell";
    subject.scene = load(scene_options);
    subject.scene_name = scene_options.source;
  } else {
    study::Preset preset = study::make_preset(options.preset);
    subject.scene = std::move(preset.scene);
    subject.scene_name = "preset:" + options.preset;
    if (light_options.source.empty()) light_options.source = preset.environment;
  }
  subject.environment = load(light_options);
  subject.environment_name = light_options.source.empty() ? "none" : light_options.source;
  if (light_options.lookup != "nearest") subject.environment_name += " (" + light_options.lookup + ")";
  return subject;
}

study::Task task_of(const Options& options, Subject& subject) {
  study::SharedLight light = study::shared_light(subject.environment);
  if (light.is_resampled) subject.environment_name += ", as 1024x512 texels for all methods";
  const Size size = parse_size(options.size);
  study::Task task;
  task.camera = camera_of(subject.scene, options.scene.camera);
  task.width = size.width;
  task.height = size.height;
  task.max_bounces = parse_bounces(options.bounces);
  task.threads = options.threads > 0 ? options.threads
                                     : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  task.world =
      std::make_shared<const integrate::World>(std::move(subject.scene), std::move(light.environment));
  return task;
}

study::Plan plan_of(const Options& options, const Subject& subject) {
  study::Plan plan;
  plan.scene = subject.scene_name;
  plan.environment = subject.environment_name;
  plan.methods = parse_methods(options.methods);
  plan.spp = parse_spp(options.spp);
  plan.repetitions = options.repetitions;
  plan.reference_spp = options.reference_spp;
  if (!options.reference.empty()) plan.reference_file = options.reference;
  plan.seed = options.seed;
  plan.progress = progress_bar("bench");
  return plan;
}

std::string reproducing_command(const Options& o) {
  std::string command = "plumbline bench";
  if (!o.scene.source.empty()) command += " " + quoted(o.scene.source);
  if (!o.preset.empty()) command += " --preset " + quoted(o.preset);
  if (o.scene.crease_deg > 0.0F) command += fmt::format(" --crease {}", o.scene.crease_deg);
  if (o.scene.has_ground) command += " --ground";
  if (!o.scene.camera.empty()) command += " --camera " + quoted(o.scene.camera);
  command += command_text(o.light);
  command += fmt::format(" --methods {} --spp {} --size {} --bounces {} --seed {} --repeat {}",
                         quoted(o.methods), o.spp, o.size, o.bounces, o.seed, o.repetitions);
  command += o.reference.empty() ? fmt::format(" --reference-spp {}", o.reference_spp)
                                 : " --reference " + quoted(o.reference);
  if (o.threads > 0) command += fmt::format(" --threads {}", o.threads);
  return command + " -o " + quoted(o.output);
}

void print_summary(const report::Report& page, const study::Outcome& outcome, const study::Plan& plan,
                   const std::filesystem::path& folder) {
  say(fmt::format("{:<10} {:>6} {:>10} {:>12} {:>12}", "method", "spp", "seconds", "relMSE", "efficiency"));
  for (const study::Budget& b : study::budgets(outcome.runs))
    say(fmt::format("{:<10} {:>6} {:>10.4g} {:>12.4g} {:>12.4g}", b.method, b.spp, b.seconds, b.relmse,
                    b.efficiency));
  for (const report::Table& table : page.tables) {
    if (table.title != "Efficiency ratios") continue;
    for (const std::vector<std::string>& row : table.rows)
      say(fmt::format("{} at {} spp: {}", row[0], row[1], row[2]));
  }
  for (const checks::Finding& finding : page.findings) {
    say(fmt::format("{}: {}: {:.4g} +- {:.2g}, bound {:.4g}", checks::to_string(report::verdict(finding)),
                    finding.name, finding.measured, finding.uncertainty, finding.bound));
  }
  for (const study::Skipped& one : outcome.skipped)
    say(fmt::format("skipped: {}: {} runs not made: {}", one.method, one.runs, one.reason));
  say(fmt::format("{} runs on {}: {}", outcome.runs.size(), plan.scene, (folder / "bench.html").string()));
}

int run(const Options& options) {
  if (!options.reference.empty() && *options.has_reference_spp)
    throw InputError("--reference and --reference-spp exclude each other");
  Subject subject = subject_of(options);
  study::Plan plan = plan_of(options, subject);
  const study::Task task = task_of(options, subject);
  plan.environment = subject.environment_name;  // now with what became of it
  const std::filesystem::path folder(options.output);
  require_destinations({{"--json", options.json, ""}});
  study::require_possible(task, plan);
  make_folder(folder, "bench.html");
  const study::Outcome outcome = study::run_study(task, plan);
  report::Report page = study::make_report(task, plan, outcome);
  page.date = now_utc();
  page.version = PLUMBLINE_VERSION;
  page.command = reproducing_command(options);
  page.machine = machine();
  nlohmann::json json = report::to_json(page);
  json.update(study::to_json(task, plan, outcome));
  write_json((folder / "bench.json").string(), json);
  write_text_atomically(folder / "bench.html", report::to_html(page));
  if (!plan.reference_file)
    study::save_reference(folder / "reference.exr", outcome.renderers,
                          study::reference_attributes(task, plan));
  if (outcome.agreement) image::write_png(folder / "z_map.png", outcome.agreement->z_map);
  write_json(options.json, json);
  if (options.json != "-") print_summary(page, outcome, plan, folder);
  return report::verdict(page) == checks::Verdict::fail ? kCheckFailed : kSuccess;
}

}  // namespace

void register_bench(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* verb =
      app.add_subcommand("bench", "run time against error: this path tracer and Blender's Cycles, in turn");
  add_scene_options(*verb, options->scene);
  verb->get_option("SCENE")->required(false);
  verb->add_option(
      "--preset", options->preset,
      fmt::format("a scene with its light instead: {} (bunny needs Debian's glmark2-data and blender-data)",
                  fmt::join(study::preset_names(), ", ")));
  add_light_options(*verb, options->light, false);
  std::vector<std::string> names;
  for (const study::MethodEntry& entry : study::methods())
    names.push_back(entry.name + " = " + entry.description);
  verb->add_option(
      "--methods", options->methods,
      fmt::format("what to time, a list with commas: {} (default path,cycles)", fmt::join(names, ", ")));
  verb->add_option("--spp", options->spp,
                   "samples a pixel of the runs, a list with commas (default 16,64,256)");
  add_size(*verb, options->size);
  verb->add_option("--bounces", options->bounces,
                   "indirect bounces: 0 = direct light only, all = no limit (default 8)");
  add_camera_option(*verb, options->scene.camera);
  add_seed(*verb, options->seed);
  add_threads(*verb, options->threads);
  add_whole_number(*verb, "--repeat", options->repetitions, {1, 1000},
                   "repetitions of every run (default 3)");
  verb->add_option(
      "--reference", options->reference,
      "OpenEXR image to hold against instead of making one, e.g. an earlier study's reference.exr");
  options->has_reference_spp =
      add_whole_number(*verb, "--reference-spp", options->reference_spp, {1, kMostSamples},
                       "samples a pixel in each half that each method gives to the reference (default 1024)");
  verb->add_option("-o,--output", options->output,
                   "folder for bench.html, bench.json, reference.exr and z_map.png")
      ->required();
  add_json(*verb, options->json, "the numbers");
  verb->footer("Example: plumbline bench --preset cornell --methods path,cycles --spp 16,64 -o study");
  on_chosen(*verb, options, chosen, &run);
}

}  // namespace plumbline::app
