// validation/bench/gl_bench.cpp: relighting in OpenGL beside the CPU, and what depth maps cost a bake.
//
// gl_vertices/WHO/CHANNELS: light times transfer at 100,000 vertices, 25 coefficients; counter GB/s of transfer.
// gl_frame/WHO/SIZE: a frame of builtin:plaza under a new light, one sample a pixel, SIZE x SIZE; OpenGL without and (read) with
// reading the image back. gl_view/WHO: what a new camera costs beside. WHO: 0 the CPU, 1 OSMesa, 2 EGL.
// gl_depth_bake/RESOLUTION/TENTHS OF A TEXEL: builtin:sphere-on-plane along 256 directions, against rays along the same:
// counters rmse (relative, all coefficients), mean_signed and largest (share of a white sky).
#include <benchmark/benchmark.h>

#include <map>
#include <memory>
#include <string>

#include "prt/relight/gl/depth_bake.hpp"
#include "prt/relight/gl/renderer.hpp"
#include "prt/transfer/bake.hpp"
#include "prt/transfer/baked_file.hpp"
#include "reference/base/error.hpp"
#include "reference/light/environment.hpp"
#include "reference/scene/builtin.hpp"
#include "validation/checks/depth_bias.hpp"

namespace {

using namespace plumbline;
using relight::gl::Context;
using relight::gl::Provider;
using relight::gl::Renderer;

enum Who : std::int64_t { kCpu, kOsmesa, kEgl };

/// The context of the run, or none, with the reason as the benchmark's error.
std::unique_ptr<Context> context_of(benchmark::State& state) {
  try {
    return std::make_unique<Context>(
        relight::gl::settings_from_environment(state.range(0) == kOsmesa ? Provider::osmesa : Provider::egl));
  } catch (const DeviceError& error) {
    state.SkipWithError(error.what());
    return nullptr;
  }
}

struct Subject {
  transfer::Baked baked;
  sh::ShRgb lighting;
};

// A strip of triangles with made-up numbers: only how many there are matters.
Subject many_vertices(int channels) {
  constexpr std::size_t kVertices = 100000;
  Subject subject;
  scene::Scene& scene = subject.baked.scene;
  for (std::size_t v = 0; v < kVertices; ++v) {
    const auto x = static_cast<float>(v);
    scene.positions.emplace_back(x, v % 2 == 0 ? 0.0F : 1.0F, 0.0F);
    scene.normals.emplace_back(0.0F, 0.0F, 1.0F);
    if (v >= 2) scene.triangles.emplace_back(v - 2, v - 1, v);
  }
  scene.triangle_materials.assign(scene.triangles.size(), 0);
  scene.materials.resize(1);
  transfer::Transfer& transfer = subject.baked.transfer;
  transfer.bands = 5;
  transfer.channels = channels;
  transfer.vertices = kVertices;
  transfer.coefficients.resize(kVertices * static_cast<std::size_t>(channels) * 25);
  for (std::size_t i = 0; i < transfer.coefficients.size(); ++i)
    transfer.coefficients[i] = static_cast<float>(i % 1021) / 1021.0F - 0.3F;
  subject.lighting = sh::project_radiance(light::make_builtin_environment("sun-sky"), 5);
  return subject;
}

const Subject& plaza() {
  static const Subject subject = [] {
    Subject made;
    made.baked.scene = scene::make_builtin_scene("plaza");
    transfer::BakeSettings settings;
    settings.kind = transfer::Kind::unshadowed;
    made.baked.transfer = transfer::bake(made.baked.scene, settings);
    made.lighting = sh::project_radiance(light::make_builtin_environment("sun-sky"), settings.bands);
    return made;
  }();
  return subject;
}

void gl_vertices(benchmark::State& state) {
  const Subject subject = many_vertices(static_cast<int>(state.range(1)));
  const double bytes = static_cast<double>(subject.baked.transfer.coefficients.size()) * sizeof(float);
  if (state.range(0) == kCpu) {
    for (auto _ : state)
      benchmark::DoNotOptimize(relight::unit_albedo_exit_radiance(subject.baked.transfer, subject.lighting));
  } else if (const auto context = context_of(state)) {
    Renderer renderer(*context, subject.baked.scene, subject.baked.transfer, {});
    for (auto _ : state) {
      renderer.set_light(subject.lighting);
      context->gl().Finish();
    }
    state.SetLabel(context->description());
  }
  state.counters["GB/s"] = benchmark::Counter(bytes * 1e-9, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(gl_vertices)
    ->ArgsProduct({{kCpu, kOsmesa, kEgl}, {1, 3}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

void draw_frames(benchmark::State& state, bool reads) {
  const Subject& subject = plaza();
  const auto size = static_cast<int>(state.range(1));
  const scene::Camera& camera = subject.baked.scene.cameras.front();
  if (state.range(0) == kCpu) {
    for (auto _ : state) {
      const std::vector<Rgb> radiance =
          relight::unit_albedo_exit_radiance(subject.baked.transfer, subject.lighting);
      benchmark::DoNotOptimize(
          relight::render_view(subject.baked.scene, radiance, camera, {size, size, 1, 0}, nullptr));
    }
  } else if (const auto context = context_of(state)) {
    Renderer renderer(*context, subject.baked.scene, subject.baked.transfer, {});
    renderer.set_view(camera, {size, size, 1, 0});
    double sum = 0.0;
    for (auto _ : state) {
      renderer.set_light(subject.lighting);
      if (reads) {
        renderer.draw([&](const relight::gl::Tile& tile) { sum += static_cast<double>(tile.radiance[0].x); });
      } else {
        renderer.draw(nullptr);
      }
      context->gl().Finish();
    }
    benchmark::DoNotOptimize(sum);
    state.SetLabel(context->description());
  }
}

void gl_frame(benchmark::State& state) {
  draw_frames(state, false);
}
BENCHMARK(gl_frame)
    ->ArgsProduct({{kCpu, kOsmesa, kEgl}, {256, 1024}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
void gl_frame_read(benchmark::State& state) {
  draw_frames(state, true);
}
BENCHMARK(gl_frame_read)
    ->ArgsProduct({{kOsmesa, kEgl}, {256, 1024}})
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

void gl_view(benchmark::State& state) {
  const Subject& subject = plaza();
  if (const auto context = context_of(state)) {
    Renderer renderer(*context, subject.baked.scene, subject.baked.transfer, {});
    for (auto _ : state) renderer.set_view(subject.baked.scene.cameras.front(), {256, 256, 1, 0});
  }
}
BENCHMARK(gl_view)->Arg(kOsmesa)->Arg(kEgl)->UseRealTime()->Unit(benchmark::kMillisecond);

void gl_context(benchmark::State& state) {
  for (auto _ : state) {
    if (context_of(state) == nullptr) break;
  }
}
BENCHMARK(gl_context)->Arg(kOsmesa)->Arg(kEgl)->UseRealTime()->Unit(benchmark::kMillisecond);

void gl_depth_bake(benchmark::State& state) {
  static const scene::Scene scene = scene::make_builtin_scene("sphere-on-plane");
  relight::gl::DepthBakeSettings settings;
  settings.directions = 256;
  settings.resolution = static_cast<int>(state.range(0));
  settings.offset = static_cast<double>(state.range(1)) / 10.0;
  static const transfer::Transfer rays = relight::gl::bake_along(scene, settings);
  try {
    const Context context(relight::gl::settings_from_environment(Provider::automatic));
    transfer::Transfer depth;
    for (auto _ : state) depth = relight::gl::bake_from_depth(context, scene, settings);
    const checks::DepthBias bias = checks::depth_bias(depth, rays);
    state.counters["rmse"] = bias.relative_rmse;
    state.counters["mean_signed"] = bias.mean_signed;
    state.counters["largest"] = bias.largest;
    state.SetLabel(context.description());
  } catch (const DeviceError& error) {
    state.SkipWithError(error.what());
  }
}
BENCHMARK(gl_depth_bake)
    ->ArgsProduct({{128, 512, 2048}, {0, 5, 10, 20, 40}})
    ->Iterations(1)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

void gl_depth_bake_rays(benchmark::State& state) {
  static const scene::Scene scene = scene::make_builtin_scene("sphere-on-plane");
  relight::gl::DepthBakeSettings settings;
  settings.directions = 256;
  for (auto _ : state) benchmark::DoNotOptimize(relight::gl::bake_along(scene, settings));
}
BENCHMARK(gl_depth_bake_rays)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
