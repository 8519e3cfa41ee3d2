#include "prt/transfer/directions.hpp"

#include <algorithm>
#include <cmath>

namespace plumbline::transfer {
namespace {

std::uint64_t next_random(std::uint64_t& state) {
  // Marsaglia's xorshift64*, Vigna 2016; the state is never 0 here because it starts from an odd multiple.
  state ^= state >> 12U;
  state ^= state << 25U;
  state ^= state >> 27U;
  return state * 0x2545F4914F6CDD1DULL;
}

double to_unit(std::uint64_t bits) {
  return static_cast<double>(bits >> 11U) * 0x1p-53;
}

}  // namespace

glm::dvec2 lattice_point(std::uint64_t i, std::uint64_t n, const glm::dvec2& shift) {
  const double x = shift.x + static_cast<double>(i) * kGoldenTurn;
  const double y = (static_cast<double>(i) + shift.y) / static_cast<double>(n);
  return {x - std::floor(x), 1.0 - std::abs(2.0 * y - 1.0)};
}

std::uint64_t cell_seed(std::uint64_t seed, std::uint64_t cell) {
  // Steele, Lea & Flood's finaliser of SplitMix64: neighbouring cells share no bits.
  std::uint64_t z = seed + (cell + 1) * 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31U);
}

RandomNumbers::RandomNumbers(std::uint64_t seed, std::uint64_t stream, std::uint32_t randomisation)
    : state_((seed * 0x9E3779B97F4A7C15ULL) ^ (stream * 0xD1B54A32D192ED03ULL + randomisation + 1)) {
  state_ = state_ * 2 + 1;
  for (int i = 0; i < 8; ++i) (void)next_random(state_);
}

double RandomNumbers::next() {
  return to_unit(next_random(state_));
}

glm::dvec2 shifted_sequence_point(std::uint64_t i, const glm::dvec2& shift) {
  // 1 / p and 1 / p^2 for the real root p of p^3 = p + 1.
  constexpr double kA = 0.7548776662466927;
  constexpr double kB = 0.5698402909980532;
  const double n = static_cast<double>(i);
  const glm::dvec2 point(shift.x + n * kA, shift.y + n * kB);
  return point - glm::floor(point);
}

glm::dvec2 random_shift(std::uint64_t seed, std::uint64_t stream, std::uint32_t randomisation) {
  RandomNumbers numbers(seed, stream, randomisation);
  const double x = numbers.next();
  return {x, numbers.next()};
}

std::pair<Vec3d, Vec3d> tangents(const Vec3d& normal) {
  const Vec3d helper = std::abs(normal.x) < 0.5 ? Vec3d(1.0, 0.0, 0.0) : Vec3d(0.0, 1.0, 0.0);
  const Vec3d tangent = glm::normalize(glm::cross(helper, normal));
  return {tangent, glm::cross(normal, tangent)};
}

Vec3d sphere_direction(const glm::dvec2& u) {
  const double z = 1.0 - 2.0 * u.y;
  const double radius = std::sqrt(std::max(0.0, 1.0 - z * z));
  const double azimuth = 2.0 * kPi * u.x;
  return {radius * std::cos(azimuth), radius * std::sin(azimuth), z};
}

Vec3d cosine_direction(const Vec3d& normal, const glm::dvec2& u) {
  const double sine = std::sqrt(u.y);
  const double cosine = std::sqrt(1.0 - u.y);
  const double azimuth = 2.0 * kPi * u.x;
  const auto [tangent, bitangent] = tangents(normal);
  return sine * std::cos(azimuth) * tangent + sine * std::sin(azimuth) * bitangent + cosine * normal;
}

}  // namespace plumbline::transfer
