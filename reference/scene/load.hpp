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

// What all loaders share. Triangles without area are left out and counted (Scene::dropped_degenerate); a file
// that has no others is refused. Positions, normals and texture coordinates that are not finite are refused.
// A normal of zero length counts as missing; other lengths are normalised.

/// `builtin:NAME`, or a .gltf, .glb, .obj or .ply file. The result has passed validate() and has at least one
/// camera (framed automatically when the file has none).
/// @throws InputError, one line naming the file and the reason.
[[nodiscard]] Scene load_scene(const std::string& source, const LoadOptions& options = {});

/// glTF 2.0, text or binary: the default scene (else the first, else all nodes) at rest: no animation, skin
/// or morph target. Taken: triangles (lists, strips, fans), baseColor (factor, texture, vertex colour),
/// emissive factor and strength, doubleSided, perspective cameras, KHR_lights_punctual (intensities as W/sr
/// and W/m^2; `range` is only a hint there and is ignored). Everything else of a material is ignored; alpha
/// too. Refused: an emissive texture that would show, a texture transform, an extension in extensionsRequired
/// that changes the geometry or the images. Primitives of one node that share their attribute accessors share
/// their vertices.
[[nodiscard]] Scene load_gltf(const std::filesystem::path& path, const LoadOptions& options);
/// Wavefront OBJ with .mtl: Kd is albedo (linear), Ke radiance, map_Kd an sRGB texture; albedo 0.8 where
/// there is no material or no such .mtl file. Vertex i is the file's i-th `v`; a `v` used with several vt or
/// vn is copied behind the last one, in the order of first use. Colours after the coordinates of a `v` are
/// linear.
[[nodiscard]] Scene load_obj(const std::filesystem::path& path, const LoadOptions& options);
/// PLY, ASCII or binary of either byte order: x y z, nx ny nz, s t (or u v, texture_u texture_v), red green
/// blue (integers are sRGB, floats linear) and polygons. Other elements and properties are skipped. Albedo
/// 0.8, or 1 where the file has vertex colours.
[[nodiscard]] Scene load_ply(const std::filesystem::path& path, const LoadOptions& options);

/// A camera that sees the whole scene: from the front right and a little above, vertical field of view 40
/// degrees.
[[nodiscard]] Camera frame_camera(const Scene& scene);

/// The camera of that name; the first one for an empty name. @throws InputError listing the names there are.
[[nodiscard]] const Camera& find_camera(const Scene& scene, const std::string& name);

}  // namespace plumbline::scene
