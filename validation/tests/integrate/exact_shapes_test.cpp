// The path tracer on exact spheres and discs against closed forms, without any allowance for facets. As strict as
// closed_forms_test.cpp: within 4 standard errors, at most 0.1 % of standard error, and 1 % off must fail (where few
// paths carry the light, the later bounces of a bowl, the precision asked for is stated with the case).
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <stdexcept>

#include "agreement.hpp"
#include "pieces.hpp"
#include "reference/integrate/render.hpp"
#include "reference/scene/exact_scenes.hpp"
#include "reference/scene/shapes.hpp"
#include "reference/trace/surface_point.hpp"
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

/// The surface that is seen from a point.
trace::SurfacePoint seen(const World& world, const Vec3& from, const Vec3& towards) {
  const Vec3 direction = glm::normalize(towards);
  const std::optional<trace::Hit> hit = world.caster.closest_hit({from, direction});
  if (!hit) throw std::logic_error("nothing is seen");
  return trace::surface_hit(world.scene, *hit, direction).point;
}

RgbEstimate scaled(RgbEstimate estimate, double factor, double offset = 0.0) {
  estimate.mean = estimate.mean * factor + offset;
  estimate.standard_error *= factor;
  return estimate;
}

std::vector<RgbEstimate> by_bounce(const World& world, const trace::SurfacePoint& point, int samples,
                                   int bounces) {
  GatherSettings settings;
  settings.samples = samples;
  settings.max_bounces = bounces;
  settings.seed = 5;
  return integrate::gather_bounces(world, point, 2, settings);
}

/// Mean radiance of an image and its standard error, from the pixels' own.
struct ImageMean {
  double mean = 0.0;
  double standard_error = 0.0;
};
ImageMean image_mean(const World& world, const scene::Camera& camera, int side, int samples) {
  integrate::RenderSettings settings;
  settings.width = side;
  settings.height = side;
  settings.samples_per_pixel = samples;
  settings.seed = 9;
  const integrate::RenderResult result = integrate::render(world, camera, settings);
  double sum = 0.0;
  double squares = 0.0;
  const std::vector<float>& mean = result.image.channels.at("G");
  const std::vector<float>& error = result.image.channels.at("stderr.G");
  for (std::size_t p = 0; p < mean.size(); ++p) {
    sum += static_cast<double>(mean[p]);
    squares += static_cast<double>(error[p]) * static_cast<double>(error[p]);
  }
  const auto pixels = static_cast<double>(mean.size());
  return {sum / pixels, std::sqrt(squares) / pixels};
}

// ---------------------------------------------------------------- inside a sphere

TEST(ExactShapes, M01FurnaceInASphereAtEveryBounceCount) {
  const World world(scene::make_sphere_room(), test::no_sky());
  const trace::SurfacePoint wall = seen(world, Vec3(0.0F), {0.3F, -0.5F, 0.6F});
  const auto exit_radiance = [&](int bounces, int samples) {
    return scaled(irradiance(world, wall, samples, bounces), 0.8 / kPi, 1.0);
  };
  for (int bounces = 0; bounces <= 8; ++bounces) {
    SCOPED_TRACE(bounces);
    expect_agrees(exit_radiance(bounces, bounces < 4 ? 1 << 15 : 1 << 17),
                  truth::enclosure_radiance(1.0, 0.8, bounces));
  }
  expect_agrees(exit_radiance(integrate::kAllBounces, 1 << 18), 5.0);
}

TEST(ExactShapes, M01FurnaceInASphereAsAPicture) {
  const World world(scene::make_sphere_room(), test::no_sky());
  const ImageMean image = image_mean(world, world.scene.cameras[0], 16, 512);
  expect_agrees(image.mean, image.standard_error, 5.0, 0.0, 0.002);
}

TEST(ExactShapes, M03PointLightAtTheCentre) {
  scene::Scene scene = scene::make_sphere_room({.albedo = 0.5F, .emission = 0.0F});
  scene.lights.emplace_back(light::PointLight{Vec3(0.0F), Rgb(static_cast<float>(kPi))});
  const World world(scene, test::no_sky());
  const RgbEstimate e = irradiance(world, seen(world, Vec3(0.0F), {0.2F, -0.9F, 0.4F}), 1 << 17);
  expect_agrees(scaled(e, 0.5 / kPi), 1.0);
}

