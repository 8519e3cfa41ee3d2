// Direct light: D1 … D19 of the closed forms, as scenes.
#include <array>
#include <cmath>

#include "validation/checks/truths_estimators.hpp"
#include "validation/checks/truths_scenes.hpp"
#include "validation/truth/distant.hpp"
#include "validation/truth/irradiance.hpp"

namespace plumbline::checks {
namespace {

using trace::free_point;
using truth::cap_irradiance;

constexpr double kDegree = kPi / 180.0;
const Vec3d kUp(0.0, 1.0, 0.0);
const Vec3d kOrigin(0.0);
constexpr int kDirect = 0;  // bounces

/// Irradiance at the origin of the ground, from an emitter of radiance 1 that `add` puts into an empty scene.
template <class Add>
std::function<Estimator()> lit_by(const Add& add, int bounces = kDirect) {
  return [add, bounces] {
    scene::Scene scene;
    add(scene, add_grey(scene, 0.0, 1.0, true));
    return irradiance_at(make_world(std::move(scene), constant_sky(0.0)), kOrigin, kUp, bounces);
  };
}

/// The same with a black body in the way of a sky of radiance 1.
template <class Add>
std::function<Estimator()> hidden_by(const Add& add) {
  return [add] {
    scene::Scene scene;
    add(scene, add_grey(scene, 0.0));
    return irradiance_at(make_world(std::move(scene), constant_sky(1.0)), kOrigin, kUp);
  };
}

/// Irradiance at the origin under an environment alone.
template <class Make>
std::function<Estimator()> under(const Make& environment, const Vec3d& normal) {
  return [environment, normal] {
    return irradiance_at(make_world(nothing_in_the_way(), environment()), kOrigin, normal);
  };
}

TruthCase noiseless(TruthCase one) {
  one.is_noiseless = true;
  one.pilot_samples = 64;
  return one;
}

TruthCase finite(TruthCase one, double model_error = kEndOfPlane) {
  one.model_error = model_error;
  return one;
}

// ---------------------------------------------------------------- skies and planes

std::function<Estimator()> over_ground(double tilt, double albedo) {
  return [tilt, albedo] {
    scene::Scene scene;
    add_ground(scene, albedo);
    return irradiance_at(make_world(std::move(scene), constant_sky(1.0)), {0.0, kNear, 0.0}, tilted(tilt));
  };
}

/// The middle of a face of an octahedron over black ground; its faces are tilted by acos(+-1/sqrt 3).
std::function<Estimator()> on_octahedron(bool is_upper) {
  return [is_upper] {
    constexpr double kSize = 0.5 * kNear;
    scene::Scene scene;
    add_ground(scene, 0.0);
    const std::uint32_t material = add_grey(scene, 0.0);
    const Vec3d centre(0.0, kNear, 0.0);
    for (int octant = 0; octant < 8; ++octant) {
      const Vec3d sign(octant & 1 ? -1.0 : 1.0, octant & 2 ? -1.0 : 1.0, octant & 4 ? -1.0 : 1.0);
      const Vec3d x = centre + Vec3d(kSize * sign.x, 0.0, 0.0);
      const Vec3d y = centre + Vec3d(0.0, kSize * sign.y, 0.0);
      const Vec3d z = centre + Vec3d(0.0, 0.0, kSize * sign.z);
      sign.x* sign.y* sign.z > 0.0 ? add_triangle(scene, x, y, z, material)
                                   : add_triangle(scene, x, z, y, material);
    }
    const Vec3d normal = glm::normalize(Vec3d(1.0, is_upper ? 1.0 : -1.0, 1.0));
    const Vec3d position = centre + kSize / std::sqrt(3.0) * normal;
    return irradiance_at(make_world(std::move(scene), constant_sky(1.0)), position, normal);
  };
}

void add_sky_cases(std::vector<TruthCase>& cases) {
  const char* const tilt = "E = pi L [(1 + cos b) + g (1 - cos b)]/2";
  cases.push_back(noiseless(named("D01_UniformSky", "E = pi L", truth::uniform_sky_irradiance(1.0),
                                  under([] { return constant_sky(1.0); }, {0.3, 0.8, -0.5}))));
  cases.push_back(finite(named("D02_TiltedOverBlackGround", tilt,
                               truth::tilted_receiver_irradiance(60.0 * kDegree, 0.0, 1.0),
                               over_ground(60.0 * kDegree, 0.0))));
  cases.push_back(finite(named("D03_TiltedOverGreyGround", tilt,
                               truth::tilted_receiver_irradiance(60.0 * kDegree, 0.3, 1.0),
                               over_ground(60.0 * kDegree, 0.3))));
  for (const bool is_upper : {true, false}) {
    const double b = std::acos((is_upper ? 1.0 : -1.0) / std::sqrt(3.0));
    cases.push_back(finite(named(is_upper ? "D16_ConvexBodyAbove" : "D16_ConvexBodyBelow",
                                 "every point of a convex body over black ground: E = pi L (1 + cos b)/2",
                                 truth::tilted_receiver_irradiance(b, 0.0, 1.0), on_octahedron(is_upper))));
  }
  const auto disc = [](const Vec3d& direction, double half_angle, double radiance) {
    return [=] {
      light::Environment environment = constant_sky(0.0);
      environment.suns.push_back(sun(direction, half_angle, radiance));
      return environment;
    };
  };
  const double sun_angle = 0.2665 * kDegree;
  cases.push_back(named("D04_CapAtZenith", "E = pi L sin^2 a", cap_irradiance(30.0 * kDegree, 0.0, 1.0),
                        under(disc(kUp, 30.0 * kDegree, 1.0), kUp)));
  cases.push_back(named("D04_SunDisc", "E = pi L sin^2 a = 1 for L = 14713.0969712", 1.0,
                        under(disc(kUp, sun_angle, truth::sun_radiance(sun_angle, 1.0)), kUp)));
  cases.push_back(named("D05_CapAboveHorizon", "E = pi L sin^2 a cos t",
                        cap_irradiance(30.0 * kDegree, 45.0 * kDegree, 1.0),
                        under(disc(tilted(45.0 * kDegree), 30.0 * kDegree, 1.0), kUp)));
  cases.push_back(named("D05_SphereLight", "E = pi L (R/d)^2 cos t",
                        cap_irradiance(30.0 * kDegree, 45.0 * kDegree, 1.0),
                        lit_by([](scene::Scene& scene, std::uint32_t material) {
                          add_sphere(scene, 2.0 * tilted(45.0 * kDegree), 1.0, Front::outward, material);
                        })));
}

// ---------------------------------------------------------------- lights

constexpr double kLightHeight = 2.0;
/// Lights of these intensities, the i-th i + 1 to the side.
std::function<Estimator()> by_point_lights(const std::vector<double>& intensities) {
  return [intensities] {
    scene::Scene scene = nothing_in_the_way();
    for (std::size_t i = 0; i < intensities.size(); ++i) {
      const Vec3d position(static_cast<double>(i + 1), kLightHeight, 0.0);
      scene.lights.emplace_back(light::PointLight{Vec3(position), Rgb(static_cast<float>(intensities[i]))});
    }
    return irradiance_at(make_world(std::move(scene), constant_sky(0.0)), kOrigin, kUp);
  };
}

double point_lights(const std::vector<double>& intensities) {
  double sum = 0.0;
  for (std::size_t i = 0; i < intensities.size(); ++i)
    sum += truth::point_light_irradiance(intensities[i], kLightHeight, static_cast<double>(i + 1));
  return sum;
}

void add_light_cases(std::vector<TruthCase>& cases) {
  const char* const point = "E = I h/(h^2 + x^2)^1.5";
  cases.push_back(noiseless(named("D07_PointLight", point, point_lights({1.0}), by_point_lights({1.0}))));
  cases.push_back(named("D07_FivePointLights", point, point_lights({3.0, 0.0, 1.0, 40.0, 2.0}),
                        by_point_lights({3.0, 0.0, 1.0, 40.0, 2.0})));
  const auto disc = [](double x) {
    return lit_by([x](scene::Scene& scene, std::uint32_t material) {
      add_disc(scene, {x, 2.0, 0.0}, -kUp, 1.0, material);
    });
  };
  const char* const howell = "F = (1 - (x^2 + h^2 - r^2)/sqrt((x^2 + h^2 + r^2)^2 - 4 r^2 x^2))/2";
  cases.push_back(named("D08_DiscAside", howell, kPi * truth::disc_form_factor(1.0, 2.0, 1.0), disc(1.0)));
  cases.push_back(named("D08_DiscAbove", howell, kPi * truth::disc_form_factor(1.0, 2.0, 0.0), disc(0.0)));
  const auto quad = [](const Vec3d& corner, const Vec3d& u, const Vec3d& v) {
    return lit_by(
        [=](scene::Scene& scene, std::uint32_t material) { add_quad(scene, corner, u, v, material); });
  };
  const char* const corner =
      "F = [A/sqrt(1+A^2) atan(B/sqrt(1+A^2)) + the same with A and B exchanged]/(2 pi)";
  cases.push_back(named("D09_CornerRectangle", corner,
                        kPi * truth::corner_rectangle_form_factor(1.0, 1.0, 1.0),
                        quad({0, 1, 0}, {1, 0, 0}, {0, 0, 1})));
  cases.push_back(named("D09_CentredRectangle", corner,
                        kPi * truth::centred_rectangle_form_factor(2.0, 2.0, 1.0),
                        quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2})));
  cases.push_back(named("D10_PerpendicularRectangle",
                        "F = [atan(b/c) - c/s atan(b/s)]/(2 pi), s^2 = a^2 + c^2",
                        kPi * truth::perpendicular_rectangle_form_factor(1.0, 1.0, 1.0),
                        quad({1, 0, 0}, {0, 0, 1}, {0, 1, 0})));
  const std::array<Vec3d, 3> triangle = {Vec3d(1, 0, 1), Vec3d(0, 1, 1), Vec3d(-1, -1, 2)};
  cases.push_back(
      named("D11_LambertPolygon", "E = (L/2) sum theta_i (Gamma_i . n)",
            truth::polygon_irradiance(triangle, Vec3d(0, 0, 1), 1.0),
            lit_by([](scene::Scene& scene, std::uint32_t material) {  // (x, y, z) -> (x, z, -y): z up to y up
              add_triangle(scene, {1, 1, 0}, {-1, 2, 1}, {0, 1, -1}, material);
            })));
}

