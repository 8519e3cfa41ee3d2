// Every skip of the plan leaves the answer as it was.
#include "prt/transfer/plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "prt/transfer/bake.hpp"
#include "prt/transfer/horizon.hpp"
#include "reference/scene/builtin.hpp"
#include "reference/scene/shapes.hpp"

namespace plumbline::transfer {
namespace {

scene::Scene make_ball(bool is_faceted, Rgb albedo = Rgb(0.8F)) {
  scene::Scene scene;
  const auto material = scene::add_material(scene, {.name = "ball", .albedo = albedo});
  const scene::Mesh mesh = scene::placed(scene::make_icosphere(2), {3.0, -1.0, 0.5});
  scene::append(scene, is_faceted ? scene::faceted(mesh) : mesh, material);
  return scene;
}

BakeSettings settings_of(Kind kind, Solver solver = Solver::traced) {
  BakeSettings settings;
  settings.bands = 4;
  settings.kind = kind;
  settings.method.solver = solver;
  settings.samples = 512;
  settings.kept_terms = 3;
  return settings;
}

Plan plan_of(const scene::Scene& scene, const BakeSettings& settings) {
  return make_plan(scene, trace::vertex_points(scene), settings);
}

struct Both {
  Transfer with;
  Transfer without;
};
Both bake_both(const scene::Scene& scene, BakeSettings settings) {
  Both both;
  both.with = bake(scene, settings);
  settings.is_skipping = false;
  both.without = bake(scene, settings);
  return both;
}

std::size_t count_of(const Plan& plan, Above above) {
  return static_cast<std::size_t>(std::count(plan.above.begin(), plan.above.end(), above));
}

TEST(Horizon, KnowsConvexFromConcave) {
  const scene::Scene ball = make_ball(true);
  const Horizon horizon(ball);
  for (const trace::SurfacePoint& point : trace::vertex_points(ball)) {
    EXPECT_TRUE(horizon.is_empty_above(point));
    trace::SurfacePoint inside = point;  // the ball is above the other side
    inside.geometric_normal = -inside.geometric_normal;
    EXPECT_FALSE(horizon.is_empty_above(inside));
  }
  // Something small and far, just above and just below the plane y = 0 of a point.
  for (const float height : {0.01F, -0.01F}) {
    scene::Scene scene;
    const auto material = scene::add_material(scene, {});
    scene::append(scene, scene::make_grid({50, static_cast<double>(height), 0}, {0, 0, 1}, {1, 0, 0}, 1, 1),
                  material);
    EXPECT_EQ(Horizon(scene).is_empty_above(trace::free_point(Vec3(0.0F), {0, 1, 0})), height < 0.0F);
  }
}

// Agrees with a look at every vertex, on a scene with all kinds.
TEST(Horizon, AgreesWithEveryVertexAsked) {
  const scene::Scene scene = scene::make_builtin_scene("sphere-on-plane");
  const Horizon horizon(scene);
  const std::vector<trace::SurfacePoint> points = trace::vertex_points(scene);
  std::size_t empty = 0;
  for (std::size_t v = 0; v < points.size(); v += 37) {
    const Vec3d normal(points[v].geometric_normal);
    const double limit =
        glm::dot(normal, Vec3d(points[v].position)) + 0.5 * static_cast<double>(points[v].clearance);
    bool is_empty = true;
    for (const Vec3& position : scene.positions) is_empty &= glm::dot(normal, Vec3d(position)) <= limit;
    EXPECT_EQ(horizon.is_empty_above(points[v]), is_empty) << v;
    empty += is_empty ? 1 : 0;
  }
  EXPECT_GT(empty, 0U);
}

// Flat: the closed form. Curved: the closed form less what the surface itself blocks. Both within the errors of what they replace.
TEST(Plan, LeavesOutRaysThatMeetNothing) {
  for (const bool is_faceted : {true, false}) {
    const scene::Scene ball = make_ball(is_faceted);
    const std::vector<trace::SurfacePoint> points = trace::vertex_points(ball);
    for (const Solver solver : {Solver::traced, Solver::iterative}) {
      const BakeSettings settings =
          settings_of(solver == Solver::traced ? Kind::shadowed : Kind::interreflected, solver);
      EXPECT_EQ(count_of(plan_of(ball, settings), is_faceted ? Above::nothing_flat : Above::nothing),
                ball.positions.size());
      const Both both = bake_both(ball, settings);
      double squares = 0.0;
      double other_sign = 0.0;
      double count = 0.0;
      for (std::size_t v = 0; v < both.with.vertices; ++v) {
        const std::vector<double> exact = unshadowed_transfer(4, points[v].shading_normal);
        for (std::size_t i = 0; i < 16; ++i) {
          const auto with = static_cast<double>(both.with.vector(v, 0)[i]);
          const auto without = static_cast<double>(both.without.vector(v, 0)[i]);
          const auto error = static_cast<double>(both.with.row_of(both.with.standard_errors, v, 0)[i]);
          const auto old_error =
              static_cast<double>(both.without.row_of(both.without.standard_errors, v, 0)[i]);
          if (is_faceted) {
            EXPECT_EQ(both.with.vector(v, 0)[i], static_cast<float>(exact[i]));
            EXPECT_EQ(error, 0.0);
          }
          // The two share their directions, so that their difference is what the old one's smooth part errs by.
          const double scale = std::max(1e-6, std::hypot(error, old_error));
          squares += std::pow((with - without) / scale, 2);
          other_sign += std::pow((2.0 * exact[i] - with - without) / scale, 2);
          count += 1.0;
        }
      }
      // Student's t with 15 degrees of freedom has mean square 15/13; coefficients without noise, and noise that both share,
      // make it less. 15360 or 2592 numbers, 16 of a vertex at worst all alike: + 5 standard deviations is 0.6 at most.
      EXPECT_LE(squares / count, 15.0 / 13.0 + 0.6) << is_faceted << ' ' << to_string(solver);
      if (!is_faceted) {
        EXPECT_GT(other_sign / count, 3.0);  // the blocked part added instead of taken off
      }
    }
  }
}

TEST(Plan, LeavesOutBouncesOfBlackScenes) {
  scene::Scene scene = scene::make_builtin_scene("open-box");
  const BakeSettings settings = settings_of(Kind::interreflected);
  EXPECT_TRUE(plan_of(scene, settings).is_reflecting);
  for (scene::Material& material : scene.materials) material.albedo = Rgb(0.0F);
  EXPECT_FALSE(plan_of(scene, settings).is_reflecting);
  const Both both = bake_both(scene, settings);
  ASSERT_EQ(both.with.coefficients.size(), both.without.coefficients.size());
  std::size_t different = 0;
  for (std::size_t i = 0; i < both.with.coefficients.size(); ++i)
    different += both.with.coefficients[i] != both.without.coefficients[i] ? 1 : 0;
  // Occlusion and closest hits round differently where a ray grazes an edge.
  EXPECT_LE(different, both.with.coefficients.size() / 1000);
}

TEST(Plan, OneChannelIsThreeOfGray) {
  const scene::Scene scene = scene::make_builtin_scene("corner");
  for (const Solver solver : {Solver::traced, Solver::iterative}) {
    const BakeSettings settings = settings_of(Kind::interreflected, solver);
    EXPECT_EQ(plan_of(scene, settings).channels, 1);
    const Both both = bake_both(scene, settings);
    EXPECT_EQ(both.with.channels, 1);
    for (std::size_t i = 0; i < both.with.coefficients.size(); ++i)
      EXPECT_LE(std::abs(both.with.coefficients[i] - both.without.coefficients[i]), 1e-6F);
  }
}

TEST(Plan, OddBandsOfUnshadowedTransferAreZero) {
  const scene::Scene ball = make_ball(false);
  BakeSettings settings = settings_of(Kind::unshadowed);
  settings.bands = 6;
  EXPECT_EQ(plan_of(ball, settings).skips.size(), 1U);
  const Both both = bake_both(ball, settings);
  EXPECT_EQ(both.with.coefficients, both.without.coefficients);
  for (std::size_t v = 0; v < both.with.vertices; ++v) {
    for (std::size_t i = 9; i < 16; ++i) EXPECT_EQ(both.with.vector(v, 0)[i], 0.0F);
    for (std::size_t i = 25; i < 36; ++i) EXPECT_EQ(both.with.vector(v, 0)[i], 0.0F);
  }
}

TEST(Plan, SaysWhatItSkips) {
  EXPECT_NE(to_text(plan_of(make_ball(true), settings_of(Kind::shadowed))).find("960 of 960 vertices"),
            std::string::npos);
  BakeSettings all = settings_of(Kind::interreflected);
  all.is_skipping = false;
  const Plan plan = plan_of(make_ball(true), all);
  EXPECT_TRUE(plan.skips.empty());
  EXPECT_TRUE(plan.above.empty());
  EXPECT_EQ(to_text(plan), "the plan skips nothing\n");
}

}  // namespace
}  // namespace plumbline::transfer
