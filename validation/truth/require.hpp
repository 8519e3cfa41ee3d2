// validation/truth/require.hpp: ranges of closed forms.
#pragma once

#include "reference/base/error.hpp"

namespace plumbline::truth {

/// Throws InputError("truth::<function>: needs <relation>, got <value>") unless `holds`.
void require(bool holds, const char* function, const char* relation, double value);

}  // namespace plumbline::truth
