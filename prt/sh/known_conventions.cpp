// The conventions of others, as read in their sources (snapshots: a project may have changed since).
#include <fmt/format.h>

#include <algorithm>

#include "prt/sh/convention.hpp"
#include "reference/base/error.hpp"
#include "reference/base/text.hpp"

namespace plumbline::sh {
namespace {

// Where a Convention says nothing else it is ours: l(l+1)+m, Condon-Shortley, orthonormal, radiance, rows of
// r, g, b, the axes of the direction as they are.
Convention positive() {
  Convention c;
  c.sign = Sign::positive;
  return c;
}
Convention with(Convention c, Quantity quantity) {
  c.quantity = quantity;
  return c;
}
Convention with(Convention c, Layout layout) {
  c.layout = layout;
  return c;
}
Convention with(Convention c, Normalization normalization, Role role) {
  c.normalization = normalization;
  c.role = role;
  return c;
}
Convention with(Convention c, const SignedAxes& axes) {
  c.axes = axes;
  return c;
}
Convention with(Convention c, Functions functions) {
  c.functions = functions;
  return c;
}
/// E/pi as 1, y, z, x, xy, … times numbers: A_l/pi, the sign and the functions' constants folded in.
Convention folded() {
  return with(with(positive(), Quantity::irradiance_over_pi), Normalization::polynomial, Role::expansion);
}

constexpr SignedAxes kMirroredX{{0, 1, 2}, {-1, 1, 1}};
/// e3nn calls the usual functions with (z, x, y), so that degree 1 is x, y, z and y is the polar axis.
constexpr SignedAxes kPolarY{{2, 0, 1}, {1, 1, 1}};

using Rows = std::vector<KnownConvention>;

void add_condon_shortley(Rows& rows) {
  rows.push_back({"plumbline", "Plumbline", "CONVENTIONS.md", {}, kMaxBands, "", ""});
  rows.push_back(
      {"directxmath", "DirectXMath, D3DX", "XMSHEvalDirection, D3DXSH*", with({}, Layout::planar), 6,
       "three arrays, one a channel. Its lights are scaled to exit radiance 1: a directional light by "
       "4 pi/3, 16 pi/17 or 32 pi/31 (2, 3 or 4, 5 or 6 bands)",
       ""});
  rows.push_back(
      {"google",
       "google/spherical-harmonics and its forks (GAMES202, Nori), pbrt-v2, shexp-demo, PRT-SH",
       "EvalSH; SHEvaluate",
       {},
       kMaxBands,
       "transfer leaves out 1/pi (pbrt-v2 multiplies by it at the end); pbrt-v2 windows what it projects",
       ""});
  rows.push_back({"cmft",
                  "cmft, Babylon, galacean, Unreal, Capsaicin, HLSL-SH, Flax, PlayCanvas, BakingLab",
                  "evalSHBasis, SHBasisFunction3, SH.cpp",
                  {},
                  kMaxBands,
                  "z is the polar axis of the formula; data with y up is not turned",
                  ""});
  rows.push_back({"3dgs", "3D Gaussian splatting", "sh_utils.py, f_dc_* and f_rest_*",
                  with(with({}, Quantity::radiance_minus_half), Layout::splat), 4,
                  "colour = 1/2 + sum: degree 0 lacks sqrt(pi)", ""});
  rows.push_back(
      {"sloan", "Sloan, \"Stupid Spherical Harmonics (SH) Tricks\"", "appendix A2", {}, kMaxBands, "", ""});
}

void add_positive(Rows& rows) {
  rows.push_back({"threejs", "three.js, SHforHLSL, sh-lib, Falcor, nerfstudio, polarch, sphericart",
                  "SphericalHarmonics3; sh_evaluate", positive(), kMaxBands,
                  "sh-lib arrives there by adding pi to the azimuth", ""});
  rows.push_back({"probulator", "Probulator", "SphericalHarmonics.h", positive(), kMaxBands,
                  "negates x and y, then applies the Condon-Shortley sign", ""});
  rows.push_back({"bakinglab-old", "BakingLab, before its #2", "SH.cpp", positive(), kMaxBands,
                  "since then as cmft", ""});
  rows.push_back({"ramamoorthi", "the shader with 0.429043, 0.511664, 0.743125, 0.886227, 0.247708",
                  "Ramamoorthi & Hanrahan 2001; GLSL samples, three.js, old Godot", positive(), 3,
                  "radiance goes in; the shader gives E, not E/pi", ""});
  rows.push_back({"godot-probe", "Godot", "probe buffer",
                  with(with(positive(), Quantity::radiance_over_pi), Layout::rgba), 3,
                  "the shader applies A_l and the constants", ""});
  rows.push_back({"flutter", "flutter_scene", "at run time", with(positive(), Quantity::irradiance_over_pi),
                  3, "radiance times 1, 2/3, 1/4; the constants stay in the shader", ""});
}

void add_other_normalizations(Rows& rows) {
  const Convention shtools = with(positive(), Layout::cosine_sine);
  rows.push_back({"shtools", "SHTOOLS", "default: norm 4pi, csphase 1",
                  with(shtools, Normalization::four_pi, Role::expansion), kMaxBands,
                  "coefficients are means over the sphere, 1/(4 pi) times the integral", ""});
  rows.push_back({"shtools-ortho", "SHTOOLS", "norm ortho", shtools, kMaxBands, "", ""});
  rows.push_back({"shtools-schmidt", "SHTOOLS", "norm schmidt",
                  with(shtools, Normalization::schmidt, Role::expansion), kMaxBands, "", ""});
  rows.push_back({"shtools-unnorm", "SHTOOLS", "norm unnorm",
                  with(shtools, Normalization::unnormalized, Role::expansion), 80, "", ""});
  rows.push_back({"geodesy", "geodesy", "4 pi normalisation",
                  with(positive(), Normalization::four_pi, Role::expansion), kMaxBands, "", ""});
  rows.push_back({"n3d", "Ambisonics", "ACN, N3D", with(positive(), Normalization::four_pi, Role::projection),
                  kMaxBands, "a plane wave is encoded as its amplitude times B(direction)", ""});
  rows.push_back({"sn3d", "Ambisonics", "ACN, SN3D (AmbiX)",
                  with(positive(), Normalization::schmidt, Role::projection), kMaxBands, "N3D/sqrt(2l + 1)",
                  ""});
  const Convention e3nn = with(positive(), kPolarY);
  rows.push_back({"e3nn-component", "e3nn", "spherical_harmonics, normalization component",
                  with(e3nn, Normalization::four_pi, Role::projection), 12, "degree 1 is x, y, z", ""});
  rows.push_back({"e3nn-norm", "e3nn", "normalization norm",
                  with(e3nn, Normalization::schmidt, Role::projection), 12, "degree 1 is x, y, z", ""});
  rows.push_back({"e3nn-integral", "e3nn", "normalization integral", e3nn, 12, "degree 1 is x, y, z", ""});
}

void add_shader_polynomials(Rows& rows) {
  rows.push_back(
      {"unity", "Unity", "SphericalHarmonicsL2", with(folded(), Layout::planar), 3,
       "[rgb, 9]. In Unity's world, which is left-handed with y up; a uniform radiance of 1 gives 1", ""});
  rows.push_back({"unity-shader", "Unity, Unreal (sky irradiance), Sloan's packing", "SHAr ... SHC",
                  with(folded(), Layout::packed), 3, "", ""});
  rows.push_back({"unity-shader-old", "Unity, an older form", "SHAr ... SHC",
                  with(folded(), Layout::packed_square), 3, "the shader makes 3z^2-1 itself, SHA.w stays c0",
                  ""});
  rows.push_back({"filament-shader", "Filament, Cesium (cmgen)", "cmgen --sh-shader, irradiance()",
                  with(folded(), kMirroredX), 3,
                  "cmgen mirrors x unless --no-mirror; builds before pull request 1397 lack or double 1/pi",
                  ""});
  rows.push_back({"filament-shader-no-mirror", "Filament; lovr (the same polynomial, its pi not checked)",
                  "cmgen --sh-shader --no-mirror; lovr.glsl", folded(), 3, "", ""});
  rows.push_back({"filament-irradiance", "Filament", "cmgen --sh -i",
                  with(with({}, Quantity::irradiance), kMirroredX), kMaxBands,
                  "cmgen mirrors x unless --no-mirror", ""});
  rows.push_back({"filament-irradiance-no-mirror", "Filament", "cmgen --sh -i --no-mirror",
                  with({}, Quantity::irradiance), kMaxBands, "", ""});
}

/// Formats that do not say all: one row a reading that is consistent with what they say.
void add_open_formats(Rows& rows) {
  rows.push_back({"ext-ibl-babylon", "EXT_lights_image_based as Babylon reads it", "irradianceCoefficients",
                  with({}, Quantity::irradiance), 3, "y up (glTF)", "sign, normalisation, axes, quantity"});
  rows.push_back({"ext-ibl-flutter", "EXT_lights_image_based as flutter_scene reads it",
                  "irradianceCoefficients", positive(), 3, "y up (glTF)",
                  "sign, normalisation, axes, quantity"});
  const auto add_readings = [&rows](const std::string& name, const std::string& project,
                                    const std::string& where, Layout layout, bool is_radiance_stated) {
    for (const Sign sign : {Sign::positive, Sign::condon_shortley}) {
      Convention c = with({}, layout);
      c.sign = sign;
      const std::string suffix = sign == Sign::positive ? "" : "-cs";
      const std::string open = is_radiance_stated ? "sign" : "sign, quantity";
      rows.push_back({name + "-radiance" + suffix, project, where, c, 3, "", open});
      if (is_radiance_stated) continue;
      rows.push_back(
          {name + "-irradiance" + suffix, project, where, with(c, Quantity::irradiance), 3, "", open});
    }
  };
  add_readings("webxr", "WebXR lighting estimation", "sphericalHarmonicsCoefficients", Layout::interleaved,
               false);
  add_readings("openxr-android", "OpenXR, XR_ANDROID_light_estimation", "\"radiance function\"",
               Layout::interleaved, true);
  add_readings("arkit", "ARKit", "sphericalHarmonicsCoefficients", Layout::planar, false);
}

void add_half_functions(Rows& rows) {
  rows.push_back({"bakinglab-h4", "BakingLab", "ProjectOntoH4", with({}, Functions::h_basis_4), kMaxBands,
                  "z is the surface normal", ""});
  rows.push_back({"habel-h6", "Habel & Wimmer 2010", "\"Efficient irradiance normal mapping\"",
                  with(positive(), Functions::h_basis_6), kMaxBands, "z is the surface normal", "sign"});
  rows.push_back({"probulator-h4", "Probulator", "HBasis.h", with(positive(), Functions::h_basis_4_half_dc),
                  kMaxBands, "z is the surface normal; the first function has half the power it should", ""});
  rows.push_back({"godot-lightmap", "Godot", "SH light map, lm_compute.glsl",
                  with(positive(), Functions::cosine_lightmap), kMaxBands,
                  "z is the surface normal; a white sky decodes to 0.917, not 1", ""});
}

Rows all_rows() {
  Rows rows;
  add_condon_shortley(rows);
  add_positive(rows);
  add_other_normalizations(rows);
  add_shader_polynomials(rows);
  add_open_formats(rows);
  add_half_functions(rows);
  return rows;
}

}  // namespace

const std::vector<KnownConvention>& known_conventions() {
  static const Rows rows = all_rows();
  return rows;
}

const KnownConvention& known_convention(const std::string& name) {
  const Rows& rows = known_conventions();
  const auto found =
      std::find_if(rows.begin(), rows.end(), [&](const KnownConvention& row) { return row.name == name; });
  if (found == rows.end()) {
    throw InputError(fmt::format("unknown convention \"{}\" (see `plumbline conventions`)", one_line(name)));
  }
  return *found;
}

}  // namespace plumbline::sh
