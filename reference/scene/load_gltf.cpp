#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <glm/gtc/quaternion.hpp>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "reference/base/error.hpp"
#include "reference/image/file.hpp"
#include "reference/scene/finish.hpp"
#include "reference/scene/gltf_accessor.hpp"
#include "reference/scene/gltf_model.hpp"
#include "reference/scene/load.hpp"
#include "reference/scene/text.hpp"

namespace plumbline::scene {
namespace {

using Mat4 = glm::dmat4;

enum class Content { colour, normals };

struct Loader {
  const tinygltf::Model& model;
  std::string where;  // the file's name
  Scene scene;
  std::vector<std::uint8_t> has_normal;
  std::map<std::tuple<int, Wrap, Wrap, Content>, int>
      textures;  // (image, wrapping, content) -> Scene::textures
  std::optional<std::uint32_t> default_material;
};

[[noreturn]] void refuse(const Loader& loader, const std::string& what) {
  throw InputError(loader.where + ": " + what);
}

template <class Thing>
const Thing& at(const Loader& loader, const std::vector<Thing>& things, int index, const char* kind) {
  if (index < 0 || static_cast<std::size_t>(index) >= things.size()) {
    refuse(loader, fmt::format("{} {} does not exist, there are {}", kind, index, things.size()));
  }
  return things[static_cast<std::size_t>(index)];
}

Rgb to_rgb(const std::vector<double>& numbers, Rgb otherwise) {
  if (numbers.size() < 3) return otherwise;
  return Rgb(RgbD(numbers[0], numbers[1], numbers[2]));
}

// ---------------------------------------------------------------- materials and textures

// The image library goes by extensions first. Files lie about theirs, so the first bytes count, then the URI.
std::string extension_of(std::string_view bytes, const std::string& uri) {
  if (bytes.starts_with("\x89PNG")) return ".png";
  if (bytes.starts_with("\xFF\xD8\xFF")) return ".jpg";
  return std::filesystem::path(uri).extension().string();
}

image::Image read_texture_image(const Loader& loader, int index, Content content) {
  const tinygltf::Image& source = at(loader, loader.model.images, index, "image");
  const std::string name = fmt::format("{}: image {}", loader.where, index);
  if (source.bufferView < 0 && source.image.empty()) {
    throw InputError(fmt::format("{}: cannot find the file {}", name, one_line(source.uri)));
  }
  const std::string_view bytes =
      source.bufferView >= 0
          ? view_bytes(loader.model, source.bufferView, name)
          : std::string_view(reinterpret_cast<const char*>(source.image.data()), source.image.size());
  const std::string hinted = name + one_line(extension_of(bytes, source.uri));
  return content == Content::normals ? image::read_data_image(bytes, hinted)
                                     : image::read_image(bytes, hinted);
}

Wrap to_wrap(int mode) {
  if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::kClamp;
  return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::kMirror : Wrap::kRepeat;
}

int add_texture(Loader& loader, int index, Content content) {
  const tinygltf::Texture& source = at(loader, loader.model.textures, index, "texture");
  std::pair wrap(Wrap::kRepeat, Wrap::kRepeat);
  if (source.sampler >= 0) {
    const tinygltf::Sampler& sampler = at(loader, loader.model.samplers, source.sampler, "sampler");
    wrap = {to_wrap(sampler.wrapS), to_wrap(sampler.wrapT)};
  }
  const auto next = static_cast<int>(loader.scene.textures.size());
  const auto [entry, is_new] =
      loader.textures.try_emplace({source.source, wrap.first, wrap.second, content}, next);
  if (is_new) {
    loader.scene.textures.push_back(
        {read_texture_image(loader, source.source, content), wrap.first, wrap.second});
  }
  return entry->second;
}

double emissive_strength(const tinygltf::Material& material) {
  const auto extension = material.extensions.find("KHR_materials_emissive_strength");
  if (extension == material.extensions.end() || !extension->second.Has("emissiveStrength")) return 1.0;
  const tinygltf::Value& strength = extension->second.Get("emissiveStrength");
  return strength.IsNumber() ? strength.GetNumberAsDouble() : 1.0;
}

template <class TextureInfo>
void refuse_transform(const Loader& loader, const TextureInfo& texture, std::size_t material) {
  if (!texture.extensions.contains("KHR_texture_transform")) return;
  refuse(loader, fmt::format("material {} ({}) uses KHR_texture_transform, which is not supported", material,
                             one_line(loader.model.materials[material].name)));
}

Material to_material(Loader& loader, std::size_t index) {
  const tinygltf::Material& source = loader.model.materials[index];
  const auto& pbr = source.pbrMetallicRoughness;
  Material material;
  material.name = source.name;
  material.albedo = to_rgb(pbr.baseColorFactor, Rgb(1.0F));
  material.is_double_sided = source.doubleSided;
  const auto strength = emissive_strength(source);
  if (source.emissiveFactor.size() >= 3) {
    const RgbD factor(source.emissiveFactor[0], source.emissiveFactor[1], source.emissiveFactor[2]);
    material.emission = Rgb(factor * strength);
  }
  if (source.emissiveTexture.index >= 0 && !is_black(material.emission)) {
    refuse(loader, fmt::format("material {} ({}) has an emissive texture, which is not supported", index,
                               one_line(source.name)));
  }
  if (pbr.baseColorTexture.index >= 0) {
    refuse_transform(loader, pbr.baseColorTexture, index);
    material.albedo_texture = add_texture(loader, pbr.baseColorTexture.index, Content::colour);
  }
  if (source.normalTexture.index >= 0) {
    refuse_transform(loader, source.normalTexture, index);
    if (material.albedo_texture >= 0 && source.normalTexture.texCoord != pbr.baseColorTexture.texCoord) {
      refuse(loader, fmt::format("material {} ({}) has its normal map on texture coordinates {} and its "
                                 "colours on {}: one set is supported",
                                 index, one_line(source.name), source.normalTexture.texCoord,
                                 pbr.baseColorTexture.texCoord));
    }
    material.normal_texture = add_texture(loader, source.normalTexture.index, Content::normals);
    material.normal_scale = static_cast<float>(source.normalTexture.scale);
  }
  return material;
}

// What glTF says of a primitive without a material: every property has its default, so the base colour is 1.
std::uint32_t default_material(Loader& loader) {
  if (!loader.default_material) {
    loader.default_material = static_cast<std::uint32_t>(loader.scene.materials.size());
    Material material;
    material.name = "default";
    material.albedo = Rgb(1.0F);
    loader.scene.materials.push_back(material);
  }
  return *loader.default_material;
}

// ---------------------------------------------------------------- nodes

Mat4 local_transform(const Loader& loader, const tinygltf::Node& node, int index) {
  const auto wrong_size = [](const std::vector<double>& numbers, std::size_t size) {
    return !numbers.empty() && numbers.size() != size;
  };
  if (wrong_size(node.matrix, 16) || wrong_size(node.translation, 3) || wrong_size(node.rotation, 4) ||
      wrong_size(node.scale, 3)) {
    refuse(loader, fmt::format("node {}: a transform has the wrong number of components", index));
  }
  Mat4 result(1.0);
  if (!node.matrix.empty()) {
    for (int i = 0; i < 16; ++i) result[i / 4][i % 4] = node.matrix[static_cast<std::size_t>(i)];
    return result;
  }
  if (!node.rotation.empty()) {
    const glm::dquat q(node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]);
    if (!(glm::length(q) > 0.0)) refuse(loader, fmt::format("node {}: rotation is zero", index));
    result = glm::mat4_cast(glm::normalize(q));
  }
  for (int c = 0; c < 3; ++c) {
    if (!node.scale.empty()) result[c] *= node.scale[static_cast<std::size_t>(c)];
    if (!node.translation.empty()) result[3][c] = node.translation[static_cast<std::size_t>(c)];
  }
  return result;
}

// det(M) times the inverse transpose of the upper 3x3: it carries normals, also of flattened meshes.
glm::dmat3 cofactors(const Mat4& m) {
  const Vec3d x(m[0]);
  const Vec3d y(m[1]);
  const Vec3d z(m[2]);
  return {glm::cross(y, z), glm::cross(z, x), glm::cross(x, y)};
}

bool is_mirroring(const Mat4& m) {
  return glm::determinant(glm::dmat3(m)) < 0.0;
}

// ---------------------------------------------------------------- primitives

// The accessors that make a primitive's vertices; primitives of a node with the same ones share vertices.
struct Attributes {
  int position = -1;
  int normal = -1;
  int tangent = -1;
  int texcoord = -1;
  int color = -1;

