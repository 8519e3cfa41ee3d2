// validation/bench/machine_bench.cpp: the machine's own limits, beside which every other figure of this process is read.
// Names: machine_WHAT/BYTES/SET or machine_WHAT/SET, with the sets of instruction_set.hpp (0 = the machine's best).
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "validation/bench/machine_bench.cpp"
#define HWY_DISABLED_TARGETS HWY_SSE4
#include <hwy/foreach_target.h>
// foreach_target.h comes first: it includes this file once for each instruction set
#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace plumbline::bench {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Plain (not streaming) stores of whole vectors.
void fill(float value, float* out, std::size_t count) {
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  const auto v = hn::Set(d, value);
  for (std::size_t i = 0; i < count; i += 4 * lanes) {
    hn::Store(v, d, out + i);
    hn::Store(v, d, out + i + lanes);
    hn::Store(v, d, out + i + 2 * lanes);
    hn::Store(v, d, out + i + 3 * lanes);
  }
}

float sum(const float* in, std::size_t count) {
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  auto a = hn::Zero(d);
  auto b = a;
  auto c = a;
  auto e = a;
  for (std::size_t i = 0; i < count; i += 4 * lanes) {
    a = hn::Add(a, hn::Load(d, in + i));
    b = hn::Add(b, hn::Load(d, in + i + lanes));
    c = hn::Add(c, hn::Load(d, in + i + 2 * lanes));
    e = hn::Add(e, hn::Load(d, in + i + 3 * lanes));
  }
  return hn::GetLane(hn::SumOfLanes(d, hn::Add(hn::Add(a, b), hn::Add(c, e))));
}

void triad(const float* a, const float* b, float* out, std::size_t count) {
  const hn::ScalableTag<float> d;
  const auto scale = hn::Set(d, 3.0F);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    hn::Store(hn::MulAdd(scale, hn::Load(d, b + i), hn::Load(d, a + i)), d, out + i);
  }
}

/// Twelve independent chains of `steps` multiply-adds; returns the floating-point operations done.
template <class T>
std::size_t fma(T* values, std::size_t steps) {
  const hn::ScalableTag<T> d;
  const auto x = hn::Set(d, values[0]);
  const auto y = hn::Set(d, values[1]);
  auto a0 = x, a1 = y, a2 = x, a3 = y, a4 = x, a5 = y, a6 = x, a7 = y, a8 = x, a9 = y, a10 = x, a11 = y;
  for (std::size_t i = 0; i < steps; ++i) {
    a0 = hn::MulAdd(a0, x, y);
    a1 = hn::MulAdd(a1, x, y);
    a2 = hn::MulAdd(a2, x, y);
    a3 = hn::MulAdd(a3, x, y);
    a4 = hn::MulAdd(a4, x, y);
    a5 = hn::MulAdd(a5, x, y);
    a6 = hn::MulAdd(a6, x, y);
    a7 = hn::MulAdd(a7, x, y);
    a8 = hn::MulAdd(a8, x, y);
    a9 = hn::MulAdd(a9, x, y);
    a10 = hn::MulAdd(a10, x, y);
    a11 = hn::MulAdd(a11, x, y);
  }
  const auto sum = hn::Add(
      hn::Add(hn::Add(a0, a1), hn::Add(a2, a3)),
      hn::Add(hn::Add(hn::Add(a4, a5), hn::Add(a6, a7)), hn::Add(hn::Add(a8, a9), hn::Add(a10, a11))));
  values[2] = hn::GetLane(hn::SumOfLanes(d, sum));
  return 2 * 12 * hn::Lanes(d) * steps;
}

