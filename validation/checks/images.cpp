// Four images of one view explain PRT's error (all without light seen directly, all through the same pixel filter, all with the same
// number of bounces: none for shadowed transfer, three for interreflected):
//   A    path traced, the full light
//   B_n  path traced, the light cut to n bands: what PRT tries to compute
//   C_n  path traced at the vertices under that light, interpolated over the triangles: the best a per-vertex method can do
//   P_n  PRT of n bands
// Then A to B_n is truncation, B_n to C_n interpolation, C_n to P_n must be noise alone. C and P come in two independent halves a and b, so that squared
// differences have no noise part: E[(Pa - B)(Pb - B)] = (P - B)^2 + Var(B), and Var(B) is what B's standard error says.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include "prt/relight/cpu.hpp"
#include "prt/sh/lighting.hpp"
#include "prt/transfer/bake.hpp"
#include "reference/image/exr.hpp"
#include "reference/integrate/gather.hpp"
#include "reference/integrate/render.hpp"
#include "reference/scene/load.hpp"
#include "validation/checks/error_parts.hpp"
#include "validation/checks/suite.hpp"
#include "validation/checks/verdicts.hpp"

namespace plumbline::checks {
namespace {

using image::Image;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// What light does between the sky and the eye.
struct Transport {
  transfer::Kind kind = transfer::Kind::shadowed;
  int bounces = 0;
  std::string suffix;  // of names
};
const std::vector<Transport>& transports() {
  static const std::vector<Transport> all = {{transfer::Kind::shadowed, 0, ""},
                                             {transfer::Kind::interreflected, 3, ", 3 bounces"}};
  return all;
}

Traced trace_image(const NamedScene& scene, const light::Environment& environment, const Budget& budget,
                   const Transport& transport, std::uint64_t seed) {
  const integrate::World world(scene.scene, environment);
  integrate::RenderSettings settings;
  settings.width = budget.width;
  settings.height = budget.height;
  settings.samples_per_pixel = budget.image_samples;
  settings.max_bounces = transport.bounces;
  settings.seed = seed;
  settings.threads = budget.threads;
  settings.is_background_visible = false;
  const integrate::RenderResult result =
      integrate::render(world, scene::find_camera(world.scene, scene.camera), settings);
  Traced traced{*image::rgb_layer(result.image, ""), *image::rgb_layer(result.image, "stderr"),
                result.seconds};
  for (Rgb& v : traced.variance.pixels) v *= v;
  return traced;
}

/// Unit-albedo exit radiance at the vertices, path traced: E / pi.
std::vector<Rgb> trace_vertices(const NamedScene& scene, const light::Environment& environment,
                                const Budget& budget, const Transport& transport, std::uint64_t seed) {
  const integrate::World world(scene.scene, environment);
  integrate::GatherSettings settings;
  settings.samples = std::max(16, budget.gather_samples / 2);
  settings.max_bounces = transport.bounces;
  settings.seed = seed;
  settings.threads = budget.threads;
  std::vector<Rgb> radiance;
  for (const integrate::RgbEstimate& e :
       integrate::gather_irradiance(world, trace::vertex_points(world.scene), settings)) {
    radiance.emplace_back(e.mean / kPi);
  }
  return radiance;
}

/// The first `bands` bands of a transfer.
transfer::Transfer truncated(const transfer::Transfer& full, int bands) {
  transfer::Transfer result = full;
  result.bands = bands;
  result.coefficients.clear();
  result.standard_errors.clear();
  const auto count = static_cast<std::size_t>(sh::coefficient_count(bands));
  for (std::size_t v = 0; v < full.vertices; ++v) {
    for (int channel = 0; channel < full.channels; ++channel) {
      const std::span<const float> vector = full.vector(v, channel).first(count);
      result.coefficients.insert(result.coefficients.end(), vector.begin(), vector.end());
    }
  }
  return result;
}

sh::ShRgb truncated(const sh::ShRgb& full, int bands) {
  const auto count = static_cast<std::ptrdiff_t>(sh::coefficient_count(bands));
  return {bands, {full.coefficients.begin(), full.coefficients.begin() + count}};
}

/// What is baked once per scene and transport.
struct SceneBakes {
  transfer::Transfer half_a;
  transfer::Transfer half_b;
  transfer::Transfer unshadowed;
  double seconds = 0.0;
};

SceneBakes bake_scene(const NamedScene& scene, int bands, const Budget& budget, const Transport& transport) {
  transfer::BakeSettings settings;
  settings.kind = transport.kind;
  settings.max_bounces = transport.bounces;
  settings.bands = bands;
  settings.samples = std::max(16, budget.bake_samples / 2);
  settings.threads = budget.threads;
  SceneBakes bakes;
  const auto start = std::chrono::steady_clock::now();
  settings.seed = 2 * budget.seed + 1;
  bakes.half_a = transfer::bake(scene.scene, settings);
  settings.seed = 2 * budget.seed + 2;
  bakes.half_b = transfer::bake(scene.scene, settings);
  bakes.seconds = seconds_since(start);
  settings.kind = transfer::Kind::unshadowed;
  settings.max_bounces = 0;
  bakes.unshadowed = transfer::bake(scene.scene, settings);
  return bakes;
}

/// Draws vertex values through the scene's camera.
class Viewer {
 public:
  Viewer(const NamedScene& scene, const Budget& budget)
      : scene_(&scene),
        camera_(&scene::find_camera(scene.scene, scene.camera)),
        settings_{budget.width, budget.height, kGrid, budget.threads} {}