  auto operator<=>(const Attributes&) const = default;
};

struct VertexBlock {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

int attribute(const tinygltf::Primitive& primitive, const std::string& name) {
  const auto found = primitive.attributes.find(name);
  return found == primitive.attributes.end() ? -1 : found->second;
}

Attributes attributes_of(const Loader& loader, const tinygltf::Primitive& primitive) {
  int set = 0;
  int tangent = -1;
  if (primitive.material >= 0) {
    const tinygltf::Material& material = at(loader, loader.model.materials, primitive.material, "material");
    const auto& colours = material.pbrMetallicRoughness.baseColorTexture;
    if (colours.index >= 0) {
      set = colours.texCoord;
    } else if (material.normalTexture.index >= 0) {
      set = material.normalTexture.texCoord;
    }
    if (material.normalTexture.index >= 0) tangent = attribute(primitive, "TANGENT");
  }
  return {attribute(primitive, "POSITION"), attribute(primitive, "NORMAL"), tangent,
          attribute(primitive, fmt::format("TEXCOORD_{}", set)), attribute(primitive, "COLOR_0")};
}

AccessorValues read_attribute(const Loader& loader, int accessor, std::span<const std::size_t> allowed,
                              std::size_t count, const std::string& where) {
  AccessorValues result = read_floats(loader.model, accessor, allowed, where);
  if (result.count != count) {
    throw InputError(
        fmt::format("{}: an attribute has {} elements, POSITION has {}", where, result.count, count));
  }
  return result;
}

constexpr std::array<std::size_t, 1> kTwo = {2};
constexpr std::array<std::size_t, 1> kThree = {3};
constexpr std::array<std::size_t, 1> kFour = {4};
constexpr std::array<std::size_t, 2> kThreeOrFour = {3, 4};

Vec3 vec3_at(const AccessorValues& values, std::size_t i) {
  const float* v = values.values.data() + i * values.components;
  return {v[0], v[1], v[2]};
}

void append_positions(Loader& loader, const AccessorValues& positions, const Mat4& transform) {
  for (std::size_t i = 0; i < positions.count; ++i) {
    loader.scene.positions.emplace_back(Vec3d(transform * glm::dvec4(Vec3d(vec3_at(positions, i)), 1.0)));
  }
}

// The transformed normal has unit length if the one in the file has; where no transform changes it, no bit
// does.
void append_normals(Loader& loader, const AccessorValues& normals, const Mat4& transform) {
  const glm::dmat3 carry = cofactors(transform) * (is_mirroring(transform) ? -1.0 : 1.0);
  const bool is_unchanged = glm::dmat3(transform) == glm::dmat3(1.0);
  for (std::size_t i = 0; i < normals.count; ++i) {
    const Vec3 normal = vec3_at(normals, i);
    const Vec3d carried = carry * Vec3d(normal);
    const bool is_usable = !is_unchanged && glm::length(carried) > 0.0;
    loader.scene.normals.push_back(is_usable ? Vec3(glm::normalize(carried)) : normal);
    loader.has_normal.push_back(is_unchanged || is_usable ? 1 : 0);
  }
}

// The tangent is carried like the surface; where that mirrors, normal x tangent turns over and so does the sign.
void append_tangents(Loader& loader, const AccessorValues& tangents, const Mat4& transform) {
  const bool is_unchanged = glm::dmat3(transform) == glm::dmat3(1.0);
  const float flip = is_mirroring(transform) ? -1.0F : 1.0F;
  for (std::size_t i = 0; i < tangents.count; ++i) {
    const float* t = tangents.values.data() + 4 * i;
    Vec3 along(t[0], t[1], t[2]);
    if (!is_unchanged) {
      const Vec3d carried = glm::dmat3(transform) * Vec3d(along);
      along = glm::length(carried) > 0.0 ? Vec3(glm::normalize(carried)) : Vec3(carried);
    }
    loader.scene.tangents.emplace_back(along, flip * t[3]);
  }
}

void append_optional(Loader& loader, const Attributes& attributes, std::size_t count, const Mat4& transform,
                     const std::string& where) {
  Scene& scene = loader.scene;
  if (attributes.texcoord >= 0) {
    const AccessorValues values = read_attribute(loader, attributes.texcoord, kTwo, count, where);
    scene.texcoords.resize(scene.positions.size() - count, Vec2(0.0F));
    for (std::size_t i = 0; i < count; ++i) {
      scene.texcoords.emplace_back(values.values[2 * i], values.values[2 * i + 1]);
    }
  }
  if (attributes.tangent >= 0 && attributes.normal >= 0) {
    scene.tangents.resize(scene.positions.size() - count, glm::vec4(0.0F));
    append_tangents(loader, read_attribute(loader, attributes.tangent, kFour, count, where), transform);
  }
  if (attributes.color >= 0) {
    const AccessorValues values = read_attribute(loader, attributes.color, kThreeOrFour, count, where);
    scene.vertex_colors.resize(scene.positions.size() - count, Rgb(1.0F));
    for (std::size_t i = 0; i < count; ++i) scene.vertex_colors.push_back(vec3_at(values, i));
  }
}

VertexBlock append_vertices(Loader& loader, const Attributes& attributes, const Mat4& transform,
                            const std::string& where) {
  const AccessorValues positions = read_floats(loader.model, attributes.position, kThree, where);
  const std::size_t first = loader.scene.positions.size();
  if (first + positions.count > kMostElements) {
    throw InputError(fmt::format("{}: more than {} vertices", where, kMostElements));
  }
  append_positions(loader, positions, transform);
  if (attributes.normal >= 0) {
    append_normals(loader, read_attribute(loader, attributes.normal, kThree, positions.count, where),
                   transform);
  } else {
    loader.scene.normals.resize(first + positions.count, Vec3(0.0F));
    loader.has_normal.resize(first + positions.count, 0);
  }
  append_optional(loader, attributes, positions.count, transform, where);
  return {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(positions.count)};
}

std::vector<std::uint32_t> primitive_indices(const Loader& loader, const tinygltf::Primitive& primitive,
                                             const VertexBlock& block, const std::string& where) {
  std::vector<std::uint32_t> indices;
  if (primitive.indices < 0) {
    for (std::uint32_t i = 0; i < block.count; ++i) indices.push_back(i);
    return indices;
  }
  indices = read_indices(loader.model, primitive.indices, where);
  for (const std::uint32_t index : indices) {
    if (index >= block.count) {
      throw InputError(
          fmt::format("{}: index {} is out of range, there are {} vertices", where, index, block.count));
    }
  }
  return indices;
}

// Lists, strips and fans as in glTF 2.0, section 3.7.2.1.
std::vector<glm::uvec3> assemble(const std::vector<std::uint32_t>& v, int mode, const std::string& where) {
  std::vector<glm::uvec3> triangles;
  if (mode == TINYGLTF_MODE_TRIANGLES) {
    if (v.size() % 3 != 0) {
      throw InputError(fmt::format("{}: {} indices are no multiple of 3", where, v.size()));
    }
    for (std::size_t i = 0; i < v.size(); i += 3) triangles.emplace_back(v[i], v[i + 1], v[i + 2]);
    return triangles;
  }
  for (std::size_t i = 0; i + 2 < v.size(); ++i) {
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
      triangles.emplace_back(v[i + 1], v[i + 2], v[0]);
    } else {
      triangles.emplace_back(v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]);
    }
  }
  return triangles;
}

