// validation/bench/compress_bench.cpp: compressing transfer, and relighting from the compressed form.
//
//   compress_iterative_cpca/100000      100,000 vectors x 75, 256 clusters x 8 components; counters: iterations, error
//   compress_assign, compress_fit       one iteration's two halves
//   relight_cpca_12x8                   12 components of 8 bits, 256 clusters; counters: relative error, bytes a vertex
//   relight_uncompressed                25 coefficients x RGB
// Vectors: what a shadowed bake is like to a compressor: smooth in the normal and in a visibility that changes slowly, two or three
// dimensions bent through 75, with a little noise.
#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <vector>

#include "prt/compress/clustering.hpp"
#include "prt/compress/quantise.hpp"
#include "prt/relight/cluster_blocks.hpp"
#include "prt/relight/cpu.hpp"
#include "prt/sh/basis.hpp"
#include "prt/transfer/bake.hpp"

namespace {

using namespace plumbline;

constexpr int kBands = 5;

/// Unshadowed transfer of the normals of a sphere times what a slowly varying visibility leaves of each channel, noise of 0.5 %.
transfer::Transfer made_up_transfer(std::size_t vertices) {
  std::mt19937_64 bits(1);
  std::normal_distribution<double> normal;
  transfer::Transfer transfer;
  transfer.bands = kBands;
  transfer.kind = transfer::Kind::interreflected;
  transfer.channels = 3;
  transfer.vertices = vertices;
  for (std::size_t v = 0; v < vertices; ++v) {
    const Vec3 direction = glm::normalize(Vec3(Vec3d(normal(bits), normal(bits), normal(bits))));
    const Vec3 bent =
        glm::normalize(direction + 0.3F * Vec3(Vec3d(normal(bits), normal(bits), normal(bits))));
    const std::vector<double> open = transfer::unshadowed_transfer(kBands, direction);
    const std::vector<double> shadowed = transfer::unshadowed_transfer(kBands, bent);
    const double seen = 0.6 + 0.4 * std::sin(4.0 * static_cast<double>(direction.x * bent.y));
    for (int c = 0; c < 3; ++c) {
      for (std::size_t i = 0; i < open.size(); ++i) {
        const double value =
            seen * shadowed[i] + 0.1 * (c + 1) * (1.0 - seen) * open[i] + 0.002 * normal(bits);
        transfer.coefficients.push_back(static_cast<float>(value));
      }
    }
  }
  return transfer;
}

const transfer::Transfer& hundred_thousand() {
  static const transfer::Transfer transfer = made_up_transfer(100000);
  return transfer;
}

compress::ClusterSettings settings_of(int components) {
  compress::ClusterSettings settings;
  settings.clusters = 256;
  settings.components = components;
  return settings;
}

void iterative_cpca(benchmark::State& state) {
  const compress::Vectors vectors = compress::vectors_of(hundred_thousand());
  compress::Clustering found;
  for (auto _ : state) found = compress::cluster_iteratively(vectors, settings_of(8));
  state.counters["iterations"] = static_cast<double>(found.history.size());
  state.counters["static_error"] = std::sqrt(found.history.front() / compress::sum_of_squares(vectors));
  state.counters["error"] = std::sqrt(found.squared_error / compress::sum_of_squares(vectors));
}
BENCHMARK(iterative_cpca)
    ->Name("compress_iterative_cpca/100000")
    ->Unit(benchmark::kSecond)
    ->Iterations(1)
    ->UseRealTime();

void static_cpca(benchmark::State& state) {
  const compress::Vectors vectors = compress::vectors_of(hundred_thousand());
  for (auto _ : state) benchmark::DoNotOptimize(compress::cluster_static(vectors, settings_of(8)));
}
BENCHMARK(static_cpca)
    ->Name("compress_static_cpca/100000")
    ->Unit(benchmark::kSecond)
    ->Iterations(1)
    ->UseRealTime();

sh::ShRgb light() {
  sh::ShRgb light{kBands, {}};
  for (int i = 0; i < kBands * kBands; ++i) light.coefficients.emplace_back(std::cos(i), std::sin(i), 1.0);
  return light;
}

/// Frames of a scene under changing light. Argument: threads, 0 = all.
void relight_cpca(benchmark::State& state) {
  const transfer::Transfer& transfer = hundred_thousand();
  compress::CompressSettings settings;
  settings.is_iterative = false;  // as fast as iterative clusters to relight from, and sooner there
  settings.clusters = settings_of(12);
  static const compress::Compressed compressed = compress::compress(transfer, settings);
  static const relight::ClusterBlocks blocks = relight::make_cluster_blocks(compressed, transfer);
  std::vector<Rgb> out(transfer.vertices);
  const sh::ShRgb lighting = light();
  for (auto _ : state) {
    relight::unit_albedo_exit_radiance(blocks, lighting, out, static_cast<int>(state.range(0)));
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(transfer.vertices));
  state.counters["error"] = compressed.relative_error;
  state.counters["bytes_per_vertex"] = compress::bytes_per_vertex(compressed);
}
BENCHMARK(relight_cpca)->Name("relight_cpca_12x8")->Arg(1)->Arg(0)->UseRealTime();

void relight_uncompressed(benchmark::State& state) {
  const transfer::Transfer& transfer = hundred_thousand();
  const sh::ShRgb lighting = light();
  for (auto _ : state) {
    benchmark::DoNotOptimize(relight::unit_albedo_exit_radiance(transfer, lighting));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(transfer.vertices));
  state.counters["bytes_per_vertex"] = 3.0 * kBands * kBands * sizeof(float);
}
BENCHMARK(relight_uncompressed)->Name("relight_uncompressed_25xrgb")->UseRealTime();

}  // namespace
