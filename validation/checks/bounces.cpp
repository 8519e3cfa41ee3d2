#include "validation/checks/bounces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prt/sh/basis.hpp"
#include "prt/transfer/bake.hpp"
#include "reference/integrate/gather.hpp"
#include "reference/scene/builtin.hpp"
#include "reference/scene/shapes.hpp"
#include "validation/checks/paired_error.hpp"
#include "validation/checks/suite.hpp"
#include "validation/checks/verdicts.hpp"
#include "validation/metrics/statistics.hpp"
#include "validation/truth/multibounce.hpp"

namespace plumbline::checks {
namespace {

constexpr int kRuns = 8;  // independent bakes: their spread is the bake's error, whatever causes it
constexpr double kSetsLess1 = 15.0;  // the path tracer's errors come from 16 randomisations

constexpr const char* kSource =
    "Term k of the transfer times the light is the irradiance over pi that bounced k times: two methods that "
    "share no "
    "sampling";

transfer::BakeSettings settings_of(const TermsEffort& effort) {
  transfer::BakeSettings settings;
  settings.kind = transfer::Kind::interreflected;
  settings.bands = effort.bands;
  settings.samples = effort.samples;
  settings.seed = effort.seed;
  settings.threads = effort.threads;
  settings.max_bounces = effort.bounces;
  settings.kept_terms = effort.bounces + 1;
  return settings;
}

/// Rows of one or three channels as RGB coefficients.
template <class Values>
std::vector<RgbD> rgb_of(const Values& values, int channels, std::size_t count) {
  std::vector<RgbD> result(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (int c = 0; c < 3; ++c)
      result[i][c] =
          static_cast<double>(values[(channels == 3 ? static_cast<std::size_t>(c) : 0U) * count + i]);
  }
  return result;
}

/// Irradiance [vertex][bounce]: pi times the transferred radiance.
std::vector<std::vector<RgbD>> irradiances(const std::vector<VertexTerms>& terms, const sh::ShRgb& light) {
  std::vector<std::vector<RgbD>> result;
  for (const VertexTerms& vertex : terms) {
    auto& bounces = result.emplace_back();
    for (const std::vector<RgbD>& term : vertex) {
      RgbD sum(0.0);
      for (std::size_t i = 0; i < term.size(); ++i) sum += term[i] * light.coefficients[i];
      bounces.push_back(kPi * sum);
    }
  }
  return result;
}

double channel_sum(const RgbD& v) {
  return v.x + v.y + v.z;
}

/// A light of three bands that is bright above and has a direction.
sh::ShRgb test_light() {
  sh::ShRgb light = sh::project_radiance(light::load_environment("builtin:overcast"), 3);
  const sh::ShRgb lobes = sh::project_radiance(light::load_environment("builtin:two-lobes"), 3);
  for (std::size_t i = 0; i < light.coefficients.size(); ++i)
    light.coefficients[i] += 0.5 * lobes.coefficients[i];
  return light;
}

double margin_of(const Budget& budget) {
  return budget.tier == Tier::nightly ? 0.005 : 0.02;
}

}  // namespace

TermsBaker traced_terms() {
  return {"random walks",
          [](const scene::Scene& scene, std::span<const std::size_t> vertices, const TermsEffort& effort) {
            const trace::RayCaster caster(scene);
            const std::vector<trace::SurfacePoint> points = trace::vertex_points(scene);
            const auto count = static_cast<std::size_t>(sh::coefficient_count(effort.bands));
            std::vector<VertexTerms> result;
            for (const std::size_t v : vertices) {
              const transfer::PointTerms point =
                  transfer::interreflected_transfer(scene, caster, points[v], settings_of(effort), v);
              auto& terms = result.emplace_back();
              for (const transfer::PointTransfer& term : point.terms)
                terms.push_back(rgb_of(term.coefficients, point.channels, count));
            }
            return result;
          }};
}

TermsBaker iterated_terms() {
  return {"iteration",
          [](const scene::Scene& scene, std::span<const std::size_t> vertices, const TermsEffort& effort) {
            transfer::BakeSettings settings = settings_of(effort);
            settings.method.solver = transfer::Solver::iterative;
            const transfer::Transfer baked = transfer::bake(scene, settings);
            const auto count = static_cast<std::size_t>(sh::coefficient_count(effort.bands));
            const std::size_t stride = count * static_cast<std::size_t>(baked.channels);
            std::vector<VertexTerms> result;
            for (const std::size_t v : vertices) {
              auto& terms = result.emplace_back();
              for (const transfer::Term& term : baked.terms)
                terms.push_back(
                    rgb_of(std::span(term.coefficients).subspan(v * stride, stride), baked.channels, count));
            }
            return result;
          }};
}

BounceCase trace_bounces(const std::string& name, scene::Scene scene, std::size_t vertices, int samples,
                         const Budget& budget) {
  BounceCase result;
  result.name = name;
  result.scene = std::move(scene);
  result.light = test_light();
  const std::size_t all = result.scene.positions.size();
  const std::size_t step = std::max<std::size_t>(1, (all + vertices - 1) / vertices);
  for (std::size_t v = step / 2; v < all; v += step) result.vertices.push_back(v);
  const integrate::World world(result.scene, sh::band_limited_environment(result.light, name));
  const std::vector<trace::SurfacePoint> points = trace::vertex_points(result.scene);
  std::vector<trace::SurfacePoint> chosen;
  for (const std::size_t v : result.vertices) chosen.push_back(points[v]);
  for (std::size_t half = 0; half < 2; ++half) {
    integrate::GatherSettings settings;
    settings.samples = samples;
    settings.max_bounces = result.bounces;
    settings.seed = 2 * budget.seed + 101 + half;
    settings.threads = budget.threads;
    for (const integrate::BouncesEstimate& e : integrate::gather_bounces(world, chosen, settings)) {
      auto& means = result.halves[half].emplace_back();
      auto& errors = result.errors[half].emplace_back();
      for (const integrate::RgbEstimate& bounce : e.bounces) {
        means.push_back(bounce.mean);
        errors.push_back(bounce.standard_error);
      }
    }
  }
  return result;
}

std::vector<NamedShape> bounce_shapes() {
  std::vector<NamedShape> shapes;
  for (const char* name : {"corner", "open-box", "cornell"}) {
    scene::Scene scene = scene::make_builtin_scene(name);
    for (scene::Material& material : scene.materials) material.emission = Rgb(0.0F);
    shapes.push_back({name, std::move(scene)});
  }
  return shapes;
}

// The bake runs kRuns times. Its mean over vertices varies between runs as its noise makes it, correlations among
// vertices and coefficients included; the path tracer's error is that of independent vertices. The squared difference is
// (a - x)(b - y) with halves a, b of the runs and x, y of the path tracer, so that no noise is squared.
std::vector<BounceDifference> measure_bounces(const BounceCase& one, const TermsBaker& baker,
                                              const TermsEffort& effort) {
  std::vector<std::vector<std::vector<RgbD>>> runs;
  for (int run = 0; run < kRuns; ++run) {
    TermsEffort once = effort;
    once.bounces = one.bounces;
    once.seed = effort.seed * kRuns + static_cast<std::uint64_t>(run) + 1;
    runs.push_back(irradiances(baker.terms(one.scene, one.vertices, once), one.light));
  }
  const double values = 3.0 * static_cast<double>(one.vertices.size());
  std::vector<BounceDifference> result;
  for (std::size_t k = 0; k <= static_cast<std::size_t>(one.bounces); ++k) {
    BounceDifference d;
    std::vector<double> means(kRuns, 0.0);
    double reference = 0.0;
    double variance = 0.0;
    metrics::RunningMoments squares;
    for (std::size_t v = 0; v < one.vertices.size(); ++v) {
      RgbD half[2] = {RgbD(0.0), RgbD(0.0)};
      for (std::size_t run = 0; run < kRuns; ++run) {
        const RgbD value = k < runs[run][v].size() ? runs[run][v][k] : RgbD(0.0);
        means[run] += channel_sum(value) / values;
        half[run % 2] += value * (2.0 / kRuns);
      }
      for (std::size_t h = 0; h < 2; ++h) {
        reference += 0.5 * channel_sum(one.halves[h][v][k]) / values;
        // The channels of one path are as good as one number: their errors add, not the squares.
        variance += 0.25 * std::pow(channel_sum(one.errors[h][v][k]) / values, 2);
      }
      squares.add(channel_sum((half[0] - one.halves[0][v][k]) * (half[1] - one.halves[1][v][k])) / 3.0);
    }
    const metrics::Estimate baked = metrics::estimate(means);
    const double own = baked.standard_error * baked.standard_error;
    d.mean_irradiance = reference;
    d.bias = (baked.mean - reference) / reference;
    d.standard_error = std::sqrt(own + variance) / reference;
    // Welch-Satterthwaite; the path tracer's share has 15 for every vertex and half.
    const double nu = own * own / (kRuns - 1) +
                      variance * variance / (kSetsLess1 * 2.0 * static_cast<double>(one.vertices.size()));
    d.degrees_of_freedom = nu > 0.0 ? (own + variance) * (own + variance) / nu : kRuns - 1;
    const metrics::Estimate square = squares.estimate();
    d.square = square.mean / (reference * reference);
    d.square_error = square.standard_error / (reference * reference);
    result.push_back(d);
  }
  return result;
}

namespace {

Finding mean_finding(const std::string& name, const BounceDifference& d, double margin, double significance) {
  Finding finding;
  finding.family = "bounces";
  finding.name = name;
  finding.unit = "%";
  finding.source = kSource;
  finding.measured = 100.0 * d.bias;
  finding.bound = 100.0 * margin;
  finding.verdict = Verdict::fail;
  if (!std::isfinite(d.bias) || !std::isfinite(d.standard_error)) {
    finding.detail = "Not a number.";
    return finding;
  }
  finding.uncertainty = 100.0 * metrics::two_sided_t(0.05, d.degrees_of_freedom) * d.standard_error;
  const double reach = metrics::two_sided_t(2.0 * significance, d.degrees_of_freedom) * d.standard_error;
  if (std::abs(d.bias) + reach <= margin) {
    finding.verdict = Verdict::pass;
  } else if (std::abs(d.bias) - reach <= margin) {
    finding.verdict = Verdict::inconclusive;
  }
  finding.detail = fmt::format(
      "Mean over vertices and channels, relative to the path tracer's {:.4g} W/m2: two one-sided tests, "
      "interval "
      "+-{:.2g} %.",
      d.mean_irradiance, 100.0 * reach);
  return finding;
}

}  // namespace

std::vector<Finding> judge_bounces(const BounceCase& one, const TermsBaker& baker, const TermsEffort& effort,
                                   const Budget& budget) {
  const std::vector<BounceDifference> differences = measure_bounces(one, baker, effort);
  const double significance = metrics::sidak(budget.significance, 2 * differences.size());
  std::vector<Finding> findings;
  for (std::size_t k = 0; k < differences.size(); ++k) {
    const BounceDifference& d = differences[k];
    const std::string name = fmt::format("{} / {}, bounce {}", one.name, baker.name, k);
    findings.push_back(mean_finding(name, d, margin_of(budget), significance));
    findings.push_back(
        judge_deviation({"bounces", name + ", vertex by vertex", kSource,
                         "Mean squared difference over the squared mean, noise of both sides taken off."},
                        {d.square, d.square_error}, 1e-6, 0.02, significance));
  }
  return findings;
}

namespace {

constexpr double kReach = 1e4;
const Rgb kFloor(0.8F, 0.5F, 1.0F);
const Rgb kWall(0.8F, 0.8F, 1.0F);

/// Floor z = 0 towards +y and wall y = 0 towards +z. The first four vertices are those of a small square of the floor
/// beside the wall: the points of vertices lie 1/1000 of it inside.
scene::Scene infinite_corner() {
  scene::Scene scene;
  const auto floor = scene::add_material(scene, {.name = "floor", .albedo = kFloor});
  const auto wall = scene::add_material(scene, {.name = "wall", .albedo = kWall});
  const auto add = [&](double x, double y, double width, double depth) {
    scene::append(scene, scene::make_grid({x, y, 0}, {width, 0, 0}, {0, depth, 0}, 1, 1), floor);
  };
  add(-1, 0, 2, 1);
  add(-kReach, 0, kReach - 1, kReach);
  add(1, 0, kReach - 1, kReach);
  add(-1, 1, 2, kReach - 1);
  scene::append(scene, scene::make_grid({-kReach, 0, 0}, {0, 0, kReach}, {2 * kReach, 0, 0}, 1, 1), wall);
  return scene;
}

}  // namespace

namespace {

// pass: within 1e-3; fail: farther than chance explains.
Finding corner_finding(const std::vector<std::vector<RgbD>>& runs, int channel, const std::string& baker,
                       int bounces) {
  const auto floor = static_cast<double>(kFloor[channel]);
  const auto wall = static_cast<double>(kWall[channel]);
  const truth::ThreeBands truth = truth::corner_transfer({0, 0, 1}, {0, 1, 0}, floor, wall, bounces);
  double distance = 0.0;
  double norm = 0.0;
  double noise = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    std::vector<double> values;
    for (const std::vector<RgbD>& run : runs) values.push_back(run[i][channel]);
    const metrics::Estimate mean = metrics::estimate(values);
    distance += std::pow(mean.mean - truth[i], 2);
    noise += std::pow(mean.standard_error, 2);
    norm += truth[i] * truth[i];
  }
  Finding finding = judge_error(
      {"bounces",
       fmt::format("infinite corner, albedos {} and {} / {}", kFloor[channel], kWall[channel], baker),
       "T = (D1 + F rho2 D2)/(1 - F^2 rho1 rho2), as far as the bounces go",
       fmt::format(
           "Distance of the nine coefficients after {} bounces from the closed form, over its norm; of that "
           "noise, about: {:.2g}.",
           bounces, std::sqrt(noise / norm))},
      std::sqrt(distance / norm), 1e-3);
  const double reach = metrics::two_sided_t(1e-4 / 3.0, kRuns - 1) * std::sqrt(noise / norm);
  if (finding.verdict == Verdict::fail && finding.measured - reach <= finding.bound)
    finding.verdict = Verdict::inconclusive;
  return finding;
}

}  // namespace

