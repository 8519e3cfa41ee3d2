// prt/sh/exponential_steps.hpp: what the single and the batched exponential share.
// Inside the library only: exponential.hpp is the interface.
#pragma once

#include <algorithm>
#include <cmath>

#include "prt/sh/exponential.hpp"

namespace plumbline::sh::detail {

/// Smallest p >= 0 with magnitude / 2^p <= kScaledMagnitude; magnitude <= kLargestMagnitude.
[[nodiscard]] inline int squarings_for(double magnitude) {
  int squarings = 0;
  for (; magnitude > kScaledMagnitude; ++squarings) magnitude *= 0.5;
  return squarings;
}

struct LinearFactors {
  double a = 1.0;
  double b = 1.0;
};
/// Linear interpolation; magnitude <= kLargestTabled.
[[nodiscard]] inline LinearFactors linear_factors(const LinearTable& table, double magnitude) {
  const double place = magnitude / table.step;
  const double low = std::min(std::floor(place), static_cast<double>(table.a.size() - 2));
  const auto i = static_cast<std::size_t>(low);
  const double t = place - low;
  return {(1.0 - t) * table.a[i] + t * table.a[i + 1], (1.0 - t) * table.b[i] + t * table.b[i + 1]};
}

}  // namespace plumbline::sh::detail
