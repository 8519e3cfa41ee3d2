#include <gtest/gtest.h>

#include <cstdint>
#include <nlohmann/json.hpp>

#include "reference/image/file.hpp"
#include "reference/scene/glb.hpp"
#include "validation/tests/scene/scene_files.hpp"

namespace plumbline::scene {
namespace {

using Json = nlohmann::json;

constexpr int kByte = 5120;
constexpr int kUnsignedByte = 5121;
constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedInt = 5125;
constexpr int kFloat = 5126;

// A glTF file under construction. One buffer; add() makes a buffer view and an accessor.
struct Gltf {
  Json root = {{"asset", {{"version", "2.0"}}}};
  std::string binary;

  int add_view(std::string_view bytes) {
    while (binary.size() % 4 != 0) binary.push_back('\0');
    root["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}});
    binary += bytes;
    return static_cast<int>(root["bufferViews"].size()) - 1;
  }
  template <class Number>
  int add(const std::vector<Number>& values, const char* type, int component, std::size_t components,
          bool is_normalized = false) {
    const int view = add_view({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Number)});
    return add_accessor({{"bufferView", view},
                         {"componentType", component},
                         {"count", values.size() / components},
                         {"type", type},
                         {"normalized", is_normalized}});
  }
  int add_accessor(const Json& accessor) {
    root["accessors"].push_back(accessor);
    return static_cast<int>(root["accessors"].size()) - 1;
  }
  int positions(const std::vector<float>& xyz) { return add(xyz, "VEC3", kFloat, 3); }
  void primitive(const Json& attributes, int indices = -1, const Json& more = Json::object()) {
    Json result = {{"attributes", attributes}};
    if (indices >= 0) result["indices"] = indices;
    result.update(more);
    root["meshes"][0]["primitives"].push_back(result);
  }
  void node(Json node) { root["nodes"].push_back(std::move(node)); }

  [[nodiscard]] std::filesystem::path write_glb() {
    root["buffers"] = Json::array({{{"byteLength", binary.size()}}});
    if (!root.contains("nodes")) node({{"mesh", 0}});
    return write_scene_file("scene.glb", join_glb(root.dump(), binary));
  }
  [[nodiscard]] std::filesystem::path write_text(const std::string& uri) {
    root["buffers"] = Json::array({{{"byteLength", binary.size()}, {"uri", uri}}});
    if (!root.contains("nodes")) node({{"mesh", 0}});
    return write_scene_file("scene.gltf", root.dump());
  }
  [[nodiscard]] Scene load() { return load_gltf(write_glb(), {}); }
};

const std::vector<float> kTriangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};
const std::vector<float> kSquare = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

Gltf triangle() {
  Gltf gltf;
  gltf.primitive({{"POSITION", gltf.positions(kTriangle)}});
  return gltf;
}

std::string base64(std::string_view bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string result;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = (group << 8U) | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      result += i + k > bytes.size() ? '=' : kDigits[(group >> (18 - 6 * k)) & 63U];
    }
  }
  return result;
}

// ---------------------------------------------------------------- containers

TEST(LoadGltf, ReadsBinaryExternalAndEmbeddedBuffersAlike) {
  Gltf gltf = triangle();
  const Scene from_glb = gltf.load();
  EXPECT_EQ(from_glb.positions[1], Vec3(1.0F, 0.0F, 0.0F));
  EXPECT_EQ(from_glb.normals[1], Vec3(0.0F, 0.0F, 1.0F));
  EXPECT_EQ(from_glb.materials[0].albedo, Rgb(1.0F));  // glTF's default material
  (void)write_scene_file("a buffer.bin", gltf.binary);
  const Scene external = load_gltf(gltf.write_text("a%20buffer.bin"), {});
  const Scene embedded =
      load_gltf(gltf.write_text("data:application/octet-stream;base64," + base64(gltf.binary)), {});
  EXPECT_EQ(fingerprint(external), fingerprint(from_glb));
  EXPECT_EQ(fingerprint(embedded), fingerprint(from_glb));
}

TEST(LoadGltf, EveryTruncationOfABinaryFileIsRefused) {
  const std::string whole = read_file(triangle().write_glb());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto path = write_scene_file("cut.glb", whole.substr(0, size));
    const std::string message = refusal([&] { (void)load_gltf(path, {}); });
    EXPECT_NE(message.find("cut.glb: "), std::string::npos) << size << ": " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << size << ": " << message;
  }
}

