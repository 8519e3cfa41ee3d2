#include "prt/relight/cpu.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>

#include "prt/relight/dot_kernels.hpp"
#include "prt/relight/screen_triangle.hpp"
#include "prt/sh/basis.hpp"
#include "reference/base/error.hpp"
#include "reference/base/parallel.hpp"
#include "reference/trace/ray_caster.hpp"

namespace plumbline::relight {
namespace {

/// r, g, b of the first `count` coefficients, rounded.
std::vector<float> rounded_lights(const sh::ShRgb& lighting, std::size_t count) {
  std::vector<float> lights;
  lights.reserve(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    for (int c = 0; c < 3; ++c) lights.push_back(static_cast<float>(lighting.coefficients[i][c]));
  }
  return lights;
}

/// Everything one camera ray adds to its pixel.
struct Seen {
  Rgb radiance{0.0F};
  Rgb background{0.0F};
  Rgb albedo{0.0F};
};

Seen look(const trace::RayCaster& caster, const scene::Scene& scene,
          const std::vector<Rgb>& unit_albedo_radiance, const SampleGrid& samples, int column, int row,
          const std::function<Rgb(const Vec3&)>& background) {
  const trace::Ray ray{Vec3(samples.eye), sample_direction(samples, column, row)};
  const std::optional<trace::Hit> hit = caster.closest_hit(ray);
  if (!hit) {
    const Rgb sky = background ? background(ray.direction) : Rgb(0.0F);
    return {sky, sky, Rgb(0.0F)};
  }
  // The hit's own barycentric coordinates carry the rounding of the whole distance: a 1e-4 of a small triangle.
  const ScreenTriangle triangle = screen_triangle(scene, hit->triangle, samples);
  if (!triangle.is_front) return {};
  const glm::uvec3 corners = scene.triangles[hit->triangle];
  const Vec3 weights = weights_at(triangle, column, row);
  const Rgb unit = weights.x * unit_albedo_radiance[corners.x] + weights.y * unit_albedo_radiance[corners.y] +
                   weights.z * unit_albedo_radiance[corners.z];
  const Rgb albedo = scene::albedo_at(scene, hit->triangle, Vec2(weights.y, weights.z));
  return {albedo * unit, Rgb(0.0F), albedo};
}

}  // namespace

// Every term carries the rounding of its light and of at most n^2 additions and products (a product that is
// fused with its addition, one less): (1 + u)^(n^2 + 1) - 1 of its size in all, whatever the order of the sum
// (Higham 2002, Accuracy and Stability of Numerical Algorithms, section 3.1), u = 2^-24.
void unit_albedo_exit_radiance(const TransferBlocks& transfer, const sh::ShRgb& lighting, std::span<Rgb> out,
                               int threads) {
  if (lighting.bands < transfer.bands) {
    throw InputError(
        fmt::format("lighting: {} bands are fewer than the transfer's {}", lighting.bands, transfer.bands));
  }
  if (out.size() != transfer.vertices)
    throw InputError(fmt::format("relight: {} places for {} vertices", out.size(), transfer.vertices));
  static_assert(sizeof(Rgb) == 3 * sizeof(float));
  const auto count = static_cast<std::size_t>(sh::coefficient_count(transfer.bands));
  const std::size_t stride = count * static_cast<std::size_t>(transfer.channels) * kBlockVertices;
  const std::vector<float> lights = rounded_lights(lighting, count);
  const auto dot = transfer.channels == 3 ? &dot_rgb : &dot_gray;
  const std::size_t blocks = (transfer.vertices + kBlockVertices - 1) / kBlockVertices;
  // Enough for a thread to be worth its start, few enough to share out evenly.
  const std::size_t share = std::max<std::size_t>(4, (256 << 10) / (stride * sizeof(float)));
  parallel_for((blocks + share - 1) / share, threads, [&](std::size_t task) {
    const std::size_t first = task * share;
    const std::size_t number = std::min(share, blocks - first);
    const std::size_t vertices =
        std::min(number * kBlockVertices, transfer.vertices - first * kBlockVertices);
    dot({lights.data(), count, transfer.coefficients.data() + first * stride, number}, vertices,
        &out[first * kBlockVertices].x);
  });
}

std::vector<Rgb> unit_albedo_exit_radiance(const transfer::Transfer& transfer, const sh::ShRgb& lighting,
                                           int threads) {
  std::vector<Rgb> result(transfer.vertices);
  unit_albedo_exit_radiance(make_blocks(transfer, threads), lighting, result, threads);
  return result;
}

void require_valid(const ViewSettings& settings) {
  if (settings.width < 1 || settings.height < 1 || settings.grid < 1) {
    throw InputError(fmt::format("size: expected at least 1x1 with 1 ray a pixel, got {}x{} with {}",
                                 settings.width, settings.height, settings.grid * settings.grid));
  }
}

image::LayeredImage view_layers(const image::Image& mean, const image::Image& sky, const image::Image& albedo,
                                int grid) {
  image::LayeredImage result{mean.width, mean.height, {}, {}};
  image::set_rgb_layer(result, "", mean);
  image::set_rgb_layer(result, "emission", sky);
  image::set_rgb_layer(result, "albedo", albedo);
  result.channels["samples"].assign(mean.pixels.size(), static_cast<float>(grid * grid));
  return result;
}

image::LayeredImage render_view(const scene::Scene& scene, const std::vector<Rgb>& unit_albedo_radiance,
                                const scene::Camera& camera, const ViewSettings& settings,
                                const std::function<Rgb(const Vec3&)>& background) {
  require_valid(settings);
  const trace::RayCaster caster(scene);
  const SampleGrid samples = sample_grid(camera, settings.width, settings.height, settings.grid);
  image::Image mean = image::make_image(settings.width, settings.height);
  image::Image sky = mean;
  image::Image albedo = mean;
  parallel_for(static_cast<std::size_t>(settings.height), settings.threads, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < settings.width; ++x) {
      RgbD sums[3] = {};
      for (int k = 0; k < settings.grid * settings.grid; ++k) {
        const Seen seen =
            look(caster, scene, unit_albedo_radiance, samples, x * settings.grid + k % settings.grid,
                 y * settings.grid + k / settings.grid, background);
        sums[0] += RgbD(seen.radiance);
        sums[1] += RgbD(seen.background);
        sums[2] += RgbD(seen.albedo);
      }
      const double rays = settings.grid * settings.grid;
      mean.at(x, y) = Rgb(sums[0] / rays);
      sky.at(x, y) = Rgb(sums[1] / rays);
      albedo.at(x, y) = Rgb(sums[2] / rays);
    }
  });
  return view_layers(mean, sky, albedo, settings.grid);
}

}  // namespace plumbline::relight
