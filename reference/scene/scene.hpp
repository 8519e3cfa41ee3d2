// reference/scene/scene.hpp: everything there is to light, as one immutable value in world space.
// Right-handed, +Y up. CONVENTIONS.md#surfaces says what a surface does to light.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "reference/base/vector.hpp"
#include "reference/image/image.hpp"
#include "reference/light/punctual.hpp"
#include "reference/scene/camera.hpp"

namespace plumbline::scene {

/// A Lambertian surface: exit radiance = emission + albedo * irradiance / pi on the front, nothing on the
/// back unless it is double-sided (then the same on both).
struct Material {
  std::string name;
  Rgb albedo{0.8F};         // in [0, 1], linear
  Rgb emission{0.0F};       // radiance [W m^-2 sr^-1], >= 0
  int albedo_texture = -1;  // index into Scene::textures, multiplies `albedo`; -1 = none
  bool is_double_sided = false;
};

/// Linear albedo image, looked up bilinearly, repeated (the glTF default). Texture coordinate (0, 0) is the
/// top left corner.
struct Texture {
  image::Image image;
};

/// All meshes of a file in one indexed triangle list. Vertex i is positions[i] with normals[i]; vertices keep
/// the file's order, and are duplicated only where a normal was missing and a crease splits them.
struct Scene {
  std::string name;
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;       // unit, one per vertex: interpolated over the triangle
  std::vector<Vec2> texcoords;     // empty, or one per vertex
  std::vector<Rgb> vertex_colors;  // empty, or one per vertex; linear, multiplies the albedo
  std::vector<glm::uvec3> triangles;
  std::vector<std::uint32_t> triangle_materials;  // one per triangle, index into `materials`
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<light::PunctualLight> lights;
  std::vector<Camera> cameras;
};

/// Axis-aligned bounds of all vertices that a triangle uses.
struct Bounds {
  Vec3 low{0.0F};
  Vec3 high{0.0F};
};
[[nodiscard]] Bounds bounds(const Scene& scene);

/// Throws InputError ("<where>: <relation>: <value>") unless: there is at least one triangle; indices are in
/// range; positions and normals are finite; normals are unit length (to 1e-3); array sizes agree; albedos are
/// in [0, 1]; emission is finite and not negative; no triangle is degenerate (zero area in float).
void validate(const Scene& scene, const std::string& where);

/// Geometric unit normal of a triangle (counter-clockwise front).
[[nodiscard]] Vec3 geometric_normal(const Scene& scene, std::uint32_t triangle);

/// Albedo at barycentric coordinates (b1, b2 weigh the triangle's second and third vertex): factor x texture
/// x vertex colour.
[[nodiscard]] Rgb albedo_at(const Scene& scene, std::uint32_t triangle, Vec2 barycentrics);

/// 64-bit fingerprint of everything that affects an image, as 16 hexadecimal digits. Names are left out.
[[nodiscard]] std::string fingerprint(const Scene& scene);

}  // namespace plumbline::scene
