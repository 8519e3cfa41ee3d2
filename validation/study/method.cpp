#include "validation/study/method.hpp"

#include <fmt/format.h>

#include <utility>

#include "reference/base/error.hpp"
#include "reference/base/parallel.hpp"
#include "reference/image/exr.hpp"
#include "reference/integrate/render.hpp"
#include "validation/study/cycles.hpp"

namespace plumbline::study {
namespace {

constexpr int kSkyWidth = 1024;
constexpr int kSkyHeight = 512;
constexpr int kSubsamples = 4;  // along each side of a texel: a sun of half a degree covers one or two

integrate::RenderResult trace(const Task& task, int spp, std::uint64_t seed, bool has_halves) {
  integrate::RenderSettings settings;
  settings.width = task.width;
  settings.height = task.height;
  settings.samples_per_pixel = spp;
  settings.max_bounces = task.max_bounces;
  settings.seed = seed;
  settings.threads = task.threads;
  settings.layers.halves = has_halves;
  return integrate::render(*task.world, task.camera, settings);
}

Method make_path(const Task& task) {
  return {"path",
          [task](int spp, std::uint64_t seed) {
            const integrate::RenderResult result = trace(task, spp, seed, false);
            return Rendered{*image::rgb_layer(result.image, ""), result.seconds};
          },
          [task](int spp, std::uint64_t seed) {
            const integrate::RenderResult result = trace(task, spp, seed, true);
            return Halved{*image::rgb_layer(result.image, "a"), *image::rgb_layer(result.image, "b")};
          }};
}

Rgb mean_of_texel(const light::Environment& environment, int x, int y) {
  RgbD sum(0.0);
  for (int k = 0; k < kSubsamples * kSubsamples; ++k) {
    const float u =
        (static_cast<float>(x) + (static_cast<float>(k % kSubsamples) + 0.5F) / kSubsamples) / kSkyWidth;
    const float v =
        (static_cast<float>(y) + (static_cast<float>(k / kSubsamples) + 0.5F) / kSubsamples) / kSkyHeight;
    sum += RgbD(light::radiance(environment, light::direction_from_lat_long({u, v})));
  }
  return glm::max(Rgb(sum / static_cast<double>(kSubsamples * kSubsamples)), Rgb(0.0F));
}

}  // namespace

const std::vector<MethodEntry>& methods() {
  static const std::vector<MethodEntry> entries = {
      {"path", "this project's path tracer", [](const Task&) { return std::string(); }, make_path},
      {"cycles", "Blender's Cycles, in its best setting for diffuse scenes", reason_against_cycles,
       make_cycles}};
  return entries;
}

const MethodEntry& find_method(const std::string& name) {
  std::string known;
  for (const MethodEntry& entry : methods()) {
    if (entry.name == name) return entry;
    known += (known.empty() ? "" : ", ") + entry.name;
  }
  throw InputError(fmt::format("method {}: not one of {}", name, known));
}

SharedLight shared_light(const light::Environment& environment) {
  const bool is_constant = std::holds_alternative<light::ConstantSky>(environment.sky);
  const bool is_lat_long =
      std::holds_alternative<light::LatLongSky>(environment.sky) && environment.rotation == glm::mat3(1.0F);
  if (environment.suns.empty() && (is_constant || is_lat_long)) return {environment, false};
  image::Image texels = image::make_image(kSkyWidth, kSkyHeight);
  parallel_for(kSkyHeight, 0, [&](std::size_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < kSkyWidth; ++x) texels.at(x, y) = mean_of_texel(environment, x, y);
  });
  light::Environment result;
  result.name = environment.name;
  result.texels = texels.pixels.size();
  result.sky = light::LatLongSky{std::move(texels)};
  return {result, true};
}

}  // namespace plumbline::study
