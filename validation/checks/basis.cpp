#include <fmt/format.h>

#include <algorithm>

#include "prt/sh/basis.hpp"
#include "prt/sh/lighting.hpp"
#include "prt/sh/zonal.hpp"
#include "validation/checks/sh_checks.hpp"
#include "validation/checks/suite.hpp"
#include "validation/checks/verdicts.hpp"

namespace plumbline::checks {
namespace {

constexpr int kManyBands = 20;

BasisUnderTest our_basis(int bands) {
  return [bands](const Vec3d& direction) { return sh::evaluate_basis(bands, direction); };
}

std::vector<RgbD> our_projection(const light::Environment& environment, int bands) {
  return sh::project_radiance(environment, bands).coefficients;
}

}  // namespace

void check_basis(const Suite& suite, report::Report& report) {
  std::vector<int> counts = suite.bands;
  counts.push_back(kManyBands);
  std::sort(counts.begin(), counts.end());
  counts.erase(std::unique(counts.begin(), counts.end()), counts.end());
  for (const int bands : counts) {
    const std::string n = fmt::format("{} bands", bands);
    report.findings.push_back(
        judge_error({"basis", n + " / Gram matrix", "Rounding of an n^2-term sum, n <= 20: 1e-12",
                     "Largest |G - I|. Sees wrong constants and polynomials."},
                    gram_deviation(our_basis(bands), bands).value, 1e-12));
    report.findings.push_back(
        judge_error({"basis", n + " / values and signs", "Definition in long double; rounding",
                     "Largest difference to the associated Legendre definition. Sees signs and order."},
                    basis_deviation(our_basis(bands), bands).value, 1e-12));
    report.findings.push_back(
        judge_error({"basis", n + " / addition theorem", "Sum over m of y y' = (2l + 1) / 4 pi P_l",
                     "Holds for every pair of directions, poles too."},
                    addition_theorem_deviation(our_basis(bands), bands), 1e-12));
  }
  report.findings.push_back(judge_error({"basis", "clamped cosine factors", "A_l = 2 pi integral z P_l(z) dz",
                                         "From radiance to irradiance coefficients."},
                                        clamped_cosine_factor_error(sh::clamped_cosine_factor, kManyBands),
                                        1e-12));
  report.findings.push_back(
      judge_error({"basis", "cube map with six colours", "Closed form to l = 2",
                   "Sees swapped or mirrored axes. Bound: Gauss nodes in one-texel faces."},
                  cube_face_projection_error(our_projection), 1e-6));
  report.findings.push_back(judge_error(
      {"basis", "polynomial skies", "Irradiance of degree-2 skies in closed form",
       "Projection, factors and evaluation together. Bound: float radiance."},
      polynomial_irradiance_error(our_projection, our_basis(3), sh::clamped_cosine_factor), 1e-6));
}

}  // namespace plumbline::checks