// A point at d = 1 from the edge: the quads' size leaves its form factor off by 0.568 d/W = 6e-5 (finite_corner_form_factor),
// and the rounding of rays against triangles of that size, 1e-3 d, moves the edge by as little. Nearer to the edge, or with
// larger quads, rounding would tell.
std::vector<Finding> judge_corner(const TermsBaker& baker, const TermsEffort& effort) {
  const scene::Scene corner = infinite_corner();
  std::size_t vertex = 0;
  while (corner.positions[vertex].y < 0.5F) ++vertex;
  std::vector<std::vector<RgbD>> runs;  // [run][coefficient], all bounces together
  for (int run = 0; run < kRuns; ++run) {
    TermsEffort once = effort;
    once.bands = 3;
    once.samples = effort.samples / kRuns;
    once.seed = effort.seed * kRuns + static_cast<std::uint64_t>(run) + 1;
    auto& sum = runs.emplace_back(truth::ThreeBands{}.size(), RgbD(0.0));
    const std::vector<VertexTerms> terms = baker.terms(corner, {&vertex, 1}, once);
    for (const std::vector<RgbD>& term : terms.front())
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += term[i];
  }
  std::vector<Finding> findings;
  for (int c = 0; c < 3; ++c) findings.push_back(corner_finding(runs, c, baker.name, effort.bounces));
  return findings;
}