TEST(ExactShapes, M04PointLightOffTheCentreSeenFromBothPoles) {
  scene::Scene scene = scene::make_sphere_room({.albedo = 0.5F, .emission = 0.0F});
  scene.lights.emplace_back(light::PointLight{{0.0F, 0.5F, 0.0F}, Rgb(1.0F)});
  const World world(scene, test::no_sky());
  for (const auto& [pole, truth] : {std::pair(1.0F, 0.795774715459), std::pair(-1.0F, 0.229890473355)}) {
    const RgbEstimate e = irradiance(world, seen(world, Vec3(0.0F), {0.0F, pole, 0.0F}), 1 << 19);
    expect_agrees(scaled(e, 0.5 / kPi), truth);
  }
}

TEST(ExactShapes, M13ConcentricSpheres) {
  const scene::ConcentricSpheres spheres;
  const World world(scene::make_concentric_spheres(spheres), test::no_sky());
  const truth::Pair radiosity = truth::concentric_spheres_radiosity(1.0, 2.0, {1.0, 0.0}, {0.5, 0.8});
  const trace::SurfacePoint inner = seen(world, {0, 1.5F, 0}, {0.1F, -1.0F, 0.2F});
  const trace::SurfacePoint outer = seen(world, {0, 1.5F, 0}, {0.1F, 1.0F, 0.2F});
  expect_agrees(scaled(irradiance(world, inner, 1 << 18), 0.5, 1.0), radiosity.first);
  expect_agrees(scaled(irradiance(world, outer, 1 << 18), 0.8), radiosity.second);
}

// ---------------------------------------------------------------- cavities

TEST(ExactShapes, M06CavitiesUnderAUniformSky) {
  for (const double opening : {0.5 * kPi, 0.25 * kPi, 0.75 * kPi}) {
    SCOPED_TRACE(opening);
    const World world(scene::make_cavity(opening, 0.8F), test::white_sky());
    // the bottom, and a point a twentieth of a radian below the rim
    for (const double angle : {0.0, kPi - opening - 0.05}) {
      const Vec3 towards(Vec3d(std::sin(angle), -std::cos(angle), 0.0));
      expect_agrees(irradiance(world, seen(world, Vec3(0.0F), towards), 1 << 18),
                    truth::cavity_irradiance(opening, 0.8, 1.0), 0.0, 0.002);
    }
  }
  const World white(scene::make_bowl(1.0F), test::white_sky());
  expect_agrees(irradiance(white, seen(white, Vec3(0.0F), {0.5F, -1.0F, 0.0F}), 1 << 17), kPi);
}

TEST(ExactShapes, M07SunAlongTheAxisOfTheBowlPerBounce) {
  scene::Scene scene = scene::make_bowl();
  scene.lights.emplace_back(light::DirectionalLight{{0.0F, -1.0F, 0.0F}, Rgb(1.0F)});
  const World world(scene, test::no_sky());
  for (const double angle : {0.0, 1.2}) {
    SCOPED_TRACE(angle);
    const Vec3 towards(Vec3d(std::sin(angle), -std::cos(angle), 0.0));
    const trace::SurfacePoint point = seen(world, Vec3(0.0F), towards);
    const std::vector<RgbEstimate> terms = by_bounce(world, point, 1 << 18, 3);
    expect_agrees(terms[0], std::cos(angle));
    expect_agrees(terms[1], 0.2, 0.0, 0.002);
    expect_agrees(terms[2], 0.08, 0.0, 0.005);
    expect_agrees(terms[3], 0.032, 0.0, 0.01);
    expect_agrees(scaled(irradiance(world, point, 1 << 18), 1.0, -std::cos(angle)),
                  truth::bowl_indirect_irradiance(1.0, 0.8), 0.0, 0.0025);
  }
}

TEST(ExactShapes, M16NeumannTermsOfTheBowlUnderAUniformSky) {
  const World world(scene::make_bowl(), test::white_sky());
  const auto terms = by_bounce(world, seen(world, Vec3(0.0F), {0.3F, -1.0F, 0.2F}), 1 << 19, 3);
  for (int k = 0; k <= 3; ++k) {
    SCOPED_TRACE(k);
    expect_agrees(terms[static_cast<std::size_t>(k)], truth::neumann_term(0.5 * kPi, 0.8, 0.5, k), 0.0,
                  0.002 + 0.003 * k);
  }
}

