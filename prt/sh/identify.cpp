#include "prt/sh/identify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "prt/sh/convention_layout.hpp"
#include "prt/sh/identify_trials.hpp"
#include "prt/sh/identify_words.hpp"
#include "reference/base/error.hpp"

namespace plumbline::sh {
namespace {

/// Part of the squares beside degree 0 that the best convention may leave over.
constexpr double kUnexplainedPart = 0.1;
/// Maps whose fingerprints differ by less are the same: rounding is 1e-14, chance 1e-5 for ten thousand maps.
constexpr double kSameFingerprint = 1e-10;

constexpr std::array kLayouts{Layout::interleaved, Layout::planar, Layout::rgba,         Layout::splat,
                              Layout::cosine_sine, Layout::packed, Layout::packed_square};

void require_usable(std::span<const double> values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i]))
      throw InputError(fmt::format("number {}: not finite: {}", i + 1, values[i]));
  }
  const std::string fault = fault_of_count(values.size());
  if (!fault.empty()) throw InputError(fault);
}

// ---------------------------------------------------------------- trials

/// One channel of which nobody says how it came about: luminance, mean, red, green, blue.
std::vector<ShRgb> one_channel_lights(const ShRgb& light) {
  const std::array<RgbD, 5> weights{RgbD(0.2126, 0.7152, 0.0722), RgbD(1.0 / 3.0), RgbD(1.0, 0.0, 0.0),
                                    RgbD(0.0, 1.0, 0.0), RgbD(0.0, 0.0, 1.0)};
  std::vector<ShRgb> lights;
  for (const RgbD& weight : weights) {
    lights.push_back(light);
    for (RgbD& c : lights.back().coefficients) c = RgbD(glm::dot(weight, c));
  }
  return lights;
}

double best_of(const std::vector<Trial>& trials) {
  double best = std::numeric_limits<double>::infinity();
  for (const Trial& trial : trials) best = std::min(best, trial.squared_residual);
  return best;
}

std::vector<Trial> trials_of(std::span<const double> values, const Split& split, const ShRgb& light,
                             Freedom freedom) {
  if (!split.is_one_channel) {
    return sphere_trials(values, split, turned_lights(light, split.bands), freedom);
  }
  std::vector<Trial> best;
  for (const ShRgb& channel : one_channel_lights(light)) {
    std::vector<Trial> trials = sphere_trials(values, split, turned_lights(channel, split.bands), freedom);
    if (best.empty() || best_of(trials) < best_of(best)) best = std::move(trials);
  }
  return best;
}

/// All trials of one freedom, best first.
std::vector<Trial> sorted_trials(std::span<const double> values, const ShRgb& light, Freedom freedom) {
  std::vector<Trial> all;
  for (const Split& split : splits_of(values.size())) {
    if (split.bands > light.bands) continue;
    std::vector<Trial> trials = trials_of(values, split, light, freedom);
    std::move(trials.begin(), trials.end(), std::back_inserter(all));
  }
  const bool sees_all = light.bands >= kBandsForHalfFunctions && freedom == Freedom::none;
  if (sees_all && is_half_count(values.size())) {
    std::vector<Trial> trials = half_trials(values, turned_lights(light, light.bands));
    std::move(trials.begin(), trials.end(), std::back_inserter(all));
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Trial& a, const Trial& b) { return a.squared_residual < b.squared_residual; });
  return all;
}

/// Gaussian noise of unknown size: the likelihood falls as residual^-rows.
double log_odds(const Trial& best, const Trial& other) {
  const double floor = kNoiseFloor * kNoiseFloor;
  return 0.5 * static_cast<double>(best.rows) *
         std::log((other.squared_residual + floor) / (best.squared_residual + floor));
}

/// No freedom could bring the residual below zero: whether even that would not be far ahead of the best trial.
bool is_at_noise(const Trial& best) {
  Trial perfect = best;
  perfect.squared_residual = 0.0;
  return log_odds(perfect, best) <= kDecisiveLogOdds;
}

/// The least freedom whose best trial is not far behind that of more freedom.
std::vector<Trial> least_free_trials(std::span<const double> values, const ShRgb& light) {
  std::vector<Trial> kept = sorted_trials(values, light, Freedom::none);
  for (const Freedom freedom : {Freedom::scale, Freedom::degrees}) {
    if (is_at_noise(kept.front())) break;
    std::vector<Trial> freer = sorted_trials(values, light, freedom);
    if (freer.empty()) continue;
    const bool is_needed = log_odds(freer.front(), kept.front()) > kDecisiveLogOdds;
    if (is_needed) kept = std::move(freer);
  }
  return kept;
}

