// reference/scene/gltf_model.hpp: a glTF file as tinygltf's Model, images still encoded.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace tinygltf {
class Model;
}

namespace plumbline::scene {

/// Parses .gltf or .glb (told apart by their first bytes) and loads its buffers. tinygltf::Image::image holds
/// the encoded bytes of an image that has a URI, and nothing when that file is missing.
/// @throws InputError when the file, or a buffer it names, is missing or damaged
void parse_gltf(const std::filesystem::path& path, tinygltf::Model& model);

/// Deepest nesting of brackets in a JSON text, strings skipped. tinygltf recurses once for each level.
[[nodiscard]] int nesting_depth(std::string_view json);

}  // namespace plumbline::scene