TEST(ExactShapes, ScaleAndPlaceChangeNothing) {
  for (const float scale : {1e-3F, 1.0F, 1e3F}) {
    for (const Vec3& shift : {Vec3(0.0F), Vec3(20.0F, -30.0F, 10.0F)}) {
      SCOPED_TRACE(scale);
      scene::Scene scene = scene::make_bowl();
      scene.spheres[0].centre = scale * shift;
      scene.spheres[0].radius = scale;
      const World world(scene, test::white_sky());
      expect_agrees(irradiance(world, seen(world, scale * shift, {0.3F, -1.0F, 0.2F}), 1 << 17),
                    truth::cavity_irradiance(0.5 * kPi, 0.8, 1.0));
    }
  }
}

// ---------------------------------------------------------------- sphere and plane

struct Place {
  float height, lateral;
};
constexpr Place kPlaces[] = {{1, 1}, {2, 0}, {2, 1}};

trace::SurfacePoint on_plane(const World& world, float lateral) {
  return seen(world, {lateral, 1e-3F, 0.0F}, {0.0F, -1.0F, 0.0F});
}

TEST(ExactShapes, D15SphereOccluder) {
  for (const Place& p : kPlaces) {
    SCOPED_TRACE(p.lateral);
    const World world(scene::make_sphere_over_plane({.height = p.height}), test::white_sky());
    expect_agrees(
        irradiance(world, on_plane(world, p.lateral), 1 << 17),
        kPi * truth::sphere_sky_view(1.0, static_cast<double>(p.height), static_cast<double>(p.lateral)));
  }
}

TEST(ExactShapes, D15SphereEmitter) {
  for (const Place& p : {kPlaces[0], kPlaces[1], kPlaces[2], Place{1, 0.05F}, Place{1, 30}}) {
    SCOPED_TRACE(p.lateral);
    const World world(scene::make_sphere_over_plane({.height = p.height, .sphere_emission = 1.0F}),
                      test::no_sky());
    expect_agrees(
        irradiance(world, on_plane(world, p.lateral), 1 << 17),
        truth::sphere_irradiance(1.0, static_cast<double>(p.height), static_cast<double>(p.lateral), 1.0));
  }
}

// Points of the plane drawn by u -> h tan(acos(1 - u)): an area element is 2 pi h^2/(1 - u)^3 du.
TEST(ExactShapes, D15TotalFluxOfASphereEmitterOntoThePlane) {
  scene::Scene scene = scene::make_sphere_over_plane({.sphere_emission = 1.0F});
  const World world(scene, test::no_sky());
  integrate::RandomisedMean mean(integrate::kRandomisations);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  integrate::BounceTerms terms;
  constexpr int kStrata = 1 << 14;
  for (int r = 0; r < integrate::kRandomisations; ++r) {
    double sum = 0.0;
    for (int i = 0; i < kStrata; ++i) {
      const double cosine = 1.0 - (i + uniform(random)) / kStrata;
      const double lateral = std::sqrt(1.0 - cosine * cosine) / cosine;
      integrate::Sampler sampler(11, static_cast<std::uint64_t>(i), static_cast<std::uint32_t>(r), 0);
      terms.clear();
      const trace::SurfacePoint point =
          trace::free_point({static_cast<float>(lateral), 1e-6F, 0.0F}, {0, 1, 0});
      integrate::add_irradiance(world, point, 0, sampler, terms);
      for (const RgbD& term : terms) sum += term.y * 2.0 * kPi / (cosine * cosine * cosine);
    }
    mean.add(r, RgbD(sum / kStrata));
  }
  expect_agrees(mean.estimate(), truth::sphere_flux_on_plane(1.0, 1.0), 1e-5);
}

TEST(ExactShapes, M02WhiteFurnaceWithASphere) {
  scene::Scene scene = scene::make_sphere_over_plane({.sphere_albedo = 1.0F, .plane_albedo = 1.0F});
  for (scene::Material& material : scene.materials) material.is_double_sided = true;
  scene.spheres.push_back({{3, 0.5F, 0}, 0.5F, 1, true, {0, -1, 0}, -0.3F});
  scene.discs.push_back({{-2, 1, 0}, glm::normalize(Vec3(1, 0.5F, 0.2F)), 0.7F, 1});
  const World world(scene, test::white_sky());
  for (const Vec3& towards : {Vec3(0, -1, 0), Vec3(0.05F, -1, 0), Vec3(1, -1, 0), Vec3(-0.5F, -0.7F, 0)}) {
    expect_agrees(irradiance(world, seen(world, {0, 3, 0}, towards), 1 << 13), kPi);
  }
}

