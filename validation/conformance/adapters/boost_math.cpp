// libboost_conformance.so: Boost.Math's spherical harmonics, an independent oracle and an example in C++.
#include <boost/math/special_functions/spherical_harmonic.hpp>
#include <cmath>
#include <exception>

#include "validation/conformance/plumbline_conformance.h"

namespace {

constexpr double kPi = 3.14159265358979323846;

// y_lm = sqrt(2) Re Y_lm or sqrt(2) Im Y_l|m|, with the Condon-Shortley phase, which Boost keeps.
double function(int l, int m, double theta, double phi) {
  const auto degree = static_cast<unsigned>(l);
  if (m == 0) return boost::math::spherical_harmonic_r(degree, 0, theta, phi);
  const double part = m > 0 ? boost::math::spherical_harmonic_r(degree, m, theta, phi)
                            : boost::math::spherical_harmonic_i(degree, -m, theta, phi);
  return std::sqrt(2.0) * part;
}

int evaluate_basis(int32_t bands, size_t count, const double* directions, double* values) {
  try {
    for (size_t k = 0; k < count; ++k) {
      const double* d = directions + 3 * k;
      const double theta = std::atan2(std::hypot(d[0], d[1]), d[2]);
      const double phi = std::atan2(d[1], d[0]);
      for (int l = 0; l < bands; ++l)
        for (int m = -l; m <= l; ++m) *values++ = function(l, m, theta, phi);
    }
    return 0;
  } catch (const std::exception&) {
    return 1;
  }
}

int light_directional(int32_t bands, const double* direction, double* out) {
  return evaluate_basis(bands, 1, direction, out);
}

int rotate_zonal(int32_t bands, const double* zonal, const double* axis, double* out) {
  if (evaluate_basis(bands, 1, axis, out) != 0) return 1;
  for (int l = 0; l < bands; ++l)
    for (int m = -l; m <= l; ++m) out[l * (l + 1) + m] *= std::sqrt(4.0 * kPi / (2 * l + 1)) * zonal[l];
  return 0;
}

plumbline_implementation make() {
  plumbline_implementation result{};
  result.struct_size = sizeof(result);
  result.abi_version = PLUMBLINE_CONFORMANCE_VERSION;
  result.name = "Boost.Math spherical_harmonic";
  result.precision = PLUMBLINE_PRECISION_DOUBLE;
  result.max_bands = 20;
  result.convention = {PLUMBLINE_INDEX_L_SQUARED,   PLUMBLINE_SIGN_CONDON_SHORTLEY,
                       PLUMBLINE_NORM_ORTHONORMAL,  {1, 2, 3},
                       PLUMBLINE_QUANTITY_RADIANCE, PLUMBLINE_LAYOUT_INTERLEAVED};
  result.evaluate_basis = evaluate_basis;
  result.rotate_zonal = rotate_zonal;
  result.light_directional = light_directional;
  return result;
}

}  // namespace

extern "C" const plumbline_implementation* plumbline_conformance_entry(uint32_t host_version) {
  static const plumbline_implementation kImplementation = make();
  return host_version == PLUMBLINE_CONFORMANCE_VERSION ? &kImplementation : nullptr;
}
