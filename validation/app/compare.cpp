// plumbline compare: how far a test image is from a reference.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reference/base/error.hpp"
#include "reference/base/text.hpp"
#include "reference/image/exr.hpp"
#include "reference/image/file.hpp"
#include "reference/scene/text.hpp"
#include "validation/app/options.hpp"
#include "validation/app/verbs.hpp"
#include "validation/metrics/compare.hpp"

namespace plumbline::app {
namespace {

struct Options {
  std::string reference;
  std::string test;
  std::string heatmap;
  std::vector<std::string> above;
  std::vector<std::string> below;
  std::string json;
};

enum class Side { above, below };

struct Limit {
  std::string metric;
  double value = 0.0;
  Side fails = Side::above;
};

Limit parse_limit(const std::string& text, Side fails) {
  const char* option = fails == Side::above ? "--fail-above" : "--fail-below";
  const std::size_t equals = std::min(text.find('='), text.size());
  const std::string metric = text.substr(0, equals);
  const auto value = scene::parse_number(text.substr(std::min(equals + 1, text.size())));
  if (!value || std::isnan(*value)) {
    throw InputError(
        fmt::format("{}: expected METRIC=VALUE with a number, got {}", option, quoted(one_line(text))));
  }
  std::string known;
  for (const auto& [name, ignored] : metrics::as_map({})) {
    if (name == metric) return {metric, *value, fails};
    known += (known.empty() ? "" : ", ") + name;
  }
  throw InputError(
      fmt::format("{}: unknown metric {}, there are: {}", option, quoted(one_line(metric)), known));
}

std::vector<Limit> limits_of(const Options& options) {
  std::vector<Limit> limits;
  for (const std::string& text : options.above) limits.push_back(parse_limit(text, Side::above));
  for (const std::string& text : options.below) limits.push_back(parse_limit(text, Side::below));
  return limits;
}

// An EXR keeps its layers; any other image has colours only.
image::LayeredImage read_layers(const std::string& path) {
  if (lower_case_extension(path) == ".exr") return image::read_exr(path);
  const image::Image colours = image::read_image(path);
  image::LayeredImage result{colours.width, colours.height, {}, {}};
  image::set_rgb_layer(result, "", colours);
  return result;
}

struct Images {
  image::LayeredImage reference;
  image::LayeredImage test;
};

Images read_images(const Options& options) {
  Images images{read_layers(options.reference), read_layers(options.test)};
  const auto require_colours = [](const std::string& path, const image::LayeredImage& layers) {
    if (!image::rgb_layer(layers, "")) throw InputError(path + ": has no R, G and B channels");
  };
  require_colours(options.reference, images.reference);
  require_colours(options.test, images.test);
  if (images.reference.width != images.test.width || images.reference.height != images.test.height) {
    throw InputError(fmt::format("{}: is {}x{}, but {} is {}x{}", options.test, images.test.width,
                                 images.test.height, options.reference, images.reference.width,
                                 images.reference.height));
  }
  return images;
}

struct Failure {
  std::string metric;
  std::string reason;
};

// Metrics are over the pixels that are finite in both images. Where one is not, the others say nothing of it:
// whoever asks for a verdict gets "failed", whatever the limits are.
std::vector<Failure> failures_of(const metrics::ImageComparison& comparison,
                                 const std::vector<Limit>& limits) {
  std::vector<Failure> failures;
  const bool is_incomplete = comparison.nonfinite > 0 || comparison.pixels == 0;
  if (is_incomplete && !limits.empty()) {
    failures.push_back({"nonfinite", fmt::format("{} pixels are not finite, {} could be compared",
                                                 comparison.nonfinite, comparison.pixels)});
  }
  for (const auto& [metric, value, fails] : limits) {
    if (is_incomplete && metric == "nonfinite") continue;  // said already
    const bool is_above = fails == Side::above;
    const bool is_failed = is_above ? metrics::exceeds(comparison, metric, value)
                                    : metrics::falls_below(comparison, metric, value);
    if (!is_failed) continue;
    failures.push_back({metric, fmt::format("expected at {} {:.9g}, got {:.9g}", is_above ? "most" : "least",
                                            value, metrics::as_map(comparison).at(metric))});
  }
  return failures;
}

nlohmann::json json_of(const metrics::ImageComparison& comparison, const std::vector<Failure>& failures) {
  nlohmann::json json = nlohmann::json::object();
  for (const auto& [name, value] : metrics::as_map(comparison)) json[name] = number(value);
  json["pixels"] = comparison.pixels;
  json["nonfinite"] = comparison.nonfinite;
  json["failed"] = nlohmann::json::array();
  for (const Failure& failure : failures) json["failed"].push_back(failure.metric);
  return json;
}

std::string text_of(const metrics::ImageComparison& comparison) {
  std::string text;
  for (const auto& [name, value] : metrics::as_map(comparison)) {
    text += fmt::format("{:<20} {:.9g}\n", name, value);
  }
  return text;
}

double write_heatmap(const std::string& path, const Images& images) {
  const image::Image reference = *image::rgb_layer(images.reference, "");
  const image::Image test = *image::rgb_layer(images.test, "");
  const double scale = metrics::heat_scale(reference, test);
  image::write_png(path, metrics::heat_map(reference, test, scale));
  return scale;
}

int run(const Options& options) {
  const std::vector<Limit> limits = limits_of(options);
  require_destinations({{"--heatmap", options.heatmap, ".png"}, {"--json", options.json, ""}});
  const Images images = read_images(options);
  const metrics::ImageComparison comparison = metrics::compare(images.reference, images.test);
  const std::vector<Failure> failures = failures_of(comparison, limits);
  nlohmann::json json = json_of(comparison, failures);
  if (!options.heatmap.empty()) json["heatmap_scale"] = number(write_heatmap(options.heatmap, images));
  if (options.json != "-") write_output("-", text_of(comparison));
  write_json(options.json, json);
  for (const Failure& failure : failures) {
    complain(fmt::format("failed: {}: {}", failure.metric, failure.reason));
  }
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
  verb->add_option("--fail-above", options->above,
                   "exit with 1 when a metric is above a value: METRIC=VALUE, may be given again; any pixel "
                   "that is not finite fails too")
      ->allow_extra_args(false);
  verb->add_option("--fail-below", options->below,
                   "the same for metrics that are better when larger: psnr, ssim")
      ->allow_extra_args(false);
  add_json(*verb, options->json, "the metrics");
  verb->footer(
      "Example: plumbline compare truth.exr mine.exr --fail-above relative_rmse=0.01 --heatmap "
      "difference.png");
  on_chosen(*verb, options, chosen, &run);
}

}  // namespace plumbline::app
