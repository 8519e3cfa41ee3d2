// Exact spheres and discs as part of a scene: what is refused, what the fingerprint and the bounds see, and who says
// no to them.
#include "reference/scene/primitive.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "reference/base/error.hpp"
#include "reference/scene/exact_scenes.hpp"
#include "reference/scene/ground.hpp"
#include "reference/scene/load.hpp"
#include "reference/scene/save_gltf.hpp"
#include "reference/scene/scene.hpp"
#include "reference/scene/shapes.hpp"
#include "validation/truth/brute_tracer.hpp"

namespace plumbline::scene {
namespace {

Scene two_primitives() {
  Scene scene;
  scene.name = "two";
  const std::uint32_t material = add_material(scene, {.name = "grey", .albedo = Rgb(0.5F)});
  add_material(scene, {.name = "other", .albedo = Rgb(0.25F)});
  scene.spheres.push_back({{1, 2, 3}, 0.5F, material});
  scene.discs.push_back({{0, 1, 0}, {0, 1, 0}, 2.0F, 1});
  return scene;
}

std::string message_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(Primitives, AloneMakeAValidScene) {
  EXPECT_NO_THROW(validate(two_primitives(), "scene"));
  EXPECT_NE(message_of([] { validate(Scene{}, "scene"); }), "");
}

TEST(Primitives, BadOnesAreRefusedByNameAndValue) {
  struct Fault {
    std::function<void(Scene&)> plant;
    const char* part;
  };
  const std::vector<Fault> faults = {
      {[](Scene& s) { s.spheres[0].radius = 0.0F; }, "sphere 0: radius is not above 0: 0"},
      {[](Scene& s) { s.spheres[0].radius = NAN; }, "sphere 0: radius is not above 0"},
      {[](Scene& s) { s.spheres[0].radius = 1e30F; }, "within 1e18"},
      {[](Scene& s) { s.spheres[0].radius = 1e-5F; }, "below 1e-4 of the centre's distance"},
      {[](Scene& s) { s.spheres[0].centre.y = NAN; }, "centre is not finite"},
      {[](Scene& s) { s.spheres[0].keep_axis = Vec3(2.0F, 0, 0); }, "keep_axis is not unit length"},
      {[](Scene& s) { s.spheres[0].keep_min_cosine = 1.0F; }, "keep_min_cosine is outside [-1, 1): 1"},
      {[](Scene& s) { s.spheres[0].keep_min_cosine = NAN; }, "keep_min_cosine"},
      {[](Scene& s) { s.spheres[0].material = 2; }, "sphere 0 uses material 2, there are 2"},
      {[](Scene& s) { s.discs[0].normal = Vec3(0.0F); }, "disc 0: normal is not unit length"},
      {[](Scene& s) { s.discs[0].radius = -1.0F; }, "disc 0: radius is not above 0: -1"},
      {[](Scene& s) { s.discs[0].material = 7; }, "disc 0 uses material 7"},
      {[](Scene& s) {
         s.textures.push_back({image::Image{1, 1, {Rgb(0.5F)}}});
         s.positions.emplace_back(0.0F);
         s.normals.emplace_back(0.0F, 1.0F, 0.0F);
         s.texcoords.emplace_back(0.0F);
         s.materials[1].albedo_texture = 0;
       },
       "disc 0 has no texture coordinates"},
  };
  for (const Fault& fault : faults) {
    Scene scene = two_primitives();
    fault.plant(scene);
    const std::string message = message_of([&] { validate(scene, "here"); });
    EXPECT_NE(message.find(fault.part), std::string::npos) << fault.part << " / " << message;
    EXPECT_EQ(message.find("here: "), 0U) << message;
  }
}

TEST(Primitives, EveryNumberChangesTheFingerprint) {
  const std::vector<std::function<void(Scene&)>> changes = {
      [](Scene& s) { s.spheres[0].centre.z += 1.0F; },
      [](Scene& s) { s.spheres[0].radius += 1.0F; },
      [](Scene& s) { s.spheres[0].material = 1; },
      [](Scene& s) { s.spheres[0].is_inward = true; },
      [](Scene& s) {
        s.spheres[0].keep_axis = {1, 0, 0};
      },
      [](Scene& s) { s.spheres[0].keep_min_cosine = 0.0F; },
      [](Scene& s) { s.discs[0].centre.x += 1.0F; },
      [](Scene& s) {
        s.discs[0].normal = {1, 0, 0};
      },
      [](Scene& s) { s.discs[0].radius += 1.0F; },
      [](Scene& s) { s.discs[0].material = 0; },
      [](Scene& s) { s.discs.clear(); },
      [](Scene& s) { s.spheres.clear(); },
  };
  const std::string before = fingerprint(two_primitives());
  EXPECT_EQ(fingerprint(two_primitives()), before);
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Scene scene = two_primitives();
    changes[i](scene);
    EXPECT_NE(fingerprint(scene), before) << "change " << i;
  }
}

TEST(Primitives, BoundsAreTight) {
  const Bounds both = bounds(two_primitives());
  EXPECT_EQ(both.low, Vec3(-2.0F, 1.0F, -2.0F));
  EXPECT_EQ(both.high, Vec3(2.0F, 2.5F, 3.5F));
  const Bounds bowl = bounds(make_bowl());
  EXPECT_EQ(bowl.low, Vec3(-1.0F));
  EXPECT_LE(std::abs(bowl.high.y), 1e-7F);
  EXPECT_EQ(bowl.high.x, 1.0F);
  // A small cap about +x, of half-angle 30 degrees: x in [cos 30, 1], y and z within sin 30.
  const Sphere cap{Vec3(0.0F), 1.0F, 0, false, {1, 0, 0}, std::sqrt(0.75F)};
  const Extent box = extent(cap);
  EXPECT_NEAR(box.low.x, std::sqrt(0.75), 1e-7);
  EXPECT_NEAR(box.high.x, 1.0, 1e-12);
  EXPECT_NEAR(box.high.y, 0.5, 1e-7);
  EXPECT_NEAR(box.low.z, -0.5, 1e-7);
  EXPECT_NEAR(area(cap), 2.0 * kPi * (1.0 - std::sqrt(0.75)), 1e-6);
}

TEST(Primitives, StandOnGroundAndAreFramed) {
  const Scene grounded = with_ground(two_primitives());
  EXPECT_NO_THROW(validate(grounded, "grounded"));
  EXPECT_EQ(bounds(grounded).low.y, 1.0F);
  EXPECT_EQ(material_of(grounded, static_cast<std::uint32_t>(grounded.triangles.size())).name, "grey");
  EXPECT_EQ(material_of(grounded, static_cast<std::uint32_t>(grounded.triangles.size()) + 1).name, "other");
  EXPECT_EQ(material_of(grounded, 0).name, "ground");
  EXPECT_EQ(albedo_at(grounded, static_cast<std::uint32_t>(grounded.triangles.size()) + 1, Vec2(0.3F)),
            Rgb(0.25F));
  const Camera camera = frame_camera(two_primitives());
  EXPECT_GT(glm::distance(camera.eye, Vec3(0.0F, 1.75F, 0.75F)), 4.0F) << "outside of what it frames";
}

TEST(Primitives, AreRefusedWhereOnlyVerticesWork) {
  const Scene scene = two_primitives();
  const std::string gltf = message_of([&] { (void)to_glb(scene); });
  EXPECT_NE(
      gltf.find("glTF of scene two: works on triangles only, the scene has 1 exact spheres and 1 discs"),
      std::string::npos)
      << gltf;
  const std::string brute = message_of([&] {
    light::Environment sky;
    sky.sky = light::ConstantSky{Rgb(1.0F)};
    (void)truth::brute_force_irradiance(scene, sky, Vec3d(0.0), {0, 1, 0}, {.samples = 2});
  });
  EXPECT_NE(brute.find("triangles only"), std::string::npos) << brute;
}

TEST(GradedSquare, IsFlatClosedInsideAndAsLargeAsAsked) {
  const Mesh mesh = make_graded_square({1, 2, 3}, {1, 0, 0}, {0, 0, -1}, 1e-3, 1e3);
  EXPECT_EQ(mesh.triangles.size(), 2U + 8U * 10U);  // log_4(1e6) = 9.97
  double area = 0.0;
  for (const glm::uvec3& t : mesh.triangles) {
    const Vec3d a(mesh.positions[t.x]);
    const Vec3d scaled = glm::cross(Vec3d(mesh.positions[t.y]) - a, Vec3d(mesh.positions[t.z]) - a);
    EXPECT_GT(scaled.y, 0.0) << "every front looks up";
    area += 0.5 * glm::length(scaled);
  }
  EXPECT_NEAR(area, 4e6, 4.0);
  EXPECT_EQ(make_graded_square(Vec3d(0.0), {1, 0, 0}, {0, 0, -1}, 1.0, 1.0).triangles.size(), 2U);
}

}  // namespace
}  // namespace plumbline::scene