// ---------------------------------------------------------------- obstructions

std::function<Estimator()> on_black_dihedral(double opening) {
  return [opening] {
    return irradiance_at(make_world(dihedral(opening, 0.0, 0.0), constant_sky(1.0)), {kNear, 0.0, 0.0}, kUp);
  };
}

std::function<Estimator()> before_wall(double height, double distance) {
  return hidden_by([=](scene::Scene& scene, std::uint32_t material) {
    add_quad(scene, {distance, 0.0, -kFar}, {0.0, 0.0, 2.0 * kFar}, {0.0, height, 0.0}, material);
  });
}

void add_obstruction_cases(std::vector<TruthCase>& cases) {
  const char* const wall = "E/pi = (1 + cos(atan(h/d)))/2";
  // The wall at distance 1 ends kFar to either side: cut off is a form factor below (1/kFar)^2.
  cases.push_back(
      finite(named("D12_Wall", wall, kPi * truth::wall_sky_view(1.0, 1.0), before_wall(1.0, 1.0))));
  cases.push_back(finite(named("D12_InfiniteWall", "E/pi = 1/2", kPi / 2.0, before_wall(kFar, kNear)),
                         2.0 * kEndOfPlane));
  for (const double degrees : {60.0, 120.0}) {
    cases.push_back(finite(named(degrees < 90.0 ? "D12_Dihedral60" : "D12_Dihedral120",
                                 "E/pi = (1 - cos phi)/2", kPi * truth::dihedral_sky_view(degrees * kDegree),
                                 on_black_dihedral(degrees * kDegree))));
  }
  struct Place {
    const char* suffix;
    double height, lateral;
  };
  for (const Place& p : {Place{"Touching", 1, 1}, Place{"Above", 1.7, 0}, Place{"Aside", 2, 1}}) {
    const auto sphere = [p](scene::Scene& scene, std::uint32_t material) {
      add_sphere(scene, {p.lateral, p.height, 0.0}, 1.0, Front::outward, material);
    };
    cases.push_back(named(std::string("D15_Occluder") + p.suffix, "E = pi L (1 - h R^2/(h^2 + x^2)^1.5)",
                          kPi * truth::sphere_sky_view(1.0, p.height, p.lateral), hidden_by(sphere)));
    cases.push_back(named(std::string("D15_Emitter") + p.suffix, "E = pi L h R^2/(h^2 + x^2)^1.5",
                          truth::sphere_irradiance(1.0, p.height, p.lateral, 1.0), lit_by(sphere)));
  }
}