bool has_triangles(const tinygltf::Primitive& primitive) {
  return primitive.mode == TINYGLTF_MODE_TRIANGLES || primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP ||
         primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN;
}

void append_primitive(Loader& loader, const tinygltf::Primitive& primitive, const VertexBlock& block,
                      bool flips_winding, const std::string& where) {
  const std::uint32_t material =
      primitive.material >= 0 ? static_cast<std::uint32_t>(primitive.material) : default_material(loader);
  Scene& scene = loader.scene;
  for (glm::uvec3 corners :
       assemble(primitive_indices(loader, primitive, block, where), primitive.mode, where)) {
    if (flips_winding) std::swap(corners.y, corners.z);
    scene.triangles.push_back(corners + block.first);
    scene.triangle_materials.push_back(material);
  }
  if (scene.triangles.size() > kMostElements) {
    throw InputError(fmt::format("{}: more than {} triangles", where, kMostElements));
  }
}

void append_mesh(Loader& loader, int index, const Mat4& transform) {
  const tinygltf::Mesh& mesh = at(loader, loader.model.meshes, index, "mesh");
  std::map<Attributes, VertexBlock> blocks;
  for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
    const tinygltf::Primitive& primitive = mesh.primitives[i];
    if (!has_triangles(primitive)) continue;
    const std::string where = fmt::format("{}: mesh {} primitive {}", loader.where, index, i);
    const Attributes attributes = attributes_of(loader, primitive);
    if (attributes.position < 0) throw InputError(where + ": has no POSITION");
    const auto [block, is_new] = blocks.try_emplace(attributes);
    if (is_new) block->second = append_vertices(loader, attributes, transform, where);
    append_primitive(loader, primitive, block->second, is_mirroring(transform), where);
  }
}

