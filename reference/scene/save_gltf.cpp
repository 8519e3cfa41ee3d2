#include "reference/scene/save_gltf.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/image/file.hpp"
#include "reference/scene/glb.hpp"
#include "reference/scene/gltf_model.hpp"
#include "reference/scene/text.hpp"

namespace plumbline::scene {
namespace {

using Json = nlohmann::json;

constexpr int kFloat = 5126;
constexpr int kUnsignedInt = 5125;
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;
constexpr int kDeepestNesting = 200;

struct Writer {
  Json root;
  std::string binary;
};

std::size_t append(Json& array, Json item) {
  array.push_back(std::move(item));
  return array.size() - 1;
}

std::size_t add_view(Writer& writer, std::string_view bytes, int target, std::size_t alignment) {
  while (writer.binary.size() % alignment != 0) writer.binary.push_back('\0');
  Json view = {{"buffer", 0}, {"byteOffset", writer.binary.size()}, {"byteLength", bytes.size()}};
  if (target != 0) view["target"] = target;
  writer.binary += bytes;
  return append(writer.root["bufferViews"], std::move(view));
}

template <class Value>
std::string_view bytes_of(const std::vector<Value>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)};
}

template <class Value>
std::size_t add_accessor(Writer& writer, const std::vector<Value>& values, const char* type, int component,
                         int target) {
  const std::size_t view = add_view(writer, bytes_of(values), target, 4);
  return append(
      writer.root["accessors"],
      {{"bufferView", view}, {"componentType", component}, {"count", values.size()}, {"type", type}});
}

Json to_json(Vec3 v) {
  return Json::array({static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)});
}

// A colour as factor x strength, the factor in [0, 1] as glTF asks. The strength is a power of two, so that
// the product is the colour again, bit for bit.
struct Scaled {
  Rgb factor;
  double strength;
};

Scaled scaled(Rgb color) {
  const float largest = max_component(color);
  if (largest <= 1.0F) return {color, 1.0};
  int exponent = 0;
  (void)std::frexp(largest, &exponent);
  const double strength = std::ldexp(1.0, exponent);
  return {Rgb(RgbD(color) / strength), strength};
}

// ---------------------------------------------------------------- mesh

Json add_attributes(Writer& writer, const Scene& scene) {
  Vec3 low = scene.positions.front();
  Vec3 high = low;
  for (const Vec3& p : scene.positions) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  Json attributes;
  const std::size_t position = add_accessor(writer, scene.positions, "VEC3", kFloat, kArrayBuffer);
  writer.root["accessors"][position]["min"] = to_json(low);
  writer.root["accessors"][position]["max"] = to_json(high);
  attributes["POSITION"] = position;
  attributes["NORMAL"] = add_accessor(writer, scene.normals, "VEC3", kFloat, kArrayBuffer);
  if (!scene.texcoords.empty()) {
    attributes["TEXCOORD_0"] = add_accessor(writer, scene.texcoords, "VEC2", kFloat, kArrayBuffer);
  }
  if (!scene.tangents.empty()) {
    attributes["TANGENT"] = add_accessor(writer, scene.tangents, "VEC4", kFloat, kArrayBuffer);
  }
  if (!scene.vertex_colors.empty()) {
    attributes["COLOR_0"] = add_accessor(writer, scene.vertex_colors, "VEC3", kFloat, kArrayBuffer);
  }
  return attributes;
}

std::vector<std::vector<std::uint32_t>> indices_by_material(const Scene& scene) {
  std::vector<std::vector<std::uint32_t>> result(scene.materials.size());
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    auto& indices = result[scene.triangle_materials[t]];
    for (int k = 0; k < 3; ++k) indices.push_back(scene.triangles[t][k]);
  }
  return result;
}

void add_mesh(Writer& writer, const Scene& scene) {
  const Json attributes = add_attributes(writer, scene);
  Json primitives = Json::array();
  const auto by_material = indices_by_material(scene);
  for (std::size_t material = 0; material < by_material.size(); ++material) {
    if (by_material[material].empty()) continue;
    const std::size_t indices =
        add_accessor(writer, by_material[material], "SCALAR", kUnsignedInt, kElementArrayBuffer);
    primitives.push_back({{"attributes", attributes}, {"indices", indices}, {"material", material}});
  }
  writer.root["meshes"] = Json::array({{{"name", scene.name}, {"primitives", std::move(primitives)}}});
  writer.root["nodes"] = Json::array({{{"name", scene.name}, {"mesh", 0}}});
}

// ---------------------------------------------------------------- materials

void use_extension(Writer& writer, const std::string& name) {
  Json& used = writer.root["extensionsUsed"];
  if (std::find(used.begin(), used.end(), name) == used.end()) used.push_back(name);
}

