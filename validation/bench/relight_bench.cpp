// validation/bench/relight_bench.cpp: light times transfer for 100,000 vertices, beside reading the same bytes
// (machine_read/BYTES of this process, which are rounded up to 256). Arguments: bands, instruction set. Items are
// vertices; bytes are those of the transfer.
#include <benchmark/benchmark.h>

#include <random>
#include <vector>

#include "prt/relight/cpu.hpp"
#include "prt/sh/basis.hpp"
#include "validation/bench/instruction_set.hpp"

namespace plumbline::bench {
namespace {

constexpr std::size_t kVertices = 100000;

transfer::Transfer make_transfer(int bands, int channels) {
  std::mt19937 bits(1);
  std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
  transfer::Transfer result;
  result.bands = bands;
  result.channels = channels;
  result.vertices = kVertices;
  result.coefficients.resize(kVertices * static_cast<std::size_t>(channels * sh::coefficient_count(bands)));
  for (float& t : result.coefficients) t = uniform(bits);
  return result;
}

sh::ShRgb make_lighting(int bands) {
  sh::ShRgb result{bands, {}};
  for (int i = 0; i < sh::coefficient_count(bands); ++i)
    result.coefficients.emplace_back(1.0 / (1 + i), 0.5, -0.25);
  return result;
}

void relight_all(benchmark::State& state, int channels, int threads) {
  const InstructionSet set(state.range(1));
  if (!set.is_available(state)) return;
  const auto bands = static_cast<int>(state.range(0));
  const relight::TransferBlocks transfer = relight::make_blocks(make_transfer(bands, channels));
  const sh::ShRgb lighting = make_lighting(bands);
  std::vector<Rgb> out(kVertices);
  for (auto _ : state) {
    relight::unit_albedo_exit_radiance(transfer, lighting, out, threads);
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
  const auto rounds = static_cast<std::int64_t>(state.iterations());
  state.SetItemsProcessed(rounds * static_cast<std::int64_t>(kVertices));
  state.SetBytesProcessed(rounds * static_cast<std::int64_t>(transfer.coefficients.size() * sizeof(float)));
}

/// The plain loop, in double: what the tests hold the kernel against.
void relight_plain_rgb(benchmark::State& state) {
  const auto bands = static_cast<int>(state.range(0));
  const transfer::Transfer transfer = make_transfer(bands, 3);
  const sh::ShRgb lighting = make_lighting(bands);
  std::vector<Rgb> out(kVertices);
  for (auto _ : state) {
    for (std::size_t v = 0; v < kVertices; ++v) {
      for (int c = 0; c < 3; ++c) {
        const auto row = transfer.vector(v, c);
        double sum = 0.0;
        for (std::size_t i = 0; i < row.size(); ++i)
          sum += static_cast<double>(row[i]) * lighting.coefficients[i][c];
        out[v][c] = static_cast<float>(sum);
      }
    }
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) *
                          static_cast<std::int64_t>(kVertices));
}

/// A light that is used once: the transfer as it is baked.
void relight_once_rgb(benchmark::State& state) {
  const transfer::Transfer transfer = make_transfer(static_cast<int>(state.range(0)), 3);
  const sh::ShRgb lighting = make_lighting(transfer.bands);
  for (auto _ : state)
    benchmark::DoNotOptimize(relight::unit_albedo_exit_radiance(transfer, lighting, 1).data());
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) *
                          static_cast<std::int64_t>(kVertices));
}

void relight_rgb(benchmark::State& state) {
  relight_all(state, 3, 1);
}
void relight_gray(benchmark::State& state) {
  relight_all(state, 1, 1);
}
void relight_rgb_all_threads(benchmark::State& state) {
  relight_all(state, 3, 0);
}
void relight_gray_all_threads(benchmark::State& state) {
  relight_all(state, 1, 0);
}

BENCHMARK(relight_rgb)->ArgsProduct({{3, 5, 6}, {kBest}});
BENCHMARK(relight_rgb)->ArgsProduct({{5}, {kAvx512, kAvx2, kSsse3, kScalar}});
BENCHMARK(relight_gray)->ArgsProduct({{3, 5, 6}, {kBest}});
BENCHMARK(relight_gray)->ArgsProduct({{5}, {kAvx512, kAvx2, kSsse3, kScalar}});
BENCHMARK(relight_rgb_all_threads)->ArgsProduct({{5}, {kBest}})->UseRealTime();
BENCHMARK(relight_gray_all_threads)->ArgsProduct({{5}, {kBest}})->UseRealTime();
BENCHMARK(relight_once_rgb)->Arg(5);
BENCHMARK(relight_plain_rgb)->Arg(5);

}  // namespace
}  // namespace plumbline::bench
