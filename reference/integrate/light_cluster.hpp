// reference/integrate/light_cluster.hpp: lights put together, for the building of a light tree.
#pragma once

#include <cstdint>
#include <span>

#include "reference/integrate/light_tree.hpp"

namespace plumbline::integrate {

/// Bounds of two lights together. Of two cones the smallest that holds both; a two-sided light may turn its axis round.
[[nodiscard]] LightBounds unite(const LightBounds& a, const LightBounds& b);
/// Of all `members` (indices into `lights`, at least one), in pairs: the cone depends little on their sequence.
[[nodiscard]] LightBounds unite(std::span<const LightBounds> lights, std::span<const std::uint32_t> members);

/// Rounded outward to float.
[[nodiscard]] LightTree::Cluster make_cluster(const LightBounds& bounds);

/// Reorders `members` (at least two) so that the first part, whose size in [1, size - 1] is returned, and the rest make
/// good branches: least strength x measure of directions x squared diagonal [Conty Estevez & Kulla 2018, eq. 1, with the
/// diagonal for the surface, which is 0 for lights in a row].
[[nodiscard]] std::size_t split_by_cost(std::span<const LightBounds> lights,
                                        std::span<std::uint32_t> members);
/// The same in halves of equal number along the longest extent.
[[nodiscard]] std::size_t split_by_number(std::span<const LightBounds> lights,
                                          std::span<std::uint32_t> members);

}  // namespace plumbline::integrate
