#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prt/transfer/bake.hpp"
#include "reference/integrate/gather.hpp"
#include "validation/checks/suite.hpp"
#include "validation/checks/verdicts.hpp"

namespace plumbline::checks {
namespace {

constexpr std::size_t kPoints = 4096;

/// The same shape, white, reflecting on both sides, with flat faces: whatever the mesh, light under a white sky is 1 everywhere.
scene::Scene white_furnace(const scene::Scene& original) {
  scene::Scene white;
  white.materials.push_back({"white", Rgb(1.0F), Rgb(0.0F), -1, true});
  for (std::uint32_t t = 0; t < original.triangles.size(); ++t) {
    const auto first = static_cast<std::uint32_t>(white.positions.size());
    for (int k = 0; k < 3; ++k) {
      white.positions.push_back(original.positions[original.triangles[t][k]]);
      white.normals.push_back(scene::geometric_normal(original, t));
    }
    white.triangles.emplace_back(first, first + 1, first + 2);
  }
  white.triangle_materials.assign(white.triangles.size(), 0);
  return white;
}

light::Environment white_sky() {
  light::Environment environment;
  environment.name = "white";
  environment.sky = light::ConstantSky{Rgb(1.0F)};
  return environment;
}

/// A scene in which light cannot get out (closed, seen from inside) never settles: points with no way out are left out and counted.
Finding all_bounces_finding(const NamedScene& scene, const Budget& budget) {
  const integrate::World world(white_furnace(scene.scene), white_sky());
  const std::vector<trace::SurfacePoint> points = trace::vertex_points(world.scene);
  integrate::GatherSettings settings;
  settings.samples = budget.gather_samples;
  settings.seed = budget.seed;
  settings.threads = budget.threads;
  std::vector<trace::SurfacePoint> chosen;
  const std::size_t step = std::max<std::size_t>(1, points.size() / kPoints);
  for (std::size_t v = 0; v < points.size(); v += step) chosen.push_back(points[v]);
  metrics::RunningMoments deviation;
  std::size_t enclosed = 0;
  for (const integrate::RgbEstimate& e : integrate::gather_irradiance(world, chosen, settings)) {
    if (e.mean.y == 0.0) ++enclosed;
    if (e.mean.y != 0.0) deviation.add(e.mean.y / kPi - 1.0);
  }
  const Label label{
      "furnace", scene.name + " / all bounces, albedo 1",
      "White furnace: radiance is 1 on any mesh under a white sky",
      fmt::format("Mean deviation of the path-traced exit radiance over {} vertices ({} have no way out).",
                  deviation.count(), enclosed)};
  if (deviation.count() < 2) {
    Finding finding = judge_largest_z(label, 0.0, 0, 0.0, budget.significance);
    return finding;
  }
  return judge_deviation(label, deviation.estimate(), 1e-5, 0.01, budget.significance);
}

Finding first_coefficient_finding(const NamedScene& scene, const Budget& budget) {
  transfer::BakeSettings settings;
  settings.bands = 1;
  settings.samples = budget.bake_samples;
  settings.seed = budget.seed;
  settings.threads = budget.threads;
  const transfer::Transfer baked = transfer::bake(scene.scene, settings);
  double largest = 0.0;
  double smallest = 1.0;
  for (const float t : baked.coefficients) {
    largest = std::max(largest, static_cast<double>(t) * std::sqrt(4.0 * kPi));
    smallest = std::min(smallest, static_cast<double>(t) * std::sqrt(4.0 * kPi));
  }
  return judge_error(
      {"furnace", scene.name + " / sky view of every vertex", "0 <= T_00 sqrt(4 pi) <= 1",
       fmt::format("Sky views lie in [{:.4f}, {:.4f}]; how far they leave [0, 1].", smallest, largest)},
      std::max(largest - 1.0, -smallest), 1e-6);
}

}  // namespace

void check_furnace(const Suite& suite, report::Report& report) {
  for (const NamedScene& scene : suite.scenes) {
    if (suite.announce) suite.announce("white furnace of " + scene.name);
    for (const auto& check : {all_bounces_finding, first_coefficient_finding}) {
      Finding finding = check(scene, suite.budget);
      finding.seed = suite.budget.seed;
      report.findings.push_back(finding);
    }
  }
}

}  // namespace plumbline::checks
