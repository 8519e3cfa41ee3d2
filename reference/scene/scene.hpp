// reference/scene/scene.hpp: everything there is to light, as one immutable value in world space.
// Right-handed, +Y up. CONVENTIONS.md#surfaces says what a surface does to light.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "reference/base/vector.hpp"
#include "reference/light/punctual.hpp"
#include "reference/scene/camera.hpp"
#include "reference/scene/primitive.hpp"
#include "reference/scene/texture.hpp"

namespace plumbline::scene {

/// A Lambertian surface: exit radiance = emission + albedo * irradiance / pi on the front, nothing on the
/// back unless it is double-sided (then the same on both).
struct Material {
  std::string name;
  Rgb albedo{0.8F};         // in [0, 1], linear
  Rgb emission{0.0F};       // radiance [W m^-2 sr^-1], >= 0
  int albedo_texture = -1;  // index into Scene::textures, multiplies `albedo`; -1 = none
  bool is_double_sided = false;
  int normal_texture = -1;    // index into Scene::textures: a normal map (normal_map.hpp); -1 = none
  float normal_scale = 1.0F;  // multiplies x and y of what the map holds, as in glTF
};

/// All meshes of a file in one indexed triangle list. Vertex i is positions[i] with normals[i]; vertices keep
/// the file's order, and are duplicated only where a normal was missing and a crease splits them. A vertex
/// that no triangle uses and whose normal was missing has the normal +Y. Beside them exact spheres and discs,
/// with or without any triangle.
///
/// A *surface* is numbered by triangles first, then spheres, then discs.
struct Scene {
  std::string name;
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;       // unit, one per vertex: interpolated over the triangle
  std::vector<Vec2> texcoords;     // empty, or one per vertex
  std::vector<Rgb> vertex_colors;  // empty, or one per vertex; linear, multiplies the albedo
  std::vector<glm::vec4>
      tangents;  // empty without normal maps, else one per vertex: unit tangent and the bitangent's sign
  std::vector<glm::uvec3> triangles;
  std::vector<std::uint32_t> triangle_materials;  // one per triangle, index into `materials`
  std::vector<Sphere> spheres;
  std::vector<Disc> discs;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<light::PunctualLight> lights;
  std::vector<Camera> cameras;
  std::size_t dropped_degenerate = 0;  // triangles without area that loading left out: worth a warning
};

/// How many surfaces are not triangles.
[[nodiscard]] inline std::size_t primitive_count(const Scene& scene) {
  return scene.spheres.size() + scene.discs.size();
}

/// Throws InputError ("<where>: <why>") when the scene holds spheres or discs: for work that lives at vertices.
void refuse_primitives(const Scene& scene, const std::string& where);

/// Material of a surface.
[[nodiscard]] inline const Material& material_of(const Scene& scene, std::uint32_t surface) {
  if (surface < scene.triangles.size()) return scene.materials[scene.triangle_materials[surface]];
  const std::size_t primitive = surface - scene.triangles.size();
  return scene
      .materials[primitive < scene.spheres.size() ? scene.spheres[primitive].material
                                                  : scene.discs[primitive - scene.spheres.size()].material];
}

/// Axis-aligned bounds of all vertices that a triangle uses, and of the spheres and discs.
struct Bounds {
  Vec3 low{0.0F};
  Vec3 high{0.0F};
};
[[nodiscard]] Bounds bounds(const Scene& scene);

/// Embree leaves out triangles beyond 1.8e18 without a word.
inline constexpr float kLargestCoordinate = 1e18F;

/// Throws InputError ("<where>: <relation>: <value>") unless: there is at least one triangle, sphere or disc;
/// indices are in range; positions and normals are finite, positions within kLargestCoordinate; normals are unit length
/// (to 1e-3); array sizes agree; albedos (factor, texture, vertex colour) are in [0, 1]; emission is finite
/// and not negative; lights and cameras are finite, with unit directions and angles in range; no triangle is
/// degenerate; a normal map has texels in [0, 1] that all point out of the surface (blue above 0.5, as glTF asks), is not an albedo
/// texture as well, and there are tangents: unit vectors (to 1e-3) with the sign 1 or -1; spheres and discs have radii above 0 (and above 1e-4 of their distance from the origin: nearer
/// to it floats can place them), unit axes, and materials without texture.
void validate(const Scene& scene, const std::string& where);

/// A triangle without area: |(b - a) x (c - a)| <= 1e-12 x (longest edge)^2, in double. That is what equal or
/// collinear vertices give; the thinnest sliver whose normal means something is far above it.
[[nodiscard]] bool is_degenerate(Vec3 a, Vec3 b, Vec3 c);

/// Geometric unit normal of a triangle (counter-clockwise front).
[[nodiscard]] Vec3 geometric_normal(const Scene& scene, std::uint32_t triangle);

/// Albedo at barycentric coordinates (b1, b2 weigh the triangle's second and third vertex): factor x texture
/// x vertex colour. Of a sphere or disc: the factor. The scene has passed validate().
[[nodiscard]] Rgb albedo_at(const Scene& scene, std::uint32_t surface, Vec2 barycentrics);

/// Albedo at every vertex, taken from the last triangle that uses it (they differ only where triangles of
/// different materials share a vertex); 0 for a vertex that no triangle uses. The scene has passed validate().
[[nodiscard]] std::vector<Rgb> vertex_albedos(const Scene& scene);

/// 64-bit fingerprint (XXH3) of everything that affects an image, cameras included, as 16 hexadecimal digits.
/// Names are left out.
[[nodiscard]] std::string fingerprint(const Scene& scene);

}  // namespace plumbline::scene