TEST(LoadGltf, DamagedBytesNeverCrash) {
  // Each byte of the JSON in turn becomes something else: the file loads or is refused, nothing worse.
  const std::string whole = read_file(triangle().write_glb());
  const std::size_t json_end = whole.find("BIN");
  ASSERT_NE(json_end, std::string::npos);
  for (std::size_t i = 0; i < json_end; ++i) {
    for (const char replacement : {'9', '-', '"', '}'}) {
      std::string damaged = whole;
      damaged[i] = replacement;
      const auto path = write_scene_file("damaged.glb", damaged);
      try {
        (void)load_gltf(path, {});
      } catch (const InputError& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        EXPECT_NE(message.find("damaged.glb"), std::string::npos) << message;
      }
    }
  }
}

// ---------------------------------------------------------------- geometry

TEST(LoadGltf, AssemblesListsStripsAndFans) {
  const std::vector<std::pair<int, std::vector<glm::uvec3>>> expected = {{5, {{0, 1, 2}, {1, 3, 2}}},
                                                                         {6, {{1, 2, 0}, {2, 3, 0}}}};
  for (const auto& [mode, triangles] : expected) {
    Gltf gltf;
    const bool is_strip = mode == 5;
    const std::vector<float> strip = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0};
    gltf.primitive({{"POSITION", gltf.positions(is_strip ? strip : kSquare)}}, -1, {{"mode", mode}});
    const Scene scene = gltf.load();
    EXPECT_EQ(scene.triangles, triangles) << "mode " << mode;
    for (std::uint32_t t = 0; t < 2; ++t) EXPECT_EQ(geometric_normal(scene, t), Vec3(0.0F, 0.0F, 1.0F));
  }
}

TEST(LoadGltf, SkipsPointsAndLines) {
  Gltf gltf = triangle();
  gltf.primitive({{"POSITION", 0}}, -1, {{"mode", 0}});
  gltf.primitive({{"POSITION", 0}}, -1, {{"mode", 3}});
  EXPECT_EQ(gltf.load().triangles.size(), 1U);
}

TEST(LoadGltf, ReadsEveryIndexType) {
  const auto indexed = [](const auto& indices, int component) {
    Gltf gltf;
    const int positions = gltf.positions(kSquare);
    gltf.primitive({{"POSITION", positions}}, gltf.add(indices, "SCALAR", component, 1));
    return gltf.load();
  };
  const std::vector<glm::uvec3> expected = {{0, 1, 2}, {0, 2, 3}};
  EXPECT_EQ(indexed(std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3}, kUnsignedByte).triangles, expected);
  EXPECT_EQ(indexed(std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, kUnsignedShort).triangles, expected);
  EXPECT_EQ(indexed(std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}, kUnsignedInt).triangles, expected);
}

TEST(LoadGltf, ReadsInterleavedAndSparseAccessors) {
  Gltf gltf;
  std::vector<float> interleaved;  // position, normal
  for (std::size_t i = 0; i < 3; ++i) {
    interleaved.insert(interleaved.end(),
                       {kTriangle[3 * i], kTriangle[3 * i + 1], kTriangle[3 * i + 2], 0, 0, 1});
  }
  const int view = gltf.add_view({reinterpret_cast<const char*>(interleaved.data()), 72});
  gltf.root["bufferViews"][0]["byteStride"] = 24;
  const std::vector<float> moved = {0, 2, 0};
  const int values = gltf.add_view({reinterpret_cast<const char*>(moved.data()), 12});
  const int indices = gltf.add_view(std::string_view("\2", 1));
  const int position =
      gltf.add_accessor({{"bufferView", view},
                         {"componentType", kFloat},
                         {"count", 3},
                         {"type", "VEC3"},
                         {"sparse",
                          {{"count", 1},
                           {"indices", {{"bufferView", indices}, {"componentType", kUnsignedByte}}},
                           {"values", {{"bufferView", values}}}}}});
  const int normal = gltf.add_accessor(
      {{"bufferView", view}, {"byteOffset", 12}, {"componentType", kFloat}, {"count", 3}, {"type", "VEC3"}});
  gltf.primitive({{"POSITION", position}, {"NORMAL", normal}});
  const Scene scene = gltf.load();
  EXPECT_EQ(scene.positions[1], Vec3(1.0F, 0.0F, 0.0F));
  EXPECT_EQ(scene.positions[2], Vec3(0.0F, 2.0F, 0.0F));
  EXPECT_EQ(scene.normals[2], Vec3(0.0F, 0.0F, 1.0F));
}

