#include "reference/integrate/sampler.hpp"

namespace plumbline::integrate {
namespace {

std::uint32_t reverse_bits(std::uint32_t x) {
  x = __builtin_bswap32(x);
  x = ((x & 0x0F0F0F0FU) << 4U) | ((x >> 4U) & 0x0F0F0F0FU);
  x = ((x & 0x33333333U) << 2U) | ((x >> 2U) & 0x33333333U);
  return ((x & 0x55555555U) << 1U) | ((x >> 1U) & 0x55555555U);
}

// Every output bit depends only on the input bits below it [4], in the variant of Vegdahl (2021) whose
// statistics are better: between two bit reversals this is a nested uniform (Owen) scramble.
std::uint32_t permute_from_below(std::uint32_t x, std::uint32_t seed) {
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
std::uint32_t sobol_second(std::uint32_t index) {
  index ^= (index >> 1U) & 0x55555555U;
  index ^= (index >> 2U) & 0x33333333U;
  index ^= (index >> 4U) & 0x0F0F0F0FU;
  index ^= (index >> 8U) & 0x00FF00FFU;
  index ^= (index >> 16U) & 0x0000FFFFU;
  return index;
}

// 24 bits, so that the result is exact and below 1.
float to_unit(std::uint32_t bits) {
  return static_cast<float>(bits >> 8U) * 0x1p-24F;
}

}  // namespace

std::uint64_t mix(std::uint64_t value) {
  value = (value ^ (value >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  value = (value ^ (value >> 27U)) * 0x94D049BB133111EBULL;
  return value ^ (value >> 31U);
}

Sampler::Sampler(std::uint64_t seed, std::uint64_t stream, std::uint32_t randomisation, std::uint32_t index)
    : key_(mix(mix(mix(seed + 0x9E3779B97F4A7C15ULL) ^ stream) + randomisation)), index_(index) {}

Sampler::Pair Sampler::next_pair() {
  const std::uint64_t a = mix(key_ + 0x9E3779B97F4A7C15ULL * ++dimension_);
  // One multiplication more makes a third 32-bit number: its high half depends on all of a.
  const std::uint64_t b = a * 0xD1342543DE82EF95ULL;
  return {static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(a >> 32U),
          static_cast<std::uint32_t>(b >> 32U)};
}

Vec2 Sampler::point(const Pair& pair, std::uint32_t split, std::uint32_t splits) const {
  // The shuffled index, still least significant bit first after the two reversals of the scramble cancel.
  const std::uint32_t index =
      reverse_bits(permute_from_below(reverse_bits(index_ * splits + split), pair.shuffle));
  const std::uint32_t x = permute_from_below(index, pair.scramble_x);
  const std::uint32_t y = permute_from_below(sobol_second(index), pair.scramble_y);
  return {to_unit(reverse_bits(x)), to_unit(reverse_bits(y))};
}

Vec2 Sampler::next_2d() {
  return point(next_pair(), 0, 1);
}

float Sampler::next_1d() {
  return next_2d().x;
}

Vec2 Sampler::independent_2d() {
  const std::uint64_t bits =
      mix(mix(key_ + 0x9E3779B97F4A7C15ULL * ++dimension_) + 0xD1342543DE82EF95ULL * index_);
  return {to_unit(static_cast<std::uint32_t>(bits)), to_unit(static_cast<std::uint32_t>(bits >> 32U))};
}

float Sampler::independent_1d() {
  return independent_2d().x;
}

}  // namespace plumbline::integrate
