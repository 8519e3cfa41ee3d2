// prt/compress/block.hpp: a compressed transfer as bytes and the members of a JSON object that describe them.
// prt/transfer/FORMAT.md specifies both.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "prt/compress/compressed.hpp"

namespace plumbline::compress {

/// Adds or replaces members of a baked file's object.
void describe_block(const Compressed& compressed, nlohmann::json& json);
[[nodiscard]] std::string to_block(const Compressed& compressed);

/// @param vertices, dimension  what the file has to hold. They must be right already: numbers of that size are made.
/// @throws InputError naming the file: a member lacks or is out of range, the block has another size, a label or a number that
/// cannot be
[[nodiscard]] Compressed parse_block(const nlohmann::json& json, const std::string& bytes,
                                     std::size_t vertices, std::size_t dimension, const std::string& file);

}  // namespace plumbline::compress
