// plumbline project: an environment as SH coefficients.
#include "prt/sh/convention.hpp"
#include "validation/app/options.hpp"
#include "validation/app/verbs.hpp"

namespace plumbline::app {
namespace {

struct Options {
  LightOptions light;
  int bands = 5;
  std::string window = "none";
  double lambda = 0.01;
  std::string convention = "plumbline";
  std::string output = "-";
  std::string json;
};

sh::Window window_of(const std::string& name) {
  if (name == "hann") return sh::Window::hann;
  if (name == "lanczos") return sh::Window::lanczos;
  if (name == "gauss") return sh::Window::gauss;
  if (name == "laplacian") return sh::Window::laplacian;
  return sh::Window::none;
}

int run(const Options& options) {
  const bool is_twice = options.json.empty() || options.json == options.output;
  require_destinations({{"-o", options.output, ""}, {"--json", is_twice ? "" : options.json, ""}});
  const sh::KnownConvention& convention = sh::known_convention(options.convention);
  const sh::ShRgb lighting = sh::project_radiance(load(options.light), options.bands);
  const sh::ShRgb seen = sh::windowed(lighting, window_of(options.window), options.lambda);
  const std::string text = sh::to_json(seen, convention);
  write_output(options.output, text);
  if (!is_twice) write_output(options.json, text);
  return kSuccess;
}

}  // namespace

void register_project(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("project", "spherical-harmonic coefficients of an environment");
  verb->add_option("ENV", options->light.source, "environment image or builtin:NAME")->required();
  add_light_modifiers(*verb, options->light);
  add_bands(*verb, options->bands,
            "n bands: degrees 0 to n-1, n^2 coefficients (\"order n\" in Sloan's papers)");
  verb->add_option("--window", options->window, "low-pass window against ringing")
      ->check(CLI::IsMember({"none", "hann", "lanczos", "gauss", "laplacian"}));
  add_number(
      *verb, "--lambda", [options = options.get()](double lambda) { options->lambda = lambda; },
      "a number from 0", [](double lambda) { return lambda >= 0.0; },
      "strength of --window laplacian (default 0.01)");
  verb->add_option("--convention", options->convention,
                   "name of the convention to write (`plumbline conventions` lists them; default: ours)");
  add_output(*verb, options->output, "JSON file to write (default: standard output)");
  add_json(*verb, options->json, "the same JSON");
  verb->footer("Example: plumbline project builtin:two-lobes --bands 4 -o two-lobes.json");
  on_chosen(*verb, options, chosen, &run);
}

}  // namespace plumbline::app
