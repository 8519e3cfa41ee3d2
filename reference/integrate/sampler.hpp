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

}  // namespace plumbline::integrate
