#include <gtest/gtest.h>

#include <cstdint>

#include "reference/image/file.hpp"
#include "validation/tests/scene/scene_files.hpp"

namespace plumbline::scene {
namespace {

Scene load(std::string_view text, const LoadOptions& options = {}) {
  return load_ply(write_scene_file("scene.ply", text), options);
}

template <class Number>
void put(std::string& bytes, Number value, bool is_big_endian) {
  char raw[sizeof(Number)];
  std::memcpy(raw, &value, sizeof(Number));
  const std::uint16_t probe = 1;
  const bool is_native_big = *reinterpret_cast<const unsigned char*>(&probe) == 0;
  if (is_big_endian != is_native_big) std::reverse(raw, raw + sizeof(Number));
  bytes.append(raw, sizeof(Number));
}

// A square as one quad, with an unknown property and an unknown element before the faces.
std::string binary_square(bool is_big_endian) {
  std::string bytes =
      std::string("ply\nformat binary_") + (is_big_endian ? "big" : "little") +
      "_endian 1.0\ncomment made here\nelement vertex 4\nproperty double x\nproperty float y\n"
      "property short z\nproperty uchar quality\nelement other 2\nproperty list uchar int a\n"
      "element face 1\nproperty uchar flags\nproperty list uchar uint vertex_indices\nend_header\n";
  for (int i = 0; i < 4; ++i) {
    put(bytes, i == 1 || i == 2 ? 1.0 : 0.0, is_big_endian);
    put(bytes, i >= 2 ? 1.0F : 0.0F, is_big_endian);
    put(bytes, std::int16_t{-2}, is_big_endian);
    put(bytes, std::uint8_t{7}, is_big_endian);
  }
  for (int i = 0; i < 2; ++i) {
    put(bytes, std::uint8_t{1}, is_big_endian);
    put(bytes, std::int32_t{5}, is_big_endian);
  }
  put(bytes, std::uint8_t{3}, is_big_endian);
  put(bytes, std::uint8_t{4}, is_big_endian);
  for (std::uint32_t i = 0; i < 4; ++i) put(bytes, i, is_big_endian);
  return bytes;
}

constexpr const char* kHeader =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_index\nend_header\n";

TEST(LoadPly, ReadsTextAndBothBinaryByteOrders) {
  const Scene text = load(
      "ply\r\nformat ascii 1.0\r\nelement vertex 4\r\nproperty float x\r\nproperty float y\r\nproperty float "
      "z\r\n"
      "element face 1\r\nproperty list uchar int vertex_index\r\nend_header\r\n"
      "0 0 -2\r\n1 0 -2\r\n1 1 -2\r\n0 1 -2\r\n4 0 1 2 3\r\n");
  for (const bool is_big_endian : {false, true}) {
    const Scene binary = load(binary_square(is_big_endian));
    EXPECT_EQ(binary.positions, text.positions);
    EXPECT_EQ(binary.triangles, text.triangles);
    EXPECT_EQ(fingerprint(binary), fingerprint(text));
  }
  ASSERT_EQ(text.triangles.size(), 2U);
  EXPECT_EQ(text.positions[2], Vec3(1.0F, 1.0F, -2.0F));
  EXPECT_EQ(text.materials[0].albedo, Rgb(0.8F));
}

TEST(LoadPly, ReadsNormalsTextureCoordinatesAndColours) {
  const Scene scene = load(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "property float nx\nproperty float ny\nproperty float nz\nproperty float texture_u\nproperty float "
      "texture_v\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0 0 0 5 0.25 0.75 255 0 128 9\n1 0 0 0 3 4 0 0 255 255 255 9\n0 1 0 0 0 0 0 0 0 0 0 9\n3 0 1 2\n");
  expect_same_vector(scene.normals[0], {0.0F, 0.0F, 1.0F});
  expect_same_vector(scene.normals[1], {0.0F, 0.6F, 0.8F});
  expect_same_vector(scene.normals[2], {0.0F, 0.0F, 1.0F});  // zero counts as missing
  EXPECT_EQ(scene.texcoords[0], Vec2(0.25F, 0.25F));
  EXPECT_EQ(scene.vertex_colors[0], Rgb(1.0F, 0.0F, image::linear_from_srgb(128.0F / 255.0F)));
  EXPECT_EQ(scene.materials[0].albedo, Rgb(1.0F));
}

TEST(LoadPly, FloatColoursAreLinear) {
  const Scene scene = load(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "property float red\nproperty float green\nproperty float blue\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0 0.5 0 0\n1 0 0 0 0.5 0\n0 1 0 0 0 0.5\n3 0 1 2\n");
  EXPECT_EQ(scene.vertex_colors[1], Rgb(0.0F, 0.5F, 0.0F));
}

TEST(LoadPly, FacesMayComeBeforeVertices) {
  const Scene scene = load(
      "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nelement vertex 3\n"
      "property float x\nproperty float y\nproperty float z\nend_header\n3 0 1 2\n0 0 0\n1 0 0\n0 1 0\n");
  EXPECT_EQ(scene.triangles.size(), 1U);
}

TEST(LoadPly, EveryTruncationIsRefused) {
  const std::string whole = binary_square(false);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto path = write_scene_file("cut.ply", whole.substr(0, size));
    const std::string message = refusal([&] { (void)load_ply(path, {}); });
    EXPECT_NE(message.find("cut.ply: "), std::string::npos) << size << ": " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << size << ": " << message;
  }
}

TEST(LoadPly, RefusesDamagedFilesInOneLineThatNamesThem) {
  const std::string header(kHeader);
  const auto replaced = [&](const std::string& from, const std::string& to) {
    std::string text = header + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    return text.replace(text.find(from), from.size(), to);
  };
  const std::vector<std::pair<std::string, const char*>> faults = {
      {"", "is empty"},
      {"solid\n", "does not begin with"},
      {"ply\nelement vertex 0\nend_header\n", "no format"},
      {replaced("ascii", "utf8"), "unknown format"},
      {replaced("float x", "real x"), "line 4: unknown type \"real\""},
      {replaced("float x", "float w"), "lack x, y or z"},
      {replaced("list uchar", "list float"), "count of type"},
      {replaced("vertex 3", "vertex -3"), "element NAME COUNT"},
      {replaced("vertex 3", "vertex 1000000000000"), "at most"},
      {replaced("vertex 3", "vertex 200000000"), "the file ends here"},
      {replaced("end_header", "wrong"), "unknown header line"},
      {replaced("0 0 0", "0 zero 0"), "vertex 0 (line 10): \"zero\" is not a number"},
      {replaced("0 0 0", "0 nan 0"), "position of vertex 0 is not finite"},
      {replaced("3 0 1 2", "3 0 1 3"), "face 0: vertex 3 is out of range"},
      {replaced("3 0 1 2", "3 0 1 -1"), "vertex index is -1"},
      {replaced("3 0 1 2", "3 0 1 0.5"), "vertex index is 0.5"},
      {replaced("3 0 1 2", "-3 0 1 2"), "a list has -3 entries"},
      {replaced("3 0 1 2", "nan 0 1 2"), "a list has nan entries"},
      {replaced("3 0 1 2", "2 0 1"), "2 corners"},
      {replaced("3 0 1 2", "4000000000 0 1 2"), "entries"},
      {replaced("3 0 1 2", "100000000 0 1 2"), "the file ends here"},
      {replaced("3 0 1 2", "3 0 1 1"), "no triangle has any area"},
      {replaced("face 1", "face 0"), "has no triangles"},
      {replaced("element face 1\nproperty list uchar int vertex_index\n", ""), "has no triangles"},
  };
  for (const auto& [text, reason] : faults) expect_refused(write_scene_file("scene.ply", text), reason);
}

}  // namespace
}  // namespace plumbline::scene
