#include <gtest/gtest.h>

#include "reference/image/file.hpp"
#include "validation/tests/scene/scene_files.hpp"

namespace plumbline::scene {
namespace {

constexpr const char* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

Scene load(std::string_view text, const LoadOptions& options = {}) {
  return load_obj(write_scene_file("scene.obj", text), options);
}

TEST(LoadObj, KeepsTheFilesVerticesInOrder) {
  const Scene scene = load("# comment\r\nv 0 0 0\nv 9 9 9\nv 1 0 0\nv 0 1 0 # end\no x\ns off\nf 1 3 4");
  ASSERT_EQ(scene.positions.size(), 4U);
  EXPECT_EQ(scene.positions[1], Vec3(9.0F));
  EXPECT_EQ(scene.triangles[0], glm::uvec3(0, 2, 3));
  EXPECT_EQ(scene.normals[0], Vec3(0.0F, 0.0F, 1.0F));
  EXPECT_EQ(scene.materials[0].albedo, Rgb(0.8F));
  EXPECT_EQ(scene.cameras.size(), 1U);
  EXPECT_EQ(scene.name, "scene");
}

TEST(LoadObj, NegativeIndicesCountFromTheEndSoFar) {
  const Scene scene = load("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 5 5\nv 6 5 5\nv 5 6 5\nf -3 -2 -1\n");
  EXPECT_EQ(scene.triangles[0], glm::uvec3(0, 1, 2));
  EXPECT_EQ(scene.triangles[1], glm::uvec3(3, 4, 5));
}

TEST(LoadObj, SharesEqualTuplesAndCopiesDifferentOnes) {
  const Scene scene = load(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 2\n"
      "f 1/1/1 2/2/1 3/3/1\nf 2/2/1 4/1/1 3/2/1\n");
  ASSERT_EQ(scene.positions.size(), 5U);  // vertex 3 has two texture coordinates
  EXPECT_EQ(scene.triangles[1], glm::uvec3(1, 3, 4));
  EXPECT_EQ(scene.positions[4], Vec3(0.0F, 1.0F, 0.0F));
  EXPECT_EQ(scene.texcoords[2], Vec2(0.0F, 0.0F));  // vt 0 1 is the top
  EXPECT_EQ(scene.texcoords[4], Vec2(1.0F, 1.0F));
  EXPECT_EQ(scene.normals[4], Vec3(0.0F, 0.0F, 1.0F));
}

TEST(LoadObj, TriangulatesPolygonsAndJoinsLines) {
  const Scene scene = load("v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 \\\n 4 5 6\n");
  ASSERT_EQ(scene.triangles.size(), 4U);
  for (std::uint32_t t = 0; t < 4; ++t) EXPECT_EQ(geometric_normal(scene, t), Vec3(0.0F, 0.0F, 1.0F));
}

TEST(LoadObj, ReadsMaterialsAndTextures) {
  const auto png = image::encode_png({1, 1, {255, 0, 128}});
  (void)write_scene_file("a map.png", png);
  (void)write_scene_file("my lib.mtl",
                         "newmtl first one\nKd 0.1 0.2 0.3\nKe 4 5 6\nNs 10\n"
                         "newmtl second\nmap_Kd -clamp on a map.png\nKd 1 1 1\n");
  const Scene scene = load(
      "mtllib my lib.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0.5 0.5\n"
      "usemtl second\nf 1/1 2/1 3/1\nusemtl first one\nf 1 2 3\nusemtl unknown\nf 1 2 3\n");
  ASSERT_EQ(scene.materials.size(), 3U);
  EXPECT_EQ(scene.materials[0].name, "first one");
  EXPECT_EQ(scene.materials[0].albedo, Rgb(0.1F, 0.2F, 0.3F));
  EXPECT_EQ(scene.materials[0].emission, Rgb(4.0F, 5.0F, 6.0F));
  EXPECT_EQ(scene.triangle_materials, (std::vector<std::uint32_t>{1, 0, 2}));
  EXPECT_EQ(scene.materials[2].albedo, Rgb(0.8F));
  ASSERT_EQ(scene.textures.size(), 1U);
  EXPECT_EQ(scene.textures[0].wrap_u, Wrap::kClamp);
  expect_same_vector(albedo_at(scene, 0, {0.2F, 0.2F}),
                     {1.0F, 0.0F, image::linear_from_srgb(128.0F / 255.0F)});
}

TEST(LoadObj, AMissingMaterialFileLeavesTheDefault) {
  const Scene scene = load(std::string("mtllib none.mtl\nusemtl a\n") + kTriangle);
  EXPECT_EQ(scene.materials[0].albedo, Rgb(0.8F));
}

TEST(LoadObj, ReadsVertexColours) {
  const Scene scene = load("v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nv 1 1 1\nf 1 2 3\n");
  ASSERT_EQ(scene.vertex_colors.size(), 4U);
  EXPECT_EQ(scene.vertex_colors[1], Rgb(0.0F, 1.0F, 0.0F));
  EXPECT_EQ(scene.vertex_colors[3], Rgb(1.0F));
}

TEST(LoadObj, DropsAndCountsDegenerateTriangles) {
  const Scene scene = load(std::string(kTriangle) + "f 1 2 2\nv 2 0 0\nf 1 2 4\n");
  EXPECT_EQ(scene.triangles.size(), 1U);
  EXPECT_EQ(scene.triangle_materials.size(), 1U);
  EXPECT_EQ(scene.dropped_degenerate, 2U);
}

TEST(LoadObj, RefusesDamagedFilesInOneLineThatNamesThem) {
  const std::vector<std::pair<const char*, const char*>> faults = {
      {"v 0 0 x\n", "scene.obj:1: \"x\" is not a number"},
      {"v 0 0\n", "2 numbers"},
      {"v 0 0 0\nf 1 2 3\n", "scene.obj:2: vertex index 2 is out of range"},
      {"v 0 0 0\nf 0 1 1\n", "vertex index 0"},
      {"v 0 0 0\nf -2 1 1\n", "vertex index -2"},
      {"v 0 0 0\nf 1 1\n", "2 corners"},
      {"v 0 0 0\nf 1/2 1 1\n", "texture coordinate index 2"},
      {"v 0 0 0\nf 1//1 1 1\n", "normal index 1"},
      {"v 0 0 0\nf 1/1/1/1 1 1\n", "v/vt/vn"},
      {"v 0 0 0\nf 1 1 99999999999999999999\n", "is not a vertex index"},
      {"v 0 0 0\nf 1 1 1.5\n", "is not a vertex index"},
      {"v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n", "position of vertex 1 is not finite"},
      {"v 0 0 0\nv 1 0 0\nv 0 1 0\nvn nan 0 0\nf 1//1 2//1 3//1\n", "normal of vertex 0 is not finite"},
      {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 \\", "should go on"},
      {"v 0 0 0\nv 1 0 0\n", "has no triangles"},
      {"v 0 0 0\nv 1 0 0\nf 1 2 2\nf 1 1 1\n", "no triangle has any area"},
      {"\n", "has no triangles"},
      {"", "is empty"},
  };
  for (const auto& [text, reason] : faults) expect_refused(write_scene_file("scene.obj", text), reason);
}

TEST(LoadObj, RefusesDamagedMaterials) {
  const std::vector<std::pair<const char*, const char*>> faults = {
      {"newmtl a\nKd 0.1 x 0\n", "lib.mtl:2"},
      {"newmtl a\nKd spectral file\n", "3"},
      {"newmtl a\nmap_Kd none.png\n", "none.png"},
      {"newmtl a\nmap_Kd lib.mtl\n", "lib.mtl"},
      {"newmtl a\nmap_Ke e.png\n", "emissive texture"},
      {"newmtl a\nKd 2 0 0\n", "outside [0, 1]"},
      {"newmtl a\nKe -1 0 0\n", "emission"},
  };
  for (const auto& [mtl, reason] : faults) {
    (void)write_scene_file("lib.mtl", mtl);
    expect_refused(write_scene_file("scene.obj", std::string("mtllib lib.mtl\nusemtl a\n") + kTriangle),
                   reason);
  }
}

TEST(LoadObj, LoadsTheBunnyAsAClosedMeshThatFacesOutwards) {
  const std::filesystem::path bunny = "/usr/share/glmark2/models/bunny.obj";
  ASSERT_TRUE(std::filesystem::exists(bunny)) << bunny << " is missing: `ci/install data` brings it";
  const Scene scene = load_obj(bunny, {.crease_deg = 180.0F});
  EXPECT_EQ(scene.positions.size(), 34835U);
  EXPECT_EQ(scene.triangles.size(), 69666U);
  EXPECT_EQ(scene.dropped_degenerate, 0U);
  EXPECT_TRUE(is_closed(scene));
  EXPECT_GT(six_volumes(scene), 0.0);
}

}  // namespace
}  // namespace plumbline::scene
