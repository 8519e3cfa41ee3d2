// validation/conformance/adapters/plumbline_sh.hpp: our own library as an implementation under test.
#pragma once

#include "validation/conformance/plumbline_conformance.h"

namespace plumbline::conformance {

/// Every operation, in double, in Plumbline's convention; lights are PHYSICAL. Refuses what the library refuses.
[[nodiscard]] const plumbline_implementation& plumbline_sh();

}  // namespace plumbline::conformance
