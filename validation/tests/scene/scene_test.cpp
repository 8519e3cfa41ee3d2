#include "reference/scene/scene.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "reference/base/error.hpp"
#include "reference/scene/load.hpp"
#include "validation/tests/scene/scene_files.hpp"

namespace plumbline::scene {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// One triangle with everything a scene can hold.
Scene full_scene() {
  Scene scene;
  scene.name = "full";
  scene.positions = {{0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}};
  scene.normals.assign(3, Vec3(0.0F, 0.0F, 1.0F));
  scene.texcoords = {{0.0F, 0.0F}, {1.0F, 0.0F}, {0.0F, 1.0F}};
  scene.vertex_colors = {{1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, {0.0F, 0.0F, 1.0F}};
  scene.triangles = {{0U, 1U, 2U}};
  scene.triangle_materials = {0U};
  scene.materials = {{"m", Rgb(0.5F), Rgb(0.0F), 0, false}};
  scene.textures = {{image::make_image(2, 2, Rgb(0.5F))}};
  scene.lights = {light::PointLight{Vec3(1.0F), Rgb(1.0F)}, light::SpotLight{}, light::DirectionalLight{}};
  scene.cameras = {Camera{}};
  return scene;
}

using Change = std::pair<const char*, std::function<void(Scene&)>>;

TEST(Scene, ValidateAcceptsAWholeScene) {
  EXPECT_NO_THROW(validate(full_scene(), "full"));
}

TEST(Scene, ValidateRefusesEachFault) {
  const std::vector<Change> faults = {
      {"no triangles", [](Scene& s) { s.triangles.clear(); }},
      {"vertex 3", [](Scene& s) { s.triangles[0].z = 3; }},
      {"material 1", [](Scene& s) { s.triangle_materials[0] = 1; }},
      {"triangle materials", [](Scene& s) { s.triangle_materials.clear(); }},
      {"position of vertex 1", [](Scene& s) { s.positions[1].x = kNan; }},
      {"position of vertex 2", [](Scene& s) { s.positions[2].y = 1e19F; }},
      {"normal of vertex 0", [](Scene& s) { s.normals[0].y = kNan; }},
      {"normal of vertex 0", [](Scene& s) { s.normals[0] *= 1.01F; }},
      {"normals", [](Scene& s) { s.normals.pop_back(); }},
      {"texture coordinates", [](Scene& s) { s.texcoords.pop_back(); }},
      {"texture coordinate of vertex 1", [](Scene& s) { s.texcoords[1].y = kNan; }},
      {"no texture coordinates", [](Scene& s) { s.texcoords.clear(); }},
      {"vertex colours", [](Scene& s) { s.vertex_colors.pop_back(); }},
      {"colour of vertex 2", [](Scene& s) { s.vertex_colors[2].x = 1.5F; }},
      {"albedo of material 0", [](Scene& s) { s.materials[0].albedo.x = 1.01F; }},
      {"albedo of material 0", [](Scene& s) { s.materials[0].albedo.x = kNan; }},
      {"emission of material 0", [](Scene& s) { s.materials[0].emission.y = -1.0F; }},
      {"uses texture 1", [](Scene& s) { s.materials[0].albedo_texture = 1; }},
      {"texture 0 has size", [](Scene& s) { s.textures[0].image.width = 3; }},
      {"texture 0 has a texel", [](Scene& s) { s.textures[0].image.pixels[1].x = kNan; }},
      {"no area",
       [](Scene& s) {
         s.positions[2] = {2.0F, 0.0F, 0.0F};
       }},
      {"no area", [](Scene& s) { s.triangles[0].z = 1; }},
      {"light 0", [](Scene& s) { std::get<0>(s.lights[0]).radiant_intensity.x = -1.0F; }},
      {"light 1", [](Scene& s) { std::get<1>(s.lights[1]).inner_angle_rad = 1.0F; }},
      {"light 2", [](Scene& s) { std::get<2>(s.lights[2]).direction = Vec3(0.0F); }},
      {"camera 0", [](Scene& s) { s.cameras[0].vertical_fov_rad = 3.2F; }},
      {"camera 0", [](Scene& s) { s.cameras[0].up = s.cameras[0].forward; }},
      {"camera 0", [](Scene& s) { s.cameras[0].eye.z = kNan; }},
  };
  for (const auto& [reason, apply] : faults) {
    Scene scene = full_scene();
    apply(scene);
    const std::string message = refusal([&] { validate(scene, "here"); });
    EXPECT_NE(message.find(reason), std::string::npos) << message << "\nexpected: " << reason;
    EXPECT_EQ(message.rfind("here: ", 0), 0U) << message;
  }
}

TEST(Scene, DegenerateIsJudgedByShapeNotBySize) {
  for (const float size : {1e-15F, 1e-6F, 1.0F, 1e6F, 1e15F}) {
    const Vec3 a = size * Vec3(1.0F, 2.0F, 3.0F);
    const Vec3 b = size * Vec3(2.0F, 2.0F, 3.0F);
    EXPECT_FALSE(is_degenerate(a, b, size * Vec3(1.0F, 2.001F, 3.0F))) << "size " << size;
    EXPECT_TRUE(is_degenerate(a, b, b)) << "size " << size;
    EXPECT_TRUE(is_degenerate(a, b, 0.5F * (a + b))) << "size " << size;
  }
  EXPECT_TRUE(is_degenerate(Vec3(0.0F), Vec3(1.0F, 0.0F, 0.0F), Vec3(kNan)));
}

TEST(Scene, BoundsLeaveOutUnusedVertices) {
  Scene scene = full_scene();
  scene.positions.emplace_back(100.0F);
  EXPECT_EQ(bounds(scene).low, Vec3(0.0F));
  EXPECT_EQ(bounds(scene).high, Vec3(1.0F, 1.0F, 0.0F));
}

TEST(Scene, GeometricNormalIsCounterClockwiseAndUnitAtAnySize) {
  Scene scene = full_scene();
  EXPECT_EQ(geometric_normal(scene, 0), Vec3(0.0F, 0.0F, 1.0F));
  for (Vec3& p : scene.positions) p *= 1e-15F;  // squares of its squares underflow in float
  EXPECT_EQ(geometric_normal(scene, 0), Vec3(0.0F, 0.0F, 1.0F));
  std::swap(scene.triangles[0].y, scene.triangles[0].z);
  EXPECT_EQ(geometric_normal(scene, 0), Vec3(0.0F, 0.0F, -1.0F));
}

TEST(Scene, AlbedoIsFactorTimesTextureTimesVertexColour) {
  const Scene scene = full_scene();
  expect_same_vector(albedo_at(scene, 0, {0.0F, 0.0F}), {0.25F, 0.0F, 0.0F});
  expect_same_vector(albedo_at(scene, 0, {1.0F, 0.0F}), {0.0F, 0.25F, 0.0F});
  expect_same_vector(albedo_at(scene, 0, {0.25F, 0.5F}), {0.0625F, 0.0625F, 0.125F});
  Scene plain = full_scene();
  plain.vertex_colors.clear();
  plain.materials[0].albedo_texture = -1;
  EXPECT_EQ(albedo_at(plain, 0, {0.3F, 0.3F}), Rgb(0.5F));
}

// A 2x2 texture, white at top left, red at its right, black below; uv of the triangle's first vertex.
Rgb texel_at(Vec2 uv, Wrap wrap) {
  Scene scene = full_scene();
  scene.vertex_colors.clear();
  scene.materials[0].albedo = Rgb(1.0F);
  scene.textures[0].image = image::make_image(2, 2, Rgb(0.0F));
  scene.textures[0].image.at(0, 0) = Rgb(1.0F);
  scene.textures[0].image.at(1, 0) = Rgb(1.0F, 0.0F, 0.0F);
  scene.textures[0].wrap_u = scene.textures[0].wrap_v = wrap;
  scene.texcoords.assign(3, uv);
  return albedo_at(scene, 0, {0.0F, 0.0F});
}

TEST(Scene, VertexAlbedosAreThoseOfTheCorners) {
  Scene scene = full_scene();
  scene.positions.emplace_back(5.0F);  // no triangle uses it
  scene.normals.emplace_back(0.0F, 1.0F, 0.0F);
  scene.texcoords.emplace_back(0.0F);
  scene.vertex_colors.emplace_back(1.0F);
  const std::vector<Rgb> albedos = vertex_albedos(scene);
  ASSERT_EQ(albedos.size(), 4U);
  EXPECT_EQ(albedos[0], Rgb(0.25F, 0.0F, 0.0F));  // factor 1/2, texture 1/2, vertex colour
  EXPECT_EQ(albedos[1], Rgb(0.0F, 0.25F, 0.0F));
  EXPECT_EQ(albedos[2], Rgb(0.0F, 0.0F, 0.25F));
  EXPECT_EQ(albedos[3], Rgb(0.0F));
}

TEST(Scene, TextureIsBilinearBetweenTexelCentres) {
  const Rgb white(1.0F);
  const Rgb red(1.0F, 0.0F, 0.0F);
  EXPECT_EQ(texel_at({0.25F, 0.25F}, Wrap::kRepeat), white);
  EXPECT_EQ(texel_at({0.75F, 0.25F}, Wrap::kRepeat), red);
  EXPECT_EQ(texel_at({0.25F, 0.75F}, Wrap::kRepeat), Rgb(0.0F));
  EXPECT_EQ(texel_at({0.5F, 0.25F}, Wrap::kRepeat), Rgb(1.0F, 0.5F, 0.5F));
  EXPECT_EQ(texel_at({0.5F, 0.5F}, Wrap::kRepeat), Rgb(0.5F, 0.25F, 0.25F));
}

TEST(Scene, TextureWrapsAsAsked) {
  const Rgb red(1.0F, 0.0F, 0.0F);
  for (const float turns : {-3.0F, -1.0F, 1.0F, 1000.0F}) {
    EXPECT_EQ(texel_at({0.75F + turns, 0.25F}, Wrap::kRepeat), red) << turns;
  }
  EXPECT_EQ(texel_at({0.0F, 0.25F}, Wrap::kRepeat), Rgb(1.0F, 0.5F, 0.5F));  // between left and right
  EXPECT_EQ(texel_at({0.0F, 0.25F}, Wrap::kClamp), Rgb(1.0F));
  EXPECT_EQ(texel_at({-7.0F, 0.25F}, Wrap::kClamp), Rgb(1.0F));
  EXPECT_EQ(texel_at({7.0F, 0.25F}, Wrap::kClamp), red);
  EXPECT_EQ(texel_at({1.25F, 0.25F}, Wrap::kMirror), red);
  EXPECT_EQ(texel_at({-0.25F, 0.25F}, Wrap::kMirror), Rgb(1.0F));
  EXPECT_EQ(texel_at({1.75F, 0.25F}, Wrap::kMirror), Rgb(1.0F));
}

TEST(Scene, FingerprintChangesWithEverythingButNames) {
  const std::vector<Change> changes = {
      {"position", [](Scene& s) { s.positions[0].x = 1e-7F; }},
      {"normal", [](Scene& s) { s.normals[0].x = 1e-7F; }},
      {"texcoord", [](Scene& s) { s.texcoords[0].x = 1e-7F; }},
      {"colour", [](Scene& s) { s.vertex_colors[0].x = 0.5F; }},
      {"no colours", [](Scene& s) { s.vertex_colors.clear(); }},
      {"triangle",
       [](Scene& s) {
         s.triangles[0] = {1U, 2U, 0U};
       }},
      {"material index", [](Scene& s) { s.triangle_materials[0] = 1; }},
      {"albedo", [](Scene& s) { s.materials[0].albedo.z = 0.1F; }},
      {"emission", [](Scene& s) { s.materials[0].emission.z = 0.1F; }},
      {"texture index", [](Scene& s) { s.materials[0].albedo_texture = -1; }},
      {"sides", [](Scene& s) { s.materials[0].is_double_sided = true; }},
      {"texel", [](Scene& s) { s.textures[0].image.pixels[3].z = 0.0F; }},
      {"wrapping", [](Scene& s) { s.textures[0].wrap_v = Wrap::kClamp; }},
      {"light", [](Scene& s) { std::get<0>(s.lights[0]).radiant_intensity.x = 2.0F; }},
      {"spot", [](Scene& s) { std::get<1>(s.lights[1]).inner_angle_rad = 0.1F; }},
      {"light kind", [](Scene& s) { s.lights[0] = light::DirectionalLight{}; }},
      {"camera", [](Scene& s) { s.cameras[0].vertical_fov_rad = 0.8F; }},
  };
  std::set<std::string> seen = {fingerprint(full_scene())};
  for (const auto& [what, apply] : changes) {
    Scene scene = full_scene();
    apply(scene);
    EXPECT_TRUE(seen.insert(fingerprint(scene)).second) << what;
  }
  Scene renamed = full_scene();
  renamed.name = renamed.materials[0].name = renamed.cameras[0].name = "other";
  EXPECT_EQ(fingerprint(renamed), fingerprint(full_scene()));
  EXPECT_EQ(fingerprint(renamed).find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_EQ(fingerprint(renamed).size(), 16U);
}

TEST(Scene, FramedCameraSeesAllOfTheBounds) {
  for (const Vec3 size : {Vec3(1.0F), Vec3(100.0F, 0.1F, 1.0F), Vec3(1e-4F, 2e-4F, 1e-5F)}) {
    Scene scene = full_scene();
    scene.positions = {Vec3(5.0F), Vec3(5.0F) + size, Vec3(5.0F) + size * Vec3(1.0F, 0.0F, 0.0F)};
    const Camera camera = frame_camera(scene);
    const float cosine = std::cos(0.5F * camera.vertical_fov_rad);
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 choice(corner & 1, (corner >> 1) & 1, corner >> 2);
      const Vec3 towards = glm::normalize(Vec3(5.0F) + choice * size - camera.eye);
      EXPECT_GE(glm::dot(towards, camera.forward), cosine) << "corner " << corner;
    }
    EXPECT_GT(camera.eye.z, 5.0F);
    EXPECT_GT(camera.eye.x, 5.0F);
    EXPECT_GT(camera.eye.y, 5.0F);
  }
}

TEST(Scene, FindCameraListsTheNamesThereAre) {
  Scene scene = full_scene();
  scene.cameras = {Camera{.name = "front"}, Camera{.name = "side"}};
  EXPECT_EQ(find_camera(scene, "").name, "front");
  EXPECT_EQ(&find_camera(scene, "side"), &scene.cameras[1]);
  const std::string message = refusal([&] { (void)find_camera(scene, "top"); });
  EXPECT_NE(message.find("front, side"), std::string::npos) << message;
  scene.cameras.clear();
  EXPECT_THROW((void)find_camera(scene, ""), InputError);
}

}  // namespace
}  // namespace plumbline::scene
