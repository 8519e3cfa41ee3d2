// Corners and bowls: M9, M10, M12, M16 of the closed forms.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "validation/checks/truths_estimators.hpp"
#include "validation/checks/truths_scenes.hpp"
#include "validation/truth/multibounce.hpp"

namespace plumbline::checks {
namespace {

const Vec3d kUp(0.0, 1.0, 0.0);
const Vec3d kFloorPoint(kNear, 0.0, 0.0);
constexpr double kDegree = kPi / 180.0;

TruthCase corner_case(std::string name, std::string formula, double truth,
                      std::function<Estimator()> prepare) {
  TruthCase one = named(std::move(name), std::move(formula), truth, std::move(prepare));
  one.model_error = 2.0 * kEndOfPlane;
  return one;
}

// ---------------------------------------------------------------- M9, M10
void add_dihedral_cases(std::vector<TruthCase>& cases) {
  for (const int degrees : {60, 90, 120}) {
    const double opening = degrees * kDegree;
    cases.push_back(corner_case(
        fmt::format("M09_Dihedral{}", degrees), "E = pi (1 - F)/(1 - rho F), F = (1 + cos phi)/2",
        truth::dihedral_irradiances(opening, 0.8, 0.8, 1.0).first, [opening] {
          return irradiance_at(make_world(dihedral(opening, 0.8, 0.8), constant_sky(1.0)), kFloorPoint, kUp);
        }));
  }
  const truth::Pair two = truth::dihedral_irradiances(kPi / 2.0, 0.5, 0.8, 1.0);
  const char* const formula = "E1 = pi (1 - F) (1 + F rho2)/(1 - F^2 rho1 rho2)";
  const auto at = [](const Vec3d& point, const Vec3d& normal) {
    return [point, normal] {
      return irradiance_at(make_world(dihedral(kPi / 2.0, 0.5, 0.8), constant_sky(1.0)), point, normal);
    };
  };
  cases.push_back(corner_case("M10_FloorOfTwoAlbedos", formula, two.first, at(kFloorPoint, kUp)));
  cases.push_back(
      corner_case("M10_WallOfTwoAlbedos", formula, two.second, at({0.0, kNear, 0.0}, {1.0, 0.0, 0.0})));
}

// ---------------------------------------------------------------- M12: one light a coefficient
/// The real spherical harmonics of three bands (CONVENTIONS.md), written out: nothing of prt/ is in this judgement.
double harmonic(std::size_t i, const Vec3d& w) {
  static const double c1 = std::sqrt(3.0 / (4.0 * kPi));
  static const double c2 = std::sqrt(15.0 / (4.0 * kPi));
  switch (i) {
    case 0:
      return std::sqrt(1.0 / (4.0 * kPi));
    case 1:
      return -c1 * w.y;
    case 2:
      return c1 * w.z;
    case 3:
      return -c1 * w.x;
    case 4:
      return c2 * w.x * w.y;
    case 5:
      return -c2 * w.y * w.z;
    case 6:
      return std::sqrt(5.0 / (16.0 * kPi)) * (3.0 * w.z * w.z - 1.0);
    case 7:
      return -c2 * w.x * w.z;
    default:
      return c2 / 2.0 * (w.x * w.x - w.y * w.y);
  }
}

// The corner stands askew to the polar axis +z of the harmonics, so that no coefficient vanishes: floor normal n,
// wall normal m, both general. Its scene is the usual one; the light is turned instead.
void add_transfer_cases(std::vector<TruthCase>& cases) {
  const Vec3d floor = glm::normalize(Vec3d(2.0, 3.0, 6.0));
  const Vec3d wall = glm::normalize(Vec3d(3.0, -6.0, 2.0));
  const Vec3d edge = glm::cross(wall, floor);
  const truth::ThreeBands transfer = truth::corner_transfer(floor, wall, 0.8, 0.8);
  // Relative to the largest coefficient: a small one is the difference of large parts, and counts as little in any image.
  double largest = 0.0;
  for (const double value : transfer) largest = std::max(largest, kPi * std::abs(value));
  for (std::size_t i = 0; i < transfer.size(); ++i) {
    // T counts exit radiance of albedo 1: E = pi T under the light y_i.
    cases.push_back(
        corner_case(fmt::format("M12_CornerTransfer{}", i),
                    "T = (D1 + F rho D2)/(1 - F^2 rho^2), light y_i alone", kPi * transfer[i], [=] {
                      const auto sky = [=](const Vec3d& w) {  // scene: floor +Y, wall +X, edge +Z
                        return harmonic(i, w.y * floor + w.x * wall + w.z * edge);
                      };
                      return irradiance_at(make_world(dihedral(kPi / 2.0, 0.8, 0.8), analytic_sky(sky)),
                                           kFloorPoint, kUp);
                    }));
    cases.back().scale = largest;
  }
}

// ---------------------------------------------------------------- M16: one bounce at a time
// A path reaches bounce k with probability (rho F)^k or so: the relative spread of term k grows like (rho F)^(-k/2),
// and so does the margin, or the eighth bounce would need 2000 times the paths of the first. Bounces of a closed room,
// which no path leaves, are held to the common margin (M16_Furnace…).
void add_series(std::vector<TruthCase>& cases, const std::string& name, double model_error,
                const std::function<SharedWorld()>& world, const Vec3d& point, const Vec3d& normal) {
  constexpr double kAlbedo = 0.8;
  constexpr double kFactor = 0.5;
  constexpr int kLast = 8;
  const auto add = [&](const std::string& which, const char* formula, double truth, int first, int last) {
    TruthCase one =
        named(name + which, formula, truth, [=] { return bounces_at(world(), point, normal, first, last); });
    one.model_error = model_error;
    one.margin_factor = std::pow(kAlbedo * kFactor, -0.5 * first);
    one.pilot_samples = 1 << 14;
    // Half of the directions from a corner's floor meet its wall: stratified directions meet exactly half.
    one.is_noiseless = name == "M16_Corner" && last == 0;
    cases.push_back(std::move(one));
  };
  for (int k = 0; k <= kLast; ++k)
    add(fmt::format("Bounce{}", k), "E_k = e (rho F)^k", truth::neumann_term(kPi / 2.0, kAlbedo, kFactor, k),
        k, k);
  // Beyond 40 bounces 10^-16 of the light is left.
  add("Remainder", "E_9 + E_10 + ... = e (rho F)^9/(1 - rho F)",
      truth::neumann_remainder(kPi / 2.0, kAlbedo, kFactor, kLast), kLast + 1, 40);
}

}  // namespace

std::vector<TruthCase> interreflection_cases() {
  std::vector<TruthCase> cases;
  add_dihedral_cases(cases);
  add_transfer_cases(cases);
  add_series(
      cases, "M16_Corner", 2.0 * kEndOfPlane,
      [] { return make_world(dihedral(kPi / 2.0, 0.8, 0.8), constant_sky(1.0)); }, kFloorPoint, kUp);
  const Vec3d outward = glm::normalize(Vec3d(1.0, -0.5, 0.3));
  add_series(
      cases, "M16_Bowl", 0.0,
      [] {
        scene::Scene scene;
        add_sphere(scene, Vec3d(0.0), 1.0, Front::inward, add_grey(scene, 0.8), {-kUp, 0.0});
        return make_world(std::move(scene), constant_sky(1.0));
      },
      outward, -outward);
  return cases;
}

}  // namespace plumbline::checks
