#include "validation/regression/quantities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prt/relight/cpu.hpp"
#include "prt/sh/lighting.hpp"
#include "prt/transfer/bake.hpp"
#include "reference/image/exr.hpp"
#include "reference/integrate/render.hpp"
#include "reference/scene/load.hpp"
#include "validation/metrics/statistics.hpp"

namespace plumbline::regression {
namespace {

constexpr int kCopies = 16;
constexpr int kWidth = 96;
constexpr int kHeight = 72;
// Sums of up to a million floats of either instruction set, relative to the largest number of the kind.
constexpr double kRounding = 1e-5;

using Means = std::array<metrics::RunningMoments, 3>;

void add_image(Means& means, const image::Image& image) {
  RgbD sum(0.0);
  for (const Rgb& pixel : image.pixels) sum += RgbD(pixel);
  for (int c = 0; c < 3; ++c)
    means[static_cast<std::size_t>(c)].add(sum[c] / static_cast<double>(image.pixels.size()));
}

void append(const std::string& name, const Means& means, std::vector<Quantity>& quantities) {
  for (std::size_t c = 0; c < 3; ++c) {
    const bool is_exact = means[c].count() < 2;
    const metrics::Estimate e = is_exact ? metrics::Estimate{means[c].mean(), 0.0} : means[c].estimate();
    quantities.push_back({fmt::format("{} / mean {}", name, "rgb"[c]), e.mean, e.standard_error,
                          is_exact ? 0 : means[c].count(), kRounding * std::abs(e.mean)});
  }
}

void append(const std::string& name, const sh::ShRgb& lighting, std::vector<Quantity>& quantities) {
  double largest = 0.0;
  for (const RgbD& row : lighting.coefficients)
    largest = std::max({largest, std::abs(row.x), std::abs(row.y), std::abs(row.z)});
  for (std::size_t i = 0; i < lighting.coefficients.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      quantities.push_back({fmt::format("{} / coefficient {} {}", name, i, "rgb"[c]),
                            lighting.coefficients[i][c], 0.0, 0, kRounding * largest});
    }
  }
}

std::uint64_t copy_seed(const checks::Budget& budget, int copy) {
  return budget.seed * kCopies + static_cast<std::uint64_t>(copy) + 1;
}

Means path_traced(const checks::NamedScene& scene, const light::Environment& environment,
                  const checks::Budget& budget) {
  const integrate::World world(scene.scene, environment);
  integrate::RenderSettings settings;
  settings.width = kWidth;
  settings.height = kHeight;
  settings.samples_per_pixel = std::max(2, budget.image_samples / kCopies);
  settings.is_background_visible = false;  // light seen directly would drown the scene
  settings.threads = budget.threads;
  Means means;
  for (int copy = 0; copy < kCopies; ++copy) {
    settings.seed = copy_seed(budget, copy);
    const auto& camera = scene::find_camera(world.scene, scene.camera);
    add_image(means, *image::rgb_layer(integrate::render(world, camera, settings).image, ""));
  }
  return means;
}

image::Image relit(const checks::NamedScene& scene, const transfer::Transfer& transfer,
                   const sh::ShRgb& lighting, int threads) {
  const relight::ViewSettings view{kWidth, kHeight, 2, threads};
  const std::vector<Rgb> radiance = relight::unit_albedo_exit_radiance(transfer, lighting);
  const auto& camera = scene::find_camera(scene.scene, scene.camera);
  return *image::rgb_layer(relight::render_view(scene.scene, radiance, camera, view, {}), "");
}

// One scene, one band count: all lights share the bakes.
std::vector<Means> relit_images(const checks::NamedScene& scene, const std::vector<sh::ShRgb>& lights,
                                int bands, transfer::Kind kind, const checks::Budget& budget) {
  transfer::BakeSettings settings;
  settings.bands = bands;
  settings.kind = kind;
  settings.samples = std::max(16, budget.bake_samples / kCopies);
  settings.threads = budget.threads;
  std::vector<Means> means(lights.size());
  const int copies = kind == transfer::Kind::unshadowed ? 1 : kCopies;
  for (int copy = 0; copy < copies; ++copy) {
    settings.seed = copy_seed(budget, copy);
    const transfer::Transfer transfer = transfer::bake(scene.scene, settings);
    for (std::size_t i = 0; i < lights.size(); ++i)
      add_image(means[i], relit(scene, transfer, lights[i], budget.threads));
  }
  return means;
}

void measure_scene(const checks::NamedScene& scene, const std::vector<sh::ShRgb>& lights,
                   const checks::Suite& suite, std::vector<Quantity>& quantities) {
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const light::Environment& environment = suite.environments[i];
    append(fmt::format("{} under {} / path traced", scene.name, checks::short_name(environment.name)),
           path_traced(scene, environment, suite.budget), quantities);
  }
  for (const int bands : suite.bands) {
    for (const auto kind : {transfer::Kind::unshadowed, transfer::Kind::shadowed}) {
      const std::vector<Means> means = relit_images(scene, lights, bands, kind, suite.budget);
      for (std::size_t i = 0; i < means.size(); ++i) {
        append(fmt::format("{} under {} / {} transfer, {} bands", scene.name,
                           checks::short_name(suite.environments[i].name), transfer::to_string(kind), bands),
               means[i], quantities);
      }
    }
  }
}

}  // namespace

std::vector<Quantity> measure_quantities(const checks::Suite& suite) {
  const int bands = *std::max_element(suite.bands.begin(), suite.bands.end());
  std::vector<Quantity> quantities;
  std::vector<sh::ShRgb> lights;
  for (const light::Environment& environment : suite.environments) {
    lights.push_back(sh::project_radiance(environment, bands, suite.budget.threads));
    append(checks::short_name(environment.name), lights.back(), quantities);
  }
  for (const checks::NamedScene& scene : suite.scenes) measure_scene(scene, lights, suite, quantities);
  return quantities;
}

}  // namespace plumbline::regression
