// plumbline project: an environment as SH coefficients.
#include <fmt/format.h>

#include "prt/sh/lighting.hpp"
#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "validation/app/verbs.hpp"

namespace plumbline::app {
namespace {

struct Options {
  LightOptions light;
  int bands = 5;
  std::string window = "none";
  double lambda = 0.01;
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
  sh::require_bands(options.bands);
  if (options.output != "-") require_writable(options.output);
  const sh::ShRgb lighting = sh::project_radiance(load(options.light), options.bands);
  const std::string text = sh::to_json(sh::windowed(lighting, window_of(options.window), options.lambda));
  write_output(options.output, text);
  if (!options.json.empty() && !(options.json == "-" && options.output == "-"))
    write_output(options.json, text);
  return kSuccess;
}

}  // namespace

void register_project(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("project", "spherical-harmonic coefficients of an environment");
  verb->add_option("ENV", options->light.source, "environment image or builtin:NAME")->required();
  verb->add_option("--env-layout", options->light.layout,
                   "how an image maps to directions (default: by its aspect ratio)")
      ->check(CLI::IsMember({"auto", "lat-long", "angular-map", "cube"}));
  add_lookup_option(*verb, options->light);
  verb->add_option("--rotate-env", options->light.rotation_deg, "turn the environment first: X,Y,Z degrees")
      ->delimiter(',')
      ->expected(3);
  verb->add_option("--bands", options->bands,
                   "n bands: degrees 0 to n-1, n^2 coefficients (\"order n\" in Sloan's papers)")
      ->required();
  verb->add_option("--window", options->window, "low-pass window against ringing")
      ->check(CLI::IsMember({"none", "hann", "lanczos", "gauss", "laplacian"}));
  verb->add_option("--lambda", options->lambda, "strength of --window laplacian (default 0.01)")
      ->check(CLI::NonNegativeNumber);
  verb->add_option("-o,--output", options->output, "JSON file to write (default: standard output)");
  verb->add_option("--json", options->json, "the same JSON to this file, or - for standard output");
  verb->footer("Example: plumbline project builtin:two-lobes --bands 4 -o two-lobes.json");
  verb->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace plumbline::app