// ---------------------------------------------------------------- cameras and lights

std::string named(const std::string& node_name, const std::string& own_name, const char* kind,
                  std::size_t count) {
  if (!node_name.empty()) return node_name;
  return own_name.empty() ? fmt::format("{}{}", kind, count) : own_name;
}

Vec3 direction_of(const Loader& loader, const Mat4& transform, Vec3d local, int node) {
  const Vec3d direction = glm::dmat3(transform) * local;
  if (!(glm::length(direction) > 0.0)) {
    refuse(loader, fmt::format("node {}: its transform leaves no direction", node));
  }
  return normalized_once(Vec3(direction));
}

void append_camera(Loader& loader, const tinygltf::Node& node, int node_index, const Mat4& transform) {
  const tinygltf::Camera& source = at(loader, loader.model.cameras, node.camera, "camera");
  if (source.type != "perspective") return;
  Camera camera;
  camera.name = named(node.name, source.name, "camera", loader.scene.cameras.size());
  camera.eye = Vec3(transform[3]);
  camera.forward = direction_of(loader, transform, {0.0, 0.0, -1.0}, node_index);
  camera.up = direction_of(loader, transform, {0.0, 1.0, 0.0}, node_index);
  const Vec3d forward(camera.forward);
  const double cosine = glm::dot(Vec3d(camera.up), forward);
  if (std::abs(cosine) > 1e-6) {  // a sheared node
    camera.up = Vec3(glm::normalize(Vec3d(camera.up) - cosine * forward));
  }
  camera.vertical_fov_rad = static_cast<float>(source.perspective.yfov);
  loader.scene.cameras.push_back(camera);
}

