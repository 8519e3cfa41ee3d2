// reference/integrate/sampler.hpp: the random numbers of the path tracer.
// [1] Sobol' 1967; [2] Owen, "Randomly permuted (t,m,s)-nets", 1995; [3] Burley, "Practical hash-based Owen
// scrambling",
//     JCGT 9(4), 2020; [4] Laine & Karras, "Stratified sampling for stochastic transparency", EGSR 2011.
#pragma once

#include <cstdint>

#include "reference/base/vector.hpp"

namespace plumbline::integrate {

/// A counted source of uniform numbers: the value depends only on (seed, stream, randomisation, index, how
/// many were drawn), never on threads or time. For one (seed, stream, randomisation) and one pair of
/// dimensions the points of index = 0 … 2^k - 1 are an Owen-scrambled (0, 2)-sequence of Sobol' [1-3]; pairs
/// are independent of each other
/// ("padding"), and so are randomisations and streams.
class Sampler {
 public:
  Sampler(std::uint64_t seed, std::uint64_t stream, std::uint32_t randomisation, std::uint32_t index);

  /// The next pair of dimensions, in [0, 1)^2.
  [[nodiscard]] Vec2 next_2d();
  [[nodiscard]] float next_1d();

  /// Numbers without any relation to those of other samples: cheaper, for decisions and for dimensions so deep in a path
  /// that a better distribution no longer shows.
  [[nodiscard]] Vec2 independent_2d();
  [[nodiscard]] float independent_1d();

  /// One pair of dimensions from which a sample draws several points (splitting).
  struct Pair {
    std::uint32_t shuffle = 0;
    std::uint32_t scramble_x = 0;
    std::uint32_t scramble_y = 0;
  };
  [[nodiscard]] Pair next_pair();
  /// Point `split` of `splits` (a power of two): over all samples of a randomisation these are the points of one sequence too.
  [[nodiscard]] Vec2 point(const Pair& pair, std::uint32_t split, std::uint32_t splits) const;

 private:
  std::uint64_t key_;
  std::uint32_t index_;
  std::uint32_t dimension_ = 0;
};

/// 64-bit mixing (the finaliser of SplitMix64): a bijection whose output bits look independent.
[[nodiscard]] std::uint64_t mix(std::uint64_t value);

// ---------------------------------------------------------------- bodies: a path draws some fifty numbers, all inline
namespace sampler_detail {

inline std::uint32_t reverse_bits(std::uint32_t x) {
  x = __builtin_bswap32(x);
  x = ((x & 0x0F0F0F0FU) << 4U) | ((x >> 4U) & 0x0F0F0F0FU);
  x = ((x & 0x33333333U) << 2U) | ((x >> 2U) & 0x33333333U);
  return ((x & 0x55555555U) << 1U) | ((x >> 1U) & 0x55555555U);
}

// Every output bit depends only on the input bits below it [4], in the variant of Vegdahl (2021) whose
// statistics are better: between two bit reversals this is a nested uniform (Owen) scramble.
inline std::uint32_t permute_from_below(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3D20ADEAU;
  x += seed;
  x *= (seed >> 16U) | 1U;
  x ^= x * 0x05526C56U;
  x ^= x * 0x53A22864U;
  return x;
}

// Sobol's second dimension has the generator matrix C(j, i) mod 2 (Pascal). C(j, i) is odd exactly when the
// bits of i are a subset of those of j (Lucas), so digit i is the XOR of the index bits j that contain i: a
// superset sum over the five bits of the bit position, five steps instead of a table. The digits come out
// least significant first.
inline std::uint32_t sobol_second(std::uint32_t index) {
  index ^= (index >> 1U) & 0x55555555U;
  index ^= (index >> 2U) & 0x33333333U;
  index ^= (index >> 4U) & 0x0F0F0F0FU;
  index ^= (index >> 8U) & 0x00FF00FFU;
  index ^= (index >> 16U) & 0x0000FFFFU;
  return index;
}

// 24 bits, so that the result is exact and below 1.
inline float to_unit(std::uint32_t bits) {
  return static_cast<float>(bits >> 8U) * 0x1p-24F;
}

}  // namespace sampler_detail

inline std::uint64_t mix(std::uint64_t value) {
  value = (value ^ (value >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  value = (value ^ (value >> 27U)) * 0x94D049BB133111EBULL;
  return value ^ (value >> 31U);
}

inline Sampler::Sampler(std::uint64_t seed, std::uint64_t stream, std::uint32_t randomisation,
                        std::uint32_t index)
    : key_(mix(mix(mix(seed + 0x9E3779B97F4A7C15ULL) ^ stream) + randomisation)), index_(index) {}

inline Sampler::Pair Sampler::next_pair() {
  const std::uint64_t a = mix(key_ + 0x9E3779B97F4A7C15ULL * ++dimension_);
  // One multiplication more makes a third 32-bit number: its high half depends on all of a.
  const std::uint64_t b = a * 0xD1342543DE82EF95ULL;
  return {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(a >> 32U),
          static_cast<std::uint32_t>(b >> 32U)};
}

inline Vec2 Sampler::point(const Pair& pair, std::uint32_t split, std::uint32_t splits) const {
  // The shuffled index, still least significant bit first after the two reversals of the scramble cancel.
  const std::uint32_t index = sampler_detail::reverse_bits(sampler_detail::permute_from_below(
      sampler_detail::reverse_bits(index_ * splits + split), pair.shuffle));
  const std::uint32_t x = sampler_detail::permute_from_below(index, pair.scramble_x);
  const std::uint32_t y =
      sampler_detail::permute_from_below(sampler_detail::sobol_second(index), pair.scramble_y);
  return {sampler_detail::to_unit(sampler_detail::reverse_bits(x)),
          sampler_detail::to_unit(sampler_detail::reverse_bits(y))};
}

inline Vec2 Sampler::next_2d() {
  return point(next_pair(), 0, 1);
}

inline float Sampler::next_1d() {
  return next_2d().x;
}

inline Vec2 Sampler::independent_2d() {
  const std::uint64_t bits =
      mix(mix(key_ + 0x9E3779B97F4A7C15ULL * ++dimension_) + 0xD1342543DE82EF95ULL * index_);
  return {sampler_detail::to_unit(static_cast<std::uint32_t>(bits)),
          sampler_detail::to_unit(static_cast<std::uint32_t>(bits >> 32U))};
}

inline float Sampler::independent_1d() {
  return independent_2d().x;
}

}  // namespace plumbline::integrate