TEST(LoadGltf, ReadsNormalizedIntegers) {
  Gltf gltf;
  const int position = gltf.positions(kTriangle);
  const int uv =
      gltf.add(std::vector<std::uint16_t>{0, 65535, 65535, 0, 13107, 0}, "VEC2", kUnsignedShort, 2, true);
  // rows of 4 bytes, as alignment asks
  const int color = gltf.add(std::vector<std::uint8_t>{255, 0, 51, 7, 0, 255, 0, 7, 0, 0, 255, 7}, "VEC4",
                             kUnsignedByte, 4, true);
  const int normal =
      gltf.add(std::vector<std::int8_t>{0, 0, 127, 0, 0, 0, 127, 0, 0, 0, -128, 0}, "VEC3", kByte, 4, true);
  gltf.root["bufferViews"].back()["byteStride"] = 4;
  gltf.primitive({{"POSITION", position}, {"TEXCOORD_0", uv}, {"COLOR_0", color}, {"NORMAL", normal}});
  const Scene scene = gltf.load();
  EXPECT_EQ(scene.texcoords[0], Vec2(0.0F, 1.0F));
  EXPECT_EQ(scene.texcoords[2], Vec2(0.2F, 0.0F));
  EXPECT_EQ(scene.vertex_colors[0], Rgb(1.0F, 0.0F, 0.2F));
  EXPECT_EQ(scene.normals[0], Vec3(0.0F, 0.0F, 1.0F));
  EXPECT_EQ(scene.normals[2], Vec3(0.0F, 0.0F, -1.0F));  // -128 means -1
}

