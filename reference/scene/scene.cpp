#include "reference/scene/scene.hpp"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>
#include <span>

#include "reference/base/error.hpp"

namespace plumbline::scene {
namespace {

constexpr float kUnitTolerance = 1e-3F;

std::string text(Vec3 v) {
  return fmt::format("({}, {}, {})", v.x, v.y, v.z);
}

[[noreturn]] void refuse(const std::string& where, const std::string& relation_and_value) {
  throw InputError(where + ": " + relation_and_value);
}

bool is_unit(Vec3 v) {
  return std::abs(glm::length(v) - 1.0F) <= kUnitTolerance;  // false for NaN
}

bool is_albedo(Rgb c) {
  return c.x >= 0.0F && c.x <= 1.0F && c.y >= 0.0F && c.y <= 1.0F && c.z >= 0.0F && c.z <= 1.0F;
}

bool is_power(Rgb c) {
  return is_finite(c) && c.x >= 0.0F && c.y >= 0.0F && c.z >= 0.0F;
}

void validate_vertices(const Scene& scene, const std::string& where) {
  const std::size_t count = scene.positions.size();
  if (count > std::numeric_limits<std::uint32_t>::max()) {
    refuse(where, fmt::format("{} vertices, more than a 32-bit index can reach", count));
  }
  if (scene.normals.size() != count) {
    refuse(where, fmt::format("{} normals for {} vertices", scene.normals.size(), count));
  }
  if (!scene.texcoords.empty() && scene.texcoords.size() != count) {
    refuse(where, fmt::format("{} texture coordinates for {} vertices", scene.texcoords.size(), count));
  }
  if (!scene.vertex_colors.empty() && scene.vertex_colors.size() != count) {
    refuse(where, fmt::format("{} vertex colours for {} vertices", scene.vertex_colors.size(), count));
  }
  if (!scene.tangents.empty() && scene.tangents.size() != count) {
    refuse(where, fmt::format("{} tangents for {} vertices", scene.tangents.size(), count));
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!(max_magnitude(scene.positions[i]) <= kLargestCoordinate) || !is_finite(scene.positions[i])) {
      refuse(where, fmt::format("position of vertex {} is not finite and within 1e18: {}", i,
                                text(scene.positions[i])));
    }
    if (!is_unit(scene.normals[i])) {
      refuse(where, fmt::format("normal of vertex {} is not unit length: {}", i, text(scene.normals[i])));
    }
  }
  for (std::size_t i = 0; i < scene.texcoords.size(); ++i) {
    const Vec2 uv = scene.texcoords[i];
    if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) {
      refuse(where, fmt::format("texture coordinate of vertex {} is not finite: ({}, {})", i, uv.x, uv.y));
    }
  }
  for (std::size_t i = 0; i < scene.vertex_colors.size(); ++i) {
    if (!is_albedo(scene.vertex_colors[i])) {
      refuse(where,
             fmt::format("colour of vertex {} is outside [0, 1]: {}", i, text(scene.vertex_colors[i])));
    }
  }
}

void validate_tangents(const Scene& scene, const std::string& where) {
  for (std::size_t i = 0; i < scene.tangents.size(); ++i) {
    const glm::vec4 t = scene.tangents[i];
    if (!is_unit(Vec3(t)) || std::abs(t.w) != 1.0F) {
      refuse(where,
             fmt::format("tangent of vertex {} is not a unit vector with a sign of 1 or -1: ({}, {}, {}, {})",
                         i, t.x, t.y, t.z, t.w));
    }
  }
}