void add_material(Writer& writer, const Material& material) {
  const Scaled emission = scaled(material.emission);
  Json factor = to_json(material.albedo);
  factor.push_back(1.0);
  Json pbr = {{"baseColorFactor", factor}, {"metallicFactor", 0.0}, {"roughnessFactor", 1.0}};
  if (material.albedo_texture >= 0) pbr["baseColorTexture"] = {{"index", material.albedo_texture}};
  Json result = {{"name", material.name},
                 {"pbrMetallicRoughness", std::move(pbr)},
                 {"emissiveFactor", to_json(emission.factor)},
                 {"doubleSided", material.is_double_sided}};
  if (material.normal_texture >= 0) {
    result["normalTexture"] = {{"index", material.normal_texture},
                               {"scale", static_cast<double>(material.normal_scale)}};
  }
  if (emission.strength != 1.0) {
    constexpr const char* kStrength = "KHR_materials_emissive_strength";
    result["extensions"][kStrength] = {{"emissiveStrength", emission.strength}};
    use_extension(writer, kStrength);
  }
  writer.root["materials"].push_back(std::move(result));
}

int wrap_mode(Wrap wrap) {
  if (wrap == Wrap::kClamp) return 33071;
  return wrap == Wrap::kMirror ? 33648 : 10497;
}

// Eight bits a channel, so that a normal map of more is rounded, by 0.4 degrees at most at scale 1.
void add_texture(Writer& writer, const Texture& texture, bool is_normal_map) {
  const std::string png =
      image::encode_png(is_normal_map ? image::quantise_data(texture.image) : image::tone_map(texture.image));
  const std::size_t view = add_view(writer, png, 0, 4);
  const std::size_t source = append(writer.root["images"], {{"bufferView", view}, {"mimeType", "image/png"}});
  const std::size_t sampler = append(
      writer.root["samplers"],
      {{"magFilter", 9729}, {"wrapS", wrap_mode(texture.wrap_u)}, {"wrapT", wrap_mode(texture.wrap_v)}});
  writer.root["textures"].push_back({{"source", source}, {"sampler", sampler}});
}

// ---------------------------------------------------------------- cameras and lights

// Column-major: local +X, +Y, +Z and the origin.
Json pose(Vec3 right, Vec3 up, Vec3 back, Vec3 position) {
  Json matrix = Json::array();
  for (const Vec3& column : {right, up, back, position}) {
    for (int c = 0; c < 3; ++c) matrix.push_back(static_cast<double>(column[c]));
    matrix.push_back(matrix.size() == 15 ? 1.0 : 0.0);
  }
  return matrix;
}

void add_camera(Writer& writer, const Camera& camera) {
  const std::size_t index =
      append(writer.root["cameras"],
             {{"name", camera.name},
              {"type", "perspective"},
              {"perspective", {{"yfov", static_cast<double>(camera.vertical_fov_rad)}, {"znear", 0.001}}}});
  const Vec3 right(glm::normalize(glm::cross(Vec3d(camera.forward), Vec3d(camera.up))));
  writer.root["nodes"].push_back({{"name", camera.name},
                                  {"camera", index},
                                  {"matrix", pose(right, camera.up, -camera.forward, camera.eye)}});
}

Json light_pose(Vec3 position, Vec3 direction) {
  const Vec3d back = -Vec3d(direction);
  const Vec3d helper = std::abs(back.y) < 0.9 ? Vec3d(0.0, 1.0, 0.0) : Vec3d(1.0, 0.0, 0.0);
  const Vec3d right = glm::normalize(glm::cross(helper, back));
  return pose(Vec3(right), Vec3(glm::normalize(glm::cross(back, right))), -direction, position);
}

struct LightParts {
  Json description;
  Json matrix;
};

Json light_json(const char* type, Rgb power) {
  const Scaled color = scaled(power);
  return {{"type", type}, {"color", to_json(color.factor)}, {"intensity", color.strength}};
}

struct ToParts {
  LightParts operator()(const light::PointLight& light) const {
    return {light_json("point", light.radiant_intensity), light_pose(light.position, {0.0F, 0.0F, -1.0F})};
  }
  LightParts operator()(const light::SpotLight& light) const {
    Json description = light_json("spot", light.radiant_intensity);
    // float(pi / 2) lies above the largest angle that glTF has
    description["spot"] = {
        {"innerConeAngle", static_cast<double>(light.inner_angle_rad)},
        {"outerConeAngle", std::min(static_cast<double>(light.outer_angle_rad), 0.5 * kPi)}};
    return {std::move(description), light_pose(light.position, light.direction)};
  }
  LightParts operator()(const light::DirectionalLight& light) const {
    return {light_json("directional", light.irradiance), light_pose(Vec3(0.0F), light.direction)};
  }
};

void add_light(Writer& writer, const light::PunctualLight& light) {
  constexpr const char* kLights = "KHR_lights_punctual";
  LightParts parts = std::visit(ToParts{}, light);
  const std::size_t index =
      append(writer.root["extensions"][kLights]["lights"], std::move(parts.description));
  use_extension(writer, kLights);
  writer.root["nodes"].push_back(
      {{"matrix", std::move(parts.matrix)}, {"extensions", {{kLights, {{"light", index}}}}}});
}

// ---------------------------------------------------------------- extensions

