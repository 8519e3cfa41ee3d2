/* plumbline_conformance.h: what a spherical-harmonics implementation offers to be judged by `plumbline conform`.
 *
 * Plain C11, no dependency: copy this one file into your project. Build a shared library that exports
 *
 *   const plumbline_implementation* plumbline_conformance_entry(uint32_t host_version);
 *
 * and returns a struct that stays valid and unchanged while the library is loaded. README.md beside this file has
 * a complete example. Every function pointer may be NULL: what is not offered is not judged.
 *
 * For all functions:
 *  - `bands` n means degrees l = 0 ... n-1, n*n coefficients. 1 <= bands <= max_bands.
 *  - Arrays are contiguous and belong to the caller; inputs and outputs never overlap. Write every output element,
 *    nothing else. Inputs must not be changed.
 *  - Directions are three doubles x, y, z of unit length, in a right-handed world with +Y up. Light directions point
 *    from the surface to the light.
 *  - Coefficients are in the convention you declare. For the quantity RADIANCE, f(w) = sum_i c_i basis_i(w).
 *    They travel in double whatever you compute in; say so in `precision`, by which bounds are scaled.
 *  - Return 0 when the outputs are the answer, any other value to refuse the request (outputs are then ignored).
 *    Refusing what the contract asks for is a finding. Non-finite input must be refused or must give a
 *    non-finite output; a finite answer to it is a finding.
 *  - Calls come from one thread, in any order, in a process of their own.
 */
#ifndef PLUMBLINE_CONFORMANCE_H
#define PLUMBLINE_CONFORMANCE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Changes when a struct or a contract below changes in a way that old libraries would not survive. */
#define PLUMBLINE_CONFORMANCE_VERSION 1u

/* ---------------------------------------------------------------- convention
 * Six independent axes; 0 is always "unknown". What is unknown is not held against you: checks that need it are
 * skipped and named. Example: Plumbline's own convention is
 *   {L_SQUARED, CONDON_SHORTLEY, ORTHONORMAL, {1, 2, 3}, RADIANCE, INTERLEAVED}. */

/* Place of (l, m) among the coefficients; band l always starts at l*l. */
enum plumbline_index_order {
  PLUMBLINE_INDEX_UNKNOWN = 0,
  PLUMBLINE_INDEX_L_SQUARED = 1,  /* l(l+1) + m: m = -l ... l; band 1 is y, z, x */
  PLUMBLINE_INDEX_DESCENDING = 2, /* m = l ... -l; band 1 is x, z, y */
  PLUMBLINE_INDEX_XYZ = 3,        /* band 1 is x, y, z, the others m = -l ... l */
  PLUMBLINE_INDEX_ZERO_FIRST = 4  /* m = 0, 1, -1, 2, -2 ...; band 1 is z, x, y */
};

/* Sign of the functions of odd |m|. Band 1 in x, y, z of the polar frame: */
enum plumbline_sign {
  PLUMBLINE_SIGN_UNKNOWN = 0,
  PLUMBLINE_SIGN_CONDON_SHORTLEY = 1, /* -y, z, -x (Sloan, D3DX) */
  PLUMBLINE_SIGN_POSITIVE = 2         /* y, z, x (Wikipedia's real harmonics, three.js) */
};

/* Length of the basis functions. */
enum plumbline_norm {
  PLUMBLINE_NORM_UNKNOWN = 0,
  PLUMBLINE_NORM_ORTHONORMAL = 1,  /* integral of y^2 = 1 */
  PLUMBLINE_NORM_FOUR_PI = 2,      /* integral of y^2 = 4 pi (N3D, geodesy) */
  PLUMBLINE_NORM_SEMI_SCHMIDT = 3, /* integral of y^2 = 4 pi / (2l + 1) (SN3D, Racah) */
  PLUMBLINE_NORM_UNNORMALIZED = 4, /* P_l|m| times cos or sin of |m| phi */
  PLUMBLINE_NORM_POLYNOMIAL = 5    /* 1, y, z, x, xy, yz, 3z^2 - 1, xz, x^2 - y^2; at most 3 bands */
};

/* What the coefficients you give and take are of. A_l = pi, 2pi/3, pi/4, 0, -pi/24 ... (clamped cosine). From
 * IRRADIANCE on only the first 3 bands are judged: A_3 = 0 cannot be undone. */
enum plumbline_quantity {
  PLUMBLINE_QUANTITY_UNKNOWN = 0,
  PLUMBLINE_QUANTITY_RADIANCE = 1,                /* c */
  PLUMBLINE_QUANTITY_RADIANCE_OVER_PI = 2,        /* c / pi */
  PLUMBLINE_QUANTITY_RADIANCE_OVER_4PI = 3,       /* c / 4 pi */
  PLUMBLINE_QUANTITY_IRRADIANCE = 4,              /* A_l c */
  PLUMBLINE_QUANTITY_IRRADIANCE_OVER_PI = 5,      /* A_l c / pi */
  PLUMBLINE_QUANTITY_IRRADIANCE_OVER_PI_TWICE = 6 /* A_l c / pi^2 */
};

