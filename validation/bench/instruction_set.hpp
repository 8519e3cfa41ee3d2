// validation/bench/instruction_set.hpp: runs a benchmark on a smaller instruction set than the machine's best.
#pragma once

#include <benchmark/benchmark.h>
#include <hwy/aligned_allocator.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cstdint>
#include <span>

namespace plumbline::bench {

/// Smallest number first is the best; kBest is what the machine offers. Vectors of 64, 32 and 16 bytes.
enum Set : std::int64_t { kBest = 0, kAvx512 = 1, kAvx2 = 2, kSsse3 = 3, kScalar = 4 };

/// While alive, every dynamic dispatch takes `set` (kScalar: Highway's fallback for machines with less: one number at a time).
class InstructionSet {
 public:
  explicit InstructionSet(std::int64_t set) {
    const std::int64_t mask = set == kAvx512   ? HWY_AVX3
                              : set == kAvx2   ? HWY_AVX2
                              : set == kSsse3  ? HWY_SSSE3
                              : set == kScalar ? HWY_SCALAR
                                               : 0;
    available_ = mask == 0 || set == kScalar || (hwy::SupportedTargets() & mask) != 0;
    if (available_ && mask != 0) hwy::GetChosenTarget().Update(mask);
  }
  ~InstructionSet() { hwy::GetChosenTarget().Update(hwy::SupportedTargets()); }
  InstructionSet(const InstructionSet&) = delete;
  InstructionSet& operator=(const InstructionSet&) = delete;

  /// Reports an error to the benchmark where the machine lacks the set.
  [[nodiscard]] bool is_available(benchmark::State& state) const {
    if (!available_) state.SkipWithError("this machine has no such instruction set");
    return available_;
  }

 private:
  bool available_ = true;
};

/// Memory for arrays that are timed, the same pages in every repetition: touching new ones costs more than filling
/// them ten times. `which` tells arrays apart that are used together (0 to 2). Holds numbers when first given out.
template <class T>
std::span<T> arena(std::size_t count, std::size_t which = 0) {
  static hwy::AlignedFreeUniquePtr<T[]> memory[3];
  static std::size_t sizes[3] = {0, 0, 0};
  if (sizes[which] < count) {
    memory[which] = hwy::AllocateAligned<T>(count);
    sizes[which] = count;
    std::fill_n(memory[which].get(), count, T(1));
  }
  return {memory[which].get(), count};
}

}  // namespace plumbline::bench