void validate_triangles(const Scene& scene, const std::string& where) {
  const std::size_t vertices = scene.positions.size();
  if (scene.triangles.empty() && primitive_count(scene) == 0) {
    refuse(where, "has no triangles, spheres or discs: 0");
  }
  if (scene.triangle_materials.size() != scene.triangles.size()) {
    refuse(where, fmt::format("{} triangle materials for {} triangles", scene.triangle_materials.size(),
                              scene.triangles.size()));
  }
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    const glm::uvec3 corners = scene.triangles[t];
    const std::uint32_t largest = std::max({corners.x, corners.y, corners.z});
    if (largest >= vertices) {
      refuse(where, fmt::format("triangle {} uses vertex {}, there are {}", t, largest, vertices));
    }
    if (scene.triangle_materials[t] >= scene.materials.size()) {
      refuse(where, fmt::format("triangle {} uses material {}, there are {}", t, scene.triangle_materials[t],
                                scene.materials.size()));
    }
    if (is_degenerate(scene.positions[corners.x], scene.positions[corners.y], scene.positions[corners.z])) {
      refuse(where, fmt::format("triangle {} has no area", t));
    }
  }
}

template <class Primitive>
void validate_primitives(const Scene& scene, const std::vector<Primitive>& primitives, const char* kind,
                         const std::string& where) {
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    const std::string fault = fault_of(primitives[i]);
    if (!fault.empty()) refuse(where, fmt::format("{} {}: {}", kind, i, fault));
    const std::uint32_t material = primitives[i].material;
    if (material >= scene.materials.size()) {
      refuse(where,
             fmt::format("{} {} uses material {}, there are {}", kind, i, material, scene.materials.size()));
    }
    if (scene.materials[material].albedo_texture >= 0 || scene.materials[material].normal_texture >= 0) {
      refuse(where, fmt::format("{} {} has no texture coordinates, but its material {} has a texture", kind,
                                i, material));
    }
  }
}

void validate_normal_map(const Scene& scene, std::size_t index, const std::string& where) {
  const Material& material = scene.materials[index];
  const int texture = material.normal_texture;
  if (texture < -1 || texture >= static_cast<int>(scene.textures.size())) {
    refuse(where, fmt::format("material {} uses texture {} as normal map, there are {}", index, texture,
                              scene.textures.size()));
  }
  if (texture < 0) return;
  if (!std::isfinite(material.normal_scale)) {
    refuse(where, fmt::format("normal scale of material {} is not finite: {}", index, material.normal_scale));
  }
  if (scene.texcoords.empty() || scene.tangents.empty()) {
    refuse(where,
           fmt::format("material {} has a normal map, but there are {} texture coordinates and {} tangents",
                       index, scene.texcoords.size(), scene.tangents.size()));
  }
  for (const Material& other : scene.materials) {
    if (other.albedo_texture == texture) {
      refuse(where, fmt::format("texture {} is an albedo and, in material {}, a normal map", texture, index));
    }
  }
  for (const Rgb& texel : scene.textures[static_cast<std::size_t>(texture)].image.pixels) {
    if (!(texel.z > 0.5F)) {
      refuse(where, fmt::format("normal map of material {} has a texel that does not point out of the "
                                "surface (blue above 0.5): {}",
                                index, text(texel)));
    }
  }
}

void validate_materials(const Scene& scene, const std::string& where) {
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& material = scene.materials[i];
    if (!is_albedo(material.albedo)) {
      refuse(where, fmt::format("albedo of material {} is outside [0, 1]: {}", i, text(material.albedo)));
    }
    if (!is_power(material.emission)) {
      refuse(where, fmt::format("emission of material {} is negative or not finite: {}", i,
                                text(material.emission)));
    }
    if (material.albedo_texture < -1 || material.albedo_texture >= static_cast<int>(scene.textures.size())) {
      refuse(where, fmt::format("material {} uses texture {}, there are {}", i, material.albedo_texture,
                                scene.textures.size()));
    }
    if (material.albedo_texture >= 0 && scene.texcoords.empty()) {
      refuse(where, fmt::format("material {} has a texture, but there are no texture coordinates: 0", i));
    }
  }
  for (std::size_t i = 0; i < scene.materials.size(); ++i) validate_normal_map(scene, i, where);
  for (std::size_t i = 0; i < scene.textures.size(); ++i) {
    const image::Image& image = scene.textures[i].image;
    if (image.width < 1 || image.height < 1 ||
        image.pixels.size() !=
            static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height)) {
      refuse(where, fmt::format("texture {} has size {}x{} and {} texels", i, image.width, image.height,
                                image.pixels.size()));
    }
    const auto wrong = std::find_if_not(image.pixels.begin(), image.pixels.end(), is_albedo);
    if (wrong != image.pixels.end()) {
      refuse(where, fmt::format("texture {} has a texel outside [0, 1]: {}", i, text(*wrong)));
    }
  }
}

