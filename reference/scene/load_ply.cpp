#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <utility>

#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/image/file.hpp"
#include "reference/scene/finish.hpp"
#include "reference/scene/load.hpp"
#include "reference/scene/polygon.hpp"
#include "reference/scene/text.hpp"

// A small reader of our own: Debian has no light PLY library, and errors should name the element they are in.
namespace plumbline::scene {
namespace {

enum class Encoding { kAscii, kLittleEndian, kBigEndian };
enum class Type { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

struct Property {
  std::string name;
  Type type = Type::kFloat32;
  std::optional<Type> list_count;  // a list with a count of this type
};

struct Element {
  std::string name;
  std::int64_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  Encoding encoding = Encoding::kAscii;
  std::vector<Element> elements;
  std::size_t lines = 0;
};

// ---------------------------------------------------------------- header

std::optional<Type> parse_type(std::string_view word) {
  constexpr std::array<std::pair<std::string_view, Type>, 16> kNames = {{{"char", Type::kInt8},
                                                                         {"int8", Type::kInt8},
                                                                         {"uchar", Type::kUint8},
                                                                         {"uint8", Type::kUint8},
                                                                         {"short", Type::kInt16},
                                                                         {"int16", Type::kInt16},
                                                                         {"ushort", Type::kUint16},
                                                                         {"uint16", Type::kUint16},
                                                                         {"int", Type::kInt32},
                                                                         {"int32", Type::kInt32},
                                                                         {"uint", Type::kUint32},
                                                                         {"uint32", Type::kUint32},
                                                                         {"float", Type::kFloat32},
                                                                         {"float32", Type::kFloat32},
                                                                         {"double", Type::kFloat64},
                                                                         {"float64", Type::kFloat64}}};
  const auto* found =
      std::find_if(kNames.begin(), kNames.end(), [&](const auto& entry) { return entry.first == word; });
  if (found == kNames.end()) return std::nullopt;
  return found->second;
}

using Words = std::vector<std::string_view>;

Property parse_property(const Words& words, const std::string& where) {
  const bool is_list = words.size() > 1 && words[1] == "list";
  if (words.size() != (is_list ? 5U : 3U)) throw InputError(where + ": is no property");
  const std::string_view type_word = words[is_list ? 3 : 1];
  const std::optional<Type> type = parse_type(type_word);
  if (!type) throw InputError(fmt::format("{}: unknown type \"{}\"", where, one_line(type_word)));
  Property property{std::string(words.back()), *type, std::nullopt};
  if (is_list) {
    property.list_count = parse_type(words[2]);
    if (!property.list_count || *property.list_count >= Type::kFloat32) {
      throw InputError(
          fmt::format("{}: a list cannot have a count of type \"{}\"", where, one_line(words[2])));
    }
  }
  return property;
}

Element parse_element(const Words& words, const std::string& where) {
  const std::optional<std::int64_t> count =
      words.size() == 3 ? parse_integer(words[2]) : std::optional<std::int64_t>{};
  if (!count || *count < 0) throw InputError(where + ": is no \"element NAME COUNT\"");
  if (*count > static_cast<std::int64_t>(kMostElements)) {
    throw InputError(fmt::format("{}: {} elements, at most {} are taken", where, *count, kMostElements));
  }
  return {std::string(words[1]), *count, {}};
}

Encoding parse_encoding(const Words& words, const std::string& where) {
  const std::string_view name = words.size() > 1 ? words[1] : "";
  if (name == "ascii") return Encoding::kAscii;
  if (name == "binary_little_endian") return Encoding::kLittleEndian;
  if (name == "binary_big_endian") return Encoding::kBigEndian;
  throw InputError(fmt::format("{}: unknown format \"{}\"", where, one_line(name)));
}

// Takes the header off the front of `rest`.
Header parse_header(std::string_view& rest, const std::string& file) {
  Header header;
  bool has_format = false;
  while (const std::optional<std::string_view> line = next_line(rest)) {
    ++header.lines;
    const std::string where = fmt::format("{}: line {}", file, header.lines);
    const Words words = split_words(*line);
    if (header.lines == 1) {
      if (words.size() != 1 || words[0] != "ply") throw InputError(file + ": does not begin with \"ply\"");
    } else if (words.empty() || words[0] == "comment" || words[0] == "obj_info") {
      continue;
    } else if (words[0] == "format") {
      header.encoding = parse_encoding(words, where);
      has_format = true;
    } else if (words[0] == "element") {
      header.elements.push_back(parse_element(words, where));
    } else if (words[0] == "property" && !header.elements.empty()) {
      header.elements.back().properties.push_back(parse_property(words, where));
    } else if (words[0] == "end_header") {
      if (!has_format) throw InputError(file + ": the header has no format");
      return header;
    } else {
      throw InputError(fmt::format("{}: unknown header line \"{}\"", where, one_line(*line)));
    }
  }
  throw InputError(file + ": is truncated: the header does not end");
}

// ---------------------------------------------------------------- body

std::size_t size_of(Type type) {
  constexpr std::array<std::size_t, 8> kSizes = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

template <class Number>
double load(std::array<char, 8> bytes) {
  Number value{};
  std::memcpy(&value, bytes.data(), sizeof(Number));
  return static_cast<double>(value);
}

double decode(const std::array<char, 8>& bytes, Type type) {
  switch (type) {
    case Type::kInt8:
      return load<std::int8_t>(bytes);
    case Type::kUint8:
      return load<std::uint8_t>(bytes);
    case Type::kInt16:
      return load<std::int16_t>(bytes);
    case Type::kUint16:
      return load<std::uint16_t>(bytes);
    case Type::kInt32:
      return load<std::int32_t>(bytes);
    case Type::kUint32:
      return load<std::uint32_t>(bytes);
    case Type::kFloat32:
      return load<float>(bytes);
    default:
      return load<double>(bytes);
  }
}

/// The numbers after the header, one by one. Knows where it is, for messages.
class Body {
 public:
  Body(std::string_view bytes, Encoding encoding, std::size_t header_lines, std::string file)
      : rest_(bytes), encoding_(encoding), line_(header_lines + 1), file_(std::move(file)) {}

  void begin_item(const std::string& element, std::int64_t index) {
    element_ = &element;
    index_ = index;
  }
  [[nodiscard]] double next(Type type) {
    return encoding_ == Encoding::kAscii ? next_word() : next_binary(type);
  }
  [[noreturn]] void refuse(const std::string& what) const {
    const std::string line = encoding_ == Encoding::kAscii ? fmt::format(" (line {})", line_) : "";
    throw InputError(fmt::format("{}: {} {}{}: {}", file_, one_line(*element_), index_, line, what));
  }

 private:
  double next_word() {
    std::size_t begin = 0;
    while (begin < rest_.size() && is_blank(rest_[begin])) {
      if (rest_[begin] == '\n') ++line_;
      ++begin;
    }
    std::size_t end = begin;
    while (end < rest_.size() && !is_blank(rest_[end])) ++end;
    if (begin == end) refuse("the file ends here");
    const std::string_view word = rest_.substr(begin, end - begin);
    const std::optional<double> value = parse_number(word);
    if (!value) refuse(fmt::format("\"{}\" is not a number", one_line(word)));
    rest_.remove_prefix(end);
    return *value;
  }
  double next_binary(Type type) {
    const std::size_t size = size_of(type);
    if (rest_.size() < size) refuse("the file ends here");
    std::array<char, 8> bytes{};
    std::copy_n(rest_.data(), size, bytes.data());
    const bool is_native_little = std::endian::native == std::endian::little;
    if ((encoding_ == Encoding::kLittleEndian) != is_native_little) {
      std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    }
    rest_.remove_prefix(size);
    return decode(bytes, type);
  }
  static bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

  std::string_view rest_;
  Encoding encoding_;
  std::size_t line_;
  std::string file_;
  const std::string* element_ = nullptr;
  std::int64_t index_ = 0;
};

std::size_t next_list_size(Body& body, const Property& property) {
  const double size = body.next(*property.list_count);
  if (!(size >= 0.0 && size <= static_cast<double>(kMostElements)) || size != std::floor(size)) {
    body.refuse(fmt::format("a list has {} entries", size));
  }
  return static_cast<std::size_t>(size);
}

void skip(Body& body, const Property& property) {
  const std::size_t count = property.list_count ? next_list_size(body, property) : 1;
  for (std::size_t i = 0; i < count; ++i) (void)body.next(property.type);
}

// ---------------------------------------------------------------- vertices

enum Slot : std::size_t { kX, kY, kZ, kNx, kNy, kNz, kS, kT, kRed, kGreen, kBlue, kSlots };

std::optional<std::size_t> slot_of(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, Slot>, 17> kNames = {{{"x", kX},
                                                                         {"y", kY},
                                                                         {"z", kZ},
                                                                         {"nx", kNx},
                                                                         {"ny", kNy},
                                                                         {"nz", kNz},
                                                                         {"s", kS},
                                                                         {"t", kT},
                                                                         {"u", kS},
                                                                         {"v", kT},
                                                                         {"texture_u", kS},
                                                                         {"texture_v", kT},
                                                                         {"texture_s", kS},
                                                                         {"texture_t", kT},
                                                                         {"red", kRed},
                                                                         {"green", kGreen},
                                                                         {"blue", kBlue}}};
  const auto* found =
      std::find_if(kNames.begin(), kNames.end(), [&](const auto& entry) { return entry.first == name; });
  if (found == kNames.end()) return std::nullopt;
  return found->second;
}

// Integers are sRGB as on a screen, floats linear.
float to_linear(double value, Type type) {
  if (type >= Type::kFloat32) return static_cast<float>(value);
  return image::linear_from_srgb(static_cast<float>(value / (type <= Type::kUint8 ? 255.0 : 65535.0)));
}

struct Mesh {
  Scene scene;
  std::vector<std::uint8_t> has_normal;
};

struct VertexLayout {
  std::vector<std::optional<std::size_t>> slots;  // one per property
  std::array<bool, kSlots> has{};

  [[nodiscard]] bool has_all(Slot first, std::size_t count) const {
    return std::all_of(has.begin() + first, has.begin() + first + count,
                       [](bool is_there) { return is_there; });
  }
};

VertexLayout vertex_layout(const Element& element, const std::string& file) {
  VertexLayout layout;
  for (const Property& property : element.properties) {
    layout.slots.push_back(property.list_count ? std::nullopt : slot_of(property.name));
    if (layout.slots.back()) layout.has[*layout.slots.back()] = true;
  }
  if (!layout.has_all(kX, 3)) throw InputError(file + ": vertices lack x, y or z");
  return layout;
}

void append_vertex(Mesh& mesh, const VertexLayout& layout, const std::array<float, kSlots>& v) {
  const bool has_normal = layout.has_all(kNx, 3);
  mesh.scene.positions.emplace_back(v[kX], v[kY], v[kZ]);
  mesh.scene.normals.emplace_back(v[kNx], v[kNy], v[kNz]);
  mesh.has_normal.push_back(has_normal ? 1 : 0);
  // (0, 0) is the bottom left corner, as in OBJ.
  if (layout.has_all(kS, 2)) mesh.scene.texcoords.emplace_back(v[kS], 1.0F - v[kT]);
  if (layout.has_all(kRed, 3)) mesh.scene.vertex_colors.emplace_back(v[kRed], v[kGreen], v[kBlue]);
}

void read_vertices(Mesh& mesh, Body& body, const Element& element, const std::string& file) {
  const VertexLayout layout = vertex_layout(element, file);
  for (std::int64_t i = 0; i < element.count; ++i) {
    body.begin_item(element.name, i);
    std::array<float, kSlots> values{};
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const Property& property = element.properties[p];
      if (!layout.slots[p]) {
        skip(body, property);
        continue;
      }
      const double value = body.next(property.type);
      const std::size_t slot = *layout.slots[p];
      values[slot] = slot >= kRed ? to_linear(value, property.type) : static_cast<float>(value);
    }
    append_vertex(mesh, layout, values);
  }
}

// ---------------------------------------------------------------- faces

struct Face {
  std::int64_t index;
  std::vector<std::uint32_t> corners;
};

// Faces may come before the vertices they use: indices are checked when both are read.
std::vector<Face> read_faces(Body& body, const Element& element) {
  std::vector<Face> faces;
  for (std::int64_t i = 0; i < element.count; ++i) {
    body.begin_item(element.name, i);
    faces.push_back({i, {}});
    for (const Property& property : element.properties) {
      const bool is_corners =
          property.list_count && (property.name == "vertex_indices" || property.name == "vertex_index");
      if (!is_corners) {
        skip(body, property);
        continue;
      }
      const std::size_t count = next_list_size(body, property);
      for (std::size_t k = 0; k < count; ++k) {
        const double index = body.next(property.type);
        if (!(index >= 0.0 && index <= 4294967295.0) || index != std::floor(index)) {
          body.refuse(fmt::format("vertex index is {}", index));
        }
        faces.back().corners.push_back(static_cast<std::uint32_t>(index));
      }
    }
  }
  return faces;
}

void append_faces(Scene& scene, const std::vector<Face>& faces, const std::string& file) {
  for (const Face& face : faces) {
    std::vector<Vec3> places;
    for (const std::uint32_t corner : face.corners) {
      if (corner >= scene.positions.size()) {
        throw InputError(fmt::format("{}: face {}: vertex {} is out of range, there are {}", file, face.index,
                                     corner, scene.positions.size()));
      }
      places.push_back(scene.positions[corner]);
    }
    if (places.size() < 3) {
      throw InputError(
          fmt::format("{}: face {}: has {} corners, expected 3", file, face.index, places.size()));
    }
    try {
      for (const glm::uvec3& t : triangulate(places)) {
        scene.triangles.emplace_back(face.corners[t.x], face.corners[t.y], face.corners[t.z]);
      }
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: face {}: {}", file, face.index, error.what()));
    }
  }
  scene.triangle_materials.assign(scene.triangles.size(), 0);
}

void skip_element(Body& body, const Element& element) {
  if (element.properties.empty()) return;  // nothing is stored, whatever the count
  for (std::int64_t i = 0; i < element.count; ++i) {
    body.begin_item(element.name, i);
    for (const Property& property : element.properties) skip(body, property);
  }
}

}  // namespace

Scene load_ply(const std::filesystem::path& path, const LoadOptions& options) {
  const std::string file = path.string();
  const std::string bytes = read_file(path);
  if (bytes.empty()) throw InputError(file + ": is empty");
  std::string_view rest = bytes;
  const Header header = parse_header(rest, file);
  Body body(rest, header.encoding, header.lines, file);
  Mesh mesh;
  std::vector<Face> faces;
  for (const Element& element : header.elements) {
    if (element.name == "vertex" && mesh.scene.positions.empty()) {
      read_vertices(mesh, body, element, file);
    } else if (element.name == "face" && faces.empty() && !element.properties.empty()) {
      faces = read_faces(body, element);
    } else {
      skip_element(body, element);
    }
  }
  mesh.scene.name = path.stem().string();
  append_faces(mesh.scene, faces, file);
  mesh.scene.materials.push_back({});
  if (!mesh.scene.vertex_colors.empty()) mesh.scene.materials[0].albedo = Rgb(1.0F);
  return finish_loading(std::move(mesh.scene), std::move(mesh.has_normal), options, file);
}

}  // namespace plumbline::scene