// ---------------------------------------------------------------- between surfaces

// Means over an area are sums over Gauss-Legendre nodes: the irradiances are smooth functions of the place, so few
// nodes are exact to far below the margins.

/// Sum of weight x irradiance over the nodes, from emitters of radiance 1.
std::function<Estimator()> mean_over(const std::function<void(scene::Scene&, std::uint32_t)>& add,
                                     const std::vector<WeightedPoint>& nodes) {
  return [add, nodes] {
    scene::Scene scene;
    add(scene, add_grey(scene, 0.0, 1.0, true));
    const SharedWorld world = make_world(std::move(scene), constant_sky(0.0));
    std::vector<IrradianceTerm> terms;
    for (const WeightedPoint& node : nodes) terms.push_back({world, node.point, node.weight, kDirect});
    return irradiance_sum(terms);
  };
}

std::vector<WeightedPoint> disc_nodes() {  // by symmetry along one radius, uniform in r^2
  std::vector<WeightedPoint> nodes;
  for (const Node& node : unit_interval_nodes())
    nodes.push_back({free_point(Vec3(Vec3d(std::sqrt(node.place), 0.0, 0.0)), Vec3(kUp)), node.weight});
  return nodes;
}

/// `softened`: the irradiance has a kink at x = 1, where the square meets a wall; x = 1 - s^3 irons it out.
std::vector<WeightedPoint> square_nodes(bool is_softened) {
  std::vector<WeightedPoint> nodes;
  for (const Node& a : unit_interval_nodes()) {
    const double x = is_softened ? 1.0 - a.place * a.place * a.place : a.place;
    const double density = is_softened ? 3.0 * a.place * a.place : 1.0;
    for (const Node& b : unit_interval_nodes())
      nodes.push_back({free_point(Vec3(Vec3d(x, 0.0, b.place)), Vec3(kUp)), a.weight * b.weight * density});
  }
  return nodes;
}

