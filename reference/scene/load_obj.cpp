#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/image/file.hpp"
#include "reference/scene/finish.hpp"
#include "reference/scene/load.hpp"
#include "reference/scene/polygon.hpp"
#include "reference/scene/text.hpp"

// Geometry and colours are read here, because tinyobjloader takes "v 1 x" for zero and drops a face whose
// index is out of range; the options in front of a texture's name are left to it.
namespace plumbline::scene {
namespace {

constexpr std::int64_t kNone = -1;

struct Reference {
  std::int64_t position = kNone;
  std::int64_t texcoord = kNone;
  std::int64_t normal = kNone;
};

// One (v, vt, vn) tuple of the file and the vertex it became; tuples with the same v form a list.
struct Vertex {
  std::int64_t texcoord = kNone;
  std::int64_t normal = kNone;
  std::uint32_t next = 0;  // 0 ends the list: vertex 0 is never a copy
  bool is_used = false;
};

struct Loader {
  std::filesystem::path path;
  std::string where;  // file and line
  std::vector<Vec3> positions;
  std::vector<Rgb> colors;  // as long as positions, or shorter when the rest has none
  std::vector<Vec2> texcoords;
  std::vector<Vec3> normals;
  std::vector<std::array<Reference, 3>> triangles;
  Scene scene;  // materials, textures, triangle_materials
  std::map<std::string, std::uint32_t, std::less<>> material_index;
  std::map<std::string, int> texture_index;
  std::optional<std::uint32_t> material;  // of the faces that follow
};

using Words = std::vector<std::string_view>;

[[noreturn]] void refuse(const Loader& loader, const std::string& what) {
  throw InputError(loader.where + ": " + what);
}

// Numbers first .. first+count-1 of a line.
Vec3 numbers(const Loader& loader, const Words& words, std::size_t first, std::size_t count) {
  if (words.size() < first + count) {
    refuse(loader, fmt::format("\"{}\" has {} numbers, expected {}", words[0], words.size() - 1, count));
  }
  Vec3 result(0.0F);
  for (std::size_t i = 0; i < count; ++i) {
    const std::optional<double> value = parse_number(words[first + i]);
    if (!value) refuse(loader, fmt::format("\"{}\" is not a number", one_line(words[first + i])));
    result[static_cast<int>(i)] = static_cast<float>(*value);
  }
  return result;
}

// Everything after the keyword, blanks in between included: names may contain them.
std::string_view argument(const Words& words) {
  if (words.size() < 2) return {};
  const std::string_view last = words.back();
  return {words[1].data(), static_cast<std::size_t>(last.data() + last.size() - words[1].data())};
}

// ---------------------------------------------------------------- materials

// `options_and_name` is what follows "map_Kd": "-clamp on brick.png".
int add_texture(Loader& loader, const std::filesystem::path& folder, std::string_view options_and_name) {
  tinyobj::texture_option_t option{};
  option.scale[0] = option.scale[1] = 1.0F;
  std::string name;
  if (!tinyobj::ParseTextureNameAndOption(&name, &option, std::string(options_and_name).c_str())) {
    refuse(loader, "map_Kd names no file");
  }
  if (option.scale[0] != 1.0F || option.scale[1] != 1.0F || option.origin_offset[0] != 0.0F ||
      option.origin_offset[1] != 0.0F) {
    refuse(loader, "map_Kd has the option -s or -o, which is not supported");
  }
  std::replace(name.begin(), name.end(), '\\', '/');
  const Wrap wrap = option.clamp ? Wrap::kClamp : Wrap::kRepeat;
  const auto next = static_cast<int>(loader.scene.textures.size());
  const auto [entry, is_new] = loader.texture_index.try_emplace(name + (option.clamp ? "|clamp" : ""), next);
  if (is_new) {
    try {
      loader.scene.textures.push_back({image::read_image(folder / name), wrap, wrap});
    } catch (const InputError& error) {
      refuse(loader, error.what());
    }
  }
  return entry->second;
}

void read_material_line(Loader& loader, const std::filesystem::path& folder, const Words& words) {
  if (words[0] == "newmtl") {
    const std::string name(argument(words));
    loader.material_index[name] = static_cast<std::uint32_t>(loader.scene.materials.size());
    loader.scene.materials.push_back({});
    loader.scene.materials.back().name = name;
    return;
  }
  if (loader.scene.materials.empty()) return;
  Material& material = loader.scene.materials.back();
  if (words[0] == "Kd") {
    material.albedo = numbers(loader, words, 1, 3);
  } else if (words[0] == "Ke") {
    material.emission = numbers(loader, words, 1, 3);
  } else if (words[0] == "map_Kd") {
    material.albedo_texture = add_texture(loader, folder, argument(words));
  } else if (words[0] == "map_Ke") {
    refuse(loader, "an emissive texture (map_Ke) is not supported");
  }
}

// A file that is not there leaves the default material: OBJ files often travel alone.
bool read_materials(Loader& loader, std::string_view name) {
  const std::filesystem::path path = loader.path.parent_path() / name;
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  const std::string text = read_file(path);
  const std::string outer = std::exchange(loader.where, {});
  std::string_view rest = text;
  for (int line_number = 1; const std::optional<std::string_view> line = next_line(rest); ++line_number) {
    loader.where = fmt::format("{}: {}:{}", loader.path.string(), path.filename().string(), line_number);
    const Words words = split_words(*line);
    if (!words.empty()) read_material_line(loader, path.parent_path(), words);
  }
  loader.where = outer;
  return true;
}

// One name with blanks in it, or several names.
void read_material_libraries(Loader& loader, const Words& words) {
  if (read_materials(loader, argument(words))) return;
  for (std::size_t i = 1; i < words.size(); ++i) (void)read_materials(loader, words[i]);
}

// An unknown name makes a default material of that name; faces in front of any "usemtl" get one too.
std::uint32_t find_material(Loader& loader, std::string_view name) {
  const auto found = loader.material_index.find(name);
  if (found != loader.material_index.end()) return found->second;
  const auto index = static_cast<std::uint32_t>(loader.scene.materials.size());
  loader.scene.materials.push_back({});
  loader.scene.materials.back().name = name;
  loader.material_index.emplace(name, index);
  return index;
}

// ---------------------------------------------------------------- geometry

// 1 is the first element so far, -1 the last one.
std::int64_t resolve(const Loader& loader, std::string_view word, std::size_t count, const char* kind) {
  const std::optional<std::int64_t> index = parse_integer(word);
  if (!index) refuse(loader, fmt::format("\"{}\" is not a {} index", one_line(word), kind));
  const auto size = static_cast<std::int64_t>(count);
  if (*index == 0 || *index > size || *index < -size) {
    refuse(loader, fmt::format("{} index {} is out of range, there are {}", kind, *index, count));
  }
  return *index > 0 ? *index - 1 : size + *index;
}

// v, v/vt, v//vn or v/vt/vn
Reference parse_reference(const Loader& loader, std::string_view word) {
  std::array<std::string_view, 3> parts;
  std::size_t part = 0;
  for (std::size_t begin = 0; begin <= word.size(); ++part) {
    if (part == 3) refuse(loader, fmt::format("\"{}\" is not v/vt/vn", one_line(word)));
    const std::size_t end = std::min(word.find('/', begin), word.size());
    parts[part] = word.substr(begin, end - begin);
    begin = end + 1;
  }
  Reference result;
  result.position = resolve(loader, parts[0], loader.positions.size(), "vertex");
  if (!parts[1].empty()) {
    result.texcoord = resolve(loader, parts[1], loader.texcoords.size(), "texture coordinate");
  }
  if (!parts[2].empty()) result.normal = resolve(loader, parts[2], loader.normals.size(), "normal");
  return result;
}

void read_face(Loader& loader, const Words& words) {
  if (words.size() < 4) refuse(loader, fmt::format("a face has {} corners, expected 3", words.size() - 1));
  std::vector<Reference> corners;
  std::vector<Vec3> places;
  for (std::size_t i = 1; i < words.size(); ++i) {
    corners.push_back(parse_reference(loader, words[i]));
    places.push_back(loader.positions[static_cast<std::size_t>(corners.back().position)]);
  }
  if (!loader.material) loader.material = find_material(loader, "");
  std::vector<glm::uvec3> triangles;
  try {
    triangles = triangulate(places);
  } catch (const InputError& error) {
    refuse(loader, error.what());
  }
  for (const glm::uvec3& t : triangles) {
    loader.triangles.push_back({corners[t.x], corners[t.y], corners[t.z]});
    loader.scene.triangle_materials.push_back(*loader.material);
  }
}

void read_position(Loader& loader, const Words& words) {
  loader.positions.push_back(numbers(loader, words, 1, 3));
  if (words.size() == 7) {  // x y z r g b
    loader.colors.resize(loader.positions.size() - 1, Rgb(1.0F));
    loader.colors.push_back(numbers(loader, words, 4, 3));
  }
}

void read_line(Loader& loader, std::string_view line) {
  const Words words = split_words(line.substr(0, line.find('#')));
  if (words.empty()) return;
  if (words[0] == "v") {
    read_position(loader, words);
  } else if (words[0] == "vt") {
    // OBJ's (0, 0) is the bottom left corner.
    const Vec3 uv = numbers(loader, words, 1, words.size() > 2 ? 2 : 1);
    loader.texcoords.emplace_back(uv.x, 1.0F - uv.y);
  } else if (words[0] == "vn") {
    loader.normals.push_back(numbers(loader, words, 1, 3));
  } else if (words[0] == "f") {
    read_face(loader, words);
  } else if (words[0] == "usemtl") {
    loader.material = find_material(loader, argument(words));
  } else if (words[0] == "mtllib") {
    read_material_libraries(loader, words);
  }
}

void read_lines(Loader& loader, const std::string& text) {
  std::string_view rest = text;
  std::string joined;  // of lines that end in a backslash
  for (std::size_t line_number = 1; const std::optional<std::string_view> line = next_line(rest);
       ++line_number) {
    loader.where = fmt::format("{}:{}", loader.path.string(), line_number);
    if (line->ends_with('\\')) {
      joined += line->substr(0, line->size() - 1);
      joined += ' ';
      continue;
    }
    read_line(loader, joined.empty() ? *line : joined + std::string(*line));
    joined.clear();
    if (loader.positions.size() > kMostElements || loader.triangles.size() > kMostElements) {
      refuse(loader, fmt::format("more than {} vertices or triangles", kMostElements));
    }
  }
  if (!joined.empty()) refuse(loader, "the file ends in a line that should go on");
}

// ---------------------------------------------------------------- tuples to vertices

std::uint32_t find_vertex(std::vector<Vertex>& vertices, std::vector<std::uint32_t>& source,
                          const Reference& corner) {
  auto current = static_cast<std::uint32_t>(corner.position);
  Vertex wanted{corner.texcoord, corner.normal, 0, true};
  if (!vertices[current].is_used) {
    vertices[current] = wanted;
    return current;
  }
  while (vertices[current].texcoord != corner.texcoord || vertices[current].normal != corner.normal) {
    if (vertices[current].next == 0) {
      const auto copy = static_cast<std::uint32_t>(vertices.size());
      vertices[current].next = copy;
      vertices.push_back(wanted);
      source.push_back(static_cast<std::uint32_t>(corner.position));
      return copy;
    }
    current = vertices[current].next;
  }
  return current;
}

struct Indexed {
  std::vector<Vertex> vertices;
  std::vector<std::uint32_t> source;  // index of the vertex's `v`
};

Indexed index_vertices(Loader& loader) {
  Indexed result;
  result.vertices.resize(loader.positions.size());
  for (std::uint32_t i = 0; i < loader.positions.size(); ++i) result.source.push_back(i);
  for (const auto& corners : loader.triangles) {
    glm::uvec3 triangle(0U);
    for (int k = 0; k < 3; ++k) {
      triangle[k] = find_vertex(result.vertices, result.source, corners[static_cast<std::size_t>(k)]);
    }
    loader.scene.triangles.push_back(triangle);
  }
  return result;
}

std::vector<std::uint8_t> fill_vertices(Loader& loader, const Indexed& indexed) {
  Scene& scene = loader.scene;
  std::vector<std::uint8_t> has_normal;
  const bool has_colors = !loader.colors.empty();
  loader.colors.resize(has_colors ? loader.positions.size() : 0, Rgb(1.0F));
  for (std::size_t i = 0; i < indexed.vertices.size(); ++i) {
    const Vertex& vertex = indexed.vertices[i];
    const std::uint32_t source = indexed.source[i];
    const bool is_with_normal = vertex.normal != kNone;
    has_normal.push_back(is_with_normal ? 1 : 0);
    scene.positions.push_back(loader.positions[source]);
    scene.normals.push_back(is_with_normal ? loader.normals[static_cast<std::size_t>(vertex.normal)]
                                           : Vec3(0.0F));
    if (!loader.texcoords.empty()) {
      scene.texcoords.push_back(vertex.texcoord == kNone
                                    ? Vec2(0.0F)
                                    : loader.texcoords[static_cast<std::size_t>(vertex.texcoord)]);
    }
    if (has_colors) scene.vertex_colors.push_back(loader.colors[source]);
  }
  return has_normal;
}

}  // namespace

Scene load_obj(const std::filesystem::path& path, const LoadOptions& options) {
  const std::string text = read_file(path);
  if (text.empty()) throw InputError(path.string() + ": is empty");
  Loader loader;
  loader.path = path;
  loader.scene.name = path.stem().string();
  read_lines(loader, text);
  const Indexed indexed = index_vertices(loader);
  std::vector<std::uint8_t> has_normal = fill_vertices(loader, indexed);
  return finish_loading(std::move(loader.scene), std::move(has_normal), options, path.string());
}

}  // namespace plumbline::scene
