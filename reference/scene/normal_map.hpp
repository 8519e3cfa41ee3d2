// reference/scene/normal_map.hpp: fine shape that is only a picture of normals. CONVENTIONS.md#surfaces.
#pragma once

#include <optional>

#include "reference/scene/scene.hpp"

namespace plumbline::scene {

/// Orthonormal frame at a point of a surface that has texture coordinates. Right-handed: bitangent = normal x tangent.
struct TangentFrame {
  Vec3 tangent{1.0F, 0.0F, 0.0F};
  Vec3 bitangent{0.0F, 1.0F, 0.0F};
  Vec3 normal{0.0F, 0.0F, 1.0F};
  float sign = 1.0F;  // -1: the texture is mirrored, what its map calls +y is -bitangent
};

/// Frame with the given unit normal and the interpolated vertex tangent made orthogonal to it. `weights` are barycentric, their sum
/// is 1; the sign is that of the interpolated signs. No frame where tangents cancel or stand upon the surface.
/// The scene has tangents.
[[nodiscard]] std::optional<TangentFrame> tangent_frame(const Scene& scene, const glm::uvec3& corners,
                                                        const Vec3& weights, const Vec3& normal);

/// Unit normal that the map of a material holds at a texture coordinate, in the right-handed frame (+z is the unperturbed one):
/// texels interpolated, 2t - 1, x and y times the scale, normalised (glTF 2.0, section 3.9.3: green is up, towards smaller v).
/// The material has a normal map.
[[nodiscard]] Vec3 normal_in_map(const Scene& scene, const Material& material, Vec2 texcoord, float sign);

/// A direction of the frame in world axes.
[[nodiscard]] Vec3 to_world(const TangentFrame& frame, const Vec3& direction);

/// Shading normal of a triangle whose material has a normal map, `normal` being the interpolated one (unit): that one itself
/// where there is no tangent frame.
[[nodiscard]] Vec3 mapped_normal(const Scene& scene, std::uint32_t triangle, const Vec3& weights,
                                 const Vec3& normal);

[[nodiscard]] bool has_normal_map(const Scene& scene);

}  // namespace plumbline::scene
