// Light from far away over the whole sphere: D20, D21, D24, D25.
#include <array>
#include <cmath>
#include <random>

#include "validation/checks/truths_estimators.hpp"
#include "validation/checks/truths_scenes.hpp"
#include "validation/truth/distant.hpp"
#include "validation/truth/irradiance.hpp"

namespace plumbline::checks {
namespace {

const Vec3d kUp(0.0, 1.0, 0.0);
const Vec3d kAxis = glm::normalize(Vec3d(2.0, 3.0, 6.0));  // of the band-limited lights: no axis of the world

template <class Make>
std::function<Estimator()> under(const Make& environment, const Vec3d& normal) {
  return [environment, normal] {
    return irradiance_at(make_world(nothing_in_the_way(), environment()), Vec3d(0.0), normal);
  };
}

/// At `angle` from kAxis.
Vec3d aside(double angle) {
  return kAxis * std::cos(angle) + glm::normalize(glm::cross(kAxis, kUp)) * std::sin(angle);
}

// ---------------------------------------------------------------- D20, D21
light::Environment power_sky(int power) {
  return analytic_sky([power](const Vec3d& w) { return std::pow(glm::dot(w, kAxis), power); });
}
light::Environment linear_sky(double a, double b) {
  return analytic_sky([a, b](const Vec3d& w) { return a + b * glm::dot(w, kAxis); });
}
light::Environment overcast() {
  return light::make_builtin_environment("overcast");
}

void add_band_limited_cases(std::vector<TruthCase>& cases) {
  cases.push_back(named("D20_OvercastHorizontal", "E = 7 pi/9 L_z", truth::overcast_irradiance(0.0, 1.0),
                        under(overcast, kUp)));
  cases.push_back(named("D20_OvercastVertical", "E = (pi/2 + 4/3)/3 L_z",
                        truth::overcast_irradiance(kPi / 2.0, 1.0), under(overcast, {0.0, 0.0, 1.0})));
  const char* const linear = "L = a + b w.z: E = pi a + (2 pi/3) b n.z";
  struct Linear {
    const char* suffix;
    double b, n_z;
  };
  for (const Linear& l : {Linear{"Towards", 1.0, 1.0}, Linear{"Aside", 1.0, 0.5},
                          Linear{"SignedTowards", 2.0, 1.0}, Linear{"SignedAway", 2.0, -1.0}}) {
    cases.push_back(named(std::string("D21_Linear") + l.suffix, linear,
                          truth::linear_environment_irradiance(1.0, l.b, l.n_z),
                          under([l] { return linear_sky(1.0, l.b); }, aside(std::acos(l.n_z)))));
  }
  struct Power {
    const char* suffix;
    int power;
    double n_z;
  };
  for (const Power& p :
       {Power{"SquareAt60", 2, 0.5}, Power{"SquareTowards", 2, 1.0}, Power{"CubeTowards", 3, 1.0},
        Power{"CubeAt60", 3, 0.5}, Power{"FourthTowards", 4, 1.0}, Power{"FourthAt60", 4, 0.5}}) {
    cases.push_back(named(std::string("D21_") + p.suffix, "L = (w.z)^k, integrated term by term",
                          truth::axis_power_irradiance(p.power, p.n_z),
                          under([p] { return power_sky(p.power); }, aside(std::acos(p.n_z)))));
  }
  for (const int power : {6, 8}) {
    cases.push_back(named(power == 6 ? "D21_SixthTowards" : "D21_EighthTowards",
                          "L = (w.z)^k, n = z: E = 2 pi/(k + 2)", 2.0 * kPi / (power + 2),
                          under([power] { return power_sky(power); }, kAxis)));
  }
}

// ---------------------------------------------------------------- D24
constexpr int kWidth = 8;
constexpr int kHeight = 4;
/// Random texels, one of them 50 times as bright.
std::vector<double> texels() {
  std::mt19937 random(24);
  std::vector<double> values;
  for (int i = 0; i < kWidth * kHeight; ++i)
    values.push_back(static_cast<double>(static_cast<float>(random() % 1000U) / 1000.0F));
  values[11] = 50.0;
  return values;
}

struct Cap {
  Vec3d axis;
  double half_angle, radiance;
};
/// Two of these cross the horizon of kAxis: no closed form for a single receiver.
std::array<Cap, 3> caps() {
  return {Cap{kUp, 0.5, 1.0}, Cap{aside(1.3), 0.6, 2.0}, Cap{-aside(0.9), 0.3, 3.0}};
}
light::Environment cap_sky() {
  light::Environment environment = constant_sky(0.25);
  for (const Cap& cap : caps()) environment.suns.push_back(sun(cap.axis, cap.half_angle, cap.radiance));
  return environment;
}
light::Environment image_sky() {
  return lat_long_sky(texels(), kWidth, kHeight, light::Lookup::nearest);
}

template <class Make>
std::function<Estimator()> both_sides(const Make& environment) {
  return [environment] {
    const SharedWorld world = make_world(nothing_in_the_way(), environment());
    const auto point = [](const Vec3d& n) { return trace::free_point(Vec3(0.0F), glm::normalize(Vec3(n))); };
    return irradiance_sum({{world, point(kAxis), 1.0}, {world, point(-kAxis), -1.0}});
  };
}

template <class Make>
std::function<Estimator()> all_normals(const Make& environment) {
  return [environment] {
    return irradiance_over(make_world(nothing_in_the_way(), environment()), [](double u, double v) {
      return WeightedPoint{trace::free_point(Vec3(0.0F), glm::normalize(Vec3(uniform_direction(u, v))))};
    });
  };
}

void add_moment_cases(std::vector<TruthCase>& cases) {
  Vec3d vector(0.0);
  for (const Cap& cap : caps()) {
    vector += truth::disc_vector_irradiance(cap.axis, cap.half_angle, cap.radiance);
  }
  const truth::DistantMoments image = truth::lat_long_moments(texels(), kWidth, kHeight);
  const char* const odd = "E(n) - E(-n) = n . int L w dw";
  const char* const mean = "mean of E(n) over n = int L dw/4";
  cases.push_back(named("D24_OppositeNormalsUnderCaps", odd, glm::dot(vector, kAxis), both_sides(cap_sky)));
  cases.push_back(
      named("D24_OppositeNormalsUnderAnImage", odd, glm::dot(image.vector, kAxis), both_sides(image_sky)));
  cases.push_back(named("D24_MeanOverNormals", mean, image.flux / 4.0, all_normals(image_sky)));
}

// ---------------------------------------------------------------- D25
light::Environment scaled_overcast(double factor) {
  return analytic_sky([factor](const Vec3d& w) { return factor * std::max(0.0, (1.0 + 2.0 * w.y) / 3.0); });
}

/// In a corner that reflects, where no direct formula would hide a slip: E(2 L1 + 3 L2) - 2 E(L1) - 3 E(L2).
std::function<Estimator()> superposition() {
  return [] {
    const scene::Scene scene = dihedral(kPi / 2.0, 0.8, 0.8);
    const auto first = [](double factor) {
      return [factor](const Vec3d& w) { return factor * (1.0 + 0.5 * w.x); };
    };
    const auto second = [](double factor) {
      return [factor](const Vec3d& w) { return factor * (1.0 - 0.5 * w.z * w.y); };
    };
    const auto both = [=](const Vec3d& w) { return first(2.0)(w) + second(3.0)(w); };
    const trace::SurfacePoint point = trace::free_point(Vec3(Vec3d(kNear, 0.0, 0.0)), Vec3(kUp));
    return irradiance_sum({{make_world(scene, analytic_sky(both)), point, 1.0, 1},
                           {make_world(scene, analytic_sky(first(1.0))), point, -2.0, 1},
                           {make_world(scene, analytic_sky(second(1.0))), point, -3.0, 1}});
  };
}

/// The same random numbers under four times the light: four times the irradiance, a power of two, so to the last bit.
std::function<Estimator()> homogeneity() {
  return [] {
    const scene::Scene scene = dihedral(kPi / 2.0, 0.8, 0.8);
    const Estimator one = irradiance_at(make_world(scene, scaled_overcast(1.0)), {kNear, 0.0, 0.0}, kUp);
    const Estimator four = irradiance_at(make_world(scene, scaled_overcast(4.0)), {kNear, 0.0, 0.0}, kUp);
    return [one, four](const Effort& effort) {
      const Measurement a = one(effort);
      const Measurement b = four(effort);
      return Measurement{b.mean / a.mean, 0.0, a.degrees_of_freedom};
    };
  };
}

void add_linearity_cases(std::vector<TruthCase>& cases) {
  TruthCase sum = named("D25_Superposition", "E(2 L1 + 3 L2) - 2 E(L1) - 3 E(L2) = 0, relative to 5 pi/2",
                        0.0, superposition());
  sum.scale = 5.0 * kPi / 2.0;
  cases.push_back(std::move(sum));
  TruthCase four =
      named("D25_Homogeneity", "E(4 L)/E(L) = 4 with the same random numbers", 4.0, homogeneity());
  four.is_noiseless = true;
  cases.push_back(std::move(four));
}

}  // namespace

std::vector<TruthCase> distant_light_cases() {
  std::vector<TruthCase> cases;
  add_band_limited_cases(cases);
  add_moment_cases(cases);
  add_linearity_cases(cases);
  return cases;
}

}  // namespace plumbline::checks
