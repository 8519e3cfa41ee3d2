// reference/scene/primitive.hpp: curved surfaces that are exact, where facets would carry an error of their own.
// They take part in everything that traces rays. They have no vertices, so nothing can be baked onto them, and
// no texture coordinates: their albedo is the material's factor alone.
#pragma once

#include <cstdint>
#include <string>

#include "reference/base/vector.hpp"

namespace plumbline::scene {

/// Sphere, or the part of one that is left when a cap is cut off: the points whose outward unit normal n has
/// n . keep_axis >= keep_min_cosine. The default keeps all; keep_axis = -Y and keep_min_cosine = 0 is a bowl.
/// The front looks outward, or with is_inward to the centre (a room, a cavity).
struct Sphere {
  Vec3 centre{0.0F};
  float radius = 1.0F;         // > 0
  std::uint32_t material = 0;  // index into Scene::materials
  bool is_inward = false;
  Vec3 keep_axis{0.0F, 1.0F, 0.0F};  // unit
  float keep_min_cosine = -1.0F;     // in [-1, 1)
};

/// Flat round disc without thickness; the front is on the side of `normal`.
struct Disc {
  Vec3 centre{0.0F};
  Vec3 normal{0.0F, 1.0F, 0.0F};  // unit
  float radius = 1.0F;            // > 0
  std::uint32_t material = 0;     // index into Scene::materials
};

/// Whether no cap is cut off.
[[nodiscard]] inline bool is_complete(const Sphere& sphere) {
  return sphere.keep_min_cosine <= -1.0F;
}

/// Area of the kept part: 2 pi R^2 (1 - keep_min_cosine).
[[nodiscard]] double area(const Sphere& sphere);
[[nodiscard]] double area(const Disc& disc);

/// The tightest axis-aligned box around the surface.
struct Extent {
  Vec3d low{0.0};
  Vec3d high{0.0};
};
[[nodiscard]] Extent extent(const Sphere& sphere);
[[nodiscard]] Extent extent(const Disc& disc);

/// What is wrong with its numbers ("<relation>: <value>"), materials aside; empty when nothing is.
[[nodiscard]] std::string fault_of(const Sphere& sphere);
[[nodiscard]] std::string fault_of(const Disc& disc);

}  // namespace plumbline::scene