TEST(LoadGltf, PrimitivesWithTheSameAccessorsShareVertices) {
  Gltf gltf;
  const int position = gltf.positions(kSquare);
  gltf.primitive({{"POSITION", position}},
                 gltf.add(std::vector<std::uint8_t>{0, 1, 2}, "SCALAR", kUnsignedByte, 1), {{"material", 1}});
  gltf.primitive({{"POSITION", position}},
                 gltf.add(std::vector<std::uint8_t>{0, 2, 3}, "SCALAR", kUnsignedByte, 1), {{"material", 0}});
  gltf.root["materials"] = {{{"name", "a"}}, {{"name", "b"}}};
  const Scene scene = gltf.load();
  EXPECT_EQ(scene.positions.size(), 4U);
  EXPECT_EQ(scene.triangles, (std::vector<glm::uvec3>{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(scene.triangle_materials, (std::vector<std::uint32_t>{1, 0}));
}

TEST(LoadGltf, ComputesNormalsOnlyWhereTheyAreMissing) {
  Gltf gltf;
  const int first = gltf.positions(kTriangle);
  const float third = 1.0F / 3.0F;
  const int normals =
      gltf.add(std::vector<float>{2 * third, 2 * third, third, 0, 0, 2, 0, 0, 0}, "VEC3", kFloat, 3);
  const int second = gltf.positions({0, 0, 0, 0, 1, 0, 0, 0, 1});
  gltf.primitive({{"POSITION", first}, {"NORMAL", normals}});
  gltf.primitive({{"POSITION", second}});
  const Scene scene = gltf.load();
  expect_same_vector(scene.normals[0], {2 * third, 2 * third, third});
  EXPECT_EQ(scene.normals[1], Vec3(0.0F, 0.0F, 1.0F));
  EXPECT_EQ(scene.normals[2], Vec3(0.0F, 0.0F, 1.0F));  // zero in the file counts as missing
  for (std::size_t i = 3; i < 6; ++i) EXPECT_EQ(scene.normals[i], Vec3(1.0F, 0.0F, 0.0F));
}

TEST(LoadGltf, FillsAttributesThatSomePrimitivesLack) {
  Gltf gltf;
  const int position = gltf.positions(kTriangle);
  const int uv = gltf.add(std::vector<float>{1, 1, 1, 1, 1, 1}, "VEC2", kFloat, 2);
  const int color = gltf.add(std::vector<float>(9, 0.5F), "VEC3", kFloat, 3);
  gltf.primitive({{"POSITION", position}});
  gltf.primitive({{"POSITION", position}, {"TEXCOORD_0", uv}, {"COLOR_0", color}});
  gltf.primitive({{"POSITION", gltf.positions({0, 0, 1, 1, 0, 1, 0, 1, 1})}});
  const Scene scene = gltf.load();
  ASSERT_EQ(scene.texcoords.size(), 9U);
  ASSERT_EQ(scene.vertex_colors.size(), 9U);
  EXPECT_EQ(scene.texcoords[0], Vec2(0.0F));
  EXPECT_EQ(scene.texcoords[3], Vec2(1.0F));
  EXPECT_EQ(scene.vertex_colors[0], Rgb(1.0F));
  EXPECT_EQ(scene.vertex_colors[5], Rgb(0.5F));
  EXPECT_EQ(scene.vertex_colors[8], Rgb(1.0F));
}

// ---------------------------------------------------------------- transforms

TEST(LoadGltf, NodesApplyScaleThenRotationThenTranslationThenTheParent) {
  Gltf gltf = triangle();
  const double h = std::sqrt(0.5);  // 90 degrees about +z
  gltf.node({{"children", {1}}, {"matrix", {2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 100, 1}}});
  gltf.node({{"mesh", 0}, {"scale", {3, 1, 1}}, {"rotation", {0, 0, h, h}}, {"translation", {10, 0, 0}}});
  const Scene scene = gltf.load();
  expect_same_vector(scene.positions[0], {20.0F, 0.0F, 100.0F}, 1e-5F);
  expect_same_vector(scene.positions[1], {20.0F, 6.0F, 100.0F}, 1e-5F);
  expect_same_vector(scene.positions[2], {18.0F, 0.0F, 100.0F}, 1e-5F);
}

TEST(LoadGltf, NormalsStayPerpendicularUnderUnequalScale) {
  Gltf gltf;
  const int position = gltf.positions({1, 0, 0, 0, 1, 0, 0, 0, 1});
  const float n = std::sqrt(1.0F / 3.0F);
  gltf.primitive({{"POSITION", position}, {"NORMAL", gltf.add(std::vector<float>(9, n), "VEC3", kFloat, 3)}});
  gltf.node({{"mesh", 0}, {"scale", {1, 5, 0.1}}});
  const Scene scene = gltf.load();
  expect_same_vector(scene.normals[0], geometric_normal(scene, 0));
}

TEST(LoadGltf, MirroredNodesKeepTheirFronts) {
  Gltf gltf;
  const int position = gltf.positions({1, 0, 0, 0, 1, 0, 0, 0, 1});
  const float n = std::sqrt(1.0F / 3.0F);
  gltf.primitive({{"POSITION", position}, {"NORMAL", gltf.add(std::vector<float>(9, n), "VEC3", kFloat, 3)}});
  gltf.node({{"mesh", 0}, {"scale", {-1, 1, 1}}});
  const Scene scene = gltf.load();
  expect_same_vector(scene.normals[0], {-n, n, n});
  expect_same_vector(geometric_normal(scene, 0), {-n, n, n});
}

TEST(LoadGltf, AMeshInTwoNodesIsThereTwice) {
  Gltf gltf = triangle();
  gltf.node({{"mesh", 0}});
  gltf.node({{"mesh", 0}, {"translation", {0, 0, 5}}});
  const Scene scene = gltf.load();
  EXPECT_EQ(scene.triangles.size(), 2U);
  EXPECT_EQ(scene.positions[3], Vec3(0.0F, 0.0F, 5.0F));
}

TEST(LoadGltf, TakesTheDefaultSceneElseTheFirstElseAllNodes) {
  Gltf gltf = triangle();
  gltf.node({{"mesh", 0}});
  gltf.node({{"mesh", 0}, {"translation", {0, 0, 5}}});
  EXPECT_EQ(gltf.load().triangles.size(), 2U);
  gltf.root["scenes"] = {{{"nodes", {1}}}, {{"nodes", {0}}}};
  EXPECT_EQ(gltf.load().positions[0].z, 5.0F);
  gltf.root["scene"] = 1;
  EXPECT_EQ(gltf.load().positions[0].z, 0.0F);
}

// ---------------------------------------------------------------- materials

TEST(LoadGltf, ReadsFactorsEmissionAndSides) {
  Gltf gltf = triangle();
  gltf.root["meshes"][0]["primitives"][0]["material"] = 0;
  gltf.root["materials"] = {
      {{"name", "lamp"},
       {"pbrMetallicRoughness", {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}}, {"metallicFactor", 1.0}}},
       {"emissiveFactor", {1.0, 0.5, 0.25}},
       {"doubleSided", true},
       {"extensions",
        {{"KHR_materials_emissive_strength", {{"emissiveStrength", 10.0}}},
         {"KHR_materials_pbrSpecularGlossiness", {{"diffuseFactor", {1, 0, 0, 1}}}}}}}};
  const Scene scene = gltf.load();
  ASSERT_EQ(scene.materials.size(), 1U);
  EXPECT_EQ(scene.materials[0].name, "lamp");
  EXPECT_EQ(scene.materials[0].albedo, Rgb(0.1F, 0.2F, 0.3F));
  EXPECT_EQ(scene.materials[0].emission, Rgb(10.0F, 5.0F, 2.5F));
  EXPECT_TRUE(scene.materials[0].is_double_sided);
}

// A triangle with a one-texel picture; `image` says where it is.
Gltf textured(const Json& image) {
  Gltf gltf;
  const int position = gltf.positions(kTriangle);
  gltf.primitive({{"POSITION", position},
                  {"TEXCOORD_0", gltf.add(std::vector<float>(6, 0.0F), "VEC2", kFloat, 2)},
                  {"TEXCOORD_1", gltf.add(std::vector<float>(6, 0.75F), "VEC2", kFloat, 2)}},
                 -1, {{"material", 0}});
  gltf.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  gltf.root["textures"] = {{{"source", 0}, {"sampler", 0}}};
  gltf.root["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
  gltf.root["images"] = Json::array({image});
  return gltf;
}

TEST(LoadGltf, ReadsTexturesFromFilesDataAndBufferViews) {
  const std::string png = image::encode_png({1, 1, {255, 0, 128}});
  (void)write_scene_file("a map.png", png);
  Gltf inside = textured({{"mimeType", "image/png"}});
  inside.root["images"][0]["bufferView"] = inside.add_view(png);
  const std::vector<Gltf> all = {textured({{"uri", "a%20map.png"}}),
                                 textured({{"uri", "data:image/png;base64," + base64(png)}}), inside};
  for (Gltf gltf : all) {
    const Scene scene = gltf.load();
    ASSERT_EQ(scene.textures.size(), 1U);
    EXPECT_EQ(scene.textures[0].wrap_u, Wrap::kClamp);
    EXPECT_EQ(scene.textures[0].wrap_v, Wrap::kMirror);
    expect_same_vector(albedo_at(scene, 0, {0.3F, 0.3F}),
                       {1.0F, 0.0F, image::linear_from_srgb(128.0F / 255.0F)});
  }
}

TEST(LoadGltf, TheTextureChoosesItsCoordinateSet) {
  Gltf gltf = textured({{"uri", "data:image/png;base64," + base64(image::encode_png({1, 1, {9, 9, 9}}))}});
  EXPECT_EQ(gltf.load().texcoords[0], Vec2(0.0F));
  gltf.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 1;
  EXPECT_EQ(gltf.load().texcoords[0], Vec2(0.75F));
}

TEST(LoadGltf, AnEmissiveTextureIsRefusedOnlyWhereItWouldShow) {
  Gltf gltf = triangle();
  gltf.root["materials"] = {{{"name", "m"}, {"emissiveTexture", {{"index", 0}}}}};
  EXPECT_NO_THROW((void)gltf.load());
  gltf.root["materials"][0]["emissiveFactor"] = {1.0, 1.0, 1.0};
  expect_refused(gltf.write_glb(), "material 0 (m) has an emissive texture");
}

// ---------------------------------------------------------------- cameras and lights

TEST(LoadGltf, ReadsPerspectiveCamerasWithTheirNodes) {
  Gltf gltf = triangle();
  const double h = std::sqrt(0.5);  // 90 degrees about +y: -z turns to -x
  gltf.root["cameras"] = {
      {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0}, {"zfar", 1}}}},
      {{"type", "perspective"}, {"name", "own"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
  gltf.node({{"mesh", 0}});
  gltf.node({{"camera", 0}});
  gltf.node({{"camera", 1}, {"translation", {1, 2, 3}}, {"rotation", {0, h, 0, h}}, {"scale", {3, 3, 3}}});
  gltf.node({{"camera", 1}, {"name", "node's"}});
  const Scene scene = gltf.load();
  ASSERT_EQ(scene.cameras.size(), 2U);
  EXPECT_EQ(scene.cameras[0].name, "own");
  EXPECT_EQ(scene.cameras[0].eye, Vec3(1.0F, 2.0F, 3.0F));
  expect_same_vector(scene.cameras[0].forward, {-1.0F, 0.0F, 0.0F});
  expect_same_vector(scene.cameras[0].up, {0.0F, 1.0F, 0.0F});
  EXPECT_EQ(scene.cameras[0].vertical_fov_rad, 0.5F);
  EXPECT_EQ(scene.cameras[1].name, "node's");
}

TEST(LoadGltf, ReadsPunctualLightsAlongTheNodesMinusZ) {
  Gltf gltf = triangle();
  const double h = std::sqrt(0.5);  // -90 degrees about +x: -z turns to -y
  gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"color", {1.0, 0.5, 0.0}}, {"intensity", 8.0}, {"range", 3.0}},
      {{"type", "spot"}, {"intensity", 2.0}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.2}}}},
      {{"type", "directional"}}};
  gltf.node({{"mesh", 0}});
  for (int i = 0; i < 3; ++i) {
    gltf.node({{"rotation", {-h, 0, 0, h}},
               {"translation", {1, 2, 3}},
               {"scale", {2, 2, 2}},
               {"extensions", {{"KHR_lights_punctual", {{"light", i}}}}}});
  }
  const Scene scene = gltf.load();
  ASSERT_EQ(scene.lights.size(), 3U);
  const auto& point = std::get<light::PointLight>(scene.lights[0]);
  EXPECT_EQ(point.position, Vec3(1.0F, 2.0F, 3.0F));
  EXPECT_EQ(point.radiant_intensity, Rgb(8.0F, 4.0F, 0.0F));
  const auto& spot = std::get<light::SpotLight>(scene.lights[1]);
  expect_same_vector(spot.direction, {0.0F, -1.0F, 0.0F});
  EXPECT_EQ(spot.radiant_intensity, Rgb(2.0F));
  EXPECT_EQ(spot.inner_angle_rad, 0.1F);
  EXPECT_EQ(spot.outer_angle_rad, 0.2F);
  const auto& directional = std::get<light::DirectionalLight>(scene.lights[2]);
  expect_same_vector(directional.direction, {0.0F, -1.0F, 0.0F});
  EXPECT_EQ(directional.irradiance, Rgb(1.0F));
}

