// Three baked transfers of one scene: two independent bakes a and b of `bake_samples` directions, and the compressed a. Compression
// that is good enough changes the image by less than baking again does.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prt/compress/quantise.hpp"
#include "prt/compress/seams.hpp"
#include "prt/relight/cluster_blocks.hpp"
#include "prt/relight/cpu.hpp"
#include "prt/sh/lighting.hpp"
#include "prt/transfer/bake.hpp"
#include "reference/scene/load.hpp"
#include "validation/checks/compression_study.hpp"
#include "validation/checks/suite.hpp"
#include "validation/checks/verdicts.hpp"
#include "validation/metrics/flip.hpp"
#include "validation/metrics/statistics.hpp"

namespace plumbline::checks {
namespace {

constexpr int kBands = 5;
constexpr int kClusters = 256;
constexpr int kComponents = 12;
constexpr int kTile = 32;  // pixels; FLIP's filters reach less far

/// What a user would compress: three bounces in three channels.
transfer::Transfer rgb_transfer(const scene::Scene& scene, std::uint64_t seed, const Budget& budget) {
  transfer::BakeSettings settings;
  settings.bands = kBands;
  settings.kind = transfer::Kind::interreflected;
  settings.max_bounces = 3;
  settings.samples = budget.bake_samples;
  settings.seed = seed;
  settings.threads = budget.threads;
  transfer::Transfer transfer = transfer::bake(scene, settings);
  if (transfer.channels == 3) return transfer;
  transfer::Transfer rgb = transfer;  // a gray scene
  rgb.channels = 3;
  rgb.coefficients.clear();
  rgb.standard_errors.clear();
  for (std::size_t v = 0; v < transfer.vertices; ++v) {
    for (int channel = 0; channel < 3; ++channel) {
      const std::span<const float> row = transfer.vector(v, 0);
      rgb.coefficients.insert(rgb.coefficients.end(), row.begin(), row.end());
    }
  }
  return rgb;
}

compress::Compressed compressed_of(const transfer::Transfer& transfer, compress::Method method, int clusters,
                                   const Budget& budget) {
  compress::CompressSettings settings;
  settings.method = method;
  settings.clusters.clusters =
      static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(clusters), transfer.vertices));
  settings.clusters.components = kComponents;
  settings.clusters.least_gain = 1e-3;
  settings.clusters.seed = budget.seed;
  settings.clusters.threads = budget.threads;
  return compress::compress(transfer, settings);
}

// ---------------------------------------------------------------- pictures

image::Image view(const NamedScene& scene, const std::vector<Rgb>& radiance, const Budget& budget) {
  const relight::ViewSettings settings{budget.width, budget.height, 4, budget.threads};
  return *image::rgb_layer(relight::render_view(scene.scene, radiance,
                                                scene::find_camera(scene.scene, scene.camera), settings, {}),
                           "");
}

/// Exposure that takes the 99th percentile of luminance to 1/2.
float exposure_of(const image::Image& image) {
  std::vector<float> luminances;
  for (const Rgb& pixel : image.pixels) luminances.push_back(luminance(pixel));
  const auto at = luminances.begin() + static_cast<std::ptrdiff_t>(luminances.size() * 99 / 100);
  std::nth_element(luminances.begin(), at, luminances.end());
  return *at > 0.0F ? 0.5F / *at : 1.0F;
}

image::Image exposed(image::Image image, float exposure) {
  for (Rgb& pixel : image.pixels) pixel = glm::clamp(exposure * pixel, Rgb(0.0F), Rgb(1.0F));
  return image;
}

/// Mean FLIP, its standard error from the spread of tiles.
metrics::Estimate flip_of(const image::Image& reference, const image::Image& test) {
  const float exposure = exposure_of(reference);
  const std::vector<float> map = metrics::flip(exposed(reference, exposure), exposed(test, exposure));
  std::vector<double> tiles;
  for (int top = 0; top + kTile <= reference.height; top += kTile) {
    for (int left = 0; left + kTile <= reference.width; left += kTile) {
      double sum = 0.0;
      for (int y = top; y < top + kTile; ++y) {
        for (int x = left; x < left + kTile; ++x) {
          sum += map[static_cast<std::size_t>(y) * static_cast<std::size_t>(reference.width) +
                     static_cast<std::size_t>(x)];
        }
      }
      tiles.push_back(sum / (kTile * kTile));
    }
  }
  return metrics::estimate(tiles);
}

struct Views {
  image::Image exact;
  image::Image again;       // from the other bake
  image::Image compressed;  // 12 components of 8 bits
  image::Image quantised;   // VQ of as many clusters as are no smaller
};

