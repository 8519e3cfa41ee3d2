// prt/sh/identify_trials.hpp: every convention that identify tries, and how well each fits.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "prt/sh/identify.hpp"

namespace plumbline::sh {

/// How much of a trial is taken from the numbers themselves.
enum class Freedom { none, scale, degrees };

/// One convention held against the numbers. The sign is always Condon-Shortley: positive functions are those with
/// half a turn about z.
struct Trial {
  Convention convention;
  Split split;  // bands 0: functions on a hemisphere
  double scale = 1.0;
  double squared_residual = 0.0;   // over the squared numbers
  double squared_variation = 0.0;  // what is not degree 0 (or the first function), over the squared numbers
  std::size_t rows = 0;            // n^2, or the number of functions
};

/// `light` in all 48 axes, in the order of all_signed_axes(), at most `bands` bands.
[[nodiscard]] std::vector<ShRgb> turned_lights(const ShRgb& light, int bands);

/// @param lights  turned_lights with the split's bands
[[nodiscard]] std::vector<Trial> sphere_trials(std::span<const double> values, const Split& split,
                                               const std::vector<ShRgb>& lights, Freedom freedom);
/// Functions on a hemisphere. @param lights  turned_lights with all the bands there are
[[nodiscard]] std::vector<Trial> half_trials(std::span<const double> values,
                                             const std::vector<ShRgb>& lights);

/// Two sums that tell maps apart: of the numbers that the convention makes of a light of random numbers.
using Fingerprint = std::array<double, 2>;
[[nodiscard]] Fingerprint fingerprint(const Convention& convention, const Split& split, double scale);

/// Normalisations, roles and quantities, each with every other; radiance_minus_half only without freedom, and only
/// normalisations with a factor per degree of their own (custom quantity) with freedom `degrees`.
[[nodiscard]] std::vector<Convention> scalings(int bands, Freedom freedom);

}  // namespace plumbline::sh
