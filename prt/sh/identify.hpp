// prt/sh/identify.hpp: which convention a set of coefficients is in.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "prt/sh/convention.hpp"

namespace plumbline::sh {

/// Identification looks at no more bands than these.
inline constexpr int kMostIdentifiedBands = 10;
/// A light of at least so many bands is also held against functions on a hemisphere, which see all bands.
inline constexpr int kBandsForHalfFunctions = 16;

/// Natural logarithm of the odds, 10^4 : 1, by which the best convention must beat the next.
inline constexpr double kDecisiveLogOdds = 9.210340371976184;
/// Relative difference (root mean square) that no answer is built on: sums in single precision.
inline constexpr double kNoiseFloor = 1e-6;

/// Conventions that give the same numbers for every light, at this number of bands.
struct Candidate {
  std::vector<Convention> readings;   // the simplest first; e.g. Condon-Shortley, or positive and half a turn
  std::vector<std::string> known;     // names of known_conventions() among them
  bool is_one_channel = false;        // n^2 numbers for one channel; the layout is then planar or cosine_sine
  int bands = 0;                      // 0 for functions on a hemisphere
  double scale = 1.0;                 // the numbers are the convention's times this, where 1 does not fit
  double residual = 0.0;              // root mean square of the differences over that of the numbers
  double log_odds_behind_best = 0.0;  // >= 0
};

enum class Verdict {
  identified,   // one candidate explains the numbers, all others are far behind
  undecided,    // several explain them
  unexplained,  // none does
};

struct Identification {
  Verdict verdict = Verdict::unexplained;
  std::vector<Candidate> ranking;         // best first, at most kRanked
  std::size_t tied = 0;                   // candidates that explain the numbers equally well
  std::vector<std::string> undecided;     // what they differ in, one line each
  std::vector<std::string> would_decide;  // and what would tell them apart
  static constexpr std::size_t kRanked = 3;
};

/// Holds the numbers against every convention: 4 arrangements, 48 signed axes with 2 signs, normalisations,
/// quantities and layouts, then the same up to one unknown scale, then with an unknown factor a degree (a window),
/// and functions on a hemisphere where `light` has kBandsForHalfFunctions. A step is taken only when the one before
/// does not explain the numbers. The noise is estimated from the best candidate's residual; candidates within
/// kDecisiveLogOdds of it (n^2 independent numbers, whatever the channels) are tied.
/// @param values  as many as some convention takes, finite
/// @param light   what was projected, in our convention; splits of the numbers into more bands are left out
/// @throws InputError for a number of values that no layout has, a non-finite one, or too few bands of light
[[nodiscard]] Identification identify(std::span<const double> values, const ShRgb& light);

/// What a set of numbers alone excludes: a light that is nowhere negative has, in every degree,
/// sum over m of c_lm^2 <= (2l + 1) c_00^2 (|P_l| <= 1), whatever its sign, axes and arrangement.
struct Bound {
  Convention convention;  // only normalisation, role, quantity and layout matter
  bool is_one_channel = false;
  int bands = 0;
  int degree = 0;      // the one that comes closest to its bound, or goes farthest beyond
  double ratio = 0.0;  // sqrt(sum c_lm^2 / (2l + 1)) / c_00 there: above 1 is impossible
  bool is_excluded = false;
};
/// @throws InputError as identify
[[nodiscard]] std::vector<Bound> passive_bounds(std::span<const double> values);

/// Why no convention has that many numbers; empty where one has.
[[nodiscard]] std::string fault_of_count(std::size_t count);
/// Whether functions on a hemisphere make so many numbers: a light of kBandsForHalfFunctions is then worth having.
[[nodiscard]] bool is_half_count(std::size_t count);

/// How the numbers of a count can be split: layouts and bands. Empty where no layout has that many.
struct Split {
  Layout layout = Layout::interleaved;
  bool is_one_channel = false;
  int bands = 0;
};
[[nodiscard]] std::vector<Split> splits_of(std::size_t count);
/// n^2 rows; one channel is repeated three times. @throws InputError when the split is not one of their number
[[nodiscard]] std::vector<RgbD> rows_of(std::span<const double> values, const Split& split);

}  // namespace plumbline::sh