/* How RGB coefficients lie in memory. */
enum plumbline_layout {
  PLUMBLINE_LAYOUT_UNKNOWN = 0,
  PLUMBLINE_LAYOUT_INTERLEAVED = 1, /* [coefficient][rgb] */
  PLUMBLINE_LAYOUT_PLANAR = 2       /* [rgb][coefficient] */
};

typedef struct plumbline_convention {
  int32_t index_order; /* enum plumbline_index_order */
  int32_t sign;        /* enum plumbline_sign */
  int32_t norm;        /* enum plumbline_norm */
  /* Your textbook x, y, z are these world axes: 1 = x, 2 = y, 3 = z, negative = reversed. {1, 2, 3}: polar axis z, no
   * swap. {3, 1, 2}: your z is the world's y (y polar). All 0: unknown. */
  int32_t axes[3];
  int32_t quantity; /* enum plumbline_quantity */
  int32_t layout;   /* enum plumbline_layout */
} plumbline_convention;

/* ---------------------------------------------------------------- what else is declared */

/* What you compute in. Bounds are multiples of its epsilon. */
enum plumbline_precision { PLUMBLINE_PRECISION_DOUBLE = 1, PLUMBLINE_PRECISION_FLOAT = 2 };

/* What directional lights and cones promise.
 *  - PHYSICAL: a directional light has irradiance 1 on a surface that faces it, a cone has radiance 1
 *  - FACING_ONE: both are scaled so that a white Lambertian surface that faces the light has exit radiance 1 when lit
 *    through the same number of bands (as D3DX documents) */
enum plumbline_light_unit { PLUMBLINE_LIGHT_PHYSICAL = 0, PLUMBLINE_LIGHT_FACING_ONE = 1 };

/* Distributions of sample_directions. */
enum plumbline_distribution {
  PLUMBLINE_SAMPLE_SPHERE = 0,     /* uniform, pdf 1 / 4 pi */
  PLUMBLINE_SAMPLE_HEMISPHERE = 1, /* uniform over z > 0, pdf 1 / 2 pi */
  PLUMBLINE_SAMPLE_COSINE = 2      /* over z > 0, pdf z / pi */
};

/* ---------------------------------------------------------------- the implementation */

