// Exact spheres and discs under random, grazing and starting-on-the-surface rays, against the same equations in
// long double without a hierarchy.
#include "reference/trace/analytic.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <random>

#include "../integrate/pieces.hpp"
#include "reference/trace/ray_caster.hpp"

namespace plumbline::trace {
namespace {

struct Wide {  // 64 bits of mantissa: 11 more than what is tested
  long double x, y, z;
  Wide(long double a, long double b, long double c) : x(a), y(b), z(c) {}
  explicit Wide(const Vec3& v) : x(v.x), y(v.y), z(v.z) {}
};
Wide operator-(const Wide& a, const Wide& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Wide along(const Wide& a, long double t, const Wide& b) {
  return {a.x + t * b.x, a.y + t * b.y, a.z + t * b.z};
}
long double dot(const Wide& a, const Wide& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

struct Answer {
  std::uint32_t surface = 0;
  long double distance = 0.0L;
};

std::optional<Answer> first(const scene::Sphere& s, std::uint32_t surface, const Ray& ray) {
  const Wide d(ray.direction);
  const Wide f = Wide(ray.origin) - Wide(s.centre);
  const long double radius = s.radius;
  const long double a = dot(d, d);
  const long double b = dot(f, d) / a;
  const Wide nearest = along(f, -b, d);
  const long double root = (radius * radius - dot(nearest, nearest)) / a;
  if (root < 0.0L) return std::nullopt;
  for (const long double t : {-b - std::sqrt(root), -b + std::sqrt(root)}) {
    if (!(t > 0.0L) || t > static_cast<long double>(ray.max_distance)) continue;
    const Wide met = along(f, t, d);
    const long double cosine = dot(met, Wide(s.keep_axis)) / radius;
    if (cosine <
        static_cast<long double>(s.keep_min_cosine) * std::sqrt(dot(Wide(s.keep_axis), Wide(s.keep_axis))))
      continue;
    return Answer{surface, t};
  }
  return std::nullopt;
}

std::optional<Answer> first(const scene::Disc& disc, std::uint32_t surface, const Ray& ray) {
  const Wide n(disc.normal);
  const Wide f = Wide(ray.origin) - Wide(disc.centre);
  const long double t = -dot(n, f) / dot(n, Wide(ray.direction));
  if (!(t > 0.0L) || t > static_cast<long double>(ray.max_distance)) return std::nullopt;
  const Wide met = along(f, t, Wide(ray.direction));
  if (dot(met, met) > static_cast<long double>(disc.radius) * static_cast<long double>(disc.radius))
    return std::nullopt;
  return Answer{surface, t};
}

std::optional<Answer> every_one_in_turn(const scene::Scene& scene, const Ray& ray) {
  std::optional<Answer> nearest;
  std::uint32_t surface = static_cast<std::uint32_t>(scene.triangles.size());
  const auto consider = [&](const auto& primitive) {
    const std::optional<Answer> found = first(primitive, surface++, ray);
    if (found && (!nearest || found->distance < nearest->distance)) nearest = found;
  };
  for (const scene::Sphere& sphere : scene.spheres) consider(sphere);
  for (const scene::Disc& disc : scene.discs) consider(disc);
  return nearest;
}

Vec3 random_vector(std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(-1.0F, 1.0F);
  const float x = uniform(random);
  const float y = uniform(random);
  return {x, y, uniform(random)};
}

Vec3 random_direction(std::mt19937& random) {
  for (;;) {
    const Vec3 v = random_vector(random);
    if (glm::length(v) > 0.1F && glm::length(v) <= 1.0F) return glm::normalize(v);
  }
}

scene::Scene clutter(float scale, const Vec3& shift) {
  std::mt19937 random(42);
  std::uniform_real_distribution<float> uniform(0.0F, 1.0F);
  scene::Scene scene;
  const std::uint32_t material = test::add_material(scene, Rgb(0.5F));
  for (int i = 0; i < 60; ++i) {
    const Vec3 centre = scale * (random_vector(random) + shift);
    scene::Sphere sphere{centre, scale * (0.02F + 0.2F * uniform(random)), material, i % 2 == 0};
    if (i % 3 == 0) {
      sphere.keep_axis = random_direction(random);
      sphere.keep_min_cosine = 1.8F * uniform(random) - 0.9F;
    }
    scene.spheres.push_back(sphere);
    scene.discs.push_back({scale * (random_vector(random) + shift), random_direction(random),
                           scale * (0.02F + 0.2F * uniform(random)), material});
  }
  return scene;
}

// Both see the same float ray, so they may differ only in the double's last digits: float storage of the distance
// is all that shows, half a unit in the last place.
TEST(AnalyticRays, AgreeWithEveryPrimitiveTriedInTurnAtEveryScaleAndPlace) {
  for (const float scale : {1e-3F, 1.0F, 1e3F}) {
    for (const Vec3& shift : {Vec3(0.0F), Vec3(20.0F, -30.0F, 10.0F)}) {
      SCOPED_TRACE(scale);
      const scene::Scene scene = clutter(scale, shift);
      ASSERT_NO_THROW(scene::validate(scene, "clutter"));
      const RayCaster caster(scene);
      std::mt19937 random(7);
      int hits = 0;
      for (int i = 0; i < 20000; ++i) {
        Ray ray{scale * (1.5F * random_vector(random) + shift), random_direction(random)};
        if (i % 3 == 1) ray.max_distance = 0.7F * scale;
        const std::optional<Answer> truth = every_one_in_turn(scene, ray);
        const std::optional<Hit> hit = caster.closest_hit(ray);
        ASSERT_EQ(hit.has_value(), truth.has_value()) << "ray " << i;
        ASSERT_EQ(caster.is_occluded(ray), truth.has_value()) << "ray " << i;
        if (!truth) continue;
        ++hits;
        ASSERT_EQ(hit->triangle, truth->surface) << "ray " << i;
        EXPECT_LE(std::abs(static_cast<long double>(hit->distance) - truth->distance),
                  6.1e-8L * truth->distance)
            << "ray " << i;
      }
      EXPECT_GT(hits, 3000);
    }
  }
}

// Planted fault for the comparison above: a sphere larger by 1e-4 is told from the right one.
TEST(AnalyticRays, TheComparisonTellsARadiusThatIsOffByATenThousandth) {
  const scene::Scene scene = clutter(1.0F, Vec3(0.0F));
  scene::Scene wrong = scene;
  for (scene::Sphere& sphere : wrong.spheres) sphere.radius *= 1.0001F;
  const RayCaster caster(wrong);
  std::mt19937 random(7);
  int differences = 0;
  for (int i = 0; i < 2000; ++i) {
    const Ray ray{1.5F * random_vector(random), random_direction(random)};
    const std::optional<Answer> truth = every_one_in_turn(scene, ray);
    const std::optional<Hit> hit = caster.closest_hit(ray);
    if (hit.has_value() != truth.has_value()) {
      ++differences;
    } else if (hit && !(std::abs(static_cast<long double>(hit->distance) - truth->distance) <=
                        6.1e-8L * truth->distance)) {
      ++differences;
    }
  }
  EXPECT_GT(differences, 100);
}

// Rays from 100 radii away that pass the rim at a known distance: 1e-6 of the radius inside hits, as much outside
// misses. The naive discriminant b^2 - ac in float loses such a ray already at 1e-3, in double at 1e-12.
TEST(AnalyticRays, GrazingRaysHitJustInsideAndMissJustOutside) {
  std::mt19937 random(3);
  for (const float radius : {1e-3F, 1.0F, 1e3F}) {
    const double scale = radius;
    for (const float shift : {0.0F, 50.0F}) {
      // In float: GCC 12.2 -O3 forgets to round a vector of doubles to float on its way back to double.
      const Vec3 centre = radius * Vec3(shift, -shift, 0.5F * shift);
      const scene::Sphere sphere{centre, radius};
      for (int i = 0; i < 2000; ++i) {
        const Vec3d direction(random_direction(random));
        const Vec3d aside = glm::normalize(glm::cross(direction, Vec3d(random_direction(random))));
        for (const double miss : {-1e-6, 1e-6}) {
          const Vec3d origin = Vec3d(centre) - 100.0 * scale * direction + scale * (1.0 + miss) * aside;
          const auto met = crossing(sphere, origin, direction, INFINITY);
          ASSERT_EQ(met.has_value(), miss < 0.0) << i;
          if (!met) continue;
          EXPECT_LE(std::abs(met->distance / scale - 100.0), 2e-3);  // sqrt(2e-6) before the middle
        }
      }
    }
  }
}

TEST(AnalyticRays, BoxesHoldSpheresThatAreOnlyGrazed) {
  scene::Scene scene;
  const std::uint32_t material = test::add_material(scene, Rgb(0.5F));
  scene.spheres.push_back({{30.0F, -20.0F, 10.0F}, 0.1F, material});
  const RayCaster caster(scene);
  const Vec3d centre(scene.spheres[0].centre);
  const double radius = scene.spheres[0].radius;
  std::mt19937 random(5);
  int hits = 0;
  for (int i = 0; i < 20000; ++i) {  // near the axes the sphere touches its box
    const Vec3d axis(i % 3 == 0, i % 3 == 1, i % 3 == 2);
    const Vec3d direction(random_direction(random));
    const Vec3d aside = glm::normalize(axis - glm::dot(axis, direction) * direction);
    const Ray ray{Vec3(centre + radius * (1.0 - 1e-6) * aside - 3.0 * direction), Vec3(direction)};
    const bool is_met = every_one_in_turn(scene, ray).has_value();
    hits += is_met ? 1 : 0;
    ASSERT_EQ(caster.closest_hit(ray).has_value(), is_met) << i;
    ASSERT_EQ(caster.is_occluded(ray), is_met) << i;
  }
  EXPECT_GT(hits, 5000);
  EXPECT_LT(hits, 20000);
}

scene::Scene shell(float scale, float shift, bool is_inward) {
  scene::Scene scene;
  scene.spheres.push_back(
      {scale * shift * Vec3(1.0F, -2.0F, 0.5F), scale, test::add_material(scene, Rgb(0.5F)), is_inward});
  return scene;
}

// Inside a sphere every ray that leaves the wall meets the wall, on its front, and never where it started.
TEST(AnalyticRays, NeitherLeakOutOfASphereNorMeetTheirOwnStart) {
  for (const float scale : {1e-3F, 1.0F, 1e3F}) {
    for (const float shift : {0.0F, 1.0F, 100.0F, 2000.0F}) {
      const scene::Scene scene = shell(scale, shift, true);
      const RayCaster caster(scene);
      std::mt19937 random(11);
      SurfacePoint point = free_point(scene.spheres[0].centre, {0, 1, 0});
      Vec3 direction(0, 1, 0);
      for (int bounce = 0; bounce < 20000; ++bounce) {
        const std::optional<Hit> hit = caster.closest_hit({ray_origin(point, direction), direction});
        ASSERT_TRUE(hit.has_value()) << "leak: scale " << scale << " shift " << shift << " bounce " << bounce;
        const SurfaceHit surface = surface_hit(scene, *hit, direction);
        ASSERT_TRUE(surface.is_front) << "outside: scale " << scale << " shift " << shift;
        // From depth e below the wall the far wall is at least 2 (R - e) cos away; e < R/20 everywhere here.
        if (bounce > 0) {
          const double cosine = glm::dot(Vec3d(point.geometric_normal), Vec3d(direction));
          ASSERT_GE(static_cast<double>(hit->distance), 1.9 * static_cast<double>(scale) * cosine);
        }
        point = surface.point;
        do {
          direction = random_direction(random);
        } while (glm::dot(direction, point.geometric_normal) < 1e-3F);
      }
    }
  }
}

// The surface alone is asked: the other primitive may well be met.
TEST(AnalyticRays, LeaveTheOutsideOfASphereAndADiscFreely) {
  for (const float scale : {1e-3F, 1.0F, 1e3F}) {
    for (const float shift : {0.0F, 1.0F, 100.0F, 2000.0F}) {
      const scene::Sphere sphere = shell(scale, shift, false).spheres[0];
      const scene::Disc disc{sphere.centre, {0.6F, 0.0F, 0.8F}, scale};
      std::mt19937 random(12);
      for (int i = 0; i < 5000; ++i) {
        const Vec3 away = random_direction(random);
        const auto is_met_again = [&](const auto& shape, const SurfacePoint& point) {
          Vec3 direction = random_direction(random);
          if (glm::dot(direction, point.geometric_normal) < 0.0F) direction = -direction;
          return crossing(shape, Vec3d(ray_origin(point, direction)), Vec3d(direction), INFINITY).has_value();
        };
        ASSERT_FALSE(is_met_again(sphere, point_on(sphere, sphere_coordinates(Vec3d(away)))))
            << scale << ' ' << shift;
        ASSERT_FALSE(is_met_again(disc, point_on(disc, 0.7F * Vec2(away.x, away.y))))
            << scale << ' ' << shift;
      }
    }
  }
}

// Planted fault: without the clearance a good part of the rays does meet its own surface.
TEST(AnalyticRays, WouldMeetTheirOwnStartWithoutClearance) {
  const scene::Sphere sphere = shell(1.0F, 1.0F, false).spheres[0];
  std::mt19937 random(14);
  int met = 0;
  for (int i = 0; i < 1000; ++i) {
    SurfacePoint point = point_on(sphere, sphere_coordinates(Vec3d(random_direction(random))));
    point.clearance = 0.0F;
    const Vec3 direction = point.geometric_normal;
    if (crossing(sphere, Vec3d(ray_origin(point, direction)), Vec3d(direction), INFINITY)) ++met;
  }
  EXPECT_GT(met, 100);
}

TEST(AnalyticPoints, LieOnTheSurfaceUpToFloatRounding) {
  std::mt19937 random(13);
  for (const float shift : {0.0F, 100.0F}) {
    const scene::Sphere sphere{shift * Vec3(1.0F, -2.0F, 0.5F), 1.5F};
    const scene::Disc disc{sphere.centre, glm::normalize(Vec3(1.0F, 2.0F, -3.0F)), 1.5F};
    for (int i = 0; i < 5000; ++i) {
      const Vec3d n = glm::normalize(Vec3d(random_direction(random)));
      const SurfacePoint point = point_on(sphere, sphere_coordinates(n));
      // half a unit in the last place of each coordinate
      const double rounding =
          0.5 * std::sqrt(3.0) * 1.2e-7 * (static_cast<double>(max_magnitude(sphere.centre)) + 1.5);
      EXPECT_LE(std::abs(glm::length(Vec3d(point.position) - Vec3d(sphere.centre)) - 1.5), rounding);
      EXPECT_LE(glm::length(Vec3d(point.geometric_normal) - n), 4e-7);  // octahedral coordinates in float
      EXPECT_GE(static_cast<double>(point.clearance), 3.0 * rounding);
      const Vec2 at = 0.7F * Vec2(random_vector(random));
      const SurfacePoint on_disc = point_on(disc, at);
      const Vec3d offset = Vec3d(on_disc.position) - Vec3d(disc.centre);
      EXPECT_LE(std::abs(glm::dot(offset, glm::normalize(Vec3d(disc.normal)))), rounding);
      EXPECT_LE(std::abs(glm::length(offset) - 1.5 * glm::length(glm::dvec2(at))), rounding + 1e-7);
    }
  }
}

TEST(AnalyticPoints, KnowTheirFront) {
  for (const bool is_inward : {false, true}) {
    scene::Scene scene = shell(1.0F, 0.0F, is_inward);
    scene.discs.push_back({{0, 0, -3}, {0, 0, 1}, 1.0F, 0});
    const RayCaster caster(scene);
    const auto is_front = [&](const Vec3& from, const Vec3& towards) {
      const std::optional<Hit> hit = caster.closest_hit({from, towards});
      EXPECT_TRUE(hit.has_value());
      const SurfaceHit surface = surface_hit(scene, *hit, towards);
      EXPECT_LE(glm::dot(surface.point.geometric_normal, towards), 0.0F) << "normals face the viewer";
      return surface.is_front;
    };
    EXPECT_EQ(is_front({0, 0, 3}, {0, 0, -1}), !is_inward);
    EXPECT_EQ(is_front({0, 0, 0}, {0, 0, -1}), is_inward);
    EXPECT_TRUE(is_front({0, 0, -2}, {0, 0, -1}));
    EXPECT_FALSE(is_front({0, 0, -4}, {0, 0, 1}));
  }
}

// A cut sphere lets rays through exactly where the cap is gone.
TEST(AnalyticRays, PassThroughTheOpeningOfACutSphere) {
  scene::Scene scene = shell(1.0F, 0.0F, true);
  scene.spheres[0].keep_axis = {0, -1, 0};
  scene.spheres[0].keep_min_cosine = 0.0F;
  const RayCaster caster(scene);
  EXPECT_FALSE(caster.is_occluded({{0, 0, 0}, {0, 1, 0}}));
  EXPECT_TRUE(caster.is_occluded({{0, 0, 0}, {0, -1, 0}}));
  const std::optional<Hit> through = caster.closest_hit({{0, 3, 0}, {0, -1, 0}});
  ASSERT_TRUE(through.has_value());
  EXPECT_EQ(through->distance, 4.0F);
  EXPECT_TRUE(surface_hit(scene, *through, {0, -1, 0}).is_front);
  for (const float slope : {-1e-5F, 1e-5F}) {
    const Vec3 direction = glm::normalize(Vec3(1.0F, slope, 0.3F));
    EXPECT_EQ(caster.is_occluded({{0, 0, 0}, direction}), slope < 0.0F);
  }
}

TEST(AnalyticRays, TrianglesBesideThemKeepTheirNumbers) {
  scene::Scene scene = shell(1.0F, 0.0F, false);
  test::add_quad(scene, {-5, -1, 5}, {10, 0, 0}, {0, 0, -10}, 0);
  const RayCaster caster(scene);
  const std::optional<Hit> on_plane = caster.closest_hit({{3, 2, 0}, {0, -1, 0}});
  const std::optional<Hit> on_sphere = caster.closest_hit({{0, 2, 0}, {0, -1, 0}});
  ASSERT_TRUE(on_plane && on_sphere);
  EXPECT_LT(on_plane->triangle, 2U);
  EXPECT_EQ(on_sphere->triangle, 2U);
  EXPECT_EQ(on_sphere->distance, 1.0F);
}

}  // namespace
}  // namespace plumbline::trace