void append_light(Loader& loader, int light_index, int node_index, const Mat4& transform) {
  const tinygltf::Light& source = at(loader, loader.model.lights, light_index, "light");
  const Rgb power = Rgb(RgbD(to_rgb(source.color, Rgb(1.0F))) * source.intensity);
  const Vec3 position(transform[3]);
  auto& lights = loader.scene.lights;
  if (source.type == "point") {
    lights.emplace_back(light::PointLight{position, power});
    return;
  }
  if (source.type != "spot" && source.type != "directional") {
    refuse(loader, fmt::format("light {} has the unknown type {}", light_index, one_line(source.type)));
  }
  const Vec3 direction = direction_of(loader, transform, {0.0, 0.0, -1.0}, node_index);
  if (source.type == "directional") {
    lights.emplace_back(light::DirectionalLight{direction, power});
  } else {
    lights.emplace_back(light::SpotLight{position, direction, power,
                                         static_cast<float>(source.spot.innerConeAngle),
                                         static_cast<float>(source.spot.outerConeAngle)});
  }
}

std::optional<int> light_of(const tinygltf::Node& node) {
  const auto extension = node.extensions.find("KHR_lights_punctual");
  if (extension == node.extensions.end() || !extension->second.Has("light")) return std::nullopt;
  const tinygltf::Value& index = extension->second.Get("light");
  return index.IsInt() ? index.GetNumberAsInt() : -1;
}