// ---------------------------------------------------------------- candidates: trials that are one map

struct Group {
  std::vector<Trial> trials;
};

/// Equal maps together, in the order of their best trial: all that are tied with the best, and at least `least`.
std::vector<Group> grouped(const std::vector<Trial>& trials, std::size_t least) {
  std::vector<Group> groups;
  std::multimap<double, std::pair<double, std::size_t>> places;
  for (const Trial& trial : trials) {
    const bool is_tied = log_odds(trials.front(), trial) < kDecisiveLogOdds;
    if (!is_tied && groups.size() >= least) break;
    const Fingerprint print = fingerprint(trial.convention, trial.split, trial.scale);
    std::size_t place = groups.size();
    for (auto it = places.lower_bound(print[0] - kSameFingerprint);
         it != places.end() && it->first <= print[0] + kSameFingerprint; ++it) {
      if (std::abs(it->second.first - print[1]) <= kSameFingerprint) place = it->second.second;
    }
    if (place == groups.size()) {
      groups.emplace_back();
      places.emplace(print[0], std::pair{print[1], place});
    }
    groups[place].trials.push_back(trial);
  }
  return groups;
}

/// Half a turn about z is the Condon-Shortley sign: y_lm(-x, -y, z) = (-1)^m y_lm(x, y, z).
Convention with_positive_sign(Convention convention) {
  convention.sign = Sign::positive;
  convention.axes = combined(convention.axes, {{0, 1, 2}, {-1, -1, 1}});
  return convention;
}

struct KnownPrint {
  const KnownConvention* known = nullptr;
  Fingerprint print{};
};

/// The known conventions that a split can hold, as their fingerprints at scale 1.
std::vector<KnownPrint> known_prints(const Trial& trial) {
  std::vector<KnownPrint> prints;
  for (const KnownConvention& known : known_conventions()) {
    Convention convention = known.convention;
    const bool is_half = convention.functions != Functions::sphere;
    const bool is_list = convention.layout != Layout::packed && convention.layout != Layout::packed_square &&
                         convention.layout != Layout::cosine_sine;
    if (trial.split.is_one_channel && is_list)
      convention.layout = Layout::planar;  // one list, whatever of three
    if (is_half != (trial.split.bands == 0) || trial.split.bands > known.max_bands) continue;
    if (!is_packable(convention.layout, trial.rows)) continue;
    prints.push_back({&known, fingerprint(convention, trial.split, 1.0)});
  }
  return prints;
}

bool is_same(const Fingerprint& a, const Fingerprint& b) {
  return std::abs(a[0] - b[0]) <= kSameFingerprint && std::abs(a[1] - b[1]) <= kSameFingerprint;
}

struct Reading {
  Convention convention;
  double scale = 1.0;
};

/// What a group's trials say, in both signs, the plainest first.
std::vector<Reading> readings_of(const Group& group) {
  std::vector<Reading> readings;
  for (const Trial& trial : group.trials) {
    readings.push_back({trial.convention, trial.scale});
    readings.push_back({with_positive_sign(trial.convention), trial.scale});
  }
  std::stable_sort(readings.begin(), readings.end(), [](const Reading& a, const Reading& b) {
    return complexity(a.convention) < complexity(b.convention);
  });
  return readings;
}

/// A known convention's own reading comes first.
Candidate candidate_of(const Group& group, const Trial& best, const std::vector<KnownPrint>& prints) {
  const Trial& first = group.trials.front();
  Candidate candidate;
  candidate.is_one_channel = first.split.is_one_channel;
  candidate.bands = first.split.bands;
  candidate.residual = std::sqrt(first.squared_residual);
  candidate.log_odds_behind_best = std::max(0.0, log_odds(best, first));
  const std::vector<Reading> readings = readings_of(group);
  candidate.scale = readings.front().scale;
  Fingerprint print = fingerprint(first.convention, first.split, first.scale / candidate.scale);
  for (const KnownPrint& known : prints) {
    if (!is_same(known.print, print)) continue;
    if (candidate.known.empty()) {
      candidate.readings.push_back(known.known->convention);
      candidate.readings.back().layout = first.split.layout;
    }
    candidate.known.push_back(known.known->name);
  }
  for (const Reading& reading : readings) {
    const bool is_new =
        candidate.readings.empty() || !is_same_reading(reading.convention, candidate.readings.front());
    const bool is_of_scale = std::abs(reading.scale / candidate.scale - 1.0) <= kSameFingerprint;
    if (is_new && is_of_scale) candidate.readings.push_back(reading.convention);
  }
  return candidate;
}

