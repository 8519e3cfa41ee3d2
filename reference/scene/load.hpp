// reference/scene/load.hpp: scenes from files and by name.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "reference/scene/scene.hpp"

namespace plumbline::scene {

struct LoadOptions {
  /// Where a mesh has no normals: neighbouring faces whose normals differ by at most this angle share a
  /// smooth, angle-weighted normal; at sharper edges the vertex is split. 0 = flat faces (what glTF asks
  /// for), 180 = all smooth.
  float crease_deg = 0.0F;
};

/// `builtin:NAME`, or a .gltf, .glb, .obj or .ply file. The result has passed validate() and has at least one
/// camera (framed automatically when the file has none).
/// @throws InputError, one line naming the file and the reason.
[[nodiscard]] Scene load_scene(const std::string& source, const LoadOptions& options = {});

[[nodiscard]] Scene load_gltf(const std::filesystem::path& path, const LoadOptions& options);
[[nodiscard]] Scene load_obj(const std::filesystem::path& path, const LoadOptions& options);
[[nodiscard]] Scene load_ply(const std::filesystem::path& path, const LoadOptions& options);

/// A camera that sees the whole scene: from the front right and a little above, vertical field of view 40
/// degrees.
[[nodiscard]] Camera frame_camera(const Scene& scene);

/// The camera of that name; the first one for an empty name. @throws InputError listing the names there are.
[[nodiscard]] const Camera& find_camera(const Scene& scene, const std::string& name);

}  // namespace plumbline::scene