typedef struct plumbline_implementation {
  uint32_t struct_size; /* sizeof(plumbline_implementation) */
  uint32_t abi_version; /* PLUMBLINE_CONFORMANCE_VERSION */
  const char* name;     /* UTF-8, of the implementation and its version; not NULL */
  int32_t precision;    /* enum plumbline_precision */
  int32_t max_bands;    /* largest `bands` all functions take, >= 1 */
  int32_t light_unit;   /* enum plumbline_light_unit */
  int32_t reserved;     /* 0 */
  plumbline_convention convention;

  /* values[k * n^2 + i] = basis function i at directions[3k ... 3k+2], k = 0 ... count-1. */
  int (*evaluate_basis)(int32_t bands, size_t count, const double* directions, double* values);

  /* The same for n^2 functions that are orthonormal over the hemisphere z > 0 (H-basis, HSH), in any order. */
  int (*evaluate_hemisphere_basis)(int32_t bands, size_t count, const double* directions, double* values);

  /* Coefficients of the radiance of a latitude-longitude image; n^2 x rgb in the declared layout. `rgb` is
   * height x width x 3, row 0 at the top, linear. The middle of pixel (x, y) is u = (x + 1/2)/width,
   * v = (y + 1/2)/height with u = 1/2 + atan2(z, x)/2pi, v = acos(y)/pi: the image's centre is +X, u = 3/4 is +Z, its
   * top +Y. Each texel is a region of constant radiance; how you integrate is yours, the judge allows for the
   * difference to point or bilinear sampling. */
  int (*project_lat_long)(int32_t bands, int32_t width, int32_t height, const float* rgb,
                          double* coefficients);

  /* The same for a cube map, 6 x size x size x 3, faces +X -X +Y -Y +Z -Z, each as OpenGL has them: with s, t from
   * the top left corner in [-1, 1], +X = (1, -t, -s), -X = (-1, -t, s), +Y = (s, 1, t), -Y = (s, -1, -t),
   * +Z = (s, -t, 1), -Z = (-s, -t, -1). */
  int (*project_cube)(int32_t bands, int32_t size, const float* rgb, double* coefficients);

  /* Radiance of the image above in a direction, nearest texel: 3 values. */
  int (*lookup_lat_long)(int32_t width, int32_t height, const float* rgb, const double* direction,
                         double* radiance);

  /* out = coefficients of f(R^-1 w): the function turned by the rotation matrix R (row-major, world axes, acts on
   * column vectors: a lobe about d becomes a lobe about R d). One channel, n^2 values. */
  int (*rotate)(int32_t bands, const double* matrix, const double* in, double* out);

  /* out = projection of the product a(w) b(w) onto the same n bands. One channel. Only RADIANCE. */
  int (*multiply)(int32_t bands, const double* a, const double* b, double* out);

  /* out = projection of exp(a(w)), or of log(a(w)), onto the same n bands; approximations are what is measured here.
   * log of a function that is not positive everywhere may be refused or clipped. */
  int (*exponential)(int32_t bands, const double* in, double* out);
  int (*logarithm)(int32_t bands, const double* in, double* out);

  /* zonal[l] = coefficient of the ORTHONORMAL y_l0 about the polar axis (n values, whatever your convention);
   * out = the same function about `axis`, n^2 values in your convention. */
  int (*rotate_zonal)(int32_t bands, const double* zonal, const double* axis, double* out);

  /* Irradiance E (not E/pi) of one channel of radiance coefficients at a surface with this normal: one value. Linear:
   * negative results of band-limited light are right. */
  int (*irradiance)(int32_t bands, const double* coefficients, const double* normal, double* result);

  /* Coefficients, n^2 values, of analytic lights. light_unit says how directional lights and cones are scaled.
   *  - directional: a light without extent from `direction`
   *  - cone: radiance 1 within half_angle (radians, 0 < half_angle <= pi) of `direction`
   *  - sphere: a sphere of radiance 1, centre and radius in the same unit as the distance from the origin, which is
   *    outside; always PHYSICAL
   *  - hemisphere: a light whose irradiance on every surface is pi (bottom + (top - bottom)(1 + n.up)/2): white and
   *    white is uniform radiance 1; always PHYSICAL. Odd bands l >= 3 do not show in it and are not judged */
  int (*light_directional)(int32_t bands, const double* direction, double* out);
  int (*light_cone)(int32_t bands, const double* direction, double half_angle, double* out);
  int (*light_sphere)(int32_t bands, const double* centre, double radius, double* out);
  int (*light_hemisphere)(int32_t bands, const double* up, double top, double bottom, double* out);

  /* Transfer vector of an unblocked point with this normal: exit radiance for unit albedo, so that
   * sum_i transfer_i lighting_i = E/pi with lighting coefficients in your convention. n^2 values. */
  int (*transfer_unshadowed)(int32_t bands, const double* normal, double* out);

  /* transfer . lighting, one channel: one value. */
  int (*relight)(int32_t bands, const double* transfer, const double* lighting, double* result);

  /* The same function with less ringing, by factors that depend on the degree only (0 ... 1; band 0 keeps its
   * value). They may be chosen by looking at the function, but not at how it is turned. */
  int (*window)(int32_t bands, const double* in, double* out);

  /* Unit direction in which the band-1 part of radiance coefficients is largest. There is none when it is 0: refuse. */
  int (*dominant_direction)(int32_t bands, const double* coefficients, double* direction);

  /* `count` random directions and their densities [1/sr], enum plumbline_distribution about +z. The same seed and
   * stream give the same samples; different streams (threads, pixels) are independent. */
  int (*sample_directions)(int32_t distribution, uint64_t seed, uint64_t stream, size_t count,
                           double* directions, double* densities);

  /* Mean of independent samples and its standard error sqrt(sum (x - mean)^2 / (count (count - 1))); count >= 2.
   * result[0] and result[1]. A non-finite sample must show in the result. */
  int (*mean_and_error)(size_t count, const double* samples, double* result);

  /* Root of the mean squared difference of two images' values: one value. A non-finite value must show in it. */
  int (*rmse)(size_t count, const double* reference, const double* test, double* result);
} plumbline_implementation;

/* The one function a library exports. `host_version` is the judge's PLUMBLINE_CONFORMANCE_VERSION; return NULL if
 * you cannot serve it. */
#define PLUMBLINE_CONFORMANCE_ENTRY "plumbline_conformance_entry"
#if defined(_WIN32)
#define PLUMBLINE_EXPORT __declspec(dllexport)
#else
#define PLUMBLINE_EXPORT __attribute__((visibility("default")))
#endif
PLUMBLINE_EXPORT const plumbline_implementation* plumbline_conformance_entry(uint32_t host_version);

#ifdef __cplusplus
}
#endif
#endif /* PLUMBLINE_CONFORMANCE_H */
