// reference/scene/save_gltf.hpp: scenes into binary glTF 2.0 that any viewer opens, with data of our own
// beside.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "reference/scene/scene.hpp"

namespace plumbline::scene {

/// A root extension of a glTF file: an object, and bytes that lie in the binary chunk (at a multiple of 8
/// bytes from its begin). Viewers that do not know it pass over it: it is "used", never "required".
struct GlbExtension {
  std::string name;     // "VENDOR_what"
  nlohmann::json json;  // an object without a member "bufferView": that one is ours
  std::string bytes;
};

/// One mesh: a primitive per material in use, all sharing the vertices, which keep their order; triangles of
/// one material keep theirs. Materials without triangles, cameras and lights are kept; images become 8-bit
/// sRGB PNG (an 8-bit source comes back bit for bit, anything finer is rounded). load_gltf of the result
/// gives equal positions, normals, texture coordinates, colours, materials, cameras and lights.
/// @throws InputError when the scene does not pass validate() or holds spheres or discs (glTF has none), two extensions have one name, or 4 GiB are not
/// enough
[[nodiscard]] std::string to_glb(const Scene& scene, const std::vector<GlbExtension>& extensions = {});

/// The same into a file, by rename.
void save_glb(const Scene& scene, const std::filesystem::path& path,
              const std::vector<GlbExtension>& extensions = {});

/// The extension of that name; none when the file has none. `bytes` is empty where the object names no buffer
/// view.
/// @throws InputError when the file is no .glb, is truncated, or the buffer view does not lie in its binary
/// chunk
[[nodiscard]] std::optional<GlbExtension> read_glb_extension(const std::filesystem::path& path,
                                                             std::string_view name);

}  // namespace plumbline::scene