namespace {

report::Table interpolation_table() {
  return {"Bounces: what interpolation between vertices costs the iterative solver",
          "Irradiance of one bounce against the path tracer: mean over vertices, and root of the mean square "
          "without noise, "
          "in per cent of the mean. Random walks interpolate nothing: theirs must vanish. Iteration gathers "
          "from vertices: "
          "on coarse meshes its bounces 1 and more are off by that.",
          {"scene", "bounce", "irradiance", "random walks: mean", "root mean square", "iteration: mean",
           "root mean square"},
          {}};
}

std::string rms_text(const BounceDifference& d) {
  const RootMeanSquare r = root({d.square, d.square_error});
  return fmt::format("{:.2g} [{:.2g}, {:.2g}]", 100.0 * r.value, 100.0 * r.low, 100.0 * r.high);
}

std::string mean_text(const BounceDifference& d) {
  return fmt::format("{:+.2f} +- {:.2f}", 100.0 * d.bias,
                     100.0 * metrics::two_sided_t(0.05, d.degrees_of_freedom) * d.standard_error);
}

void add_rows(const BounceCase& one, const TermsEffort& effort, report::Table& table) {
  const std::vector<BounceDifference> traced = measure_bounces(one, traced_terms(), effort);
  const std::vector<BounceDifference> iterated = measure_bounces(one, iterated_terms(), effort);
  for (std::size_t k = 0; k < traced.size(); ++k) {
    table.rows.push_back({one.name, std::to_string(k), fmt::format("{:.4g}", traced[k].mean_irradiance),
                          mean_text(traced[k]), rms_text(traced[k]), mean_text(iterated[k]),
                          rms_text(iterated[k])});
  }
}

}  // namespace

