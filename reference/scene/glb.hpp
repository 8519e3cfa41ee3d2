// reference/scene/glb.hpp: the container of binary glTF 2.0: a header and two chunks.
#pragma once

#include <string>
#include <string_view>

namespace plumbline::scene {

/// The chunks of a .glb; both point into the file's bytes.
struct GlbChunks {
  std::string_view json;
  std::string_view binary;  // empty when the file has none
};

[[nodiscard]] bool is_glb(std::string_view bytes);

/// @param where  the file's name, for messages
/// @throws InputError when the header or a chunk does not fit the file
[[nodiscard]] GlbChunks split_glb(std::string_view bytes, const std::string& where);

/// Pads both chunks and puts the header in front. @throws InputError beyond the format's 4 GiB.
[[nodiscard]] std::string join_glb(std::string json, std::string binary);

}  // namespace plumbline::scene