// ---------------------------------------------------------------- bad input

TEST(LoadGltf, RefusesFilesThatAreNotThereOrNotGltf) {
  const auto folder = write_scene_file("x", "x").parent_path();
  expect_refused(folder / "none.gltf", "no such file");
  expect_refused(folder / "none.glb", "no such file");
  expect_refused(write_scene_file("scene.stl", "solid"), "unknown kind of scene");
  expect_refused(write_scene_file("scene", "solid"), "unknown kind of scene");
  expect_refused(write_scene_file("empty.gltf", ""), "is empty");
  expect_refused(write_scene_file("empty.glb", ""), "is empty");
  expect_refused(write_scene_file("text.gltf", "{\n\"asset\": {\n\"version\" \"2.0\"}}"),
                 "cannot read as glTF");
  expect_refused(write_scene_file("array.gltf", "[1, 2]"), "cannot read as glTF");
  expect_refused(write_scene_file("old.gltf", R"({"asset": {"version": "1.0"}})"), "glTF version is 1.0");
  expect_refused(write_scene_file("bare.gltf", R"({"asset": {"version": "2.0"}})"), "has no triangles");
  const std::string deep = R"({"asset": {"version": "2.0"}, "extras": )";
  expect_refused(
      write_scene_file("deep.gltf", deep + std::string(100000, '[') + std::string(100000, ']') + "}"),
      "nested deeper");
}

