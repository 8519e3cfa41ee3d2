// prt/transfer/directions.hpp: well-spread directions for a bake. The bake has its own point set on purpose:
// it shares no sampling code with the reference it is held against.
#pragma once

#include <cstdint>

#include "reference/base/vector.hpp"

namespace plumbline::transfer {

/// Point i of the rank-1 sequence with the generators of the plastic number (Roberts' R2: the two-dimensional
/// golden ratio), shifted by `shift` modulo 1 (Cranley & Patterson 1976): for a uniform shift every point is
/// uniform on [0, 1)^2.
[[nodiscard]] glm::dvec2 shifted_lattice_point(std::uint64_t i, const glm::dvec2& shift);

/// A uniform shift from (seed, stream, randomisation).
[[nodiscard]] glm::dvec2 random_shift(std::uint64_t seed, std::uint64_t stream, std::uint32_t randomisation);

/// Direction of density max(0, n.w) / pi: cos^2 = 1 - u.y, azimuth 2 pi u.x about the unit normal.
[[nodiscard]] Vec3d cosine_direction(const Vec3d& normal, const glm::dvec2& u);

}  // namespace plumbline::transfer
