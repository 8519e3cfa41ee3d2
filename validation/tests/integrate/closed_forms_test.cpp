// The path tracer against closed forms of light transport. Every case must agree within 4 standard errors
// *and* have a relative standard error of at most 0.1 %; the same comparison applied to an estimate that is 1
// % off must fail, so none of these tests can pass by being vague. The numbers are derived in
// validation/truth.
#include <gtest/gtest.h>

#include <cmath>

#include "agreement.hpp"
#include "pieces.hpp"
#include "reference/integrate/gather.hpp"
#include "reference/scene/builtin.hpp"
#include "validation/truth/irradiance.hpp"
#include "validation/truth/multibounce.hpp"

namespace plumbline {
namespace {

using integrate::GatherSettings;
using integrate::RgbEstimate;
using integrate::World;
using test::expect_agrees;
using test::irradiance;
using test::mean_irradiance;

Vec3 tilted(double angle_deg) {
  const double a = angle_deg * kPi / 180.0;
  return Vec3(Vec3d(std::sin(a), std::cos(a), 0.0));
}

constexpr float kHuge = 1000.0F;
constexpr float kNear = 1e-3F;  // height over, or distance from, huge planes: they end at an angle of 1e-6

void add_ground(scene::Scene& scene, float albedo) {
  test::add_quad(scene, {-kHuge, 0, -kHuge}, {0, 0, 2 * kHuge}, {2 * kHuge, 0, 0},
                 test::add_material(scene, Rgb(albedo)));
}

// ---------------------------------------------------------------- direct light

TEST(ClosedForm, D01UniformSky) {
  const World world(test::nothing_in_the_way(), test::white_sky());
  expect_agrees(irradiance(world, Vec3(0.0F), {0.3F, 0.8F, -0.5F}, 1024), 3.14159265359);
}

TEST(ClosedForm, D02TiltedReceiverOverBlackGround) {
  scene::Scene scene;
  add_ground(scene, 0.0F);
  const World world(scene, test::white_sky());
  expect_agrees(irradiance(world, {0, kNear, 0}, tilted(60), 1 << 18), 2.35619449019, 2e-6);
}

TEST(ClosedForm, D03TiltedReceiverOverReflectingGround) {
  scene::Scene scene;
  add_ground(scene, 0.3F);
  const World world(scene, test::white_sky());
  expect_agrees(irradiance(world, {0, kNear, 0}, tilted(60), 1 << 18), 2.59181393921, 2e-6);
}

TEST(ClosedForm, D04CapAtZenithAndSunDisc) {
  light::Environment environment = test::no_sky();
  environment.suns.push_back({{0, 1, 0}, kPi / 6, Rgb(1.0F)});
  expect_agrees(irradiance(World(test::nothing_in_the_way(), environment), Vec3(0.0F), {0, 1, 0}, 1 << 16),
                kPi / 4);
  environment.suns = {{{0, 1, 0}, 0.2665 * kPi / 180.0, Rgb(14713.0969712F)}};
  expect_agrees(irradiance(World(test::nothing_in_the_way(), environment), Vec3(0.0F), {0, 1, 0}, 1 << 14),
                1.0);
}

TEST(ClosedForm, D05CapAboveTheHorizon) {
  light::Environment environment = test::no_sky();
  environment.suns.push_back({tilted(45), kPi / 6, Rgb(1.0F)});
  expect_agrees(irradiance(World(test::nothing_in_the_way(), environment), Vec3(0.0F), {0, 1, 0}, 1 << 17),
                0.555360367270);
}

TEST(ClosedForm, D07PointLight) {
  scene::Scene scene = test::nothing_in_the_way();
  scene.lights.emplace_back(light::PointLight{{1, 2, 0}, Rgb(1.0F)});
  expect_agrees(irradiance(World(scene, test::no_sky()), Vec3(0.0F), {0, 1, 0}, 64), 0.178885438200);
}

TEST(ClosedForm, D07PointLightsAmongMany) {
  scene::Scene scene = test::nothing_in_the_way();
  for (int i = 0; i < 5; ++i)
    scene.lights.emplace_back(light::PointLight{{1, 2, 0}, Rgb(static_cast<float>(i))});
  expect_agrees(irradiance(World(scene, test::no_sky()), Vec3(0.0F), {0, 1, 0}, 1 << 12),
                10 * 0.178885438200);
}

TEST(ClosedForm, D08ParallelDisc) {
  for (const auto& [x, truth] : {std::pair(1.0F, 0.146446609407), std::pair(0.0F, 0.2)}) {
    scene::Scene scene;
    test::add_disc(scene, {x, 2, 0}, {1, 0, 0}, {0, 0, 1}, 1024,
                   test::add_material(scene, Rgb(0.0F), Rgb(1.0F)));
    expect_agrees(irradiance(World(scene, test::no_sky()), Vec3(0.0F), {0, 1, 0}, 1 << 16), kPi * truth,
                  1e-5);
  }
}

TEST(ClosedForm, D09ParallelRectangle) {
  scene::Scene scene;
  test::add_quad(scene, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, test::add_material(scene, Rgb(0.0F), Rgb(1.0F)));
  expect_agrees(irradiance(World(scene, test::no_sky()), Vec3(0.0F), {0, 1, 0}, 1 << 16),
                kPi * 0.138531605995);
}

TEST(ClosedForm, D09BothSidesOfALightShineOnlyWhenAskedTo) {
  for (const bool is_double_sided : {false, true}) {
    scene::Scene scene;
    test::add_quad(scene, {-1, 1, -1}, {0, 0, 2}, {2, 0, 0},
                   test::add_material(scene, Rgb(0.0F), Rgb(1.0F), is_double_sided));  // faces up
    const RgbEstimate estimate = irradiance(World(scene, test::no_sky()), Vec3(0.0F), {0, 1, 0}, 1 << 16);
    if (is_double_sided) {
      expect_agrees(estimate, kPi * 0.554126423980);
    } else {
      EXPECT_EQ(estimate.mean.y, 0.0);
    }
  }
}

TEST(ClosedForm, D10PerpendicularRectangle) {
  scene::Scene scene;
  test::add_quad(scene, {1, 0, 0}, {0, 0, 1}, {0, 1, 0}, test::add_material(scene, Rgb(0.0F), Rgb(1.0F)));
  expect_agrees(irradiance(World(scene, test::no_sky()), Vec3(0.0F), {0, 1, 0}, 1 << 16),
                kPi * 0.0557341970026);
}

TEST(ClosedForm, D11LambertPolygon) {
  // Axes turned so that the formula's z is our y: (x, y, z) -> (x, z, -y).
  scene::Scene scene;
  test::add_triangle(scene, {1, 1, 0}, {-1, 2, 1}, {0, 1, -1},
                     test::add_material(scene, Rgb(0.0F), Rgb(1.0F), true));
  expect_agrees(irradiance(World(scene, test::no_sky()), Vec3(0.0F), {0, 1, 0}, 1 << 17), 0.687617388735);
}

TEST(ClosedForm, D12WallAndDihedral) {
  scene::Scene scene;  // black wall of height 1 at distance 1
  test::add_quad(scene, {1, 0, -kHuge}, {0, 0, 2 * kHuge}, {0, 1, 0}, test::add_material(scene, Rgb(0.0F)));
  expect_agrees(irradiance(World(scene, test::white_sky()), {0, 0, 0}, {0, 1, 0}, 1 << 18),
                kPi * 0.853553390593, 2e-6);
  scene::Scene high;  // as good as infinitely high
  test::add_quad(high, {kNear, 0, -kHuge}, {0, 0, 2 * kHuge}, {0, kHuge, 0},
                 test::add_material(high, Rgb(0.0F)));
  expect_agrees(irradiance(World(high, test::white_sky()), {0, 0, 0}, {0, 1, 0}, 1 << 18), kPi * 0.5, 4e-6);
}

TEST(ClosedForm, D15SphereOccluderAndEmitter) {
  constexpr double kFacets = 8e-5;  // 2 h^2 of 256 rings, see add_sphere
  struct Case {
    double height, lateral, open;
  };
  for (const Case& c : {Case{1, 1, 0.646446609407}, Case{2, 0, 0.75}, Case{2, 1, 0.821114561800}}) {
    scene::Scene blocker;
    test::add_sphere(blocker, Vec3(Vec3d(c.lateral, c.height, 0)), 1.0, 256, false,
                     test::add_material(blocker, Rgb(0.0F)));
    expect_agrees(irradiance(World(blocker, test::white_sky()), Vec3(0.0F), {0, 1, 0}, 1 << 15), kPi * c.open,
                  kFacets);
    scene::Scene emitter;
    test::add_sphere(emitter, Vec3(Vec3d(c.lateral, c.height, 0)), 1.0, 256, false,
                     test::add_material(emitter, Rgb(0.0F), Rgb(1.0F)));
    expect_agrees(irradiance(World(emitter, test::no_sky()), Vec3(0.0F), {0, 1, 0}, 1 << 16),
                  kPi * (1.0 - c.open), kFacets);
  }
}

TEST(ClosedForm, D17CoaxialDiscs) {
  scene::Scene scene;
  test::add_disc(scene, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, 1024,
                 test::add_material(scene, Rgb(0.0F), Rgb(1.0F)));
  const World world(scene, test::no_sky());
  const auto on_disc = [](Vec2 u) {
    const double r = std::sqrt(static_cast<double>(u.x));
    const double phi = 2.0 * kPi * static_cast<double>(u.y);
    return trace::free_point(Vec3(Vec3d(r * std::cos(phi), 0.0, r * std::sin(phi))), {0, 1, 0});
  };
  expect_agrees(mean_irradiance(world, on_disc, 150, 0), kPi * 0.381966011250, 1e-5);
}

TEST(ClosedForm, D18FacesOfACube) {
  const auto on_floor = [](Vec2 u) { return trace::free_point({u.x, 0.0F, u.y}, {0, 1, 0}); };
  scene::Scene opposite;  // ceiling
  test::add_quad(opposite, {0, 1, 0}, {1, 0, 0}, {0, 0, 1},
                 test::add_material(opposite, Rgb(0.0F), Rgb(1.0F)));
  expect_agrees(mean_irradiance(World(opposite, test::no_sky()), on_floor, 150, 0), kPi * 0.199824895698);
  scene::Scene adjacent;  // wall x = 1, facing -x
  test::add_quad(adjacent, {1, 0, 0}, {0, 0, 1}, {0, 1, 0},
                 test::add_material(adjacent, Rgb(0.0F), Rgb(1.0F)));
  expect_agrees(mean_irradiance(World(adjacent, test::no_sky()), on_floor, 220, 0), kPi * 0.200043776075);
}

TEST(ClosedForm, D19SphereAndDisc) {
  // The disc of radius r = h receives, from a sphere of radiance 1, the flux pi A_sphere F(sphere -> disc);
  // as a mean irradiance over pi r^2.
  scene::Scene scene;
  const double radius = 0.25;
  test::add_sphere(scene, {0, 1, 0}, radius, 256, false, test::add_material(scene, Rgb(0.0F), Rgb(1.0F)));
  const auto on_disc = [](Vec2 u) {
    const double r = std::sqrt(static_cast<double>(u.x));
    const double phi = 2.0 * kPi * static_cast<double>(u.y);
    return trace::free_point(Vec3(Vec3d(r * std::cos(phi), 0.0, r * std::sin(phi))), {0, 1, 0});
  };
  const double truth = kPi * (4.0 * kPi * radius * radius) * 0.146446609407 / kPi;
  expect_agrees(mean_irradiance(World(scene, test::no_sky()), on_disc, 200, 0), truth,
                8e-5);  // 2 h^2 of 256 rings
}

TEST(ClosedForm, D20OvercastSky) {
  const World world(test::nothing_in_the_way(), light::make_builtin_environment("overcast"));
  expect_agrees(irradiance(world, Vec3(0.0F), {0, 1, 0}, 1 << 17), 2.44346095279);
  expect_agrees(irradiance(world, Vec3(0.0F), {0, 0, 1}, 1 << 18), 0.968043220043);
}

TEST(ClosedForm, D21BandLimitedAndSignedLight) {
  const Vec3d axis = glm::normalize(Vec3d(2, 3, 6));
  const scene::Scene nothing = test::nothing_in_the_way();
  const auto along = [&](double power) {
    return test::analytic_sky([=](const Vec3d& w) { return std::pow(glm::dot(w, axis), power); });
  };
  const Vec3 n(axis);
  // L = 1 + 2 w.a is negative below: a and b of either sign, E = pi a + (2 pi / 3) b n.a
  const World linear(nothing,
                     test::analytic_sky([=](const Vec3d& w) { return 1.0 + 2.0 * glm::dot(w, axis); }));
  expect_agrees(irradiance(linear, Vec3(0.0F), n, 1 << 18), kPi + 4.0 * kPi / 3.0);
  expect_agrees(irradiance(linear, Vec3(0.0F), -n, 1 << 20), kPi - 4.0 * kPi / 3.0);
  const Vec3 sideways(glm::normalize(glm::cross(axis, Vec3d(0, 1, 0))));
  const Vec3 at_60(Vec3d(sideways) * std::sin(kPi / 3) + axis * 0.5);
  expect_agrees(irradiance(World(nothing, along(2)), Vec3(0.0F), at_60, 1 << 18), 0.981747704247);
  expect_agrees(irradiance(World(nothing, along(3)), Vec3(0.0F), n, 1 << 17), 2.0 * kPi / 5.0);
  expect_agrees(irradiance(World(nothing, along(4)), Vec3(0.0F), n, 1 << 17), kPi / 3.0);
}

// ---------------------------------------------------------------- many bounces

TEST(ClosedForm, M01FurnaceAtEveryBounceCount) {
  const double albedo = 0.8;
  scene::Scene scene;
  test::add_room(scene, 1.0F, test::add_material(scene, Rgb(static_cast<float>(albedo)), Rgb(1.0F)));
  const World world(scene, test::no_sky());
  const auto exit_radiance = [&](int bounces) {  // of a wall: its emission and what it reflects
    RgbEstimate e = irradiance(world, {0.3F, 0.0F, 0.6F}, {0, 1, 0}, 1 << 18, bounces);
    e.mean = 1.0 + albedo / kPi * e.mean;
    e.standard_error *= albedo / kPi;
    return e;
  };
  double truth = 1.0;
  double power = 1.0;
  for (int bounces = 0; bounces <= 8; ++bounces) {
    power *= albedo;
    truth += power;  // Le (1 + rho + ... + rho^(bounces + 1)): the wall's own reflection is the last factor
    SCOPED_TRACE(bounces);
    expect_agrees(exit_radiance(bounces), truth);
  }
  expect_agrees(exit_radiance(integrate::kAllBounces), 5.0);
}

TEST(ClosedForm, M02WhiteFurnaceOnAnyMesh) {
  scene::Scene scene = scene::make_builtin_scene("open-box");
  for (scene::Material& material : scene.materials) material = {"", Rgb(1.0F), Rgb(0.0F), -1, true};
  scene.vertex_colors.clear();
  const World world(scene, test::white_sky());
  const std::vector<trace::SurfacePoint> points = trace::vertex_points(scene);
  for (std::size_t v = 0; v < points.size(); v += points.size() / 7) {
    GatherSettings settings;
    settings.samples = 1 << 16;
    expect_agrees(integrate::gather_irradiance(world, points[v], v, settings), kPi);
  }
}

TEST(ClosedForm, M03PointLightInASphere) {
  scene::Scene scene;
  test::add_sphere(scene, Vec3(0.0F), 1.0, 128, true, test::add_material(scene, Rgb(0.5F)));
  scene.lights.emplace_back(light::PointLight{Vec3(0.0F), Rgb(static_cast<float>(kPi))});
  const World world(scene, test::no_sky());
  RgbEstimate e = irradiance(world, {0, -0.99999F, 0}, {0, 1, 0}, 1 << 19);
  e.mean *= 0.5 / kPi;
  e.standard_error *= 0.5 / kPi;
  expect_agrees(e, 1.0, 3e-4);  // 2 h^2 of 128 rings, see add_sphere
}

/// A face from the z axis out to kHuge along u, in cells that grow with their distance: floats resolve the neighbourhood of the edge only
/// when the triangles there have small coordinates.
void add_graded_face(scene::Scene& scene, const Vec3d& u, bool is_u_first, float albedo) {
  const std::uint32_t material = test::add_material(scene, Rgb(albedo));
  std::vector<double> marks = {0.0};
  for (double mark = static_cast<double>(kNear) / 4.0; mark < static_cast<double>(kHuge); mark *= 4.0)
    marks.push_back(mark);
  marks.push_back(static_cast<double>(kHuge));
  const auto cell = [&](double u0, double u1, double z0, double z1) {
    const Vec3 corner(u * u0 + Vec3d(0, 0, z0));
    const Vec3 along_u(u * (u1 - u0));
    const Vec3 along_z(0, 0, static_cast<float>(z1 - z0));
    is_u_first ? test::add_quad(scene, corner, along_u, along_z, material)
               : test::add_quad(scene, corner, along_z, along_u, material);
  };
  for (std::size_t i = 0; i + 1 < marks.size(); ++i) {
    for (std::size_t k = 0; k + 1 < marks.size(); ++k) {
      cell(marks[i], marks[i + 1], marks[k], marks[k + 1]);
      cell(marks[i], marks[i + 1], -marks[k + 1], -marks[k]);
    }
  }
}

scene::Scene dihedral(double angle_deg, float floor_albedo, float wall_albedo) {
  const double a = angle_deg * kPi / 180.0;
  scene::Scene scene;  // floor along +x from the edge (the z axis), wall turned up by the angle
  add_graded_face(scene, {1, 0, 0}, false, floor_albedo);
  add_graded_face(scene, {std::cos(a), std::sin(a), 0}, true, wall_albedo);
  return scene;
}

TEST(ClosedForm, M09DihedralCorner) {
  // Faces of size W seen from d err by about 0.57 d / W in the form factor.
  for (const auto& [angle, truth] :
       {std::pair(90.0, 2.61799387799), std::pair(60.0, 1.96349540849), std::pair(120.0, 2.94524311274)}) {
    SCOPED_TRACE(angle);
    const World world(dihedral(angle, 0.8F, 0.8F), test::white_sky());
    expect_agrees(irradiance(world, {kNear, 0, 0}, {0, 1, 0}, 1 << 18), truth, 1e-5);
  }
}

TEST(ClosedForm, M10CornerOfTwoAlbedos) {
  const World world(dihedral(90, 0.5F, 0.8F), test::white_sky());
  expect_agrees(irradiance(world, {kNear, 0, 0}, {0, 1, 0}, 1 << 18), 2.44346095279, 1e-5);
  expect_agrees(irradiance(world, {0, kNear, 0}, {1, 0, 0}, 1 << 18), 2.18166156499, 1e-5);
}

TEST(ClosedForm, M16NeumannTermsOfTheCorner) {
  const World world(dihedral(90, 0.8F, 0.8F), test::white_sky());
  GatherSettings settings;
  settings.samples = 1 << 20;
  settings.max_bounces = 4;
  const auto terms =
      integrate::gather_bounces(world, trace::free_point({kNear, 0, 0}, {0, 1, 0}), 3, settings);
  for (int k = 0; k <= 4; ++k) {
    SCOPED_TRACE(k);
    const RgbEstimate& term = terms[static_cast<std::size_t>(k)];
    const double truth = kPi / 2.0 * std::pow(0.4, k);
    EXPECT_LE(std::abs(term.mean.y - truth), 4.0 * term.standard_error.y + 1e-5 * truth);
    EXPECT_LE(term.standard_error.y, 0.01 * truth);
  }
}

TEST(ClosedForm, ScaleChangesNothing) {
  for (const float scale : {1e-3F, 1.0F, 1e3F}) {
    scene::Scene scene = dihedral(90, 0.8F, 0.8F);
    for (Vec3& p : scene.positions) p *= scale;
    const World world(scene, test::white_sky());
    expect_agrees(irradiance(world, {kNear * scale, 0, 0}, {0, 1, 0}, 1 << 17), 2.61799387799, 1e-5);
  }
}

}  // namespace
}  // namespace plumbline