TEST(LoadGltf, RefusesMissingOrShortBuffers) {
  Gltf gltf = triangle();
  expect_refused(gltf.write_text("none.bin"), "none.bin");
  (void)write_scene_file("short.bin", gltf.binary.substr(4));
  expect_refused(gltf.write_text("short.bin"), "short.bin");
  expect_refused(gltf.write_text("data:application/octet-stream;base64,AAAA"), "cannot read as glTF");
  expect_refused(textured({{"uri", "none.png"}}).write_glb(), "none.png");
  expect_refused(textured({{"uri", "data:image/png;base64,AAAA"}}).write_glb(), "image 0");
}

using Damage = std::pair<const char*, std::function<void(Gltf&)>>;

void expect_all_refused(const std::function<Gltf()>& make, const std::vector<Damage>& damages) {
  for (const auto& [reason, apply] : damages) {
    Gltf gltf = make();
    apply(gltf);
    expect_refused(gltf.write_glb(), reason);
  }
}

Gltf indexed_square() {
  Gltf gltf;
  const int positions = gltf.positions(kSquare);
  gltf.primitive({{"POSITION", positions}},
                 gltf.add(std::vector<std::uint8_t>{0, 1, 2}, "SCALAR", kUnsignedByte, 1));
  return gltf;
}

