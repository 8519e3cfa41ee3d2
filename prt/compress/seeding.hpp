// prt/compress/seeding.hpp: where clusters start. Not for others.
#pragma once

#include <cstdint>
#include <vector>

#include "prt/compress/vectors.hpp"

namespace plumbline::compress {

/// k-means++: the first vector at random, each further one with a chance proportional to its squared distance from the nearest
/// one taken so far. Fewer than `count` where there are no more different vectors. The same for any number of threads.
[[nodiscard]] std::vector<std::uint32_t> choose_seeds(const Vectors& vectors, std::size_t count,
                                                      std::uint64_t seed, int threads);

}  // namespace plumbline::compress
