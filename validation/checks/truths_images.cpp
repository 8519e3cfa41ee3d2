#include "validation/checks/truths_images.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "reference/base/error.hpp"
#include "reference/integrate/render.hpp"
#include "reference/scene/builtin.hpp"
#include "validation/checks/truths.hpp"
#include "validation/checks/truths_scenes.hpp"

namespace plumbline::checks {
namespace {

constexpr std::size_t kRandomisations = 16;
constexpr double kEqual = 1e-4;  // relative: what float rounding may do to a pixel without noise

Finding start(const std::string& name, const std::string& source) {
  Finding finding;
  finding.family = "truths";
  finding.name = name;
  finding.source = source;
  finding.verdict = Verdict::fail;
  return finding;
}

void require_same_size(const Values& a, const Values& b) {
  if (a.size() != b.size() || a.empty())
    throw InputError(
        fmt::format("judge: images of one size are needed, got {} and {} values", a.size(), b.size()));
}

/// Welch's t as a normal deviate of the same p; infinite for NaN.
double deviate(const metrics::Estimate& a, const metrics::Estimate& b) {
  if (a.standard_error == 0.0 && b.standard_error == 0.0)
    return std::abs(a.mean - b.mean) <= kEqual * std::abs(a.mean) ? 0.0 : INFINITY;
  const metrics::TestResult test = metrics::welch(a, kRandomisations, b, kRandomisations);
  return std::copysign(metrics::two_sided_z(test.p), test.statistic);
}

}  // namespace

Finding judge_values(const std::string& name, const Values& a, const Values& b, double significance) {
  require_same_size(a, b);
  Finding finding = start(name, "Welch's t of every value, Sidak's limit over all");
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double z = std::abs(deviate(a[i], b[i]));
    if (!(z <= finding.measured)) finding.measured = z;
  }
  finding.bound = metrics::two_sided_z(metrics::sidak(significance, a.size()));
  finding.unit = "standard errors";
  finding.detail = fmt::format("The largest of {} deviations.", a.size());
  finding.verdict = finding.measured <= finding.bound ? Verdict::pass : Verdict::fail;
  return finding;
}

Finding judge_mean(const std::string& name, const Values& a, const Values& b, double margin,
                   double significance) {
  require_same_size(a, b);
  Finding finding = start(name, "equal within the margin by two one-sided tests");
  double sum_a = 0.0;
  double sum_b = 0.0;
  double variance = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum_a += a[i].mean;
    sum_b += b[i].mean;
    variance += a[i].standard_error * a[i].standard_error + b[i].standard_error * b[i].standard_error;
  }
  const double difference = sum_b / sum_a - 1.0;
  const double error = std::sqrt(variance) / sum_a;
  const double reach = metrics::two_sided_z(2.0 * significance) * error;
  finding.measured = 100.0 * difference;
  finding.uncertainty = 100.0 * metrics::two_sided_z(0.05) * error;
  finding.bound = 100.0 * margin;
  finding.unit = "%";
  if (std::abs(difference) + reach <= margin) {
    finding.verdict = Verdict::pass;
  } else if (std::isfinite(difference) && error > 0.0 && !(std::abs(difference) - reach > margin)) {
    finding.verdict = Verdict::inconclusive;
  }
  return finding;
}

Values scaled_image(float scale, int samples_per_pixel, const Budget& budget, std::uint64_t seed) {
  constexpr int kSide = 64;
  constexpr int kTile = 8;
  constexpr int kTiles = kSide / kTile;
  scene::Scene scene = scene::make_builtin_scene("cornell");
  for (Vec3& p : scene.positions) p *= scale;
  scene::Camera camera = scene.cameras.front();
  camera.eye *= scale;
  const integrate::World world(std::move(scene), constant_sky(0.0));
  integrate::RenderSettings settings;
  settings.width = settings.height = kSide;
  settings.samples_per_pixel = samples_per_pixel;
  settings.threads = budget.threads;
  std::vector<metrics::RunningMoments> tiles(kTiles * kTiles);
  for (std::size_t r = 0; r < kRandomisations; ++r) {
    settings.seed = truth_seed(seed, "scaled image", r);
    const integrate::RenderResult result = integrate::render(world, camera, settings);
    const std::vector<float>& green = result.image.channels.at("G");
    std::vector<double> sums(tiles.size(), 0.0);
    for (std::size_t i = 0; i < green.size(); ++i)
      sums[i / kSide / kTile * kTiles + i % kSide / kTile] += static_cast<double>(green[i]) / (kTile * kTile);
    for (std::size_t i = 0; i < tiles.size(); ++i) tiles[i].add(sums[i]);
  }
  Values values;
  for (const metrics::RunningMoments& tile : tiles) values.push_back(tile.estimate());
  return values;
}

