// prt/sh/direction.hpp: directions that come from outside.
#pragma once

#include <algorithm>
#include <string>

#include "reference/base/error.hpp"
#include "reference/base/vector.hpp"

namespace plumbline::sh {

/// v / |v|, also where the squares of v would overflow or vanish. @throws InputError, naming `where`, for a vector that
/// is zero or not finite
[[nodiscard]] inline Vec3d unit_direction(const Vec3d& v, const std::string& where) {
  const double largest = std::max(std::abs(v.x), std::max(std::abs(v.y), std::abs(v.z)));
  if (!(largest > 0.0 && std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z))) {
    throw InputError(where + ": expected a finite vector that has a length");
  }
  return glm::normalize(v / largest);
}

}  // namespace plumbline::sh