// ---------------------------------------------------------------- the scene's nodes

std::vector<int> root_nodes(const Loader& loader) {
  const tinygltf::Model& model = loader.model;
  if (model.defaultScene >= 0 || !model.scenes.empty()) {
    return at(loader, model.scenes, std::max(model.defaultScene, 0), "scene").nodes;
  }
  std::vector<std::uint8_t> is_child(model.nodes.size(), 0);
  for (const tinygltf::Node& node : model.nodes) {
    for (const int child : node.children) {
      if (child >= 0 && static_cast<std::size_t>(child) < is_child.size()) {
        is_child[static_cast<std::size_t>(child)] = 1;
      }
    }
  }
  std::vector<int> roots;
  for (std::size_t i = 0; i < is_child.size(); ++i) {
    if (is_child[i] == 0) roots.push_back(static_cast<int>(i));
  }
  return roots;
}

void append_node(Loader& loader, int index, const Mat4& transform) {
  const tinygltf::Node& node = at(loader, loader.model.nodes, index, "node");
  if (node.mesh >= 0) append_mesh(loader, node.mesh, transform);
  if (node.camera >= 0) append_camera(loader, node, index, transform);
  if (const std::optional<int> light = light_of(node)) append_light(loader, *light, index, transform);
}

// Depth first, children in the file's order. A node that is met twice is no tree: it has two parents or is
// its own ancestor.
void append_nodes(Loader& loader) {
  struct Pending {
    int index;
    Mat4 parent;
  };
  std::vector<Pending> stack;
  const auto push = [&](const std::vector<int>& nodes, const Mat4& parent) {
    for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) stack.push_back({*node, parent});
  };
  push(root_nodes(loader), Mat4(1.0));
  std::vector<std::uint8_t> is_visited(loader.model.nodes.size(), 0);
  while (!stack.empty()) {
    const Pending pending = stack.back();
    stack.pop_back();
    const tinygltf::Node& node = at(loader, loader.model.nodes, pending.index, "node");
    std::uint8_t& visited = is_visited[static_cast<std::size_t>(pending.index)];
    if (visited != 0) {
      refuse(loader, fmt::format("node {} is reached twice: nodes do not form a tree", pending.index));
    }
    visited = 1;
    const Mat4 transform = pending.parent * local_transform(loader, node, pending.index);
    append_node(loader, pending.index, transform);
    push(node.children, transform);
  }
}

}  // namespace

Scene load_gltf(const std::filesystem::path& path, const LoadOptions& options) {
  tinygltf::Model model;
  parse_gltf(path, model);
  Loader loader{model, path.string(), {}, {}, {}, {}};
  loader.scene.name = path.stem().string();
  for (std::size_t i = 0; i < model.materials.size(); ++i) {
    loader.scene.materials.push_back(to_material(loader, i));
  }
  append_nodes(loader);
  Scene& scene = loader.scene;
  if (!scene.texcoords.empty()) scene.texcoords.resize(scene.positions.size(), Vec2(0.0F));
  if (!scene.vertex_colors.empty()) scene.vertex_colors.resize(scene.positions.size(), Rgb(1.0F));
  return finish_loading(std::move(scene), std::move(loader.has_normal), options, loader.where);
}

}  // namespace plumbline::scene