void check_bounces(const Suite& suite, report::Report& report) {
  const bool is_quick = suite.budget.tier == Tier::quick;
  const std::size_t vertices = is_quick ? 64 : 256;
  TermsEffort effort;
  effort.samples = is_quick ? 1024 : 16384;
  effort.seed = suite.budget.seed;
  effort.threads = suite.budget.threads;
  report::Table table = interpolation_table();
  const auto judge = [&](const std::string& name, const scene::Scene& scene, bool is_iterated_too) {
    if (suite.announce) suite.announce("bounces of " + name);
    const BounceCase one = trace_bounces(name, scene, vertices, 4 * effort.samples, suite.budget);
    for (Finding& finding : judge_bounces(one, traced_terms(), effort, suite.budget)) {
      finding.seed = suite.budget.seed;
      report.findings.push_back(std::move(finding));
    }
    TermsEffort small = effort;
    small.samples = is_quick ? 128 : 1024;
    if (is_iterated_too) add_rows(one, small, table);
  };
  for (const NamedShape& shape : bounce_shapes()) judge(shape.name, shape.scene, true);
  for (const NamedScene& scene : suite.scenes) judge(scene.name, scene.scene, !is_quick);
  if (suite.announce) suite.announce("bounces of an infinite corner");
  TermsEffort long_walk = effort;
  long_walk.bounces = 8;
  long_walk.samples = 1 << (is_quick ? 21 : 24);
  for (Finding& finding : judge_corner(traced_terms(), long_walk))
    report.findings.push_back(std::move(finding));
  report.tables.push_back(std::move(table));
}

}  // namespace plumbline::checks