void add_extension(Writer& writer, const GlbExtension& extension) {
  if (!extension.json.is_object() || extension.json.contains("bufferView")) {
    throw InputError(
        fmt::format("extension {}: its JSON is not an object without \"bufferView\"", extension.name));
  }
  Json& slot = writer.root["extensions"][extension.name];
  if (!slot.is_null()) throw InputError(fmt::format("extension {}: is there twice", extension.name));
  slot = extension.json;
  if (!extension.bytes.empty()) slot["bufferView"] = add_view(writer, extension.bytes, 0, 8);
  use_extension(writer, extension.name);
}

std::string file_bytes(Writer writer) {
  writer.root["buffers"] = Json::array({{{"byteLength", writer.binary.size()}}});
  // Names come from files and may be anything; bytes that are not UTF-8 become U+FFFD.
  return join_glb(writer.root.dump(-1, ' ', false, Json::error_handler_t::replace), std::move(writer.binary));
}

// ---------------------------------------------------------------- reading back

std::size_t member(const Json& object, const char* name, std::optional<std::size_t> otherwise,
                   const std::string& where) {
  const auto found = object.find(name);
  if (found == object.end() && otherwise) return *otherwise;
  if (found == object.end() || !found->is_number_unsigned()) {
    throw InputError(fmt::format("{}: \"{}\" is missing or not a whole number", where, name));
  }
  return found->get<std::size_t>();
}

std::string_view extension_bytes(const Json& root, std::size_t index, std::string_view binary,
                                 const std::string& where) {
  const auto views = root.find("bufferViews");
  if (views == root.end() || !views->is_array() || index >= views->size() || !(*views)[index].is_object()) {
    throw InputError(fmt::format("{}: buffer view {} does not exist", where, index));
  }
  const Json& view = (*views)[index];
  if (member(view, "buffer", {}, where) != 0) {
    throw InputError(fmt::format("{}: buffer view {} is not in the binary chunk", where, index));
  }
  const std::size_t offset = member(view, "byteOffset", 0, where);
  const std::size_t length = member(view, "byteLength", {}, where);
  if (offset > binary.size() || length > binary.size() - offset) {
    throw InputError(
        fmt::format("{}: buffer view {} ({} bytes at byte {}) exceeds the binary chunk of {} bytes", where,
                    index, length, offset, binary.size()));
  }
  return binary.substr(offset, length);
}

Json parse_json(std::string_view text, const std::string& where) {
  if (nesting_depth(text) > kDeepestNesting) throw InputError(where + ": JSON is nested too deeply");
  Json root;
  try {
    root = Json::parse(text);
  } catch (const Json::exception& error) {
    throw InputError(fmt::format("{}: cannot read as glTF: {}", where, one_line(error.what())));
  }
  if (!root.is_object()) throw InputError(where + ": cannot read as glTF: the JSON is not an object");
  return root;
}

}  // namespace

std::string to_glb(const Scene& scene, const std::vector<GlbExtension>& extensions) {
  validate(scene, "scene " + scene.name);
  refuse_primitives(scene, "glTF of scene " + scene.name);
  Writer writer;
  writer.root["asset"] = {{"version", "2.0"}, {"generator", "Plumbline " PLUMBLINE_VERSION}};
  add_mesh(writer, scene);
  for (const Material& material : scene.materials) add_material(writer, material);
  for (std::size_t i = 0; i < scene.textures.size(); ++i) {
    const bool is_normal_map =
        std::any_of(scene.materials.begin(), scene.materials.end(),
                    [i](const Material& material) { return material.normal_texture == static_cast<int>(i); });
    add_texture(writer, scene.textures[i], is_normal_map);
  }
  for (const Camera& camera : scene.cameras) add_camera(writer, camera);
  for (const light::PunctualLight& light : scene.lights) add_light(writer, light);
  for (const GlbExtension& extension : extensions) add_extension(writer, extension);
  Json nodes = Json::array();
  for (std::size_t i = 0; i < writer.root["nodes"].size(); ++i) nodes.push_back(i);
  writer.root["scenes"] = Json::array({{{"nodes", std::move(nodes)}}});
  writer.root["scene"] = 0;
  return file_bytes(std::move(writer));
}

void save_glb(const Scene& scene, const std::filesystem::path& path,
              const std::vector<GlbExtension>& extensions) {
  write_text_atomically(path, to_glb(scene, extensions));
}

std::optional<GlbExtension> read_glb_extension(const std::filesystem::path& path, std::string_view name) {
  const std::string where = path.string();
  const std::string bytes = read_file(path);
  const GlbChunks chunks = split_glb(bytes, where);
  const Json root = parse_json(chunks.json, where);
  const auto extensions = root.find("extensions");
  if (extensions == root.end() || !extensions->is_object()) return std::nullopt;
  const auto found = extensions->find(std::string(name));
  if (found == extensions->end()) return std::nullopt;
  if (!found->is_object()) throw InputError(fmt::format("{}: extension {} is not an object", where, name));
  GlbExtension result{std::string(name), *found, {}};
  if (found->contains("bufferView")) {
    const std::string here = fmt::format("{}: extension {}", where, name);
    result.bytes = extension_bytes(root, member(*found, "bufferView", {}, here), chunks.binary, here);
    result.json.erase("bufferView");
  }
  return result;
}

}  // namespace plumbline::scene
