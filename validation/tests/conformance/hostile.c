/* Libraries that misbehave, one for each HOSTILE_ macro. */
#include <stdlib.h>
#include <string.h>

#include "validation/conformance/plumbline_conformance.h"

static int relight(int32_t bands, const double* transfer, const double* lighting, double* result) {
  (void)bands, (void)transfer, (void)lighting, (void)result;
#if defined(HOSTILE_CRASHES)
  volatile int* volatile nowhere = NULL;
  return *nowhere;
#elif defined(HOSTILE_HANGS)
  for (volatile int i = 0;; i = i + 1) {
  }
#elif defined(HOSTILE_EXITS)
  exit(0);
#elif defined(HOSTILE_ABORTS)
  abort();
#else
  double sum = 0.0;
  for (int32_t i = 0; i < bands * bands; ++i) sum += transfer[i] * lighting[i];
  result[0] = sum;
#if defined(HOSTILE_WRITES_OUTSIDE)
  result[1] = sum;
#endif
#endif
  return 0;
}

#if defined(HOSTILE_CRASHES_ON_LOAD)
__attribute__((constructor)) static void at_load(void) {
  abort();
}
#endif

#if defined(HOSTILE_NO_ENTRY)
PLUMBLINE_EXPORT int something_else(void);
int something_else(void) {
  return relight(0, NULL, NULL, (double[2]){0.0, 0.0});
}
#else
const plumbline_implementation* plumbline_conformance_entry(uint32_t host_version) {
  static plumbline_implementation implementation = {
      .struct_size = sizeof(plumbline_implementation),
      .abi_version = PLUMBLINE_CONFORMANCE_VERSION,
      .name = "hostile",
      .precision = PLUMBLINE_PRECISION_DOUBLE,
      .max_bands = 6,
      .convention = {1, 1, 1, {1, 2, 3}, 1, 1},
      .relight = relight,
  };
  (void)host_version;
#if defined(HOSTILE_WRONG_SIZE)
  implementation.struct_size = (uint32_t)sizeof(plumbline_implementation) - 8;
#elif defined(HOSTILE_WRONG_VERSION)
  implementation.abi_version = 99;
#elif defined(HOSTILE_NULL)
  return NULL;
#elif defined(HOSTILE_LIES)
  implementation.max_bands = -5;
#endif
  return &implementation;
}
#endif
