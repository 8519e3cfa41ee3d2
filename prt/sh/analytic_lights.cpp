#include "prt/sh/analytic_lights.hpp"

#include <cmath>
#include <string>

#include "prt/sh/direction.hpp"
#include "prt/sh/rotation.hpp"
#include "prt/sh/zonal.hpp"
#include "reference/base/error.hpp"

namespace plumbline::sh {
namespace {

void require_radiance(const RgbD& radiance, const char* where) {
  const bool is_finite = std::isfinite(radiance.r) && std::isfinite(radiance.g) && std::isfinite(radiance.b);
  if (!is_finite) throw InputError(std::string(where) + ": radiance is not finite");
}

}  // namespace

ShRgb lit(const std::vector<double>& coefficients, const RgbD& radiance) {
  require_radiance(radiance, "sh::lit");
  ShRgb result{bands_of(coefficients.size(), "sh::lit"), {}};
  for (const double c : coefficients) result.coefficients.push_back(c * radiance);
  return result;
}

ShRgb lit(const std::vector<double>& zonal, const Vec3d& axis, const RgbD& radiance) {
  return lit(rotate_zonal(zonal, unit_direction(axis, "sh::lit")), radiance);
}

std::vector<double> directional_light(int bands) {
  require_bands(bands);
  std::vector<double> zonal;
  for (int l = 0; l < bands; ++l) zonal.push_back(std::sqrt((2.0 * l + 1.0) / (4.0 * kPi)));
  return zonal;
}

std::vector<double> sphere_light(int bands, double distance, double radius) {
  if (!(radius > 0.0 && radius < distance && std::isfinite(distance))) {
    throw InputError("sphere_light: expected 0 < radius < distance, got radius " + std::to_string(radius) +
                     " and distance " + std::to_string(distance));
  }
  return cap(bands, std::asin(radius / distance));
}

// (1 + cos)/2 above + (1 - cos)/2 below = (above + below)/2 + (above - below)/2 cos, and cos t is
// sqrt(4 pi/3) y_10, 1 is sqrt(4 pi) y_00.
ShRgb hemisphere_light(int bands, const HemisphereLight& light, const Vec3d& up) {
  require_bands(bands);
  require_radiance(light.above, "hemisphere_light");
  require_radiance(light.below, "hemisphere_light");
  std::vector<double> mean(static_cast<std::size_t>(bands), 0.0);
  mean[0] = std::sqrt(4.0 * kPi);
  ShRgb result = lit(mean, up, 0.5 * light.above + 0.5 * light.below);
  if (bands == 1) return result;
  std::vector<double> slope(static_cast<std::size_t>(bands), 0.0);
  slope[1] = std::sqrt(4.0 * kPi / 3.0);
  const ShRgb tilt = lit(slope, up, 0.5 * light.above - 0.5 * light.below);
  for (std::size_t i = 0; i < result.coefficients.size(); ++i) result.coefficients[i] += tilt.coefficients[i];
  return result;
}

// The ratio r_l = i_(l+1)/i_l obeys r_(l-1) = 1 / ((2l + 1)/k + r_l), a contraction downwards. It starts from the ratio's
// asymptotic form k / (L + 3/2 + sqrt((L + 3/2)^2 + k^2)), far enough up that the error of that is forgotten: each step
// down to 0 shrinks it by r^2, about exp(-2l/k), which over L = 8 sqrt(k) steps is e^-64. Beyond k = 1e8 these would be
// many; there i_0 = i_1 = … to first order in l^2/k, and the recurrence upwards, i_(l+1) = i_(l-1) - (2l + 1)/k i_l, loses
// nothing. e^-k i_0 = (1 - e^-2k)/(2k).
std::vector<double> spherical_gaussian(int bands, double sharpness) {
  require_bands(bands);
  if (!(sharpness >= 0.0 && std::isfinite(sharpness))) {
    throw InputError("spherical_gaussian: expected a finite sharpness >= 0, got " +
                     std::to_string(sharpness));
  }
  const double k = sharpness;
  const auto size = static_cast<std::size_t>(bands);
  std::vector<double> bessel(size, 0.0);  // e^-k i_l(k)
  bessel[0] = k > 0.0 ? -std::expm1(-2.0 * k) / (2.0 * k) : 1.0;
  if (k > 1e8) {
    if (bands > 1) bessel[1] = bessel[0] - 0.5 / k / k;
    for (std::size_t l = 1; l + 1 < size; ++l) {
      bessel[l + 1] = bessel[l - 1] - (2.0 * static_cast<double>(l) + 1.0) / k * bessel[l];
    }
  } else if (k > 0.0) {
    const int top = bands + 40 + static_cast<int>(8.0 * std::sqrt(k));
    double ratio = k / (top + 1.5 + std::hypot(top + 1.5, k));
    std::vector<double> ratios(size, 0.0);
    for (int l = top; l >= 1; --l) {
      ratio = k / (2.0 * l + 1.0 + k * ratio);
      if (l <= bands) ratios[static_cast<std::size_t>(l - 1)] = ratio;
    }
    for (std::size_t l = 0; l + 1 < size; ++l) bessel[l + 1] = ratios[l] * bessel[l];
  }
  for (std::size_t l = 0; l < size; ++l)
    bessel[l] *= std::sqrt(4.0 * kPi * (2.0 * static_cast<double>(l) + 1.0));
  return bessel;
}

}  // namespace plumbline::sh