struct LightFault {
  std::string operator()(const light::PointLight& light) const {
    if (!is_finite(light.position)) return "position is not finite: " + text(light.position);
    if (!is_power(light.radiant_intensity)) {
      return "intensity is negative or not finite: " + text(light.radiant_intensity);
    }
    return {};
  }
  std::string operator()(const light::SpotLight& light) const {
    const std::string fault = (*this)(light::PointLight{light.position, light.radiant_intensity});
    if (!fault.empty()) return fault;
    if (!is_unit(light.direction)) return "direction is not unit length: " + text(light.direction);
    const float right_angle = 1.5707964F;
    if (!(light.inner_angle_rad >= 0.0F && light.inner_angle_rad < light.outer_angle_rad &&
          light.outer_angle_rad <= right_angle)) {
      return fmt::format("cone angles violate 0 <= inner < outer <= pi/2: {}, {}", light.inner_angle_rad,
                         light.outer_angle_rad);
    }
    return {};
  }
  std::string operator()(const light::DirectionalLight& light) const {
    if (!is_unit(light.direction)) return "direction is not unit length: " + text(light.direction);
    if (!is_power(light.irradiance)) return "irradiance is negative or not finite: " + text(light.irradiance);
    return {};
  }
};

void validate_lights_and_cameras(const Scene& scene, const std::string& where) {
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const std::string fault = std::visit(LightFault{}, scene.lights[i]);
    if (!fault.empty()) refuse(where, fmt::format("light {}: {}", i, fault));
  }
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    const Camera& camera = scene.cameras[i];
    if (!is_finite(camera.eye)) {
      refuse(where, fmt::format("camera {}: position is not finite: {}", i, text(camera.eye)));
    }
    const float cosine = glm::dot(camera.forward, camera.up);
    if (!is_unit(camera.forward) || !is_unit(camera.up) || !(std::abs(cosine) <= kUnitTolerance)) {
      refuse(where, fmt::format("camera {}: forward and up are not orthogonal unit vectors: {}, {}", i,
                                text(camera.forward), text(camera.up)));
    }
    if (!(camera.vertical_fov_rad > 0.0F && static_cast<double>(camera.vertical_fov_rad) < kPi)) {
      refuse(where, fmt::format("camera {}: vertical field of view is outside (0, pi): {}", i,
                                camera.vertical_fov_rad));
    }
  }
}

template <class Value>
Value interpolated(const std::vector<Value>& values, glm::uvec3 corners, Vec2 b) {
  return values[corners.x] * (1.0F - b.x - b.y) + values[corners.y] * b.x + values[corners.z] * b.y;
}

// ---------------------------------------------------------------- fingerprint

class Hasher {
 public:
  Hasher() : state_(XXH3_createState(), &XXH3_freeState) { XXH3_64bits_reset(state_.get()); }

  template <class Value>
  void add(const Value& value) {
    static_assert(std::has_unique_object_representations_v<Value> || std::is_floating_point_v<Value>);
    XXH3_64bits_update(state_.get(), &value, sizeof(Value));
  }
  void add(Vec3 value) { add_floats(std::span(&value.x, 3)); }
  template <class Value>
  void add_array(const std::vector<Value>& values) {  // of floats, integers, or vectors of them: no padding
    add(static_cast<std::uint64_t>(values.size()));
    XXH3_64bits_update(state_.get(), values.data(), values.size() * sizeof(Value));
  }
  [[nodiscard]] std::string digits() const {
    return fmt::format("{:016x}", static_cast<std::uint64_t>(XXH3_64bits_digest(state_.get())));
  }

