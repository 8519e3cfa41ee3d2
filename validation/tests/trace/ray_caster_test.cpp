#include "reference/trace/ray_caster.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>

#include "../integrate/pieces.hpp"
#include "reference/trace/surface_point.hpp"

namespace plumbline::trace {
namespace {

// Moller & Trumbore in double over every triangle: slow and independent of the hierarchy.
std::optional<double> brute_force(const scene::Scene& scene, const Ray& ray) {
  std::optional<double> nearest;
  for (const glm::uvec3& t : scene.triangles) {
    const Vec3d a(scene.positions[t.x]);
    const Vec3d e1 = Vec3d(scene.positions[t.y]) - a;
    const Vec3d e2 = Vec3d(scene.positions[t.z]) - a;
    const Vec3d p = glm::cross(Vec3d(ray.direction), e2);
    const double determinant = glm::dot(e1, p);
    if (determinant == 0.0) continue;
    const Vec3d s = Vec3d(ray.origin) - a;
    const double u = glm::dot(s, p) / determinant;
    const Vec3d q = glm::cross(s, e1);
    const double v = glm::dot(Vec3d(ray.direction), q) / determinant;
    const double distance = glm::dot(e2, q) / determinant;
    if (u < 0.0 || v < 0.0 || u + v > 1.0 || distance < 0.0 ||
        distance > static_cast<double>(ray.max_distance))
      continue;
    if (!nearest || distance < *nearest) nearest = distance;
  }
  return nearest;
}

Vec3 random_vector(std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
  const float x = uniform(random);
  const float y = uniform(random);
  return {x, y, uniform(random)};
}

scene::Scene soup(int triangles) {
  std::mt19937 random(42);
  scene::Scene scene;
  const std::uint32_t material = test::add_material(scene, Rgb(0.5F));
  for (int i = 0; i < triangles; ++i) {
    const Vec3 a = random_vector(random);
    const Vec3 b = a + 0.3F * random_vector(random);
    test::add_triangle(scene, a, b, a + 0.3F * random_vector(random), material);
  }
  return scene;
}

TEST(RayCaster, AgreesWithEveryTriangleTriedInTurn) {
  const scene::Scene scene = soup(300);
  const RayCaster caster(scene);
  std::mt19937 random(7);
  int hits = 0;
  for (int i = 0; i < 20000; ++i) {
    Ray ray{2.0F * random_vector(random), glm::normalize(random_vector(random))};
    if (i % 2 == 1) ray.max_distance = 1.0F;
    const std::optional<double> truth = brute_force(scene, ray);
    const std::optional<Hit> hit = caster.closest_hit(ray);
    ASSERT_EQ(hit.has_value(), truth.has_value()) << "ray " << i;
    EXPECT_EQ(caster.is_occluded(ray), truth.has_value()) << "ray " << i;
    if (!truth) continue;
    ++hits;
    EXPECT_LE(std::abs(static_cast<double>(hit->distance) - *truth), 1e-4 * (1.0 + *truth)) << "ray " << i;
  }
  EXPECT_GT(hits, 1000);
}

TEST(RayCaster, HitsAnAnalyticSphereWhereItIs) {
  scene::Scene scene;
  test::add_sphere(scene, Vec3(0.0F), 1.0, 128, false, test::add_material(scene, Rgb(0.5F)));
  const RayCaster caster(scene);
  std::mt19937 random(8);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 direction = glm::normalize(random_vector(random));
    const std::optional<Hit> hit = caster.closest_hit({-3.0F * direction, direction});
    ASSERT_TRUE(hit.has_value());
    EXPECT_LE(std::abs(hit->distance - 2.0F), 1.5e-4F);  // h^2 of 128 rings
  }
}

TEST(RayCaster, SeesFarAndNearOccludersAlike) {
  for (const float scale : {1e-3F, 1.0F, 1e6F}) {
    scene::Scene scene;
    test::add_quad(scene, Vec3(-1, 1, -1) * scale, Vec3(2, 0, 0) * scale, Vec3(0, 0, 2) * scale,
                   test::add_material(scene, Rgb(0.5F)));
    const RayCaster caster(scene);
    EXPECT_TRUE(caster.is_occluded({Vec3(0.0F), {0, 1, 0}}));
    EXPECT_FALSE(caster.is_occluded({Vec3(0.0F), {0, -1, 0}}));
    EXPECT_FALSE(caster.is_occluded({Vec3(0.0F), {0, 1, 0}, 0.99F * scale}));
  }
}

// From random points of a room of random size and place, no ray leaves and none starts inside the wall it
// left.
TEST(RayOrigin, NeitherLeaksNorSelfIntersects) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
  for (const float scale : {1e-4F, 1.0F, 1e4F}) {
    for (const float shift : {0.0F, 100.0F}) {
      scene::Scene scene;
      test::add_sphere(scene, Vec3(shift * scale), 1.0, 24, true, test::add_material(scene, Rgb(0.5F)));
      for (Vec3& p : scene.positions) p = Vec3(shift * scale) + scale * (p - Vec3(shift * scale));
      const RayCaster caster(scene);
      SurfacePoint point = free_point(Vec3(shift * scale), {0, 1, 0});
      Vec3 direction(0, 1, 0);
      for (int bounce = 0; bounce < 20000; ++bounce) {
        const std::optional<Hit> hit = caster.closest_hit({ray_origin(point, direction), direction});
        ASSERT_TRUE(hit.has_value()) << "leak: scale " << scale << " shift " << shift << " bounce " << bounce;
        const SurfaceHit surface = surface_hit(scene, *hit, direction);
        ASSERT_TRUE(surface.is_front)
            << "started behind the wall: scale " << scale << " shift " << shift << " bounce " << bounce;
        point = surface.point;
        do {
          direction = glm::normalize(random_vector(random));
        } while (glm::dot(direction, point.geometric_normal) < 0.02F);
      }
    }
  }
}

TEST(VertexPoints, StayOffTheWallNextDoor) {
  scene::Scene scene;  // the floor's vertices at the edge lie in the wall's plane
  test::add_quad(scene, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}, test::add_material(scene, Rgb(0.5F)));
  test::add_quad(scene, {0, 0, -9}, {0, 9, 0}, {0, 0, 18}, test::add_material(scene, Rgb(0.5F)));
  const RayCaster caster(scene);
  for (const SurfacePoint& point : vertex_points(scene)) {
    if (point.geometric_normal.y < 0.5F) continue;
    const Vec3 up_into_wall = glm::normalize(Vec3(-1, 0.5F, 0));
    EXPECT_TRUE(caster.is_occluded({ray_origin(point, up_into_wall), up_into_wall})) << point.position.x;
    const Vec3 away = glm::normalize(Vec3(1, 0.5F, 0));
    EXPECT_FALSE(caster.is_occluded({ray_origin(point, away), away})) << point.position.x;
  }
}

}  // namespace
}  // namespace plumbline::trace
