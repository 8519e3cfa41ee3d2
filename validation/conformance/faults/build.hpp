// validation/conformance/faults/build.hpp: our implementation with something done to one function.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "prt/sh/basis.hpp"
#include "prt/sh/texels.hpp"
#include "validation/conformance/adapters/plumbline_sh.hpp"
#include "validation/conformance/faults/catalogue.hpp"
#include "validation/conformance/truths.hpp"

namespace plumbline::conformance {

inline std::size_t count_of(std::int32_t bands) {
  return static_cast<std::size_t>(bands) * static_cast<std::size_t>(bands);
}
inline Vec3d vector_of(const double* d) {
  return {d[0], d[1], d[2]};
}
inline std::size_t at(int l, int m) {
  return static_cast<std::size_t>(l * (l + 1) + m);
}

/// Ours with `member` replaced.
template <class Member, class Function>
plumbline_implementation ours_with(Member plumbline_implementation::*member, Function function) {
  plumbline_implementation result = plumbline_sh();
  result.name = "ours with one function replaced";
  result.*member = function;
  return result;
}

/// kChange(bands, y, direction) after our basis.
template <auto kChange>
plumbline_implementation basis_then() {
  return ours_with(
      &plumbline_implementation::evaluate_basis,
      +[](std::int32_t bands, std::size_t count, const double* directions, double* values) {
        const int status = plumbline_sh().evaluate_basis(bands, count, directions, values);
        for (std::size_t k = 0; k < count; ++k)
          kChange(bands, values + k * count_of(bands), vector_of(directions + 3 * k));
        return status;
      });
}

/// kChange(bands, c) after our projection of lat-long images; c is n^2 rows of rgb.
template <auto kChange>
plumbline_implementation lat_long_then() {
  return ours_with(
      &plumbline_implementation::project_lat_long,
      +[](std::int32_t bands, std::int32_t width, std::int32_t height, const float* rgb, double* c) {
        const int status = plumbline_sh().project_lat_long(bands, width, height, rgb, c);
        kChange(bands, c);
        return status;
      });
}

/// kChange(bands, out) after one of ours that takes (bands, const double*, double* out).
template <auto kMember, auto kChange>
plumbline_implementation unary_then() {
  return ours_with(
      kMember, +[](std::int32_t bands, const double* in, double* out) {
        const int status = (plumbline_sh().*kMember)(bands, in, out);
        kChange(bands, out);
        return status;
      });
}

/// Multiplies each degree.
template <class Factor>
void scale_bands(std::int32_t bands, double* c, std::size_t channels, const Factor& factor) {
  for (int l = 0; l < bands; ++l)
    for (std::size_t i = channels * count_of(l); i < channels * count_of(l + 1); ++i) c[i] *= factor(l);
}

/// A sample of an image: where it looks, with what weight, and what radiance it takes.
struct TexelSample {
  Vec3d direction;
  double weight;
  Rgb radiance;
};

/// sum over texels of weight radiance y(direction), as kSample(x, y, width, height, rgb) says.
template <auto kSample>
int summed_lat_long(std::int32_t bands, std::int32_t width, std::int32_t height, const float* rgb,
                    double* c) {
  std::fill_n(c, 3 * count_of(bands), 0.0);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const TexelSample sample = kSample(x, y, width, height, rgb);
      if (sample.radiance == Rgb(0.0F) || sample.weight == 0.0) continue;
      const std::vector<double> basis = sh::evaluate_basis(bands, sample.direction);
      for (std::size_t i = 0; i < basis.size(); ++i)
        for (glm::length_t k = 0; k < 3; ++k)
          c[3 * i + static_cast<std::size_t>(k)] +=
              basis[i] * sample.weight * static_cast<double>(sample.radiance[k]);
    }
  }
  return 0;
}
template <auto kSample>
plumbline_implementation lat_long_by() {
  return ours_with(&plumbline_implementation::project_lat_long, &summed_lat_long<kSample>);
}

/// The same over a cube map, kSample(face, x, y, size, rgb).
template <auto kSample>
int summed_cube(std::int32_t bands, std::int32_t size, const float* rgb, double* c) {
  std::fill_n(c, 3 * count_of(bands), 0.0);
  for (int face = 0; face < 6; ++face) {
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x) {
        const TexelSample sample = kSample(face, x, y, size, rgb);
        if (sample.radiance == Rgb(0.0F)) continue;
        const std::vector<double> basis = sh::evaluate_basis(bands, sample.direction);
        for (std::size_t i = 0; i < basis.size(); ++i)
          for (glm::length_t k = 0; k < 3; ++k)
            c[3 * i + static_cast<std::size_t>(k)] +=
                basis[i] * sample.weight * static_cast<double>(sample.radiance[k]);
      }
    }
  }
  return 0;
}
template <auto kSample>
plumbline_implementation cube_by() {
  return ours_with(&plumbline_implementation::project_cube, &summed_cube<kSample>);
}

inline Rgb pixel(const float* rgb, int width, int x, int y) {
  const float* p = rgb + 3 * (static_cast<std::ptrdiff_t>(y) * width + x);
  return {p[0], p[1], p[2]};
}
/// Exact solid angle of a texel in row y.
inline double row_weight(int width, int height, int y) {
  return 2.0 * kPi / width * (std::cos(kPi * y / height) - std::cos(kPi * (y + 1) / height));
}
/// What a right implementation takes.
inline TexelSample right_sample(int x, int y, int width, int height, const float* rgb) {
  return {truths::lat_long_centre(width, height, x, y), row_weight(width, height, y),
          pixel(rgb, width, x, y)};
}
inline TexelSample right_cube_sample(int face, int x, int y, int size, const float* rgb) {
  const double s = (2.0 * x + 1.0) / size - 1.0;
  const double t = (2.0 * y + 1.0) / size - 1.0;
  return {truths::cube_direction(face, s, t), sh::cube_texel_solid_angle(size, x, y),
          pixel(rgb, size, x, face * size + y)};
}

}  // namespace plumbline::conformance
