#include "reference/scene/normal_map.hpp"

#include <algorithm>

namespace plumbline::scene {

std::optional<TangentFrame> tangent_frame(const Scene& scene, const glm::uvec3& corners, const Vec3& weights,
                                          const Vec3& normal) {
  const glm::vec4 mean = weights.x * scene.tangents[corners.x] + weights.y * scene.tangents[corners.y] +
                         weights.z * scene.tangents[corners.z];
  const Vec3 along(mean);
  const Vec3 in_plane = along - glm::dot(along, normal) * normal;
  const float length = glm::length(in_plane);
  if (!(length > 1e-4F)) return std::nullopt;
  TangentFrame frame;
  frame.tangent = in_plane / length;
  frame.normal = normal;
  frame.bitangent = glm::cross(normal, frame.tangent);
  frame.sign = mean.w < 0.0F ? -1.0F : 1.0F;
  return frame;
}

// Texels have z > 0, so what lies between them has too: there is always a direction.
Vec3 normal_in_map(const Scene& scene, const Material& material, Vec2 texcoord, float sign) {
  const Texture& map = scene.textures[static_cast<std::size_t>(material.normal_texture)];
  const Vec3 stored = 2.0F * value_at(map, texcoord) - Vec3(1.0F);
  return glm::normalize(stored * Vec3(material.normal_scale, sign * material.normal_scale, 1.0F));
}

Vec3 to_world(const TangentFrame& frame, const Vec3& direction) {
  return direction.x * frame.tangent + direction.y * frame.bitangent + direction.z * frame.normal;
}

Vec3 mapped_normal(const Scene& scene, std::uint32_t triangle, const Vec3& weights, const Vec3& normal) {
  const glm::uvec3 corners = scene.triangles[triangle];
  const std::optional<TangentFrame> frame = tangent_frame(scene, corners, weights, normal);
  if (!frame) return normal;
  const Vec2 texcoord = weights.x * scene.texcoords[corners.x] + weights.y * scene.texcoords[corners.y] +
                        weights.z * scene.texcoords[corners.z];
  const Material& material = scene.materials[scene.triangle_materials[triangle]];
  return glm::normalize(to_world(*frame, normal_in_map(scene, material, texcoord, frame->sign)));
}

bool has_normal_map(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const Material& material) { return material.normal_texture >= 0; });
}

}  // namespace plumbline::scene
