// reference/integrate/hemisphere.hpp: directions about a normal.
#pragma once

#include "reference/base/vector.hpp"

namespace plumbline::integrate {

/// Direction with density max(0, n.w) / pi about the unit normal; u in [0, 1)^2.
/// A uniform disc lifted to the hemisphere (Malley), with Shirley & Chiu's concentric map, which keeps strata
/// together. Unit to float rounding, as the normal is.
[[nodiscard]] Vec3 sample_cosine_hemisphere(const Vec3& normal, const Vec2& u);

}  // namespace plumbline::integrate
