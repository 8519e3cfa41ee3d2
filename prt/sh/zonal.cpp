#include "prt/sh/zonal.hpp"

#include <cmath>
#include <string>

#include "prt/sh/basis.hpp"
#include "prt/sh/quadrature.hpp"
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

// I_l = integral_0^1 x^n P_l(x) dx: I_0 = 1/(n + 1), I_1 = 1/(n + 2), I_(l+2) = I_l (n - l)/(n + l + 3).
std::vector<double> clamped_cosine_power(int bands, double exponent) {
  require_bands(bands);
  if (!(exponent >= 0.0 && std::isfinite(exponent))) {
    throw InputError("clamped_cosine_power: expected a finite exponent >= 0, got " +
                     std::to_string(exponent));
  }
  std::vector<double> zonal;
  double integral = 1.0 / (exponent + 1.0);
  double next = 1.0 / (exponent + 2.0);
  for (int l = 0; l < bands; ++l) {
    zonal.push_back(std::sqrt(kPi * (2.0 * l + 1.0)) * integral);
    const double after = integral * (exponent - l) / (exponent + l + 3.0);
    integral = next;
    next = after;
  }
  return zonal;
}

// With u = sqrt(1 + s^2 - 2 s x), x = cos a, the lobe (x - s)/u dx is (x - s)/s du, a polynomial in u, so that Gauss nodes
// are exact: degree 2l + 2 at degree l. u runs from 1 - s (x = 1) to sqrt(1 - s^2) (x = s), and with t in 0 … 1 along it
// x = 1 - t (1 - s)(u + 1 - s)/(sqrt(1 - s^2) + 1 - s), which cancels nowhere. Factors without x go when normalising.
std::vector<double> form_factor_lobe(int bands, double half_angle_rad) {
  require_bands(bands);
  if (!(half_angle_rad > 0.0 && half_angle_rad < 0.5 * kPi)) {
    throw InputError("form_factor_lobe: expected a half angle in (0, pi/2), got " +
                     std::to_string(half_angle_rad));
  }
  const double s = std::sin(half_angle_rad);
  const double first = 1.0 - s;
  const double last = std::sqrt(first * (1.0 + s));
  const GaussLegendre rule = gauss_legendre(bands + 2);
  std::vector<double> zonal(static_cast<std::size_t>(bands), 0.0);
  for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
    const double t = 0.5 + 0.5 * rule.nodes[k];
    const double u = first + t * (last - first);
    const double fall = t * first * (u + first) / (last + first);  // 1 - x
    const std::vector<double> p = legendre(bands, 1.0 - fall);
    for (std::size_t l = 0; l < zonal.size(); ++l) zonal[l] += rule.weights[k] * (first - fall) * p[l];
  }
  const double total = zonal[0];
  for (std::size_t l = 0; l < zonal.size(); ++l) {
    zonal[l] *= std::sqrt((2.0 * static_cast<double>(l) + 1.0) / (4.0 * kPi)) / total;
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