/// What a shining plane sends to a black sphere over it: by reciprocity what the sphere would send to the plane.
std::function<Estimator()> flux_on_sphere() {
  constexpr double kRadius = 0.5 * kNear;
  const Vec3d centre(0.0, kNear, 0.0);
  std::vector<WeightedPoint> nodes;
  for (const Node& node : unit_interval_nodes()) {
    const Vec3d outward = glm::normalize(uniform_direction(node.place, 0.2));
    nodes.push_back({free_point(Vec3(centre + kRadius * outward), glm::normalize(Vec3(outward))),
                     4.0 * kPi * node.weight});
  }
  const auto add = [centre](scene::Scene& scene, std::uint32_t material) {
    add_quad(scene, {-kFar, 0.0, -kFar}, {0.0, 0.0, 2.0 * kFar}, {2.0 * kFar, 0.0, 0.0}, material);
    add_sphere(scene, centre, kRadius, Front::outward, add_grey(scene, 0.0));
  };
  return mean_over(add, nodes);
}

std::function<Estimator()> inside_sphere() {
  return [] {  // black but for a cap about -x, seen from the far side
    scene::Scene scene;
    const double edge = std::cos(40.0 * kDegree);
    add_sphere(scene, kOrigin, 1.0, Front::inward, add_grey(scene, 0.0, 1.0), {{-1, 0, 0}, edge});
    add_sphere(scene, kOrigin, 1.0, Front::inward, add_grey(scene, 0.0), {{1, 0, 0}, -edge});
    const Vec3d outward = glm::normalize(Vec3d(2, 3, 6));
    return irradiance_at(make_world(std::move(scene), constant_sky(0.0)), outward, -outward);
  };
}