std::vector<Candidate> candidates_of(const std::vector<Trial>& trials) {
  std::map<std::pair<int, bool>, std::vector<KnownPrint>> prints;
  std::vector<Candidate> candidates;
  for (const Group& group : grouped(trials, Identification::kRanked)) {
    const Trial& first = group.trials.front();
    const std::pair key(first.split.bands, first.split.is_one_channel);
    if (!prints.contains(key)) prints.emplace(key, known_prints(first));
    candidates.push_back(candidate_of(group, trials.front(), prints.at(key)));
  }
  return candidates;
}

/// Of those that fit equally well: known ones first, then the plainest.
bool is_plainer(const Candidate& a, const Candidate& b) {
  if (a.known.empty() != b.known.empty()) return b.known.empty();
  return complexity(a.readings.front()) < complexity(b.readings.front());
}

bool is_explained(const Trial& best) {
  return best.squared_residual <= kUnexplainedPart * best.squared_variation + kNoiseFloor * kNoiseFloor;
}

}  // namespace

std::string fault_of_count(std::size_t count) {
  if (!splits_of(count).empty()) return "";
  return fmt::format(
      "{} numbers: expected n^2 (one channel), 3 n^2 (red, green, blue), 4 n^2, 2 n^2 or 6 n^2 (SHTOOLS), or "
      "28 "
      "(packed for shaders), n = 1 to {}",
      count, kMostIdentifiedBands);
}

std::vector<Split> splits_of(std::size_t count) {
  std::vector<Split> splits;
  for (int bands = 1; bands <= kMostIdentifiedBands; ++bands) {
    const auto rows = static_cast<std::size_t>(coefficient_count(bands));
    for (const Layout layout : kLayouts) {
      if (!is_packable(layout, rows)) continue;
      const std::size_t whole = packed_count(layout, rows);
      if (whole == count) splits.push_back({layout, false, bands});
      const bool has_channels = layout == Layout::planar || layout == Layout::cosine_sine;
      if (has_channels && whole == 3 * count) splits.push_back({layout, true, bands});
    }
  }
  return splits;
}

std::vector<RgbD> rows_of(std::span<const double> values, const Split& split) {
  const auto rows = static_cast<std::size_t>(coefficient_count(split.bands));
  if (!split.is_one_channel) return unpacked_rows(values, split.layout, rows);
  std::vector<double> three;
  for (int channel = 0; channel < 3; ++channel) three.insert(three.end(), values.begin(), values.end());
  return unpacked_rows(three, split.layout, rows);
}

Identification identify(std::span<const double> values, const ShRgb& light) {
  require_usable(values);
  const std::vector<Split> splits = splits_of(values.size());
  const bool is_enough = std::any_of(splits.begin(), splits.end(),
                                     [&](const Split& split) { return split.bands <= light.bands; });
  if (!is_enough) {
    throw InputError(fmt::format("sh::identify: {} numbers need a light of at least {} bands, got {}",
                                 values.size(), splits.front().bands, light.bands));
  }
  const std::vector<Trial> trials = least_free_trials(values, light);
  std::vector<Candidate> candidates = candidates_of(trials);
  Identification result;
  const auto first_behind = std::find_if(candidates.begin(), candidates.end(), [](const Candidate& c) {
    return c.log_odds_behind_best >= kDecisiveLogOdds;
  });
  std::stable_sort(candidates.begin(), first_behind, is_plainer);
  result.tied = static_cast<std::size_t>(first_behind - candidates.begin());
  if (!is_explained(trials.front())) {
    result.verdict = Verdict::unexplained;
    result.tied = 0;
  } else if (result.tied > 1) {
    result.verdict = Verdict::undecided;
    const std::span<const Candidate> tied(candidates.data(), result.tied);
    result.undecided = differences(tied);
    result.would_decide = remedies(tied, trials.front().squared_variation <= kNoiseFloor * kNoiseFloor);
  } else {
    result.verdict = Verdict::identified;
  }
  candidates.resize(std::min(candidates.size(), Identification::kRanked));
  result.ranking = std::move(candidates);
  return result;
}

}  // namespace plumbline::sh
