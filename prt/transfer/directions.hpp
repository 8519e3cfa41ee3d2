// prt/transfer/directions.hpp: well-spread directions for a bake. The bake has its own point set on purpose:
// it shares no sampling code with the reference it is held against.
#pragma once

#include <cstdint>
#include <limits>
#include <utility>

#include "reference/base/vector.hpp"

namespace plumbline::transfer {

/// Point i of a Fibonacci lattice of n points (azimuth by the golden ratio, u.y in even steps), shifted by `shift` and folded in
/// u.y: u.y = 1 - |2 (i + shift.y)/n - 1|. For a uniform shift the n points are together an unbiased rule on [0, 1)^2. The
/// fold puts two grids of opposite offset on each other, whose first-order errors cancel: what is smooth over the hemisphere
/// is integrated to second order (Hickernell's tent, 2002).
[[nodiscard]] glm::dvec2 lattice_point(std::uint64_t i, std::uint64_t n, const glm::dvec2& shift);

/// Point i of the rank-1 sequence with the generators of the plastic number (Roberts' R2: the two-dimensional
/// golden ratio), shifted by `shift` modulo 1 (Cranley & Patterson 1976): for a uniform shift every point is
/// uniform on [0, 1)^2. Unlike the lattice it may end anywhere.
[[nodiscard]] glm::dvec2 shifted_sequence_point(std::uint64_t i, const glm::dvec2& shift);

/// A uniform shift from (seed, stream, randomisation).
[[nodiscard]] glm::dvec2 random_shift(std::uint64_t seed, std::uint64_t stream, std::uint32_t randomisation);

/// Another seed for each cell of a grid.
[[nodiscard]] std::uint64_t cell_seed(std::uint64_t seed, std::uint64_t cell);

/// Random numbers in order: a walk's choices.
class RandomNumbers {
 public:
  RandomNumbers(std::uint64_t seed, std::uint64_t stream, std::uint32_t randomisation);
  /// Uniform in [0, 1).
  [[nodiscard]] double next();

 private:
  std::uint64_t state_;
};

/// 1/golden ratio: azimuths of neighbours in the lattice, in turns.
inline constexpr double kGoldenTurn = 0.6180339887498949;

/// The largest float below 1.
inline constexpr float kBelowOne = 1.0F - std::numeric_limits<float>::epsilon() / 2.0F;

/// Two unit vectors that make a right-handed frame with the unit normal: tangent x bitangent = normal.
[[nodiscard]] std::pair<Vec3d, Vec3d> tangents(const Vec3d& normal);

/// Uniform over the sphere: z = 1 - 2 u.y, azimuth 2 pi u.x.
[[nodiscard]] Vec3d sphere_direction(const glm::dvec2& u);

/// Direction of density max(0, n.w) / pi: cos^2 = 1 - u.y, azimuth 2 pi u.x about the unit normal.
[[nodiscard]] Vec3d cosine_direction(const Vec3d& normal, const glm::dvec2& u);

}  // namespace plumbline::transfer