  [[nodiscard]] Image draw(const std::vector<Rgb>& vertex_radiance) const {
    return *image::rgb_layer(relight::render_view(scene_->scene, vertex_radiance, *camera_, settings_, {}),
                             "");
  }
  /// The light seen directly, to put behind the pictures.
  [[nodiscard]] Image background(const light::Environment& environment) const {
    const std::vector<Rgb> black(scene_->scene.positions.size(), Rgb(0.0F));
    return *image::rgb_layer(
        relight::render_view(scene_->scene, black, *camera_, settings_,
                             [&](const Vec3& d) { return light::radiance(environment, d); }),
        "");
  }
  /// Pixels that the scene covers wholly: silhouettes compare pixel filters, not light.
  [[nodiscard]] Mask covered() const {
    const Image sky = *image::rgb_layer(
        relight::render_view(scene_->scene, std::vector<Rgb>(scene_->scene.positions.size(), Rgb(0.0F)),
                             *camera_, settings_, [](const Vec3&) { return Rgb(1.0F); }),
        "emission");
    Mask mask;
    for (const Rgb& pixel : sky.pixels) mask.push_back(pixel.x == 0.0F);
    return mask;
  }

 private:
  static constexpr int kGrid = 8;
  const NamedScene* scene_;
  const scene::Camera* camera_;
  relight::ViewSettings settings_;
};

std::string percent(const metrics::Estimate& mean_square, double scale) {
  const RootMeanSquare r = root(mean_square);
  return fmt::format("{:.3g} % [{:.3g}, {:.3g}]", 100.0 * r.value / scale, 100.0 * r.low / scale,
                     100.0 * r.high / scale);
}

Image over(const Image& image, const Image& background) {
  Image result = image;
  for (std::size_t i = 0; i < result.pixels.size(); ++i) result.pixels[i] += background.pixels[i];
  return result;
}

void add_gallery(const std::string& name, const Transport& transport, int bands, const Pictures& p,
                 const Image& background, double mean_radiance, report::Report& report) {
  const Image prt = mean_image(p.prt_a, p.prt_b);
  report::Gallery gallery;
  gallery.title = name;
  // The mean radiance of the scene a little above middle gray, in the slider's quarter stops.
  gallery.exposure_stops =
      static_cast<float>(std::clamp(std::round(4.0 * std::log2(0.35 / mean_radiance)) / 4.0, -10.0, 10.0));
  gallery.caption =
      std::string(transport.bounces == 0 ? "Direct light only" : "Direct light and three bounces") +
      ", the environment behind. Compare PRT with the truth under the same, band-limited "
      "light: they must look the same. Against the full "
      "light PRT may only lack what its bands cannot hold: crisp shadows and bright, small lights.";
  gallery.entries = {
      {"path traced, full light", over(p.full.mean, background)},
      {fmt::format("path traced, {} bands of light", bands), over(p.band_limited.mean, background)},
      {fmt::format("PRT {}, {} bands", to_string(transport.kind), bands), over(prt, background)},
      {fmt::format("PRT unshadowed, {} bands", bands), over(p.unshadowed, background)}};
  const double scale = 0.2 * mean_radiance;
  gallery.errors = {
      report::error_map(fmt::format("PRT against path tracing, both {} bands of light", bands),
                        p.band_limited.mean, prt, scale, "radiance"),
      report::error_map("PRT against path tracing, full light", p.full.mean, prt, scale, "radiance"),
      report::error_map("What truncating the light does (path traced)", p.full.mean, p.band_limited.mean,
                        scale, "radiance")};
  report.galleries.push_back(std::move(gallery));
}

const std::vector<std::string> kColumns = {
    "scene",      "light",      "transfer",         "bands",    "band-limited light", "interpolation alone",
    "bake noise", "full light", "truncation alone", "bake [s]", "relight [ms]",       "path trace [s]"};

struct Charted {
  report::Series full;
  report::Series band_limited;
};

void chart_point(report::Series& series, int bands, const metrics::Estimate& mean_square, double scale) {
  const RootMeanSquare r = root(mean_square);
  series.x.push_back(bands);
  series.y.push_back(100.0 * r.value / scale);
  series.y_low.push_back(100.0 * r.low / scale);
  series.y_high.push_back(100.0 * r.high / scale);
}

void add_headlines(const std::string& name, const Parts& parts, report::Report& report) {
  const double m = parts.mean_radiance;
  report.headlines.push_back({name + ": error under the band-limited light", percent(parts.band_limited, m),
                              fmt::format("RMSE over the mean radiance, noise of the truth removed. Must be "
                                          "interpolation ({}) and bake noise ({}) only.",
                                          percent(parts.interpolation, m), percent(parts.bake_noise, m))});
  report.headlines.push_back(
      {name + ": error under the full light", percent(parts.full, m),
       fmt::format("Must be what truncating the light costs: {}, measured by path tracing.",
                   percent(parts.truncation, m))});
}

/// One scene under one light: all band counts.
void check_pair(const NamedScene& scene, const light::Environment& environment, const Transport& transport,
                const SceneBakes& bakes, const Suite& suite, report::Table& table, Charted& charted,
                report::Report& report) {
  const Budget& budget = suite.budget;
  const Viewer viewer(scene, budget);
  const Mask mask = viewer.covered();
  const Image background = viewer.background(environment);
  const std::string pair = scene.name + " under " + short_name(environment.name);
  if (suite.announce) suite.announce("path tracing " + pair + transport.suffix);
  Pictures pictures;
  pictures.full = trace_image(scene, environment, budget, transport, 4 * budget.seed + 1);
  const sh::ShRgb lighting = sh::project_radiance(environment, bakes.half_a.bands, budget.threads);
  const int most = *std::max_element(suite.bands.begin(), suite.bands.end());
  for (const int bands : suite.bands) {
    if (transport.bounces > 0 && bands != most) continue;  // minutes for what the direct light has shown
    if (suite.announce) suite.announce(fmt::format("{}, {} bands{}", pair, bands, transport.suffix));
    const sh::ShRgb light = truncated(lighting, bands);
    const light::Environment cut = sh::band_limited_environment(light, short_name(environment.name));
    pictures.band_limited = trace_image(scene, cut, budget, transport, 4 * budget.seed + 2);
    pictures.vertex_a = viewer.draw(trace_vertices(scene, cut, budget, transport, 4 * budget.seed + 3));
    pictures.vertex_b = viewer.draw(trace_vertices(scene, cut, budget, transport, 4 * budget.seed + 4));
    const transfer::Transfer half_a = truncated(bakes.half_a, bands);
    const auto start = std::chrono::steady_clock::now();
    const std::vector<Rgb> radiance_a = relight::unit_albedo_exit_radiance(half_a, light);
    const double relight_ms = 1e3 * seconds_since(start);
    pictures.prt_a = viewer.draw(radiance_a);
    pictures.prt_b = viewer.draw(relight::unit_albedo_exit_radiance(truncated(bakes.half_b, bands), light));
    pictures.unshadowed =
        viewer.draw(relight::unit_albedo_exit_radiance(truncated(bakes.unshadowed, bands), light));
    const Parts parts = measure(pictures, mask);
    const double m = parts.mean_radiance;
    const std::string name = fmt::format("{}, {} bands{}", pair, bands, transport.suffix);
    for (Finding& finding : judge_parts(name, parts, budget.significance))
      report.findings.push_back(std::move(finding));
    table.rows.push_back({scene.name, short_name(environment.name), std::string(to_string(transport.kind)),
                          std::to_string(bands), percent(parts.band_limited, m),
                          percent(parts.interpolation, m), percent(parts.bake_noise, m),
                          percent(parts.full, m), percent(parts.truncation, m),
                          fmt::format("{:.2f}", bakes.seconds), fmt::format("{:.2f}", relight_ms),
                          fmt::format("{:.2f}", pictures.full.seconds)});
    chart_point(charted.full, bands, parts.full, m);
    chart_point(charted.band_limited, bands, parts.band_limited, m);
    if (bands != most) continue;
    add_gallery(name, transport, bands, pictures, background, m, report);
    add_headlines(name, parts, report);
  }
}

}  // namespace

void check_images(const Suite& suite, report::Report& report) {
  report::Table table{
      "Accuracy of PRT",
      "RMSE over covered pixels in percent of the mean radiance, noise of the truth removed, with 95 % "
      "intervals. Good: `band-limited light` no "
      "larger than interpolation and bake noise together, and `full light` equal to truncation.",
      kColumns,
      {}};
  report::Chart chart;
  chart.title = "Image error against bands";
  chart.caption =
      "RMSE of PRT in percent of the mean radiance. The error under the full light falls as bands "
      "are added; under the band-limited light it stays at "
      "the level of interpolation and bake noise: the method computes what it promises.";
  chart.x_label = "bands";
  chart.y_label = "RMSE, % of the mean radiance";
  chart.is_y_log = true;
  const int bands = *std::max_element(suite.bands.begin(), suite.bands.end());
  for (const NamedScene& scene : suite.scenes) {
    std::vector<float> direct;
    for (const Transport& transport : transports()) {
      if (suite.announce) suite.announce("baking " + scene.name + transport.suffix);
      const SceneBakes bakes = bake_scene(scene, bands, suite.budget, transport);
      // Where no surface sees another the bake says so, and bounces add nothing to look at.
      if (transport.bounces > 0 && bakes.half_a.coefficients == direct) continue;
      direct = bakes.half_a.coefficients;
      for (const light::Environment& environment : suite.environments) {
        const std::string name = scene.name + " under " + short_name(environment.name) + transport.suffix;
        Charted charted;
        charted.full.name = name + ", full light";
        charted.band_limited.name = name + ", band-limited light";
        check_pair(scene, environment, transport, bakes, suite, table, charted, report);
        chart.series.push_back(charted.full);
        chart.series.push_back(charted.band_limited);
      }
    }
  }
  report.tables.push_back(table);
  report.charts.push_back(chart);
}

}  // namespace plumbline::checks
