// reference/scene/finish.hpp: the last step of every loader.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "reference/scene/load.hpp"

namespace plumbline::scene {

/// The most vertices or triangles a file may ask for: some 6 GB, far below what could wrap an index.
inline constexpr std::size_t kMostElements = std::size_t{1} << 28U;

/// Turns what a file holds into a scene that passes validate(): drops triangles without area and counts them,
/// normalises normals, computes missing ones, adds a camera and texture coordinates (0, 0) where there are
/// none but a texture asks for them.
/// @param scene       triangles with indices in range; normals one per vertex
/// @param has_normal  one per vertex: 0 where the file has no normal
/// @throws InputError that begins with `where`
[[nodiscard]] Scene finish_loading(Scene scene, std::vector<std::uint8_t> has_normal,
                                   const LoadOptions& options, const std::string& where);

/// `v` with unit length; unchanged where it is as close to that as float gets, so that loading what was saved
/// changes no bit.
[[nodiscard]] Vec3 normalized_once(Vec3 v);

}  // namespace plumbline::scene