// ---------------------------------------------------------------- discs

trace::SurfacePoint on_unit_disc(Vec2 u) {
  const double r = std::sqrt(static_cast<double>(u.x));
  const double phi = 2.0 * kPi * static_cast<double>(u.y);
  return trace::free_point(Vec3(Vec3d(r * std::cos(phi), 0.0, r * std::sin(phi))), {0, 1, 0});
}

TEST(ExactShapes, D08ParallelDiscOnItsFrontAlone) {
  for (const float side : {-1.0F, 1.0F}) {
    for (const float x : {0.0F, 1.0F}) {
      scene::Scene scene;
      scene.discs.push_back({{x, 2, 0}, {0, side, 0}, 1.0F, test::add_material(scene, Rgb(0.0F), Rgb(1.0F))});
      const RgbEstimate e = irradiance(World(scene, test::no_sky()), Vec3(0.0F), {0, 1, 0}, 1 << 16);
      if (side > 0.0F) {
        EXPECT_EQ(e.mean.y, 0.0);
      } else {
        expect_agrees(e, kPi * truth::disc_form_factor(1.0, 2.0, static_cast<double>(x)));
      }
    }
  }
}

TEST(ExactShapes, D17CoaxialDiscs) {
  scene::Scene scene;
  scene.discs.push_back({{0, 1, 0}, {0, -1, 0}, 1.0F, test::add_material(scene, Rgb(0.0F), Rgb(1.0F))});
  const World world(scene, test::no_sky());
  expect_agrees(mean_irradiance(world, on_unit_disc, 220, 0), kPi * 0.381966011250);
}

TEST(ExactShapes, D19SphereOverADisc) {
  constexpr double kRadius = 0.25;
  scene::Scene scene;
  scene.spheres.push_back(
      {{0, 1, 0}, static_cast<float>(kRadius), test::add_material(scene, Rgb(0.0F), Rgb(1.0F))});
  const double truth = 4.0 * kPi * kRadius * kRadius * truth::sphere_to_disc_form_factor(1.0, 1.0);
  expect_agrees(mean_irradiance(World(scene, test::no_sky()), on_unit_disc, 150, 0), truth);
}

// Inside a sphere a patch of area A gives every point pi L A/(4 pi R^2): the emitter is a cap of it.
TEST(ExactShapes, D19FormFactorToACapInsideASphere) {
  scene::Scene scene;
  const std::uint32_t dark = test::add_material(scene, Rgb(0.0F));
  const std::uint32_t bright = test::add_material(scene, Rgb(0.0F), Rgb(1.0F));
  scene.spheres.push_back({Vec3(0.0F), 1.0F, dark, true, {0, -1, 0}, -0.6F});
  scene.spheres.push_back({Vec3(0.0F), 1.0F, bright, true, {0, 1, 0}, 0.6F});
  const World world(scene, test::no_sky());
  const double truth = kPi * truth::inside_sphere_form_factor(2.0 * kPi * 0.4, 1.0);
  for (const Vec3& towards : {Vec3(0, -1, 0), Vec3(1, 0, 0), Vec3(0.7F, 0.4F, 0), Vec3(0, 1, 0)}) {
    expect_agrees(irradiance(world, seen(world, Vec3(0.0F), towards), 1 << 17), truth);
  }
}

// ---------------------------------------------------------------- emitters met and drawn

