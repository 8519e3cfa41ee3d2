/* libgsl_conformance.so: the GNU Scientific Library's Legendre functions as spherical harmonics, an independent
 * oracle and an example in C. gsl_sf_legendre_array takes cos theta alone, so that sin theta comes from 1 - z^2: digits
 * of m > 0 are lost near the poles, and `plumbline conform` says so. */
#include <gsl/gsl_sf_legendre.h>
#include <math.h>
#include <stdlib.h>

#include "validation/conformance/plumbline_conformance.h"

static const double kPi = 3.14159265358979323846;

static int evaluate(int32_t bands, const double* direction, double* values, double* legendre) {
  const size_t last = (size_t)bands - 1;
  /* Spherical-harmonic normalisation, Condon-Shortley phase included. */
  const double z = fmin(1.0, fmax(-1.0, direction[2]));
  if (gsl_sf_legendre_array_e(GSL_SF_LEGENDRE_SPHARM, last, z, -1.0, legendre) != 0) return 1;
  const double phi = atan2(direction[1], direction[0]);
  for (int l = 0; l < bands; ++l) {
    for (int m = 0; m <= l; ++m) {
      const double p = legendre[gsl_sf_legendre_array_index((size_t)l, (size_t)m)];
      const int centre = l * (l + 1);
      values[centre + m] = m == 0 ? p : sqrt(2.0) * p * cos(m * phi);
      if (m > 0) values[centre - m] = sqrt(2.0) * p * sin(m * phi);
    }
  }
  return 0;
}

static int evaluate_basis(int32_t bands, size_t count, const double* directions, double* values) {
  double* legendre = malloc(gsl_sf_legendre_array_n((size_t)bands - 1) * sizeof(double));
  if (legendre == NULL) return 1;
  int status = 0;
  for (size_t k = 0; k < count && status == 0; ++k) {
    const size_t row = k * (size_t)bands * (size_t)bands;
    status = evaluate(bands, directions + 3 * k, values + row, legendre);
  }
  free(legendre);
  return status;
}

static int light_directional(int32_t bands, const double* direction, double* out) {
  return evaluate_basis(bands, 1, direction, out);
}

static int rotate_zonal(int32_t bands, const double* zonal, const double* axis, double* out) {
  if (evaluate_basis(bands, 1, axis, out) != 0) return 1;
  for (int l = 0; l < bands; ++l)
    for (int m = -l; m <= l; ++m) out[l * (l + 1) + m] *= sqrt(4.0 * kPi / (2 * l + 1)) * zonal[l];
  return 0;
}

const plumbline_implementation* plumbline_conformance_entry(uint32_t host_version) {
  static plumbline_implementation implementation = {
      .struct_size = sizeof(plumbline_implementation),
      .abi_version = PLUMBLINE_CONFORMANCE_VERSION,
      .name =
          "GSL "
          "gsl_sf_legendre_array",
      .precision = PLUMBLINE_PRECISION_DOUBLE,
      .max_bands = 20,
      .convention = {.index_order = PLUMBLINE_INDEX_L_SQUARED,
                     .sign = PLUMBLINE_SIGN_CONDON_SHORTLEY,
                     .norm = PLUMBLINE_NORM_ORTHONORMAL,
                     .axes = {1, 2, 3},
                     .quantity = PLUMBLINE_QUANTITY_RADIANCE,
                     .layout = PLUMBLINE_LAYOUT_INTERLEAVED},
      .evaluate_basis = evaluate_basis,
      .rotate_zonal = rotate_zonal,
      .light_directional = light_directional,
  };
  return host_version == PLUMBLINE_CONFORMANCE_VERSION ? &implementation : NULL;
}
