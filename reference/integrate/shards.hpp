// reference/integrate/shards.hpp: parts of an image put together again.
#pragma once

#include <string>
#include <vector>

#include "reference/image/image.hpp"

namespace plumbline::integrate {

/// Attribute that says which shard an image is ("i/N").
inline constexpr const char* kShardAttribute = "plumbline.shard";

/// Puts the N shards of one render together, given in any order; bit-identical to the unsharded render.
/// @param names  one per part, for messages
/// @throws InputError when sizes, channels or attributes differ, when a shard is missing or comes twice.
[[nodiscard]] image::LayeredImage merge_shards(const std::vector<image::LayeredImage>& parts,
                                               const std::vector<std::string>& names);

}  // namespace plumbline::integrate
