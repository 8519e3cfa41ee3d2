#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prt/sh/basis.hpp"
#include "prt/transfer/bake.hpp"
#include "reference/scene/builtin.hpp"
#include "reference/trace/surface_point.hpp"
#include "validation/checks/suite.hpp"
#include "validation/checks/verdicts.hpp"
#include "validation/truth/irradiance.hpp"
#include "validation/truth/multibounce.hpp"

namespace plumbline::checks {
namespace {

constexpr double kShiftDegrees = 15.0;  // the bake's standard errors come from 16 sets of directions
// The bake evaluates up to 6 bands in float, to 7e-7 (prt/sh/batch.hpp), along directions rounded to float.
constexpr double kFloatBasis = 1e-6;

/// Largest |T - truth| beyond `allowance`, in standard errors.
double largest_z(const transfer::PointTransfer& point, const std::vector<double>& truth, double allowance) {
  double worst = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double excess = std::max(0.0, std::abs(point.coefficients[i] - truth[i]) - allowance);
    const double z = excess / std::max(point.standard_errors[i], 1e-7);
    worst = z <= worst ? worst : z;
  }
  return worst;
}

Finding convex_finding(const Suite& suite) {
  const scene::Scene scene = scene::make_builtin_scene("convex");
  const trace::RayCaster caster(scene);
  const std::vector<trace::SurfacePoint> points = trace::vertex_points(scene);
  constexpr int kBands = 5;
  double worst = 0.0;
  for (std::size_t v = 0; v < points.size(); ++v) {
    const transfer::PointTransfer traced = transfer::shadowed_transfer(
        caster, points[v], kBands, suite.budget.bake_samples * 4, suite.budget.seed, v);
    worst = std::max(worst, largest_z(traced, transfer::unshadowed_transfer(kBands, points[v].shading_normal),
                                      kFloatBasis));
  }
  return judge_largest_z(
      {"transfer", "convex body / shadowed = unshadowed", "T_lm = A_l y_lm(n) / pi (Funk-Hecke)",
       "Nothing blocks on a convex body: the traced vectors must be the closed form."},
      worst, points.size() * kBands * kBands, kShiftDegrees, suite.budget.significance);
}

Finding corner_finding(const Suite& suite) {
  // Quads 2000 x 1000 seen from 1 away: the view factor errs by less than 1/pi + 1/4 over 1000 (finite_corner_form_factor).
  const scene::Scene scene = scene::make_builtin_scene("corner");
  const trace::RayCaster caster(scene);
  const auto at = trace::free_point({0, 0, 1}, {0, 1, 0});
  const transfer::PointTransfer traced =
      transfer::shadowed_transfer(caster, at, 3, suite.budget.bake_samples * 64, suite.budget.seed, 1);
  const truth::ThreeBands truth = truth::corner_direct_transfer({0, 1, 0}, {0, 0, 1});
  return judge_largest_z(
      {"transfer", "infinite corner / direct", "Closed-form transfer vector of a dihedral corner",
       "Nine coefficients at a point of the floor beside a wall; allowance 0.0006 for the quads' finite "
       "size."},
      largest_z(traced, {truth.begin(), truth.end()}, 6e-4), truth.size(), kShiftDegrees,
      suite.budget.significance);
}

Finding sphere_finding(const Suite& suite) {
  const scene::Scene scene = scene::make_builtin_scene("sphere-on-plane");
  const trace::RayCaster caster(scene);
  double worst = 0.0;
  constexpr int kPoints = 24;
  for (int i = 0; i < kPoints; ++i) {
    const double x = 0.3 + 0.1 * i;
    const auto at = trace::free_point(Vec3(Vec3d(x, 0.0, 0.0)), {0, 1, 0});
    const transfer::PointTransfer traced = transfer::shadowed_transfer(
        caster, at, 1, suite.budget.bake_samples * 4, suite.budget.seed, static_cast<std::uint64_t>(i));
    const double view = traced.coefficients[0] * std::sqrt(4.0 * kPi);
    const double error = std::max(traced.standard_errors[0] * std::sqrt(4.0 * kPi), 1e-7);
    // Facets of the level-5 icosphere lie up to 3e-4 inside the sphere: twice that of the covered part.
    const double excess = std::max(0.0, std::abs(view - truth::sphere_sky_view(1.0, 1.0, x)) - 6e-4);
    worst = std::max(worst, excess / error);
  }
  return judge_largest_z(
      {"transfer", "sphere on a plane / sky view", "1 - h R^2 / (h^2 + x^2)^(3/2)",
       "The first coefficient is the share of the sky that is seen: contact shadow of a sphere."},
      worst, kPoints, kShiftDegrees, suite.budget.significance);
}

}  // namespace

void check_transfer(const Suite& suite, report::Report& report) {
  if (suite.announce) suite.announce("transfer against closed forms");
  for (const auto& check : {convex_finding, corner_finding, sphere_finding}) {
    Finding finding = check(suite);
    finding.seed = suite.budget.seed;
    report.findings.push_back(finding);
  }
}

}  // namespace plumbline::checks
