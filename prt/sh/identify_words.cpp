#include "prt/sh/identify_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace plumbline::sh {
namespace {

/// The choices as words; sign and axes are one: half a turn about z is the Condon-Shortley sign.
enum Choice : std::size_t { kArrangement, kSignAndAxes, kScaling, kQuantity, kLayout, kChoices };
constexpr std::array<const char*, kChoices> kNames{"arrangement", "sign and axes", "normalisation",
                                                   "quantity", "layout"};
using Words = std::array<std::string, kChoices>;

Words words_of(const Convention& c) {
  std::string quantity = to_string(c.quantity);
  if (c.functions != Functions::sphere) quantity += " by " + to_string(c.functions);
  return {to_string(c.arrangement), to_string(c.sign) + " with " + to_string(c.axes),
          to_string(c.normalization, c.role), quantity, to_string(c.layout)};
}

std::size_t distance(const Words& a, const Words& b) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < kChoices; ++i) count += a[i] == b[i] ? 0U : 1U;
  return count;
}

/// For each choice, what stands in place of the first candidate's.
std::array<std::vector<std::string>, kChoices> alternatives(std::span<const Candidate> tied) {
  std::array<std::vector<std::string>, kChoices> result;
  const Words first = words_of(tied.front().readings.front());
  for (const Candidate& candidate : tied.subspan(1)) {
    Words nearest = words_of(candidate.readings.front());
    for (const Convention& reading : candidate.readings) {
      const Words words = words_of(reading);
      if (distance(words, first) < distance(nearest, first)) nearest = words;
    }
    for (std::size_t i = 0; i < kChoices; ++i) {
      const bool is_new = std::find(result[i].begin(), result[i].end(), nearest[i]) == result[i].end();
      if (nearest[i] != first[i] && is_new) result[i].push_back(nearest[i]);
    }
  }
  return result;
}

/// "known as: A, B (one map) | C (another)"
std::string known_line(std::span<const Candidate> tied) {
  std::string line;
  for (const Candidate& candidate : tied) {
    if (candidate.known.empty()) continue;
    line += (line.empty() ? "known as: " : " | ") + fmt::format("{}", fmt::join(candidate.known, ", "));
  }
  return line;
}

}  // namespace

int complexity(const Convention& c) {
  int cost = 0;
  if (c.arrangement != Arrangement::ascending) cost += 200;
  if (c.axes.axis != std::array<int, 3>{0, 1, 2}) cost += 40;
  for (const int sign : c.axes.sign) cost += sign < 0 ? 20 : 0;
  if (is_mirrored(c.axes)) cost += 10;
  if (c.normalization != Normalization::orthonormal) cost += 100 + static_cast<int>(c.normalization);
  if (c.role == Role::projection) cost += 2;
  cost += 12 * static_cast<int>(c.quantity);
  if (c.layout != Layout::interleaved) cost += 1;
  if (c.sign == Sign::positive) cost += 1;
  return cost;
}

bool is_same_reading(const Convention& a, const Convention& b) {
  return a.arrangement == b.arrangement && a.sign == b.sign && a.normalization == b.normalization &&
         a.role == b.role && a.axes == b.axes && a.quantity == b.quantity && a.layout == b.layout &&
         a.functions == b.functions;
}

std::vector<std::string> differences(std::span<const Candidate> tied) {
  constexpr std::size_t kShown = 3;
  const auto others = alternatives(tied);
  const Words first = words_of(tied.front().readings.front());
  std::vector<std::string> lines;
  const std::string known = known_line(tied);
  if (!known.empty()) lines.push_back(known);
  for (std::size_t i = 0; i < kChoices; ++i) {
    if (others[i].empty()) continue;
    std::string line = fmt::format("{}: {}", kNames[i], first[i]);
    for (std::size_t k = 0; k < std::min(kShown, others[i].size()); ++k) line += " | " + others[i][k];
    if (others[i].size() > kShown) line += fmt::format(" | and {} more", others[i].size() - kShown);
    lines.push_back(line);
  }
  return lines;
}

std::vector<std::string> remedies(std::span<const Candidate> tied, bool is_uniform) {
  const auto others = alternatives(tied);
  std::vector<std::string> lines;
  if (is_uniform) {
    lines.emplace_back(
        "everything: a light that is not the same from everywhere (these numbers hold degree 0 only)");
  }
  if (!others[kArrangement].empty() || !others[kSignAndAxes].empty()) {
    lines.emplace_back(
        "sign, axes and arrangement: a light without symmetry, e.g. one directional light from (2, 3, 6)/7, "
        "whose "
        "three components differ");
  }
  if (!others[kScaling].empty() || !others[kQuantity].empty()) {
    lines.emplace_back("normalisation and quantity: a light with power in every degree, and more bands");
  }
  if (!others[kLayout].empty()) lines.emplace_back("layout: a light whose red, green and blue differ");
  return lines;
}

}  // namespace plumbline::sh
