#include "prt/sh/zonal.hpp"

#include <cmath>
#include <string>

#include "prt/sh/basis.hpp"
#include "reference/base/error.hpp"

namespace plumbline::sh {

// A_l = 2 pi integral_0^1 z P_l(z) dz. Odd l > 1 vanish by parity (z P_l is even there, and orthogonal to 1
// over the whole interval); even l: 2 pi (-1)^(l/2 - 1) / ((l + 2)(l - 1)) * l! / (2^l (l/2)!^2), whose last
// factor is the product of (2k - 1)/(2k) for k = 1 … l/2.
double clamped_cosine_factor(int degree) {
  if (degree < 0) {
    throw InputError("clamped_cosine_factor: expected degree >= 0, got " + std::to_string(degree));
  }
  if (degree == 1) return 2.0 * kPi / 3.0;
  if (degree % 2 == 1) return 0.0;
  double ratio = 1.0;
  for (int k = 1; k <= degree / 2; ++k) ratio *= (2.0 * k - 1.0) / (2.0 * k);
  const double sign = (degree / 2) % 2 == 1 ? 1.0 : -1.0;
  return 2.0 * kPi * sign * ratio / ((degree + 2.0) * (degree - 1.0));
}

std::vector<double> clamped_cosine(int bands) {
  require_bands(bands);
  std::vector<double> zonal;
  for (int l = 0; l < bands; ++l) {
    zonal.push_back(std::sqrt((2.0 * l + 1.0) / (4.0 * kPi)) * clamped_cosine_factor(l));
  }
  return zonal;
}

// z_l = 2 pi sqrt((2l + 1)/(4 pi)) integral_(cos a)^1 P_l(x) dx. Legendre's equation gives the integral as
// (1 - x^2) P_l'(x) / (l (l + 1)) at x = cos a, where sin^2 a is known without cancellation however small a
// is, and P_l' = x P_(l-1)' + l P_(l-1) adds terms of one sign near x = 1.
std::vector<double> cap(int bands, double half_angle_rad) {
  require_bands(bands);
  if (!(half_angle_rad > 0.0 && half_angle_rad <= kPi)) {
    throw InputError("cap: expected a half angle in (0, pi], got " + std::to_string(half_angle_rad));
  }
  const double x = std::cos(half_angle_rad);
  const double sin_a = std::sin(half_angle_rad);
  const double sin_half = std::sin(0.5 * half_angle_rad);
  const std::vector<double> p = legendre(bands, x);
  std::vector<double> zonal{2.0 * std::sqrt(kPi) * sin_half * sin_half};
  double derivative = 0.0;
  for (int l = 1; l < bands; ++l) {
    derivative = x * derivative + l * p[static_cast<std::size_t>(l - 1)];
    zonal.push_back(std::sqrt(kPi * (2.0 * l + 1.0)) * sin_a * sin_a * derivative / (l * (l + 1.0)));
  }
  return zonal;
}

std::vector<double> legendre(int count, double x) {
  if (count < 0) throw InputError("legendre: expected count >= 0, got " + std::to_string(count));
  std::vector<double> p;
  p.reserve(static_cast<std::size_t>(count));
  for (int l = 0; l < count; ++l) {
    const auto i = static_cast<std::size_t>(l);
    p.push_back(l == 0 ? 1.0 : l == 1 ? x : ((2.0 * l - 1.0) * x * p[i - 1] - (l - 1.0) * p[i - 2]) / l);
  }
  return p;
}

std::vector<double> rotate_zonal(const std::vector<double>& zonal, const Vec3d& direction) {
  const auto bands = static_cast<int>(zonal.size());
  std::vector<double> values = evaluate_basis(bands, direction);
  for (int l = 0; l < bands; ++l) {
    const double factor = std::sqrt(4.0 * kPi / (2.0 * l + 1.0)) * zonal[static_cast<std::size_t>(l)];
    for (int m = -l; m <= l; ++m) values[static_cast<std::size_t>(index(l, m))] *= factor;
  }
  return values;
}

}  // namespace plumbline::sh
