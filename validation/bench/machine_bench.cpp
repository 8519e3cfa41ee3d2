// validation/bench/machine_bench.cpp: the machine's own limits, beside which every other figure of this process is read.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <vector>

namespace {

/// Plain fill of an array: what writing results cannot beat. Argument: bytes.
void machine_fill(benchmark::State& state) {
  std::vector<float> out(static_cast<std::size_t>(state.range(0)) / sizeof(float));
  float value = 0.0F;
  for (auto _ : state) {
    for (float& x : out) x = value;
    value += 1.0F;
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
  state.SetBytesProcessed(static_cast<std::int64_t>(state.iterations()) * state.range(0));
}
BENCHMARK(machine_fill)->Arg(32 << 10)->Arg(512 << 10)->Arg(10 << 20)->Arg(160 << 20);

}  // namespace