TEST(LoadGltf, RefusesAccessorsThatDoNotFit) {
  const auto accessor = [](const char* member, Json value) {
    return [=](Gltf& g) { g.root["accessors"][0][member] = value; };
  };
  expect_all_refused(indexed_square,
                     {{"exceed their buffer view", accessor("count", 5)},
                      {"elements", accessor("count", 0)},
                      {"elements", accessor("count", 9000000000000000000)},
                      {"", accessor("count", -4)},
                      {"exceed their buffer view", accessor("byteOffset", 4)},
                      {"exceed their buffer view", accessor("byteOffset", 18446744073709551612U)},
                      {"buffer view 7 does not exist", accessor("bufferView", 7)},
                      {"component type", accessor("componentType", kUnsignedInt)},
                      {"component type", accessor("componentType", 5130)},
                      {"1 components", accessor("type", "SCALAR")},
                      {"0 components", accessor("type", "MAT4")},
                      {"in buffer 1", [](Gltf& g) { g.root["bufferViews"][0]["buffer"] = 1; }},
                      {"exceeds its buffer", [](Gltf& g) { g.root["bufferViews"][0]["byteLength"] = 1000; }},
                      {"exceeds its buffer",
                       [](Gltf& g) { g.root["bufferViews"][0]["byteOffset"] = 18446744073709551600U; }},
                      {"byteStride 4", [](Gltf& g) { g.root["bufferViews"][0]["byteStride"] = 4; }},
                      {"without a buffer view", [](Gltf& g) {
                         g.root["accessors"][0].erase("bufferView");
                         g.root["accessors"][0]["count"] = 100000000;
                       }}});
}

TEST(LoadGltf, RefusesBadSparseAccessors) {
  const auto sparse = [](const char* pointer, Json value) {
    return [=](Gltf& g) {
      const int values = g.add_view(std::string(12, '\0'));
      const int indices = g.add_view(std::string_view("\1\0\0\7", 4));
      Json& target = g.root["accessors"][0]["sparse"];
      target = {{"count", 1},
                {"indices", {{"bufferView", indices}, {"componentType", kUnsignedByte}}},
                {"values", {{"bufferView", values}}}};
      target[Json::json_pointer(pointer)] = value;
    };
  };
  expect_all_refused(indexed_square, {{"sparse values", sparse("/count", 5)},
                                      {"sparse values", sparse("/count", 0)},
                                      {"exceed", sparse("/values/byteOffset", 1)},
                                      {"negative", sparse("/values/byteOffset", -1)},
                                      {"exceed", sparse("/indices/byteOffset", 4)},
                                      {"component type", sparse("/indices/componentType", kFloat)},
                                      {"does not exist", sparse("/indices/bufferView", 99)},
                                      {"out of range", sparse("/indices/byteOffset", 3)}});
}