void add_surface_cases(std::vector<TruthCase>& cases) {
  cases.push_back(finite(named("D15_FluxBetweenSphereAndPlane", "2 pi^2 R^2 L",
                               truth::sphere_flux_on_plane(1.0, 1.0), flux_on_sphere())));
  cases.push_back(named("D17_CoaxialDiscs", "F = (X - sqrt(X^2 - 4 (R2/R1)^2))/2, X = 1 + (1 + R2^2)/R1^2",
                        kPi * truth::coaxial_discs_form_factor(1.0, 1.0, 1.0),
                        mean_over(
                            [](scene::Scene& scene, std::uint32_t material) {
                              add_disc(scene, {0.0, 1.0, 0.0}, -kUp, 1.0, material);
                            },
                            disc_nodes())));
  const auto quad = [](const Vec3d& corner, const Vec3d& u, const Vec3d& v, bool is_softened) {
    return mean_over(
        [=](scene::Scene& scene, std::uint32_t material) { add_quad(scene, corner, u, v, material); },
        square_nodes(is_softened));
  };
  cases.push_back(named("D18_OppositeFaces", "Howell C-11",
                        kPi * truth::opposite_rectangles_form_factor(1, 1, 1),
                        quad({0, 1, 0}, {1, 0, 0}, {0, 0, 1}, false)));
  cases.push_back(named("D18_AdjacentFaces", "Howell C-14",
                        kPi * truth::adjacent_rectangles_form_factor(1, 1, 1),
                        quad({1, 0, 0}, {0, 0, 1}, {0, 1, 0}, true)));
  const double radius = 0.5;  // flux pi A F over the disc's area pi
  cases.push_back(named("D19_SphereToDisc", "F = (1 - 1/sqrt(1 + (r/h)^2))/2",
                        4.0 * kPi * radius * radius * truth::sphere_to_disc_form_factor(1.0, 1.0),
                        mean_over(
                            [radius](scene::Scene& scene, std::uint32_t material) {
                              add_sphere(scene, {0.0, 1.0, 0.0}, radius, Front::outward, material);
                            },
                            disc_nodes())));
  cases.push_back(named("D19_InsideSphere", "F(dA1 -> A2) = A2/(4 pi R^2)",
                        kPi * truth::inside_sphere_form_factor(truth::cap_solid_angle(40.0 * kDegree), 1.0),
                        inside_sphere()));
  cases.push_back(named("D23_SphereSilhouette", "share of the image: pi R^2/(D^2 - R^2)/(4 tan^2(f/2))",
                        truth::sphere_silhouette_share(1.0, 3.0, 60.0 * kDegree), [] {
                          scene::Scene scene;
                          add_sphere(scene, kOrigin, 1.0, Front::outward, add_grey(scene, 0.0, 1.0));
                          return image_mean(make_world(std::move(scene), constant_sky(0.0)),
                                            scene::look_at({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 60.0F));
                        }));
  cases.back().pilot_samples = 16 * 32 * 32;
}

}  // namespace

std::vector<TruthCase> direct_light_cases() {
  std::vector<TruthCase> cases;
  add_sky_cases(cases);
  add_light_cases(cases);
  add_obstruction_cases(cases);
  add_surface_cases(cases);
  return cases;
}

}  // namespace plumbline::checks
