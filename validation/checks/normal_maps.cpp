// Normal-mapped PRT against the path tracer with the same normal map, direct light, under the band-limited light that both see. Bumps
// neither shadow nor light each other in either: the map only turns the normal. So the methods differ from the truth by (1) what quadratic incident
// radiance cannot hold, (2) interpolation between vertices and bake noise, and (3) the method's own shortcut.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "prt/normal_map/view.hpp"
#include "prt/relight/cpu.hpp"
#include "prt/sh/lighting.hpp"
#include "prt/sh/quadrature.hpp"
#include "prt/transfer/bake.hpp"
#include "reference/image/exr.hpp"
#include "reference/integrate/render.hpp"
#include "reference/scene/builtin.hpp"
#include "reference/scene/load.hpp"
#include "reference/scene/normal_map.hpp"
#include "validation/checks/normal_maps.hpp"
#include "validation/checks/suite.hpp"
#include "validation/checks/verdicts.hpp"

namespace plumbline::checks {
namespace {

using image::Image;
using normal_map::Shader;

constexpr int kTextureSide = 64;
constexpr const char* kFamily = "normal-maps";

struct Method {
  std::string name;
  std::string stored;  // numbers a vertex, for a light of n bands
  Shader shader;
};
// Places in the list of methods, best first.
enum : std::size_t { kWorld, kFrame, kSixTerms, kFourTerms, kFitted, kHalfLife2, kRatio, kNoMap };

/// What is baked once a scene and band count.
struct Bakes {
  normal_map::LocalTransfer world;
  normal_map::LocalTransfer tangent;
  transfer::Transfer vertex;  // ordinary shadowed transfer
};

Bakes bake_all(const scene::Scene& scene, int bands, const Budget& budget) {
  Bakes bakes;
  normal_map::LocalBakeSettings local;
  local.bands = bands;
  local.samples = budget.bake_samples;
  local.seed = budget.seed;
  local.threads = budget.threads;
  bakes.world = normal_map::bake_incident_radiance(scene, local);
  bakes.tangent = normal_map::in_tangent_frames(bakes.world, scene);
  transfer::BakeSettings settings;
  settings.bands = bands;
  settings.samples = budget.bake_samples;
  settings.seed = budget.seed + 1;
  settings.threads = budget.threads;
  bakes.vertex = transfer::bake(scene, settings);
  return bakes;
}

std::vector<Method> make_methods(const scene::Scene& scene, const Bakes& bakes, const sh::ShRgb& light) {
  using namespace normal_map;
  const NormalBasis basis = make_normal_basis(NormalWeight::cosine);
  const auto terms = [&](int count) {
    return shade_by_texture(lit_rows(compressed(bakes.tangent, basis, count), light),
                            make_normal_texture(basis, count, kTextureSide));
  };
  const std::vector<Rgb> radiance = relight::unit_albedo_exit_radiance(bakes.vertex, light);
  return {{"9 terms, world axes", "9 n^2", shade_in_world(lit_rows(bakes.world, light))},
          {"9 terms, tangent frames", "9 n^2", shade_in_frame(lit_rows(bakes.tangent, light))},
          {"6 terms (SVD)", "6 n^2", terms(6)},
          {"4 terms (SVD)", "4 n^2", terms(4)},
          {"Half-Life 2 basis, fitted", "3 n^2",
           shade_half_life_2_fitted(lit_rows(half_life_2_fitted(bakes.tangent), light))},
          {"Half-Life 2 basis, as shipped", "3 n^2",
           shade_half_life_2(lit_rows(half_life_2(bakes.tangent), light))},
          {"shadowed / unshadowed ratio", "n^2", shade_by_ratio(scene, radiance, light)},
          {"the map ignored", "n^2", shade_without_map(radiance)}};
}

struct Reference {
  Image mean;
  Image variance;
};

Reference trace(const NamedScene& scene, const light::Environment& light, const Budget& budget) {
  const integrate::World world(scene.scene, light);
  integrate::RenderSettings settings;
  settings.width = budget.width;
  settings.height = budget.height;
  settings.samples_per_pixel = budget.image_samples;
  settings.max_bounces = 0;
  settings.seed = budget.seed + 2;
  settings.threads = budget.threads;
  settings.is_background_visible = false;
  const integrate::RenderResult result =
      integrate::render(world, scene::find_camera(world.scene, scene.camera), settings);
  Reference reference{*image::rgb_layer(result.image, ""), *image::rgb_layer(result.image, "stderr")};
  for (Rgb& v : reference.variance.pixels) v *= v;
  return reference;
}

double at(const Image& image, std::size_t pixel, int c) {
  return static_cast<double>(image.pixels[pixel][c]);
}

/// Mean square difference to the truth with the truth's own noise taken off.
metrics::Estimate mean_square_error(const Image& image, const Reference& truth, const Mask& mask) {
  return tile_mean(mask, image.width, image.height, [&](std::size_t i, int c) {
    return std::pow(at(image, i, c) - at(truth.mean, i, c), 2) - at(truth.variance, i, c);
  });
}

/// The same for two images: the second's less the first's. The truth's noise cancels but for its product with their difference.
metrics::Estimate excess_error(const Image& better, const Image& worse, const Reference& truth,
                               const Mask& mask) {
  return tile_mean(mask, better.width, better.height, [&](std::size_t i, int c) {
    return std::pow(at(worse, i, c) - at(truth.mean, i, c), 2) -
           std::pow(at(better, i, c) - at(truth.mean, i, c), 2);
  });
}

/// Pixels wholly covered by fronts.
Mask covered(const NamedScene& scene, const relight::ViewSettings& settings) {
  scene::Scene white = scene.scene;
  for (scene::Material& material : white.materials) {
    material = scene::Material{};
    material.albedo = Rgb(1.0F);
  }
  const auto one = [](const normal_map::Fragment&) { return Rgb(1.0F); };
  white.vertex_colors.clear();
  white.tangents.clear();
  const Image cover =
      normal_map::render_shaded(white, scene::find_camera(white, scene.camera), settings, {Shader(one)})[0];
  Mask mask;
  for (const Rgb& pixel : cover.pixels) mask.push_back(pixel.x > 0.999F);
  return mask;
}

std::string percent(const metrics::Estimate& mean_square, double scale) {
  const RootMeanSquare r = root(mean_square);
  return fmt::format("{:.3g} % [{:.3g}, {:.3g}]", 100.0 * r.value / scale, 100.0 * r.low / scale,
                     100.0 * r.high / scale);
}

/// One view under one light.
struct View {
  std::string name;
  Reference truth;
  std::vector<Method> methods;
  std::vector<Image> images;
  Image bound;  // of the error of nine terms
  Mask mask;
  double mean = 0.0;  // of the truth
};

void add_rows(const View& view, const std::vector<std::string>& where, report::Table& table) {
  for (std::size_t i = 0; i < view.methods.size(); ++i) {
    const metrics::Estimate shortcut =
        tile_mean(view.mask, view.truth.mean.width, view.truth.mean.height, [&](std::size_t p, int c) {
          return std::pow(at(view.images[i], p, c) - at(view.images[kWorld], p, c), 2);
        });
    std::vector<std::string> row = where;
    row.insert(row.end(), {view.methods[i].name, view.methods[i].stored,
                           percent(mean_square_error(view.images[i], view.truth, view.mask), view.mean),
                           percent(shortcut, view.mean)});
    table.rows.push_back(std::move(row));
  }
}

void add_gallery(const View& view, report::Report& report) {
  report::Gallery gallery;
  gallery.title = view.name + ": normal maps";
  gallery.exposure_stops =
      static_cast<float>(std::clamp(std::round(4.0 * std::log2(0.35 / view.mean)) / 4.0, -10.0, 10.0));
  gallery.caption =
      "One normal map over coarse transfer, direct light. The relief must look the same as path traced; "
      "fewer numbers a vertex "
      "flatten or tint it.";
  gallery.entries.push_back({"path traced", view.truth.mean});
  for (std::size_t i = 0; i < view.methods.size(); ++i)
    gallery.entries.push_back({view.methods[i].name, view.images[i]});
  for (const std::size_t i :
       {std::size_t{kWorld}, std::size_t{kFourTerms}, std::size_t{kHalfLife2}, std::size_t{kRatio}}) {
    gallery.errors.push_back(report::error_map(view.methods[i].name + " against path tracing",
                                               view.truth.mean, view.images[i], 0.2 * view.mean, "radiance"));
  }
  report.galleries.push_back(std::move(gallery));
}

/// Two methods of which the first must be nearer to the truth.
struct Pair {
  std::size_t better, worse;
  const char* source;
};
constexpr const char* kEnergies =
    "Sloan 2005: 4, 6 and 9 terms keep 96.4, 99.3 and 100 % of the squared energy";
constexpr const char* kCourse = "Sloan 2005: the ratio is \"a much more approximate solution\"";
constexpr const char* kOptimal =
    "Eckart & Young: no four functions of the normal hold more than singular vectors; here are three";
constexpr const char* kFit =
    "Least squares: no numbers for these three functions do better, over all normals";
constexpr const char* kMap = "The map bends normals by up to 40 degrees";
constexpr std::array<Pair, 6> kPairs = {{{kFrame, kSixTerms, kEnergies},
                                         {kSixTerms, kFourTerms, kEnergies},
                                         {kFourTerms, kFitted, kOptimal},
                                         {kFourTerms, kRatio, kCourse},
                                         {kFourTerms, kNoMap, kMap},
                                         {kFitted, kHalfLife2, kFit}}};

std::vector<Finding> judge(const View& view, double significance) {
  std::vector<Finding> findings;
  const RootMeanSquare error = root(mean_square_error(view.images[kWorld], view.truth, view.mask));
  const double bound = tile_mean(view.mask, view.bound.width, view.bound.height, [&](std::size_t i, int c) {
                         return std::pow(at(view.bound, i, c), 2);
                       }).mean;
  findings.push_back(judge_error({kFamily, view.name + " / nine terms",
                                  "The kernel max(0, cos) is off by 3/32 at most when cut at degree 2; times "
                                  "|light| above each surface, over pi",
                                  "RMSE of nine terms in world axes against path tracing, upper end of the "
                                  "interval. Interpolation and bake noise are in it."},
                                 error.high, std::sqrt(bound)));
  for (const Pair& pair : kPairs) {
    const metrics::Estimate excess =
        excess_error(view.images[pair.better], view.images[pair.worse], view.truth, view.mask);
    findings.push_back(
        judge_order({kFamily,
                     fmt::format("{} / {} before {}", view.name, view.methods[pair.better].name,
                                 view.methods[pair.worse].name),
                     pair.source,
                     "Mean squared error of the first less that of the second, over the squared mean "
                     "radiance: must be below 0."},
                    {-excess.mean / (view.mean * view.mean), excess.standard_error / (view.mean * view.mean)},
                    significance));
  }
  return findings;
}

/// `seen`: the scene that the methods are given.
View look(const NamedScene& scene, const scene::Scene& seen, const Bakes& bakes, const sh::ShRgb& light,
          const std::string& light_name, const Budget& budget) {
  constexpr int kGrid = 8;
  const relight::ViewSettings settings{budget.width, budget.height, kGrid, budget.threads};
  View view;
  view.name = fmt::format("{} under {}, {} bands", scene.name, light_name, light.bands);
  view.truth = trace(scene, sh::band_limited_environment(light, light_name), budget);
  view.methods = make_methods(seen, bakes, light);
  std::vector<Shader> shaders;
  for (const Method& method : view.methods) shaders.push_back(method.shader);
  shaders.push_back(normal_map::shade_without_map(nine_terms_bounds(seen, light)));
  view.images =
      normal_map::render_shaded(seen, scene::find_camera(scene.scene, scene.camera), settings, shaders);
  view.bound = std::move(view.images.back());
  view.images.pop_back();
  view.mask = covered(scene, settings);
  view.mean = tile_mean(view.mask, budget.width, budget.height, [&](std::size_t i, int c) {
                return at(view.truth.mean, i, c);
              }).mean;
  return view;
}

std::vector<NamedScene> mapped_scenes(const Suite& suite) {
  std::vector<NamedScene> scenes;
  for (const NamedScene& scene : suite.scenes) {
    if (scene::has_normal_map(scene.scene)) scenes.push_back(scene);
  }
  if (scenes.empty())
    scenes.push_back({"builtin:normal-mapped", scene::make_builtin_scene("normal-mapped"), ""});
  return scenes;
}

}  // namespace

std::vector<Rgb> nine_terms_bounds(const scene::Scene& scene, const sh::ShRgb& light) {
  constexpr double kKernelError = 3.0 / 32.0;
  constexpr int kQuadratureBands = 32;
  struct Node {
    Vec3d direction;
    RgbD weighted;  // |light| times the node's solid angle
  };
  std::vector<Node> nodes;
  for (const sh::SphereNode& node : sh::sphere_quadrature(kQuadratureBands)) {
    nodes.push_back({node.direction, glm::abs(sh::evaluate(light, node.direction)) * node.weight});
  }
  std::vector<Rgb> bounds;
  bounds.reserve(scene.normals.size());
  for (const Vec3& normal : scene.normals) {
    RgbD sum(0.0);
    for (const Node& node : nodes) {
      if (glm::dot(node.direction, Vec3d(normal)) > 0.0) sum += node.weighted;
    }
    bounds.emplace_back(sum * (kKernelError / kPi));
  }
  return bounds;
}

std::vector<Finding> judge_normal_maps(const NamedScene& scene, const scene::Scene& seen,
                                       const light::Environment& environment, int bands,
                                       const Budget& budget) {
  const sh::ShRgb light = sh::project_radiance(environment, bands, budget.threads);
  const View view =
      look(scene, seen, bake_all(seen, bands, budget), light, short_name(environment.name), budget);
  return judge(view, budget.significance);
}

Finding judge_order(const Label& label, const metrics::Estimate& difference, double significance) {
  Finding finding =
      judge_error(label, difference.mean, metrics::two_sided_z(significance) * difference.standard_error);
  finding.uncertainty = metrics::two_sided_z(0.05) * difference.standard_error;
  const bool is_clear = difference.mean + finding.uncertainty < 0.0;
  if (finding.verdict == Verdict::pass && !is_clear) finding.verdict = Verdict::inconclusive;
  return finding;
}

void check_normal_maps(const Suite& suite, report::Report& report) {
  report::Table table{
      "Normal-mapped PRT",
      "RMSE over covered pixels in percent of the mean radiance, against path tracing with the same normal "
      "map and the "
      "same band-limited light (its noise removed), and against the nine terms in world axes, with 95 % "
      "intervals. n: "
      "bands of the light. Good: fewer numbers, little more error.",
      {"scene", "light", "bands", "method", "numbers a vertex", "error", "difference to nine terms"},
      {}};
  for (const NamedScene& scene : mapped_scenes(suite)) {
    for (const int bands : suite.bands) {
      if (bands < normal_map::kQuadraticBands) continue;
      if (suite.announce)
        suite.announce(fmt::format("normal-mapped transfer of {}, {} bands", scene.name, bands));
      const Bakes bakes = bake_all(scene.scene, bands, suite.budget);
      for (const light::Environment& environment : suite.environments) {
        const sh::ShRgb light = sh::project_radiance(environment, bands, suite.budget.threads);
        const std::string name = short_name(environment.name);
        const View view = look(scene, scene.scene, bakes, light, name, suite.budget);
        for (Finding& finding : judge(view, suite.budget.significance))
          report.findings.push_back(std::move(finding));
        add_rows(view, {scene.name, name, std::to_string(bands)}, table);
        if (bands == suite.bands.back()) add_gallery(view, report);
      }
    }
  }
  report.tables.push_back(std::move(table));
}

}  // namespace plumbline::checks
