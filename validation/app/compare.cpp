// plumbline compare: how far a test image is from a reference.
#include <fmt/format.h>

#include <cmath>

#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/image/exr.hpp"
#include "reference/image/file.hpp"
#include "validation/app/verbs.hpp"
#include "validation/metrics/compare.hpp"

namespace plumbline::app {
namespace {

struct Options {
  std::string reference;
  std::string test;
  std::string heatmap;
  std::vector<std::string> limits;
  std::string json;
};

struct Limit {
  std::string metric;
  double value = 0.0;
};

Limit parse_limit(const std::string& text) {
  const std::size_t equals = text.find('=');
  char* end = nullptr;
  const double value = equals == std::string::npos ? NAN : std::strtod(text.c_str() + equals + 1, &end);
  if (equals == std::string::npos || end == text.c_str() + equals + 1 || *end != '\0' || std::isnan(value)) {
    throw InputError(fmt::format("--fail-above: expected METRIC=VALUE, got {}", text));
  }
  return {text.substr(0, equals), value};
}

// An EXR keeps its layers; any other image has colours only.
image::LayeredImage read_layers(const std::string& path) {
  if (path.ends_with(".exr")) return image::read_exr(path);
  const image::Image colours = image::read_image(path);
  image::LayeredImage result{colours.width, colours.height, {}, {}};
  image::set_rgb_layer(result, "", colours);
  return result;
}

int run(const Options& options) {
  std::vector<Limit> limits;
  for (const std::string& text : options.limits) limits.push_back(parse_limit(text));
  if (!options.heatmap.empty()) require_writable(options.heatmap);
  const image::LayeredImage reference = read_layers(options.reference);
  const image::LayeredImage test = read_layers(options.test);
  for (const auto& [path, layers] :
       {std::pair(options.reference, &reference), std::pair(options.test, &test)}) {
    if (!image::rgb_layer(*layers, "")) throw InputError(path + ": has no R, G and B channels");
  }
  if (reference.width != test.width || reference.height != test.height) {
    throw InputError(fmt::format("{}: is {}x{}, but {} is {}x{}", options.test, test.width, test.height,
                                 options.reference, reference.width, reference.height));
  }
  const metrics::ImageComparison comparison = metrics::compare(reference, test);
  std::vector<std::string> failures;
  for (const Limit& limit : limits) {
    if (metrics::exceeds(comparison, limit.metric, limit.value)) failures.push_back(limit.metric);
  }
  nlohmann::json json = nlohmann::json::object();
  for (const auto& [name, value] : metrics::as_map(comparison)) {
    json[name] = number(value);
    if (options.json != "-") fmt::print("{:<20} {:.9g}\n", name, value);
  }
  json["pixels"] = comparison.pixels;
  json["nonfinite"] = comparison.nonfinite;
  json["failed"] = failures;
  if (!options.heatmap.empty()) {
    const image::Image a = *image::rgb_layer(reference, "");
    const image::Image b = *image::rgb_layer(test, "");
    const double scale = metrics::heat_scale(a, b);
    image::write_png(options.heatmap, metrics::heat_map(a, b, scale));
    json["heatmap_scale"] = number(scale);
  }
  write_json(options.json, json);
  for (const std::string& metric : failures)
    fmt::print(stderr, "plumbline: failed: {} is above its limit\n", metric);
  return failures.empty() ? kSuccess : kCheckFailed;
}

}  // namespace

void register_compare(CLI::App& app, Action& chosen) {
  auto options = std::make_shared<Options>();
  CLI::App* verb =
      app.add_subcommand("compare", "how far a test image is from a reference, and how sure that is");
  verb->add_option("REFERENCE", options->reference, "image taken as right")->required();
  verb->add_option("TEST", options->test, "image to judge")->required();
  verb->add_option("--heatmap", options->heatmap, "PNG of the absolute difference");
  verb->add_option("--fail-above", options->limits,
                   "exit with 1 when a metric is above a value: METRIC=VALUE, may be given again");
  verb->add_option("--json", options->json, "write the metrics to this file, or - for standard output");
  verb->footer(
      "Example: plumbline compare truth.exr mine.exr --fail-above relative_rmse=0.01 --fail-above "
      "nonfinite=0 --heatmap difference.png");
  verb->callback([options, &chosen] { chosen = [options] { return run(*options); }; });
}

}  // namespace plumbline::app
