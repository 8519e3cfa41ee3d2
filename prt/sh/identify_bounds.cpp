// What numbers alone exclude: passive_bounds of identify.hpp.
#include <fmt/format.h>

#include <cmath>

#include "prt/sh/identify.hpp"
#include "prt/sh/identify_trials.hpp"
#include "reference/base/error.hpp"

namespace plumbline::sh {
namespace {

/// Numbers rounded to single precision do not exceed a bound by more.
constexpr double kSlack = 1e-5;

// For L >= 0 and any degree, the addition theorem gives
//   sum over m of c_lm^2 = (2l + 1)/(4 pi) integral integral L(v) L(w) P_l(v w) dv dw <= (2l + 1) c_00^2,
// with equality for light from one direction. Their numbers divided by the convention's factors are such c; turning,
// mirroring and signs change no sum. A degree that the factors remove must be zero.
Bound bound_of(const std::vector<RgbD>& rows, const Convention& scaling, const Split& split) {
  Bound bound{scaling, split.is_one_channel, split.bands, 0, 0.0, false};
  bound.convention.layout = split.layout;
  for (int l = 1; l < split.bands; ++l) {
    for (glm::length_t channel = 0; channel < 3; ++channel) {
      const double mean = rows[0][channel] / coefficient_factor(scaling, 0, 0);
      double sum = 0.0;
      for (int m = -l; m <= l; ++m) {
        const double factor = coefficient_factor(scaling, l, m);
        const double value = rows[static_cast<std::size_t>(index(l, m))][channel];
        const double c = factor != 0.0 ? value / factor
                                       : (std::abs(value) <= kSlack * std::abs(rows[0][channel])
                                              ? 0.0
                                              : std::numeric_limits<double>::infinity());
        sum += c * c;
      }
      double ratio = std::sqrt(sum / (2.0 * l + 1.0)) / mean;
      if (sum == 0.0) ratio = 0.0;
      if (!(mean >= 0.0)) ratio = std::numeric_limits<double>::infinity();  // no light has a negative mean
      if (ratio > bound.ratio) {
        bound.ratio = ratio;
        bound.degree = l;
      }
    }
  }
  bound.is_excluded = !(bound.ratio <= 1.0 + kSlack);
  return bound;
}

}  // namespace

std::vector<Bound> passive_bounds(std::span<const double> values) {
  const std::string fault = fault_of_count(values.size());
  if (!fault.empty()) throw InputError(fault);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i]))
      throw InputError(fmt::format("number {}: not finite: {}", i + 1, values[i]));
  }
  std::vector<Bound> bounds;
  for (const Split& split : splits_of(values.size())) {
    const std::vector<RgbD> rows = rows_of(values, split);
    for (const Convention& scaling : scalings(split.bands, Freedom::scale)) {
      const bool is_scaled_radiance =
          scaling.quantity == Quantity::radiance_over_pi || scaling.quantity == Quantity::radiance_over_4pi;
      const bool is_scaled_irradiance = scaling.quantity == Quantity::irradiance_over_pi ||
                                        scaling.quantity == Quantity::irradiance_over_pi_twice;
      const bool is_scaled = scaling.normalization == Normalization::four_pi;
      // Up to a scale these are others'.
      if (is_scaled_radiance || is_scaled_irradiance || is_scaled) continue;
      bounds.push_back(bound_of(rows, scaling, split));
    }
  }
  return bounds;
}

}  // namespace plumbline::sh