std::vector<Rgb> relit(const compress::Compressed& compressed, const transfer::Transfer& like,
                       const sh::ShRgb& light) {
  return relight::unit_albedo_exit_radiance(relight::make_cluster_blocks(compressed, like), light);
}

void add_gallery(const std::string& name, const Views& views, report::Report& report) {
  report::Gallery gallery;
  gallery.title = name + ": compressed transfer";
  gallery.caption =
      "All four must look the same. Vector quantisation shows its clusters as steps; clustered PCA of 12 "
      "components may not.";
  gallery.entries = {
      {"uncompressed, 300 bytes a vertex", views.exact},
      {fmt::format("CPCA, {} clusters x {} components x 8 bits", kClusters, kComponents), views.compressed},
      {"VQ, 4096 clusters", views.quantised},
      {"uncompressed, baked again", views.again}};
  gallery.exposure_stops = std::round(4.0F * std::log2(exposure_of(views.exact))) / 4.0F;
  const double scale = 0.02 / static_cast<double>(exposure_of(views.exact));
  gallery.errors = {
      report::error_map("CPCA against uncompressed", views.exact, views.compressed, scale, "radiance"),
      report::error_map("VQ against uncompressed", views.exact, views.quantised, scale, "radiance"),
      report::error_map("baked again, against the first bake", views.exact, views.again, scale, "radiance")};
  report.galleries.push_back(std::move(gallery));
}

// ---------------------------------------------------------------- findings

std::vector<Finding> judge_curves(const std::string& name, const std::vector<SizedError>& points) {
  const std::string method =
      "The methods' own optimality: affine models hold constant ones, the iteration starts from the static "
      "clusters";
  std::vector<Finding> findings;
  findings.push_back(
      judge_error({"compression", name + " / iterative against static CPCA, equal size", method,
                   "Largest ratio of the errors over all clusters x components x bits: at most 1."},
                  largest_ratio(points, "iterative CPCA", "static CPCA"), 1.0));
  findings.push_back(judge_error(
      {"compression", name + " / static CPCA (8-bit weights) against VQ of its size", method,
       "Largest ratio of the errors, VQ's read off the line between the sizes that were tried: at most 1."},
      largest_ratio_to_vq(points, "static CPCA", 8), 1.0));
  findings.push_back(
      judge_error({"compression", name + " / what 8-bit weights add to the error of iterative CPCA",
                   "Sloan, SIGGRAPH 2005 course: 8 bits, almost no difference; taken as 5 %",
                   "Largest relative increase over the error of exact weights."},
                  largest_increase(points, "iterative CPCA", 8), 0.05));
  return findings;
}

Finding judge_flip(const std::string& name, const metrics::Estimate& flip, const metrics::Estimate& again) {
  Finding finding = judge_error({"compression", name + " / FLIP of 12 components of 8 bits",
                                 "FLIP between two independent bakes: no one can tell the "
                                 "compressed image from the next bake's",
                                 "Mean FLIP of the relit image against the uncompressed one."},
                                flip.mean, again.mean);
  finding.uncertainty = 1.96 * flip.standard_error;
  return finding;
}

report::Chart chart_of(const std::string& name, const std::vector<SizedError>& points) {
  report::Chart chart;
  chart.title = name + ": error against size";
  chart.caption =
      "Lower and farther left is better. Sizes include the clusters' constants. Points of one line differ in "
      "clusters and components; "
      "each line keeps those that nothing smaller of the line beats. Uncompressed: 300 bytes.";
  chart.x_label = "bytes a vertex";
  chart.y_label = "relative error, root mean square";
  chart.is_x_log = chart.is_y_log = true;
  std::vector<SizedError> sorted = points;
  std::stable_sort(sorted.begin(), sorted.end(), [](const SizedError& a, const SizedError& b) {
    return a.bytes_per_vertex < b.bytes_per_vertex;
  });
  for (const SizedError& point : sorted) {
    const std::string line =
        point.method == "VQ" ? "VQ" : fmt::format("{}, {} bits", point.method, point.bits);
    auto series =
        std::find_if(chart.series.begin(), chart.series.end(), [&](const auto& s) { return s.name == line; });
    if (series == chart.series.end())
      series = chart.series.insert(series, report::Series{line, {}, {}, {}, {}});
    if (!series->y.empty() && point.error >= series->y.back()) continue;
    series->x.push_back(point.bytes_per_vertex);
    series->y.push_back(point.error);
  }
  return chart;
}

