#include "validation/conformance/adapters/plumbline_sh.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <span>
#include <vector>

#include "prt/sh/basis.hpp"
#include "prt/sh/exponential.hpp"
#include "prt/sh/lighting.hpp"
#include "prt/sh/logarithm.hpp"
#include "prt/sh/product.hpp"
#include "prt/sh/rotation.hpp"
#include "prt/sh/zonal.hpp"
#include "reference/integrate/sampler.hpp"
#include "validation/conformance/border.hpp"
#include "validation/metrics/statistics.hpp"

namespace plumbline::conformance {
namespace {

using Values = std::vector<double>;

constexpr int kAnswered = 0;
constexpr int kRefused = 1;

std::size_t size_of(std::int32_t bands) {
  return static_cast<std::size_t>(bands) * static_cast<std::size_t>(bands);
}

/// Exceptions must not leave a C function.
template <class Work>
int answered(const Work& work) {
  try {
    work();
    return kAnswered;
  } catch (const std::exception&) {
    return kRefused;
  }
}

Values read(const double* values, std::size_t count) {
  return {values, values + count};
}
void write(const Values& values, double* out) {
  std::copy(values.begin(), values.end(), out);
}
Vec3d vector_at(const double* values) {
  return {values[0], values[1], values[2]};
}

int evaluate_basis(std::int32_t bands, std::size_t count, const double* directions, double* values) {
  return answered([&] {
    const sh::Basis<double> basis(bands);
    for (std::size_t k = 0; k < count; ++k) {
      const double* d = directions + 3 * k;
      basis.evaluate(d[0], d[1], d[2], {values + k * size_of(bands), size_of(bands)});
    }
  });
}

// sqrt(2) y_lm with cos theta' = 2 z - 1: z in [0, 1] covers the sphere once, and dz' = 2 dz. sin theta'/sin theta is
// 2 sqrt(z/(1 + z)).
int evaluate_hemisphere_basis(std::int32_t bands, std::size_t count, const double* directions,
                              double* values) {
  return answered([&] {
    const sh::Basis<double> basis(bands);
    for (std::size_t k = 0; k < count; ++k) {
      const double* d = directions + 3 * k;
      const double stretch = 2.0 * std::sqrt(d[2] / (1.0 + d[2]));
      const std::span<double> row(values + k * size_of(bands), size_of(bands));
      basis.evaluate(stretch * d[0], stretch * d[1], 2.0 * d[2] - 1.0, row);
      for (double& v : row) v *= std::sqrt(2.0);
    }
  });
}

image::Image image_of(int width, int height, const float* rgb) {
  image::Image image = image::make_image(width, height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = {rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]};
  return image;
}

int projected(const light::Environment& environment, std::int32_t bands, double* coefficients) {
  return answered([&] {
    const sh::ShRgb result = sh::project_radiance(environment, bands, 1);
    for (std::size_t i = 0; i < result.coefficients.size(); ++i)
      for (glm::length_t c = 0; c < 3; ++c)
        coefficients[3 * i + static_cast<std::size_t>(c)] = result.coefficients[i][c];
  });
}

int project_lat_long(std::int32_t bands, std::int32_t width, std::int32_t height, const float* rgb,
                     double* coefficients) {
  light::Environment environment;
  environment.sky = light::LatLongSky{image_of(width, height, rgb)};
  return projected(environment, bands, coefficients);
}

int project_cube(std::int32_t bands, std::int32_t size, const float* rgb, double* coefficients) {
  light::Environment environment;
  light::CubeMapSky cube;
  for (std::size_t face = 0; face < 6; ++face)
    cube.faces.at(face) = image_of(size, size, rgb + 3 * face * size_of(size));
  environment.sky = cube;
  return projected(environment, bands, coefficients);
}

int lookup_lat_long(std::int32_t width, std::int32_t height, const float* rgb, const double* direction,
                    double* radiance) {
  return answered([&] {
    light::Environment environment;
    environment.sky = light::LatLongSky{image_of(width, height, rgb)};
    const Rgb value = light::radiance(environment, Vec3(vector_at(direction)));
    for (glm::length_t c = 0; c < 3; ++c) radiance[c] = static_cast<double>(value[c]);
  });
}

int rotate(std::int32_t bands, const double* matrix, const double* in, double* out) {
  return answered([&] {
    glm::dmat3 r;
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) r[column][row] = matrix[3 * row + column];
    sh::Rotation(r, bands).apply({in, size_of(bands)}, std::span<double>(out, size_of(bands)));
  });
}

int multiply(std::int32_t bands, const double* a, const double* b, double* out) {
  const std::size_t n = size_of(bands);
  return answered([&] { sh::multiply({a, n}, {b, n}, std::span<double>(out, n)); });
}

int exponential(std::int32_t bands, const double* in, double* out) {
  return answered([&] { write(sh::exponential(read(in, size_of(bands))), out); });
}

int logarithm(std::int32_t bands, const double* in, double* out) {
  return answered([&] { write(sh::logarithm(read(in, size_of(bands))).coefficients, out); });
}

int rotate_zonal(std::int32_t bands, const double* zonal, const double* axis, double* out) {
  return answered(
      [&] { write(sh::rotate_zonal(read(zonal, static_cast<std::size_t>(bands)), vector_at(axis)), out); });
}

/// A_l y_lm(n) over `divisor`.
Values cosine_about(std::int32_t bands, const Vec3d& normal, double divisor) {
  Values result = sh::evaluate_basis(bands, normal);
  for (int l = 0; l < bands; ++l) {
    const double factor = sh::clamped_cosine_factor(l) / divisor;
    for (int m = -l; m <= l; ++m) result[static_cast<std::size_t>(sh::index(l, m))] *= factor;
  }
  return result;
}

int irradiance(std::int32_t bands, const double* coefficients, const double* normal, double* result) {
  return answered([&] {
    const Values kernel = cosine_about(bands, vector_at(normal), 1.0);
    *result = 0.0;
    for (std::size_t i = 0; i < kernel.size(); ++i) *result += kernel[i] * coefficients[i];
  });
}

int light_directional(std::int32_t bands, const double* direction, double* out) {
  return answered([&] { write(sh::evaluate_basis(bands, vector_at(direction)), out); });
}

int light_cone(std::int32_t bands, const double* direction, double half_angle, double* out) {
  return answered([&] { write(sh::rotate_zonal(sh::cap(bands, half_angle), vector_at(direction)), out); });
}

int light_sphere(std::int32_t bands, const double* centre, double radius, double* out) {
  return answered([&] {
    const double distance = glm::length(vector_at(centre));
    write(sh::rotate_zonal(sh::cap(bands, std::asin(radius / distance)), vector_at(centre) / distance), out);
  });
}

// The part of a sky of two radiances that irradiance can see: its bands 0 and 1, the cap of 90 degrees.
int light_hemisphere(std::int32_t bands, const double* up, double top, double bottom, double* out) {
  return answered([&] {
    Values zonal = sh::cap(bands, kPi / 2.0);
    for (std::size_t l = 1; l < zonal.size(); ++l) zonal[l] *= l == 1 ? top - bottom : 0.0;
    zonal[0] *= top + bottom;
    write(sh::rotate_zonal(zonal, vector_at(up)), out);
  });
}

int transfer_unshadowed(std::int32_t bands, const double* normal, double* out) {
  return answered([&] { write(cosine_about(bands, vector_at(normal), kPi), out); });
}

int relight(std::int32_t bands, const double* transfer, const double* lighting, double* result) {
  *result = 0.0;
  for (std::size_t i = 0; i < size_of(bands); ++i) *result += transfer[i] * lighting[i];
  return kAnswered;
}

int window(std::int32_t bands, const double* in, double* out) {
  return answered([&] {
    for (int l = 0; l < bands; ++l) {
      const double factor = sh::window_factor(sh::Window::hann, l, bands, 0.0);
      for (std::size_t i = size_of(l); i < size_of(l + 1); ++i) out[i] = factor * in[i];
    }
  });
}

int dominant_direction(std::int32_t bands, const double* coefficients, double* direction) {
  if (bands < 2) return kRefused;
  const Vec3d d(-coefficients[3], -coefficients[1], coefficients[2]);
  const double length = glm::length(d);
  if (!(length > 0.0) || !std::isfinite(length)) return kRefused;
  for (glm::length_t k = 0; k < 3; ++k) direction[k] = d[k] / length;
  return kAnswered;
}

int sample_directions(std::int32_t distribution, std::uint64_t seed, std::uint64_t stream, std::size_t count,
                      double* directions, double* densities) {
  for (std::size_t i = 0; i < count; ++i) {
    integrate::Sampler random(seed, stream, 0, static_cast<std::uint32_t>(i));
    const Vec2 uv = random.next_2d();
    const auto u = static_cast<double>(uv.x);
    const double z = distribution == PLUMBLINE_SAMPLE_SPHERE       ? 1.0 - 2.0 * u
                     : distribution == PLUMBLINE_SAMPLE_HEMISPHERE ? 1.0 - u
                                                                   : std::sqrt(1.0 - u);
    const double radius = std::sqrt((1.0 - z) * (1.0 + z));
    const double phi = 2.0 * kPi * static_cast<double>(uv.y);
    directions[3 * i] = radius * std::cos(phi);
    directions[3 * i + 1] = radius * std::sin(phi);
    directions[3 * i + 2] = z;
    densities[i] = distribution == PLUMBLINE_SAMPLE_SPHERE       ? 1.0 / (4.0 * kPi)
                   : distribution == PLUMBLINE_SAMPLE_HEMISPHERE ? 1.0 / (2.0 * kPi)
                                                                 : z / kPi;
  }
  return kAnswered;
}

int mean_and_error(std::size_t count, const double* samples, double* result) {
  metrics::RunningMoments moments;
  for (std::size_t i = 0; i < count; ++i) moments.add(samples[i]);
  const metrics::Estimate estimate = moments.estimate();
  result[0] = estimate.mean;
  result[1] = estimate.standard_error;
  return kAnswered;
}

int rmse(std::size_t count, const double* reference, const double* test, double* result) {
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) sum += (test[i] - reference[i]) * (test[i] - reference[i]);
  *result = std::sqrt(sum / static_cast<double>(count));
  return kAnswered;
}

