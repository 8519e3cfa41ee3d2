#include "reference/trace/surface_table.hpp"

#include <gtest/gtest.h>

#include "reference/scene/builtin.hpp"
#include "validation/tests/light/support.hpp"

namespace plumbline::trace {
namespace {

// The table is a faster way to the same numbers. Normals may differ where vertex normals are the plane's own up to rounding.
TEST(SurfaceTable, GivesWhatTheSceneGives) {
  for (const char* name : {"cornell", "plaza", "exact-sphere-on-plane"}) {
    const scene::Scene scene = scene::make_builtin_scene(name);
    const SurfaceTable table(scene);
    light::testing::Numbers numbers;
    const std::size_t surfaces = scene.triangles.size() + scene::primitive_count(scene);
    for (std::size_t i = 0; i < surfaces; i += 1 + surfaces / 500) {
      Vec2 b = numbers.next_pair();
      if (b.x + b.y > 1.0F) b = Vec2(1.0F) - b;
      const Hit hit{static_cast<std::uint32_t>(i), b, 1.0F};
      const Vec3 direction = numbers.direction();
      const SurfaceHit expected = surface_hit(scene, hit, direction);
      const SurfaceHit found = table.hit(hit, direction);
      EXPECT_EQ(found.is_front, expected.is_front) << name << " " << i;
      EXPECT_EQ(found.point.position, expected.point.position) << name << " " << i;
      EXPECT_EQ(found.point.geometric_normal, expected.point.geometric_normal) << name << " " << i;
      EXPECT_EQ(found.point.clearance, expected.point.clearance) << name << " " << i;
      EXPECT_LE(glm::length(found.point.shading_normal - expected.point.shading_normal), 1e-6F)
          << name << " " << i;
      EXPECT_EQ(table.albedo(hit), scene::albedo_at(scene, hit.triangle, hit.barycentrics))
          << name << " " << i;
      EXPECT_EQ(table.surface(hit.triangle).emission, scene::material_of(scene, hit.triangle).emission);
    }
  }
}

}  // namespace
}  // namespace plumbline::trace
