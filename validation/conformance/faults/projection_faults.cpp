#include <cmath>
#include <limits>

#include "prt/sh/zonal.hpp"
#include "validation/conformance/faults/build.hpp"

namespace plumbline::conformance {
namespace {

using C = double*;

double cosine_over_pi(int l) {
  return sh::clamped_cosine_factor(l) / kPi;
}

/// Infinity where a 16-bit float has it.
double half(double value) {
  return std::abs(value) >= 65520.0 ? std::copysign(std::numeric_limits<double>::infinity(), value) : value;
}

double srgb_decoded(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

std::vector<Fault> scale_faults() {
  return {
      {"M13", "pbrt-v2 SHProjectIncidentDirectRadiance", "every projection windowed, lambda 0.005",
       "project lat-long: one bright texel", "windowed", lat_long_then<[](int n, C c) {
         scale_bands(n, c, 3, [](int l) { return 1.0 / (1.0 + 0.005 * l * l * (l + 1.0) * (l + 1.0)); });
       }>()},
      {"M16", "Capsaicin #21", "sum over size^2 texels scaled by 1/size, no solid angle",
       "project lat-long: radiance 1", "grows with the resolution",
       lat_long_by<[](int x, int y, int w, int h, const float* rgb) {
         return TexelSample{truths::lat_long_centre(w, h, x, y), row_weight(w, h, y) * w / 50.0,
                            pixel(rgb, w, x, y)};
       }>()},
      {"M18", "ands/spherical_harmonics_playground #2", "32/N instead of 4 pi over the sum of weights",
       "project lat-long: radiance 1", "times too large",
       lat_long_then<[](int n, C c) { scale_bands(n, c, 3, [](int) { return 32.0 / (4.0 * kPi); }); }>()},
      {"RA1", "means over directions", "sum divided by N without 4 pi", "project lat-long: radiance 1",
       "number of samples without 4 pi",
       lat_long_then<[](int n, C c) { scale_bands(n, c, 3, [](int) { return 1.0 / (4.0 * kPi); }); }>()},
      {"RA2", "Godot probe buffer", "radiance / pi where radiance is declared",
       "project lat-long: radiance 1", "1/pi applied twice",
       lat_long_then<[](int n, C c) { scale_bands(n, c, 3, [](int) { return 1.0 / kPi; }); }>()},
      {"RA3", "Babylon's reading of EXT_lights_image_based",
       "coefficients of irradiance where radiance is declared", "project lat-long: one bright texel",
       "coefficients are those of irradiance:", lat_long_then<[](int n, C c) {
         scale_bands(n, c, 3, [](int l) { return sh::clamped_cosine_factor(l); });
       }>()},
      {"RA4", "flutter_scene, Unity, Filament", "coefficients of irradiance / pi where radiance is declared",
       "project lat-long: one bright texel", "coefficients are those of irradiance / pi",
       lat_long_then<[](int n, C c) { scale_bands(n, c, 3, cosine_over_pi); }>()},
      {"RA5", "SHTOOLS default", "4 pi norm where orthonormal is declared", "project lat-long: radiance 1",
       "4 pi norm", lat_long_then<[](int n, C c) {
         scale_bands(n, c, 3, [](int) { return 1.0 / std::sqrt(4.0 * kPi); });
       }>()},
      {"RA6", "DirectXMath's arrays read as rows", "planar layout where interleaved is declared",
       "project lat-long: polynomial sky", "", lat_long_then<[](int n, C c) {
         std::vector<double> planar(3 * count_of(n));
         for (std::size_t i = 0; i < count_of(n); ++i)
           for (std::size_t k = 0; k < 3; ++k) planar[k * count_of(n) + i] = c[3 * i + k];
         std::copy(planar.begin(), planar.end(), c);
       }>()},
      {"T10", "written twice", "sqrt(4 pi/(2l + 1)) applied once too often",
       "project lat-long: one bright texel", "sqrt(4 pi/(2l + 1)) is applied once too often",
       lat_long_then<[](int n, C c) {
         scale_bands(n, c, 3, [](int l) { return std::sqrt(4.0 * kPi / (2.0 * l + 1.0)); });
       }>()},
  };
}

std::vector<Fault> lat_long_faults() {
  return {
      {"M19d", "lovr PR 644", "odd bands negated: alternating signs", "project lat-long: one bright texel",
       "odd bands are negated", lat_long_then<[](int n, C c) {
         scale_bands(n, c, 3, [](int l) { return l % 2 == 0 ? 1.0 : -1.0; });
       }>()},
      {"M20", "three.js against Sloan's signs", "no Condon-Shortley phase where it is declared",
       "project lat-long: one bright texel", "Condon-Shortley phase", lat_long_then<[](int n, C c) {
         for (int l = 1; l < n; ++l)
           for (int m = -l; m <= l; ++m)
             for (std::size_t k = 0; k < 3 && m % 2 != 0; ++k) c[3 * at(l, m) + k] *= -1.0;
       }>()},
      {"M23", "WickedEngine PR 1667", "16-bit accumulators: infinite under a bright sun",
       "project lat-long: suns", "not finite", lat_long_then<[](int n, C c) {
         for (std::size_t i = 0; i < 3 * count_of(n); ++i) c[i] = half(c[i]);
       }>()},
      {"T20a", "Filament #3591, three-gpu-pathtracer #813", "sin theta missing in the texels' weights",
       "project lat-long: radiance 1", "too large",
       lat_long_by<[](int x, int y, int w, int h, const float* rgb) {
         return TexelSample{truths::lat_long_centre(w, h, x, y), 2.0 * kPi / w * kPi / h,
                            pixel(rgb, w, x, y)};
       }>()},
      {"T20b", "goliath #12", "sin theta applied twice", "project lat-long: radiance 1",
       "4/pi times too small", lat_long_by<[](int x, int y, int w, int h, const float* rgb) {
         const double sine = std::sin(kPi * (y + 0.5) / h);
         return TexelSample{truths::lat_long_centre(w, h, x, y), row_weight(w, h, y) * sine,
                            pixel(rgb, w, x, y)};
       }>()},
      {"T21", "OpenImageIO #588", "weights wrong at some sizes (odd heights)", "project lat-long: radiance 1",
       "some sizes only", lat_long_by<[](int x, int y, int w, int h, const float* rgb) {
         TexelSample sample = right_sample(x, y, w, h, rgb);
         if (h % 2 == 1 && y == h / 2) sample.weight *= 0.5;
         return sample;
       }>()},
      {"T22a", "pbrt-v3 #62", "directions off by half a texel", "project lat-long: one bright texel",
       "off by half a texel", lat_long_by<[](int x, int y, int w, int h, const float* rgb) {
         TexelSample sample = right_sample(x, y, w, h, rgb);
         sample.direction = truths::lat_long_centre(w, h, x - 0.5, y);
         return sample;
       }>()},
      {"T22b", "mitsuba2 #173", "the last column repeats the one before it",
       "project lat-long: one bright texel", "only at",
       lat_long_by<[](int x, int y, int w, int h, const float* rgb) {
         TexelSample sample = right_sample(x, y, w, h, rgb);
         sample.radiance = pixel(rgb, w, x == w - 1 ? std::max(0, w - 2) : x, y);
         return sample;
       }>()},
      {"T23b", "Filament PR 2103", "Y flipped against the skybox", "project lat-long: one bright texel",
       "mirrored", lat_long_by<[](int x, int y, int w, int h, const float* rgb) {
         TexelSample sample = right_sample(x, y, w, h, rgb);
         sample.direction.y = -sample.direction.y;
         return sample;
       }>()},
      {"T23c", "cmgen without --no-mirror", "X mirrored", "project lat-long: one bright texel", "mirrored",
       lat_long_by<[](int x, int y, int w, int h, const float* rgb) {
         TexelSample sample = right_sample(x, y, w, h, rgb);
         sample.direction.x = -sample.direction.x;
         return sample;
       }>()},
      {"YUP", "y-up data in z-up formulas after a swap of axes", "y and z exchanged",
       "project lat-long: one bright texel", "axes are swapped",
       lat_long_by<[](int x, int y, int w, int h, const float* rgb) {
         TexelSample sample = right_sample(x, y, w, h, rgb);
         std::swap(sample.direction.y, sample.direction.z);
         return sample;
       }>()},
      {"T25", "spharpy #125", "quadrature weights do not add up to 4 pi", "project lat-long: radiance 1",
       "do not add up to 4 pi", lat_long_by<[](int x, int y, int w, int h, const float* rgb) {
         TexelSample sample = right_sample(x, y, w, h, rgb);
         sample.weight = 2.0 * kPi / w * kPi / h * std::sin(kPi * (y + 0.5) / h);
         return sample;
       }>()},
      {"T26", "GAMES202 template", "linear input decoded with the sRGB curve",
       "project lat-long: linear in the radiance", "sRGB curve",
       lat_long_by<[](int x, int y, int w, int h, const float* rgb) {
         TexelSample sample = right_sample(x, y, w, h, rgb);
         for (glm::length_t k = 0; k < 3; ++k)
           sample.radiance[k] = static_cast<float>(srgb_decoded(static_cast<double>(sample.radiance[k])));
         return sample;
       }>()},
      {"SKIP", "robust loaders", "non-finite texels dropped silently", "project lat-long: non-finite texels",
       "a finite answer", lat_long_by<[](int x, int y, int w, int h, const float* rgb) {
         TexelSample sample = right_sample(x, y, w, h, rgb);
         if (!is_finite(sample.radiance)) sample.radiance = Rgb(0.0F);
         return sample;
       }>()},
      {"L7", "gentle introduction, LightProbeAccess", "no clamp: reads past the last row and column",
       "lookup lat-long: every texel", "outside of the image",
       ours_with(
           &plumbline_implementation::lookup_lat_long,
           +[](std::int32_t width, std::int32_t height, const float* rgb, const double* d, double* radiance) {
             const double u = 0.5 + std::atan2(d[2], d[0]) / (2.0 * kPi);
             const auto x = static_cast<int>(u * width);
             const auto y = static_cast<int>(std::acos(d[1]) / kPi * height);
             const Rgb value = pixel(rgb, width, x, y);
             for (glm::length_t k = 0; k < 3; ++k) radiance[k] = static_cast<double>(value[k]);
             return 0;
           })},
  };
}

std::vector<Fault> cube_faults() {
  return {
      {"M19a", "lovr PR 644", "the sign of X on the X faces", "project cube: six faces", "mirrored",
       cube_by<[](int face, int x, int y, int size, const float* rgb) {
         TexelSample sample = right_cube_sample(face, x, y, size, rgb);
         if (face < 2) sample.direction.x = -sample.direction.x;
         return sample;
       }>()},
      {"M19b", "lovr PR 644", "V flipped on every face", "project cube: one bright texel", "",
       cube_by<[](int face, int x, int y, int size, const float* rgb) {
         TexelSample sample = right_cube_sample(face, x, y, size, rgb);
         sample.direction = right_cube_sample(face, x, size - 1 - y, size, rgb).direction;
         return sample;
       }>()},
      {"M19c", "lovr PR 644", "missing half texel", "project cube: one bright texel", "off by half a texel",
       cube_by<[](int face, int x, int y, int size, const float* rgb) {
         TexelSample sample = right_cube_sample(face, x, y, size, rgb);
         sample.direction = truths::cube_direction(face, 2.0 * x / size - 1.0, 2.0 * y / size - 1.0);
         return sample;
       }>()},
      {"T19", "Babylon PR 11884", "texel weight (1 + u^2 + v^2)^-1.5 instead of the solid angle",
       "project cube: radiance 1", "instead of its solid angle",
       cube_by<[](int face, int x, int y, int size, const float* rgb) {
         TexelSample sample = right_cube_sample(face, x, y, size, rgb);
         const double s = (2.0 * x + 1.0) / size - 1.0;
         const double t = (2.0 * y + 1.0) / size - 1.0;
         sample.weight = 4.0 / (static_cast<double>(size) * size) * std::pow(1.0 + s * s + t * t, -1.5);
         return sample;
       }>()},
      {"T23a", "QtMeshEditor PR 779", "negative faces mirrored: divided by the signed axis",
       "project cube: one bright texel", "", cube_by<[](int face, int x, int y, int size, const float* rgb) {
         TexelSample sample = right_cube_sample(face, x, y, size, rgb);
         if (face % 2 == 1) sample.direction = right_cube_sample(face, size - 1 - x, y, size, rgb).direction;
         return sample;
       }>()},
      {"T18", "Capsaicin #21", "1/size for 1/size^2 in the sum", "project cube: radiance 1",
       "grows with the resolution", cube_by<[](int face, int x, int y, int size, const float* rgb) {
         TexelSample sample = right_cube_sample(face, x, y, size, rgb);
         sample.weight *= size / 12.0;
         return sample;
       }>()},
  };
}

}  // namespace

std::vector<Fault> projection_faults() {
  std::vector<Fault> all = scale_faults();
  for (const auto part : {lat_long_faults, cube_faults}) {
    const std::vector<Fault> more = part();
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

}  // namespace plumbline::conformance