plumbline_implementation make() {
  constexpr int kMostBands = 20;
  plumbline_implementation result{};
  result.struct_size = sizeof(result);
  result.abi_version = PLUMBLINE_CONFORMANCE_VERSION;
  result.name = "plumbline_sh " PLUMBLINE_VERSION;
  result.precision = PLUMBLINE_PRECISION_DOUBLE;
  result.max_bands = kMostBands;
  result.light_unit = PLUMBLINE_LIGHT_PHYSICAL;
  result.convention = own_convention();
  result.evaluate_basis = evaluate_basis;
  result.evaluate_hemisphere_basis = evaluate_hemisphere_basis;
  result.project_lat_long = project_lat_long;
  result.project_cube = project_cube;
  result.lookup_lat_long = lookup_lat_long;
  result.rotate = rotate;
  result.multiply = multiply;
  result.exponential = exponential;
  result.logarithm = logarithm;
  result.rotate_zonal = rotate_zonal;
  result.irradiance = irradiance;
  result.light_directional = light_directional;
  result.light_cone = light_cone;
  result.light_sphere = light_sphere;
  result.light_hemisphere = light_hemisphere;
  result.transfer_unshadowed = transfer_unshadowed;
  result.relight = relight;
  result.window = window;
  result.dominant_direction = dominant_direction;
  result.sample_directions = sample_directions;
  result.mean_and_error = mean_and_error;
  result.rmse = rmse;
  return result;
}

}  // namespace

const plumbline_implementation& plumbline_sh() {
  static const plumbline_implementation kImplementation = make();
  return kImplementation;
}

}  // namespace plumbline::conformance
