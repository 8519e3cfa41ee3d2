// Closed and nearly closed rooms: M1 … M7, M13, M14 of the closed forms.
#include <fmt/format.h>

#include <cmath>

#include "reference/scene/builtin.hpp"
#include "validation/checks/truths_estimators.hpp"
#include "validation/checks/truths_scenes.hpp"
#include "validation/truth/irradiance.hpp"
#include "validation/truth/multibounce.hpp"

namespace plumbline::checks {
namespace {

using integrate::kAllBounces;

const Vec3d kUp(0.0, 1.0, 0.0);
const Vec3d kOrigin(0.0);
constexpr double kDegree = kPi / 180.0;

trace::SurfacePoint point_at(const Vec3d& position, const Vec3d& normal) {
  return trace::free_point(Vec3(position), glm::normalize(Vec3(normal)));
}

// ---------------------------------------------------------------- M1: furnaces
constexpr double kRoomAlbedo = 0.8;
SharedWorld furnace_room() {
  scene::Scene scene;
  add_room(scene, 1.0, add_grey(scene, kRoomAlbedo, 1.0));
  return make_world(std::move(scene), constant_sky(0.0));
}
const Vec3d kInRoom(0.3, 0.0, 0.6);

/// Exit radiance of the floor: its emission and what it reflects.
std::function<Estimator()> room_radiance(int bounces) {
  return [bounces] {
    return irradiance_sum({{furnace_room(), point_at(kInRoom, kUp), kRoomAlbedo / kPi, bounces}}, 1.0);
  };
}

void add_furnace_cases(std::vector<TruthCase>& cases) {
  for (int n = 0; n <= 8; ++n) {
    cases.push_back(named(fmt::format("M01_FurnaceBounces{}", n), "L = L_e (1 - rho^(n + 2))/(1 - rho)",
                          truth::enclosure_radiance(1.0, kRoomAlbedo, n), room_radiance(n)));
  }
  cases.push_back(named("M01_FurnaceAllBounces", "L = L_e/(1 - rho)",
                        truth::enclosure_radiance(1.0, kRoomAlbedo), room_radiance(kAllBounces)));
  for (const int k : {1, 2, 4, 8}) {
    cases.push_back(named(fmt::format("M16_FurnaceBounce{}Alone", k), "E_k = pi L_e rho^k",
                          truth::neumann_term(kPi, kRoomAlbedo, 1.0, k),
                          [k] { return bounces_at(furnace_room(), kInRoom, kUp, k, k); }));
  }
  cases.push_back(named("M01_FurnaceInSphere", "L = L_e/(1 - rho)", truth::enclosure_radiance(1.0, 0.5), [] {
    scene::Scene scene;
    add_sphere(scene, kOrigin, 1.0, Front::inward, add_grey(scene, 0.5, 1.0));
    return irradiance_sum({{make_world(std::move(scene), constant_sky(0.0)), point_at(-0.999 * kUp, kUp),
                            0.5 / kPi, kAllBounces}},
                          1.0);
  }));
}

// ---------------------------------------------------------------- M2: white furnaces
scene::Scene white_open_box() {
  scene::Scene scene = scene::make_builtin_scene("open-box");
  for (scene::Material& material : scene.materials) material = {"", Rgb(1.0F), Rgb(0.0F), -1, true};
  scene.vertex_colors.clear();
  return scene;
}

void add_white_cases(std::vector<TruthCase>& cases) {
  for (int i = 0; i < 4; ++i) {
    cases.push_back(
        named(fmt::format("M02_WhiteFurnacePoint{}", i), "albedo 1 under a sky of 1: E = pi", kPi, [i] {
          const scene::Scene scene = white_open_box();
          const std::vector<trace::SurfacePoint> points = trace::vertex_points(scene);
          return irradiance_sum({{make_world(scene, constant_sky(1.0)),
                                  points[points.size() * static_cast<std::size_t>(2 * i + 1) / 8U], 1.0}});
        }));
  }
  cases.push_back(named("M02_WhiteFurnaceImage", "albedo 1 under a sky of 1: every pixel 1", 1.0, [] {
    const scene::Scene scene = white_open_box();
    return image_mean(make_world(scene, constant_sky(1.0)), scene.cameras.front());
  }));
  cases.back().pilot_samples = 16 * 32 * 32;
  cases.back().is_noiseless = true;  // no path ends before it finds the sky: each carries 1
}

// ---------------------------------------------------------------- M3, M4: inside a sphere
SharedWorld sphere_with_light(double offset, double intensity) {
  scene::Scene scene;
  add_sphere(scene, kOrigin, 1.0, Front::inward, add_grey(scene, 0.5));
  scene.lights.emplace_back(
      light::PointLight{Vec3(Vec3d(0.0, offset, 0.0)), Rgb(static_cast<float>(intensity))});
  return make_world(std::move(scene), constant_sky(0.0));
}

/// rho/pi E at the wall where its outward normal is `outward`.
std::function<Estimator()> wall_radiance(double offset, double intensity, const Vec3d& outward) {
  return [=] {
    return irradiance_sum({{sphere_with_light(offset, intensity), point_at(outward, -outward), 0.5 / kPi}});
  };
}

void add_sphere_cases(std::vector<TruthCase>& cases) {
  const char* const any = "E_ind = rho Phi/(4 pi R^2 (1 - rho)), L = rho/pi (E_direct + E_ind)";
  cases.push_back(named("M03_LightAtTheCentre", "L = rho/(1 - rho) I/(pi R^2)",
                        truth::sphere_point_light_radiance(kPi, 0.0, 1.0, 1.0, 0.5),
                        wall_radiance(0.0, kPi, glm::normalize(Vec3d(1.0, -2.0, 0.5)))));
  cases.push_back(named("M04_NorthPole", any, truth::sphere_point_light_radiance(1.0, 0.5, 1.0, 1.0, 0.5),
                        wall_radiance(0.5, 1.0, kUp)));
  cases.push_back(named("M04_SouthPole", any, truth::sphere_point_light_radiance(1.0, 0.5, 1.0, -1.0, 0.5),
                        wall_radiance(0.5, 1.0, -kUp)));
  const Vec3d equator = glm::normalize(Vec3d(3.0, 0.0, -1.0));
  cases.push_back(
      named("M04_IndirectAtTheEquator", any, truth::sphere_indirect_irradiance(4.0 * kPi, 1.0, 0.5),
            [equator] { return bounces_at(sphere_with_light(0.25, 1.0), equator, -equator, 1, 40); }));
}

// ---------------------------------------------------------------- M6, M7: cavities
/// The opening is the cap of half-angle a about +Y.
scene::Scene cavity(double opening_half_angle, double albedo) {
  scene::Scene scene;
  add_sphere(scene, kOrigin, 1.0, Front::inward, add_grey(scene, albedo),
             {-kUp, -std::cos(opening_half_angle)});
  return scene;
}

std::function<Estimator()> cavity_under_sky(double opening_half_angle, double albedo, const Vec3d& outward) {
  return [=] {
    return irradiance_at(make_world(cavity(opening_half_angle, albedo), constant_sky(1.0)), outward,
                         -outward);
  };
}

/// Beyond 40 bounces of a bowl of albedo .8, and of a sphere of albedo .5, less than 10^-12 of the light is left.
constexpr int kAsGoodAsAll = 40;

/// What bounces 1 ... n bring to a point of the bowl, under a sun or a sky.
std::function<Estimator()> bowl_indirect(const std::function<light::Environment()>& sky, int bounces) {
  return [sky, bounces] {
    scene::Scene scene = cavity(kPi / 2.0, 0.8);
    light::Environment environment = constant_sky(0.0);
    if (sky) {
      environment = sky();
    } else {
      scene.lights.emplace_back(light::DirectionalLight{{0.0F, -1.0F, 0.0F}, Rgb(1.0F)});
    }
    const Vec3d outward = glm::normalize(Vec3d(1.0, -1.0, 0.3));
    return bounces_at(make_world(std::move(scene), std::move(environment)), outward, -outward, 1, bounces);
  };
}

void add_cavity_cases(std::vector<TruthCase>& cases) {
  const Vec3d deep = -kUp;
  const Vec3d side = glm::normalize(Vec3d(1.0, -0.5, 0.3));
  const char* const sky = "E = pi f/(1 - rho (1 - f)), f = (1 - cos a)/2";
  cases.push_back(named("M06_BowlBottom", sky, truth::cavity_irradiance(kPi / 2.0, 0.8, 1.0),
                        cavity_under_sky(kPi / 2.0, 0.8, deep)));
  cases.push_back(named("M06_BowlSide", sky, truth::cavity_irradiance(kPi / 2.0, 0.8, 1.0),
                        cavity_under_sky(kPi / 2.0, 0.8, side)));
  cases.push_back(named("M06_WhiteBowl", sky, truth::cavity_irradiance(kPi / 2.0, 1.0, 1.0),
                        cavity_under_sky(kPi / 2.0, 1.0, side)));
  cases.push_back(named("M06_NarrowCavity", sky, truth::cavity_irradiance(60.0 * kDegree, 0.8, 1.0),
                        cavity_under_sky(60.0 * kDegree, 0.8, side)));
  const char* const indirect = "E_ind = (rho/4)/(1 - rho/2) E_aperture";
  for (const int n : {1, 2}) {
    cases.push_back(named(fmt::format("M07_SunlitBowlBounces{}", n), "E_ind = E_s rho/4 (1 + rho/2 + ...)",
                          truth::bowl_indirect_irradiance(1.0, 0.8, n), bowl_indirect({}, n)));
  }
  cases.push_back(named("M07_SunlitBowl", indirect, truth::bowl_indirect_irradiance(1.0, 0.8),
                        bowl_indirect({}, kAsGoodAsAll)));
  cases.push_back(
      named("M07_BowlUnderOvercast", indirect,
            truth::bowl_indirect_irradiance(truth::overcast_irradiance(0.0, 1.0), 0.8),
            bowl_indirect([] { return light::make_builtin_environment("overcast"); }, kAsGoodAsAll)));
}

// ---------------------------------------------------------------- M13, M14: two surfaces
constexpr double kEmitted = 1.0;  // radiosity of the first surface

std::function<Estimator()> concentric(double distance, double direction) {
  return [=] {
    scene::Scene scene;
    add_sphere(scene, kOrigin, 1.0, Front::outward, add_grey(scene, 0.5, kEmitted / kPi));
    add_sphere(scene, kOrigin, 2.0, Front::inward, add_grey(scene, 0.8));
    const Vec3d outward = glm::normalize(Vec3d(2.0, 1.0, -2.0));
    return irradiance_at(make_world(std::move(scene), constant_sky(0.0)), distance * outward,
                         direction * outward);
  };
}

std::function<Estimator()> between_plates(double height, double direction) {
  return [=] {
    scene::Scene scene;
    const std::uint32_t lower = add_grey(scene, 0.5, kEmitted / kPi);
    const std::uint32_t upper = add_grey(scene, 0.8);
    add_quad(scene, {-kFar, 0.0, -kFar}, {0.0, 0.0, 2.0 * kFar}, {2.0 * kFar, 0.0, 0.0}, lower);
    add_quad(scene, {-kFar, 1.0, -kFar}, {2.0 * kFar, 0.0, 0.0}, {0.0, 0.0, 2.0 * kFar}, upper);
    return irradiance_at(make_world(std::move(scene), constant_sky(0.0)), {0.1, height, 0.3},
                         direction * kUp);
  };
}

// B = M + rho E tells the irradiance on each surface.
void add_pair_cases(std::vector<TruthCase>& cases) {
  const truth::Pair spheres = truth::concentric_spheres_radiosity(1.0, 2.0, {kEmitted, 0.0}, {0.5, 0.8});
  const char* const two = "B1 = M1 + rho1 B2, B2 = M2 + rho2 (q B1 + (1 - q) B2)";
  cases.push_back(named("M13_InnerSphere", two, (spheres.first - kEmitted) / 0.5, concentric(1.0, 1.0)));
  cases.push_back(named("M13_OuterSphere", two, spheres.second / 0.8, concentric(2.0, -1.0)));
  const truth::Pair plates = truth::parallel_plates_radiosity({kEmitted, 0.0}, {0.5, 0.8});
  const char* const plate = "B1 = (M1 + rho1 M2)/(1 - rho1 rho2)";
  cases.push_back(named("M14_LowerPlate", plate, (plates.first - kEmitted) / 0.5, between_plates(0.0, 1.0)));
  cases.push_back(named("M14_UpperPlate", plate, plates.second / 0.8, between_plates(1.0, -1.0)));
  for (std::size_t i = cases.size() - 2; i < cases.size(); ++i) cases[i].model_error = 2.0 * kEndOfPlane;
}

}  // namespace

std::vector<TruthCase> enclosure_cases() {
  std::vector<TruthCase> cases;
  add_furnace_cases(cases);
  add_white_cases(cases);
  add_sphere_cases(cases);
  add_cavity_cases(cases);
  add_pair_cases(cases);
  return cases;
}

}  // namespace plumbline::checks