std::size_t fma_f32(float* values, std::size_t steps) {
  return fma(values, steps);
}
std::size_t fma_f64(double* values, std::size_t steps) {
  return fma(values, steps);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace plumbline::bench
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <benchmark/benchmark.h>

#include <array>

#include "validation/bench/instruction_set.hpp"

namespace plumbline::bench {
namespace {

HWY_EXPORT(fill);
HWY_EXPORT(sum);
HWY_EXPORT(triad);
HWY_EXPORT(fma_f32);
HWY_EXPORT(fma_f64);

constexpr std::size_t kFmaSteps = 1000;

void machine_fill(benchmark::State& state) {
  const InstructionSet set(state.range(1));
  if (!set.is_available(state)) return;
  const auto count = static_cast<std::size_t>(state.range(0)) / sizeof(float);
  const std::span<float> out = arena<float>(count);
  float value = 0.0F;
  for (auto _ : state) {
    HWY_DYNAMIC_DISPATCH(fill)(value, out.data(), count);
    value += 1.0F;
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) * state.range(0));
}
BENCHMARK(machine_fill)->ArgsProduct({{32 << 10, 512 << 10, 10 << 20, 160 << 20}, {kBest}});
// What 256 directions fill at 3, 5, 6, 8, 10 and 20 bands of float, and of double at 5 and 20.
BENCHMARK(machine_fill)
    ->ArgsProduct({{9 << 10, 25 << 10, 36 << 10, 64 << 10, 100 << 10, 400 << 10, 50 << 10, 800 << 10},
                   {kBest, kAvx512, kAvx2, kSsse3, kScalar}});
// And 100,000 directions of float.
BENCHMARK(machine_fill)->ArgsProduct({{3600000, 10000384, 40000000, 160000000}, {kBest}});

void machine_read(benchmark::State& state) {
  const auto count = static_cast<std::size_t>(state.range(0)) / sizeof(float);
  const std::span<float> in = arena<float>(count);
  for (auto _ : state) {
    float total = HWY_DYNAMIC_DISPATCH(sum)(in.data(), count);
    benchmark::DoNotOptimize(total);
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) * state.range(0));
}
// 6,291,456 bytes: an image of 1024 x 512 RGB; 4,718,592: a cube map of 6 x 256 x 256;
// 10,000,384 and 30,000,128: 100,000 transfer vectors of 5 bands, gray and RGB.
BENCHMARK(machine_read)
    ->Arg(32 << 10)
    ->Arg(512 << 10)
    ->Arg(4718592)
    ->Arg(6291456)
    ->Arg(10000384)
    ->Arg(30000128)
    ->Arg(160 << 20);

/// STREAM's triad a + 3 b; 12 bytes an element are counted.
void machine_triad(benchmark::State& state) {
  const auto count = static_cast<std::size_t>(state.range(0)) / sizeof(float);
  const std::span<float> a = arena<float>(count, 0);
  const std::span<float> b = arena<float>(count, 1);
  const std::span<float> out = arena<float>(count, 2);
  for (auto _ : state) {
    HWY_DYNAMIC_DISPATCH(triad)(a.data(), b.data(), out.data(), count);
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) * 3 * state.range(0));
}
BENCHMARK(machine_triad)->Arg(64 << 20);

/// Items are floating-point operations: items per second is the rate that bounds in nanoseconds are scaled by.
void machine_fma_f32(benchmark::State& state) {
  const InstructionSet set(state.range(0));
  if (!set.is_available(state)) return;
  std::array<float, 3> values{0.999F, 0.001F, 0.0F};
  std::size_t operations = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(values.data());
    operations += HWY_DYNAMIC_DISPATCH(fma_f32)(values.data(), kFmaSteps);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(operations));
}
BENCHMARK(machine_fma_f32)->Arg(kBest)->Arg(kAvx512)->Arg(kAvx2)->Arg(kSsse3)->Arg(kScalar);

void machine_fma_f64(benchmark::State& state) {
  const InstructionSet set(state.range(0));
  if (!set.is_available(state)) return;
  std::array<double, 3> values{0.999, 0.001, 0.0};
  std::size_t operations = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(values.data());
    operations += HWY_DYNAMIC_DISPATCH(fma_f64)(values.data(), kFmaSteps);
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(operations));
}
BENCHMARK(machine_fma_f64)->Arg(kBest);

}  // namespace
}  // namespace plumbline::bench
#endif  // HWY_ONCE