namespace {

light::Environment tiny_sun() {
  constexpr int kWidth = 512;
  constexpr int kHeight = 256;
  std::vector<double> texels(static_cast<std::size_t>(kWidth) * kHeight, 1.0);
  texels[static_cast<std::size_t>(60) * kWidth + 200] = 1e5;
  return lat_long_sky(texels, kWidth, kHeight, light::Lookup::bilinear);
}

Values pixels_of(const integrate::RenderResult& result) {
  const std::vector<float>& mean = result.image.channels.at("G");
  const std::vector<float>& error = result.image.channels.at("stderr.G");
  Values values;
  for (std::size_t i = 0; i < mean.size(); ++i)
    values.push_back({static_cast<double>(mean[i]), static_cast<double>(error[i])});
  return values;
}

double kurtosis(const Values& a, const Values& b) {
  metrics::RunningMoments moments;
  std::vector<double> z;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].standard_error == 0.0 && b[i].standard_error == 0.0) continue;
    z.push_back(deviate(a[i], b[i]));
    moments.add(z.back());
  }
  double fourth = 0.0;
  for (const double value : z)
    fourth += std::pow(value - moments.mean(), 4.0) / static_cast<double>(z.size());
  return fourth / (moments.variance() * moments.variance());
}

}  // namespace

SunImages sun_images(const Budget& budget, int reference_samples) {
  scene::Scene scene = scene::make_builtin_scene("open-box");
  const scene::Camera camera = scene.cameras.front();
  const integrate::World world(std::move(scene), tiny_sun());
  integrate::RenderSettings settings;
  settings.width = settings.height = 32;
  settings.threads = budget.threads;
  settings.seed = truth_seed(budget.seed, "sun", 1);
  settings.target_error = 0.01;
  const integrate::RenderResult quick = integrate::render(world, camera, settings);
  settings.seed = truth_seed(budget.seed, "sun", 2);
  settings.target_error.reset();
  settings.samples_per_pixel = reference_samples;
  SunImages images{pixels_of(quick), pixels_of(integrate::render(world, camera, settings))};
  images.relative_error = quick.relative_error;
  images.samples_per_pixel = quick.samples_per_pixel;
  images.kurtosis = kurtosis(images.quick, images.reference);
  return images;
}

std::vector<Finding> check_truth_images(const Budget& budget) {
  const bool is_nightly = budget.tier == Tier::nightly;
  std::vector<Finding> findings;
  const auto timed = [&](Finding finding, double seconds) {
    finding.seconds = seconds;
    findings.push_back(std::move(finding));
  };
  auto begin = std::chrono::steady_clock::now();
  const auto lap = [&] {
    const auto now = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(now - std::exchange(begin, now)).count();
  };
  const int samples = is_nightly ? 256 : 16;
  const double margin = tier_margin(budget.tier);
  const Values one = scaled_image(1.0F, samples, budget, truth_seed(budget.seed, "scale", 1));
  for (const float scale : {1e-3F, 1e3F}) {
    const Values other =
        scaled_image(scale, samples, budget, truth_seed(budget.seed, "scale", scale < 1.0F ? 2 : 3));
    const std::string name = fmt::format("scale {:g} / ", scale);
    timed(judge_mean(name + "mean radiance", one, other, margin, budget.significance), lap());
    timed(judge_values(name + "tiles", one, other, budget.significance), 0.0);
  }
  const SunImages sun = sun_images(budget, is_nightly ? 65536 : 4096);
  Finding pixels = judge_values("sun of 1e5 / pixels", sun.quick, sun.reference, budget.significance);
  pixels.detail += fmt::format(" {} paths a pixel for an error of {:.2g}; kurtosis of the deviations {:.2f}.",
                               sun.samples_per_pixel, sun.relative_error, sun.kurtosis);
  timed(std::move(pixels), lap());
  Finding target = start("sun of 1e5 / target error", "asked for");
  target.measured = sun.relative_error;
  target.bound = 0.01;
  target.verdict = target.measured <= target.bound ? Verdict::pass : Verdict::fail;
  timed(std::move(target), 0.0);
  return findings;
}

}  // namespace plumbline::checks
