// validation/metrics/mann_whitney.hpp: does one sample tend to be larger than another? For times, whose law is nobody's
// favourite: long tails to one side.
#pragma once

#include <span>

#include "validation/metrics/statistics.hpp"

namespace plumbline::metrics {

/// Mann and Whitney's U of `a` over `b`: how many pairs have a > b, ties counting one half; and the probability of a U
/// at least as large were both of one law. Exact without ties and up to 64 values each; else the normal law with the
/// correction for ties and continuity. NaN gives p = 1: a time that is none has not been shown to be longer.
/// @throws InputError unless both have at least one value.
[[nodiscard]] TestResult mann_whitney_greater(std::span<const double> a, std::span<const double> b);

}  // namespace plumbline::metrics
