#include "reference/scene/save_gltf.hpp"

#include <gtest/gtest.h>

#include <cstdint>

#include "reference/image/file.hpp"
#include "reference/scene/glb.hpp"
#include "validation/tests/scene/scene_files.hpp"

namespace plumbline::scene {
namespace {

using Json = nlohmann::json;

// Two squares of two materials in mixed order, every 8-bit value in a texture, lights, cameras.
Scene rich_scene() {
  Scene scene;
  scene.name = "rich";
  for (int i = 0; i < 8; ++i) {
    scene.positions.emplace_back(0.1F * static_cast<float>(i), i % 2 == 0 ? 0.3F : 1.3F,
                                 i % 4 < 2 ? -1.7F : 0.3F);
    scene.normals.push_back(glm::normalize(Vec3(0.3F * static_cast<float>(i), 1.0F, -0.2F)));
    scene.texcoords.emplace_back(0.37F * static_cast<float>(i), -1.0F);
    scene.vertex_colors.emplace_back(0.1F * static_cast<float>(i), 0.0F, 1.0F / 3.0F);
  }
  scene.triangles = {{0, 1, 2}, {4, 5, 6}, {1, 3, 2}, {5, 7, 6}};
  scene.triangle_materials = {2, 0, 2, 0};
  scene.materials = {{"grey", Rgb(0.1F, 0.2F, 0.3F), Rgb(0.0F), -1, true},
                     {"unused", Rgb(1.0F), Rgb(0.5F), -1, false},
                     {"lamp", Rgb(0.7F), Rgb(17.3F, 0.1F, 3.0F), 0, false}};
  image::Image8 levels{16, 16, {}};
  for (int i = 0; i < 256; ++i) {
    const auto level = static_cast<std::uint8_t>(i);
    levels.rgb.insert(levels.rgb.end(), {level, 0, static_cast<std::uint8_t>(255 - i)});
  }
  const image::Image picture = image::read_image(image::encode_png(levels), "levels.png");
  scene.textures = {{picture, Wrap::kClamp, Wrap::kMirror}};
  scene.lights = {
      light::PointLight{{1.0F, 2.0F, 3.0F}, {100.1F, 0.2F, 3.0F}},
      light::SpotLight{
          {3.0F, 2.0F, 1.0F}, glm::normalize(Vec3(1.0F, -2.0F, 0.3F)), Rgb(0.3F), 0.1F, 1.5707964F},
      light::DirectionalLight{{0.0F, -1.0F, 0.0F}, Rgb(3.0F)}};
  scene.cameras = {look_at({3.0F, 2.0F, 5.0F}, {0.1F, 1.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, 40.0F, "one"),
                   look_at({-3.0F, 2.0F, 5.0F}, {0.0F, 1.0F, 0.0F}, {0.3F, 1.0F, 0.0F}, 70.0F, "two")};
  return scene;
}

Scene reloaded(const Scene& scene, const std::vector<GlbExtension>& extensions = {}) {
  return load_gltf(write_scene_file("saved.glb", to_glb(scene, extensions)), {});
}

Json json_of(const std::string& glb) {
  return Json::parse(split_glb(glb, "test").json);
}

TEST(SaveGltf, RoundTripKeepsEveryBitOfTheGeometry) {
  const Scene scene = rich_scene();
  const Scene again = reloaded(scene);
  EXPECT_EQ(again.positions, scene.positions);
  EXPECT_EQ(again.normals, scene.normals);
  EXPECT_EQ(again.texcoords, scene.texcoords);
  EXPECT_EQ(again.vertex_colors, scene.vertex_colors);
  // grouped by material, in the same order inside each group
  EXPECT_EQ(again.triangles, (std::vector<glm::uvec3>{{4, 5, 6}, {5, 7, 6}, {0, 1, 2}, {1, 3, 2}}));
  EXPECT_EQ(again.triangle_materials, (std::vector<std::uint32_t>{0, 0, 2, 2}));
}

TEST(SaveGltf, RoundTripKeepsMaterialsAndTextures) {
  const Scene scene = rich_scene();
  const Scene again = reloaded(scene);
  ASSERT_EQ(again.materials.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(again.materials[i].name, scene.materials[i].name);
    EXPECT_EQ(again.materials[i].albedo, scene.materials[i].albedo);
    EXPECT_EQ(again.materials[i].emission, scene.materials[i].emission);
    EXPECT_EQ(again.materials[i].albedo_texture, scene.materials[i].albedo_texture);
    EXPECT_EQ(again.materials[i].is_double_sided, scene.materials[i].is_double_sided);
  }
  ASSERT_EQ(again.textures.size(), 1U);
  EXPECT_EQ(again.textures[0].image.pixels, scene.textures[0].image.pixels);  // all 256 levels
  EXPECT_EQ(again.textures[0].wrap_u, Wrap::kClamp);
  EXPECT_EQ(again.textures[0].wrap_v, Wrap::kMirror);
}

TEST(SaveGltf, RoundTripKeepsCamerasAndLights) {
  const Scene scene = rich_scene();
  const Scene again = reloaded(scene);
  ASSERT_EQ(again.cameras.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(again.cameras[i].name, scene.cameras[i].name);
    EXPECT_EQ(again.cameras[i].eye, scene.cameras[i].eye);
    EXPECT_EQ(again.cameras[i].forward, scene.cameras[i].forward);
    EXPECT_EQ(again.cameras[i].up, scene.cameras[i].up);
    EXPECT_EQ(again.cameras[i].vertical_fov_rad, scene.cameras[i].vertical_fov_rad);
  }
  ASSERT_EQ(again.lights.size(), 3U);
  const auto& spot = std::get<light::SpotLight>(scene.lights[1]);
  const auto& spot_again = std::get<light::SpotLight>(again.lights[1]);
  EXPECT_EQ(std::get<light::PointLight>(again.lights[0]).position, Vec3(1.0F, 2.0F, 3.0F));
  EXPECT_EQ(std::get<light::PointLight>(again.lights[0]).radiant_intensity, Rgb(100.1F, 0.2F, 3.0F));
  EXPECT_EQ(spot_again.position, spot.position);
  EXPECT_EQ(spot_again.direction, spot.direction);
  EXPECT_EQ(spot_again.radiant_intensity, spot.radiant_intensity);
  EXPECT_EQ(spot_again.inner_angle_rad, spot.inner_angle_rad);
  EXPECT_EQ(spot_again.outer_angle_rad, spot.outer_angle_rad);
  EXPECT_EQ(std::get<light::DirectionalLight>(again.lights[2]).direction, Vec3(0.0F, -1.0F, 0.0F));
  EXPECT_EQ(std::get<light::DirectionalLight>(again.lights[2]).irradiance, Rgb(3.0F));
}

TEST(SaveGltf, TheSecondSaveIsTheFirst) {
  const Scene once = reloaded(rich_scene());
  const Scene twice = reloaded(once);
  EXPECT_EQ(fingerprint(twice), fingerprint(once));
  EXPECT_EQ(to_glb(rich_scene()), to_glb(rich_scene()));
}

TEST(SaveGltf, WritesWhatAViewerNeeds) {
  const std::string glb = to_glb(rich_scene());
  const Json root = json_of(glb);
  EXPECT_EQ(root["asset"]["generator"], "Plumbline " PLUMBLINE_VERSION);
  EXPECT_EQ(root["meshes"][0]["primitives"].size(), 2U);
  EXPECT_EQ(root["meshes"][0]["primitives"][0]["attributes"],
            root["meshes"][0]["primitives"][1]["attributes"]);
  const Json& position =
      root["accessors"][root["meshes"][0]["primitives"][0]["attributes"]["POSITION"].get<std::size_t>()];
  EXPECT_EQ(position["min"][1], static_cast<double>(0.3F));
  EXPECT_EQ(position["max"][2], static_cast<double>(0.3F));
  EXPECT_EQ(root["materials"][2]["pbrMetallicRoughness"]["metallicFactor"], 0.0);
  for (const Json& component : root["materials"][2]["emissiveFactor"])
    EXPECT_LE(component.get<double>(), 1.0);
  for (const Json& view : root["bufferViews"]) EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0U);
  EXPECT_FALSE(root.contains("extensionsRequired"));
  EXPECT_EQ(glb.size() % 4, 0U);
}

TEST(SaveGltf, ExtensionsComeBackAndDoNotDisturb) {
  const std::vector<GlbExtension> extensions = {
      {"PLUMBLINE_a", {{"bands", 4}, {"nested", {{"x", 0.1}}}}, std::string("\0\1odd", 5)},
      {"PLUMBLINE_b", Json::object(), std::string(1000, 'b')},
      {"PLUMBLINE_c", {{"text", "no bytes"}}, ""}};
  const auto path = write_scene_file("extended.glb", to_glb(rich_scene(), extensions));
  for (const GlbExtension& extension : extensions) {
    const auto read = read_glb_extension(path, extension.name);
    ASSERT_TRUE(read.has_value()) << extension.name;
    EXPECT_EQ(read->json, extension.json);
    EXPECT_EQ(read->bytes, extension.bytes);
  }
  EXPECT_FALSE(read_glb_extension(path, "PLUMBLINE_d").has_value());
  const Json root = json_of(read_file(path));
  const std::size_t view = root["extensions"]["PLUMBLINE_b"]["bufferView"].get<std::size_t>();
  EXPECT_EQ(root["bufferViews"][view]["byteOffset"].get<std::size_t>() % 8, 0U);
  EXPECT_EQ(fingerprint(load_gltf(path, {})), fingerprint(reloaded(rich_scene())));
}

TEST(SaveGltf, RefusesWhatItCannotWrite) {
  Scene broken = rich_scene();
  broken.normals[0] = Vec3(0.0F);
  EXPECT_THROW((void)to_glb(broken), InputError);
  const Scene scene = rich_scene();
  EXPECT_THROW((void)to_glb(scene, {{"A", Json::array(), ""}}), InputError);
  EXPECT_THROW((void)to_glb(scene, {{"A", {{"bufferView", 1}}, ""}}), InputError);
  EXPECT_THROW((void)to_glb(scene, {{"A", Json::object(), ""}, {"A", Json::object(), ""}}), InputError);
  EXPECT_THROW(save_glb(scene, "/no/such/folder/a.glb"), InputError);
}

TEST(SaveGltf, SavesByRename) {
  const auto folder = write_scene_file("x", "x").parent_path();
  save_glb(rich_scene(), folder / "file.glb");
  EXPECT_EQ(read_file(folder / "file.glb"), to_glb(rich_scene()));
}

TEST(SaveGltf, NamesMayHoldAnyBytes) {
  Scene scene = rich_scene();
  scene.materials[0].name = "caf\xE9 \"quoted\"\n";
  EXPECT_EQ(reloaded(scene).positions, scene.positions);
}

TEST(ReadGlbExtension, EveryTruncationIsRefused) {
  const std::string whole = to_glb(rich_scene(), {{"PLUMBLINE_a", Json::object(), "bytes"}});
  for (std::size_t size = 0; size < whole.size(); size += size < 100 ? 1 : 97) {
    const auto path = write_scene_file("cut.glb", whole.substr(0, size));
    const std::string message = refusal([&] { (void)read_glb_extension(path, "PLUMBLINE_a"); });
    EXPECT_NE(message.find("cut.glb: "), std::string::npos) << size << ": " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << size << ": " << message;
  }
}

TEST(ReadGlbExtension, RefusesViewsThatDoNotFit) {
  const std::vector<std::pair<const char*, const char*>> faults = {
      {R"("bufferView": 1)", "does not exist"},           {R"("bufferView": -1)", "not a whole number"},
      {R"("bufferView": 0.5)", "not a whole number"},     {R"("bufferView": "0")", "not a whole number"},
      {R"("bufferView": 0)", "exceeds the binary chunk"},
  };
  for (const auto& [member, reason] : faults) {
    const std::string json =
        std::string(R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": 8}], )") +
        R"("bufferViews": [{"buffer": 0, "byteOffset": 4, "byteLength": 5}], )" + R"("extensions": {"A": {)" +
        member + "}}}";
    const auto path = write_scene_file("bad.glb", join_glb(json, "12345678"));
    const std::string message = refusal([&] { (void)read_glb_extension(path, "A"); });
    EXPECT_NE(message.find("bad.glb"), std::string::npos) << message;
    EXPECT_NE(message.find(reason), std::string::npos) << message;
  }
  const auto no_glb = write_scene_file("text.glb", "{}");
  EXPECT_NE(refusal([&] { (void)read_glb_extension(no_glb, "A"); }).find("is not binary glTF"),
            std::string::npos);
  const auto no_json = write_scene_file("nojson.glb", join_glb("{\n]", ""));
  EXPECT_NE(refusal([&] { (void)read_glb_extension(no_json, "A"); }).find("cannot read"), std::string::npos);
}

}  // namespace
}  // namespace plumbline::scene