report::Table table_of(const std::string& name, const std::vector<SizedError>& points) {
  report::Table table{
      name + ": compression",
      "All that was tried.",
      {"method", "clusters", "components", "bits", "bytes a vertex", "error", "of clustering"},
      {}};
  for (const SizedError& p : points) {
    table.rows.push_back({p.method, std::to_string(p.clusters), std::to_string(p.components),
                          p.method == "VQ" ? "" : std::to_string(p.bits),
                          fmt::format("{:.2f}", p.bytes_per_vertex), fmt::format("{:.3g} %", 100.0 * p.error),
                          fmt::format("{:.3g} %", 100.0 * p.clustering_error)});
  }
  return table;
}

nlohmann::json json_of(const std::vector<SizedError>& points) {
  nlohmann::json rows = nlohmann::json::array();
  for (const SizedError& p : points) {
    rows.push_back({{"method", p.method},
                    {"clusters", p.clusters},
                    {"components", p.components},
                    {"bits", p.bits},
                    {"bytes_per_vertex", p.bytes_per_vertex},
                    {"error", p.error},
                    {"clustering_error", p.clustering_error}});
  }
  return rows;
}

report::Table seam_table(const std::string& name, const compress::Seams& seams) {
  const auto cell = [](double x) { return fmt::format("{:.3g}", x); };
  return {name + ": seams between clusters",
          "Exit radiance for unit albedo across the edges of triangles, root mean squares. What compression "
          "adds at the borders of clusters "
          "should be small against the jump that is there.",
          {"border edges", "jump, uncompressed", "jump, CPCA", "added at borders", "added inside clusters"},
          {{std::to_string(seams.border_edges), cell(seams.exact_jump), cell(seams.border_jump),
            cell(seams.border_added), cell(seams.inner_added)}}};
}

compress::Vectors vectors_of(const std::vector<Rgb>& colours) {
  return {{&colours.front().x, 3 * colours.size()}, 3};
}

void check_scene(const Suite& suite, const NamedScene& scene, report::Report& report) {
  const Budget& budget = suite.budget;
  const transfer::Transfer transfer = rgb_transfer(scene.scene, 2 * budget.seed + 1, budget);
  const transfer::Transfer again = rgb_transfer(scene.scene, 2 * budget.seed + 2, budget);
  CompressionGrid grid;
  grid.seed = budget.seed;
  grid.threads = budget.threads;
  const std::vector<SizedError> points = compression_study(transfer, grid);
  for (Finding& finding : judge_curves(scene.name, points)) report.findings.push_back(std::move(finding));
  report.charts.push_back(chart_of(scene.name, points));
  report.tables.push_back(table_of(scene.name, points));
  report.data["compression"][scene.name] = json_of(points);

  const compress::Compressed cpca = compressed_of(transfer, compress::Method::cpca, kClusters, budget);
  const compress::Compressed vq = compressed_of(transfer, compress::Method::vq, 4096, budget);
  const light::Environment& environment = suite.environments.front();
  const sh::ShRgb light = sh::project_radiance(environment, kBands, budget.threads);
  const std::vector<Rgb> exact = relight::unit_albedo_exit_radiance(transfer, light);
  const std::vector<Rgb> compressed = relit(cpca, transfer, light);
  const Views views{view(scene, exact, budget),
                    view(scene, relight::unit_albedo_exit_radiance(again, light), budget),
                    view(scene, compressed, budget), view(scene, relit(vq, transfer, light), budget)};
  const metrics::Estimate flip = flip_of(views.exact, views.compressed);
  const std::string name = scene.name + ", " + short_name(environment.name);
  report.findings.push_back(judge_flip(name, flip, flip_of(views.exact, views.again)));
  report.headlines.push_back({fmt::format("{}: transfer in {:.1f} bytes a vertex instead of 300", name,
                                          compress::bytes_per_vertex(cpca)),
                              fmt::format("error {:.2g} %, FLIP {:.2g} ± {:.1g}", 100.0 * cpca.relative_error,
                                          flip.mean, 1.96 * flip.standard_error),
                              "Good is a FLIP below that of baking again"});
  report.tables.push_back(
      seam_table(name, compress::measure_seams(scene.scene.triangles, cpca.labels, vectors_of(exact),
                                               vectors_of(compressed))));
  add_gallery(name, views, report);
}

}  // namespace

void check_compression(const Suite& suite, report::Report& report) {
  for (const NamedScene& scene : suite.scenes) {
    if (suite.announce) suite.announce("compression of " + scene.name);
    check_scene(suite, scene, report);
  }
}

}  // namespace plumbline::checks
