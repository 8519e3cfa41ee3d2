// validation/conformance/timing.hpp: nanoseconds a call.
#pragma once

#include <optional>
#include <string>

#include "validation/conformance/plumbline_conformance.h"

namespace plumbline::conformance {

/// Median of five runs of at least a millisecond of one call of the operation (a check's operation) with plain
/// arguments; a basis is evaluated at one direction, images have 32 x 16 texels or faces of 8 x 8. None where
/// the operation is not offered or is refused.
[[nodiscard]] std::optional<double> nanoseconds(const plumbline_implementation& implementation,
                                                const std::string& operation, int bands);

}  // namespace plumbline::conformance