// Mixed lights, one of each kind and a triangle: the sum is the sum of the parts.
TEST(ExactShapes, LightsOfAllKindsAddUp) {
  const auto add_ball = [](scene::Scene& scene) {
    const auto bright = test::add_material(scene, Rgb(0.0F), Rgb(2.0F));
    scene.spheres.push_back({{-1.5F, 2, 0}, 0.5F, bright});
  };
  const auto add_disc = [](scene::Scene& scene) {
    const auto bright = test::add_material(scene, Rgb(0.0F), Rgb(1.0F), true);
    scene.discs.push_back({{1, 2, 0}, {0, 1, 0}, 0.5F, bright});
  };
  const auto add_square = [](scene::Scene& scene) {
    test::add_quad(scene, {0, 1, 1}, {1, 0, 0}, {0, 0, 1},
                   test::add_material(scene, Rgb(0.0F), Rgb(1.0F), true));
  };
  const auto add_cavity = [](scene::Scene& scene) {  // seen from below into its bright inside
    const auto bright = test::add_material(scene, Rgb(0.0F), Rgb(1.0F));
    scene.spheres.push_back({{0, 2, -2}, 0.5F, bright, true, {0, 1, 0}, 0.0F});
  };
  const auto measured = [](const scene::Scene& scene) {
    return irradiance(World(scene, test::no_sky()), Vec3(0.0F), {0, 1, 0}, 1 << 18);
  };
  scene::Scene all;
  add_ball(all);
  add_disc(all);
  add_square(all);
  add_cavity(all);
  scene::Scene ball;
  add_ball(ball);
  scene::Scene disc;
  add_disc(disc);
  scene::Scene square;
  add_square(square);
  scene::Scene cavity;
  add_cavity(cavity);
  const double ball_alone = 2.0 * truth::sphere_irradiance(0.5, 2.0, 1.5, 1.0);
  const double disc_alone = kPi * truth::disc_form_factor(0.5, 2.0, 1.0);
  const double cavity_alone = kPi * truth::disc_form_factor(0.5, 2.0, 2.0);  // its mouth looks as bright
  const double square_alone = kPi * (truth::corner_rectangle_form_factor(1.0, 2.0, 1.0) -
                                     truth::corner_rectangle_form_factor(1.0, 1.0, 1.0));
  expect_agrees(measured(ball), ball_alone);
  expect_agrees(measured(disc), disc_alone);
  expect_agrees(measured(square), square_alone);
  expect_agrees(measured(cavity), cavity_alone);
  expect_agrees(measured(all), ball_alone + disc_alone + square_alone + cavity_alone);
}

// ---------------------------------------------------------------- pictures and planes

TEST(ExactShapes, D23SilhouetteOfASphere) {
  scene::Scene scene;
  scene.spheres.push_back({Vec3(0.0F), 1.0F, test::add_material(scene, Rgb(0.0F), Rgb(1.0F))});
  const scene::Camera camera = scene::look_at({0, 0, 3}, Vec3(0.0F), {0, 1, 0}, 60.0F);
  const ImageMean image = image_mean(World(scene, test::no_sky()), camera, 64, 64);
  expect_agrees(image.mean, image.standard_error, 0.294524311274);
}

// Two black squares at right angles through one centre: their mutual form factor falls short of 1/2 by 0.568 d/W.
TEST(ExactShapes, M12FiniteSquaresFallShortByTheKnownAmount) {
  for (const double ratio : {20.0, 200.0, 1e5}) {
    SCOPED_TRACE(ratio);
    scene::Scene scene;
    const std::uint32_t black = test::add_material(scene, Rgb(0.0F));
    const Vec3d x(1, 0, 0);
    const Vec3d y(0, 1, 0);
    const Vec3d z(0, 0, 1);
    const double size = 0.01 * ratio;
    scene::append(scene, scene::make_graded_square(Vec3d(0.0), z, x, 1e-3, size), black);
    scene::append(scene, scene::make_graded_square(Vec3d(0.0), y, z, 1e-3, size), black);
    const World world(scene, test::white_sky());
    const RgbEstimate e = irradiance(world, seen(world, {0.01F, 0.005F, 0}, {0, -1, 0}), 1 << 19);
    const double form_factor = 1.0 - e.mean.y / kPi;
    const double error = e.standard_error.y / kPi;
    EXPECT_LE(std::abs(form_factor - truth::finite_corner_form_factor(ratio, 1.0)), 4.0 * error + 1e-6);
    // the series' next term is below (d/W)^2
    EXPECT_LE(std::abs(0.5 - form_factor - 0.568 / ratio), 4.0 * error + 1.0 / (ratio * ratio) + 1e-6);
    EXPECT_LE(error, 1e-3) << "4 errors must tell 0.568/20 from nothing";
  }
}

}  // namespace
}  // namespace plumbline
