// libplumbline_sh_conformance.so: our own library, judged like anybody else's.
#include "validation/conformance/adapters/plumbline_sh.hpp"

extern "C" const plumbline_implementation* plumbline_conformance_entry(uint32_t host_version) {
  if (host_version != PLUMBLINE_CONFORMANCE_VERSION) return nullptr;
  return &plumbline::conformance::plumbline_sh();
}