 private:
  void add_floats(std::span<const float> values) {
    XXH3_64bits_update(state_.get(), values.data(), values.size_bytes());
  }
  std::unique_ptr<XXH3_state_t, decltype(&XXH3_freeState)> state_;
};

struct AddLight {
  Hasher& hasher;

  void operator()(const light::PointLight& light) const {
    hasher.add(light.position);
    hasher.add(light.radiant_intensity);
  }
  void operator()(const light::SpotLight& light) const {
    hasher.add(light.position);
    hasher.add(light.direction);
    hasher.add(light.radiant_intensity);
    hasher.add(light.inner_angle_rad);
    hasher.add(light.outer_angle_rad);
  }
  void operator()(const light::DirectionalLight& light) const {
    hasher.add(light.direction);
    hasher.add(light.irradiance);
  }
};

void add_materials(Hasher& hasher, const Scene& scene) {
  hasher.add(static_cast<std::uint64_t>(scene.materials.size()));
  for (const Material& material : scene.materials) {
    hasher.add(material.albedo);
    hasher.add(material.emission);
    hasher.add(material.albedo_texture);
    hasher.add(static_cast<int>(material.is_double_sided));
  }
  hasher.add(static_cast<std::uint64_t>(scene.textures.size()));
  for (const Texture& texture : scene.textures) {
    hasher.add(texture.image.width);
    hasher.add(texture.image.height);
    hasher.add(static_cast<int>(texture.wrap_u));
    hasher.add(static_cast<int>(texture.wrap_v));
    hasher.add_array(texture.image.pixels);
  }
}

// Scenes without spheres and discs keep the fingerprint they had before there were any.
void add_primitives(Hasher& hasher, const Scene& scene) {
  if (primitive_count(scene) == 0) return;
  hasher.add(static_cast<std::uint64_t>(scene.spheres.size()));
  for (const Sphere& sphere : scene.spheres) {
    hasher.add(sphere.centre);
    hasher.add(sphere.radius);
    hasher.add(sphere.material);
    hasher.add(static_cast<int>(sphere.is_inward));
    hasher.add(sphere.keep_axis);
    hasher.add(sphere.keep_min_cosine);
  }
  hasher.add(static_cast<std::uint64_t>(scene.discs.size()));
  for (const Disc& disc : scene.discs) {
    hasher.add(disc.centre);
    hasher.add(disc.normal);
    hasher.add(disc.radius);
    hasher.add(disc.material);
  }
}

// Nor do normal maps change the fingerprint of scenes that have none.
void add_normal_maps(Hasher& hasher, const Scene& scene) {
  if (scene.tangents.empty()) return;
  hasher.add_array(scene.tangents);
  for (const Material& material : scene.materials) {
    hasher.add(material.normal_texture);
    hasher.add(material.normal_scale);
  }
}

}  // namespace

bool is_degenerate(Vec3 a, Vec3 b, Vec3 c) {
  const Vec3d ab = Vec3d(b) - Vec3d(a);
  const Vec3d ac = Vec3d(c) - Vec3d(a);
  const Vec3d bc = Vec3d(c) - Vec3d(b);
  const double longest_squared = std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(bc, bc)});
  return !(glm::length(glm::cross(ab, ac)) > 1e-12 * longest_squared);
}

Bounds bounds(const Scene& scene) {
  if (scene.triangles.empty() && primitive_count(scene) == 0) return {};
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Bounds result{Vec3(kInfinity), Vec3(-kInfinity)};
  for (const glm::uvec3& corners : scene.triangles) {
    for (int k = 0; k < 3; ++k) {
      result.low = glm::min(result.low, scene.positions[corners[k]]);
      result.high = glm::max(result.high, scene.positions[corners[k]]);
    }
  }
  const auto include = [&](const Extent& box) {
    result.low = glm::min(result.low, Vec3(box.low));
    result.high = glm::max(result.high, Vec3(box.high));
  };
  for (const Sphere& sphere : scene.spheres) include(extent(sphere));
  for (const Disc& disc : scene.discs) include(extent(disc));
  return result;
}