TEST(LoadGltf, RefusesBadPrimitivesAndNodes) {
  const auto index = [](char value) { return [=](Gltf& g) { g.binary[50] = value; }; };
  const auto primitive = [](const char* member, Json value) {
    return [=](Gltf& g) { g.root["meshes"][0]["primitives"][0][member] = value; };
  };
  const auto node = [](Json value) { return [=](Gltf& g) { g.node(value); }; };
  expect_all_refused(indexed_square,
                     {{"index 4 is out of range", index('\4')},
                      {"no multiple of 3", [](Gltf& g) { g.root["accessors"][1]["count"] = 2; }},
                      {"out of bounds", primitive("indices", 9)},
                      {"indices have component type", primitive("indices", 0)},
                      {"material 3 does not exist", primitive("material", 3)},
                      {"has no POSITION", primitive("attributes", {{"NORMAL", 0}})},
                      {"accessor 8 does not exist", primitive("attributes", {{"POSITION", 8}})},
                      {"accessor 1 has", primitive("attributes", {{"POSITION", 0}, {"NORMAL", 1}})},
                      {"mesh 5 does not exist", node({{"mesh", 5}})},
                      {"camera 5 does not exist", node({{"mesh", 0}, {"camera", 5}})},
                      {"light 5 does not exist",
                       node({{"mesh", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 5}}}}}})},
                      {"node 7 does not exist", node({{"mesh", 0}, {"children", {7}}})},
                      {"has no triangles", node({{"mesh", 0}, {"children", {0}}})},
                      {"wrong number", node({{"mesh", 0}, {"scale", {1, 1}}})},
                      {"rotation is zero", node({{"mesh", 0}, {"rotation", {0, 0, 0, 0}}})},
                      {"not finite", node({{"mesh", 0}, {"scale", {1e300, 1, 1}}})},
                      {"no triangle has any area", node({{"mesh", 0}, {"scale", {0, 1, 1}}})},
                      {"nodes do not form a tree",
                       [](Gltf& g) {
                         g.node({{"mesh", 0}, {"children", {1}}});
                         g.node({{"children", {0}}});
                         g.root["scenes"] = {{{"nodes", {0}}}};
                       }},
                      {"scene 3 does not exist", [](Gltf& g) { g.root["scene"] = 3; }},
                      {"requires the extension KHR_draco_mesh_compression",
                       [](Gltf& g) { g.root["extensionsRequired"] = {"KHR_draco_mesh_compression"}; }}});
}

TEST(LoadGltf, RefusesBadNumbers) {
  const auto position = [](float value) {
    return [=](Gltf& g) { std::memcpy(g.binary.data() + 16, &value, 4); };
  };
  const auto material = [](Json value) {
    return [=](Gltf& g) { g.root["materials"] = Json::array({value}); };
  };
  const auto light = [](Json value) {
    return [=](Gltf& g) {
      g.root["extensions"]["KHR_lights_punctual"]["lights"] = Json::array({value});
      g.node({{"mesh", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    };
  };
  expect_all_refused(
      indexed_square,
      {{"position of vertex 1 is not finite", position(std::nanf(""))},
       {"position of vertex 1 is not finite", position(1e30F)},
       {"albedo of material 0", material({{"pbrMetallicRoughness", {{"baseColorFactor", {1.5, 0, 0, 1}}}}})},
       {"emission of material 0", material({{"emissiveFactor", {-1, 0, 0}}})},
       {"KHR_texture_transform",
        material({{"pbrMetallicRoughness",
                   {{"baseColorTexture",
                     {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"scale", {2, 2}}}}}}}}}}})},
       {"texture 0 does not exist",
        material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}})},
       {"intensity is negative", light({{"type", "point"}, {"intensity", -1.0}})},
       {"cone angles",
        light({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.5}, {"outerConeAngle", 0.2}}}})},
       {"unknown type", light({{"type", "area"}})},
       {"field of view", [](Gltf& g) {
          g.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 4.0}, {"znear", 0.1}}}}};
          g.node({{"mesh", 0}, {"camera", 0}});
        }}});
}

}  // namespace
}  // namespace plumbline::scene
