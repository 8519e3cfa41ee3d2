// Normal maps: what a texel means, tangent frames given and computed, files, hostile input.
#include "reference/scene/normal_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "reference/image/file.hpp"
#include "reference/scene/builtin.hpp"
#include "reference/scene/glb.hpp"
#include "reference/scene/load.hpp"
#include "reference/scene/save_gltf.hpp"
#include "reference/scene/tangents.hpp"
#include "reference/trace/surface_table.hpp"
#include "validation/tests/scene/scene_files.hpp"

namespace plumbline::scene {
namespace {

using Json = nlohmann::json;

/// The unit square in the plane z = 0, seen from +z as an image lies: u to the right, v down.
Scene mapped_square(Rgb texel) {
  Scene scene;
  scene.name = "mapped";
  scene.positions = {{0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {1.0F, 1.0F, 0.0F}, {0.0F, 1.0F, 0.0F}};
  scene.normals.assign(4, Vec3(0.0F, 0.0F, 1.0F));
  scene.texcoords = {{0.0F, 1.0F}, {1.0F, 1.0F}, {1.0F, 0.0F}, {0.0F, 0.0F}};
  scene.triangles = {{0U, 1U, 2U}, {0U, 2U, 3U}};
  scene.triangle_materials = {0U, 0U};
  scene.materials = {{.name = "m", .normal_texture = 0}};
  scene.textures = {{image::make_image(2, 2, texel)}};
  scene.cameras = {Camera{}};
  scene.tangents.assign(4, glm::vec4(0.0F));
  return with_computed_tangents(std::move(scene));
}

Vec3 normal_at(const Scene& scene, std::uint32_t triangle) {
  const trace::Hit hit{triangle, Vec2(0.3F, 0.3F), 1.0F};
  return trace::surface_hit(scene, hit, Vec3(0.0F, 0.0F, -1.0F)).point.shading_normal;
}

void expect_near(const Vec3& found, const Vec3& expected) {
  EXPECT_LE(glm::length(found - expected), 1e-6F) << found.x << " " << found.y << " " << found.z;
}

// Red 1, green 1/2: leans to +u. Green 1: leans up in the image, which is +y here.
TEST(NormalMap, RedLeansAlongUAndGreenUpInTheImage) {
  expect_near(normal_at(mapped_square({0.5F, 0.5F, 1.0F}), 0), {0.0F, 0.0F, 1.0F});
  expect_near(normal_at(mapped_square({0.8F, 0.5F, 0.9F}), 0), {0.6F, 0.0F, 0.8F});
  expect_near(normal_at(mapped_square({0.5F, 0.8F, 0.9F}), 1), {0.0F, 0.6F, 0.8F});
}

TEST(NormalMap, AMirroredTextureMirrorsTheLean) {
  Scene scene = mapped_square({0.8F, 0.8F, 0.9F});
  expect_near(normal_at(scene, 0), glm::normalize(Vec3(0.6F, 0.6F, 0.8F)));
  for (Vec2& uv : scene.texcoords) uv.x = 1.0F - uv.x;
  scene.tangents.assign(4, glm::vec4(0.0F));
  scene = with_computed_tangents(std::move(scene));
  EXPECT_EQ(scene.tangents[0].w, -1.0F);
  expect_near(normal_at(scene, 0), glm::normalize(Vec3(-0.6F, 0.6F, 0.8F)));
}

TEST(NormalMap, TheScaleMultipliesTheLean) {
  Scene scene = mapped_square({0.8F, 0.65F, 0.9F});
  scene.materials[0].normal_scale = 2.0F;
  expect_near(normal_at(scene, 0), glm::normalize(Vec3(1.2F, 0.6F, 0.8F)));
  scene.materials[0].normal_scale = 0.0F;
  expect_near(normal_at(scene, 0), {0.0F, 0.0F, 1.0F});
}

TEST(NormalMap, TheTracersTableGivesTheSame) {
  const Scene scene = make_builtin_scene("normal-mapped");
  const trace::SurfaceTable table(scene);
  int bent = 0;
  for (std::uint32_t t = 0; t < scene.triangles.size(); t += 7) {
    const trace::Hit hit{t, Vec2(0.2F, 0.5F), 1.0F};
    const Vec3 towards = -geometric_normal(scene, t);
    const trace::SurfacePoint expected = trace::surface_hit(scene, hit, towards).point;
    const trace::SurfacePoint found = table.hit(hit, towards).point;
    ASSERT_EQ(found.shading_normal, expected.shading_normal) << t;
    EXPECT_NEAR(glm::length(found.shading_normal), 1.0F, 1e-6F);
    if (glm::dot(found.shading_normal, found.geometric_normal) < 0.99F) ++bent;
  }
  EXPECT_GE(bent, 500);  // of 2048
}

// The ring's own tangent is known: d/da of its centre line.
TEST(NormalMap, ComputedTangentsFollowTheSurface) {
  const Scene scene = make_builtin_scene("normal-mapped");
  const std::size_t first = 49 * 49 + 33 * 33;
  ASSERT_EQ(scene.positions.size(), first + 97 * 41);
  for (std::size_t i = 0; i < 97 * 41; ++i) {
    const double a = 2.0 * kPi * static_cast<double>(i % 97) / 96.0;
    const glm::vec4 t = scene.tangents[first + i];
    EXPECT_EQ(t.w, 1.0F);
    // Half of a cell of 2 pi / 96 on the seams, whose vertices see one side only.
    EXPECT_GE(glm::dot(Vec3(t), Vec3(Vec3d(-std::sin(a), std::cos(a), 0.0))), std::cos(kPi / 96.0) - 1e-5);
    EXPECT_LE(std::abs(glm::dot(Vec3(t), scene.normals[first + i])), 1e-6F);
  }
}

TEST(NormalMap, AVertexUsedByBothHandednessesIsSplit) {
  Scene scene = mapped_square({0.8F, 0.5F, 0.9F});
  // A second square left of the first, its texture mirrored at the common edge.
  scene.positions.insert(scene.positions.end(), {{-1.0F, 0.0F, 0.0F}, {-1.0F, 1.0F, 0.0F}});
  scene.normals.resize(6, Vec3(0.0F, 0.0F, 1.0F));
  scene.texcoords.insert(scene.texcoords.end(), {{1.0F, 1.0F}, {1.0F, 0.0F}});
  scene.triangles.insert(scene.triangles.end(), {{4U, 0U, 3U}, {4U, 3U, 5U}});
  scene.triangle_materials.resize(4, 0U);
  scene.tangents.assign(6, glm::vec4(0.0F));
  scene = with_computed_tangents(std::move(scene));
  EXPECT_EQ(scene.positions.size(), 8U);
  EXPECT_NO_THROW(validate(scene, "split"));
  expect_near(normal_at(scene, 0), {0.6F, 0.0F, 0.8F});
  expect_near(normal_at(scene, 2), {-0.6F, 0.0F, 0.8F});
}

// ---------------------------------------------------------------- files

Scene reloaded(const Scene& scene) {
  return load_gltf(write_scene_file("mapped.glb", to_glb(scene)), {});
}

TEST(NormalMap, RoundTripKeepsEveryBit) {
  Scene scene = make_builtin_scene("normal-mapped");
  scene.materials[1].normal_scale = 0.3F;
  const Scene again = reloaded(scene);
  EXPECT_EQ(again.tangents, scene.tangents);
  EXPECT_EQ(again.materials[1].normal_scale, 0.3F);
  EXPECT_EQ(again.textures[0].image.pixels, scene.textures[0].image.pixels);
  // The pose of a camera passes through its glTF matrix; all else is the same.
  Scene with_same_cameras = again;
  with_same_cameras.cameras = scene.cameras;
  // Vertices of three primitives, in the order of their materials: as they were.
  EXPECT_EQ(fingerprint(with_same_cameras), fingerprint(scene));
}

TEST(NormalMap, FingerprintChangesWithTheMapAndOnlyThen) {
  const Scene scene = make_builtin_scene("normal-mapped");
  const std::vector<std::function<void(Scene&)>> changes = {
      [](Scene& s) { s.materials[0].normal_scale = 0.5F; },
      [](Scene& s) { s.materials[2].normal_texture = -1; }, [](Scene& s) { s.tangents[5].w = -1.0F; },
      [](Scene& s) { s.textures[0].image.pixels[9].x = 0.25F; }};
  for (const auto& change : changes) {
    Scene changed = scene;
    change(changed);
    EXPECT_NE(fingerprint(changed), fingerprint(scene));
  }
}

/// The square as glTF; `change` may spoil its JSON, `tangents` are four numbers a vertex.
Scene load_changed(const std::function<void(Json&)>& change, const std::vector<float>& tangents = {}) {
  Scene scene = mapped_square({0.8F, 0.5F, 0.9F});
  if (!tangents.empty()) {
    for (std::size_t v = 0; v < 4; ++v) {
      for (int c = 0; c < 4; ++c) scene.tangents[v][c] = tangents[4 * v + static_cast<std::size_t>(c)];
    }
  }
  std::string glb = to_glb(mapped_square({0.8F, 0.5F, 0.9F}));
  const GlbChunks chunks = split_glb(glb, "test");
  Json root = Json::parse(chunks.json);
  std::string binary(chunks.binary);
  if (!tangents.empty()) {
    const auto accessor = root["meshes"][0]["primitives"][0]["attributes"]["TANGENT"].get<std::size_t>();
    const auto view = root["accessors"][accessor]["bufferView"].get<std::size_t>();
    binary.replace(root["bufferViews"][view]["byteOffset"].get<std::size_t>(), 64,
                   std::string_view(reinterpret_cast<const char*>(scene.tangents.data()), 64));
  }
  change(root);
  return load_gltf(write_scene_file("changed.glb", join_glb(root.dump(), binary)), {});
}

Json& attributes(Json& root) {
  return root["meshes"][0]["primitives"][0]["attributes"];
}

TEST(NormalMap, ComputesTangentsWhereTheFileHasNone) {
  const Scene given = load_changed([](Json&) {});
  const Scene computed = load_changed([](Json& root) { attributes(root).erase("TANGENT"); });
  EXPECT_EQ(given.tangents, computed.tangents);
  // Tangents go with the normals they belong to.
  const Scene without_normals = load_changed([](Json& root) { attributes(root).erase("NORMAL"); },
                                             {0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 0, 1});
  EXPECT_EQ(without_normals.tangents, given.tangents);
}

TEST(NormalMap, TangentsOfTheFileCountAndAreMadeUnitLength) {
  const Scene scene = load_changed([](Json&) {}, {0, 2, 0, 1, 0, 2, 0, 1, 0, 2, 0, 1, 0, 2, 0, 1});
  EXPECT_EQ(scene.tangents[0], glm::vec4(0.0F, 1.0F, 0.0F, 1.0F));
  // 8 bits hold 0.8 exactly (204) and 0.5 not: 128.
  EXPECT_NEAR(normal_at(scene, 0).y, 0.6F, 0.005F);
}

TEST(NormalMap, MirroredNodesMirrorTheMap) {
  const Scene scene = load_changed([](Json& root) { root["nodes"][0]["scale"] = {-1.0, 1.0, 1.0}; });
  EXPECT_NEAR(normal_at(scene, 0).x, -0.6F, 0.005F);
  EXPECT_NEAR(normal_at(scene, 0).y, 0.0F, 0.005F);
  EXPECT_EQ(scene.tangents[0].w, -1.0F);
}

TEST(NormalMap, TangentsWithoutANormalMapAreDropped) {
  const Scene scene = load_changed([](Json& root) { root["materials"][0].erase("normalTexture"); });
  EXPECT_TRUE(scene.tangents.empty());
}

TEST(NormalMap, RefusesHostileFiles) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto refused = [](const std::string& reason, const std::function<void(Json&)>& change,
                          const std::vector<float>& tangents = {}) {
    const std::string message = refusal([&] { (void)load_changed(change, tangents); });
    EXPECT_NE(message.find(reason), std::string::npos) << message << "\nexpected: " << reason;
    EXPECT_NE(message.find("changed.glb"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  };
  const auto nothing = [](Json&) {};
  refused("tangent of vertex 0", nothing, {nan, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1});
  refused("tangent of vertex 1", nothing, {1, 0, 0, 1, 1, 0, 0, 0.5F, 1, 0, 0, 1, 1, 0, 0, 1});
  refused("tangent of vertex 3", nothing, {1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, nan});
  refused("elements of 3 components",
          [](Json& root) { attributes(root)["TANGENT"] = attributes(root)["NORMAL"]; });
  refused("texture 7 does not exist", [](Json& root) { root["materials"][0]["normalTexture"]["index"] = 7; });
  refused("one set is supported", [](Json& root) {
    root["materials"][0]["normalTexture"]["texCoord"] = 1;
    root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
  });
  refused("KHR_texture_transform", [](Json& root) {
    root["materials"][0]["normalTexture"]["extensions"]["KHR_texture_transform"] = Json::object();
  });
}

TEST(NormalMap, ValidateRefusesEachFault) {
  const std::vector<std::pair<const char*, std::function<void(Scene&)>>> faults = {
      {"does not point out", [](Scene& s) { s.textures[0].image.pixels[3] = Rgb(0.5F); }},
      {"does not point out", [](Scene& s) { s.textures[0].image.pixels[3] = Rgb(0.0F); }},
      {"does not point out", [](Scene& s) { s.textures[0].image.pixels[3].z = std::nanf(""); }},
      {"outside [0, 1]", [](Scene& s) { s.textures[0].image.pixels[3].x = 1.5F; }},
      {"normal scale of material 0", [](Scene& s) { s.materials[0].normal_scale = std::nanf(""); }},
      {"as normal map", [](Scene& s) { s.materials[0].normal_texture = 1; }},
      {"an albedo and", [](Scene& s) { s.materials[0].albedo_texture = 0; }},
      {"3 tangents for 4 vertices", [](Scene& s) { s.tangents.pop_back(); }},
      {"0 tangents", [](Scene& s) { s.tangents.clear(); }},
      {"tangent of vertex 2", [](Scene& s) { s.tangents[2] *= 1.01F; }},
      {"material 0 has a texture", [](Scene& s) { s.spheres.push_back({}); }},
  };
  for (const auto& [reason, apply] : faults) {
    Scene scene = mapped_square({0.8F, 0.5F, 0.9F});
    apply(scene);
    const std::string message = refusal([&] { validate(scene, "here"); });
    EXPECT_NE(message.find(reason), std::string::npos) << message << "\nexpected: " << reason;
  }
  EXPECT_NO_THROW(validate(mapped_square({0.8F, 0.5F, 0.9F}), "here"));
}

}  // namespace
}  // namespace plumbline::scene
