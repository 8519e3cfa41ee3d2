#include <cmath>

#include "prt/sh/zonal.hpp"
#include "validation/conformance/faults/build.hpp"

namespace plumbline::conformance {
namespace {

using I = plumbline_implementation;

/// E(n) = sum of kFactor(l) y_lm(n) c_lm, coefficients first through kSource(i).
template <auto kFactor>
int convolved(std::int32_t n, const double* c, const double* normal, double* result) {
  const std::vector<double> y = sh::evaluate_basis(n, vector_of(normal));
  *result = 0.0;
  for (int l = 0; l < n; ++l)
    for (std::size_t i = count_of(l); i < count_of(l + 1); ++i) *result += kFactor(l) * y[i] * c[i];
  return 0;
}
template <auto kFactor>
plumbline_implementation irradiance_by() {
  return ours_with(&I::irradiance, &convolved<kFactor>);
}
double right_factor(int l) {
  return sh::clamped_cosine_factor(l);
}

/// The L1 reconstruction of Geomerics, fed with c_00 as if it were the mean radiance times 4.
int geomerics(std::int32_t n, const double* c, const double* normal, double* result) {
  const double r0 = c[0];
  if (n < 2) {
    *result = r0;
    return 0;
  }
  const Vec3d r1 = 0.5 * Vec3d(-c[3], -c[1], c[2]);
  const double length = glm::length(r1);
  const double q = 0.5 * (1.0 + glm::dot(r1 / length, vector_of(normal)));
  const double p = 1.0 + 2.0 * length / r0;
  const double a = (1.0 - length / r0) / (1.0 + length / r0);
  *result = r0 * (a + (1.0 - a) * (p + 1.0) * std::pow(q, p));
  return 0;
}
int geomerics_without_nan(std::int32_t n, const double* c, const double* normal, double* result) {
  const int status = geomerics(n, c, normal, result);
  if (std::isnan(*result)) *result = c[0];
  return status;
}

/// kChange(c) before our irradiance.
template <auto kChange>
plumbline_implementation irradiance_of() {
  return ours_with(
      &I::irradiance, +[](std::int32_t n, const double* c, const double* normal, double* result) {
        std::vector<double> changed(c, c + count_of(n));
        kChange(n, changed);
        return plumbline_sh().irradiance(n, changed.data(), normal, result);
      });
}
/// kChange(E) after it.
template <auto kChange>
plumbline_implementation irradiance_then() {
  return ours_with(
      &I::irradiance, +[](std::int32_t n, const double* c, const double* normal, double* result) {
        const int status = plumbline_sh().irradiance(n, c, normal, result);
        *result = kChange(*result);
        return status;
      });
}

void flip_signs(std::vector<double>& c) {
  for (std::size_t i = 0; i < c.size(); ++i) {
    const int l = static_cast<int>(std::sqrt(static_cast<double>(i) + 0.5));
    if ((static_cast<int>(i) - l * (l + 1)) % 2 != 0) c[i] = -c[i];
  }
}

std::vector<Fault> irradiance_faults() {
  using C = std::vector<double>;
  return {
      {"M2", "SHforHLSL, BakingLab EvalSH4IrradianceGeomerics",
       "orthonormal c_00 where the mean radiance is meant", "irradiance: uniform light", "2/sqrt(pi)",
       ours_with(&I::irradiance, geomerics_without_nan)},
      {"M2n", "Probulator shEvaluateDiffuseL1Geomerics", "NaN when band 1 is 0", "irradiance: uniform light",
       "nan", ours_with(&I::irradiance, geomerics)},
      {"M3", "BakingLab before c3868af", "pi missing from one band's factor",
       "irradiance: response to each coefficient", "band 2 is pi times too small",
       irradiance_by<[](int l) { return right_factor(l) / (l == 2 ? kPi : 1.0); }>()},
      {"M5A", "FlaxEngine SH.hlsl", "A_1 = 2.095395 for 2.094395", "irradiance: response to each coefficient",
       "band 1", irradiance_by<[](int l) { return l == 1 ? 2.095395 : right_factor(l); }>()},
      {"M17", "RTXGI-DDGI issues 15 and 60", "a stray 0.5", "irradiance: uniform light", "stray 1/2",
       irradiance_then<[](double e) { return 0.5 * e; }>()},
      {"M20r", "Filament PR 1397", "sign and factors of band 1 wrong",
       "irradiance: response to each coefficient", "band 1",
       irradiance_by<[](int l) { return l == 1 ? -kPi / 3.0 : right_factor(l); }>()},
      {"M24", "three.js issues 26668 and 16271", "pi times too bright", "irradiance: uniform light",
       "pi times too large", irradiance_then<[](double e) { return kPi * e; }>()},
      {"M26a", "Babylon reading EXT_lights_image_based", "the coefficients are taken for irradiance's",
       "irradiance: response to each coefficient", "the clamped cosine's factors",
       irradiance_by<[](int) { return 1.0; }>()},
      {"M26b", "flutter_scene reading EXT_lights_image_based", "x and y flipped: the other sign convention",
       "irradiance: response to each coefficient", "Condon-Shortley phase",
       irradiance_of<[](int, C& c) { flip_signs(c); }>()},
      {"EPI", "Probulator, Filament's names", "E/pi under the name of irradiance",
       "irradiance: uniform light", "1/pi applied twice, or E/pi where E is asked",
       irradiance_then<[](double e) { return e / kPi; }>()},
      {"T9", "Filament PR 1397, before", "factors 1, 2/3, 1/4 with pi and a sign wrong in band 2",
       "irradiance: response to each coefficient", "band 2 is negated",
       irradiance_by<[](int l) { return l == 2 ? -right_factor(l) : right_factor(l); }>()},
      {"T10c", "A_l and c_l confused", "c_l = sqrt((2l + 1)/4 pi) A_l for A_l",
       "irradiance: response to each coefficient", "the zonal coefficient c_l used for the factor A_l",
       irradiance_by<[](int l) { return std::sqrt((2.0 * l + 1.0) / (4.0 * kPi)) * right_factor(l); }>()},
      {"T12", "Godot PR 61910 to 95888", "8 where 2 pi belongs", "irradiance: uniform light",
       "4/pi times too large", irradiance_then<[](double e) { return e * 8.0 / (2.0 * kPi); }>()},
      {"T14", "keijiro/LightProbeUtility #1", "packing of band 2 in another order",
       "irradiance: response to each coefficient", "holds", irradiance_of<[](int n, C& c) {
         if (2 < n) std::swap(c[5], c[6]);
       }>()},
      {"T17", "three.js #26767, the other way", "negative irradiance set to 0",
       "irradiance: a light without extent", "set to 0",
       irradiance_then<[](double e) { return std::max(0.0, e); }>()},
      {"HIDE", "max(0, NaN) is 0", "NaN turned into 0", "irradiance: non-finite input", "a finite answer",
       irradiance_then<[](double e) { return std::isfinite(e) ? e : 0.0; }>()},
      {"FLT", "single precision under a double interface", "squares overflow at 1e30", "irradiance: scales",
       "extreme scales", irradiance_then<[](double e) {
         const auto f = static_cast<float>(e);
         return static_cast<double>(f * f / (f == 0.0F ? 1.0F : f));
       }>()},
  };
}

// ---------------------------------------------------------------- lights
plumbline_implementation facing_one(double factor) {
  plumbline_implementation result = plumbline_sh();
  result.name = "ours with one function replaced";
  result.light_unit = PLUMBLINE_LIGHT_FACING_ONE;
  result.light_cone = nullptr;
  if (factor > 3.0)
    result.light_directional = +[](std::int32_t n, const double* d, double* out) {
      const int status = plumbline_sh().light_directional(n, d, out);
      scale_bands(n, out, 1, [](int) { return 16.0 * kPi / 17.0; });
      return status;
    };
  return result;
}

template <auto kBand0>
int hemisphere_with(std::int32_t n, const double* up, double top, double bottom, double* out) {
  const int status = plumbline_sh().light_hemisphere(n, up, top, bottom, out);
  scale_bands(n, out, 1, kBand0);
  return status;
}

std::vector<Fault> light_faults() {
  return {
      {"M1", "DirectXMath XMSHEvalHemisphereLight", "c_00 half as large again: exit radiance 1.25 for 1",
       "light hemisphere: promised exit radiance", "band 0 is 3/2 times too large",
       ours_with(&I::light_hemisphere, &hemisphere_with<[](int l) { return l == 0 ? 1.5 : 1.0; }>)},
      {"M24h", "three.js #26668, HemisphereLightProbe", "pi times too bright",
       "light hemisphere: promised exit radiance", "pi times too large",
       ours_with(&I::light_hemisphere, &hemisphere_with<[](int) { return kPi; }>)},
      {"S4a", "normalisation of another number of bands", "16 pi/17 for every number of bands",
       "light directional: y_lm(d)", "times what it should be", facing_one(4.0)},
      {"S4b", "unit declared but not applied", "a facing surface has exit radiance 0.34, not 1",
       "light directional: y_lm(d)", "times", facing_one(1.0)},
      {"S5a", "full and half angle", "the cone's full angle for its half angle", "light cone: caps", "",
       ours_with(
           &I::light_cone, +[](std::int32_t n, const double* d, double angle,
                               double* out) { return plumbline_sh().light_cone(n, d, 0.5 * angle, out); })},
      {"S5b", "P_(l-1) - P_(l+1) in single precision", "a small disc cancels to nothing", "light cone: caps",
       "",
       ours_with(
           &I::light_cone,
           +[](std::int32_t n, const double* d, double angle, double* out) {
             std::vector<double> zonal(static_cast<std::size_t>(n));
             const std::vector<double> p = sh::legendre(n + 1, std::cos(angle));
             for (int l = 0; l < n; ++l) {
               const auto i = static_cast<std::size_t>(l);
               const auto before = static_cast<float>(l == 0 ? 1.0 : p[i - 1]);
               const auto after = static_cast<float>(p[i + 1]);
               zonal[i] = std::sqrt(kPi / (2.0 * l + 1.0)) * static_cast<double>(before - after);
             }
             return plumbline_sh().rotate_zonal(n, zonal.data(), d, out);
           })},
      {"D5", "angle from the tangent", "sphere light with tan a = r/d", "light sphere: near and far", "",
       ours_with(
           &I::light_sphere,
           +[](std::int32_t n, const double* centre, double radius, double* out) {
             const double distance = glm::length(vector_of(centre));
             const Vec3d d = vector_of(centre) / distance;
             const double direction[3] = {d.x, d.y, d.z};
             return plumbline_sh().light_cone(n, direction, std::atan2(radius, distance), out);
           })},
      {"DIR", "towards and away", "light directions point the other way", "light directional: y_lm(d)",
       "odd bands are negated",
       ours_with(
           &I::light_directional,
           +[](std::int32_t n, const double* d, double* out) {
             const double away[3] = {-d[0], -d[1], -d[2]};
             return plumbline_sh().light_directional(n, away, out);
           })},
  };
}

// ---------------------------------------------------------------- transfer and relighting
/// (1/pi) integral of y n.w: the cosine not clamped, as the listing has it.
int unclamped(std::int32_t n, const double* normal, double* out) {
  const std::vector<double> y = sh::evaluate_basis(n, vector_of(normal));
  for (int l = 0; l < n; ++l)
    for (std::size_t i = count_of(l); i < count_of(l + 1); ++i) out[i] = l == 1 ? y[i] * 4.0 / 3.0 : 0.0;
  return 0;
}

std::vector<Fault> transfer_faults() {
  return {
      {"L4", "gentle introduction, ProjectUnshadowed",
       "cosine not clamped: band 1 alone, at twice its weight", "transfer unshadowed: clamped cosine",
       "band 0 is missing; band 1 is 2 times too large", ours_with(&I::transfer_unshadowed, unclamped)},
      {"L5", "gentle introduction; EnterprisePBR #13", "albedo without 1/pi",
       "transfer unshadowed: clamped cosine", "1/pi is missing",
       unary_then<&I::transfer_unshadowed,
                  [](int n, double* out) { scale_bands(n, out, 1, [](int) { return kPi; }); }>()},
      {"T33", "ogre-next #190, Scotty3D #20", "divided by pi twice", "transfer unshadowed: clamped cosine",
       "1/pi applied twice",
       unary_then<&I::transfer_unshadowed,
                  [](int n, double* out) { scale_bands(n, out, 1, [](int) { return 1.0 / kPi; }); }>()},
      {"T6b", "BakingLab #2", "light and transfer of different sign conventions",
       "relight: own transfer under own light", "light and transfer use different signs",
       unary_then<&I::transfer_unshadowed,
                  [](int n, double* out) {
                    std::vector<double> c(out, out + count_of(n));
                    flip_signs(c);
                    std::copy(c.begin(), c.end(), out);
                  }>()},
      {"DOT", "a loop that ends early", "the last coefficient is left out of the dot product",
       "relight: transfer . light", "is missing",
       ours_with(
           &I::relight,
           +[](std::int32_t n, const double* transfer, const double* light, double* result) {
             const int status = plumbline_sh().relight(n, transfer, light, result);
             const std::size_t last = count_of(n) - 1;
             *result -= transfer[last] * light[last];
             return status;
           })},
  };
}

}  // namespace

std::vector<Fault> lighting_faults() {
  std::vector<Fault> all = irradiance_faults();
  for (const auto part : {light_faults, transfer_faults}) {
    const std::vector<Fault> more = part();
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

}  // namespace plumbline::conformance
