// validation/bench/sh_exponential_bench.cpp: exponentials and logarithms of SH vectors. Items are vectors.
// Names: WHAT/BANDS or WHAT/BANDS/SET with the sets of instruction_set.hpp.
#include <benchmark/benchmark.h>

#include <random>
#include <vector>

#include "prt/sh/basis.hpp"
#include "prt/sh/exponential.hpp"
#include "prt/sh/logarithm.hpp"
#include "prt/sh/zonal.hpp"
#include "validation/bench/instruction_set.hpp"

namespace plumbline::bench {
namespace {

constexpr std::size_t kVectors = 64;

/// Sums of the log visibilities of 20 spheres of angular radius 3 to 23 degrees.
std::vector<std::vector<double>> blocker_sums(int bands) {
  std::mt19937 bits(1);
  const auto uniform = [&bits] { return (static_cast<double>(bits()) + 0.5) / 4294967296.0; };
  std::vector<std::vector<double>> sums;
  for (std::size_t v = 0; v < kVectors; ++v) {
    std::vector<double> sum(static_cast<std::size_t>(sh::coefficient_count(bands)), 0.0);
    for (int sphere = 0; sphere < 20; ++sphere) {
      const Vec3d axis = glm::normalize(Vec3d(uniform() - 0.5, uniform() - 0.5, uniform() - 0.5));
      const double radius = (3.0 + 20.0 * uniform()) * kPi / 180.0;
      const std::vector<double> log =
          sh::rotate_zonal(sh::zonal_logarithm(sh::sphere_visibility(bands, radius)).coefficients, axis);
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += log[i];
    }
    sums.push_back(sum);
  }
  return sums;
}

using Blocks = std::size_t (*)(int, std::span<const float>, std::span<float>);

template <Blocks kMethod>
void time_blocks(benchmark::State& state) {
  const InstructionSet set(state.range(1));
  if (!set.is_available(state)) return;
  const auto bands = static_cast<int>(state.range(0));
  const auto count = static_cast<std::size_t>(sh::coefficient_count(bands));
  const std::vector<std::vector<double>> sums = blocker_sums(bands);
  std::vector<float> in(kVectors * count);
  std::vector<float> out(in.size());
  for (std::size_t v = 0; v < kVectors; ++v) {
    for (std::size_t i = 0; i < count; ++i) {
      in[(v / sh::kProductLanes * count + i) * sh::kProductLanes + v % sh::kProductLanes] =
          static_cast<float>(sums[v][i]);
    }
  }
  for (auto _ : state) {
    benchmark::DoNotOptimize(kMethod(bands, in, out));
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) *
                          static_cast<std::int64_t>(kVectors));
}
BENCHMARK(time_blocks<sh::exponential_hybrid_blocks>)
    ->Name("sh_exponential_hybrid_blocks_f32")
    ->ArgsProduct({{3, 4, 5, 6}, {kBest}})
    ->ArgsProduct({{4}, {kAvx512, kAvx2, kSsse3}});
BENCHMARK(time_blocks<sh::exponential_blocks>)
    ->Name("sh_exponential_blocks_f32")
    ->ArgsProduct({{3, 4, 5, 6}, {kBest}})
    ->ArgsProduct({{4}, {kAvx512, kAvx2, kSsse3}});

using Single = std::vector<double> (*)(const std::vector<double>&);

std::vector<double> isolated_to_nine(const std::vector<double>& f) {
  return sh::exponential_isolated(f, 9);
}
std::vector<double> by_quadrature(const std::vector<double>& f) {
  return sh::exponential_by_quadrature(f).coefficients;
}
std::vector<double> logarithm_of(const std::vector<double>& g) {
  return sh::logarithm(g).coefficients;
}

template <Single kMethod>
void time_single(benchmark::State& state) {
  const std::vector<std::vector<double>> sums = blocker_sums(static_cast<int>(state.range(0)));
  std::size_t next = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(kMethod(sums[next]));
    next = (next + 1) % sums.size();
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()));
}
BENCHMARK(time_single<sh::exponential_linear>)->Name("sh_exponential_linear_f64")->DenseRange(3, 6);
BENCHMARK(time_single<sh::exponential_hybrid>)->Name("sh_exponential_hybrid_f64")->DenseRange(3, 6);
BENCHMARK(time_single<sh::exponential>)->Name("sh_exponential_f64")->DenseRange(3, 6);
BENCHMARK(time_single<isolated_to_nine>)->Name("sh_exponential_series9_f64")->DenseRange(3, 6);
BENCHMARK(time_single<sh::exponential_of_matrix>)->Name("sh_exponential_matrix_f64")->DenseRange(3, 6);
BENCHMARK(time_single<by_quadrature>)->Name("sh_exponential_quadrature_f64")->Arg(4);
BENCHMARK(time_single<logarithm_of>)->Name("sh_logarithm_f64")->DenseRange(3, 6);

void sh_zonal_logarithm_f64(benchmark::State& state) {
  const std::vector<double> zonal = sh::sphere_visibility(static_cast<int>(state.range(0)), 0.5);
  for (auto _ : state) benchmark::DoNotOptimize(sh::zonal_logarithm(zonal));
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()));
}
BENCHMARK(sh_zonal_logarithm_f64)->DenseRange(3, 6);

}  // namespace
}  // namespace plumbline::bench
