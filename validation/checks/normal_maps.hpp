// validation/checks/normal_maps.hpp: what the family of normal-mapped PRT judges by.
#pragma once

#include "prt/sh/lighting.hpp"
#include "validation/checks/error_parts.hpp"
#include "validation/checks/verdicts.hpp"

namespace plumbline::checks {

/// The most that any pixel of albedo 1 can be off when incident radiance is kept to degree 2, root mean square over channels. The kernel
/// max(0, cos)/pi has the squared norm 2/(3 pi), of which 1/128 lies beyond degree 2; incident radiance is the light where nothing
/// blocks, so its norm is at most the light's: |error| <= sqrt(2/(3 pi)/128) |light| (Cauchy-Schwarz), |light|^2 = sum of its squared
/// coefficients (Parseval).
[[nodiscard]] double nine_terms_bound(const sh::ShRgb& light);

/// A difference that must be below 0: fails when it is above by more than chance (two-sided `significance`), passes when its 95 % interval
/// is below, else inconclusive. NaN fails.
[[nodiscard]] Finding judge_order(const Label& label, const metrics::Estimate& difference,
                                  double significance);

}  // namespace plumbline::checks