void validate(const Scene& scene, const std::string& where) {
  validate_vertices(scene, where);
  validate_tangents(scene, where);
  validate_triangles(scene, where);
  validate_primitives(scene, scene.spheres, "sphere", where);
  validate_primitives(scene, scene.discs, "disc", where);
  if (scene.triangles.size() + primitive_count(scene) > std::numeric_limits<std::uint32_t>::max()) {
    refuse(where, fmt::format("{} surfaces, more than a 32-bit index can reach",
                              scene.triangles.size() + primitive_count(scene)));
  }
  validate_materials(scene, where);
  validate_lights_and_cameras(scene, where);
}

Vec3 geometric_normal(const Scene& scene, std::uint32_t triangle) {
  const glm::uvec3 corners = scene.triangles[triangle];
  const Vec3d a(scene.positions[corners.x]);
  return Vec3(glm::normalize(
      glm::cross(Vec3d(scene.positions[corners.y]) - a, Vec3d(scene.positions[corners.z]) - a)));
}

void refuse_primitives(const Scene& scene, const std::string& where) {
  if (primitive_count(scene) == 0) return;
  refuse(where, fmt::format("works on triangles only, the scene has {} exact spheres and {} discs",
                            scene.spheres.size(), scene.discs.size()));
}

Rgb albedo_at(const Scene& scene, std::uint32_t surface, Vec2 barycentrics) {
  if (surface >= scene.triangles.size()) return material_of(scene, surface).albedo;
  const std::uint32_t triangle = surface;
  const Material& material = scene.materials[scene.triangle_materials[triangle]];
  Rgb albedo = material.albedo;
  if (material.albedo_texture >= 0) {
    const Texture& texture = scene.textures[static_cast<std::size_t>(material.albedo_texture)];
    albedo *= value_at(texture, interpolated(scene.texcoords, scene.triangles[triangle], barycentrics));
  }
  if (!scene.vertex_colors.empty()) {
    albedo *= interpolated(scene.vertex_colors, scene.triangles[triangle], barycentrics);
  }
  return albedo;
}

std::vector<Rgb> vertex_albedos(const Scene& scene) {
  constexpr Vec2 kCorners[3] = {{0.0F, 0.0F}, {1.0F, 0.0F}, {0.0F, 1.0F}};
  std::vector<Rgb> albedos(scene.positions.size(), Rgb(0.0F));
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) albedos[scene.triangles[t][k]] = albedo_at(scene, t, kCorners[k]);
  }
  return albedos;
}

std::string fingerprint(const Scene& scene) {
  Hasher hasher;
  hasher.add_array(scene.positions);
  hasher.add_array(scene.normals);
  hasher.add_array(scene.texcoords);
  hasher.add_array(scene.vertex_colors);
  hasher.add_array(scene.triangles);
  hasher.add_array(scene.triangle_materials);
  add_primitives(hasher, scene);
  add_materials(hasher, scene);
  add_normal_maps(hasher, scene);
  hasher.add(static_cast<std::uint64_t>(scene.lights.size()));
  for (const light::PunctualLight& light : scene.lights) {
    hasher.add(static_cast<std::uint64_t>(light.index()));
    std::visit(AddLight{hasher}, light);
  }
  hasher.add(static_cast<std::uint64_t>(scene.cameras.size()));
  for (const Camera& camera : scene.cameras) {
    hasher.add(camera.eye);
    hasher.add(camera.forward);
    hasher.add(camera.up);
    hasher.add(camera.vertical_fov_rad);
  }
  return hasher.digits();
}

}  // namespace plumbline::scene
