// validation/tests/sh/oracle.hpp: spherical harmonics in quadruple precision, by a route of their own.
#pragma once

#include <cmath>
#include <random>
#include <vector>

#include "reference/base/vector.hpp"

namespace plumbline::sh_test {

#if defined(__SIZEOF_FLOAT128__)
using Quad = __float128;
#else
using Quad = long double;
#endif

/// Square root: long double's, polished by two Newton steps.
inline Quad quad_sqrt(Quad value) {
  if (value <= Quad(0)) return Quad(0);
  Quad root = std::sqrt(static_cast<long double>(value));
  for (int step = 0; step < 2; ++step) root = (root + value / root) / Quad(2);
  return root;
}

/// All functions of `bands` bands at direction / |direction|, index l(l+1)+m.
/// The textbook route: P_m^m = (2m - 1)!! sin^m with the Condon-Shortley sign, unnormalised recurrence in l
/// for fixed m, then K_lm and the azimuth as a Chebyshev recurrence. Its numbers overflow nothing in
/// quadruple precision up to a few hundred bands; exact to 1e-30 (1e-15 where long double stands in).
inline std::vector<Quad> evaluate(int bands, const Vec3d& direction) {
  const Quad dx = direction.x;
  const Quad dy = direction.y;
  const Quad dz = direction.z;
  const Quad length = quad_sqrt(dx * dx + dy * dy + dz * dz);
  const Quad z = dz / length;
  const Quad sine = quad_sqrt(dx * dx + dy * dy) / length;
  const Quad cos_phi = sine > Quad(0) ? dx / (length * sine) : Quad(1);
  const Quad sin_phi = sine > Quad(0) ? dy / (length * sine) : Quad(0);
  // pi in two doubles' worth of digits beyond long double's: the high part is exact, the low part is what it
  // leaves out.
  const Quad pi = Quad(3.141592653589793115997963468544185161590576171875) + Quad(1.2246467991473531772e-16L);
  std::vector<Quad> values(static_cast<std::size_t>(bands * bands));
  Quad top = 1;  // P_m^m
  Quad cos_m = 1;
  Quad sin_m = 0;
  for (int m = 0; m < bands; ++m) {
    if (m > 0) {
      top *= -Quad(2 * m - 1) * sine;
      const Quad next = cos_m * cos_phi - sin_m * sin_phi;
      sin_m = cos_m * sin_phi + sin_m * cos_phi;
      cos_m = next;
    }
    Quad factorials = 1;  // (l - m)! / (l + m)!
    for (int k = 1; k <= 2 * m; ++k) factorials /= Quad(k);
    Quad previous = 0;
    Quad current = top;
    for (int l = m; l < bands; ++l) {
      if (l > m) {
        const Quad next = (Quad(2 * l - 1) * z * current - Quad(l + m - 1) * previous) / Quad(l - m);
        previous = current;
        current = next;
        factorials *= Quad(l - m) / Quad(l + m);
      }
      const Quad scale = quad_sqrt(Quad(2 * l + 1) / (Quad(4) * pi) * factorials * Quad(m > 0 ? 2 : 1));
      values[static_cast<std::size_t>(l * (l + 1) + m)] = scale * current * cos_m;
      if (m > 0) values[static_cast<std::size_t>(l * (l + 1) - m)] = scale * current * sin_m;
    }
  }
  return values;
}

/// Uniform directions, the same on every machine.
inline std::vector<Vec3d> directions(int count, unsigned seed) {
  std::mt19937 bits(seed);
  const auto uniform = [&bits] { return (static_cast<double>(bits()) + 0.5) / 4294967296.0; };
  std::vector<Vec3d> result;
  for (int i = 0; i < count; ++i) {
    const double z = 2.0 * uniform() - 1.0;
    const double phi = 2.0 * kPi * uniform();
    const double radius = std::sqrt((1.0 - z) * (1.0 + z));
    result.push_back(glm::normalize(Vec3d(radius * std::cos(phi), radius * std::sin(phi), z)));
  }
  return result;
}

/// 0.1, 0.01 … 1e-8 rad from either pole, as far as that is within `largest_angle`, at azimuths of no special kind.
inline std::vector<Vec3d> polar_directions(double largest_angle) {
  std::vector<Vec3d> result;
  for (int k = 1; k <= 8; ++k) {
    const double angle = std::pow(10.0, -k);
    if (angle > largest_angle * 1.001) continue;
    for (const double azimuth : {0.3, 0.9272952180016122, 2.0, 4.5}) {
      const Vec3d d(std::cos(azimuth) * std::sin(angle), std::sin(azimuth) * std::sin(angle),
                    std::cos(angle));
      result.push_back(d);
      result.emplace_back(d.x, d.y, -d.z);
    }
  }
  return result;
}

/// Largest |error| of a +-m pair (a single value at m = 0) over the pair's size, of `values` at `direction`. Pairs
/// that Real cannot hold with all its digits are left out. NaN stays.
template <class Real>
double pair_error(int bands, const Vec3d& direction, const std::vector<Real>& values) {
  const double smallest = sizeof(Real) == sizeof(float) ? 1e-30 : 1e-290;
  const std::vector<Quad> truth = evaluate(bands, direction);
  double result = 0.0;
  for (int l = 0; l < bands; ++l) {
    for (int m = 0; m <= l; ++m) {
      const auto plus = static_cast<std::size_t>(l * (l + 1) + m);
      const auto minus = static_cast<std::size_t>(l * (l + 1) - m);
      const double other = m > 0 ? static_cast<double>(truth[minus]) : 0.0;
      const double size = std::hypot(static_cast<double>(truth[plus]), other);
      if (size < smallest) continue;
      const double error = static_cast<double>(Quad(values[plus]) - truth[plus]);
      const double other_error = m > 0 ? static_cast<double>(Quad(values[minus]) - truth[minus]) : 0.0;
      const double relative = std::hypot(error, other_error) / size;
      if (!(relative <= result)) result = relative;
      if (std::isnan(result)) return result;
    }
  }
  return result;
}

}  // namespace plumbline::sh_test
