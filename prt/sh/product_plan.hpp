// prt/sh/product_plan.hpp: in which order a product for bands known at compile time does its work.
// Inside the library only: product.hpp is the interface.
// After Snyder's factoring (tripling.hpp [2]), worked out by the compiler.
#pragma once

#include <array>
#include <cstddef>
#include <utility>

#include "prt/sh/tripling.hpp"

namespace plumbline::sh::detail {

// The product needs, for every tripling coefficient G of three different i, j, k,
//
//   c_i += G (a_j b_k + a_k b_j),   c_j += G (a_i b_k + a_k b_i),   c_k += G (a_i b_j + a_j b_i).
//
// Coefficients that share a pair (i, j) share work. Over all k of the pair, with s = sum_k G_k a_k and
// t = sum_k G_k b_k:
//
//   u = a_i b_j + a_j b_i;   c_k += G_k u;   c_i += s b_j + t a_j;   c_j += s b_i + t a_i.
//
// Three multiplications a coefficient instead of nine. With j = i, u = a_i b_i and c_i += s b_i + t a_i. A
// coefficient (i, i, k) may join the pair (i, k) at half its value, as k' = i. (i, i, i) is c_i += G u at
// the pair (i, i), without s and t. The pair to treat next is always the one that the most remaining
// coefficients share, which gives Snyder's counts.
//
// i = 0 is special, every (0, i, i) has G = 1/sqrt(4 pi): c_i = G (a_0 b_i + a_i b_0), c_0 = G sum a_i b_i.

inline constexpr double kInverseRootFourPi = 0.282094791773878143474039725780386293;

/// Number of coefficients (i, j, k), i <= j <= k, i > 0, that are not 0.
[[nodiscard]] constexpr int plan_size(int bands) {
  constexpr std::array<int, 7> kUnique{0, 1, 4, 25, 77, 238, 549};
  return kUnique[static_cast<std::size_t>(bands)] - bands * bands;
}

struct PlanEntry {
  int k = 0;
  float value_f = 0.0F;  // each type's own rounding
  double value = 0.0;
  bool is_cube = false;  // (i, i, i)
};
struct PlanGroup {
  int i = 0;
  int j = 0;
  int begin = 0;
  int end = 0;
};

template <int kBands>
struct Plan {
  static constexpr int kSize = plan_size(kBands);
  std::array<PlanEntry, static_cast<std::size_t>(kSize > 0 ? kSize : 1)> entries{};
  std::array<PlanGroup, static_cast<std::size_t>(kSize > 0 ? kSize : 1)> groups{};
  int group_count = 0;
};

template <int kBands>
[[nodiscard]] constexpr auto plan_triplings() {
  std::array<Tripling, static_cast<std::size_t>(plan_size(kBands))> list{};
  std::size_t size = 0;
  constexpr int kCount = kBands * kBands;
  for (int i = 1; i < kCount; ++i) {
    const DegreeAndM a = degree_and_m(i);
    for (int j = i; j < kCount; ++j) {
      const DegreeAndM b = degree_and_m(j);
      for (int l = b.degree; l < kBands && l <= a.degree + b.degree; ++l) {
        if ((a.degree + b.degree + l) % 2 != 0) continue;
        const int sum = magnitude(a.m) + magnitude(b.m);
        const int difference = magnitude(magnitude(a.m) - magnitude(b.m));
        std::array<int, 4> candidates{-sum, -difference, difference, sum};
        for (std::size_t c = 0; c < 4; ++c) {
          if (c > 0 && candidates[c] == candidates[c - 1]) continue;
          if (magnitude(candidates[c]) > l) continue;
          const int k = l * (l + 1) + candidates[c];
          if (k < j) continue;
          const double value = real_tripling(a, b, {l, candidates[c]});
          if (value != 0.0) list[size++] = {i, j, k, value};
        }
      }
    }
  }
  return list;
}

/// How many of `list` not yet used hold each pair i <= j.
template <std::size_t kSize, std::size_t kCells>
constexpr void count_pair(std::array<int, kCells>& counts, int width, const std::array<Tripling, kSize>& list,
                          std::size_t n, int step) {
  const auto cell = [width](int p, int q) { return static_cast<std::size_t>(p * width + q); };
  const Tripling& t = list[n];
  counts[cell(t.i, t.j)] += step;
  if (t.k != t.j) counts[cell(t.i, t.k)] += step;
  if (t.i != t.j) counts[cell(t.j, t.k)] += step;
}

[[nodiscard]] constexpr bool holds_pair(const Tripling& t, int p, int q) {
  return (t.i == p && (t.j == q || t.k == q)) || (t.j == p && t.k == q);
}

/// The coefficient as an entry of the pair (p, q).
[[nodiscard]] constexpr PlanEntry entry_of(const Tripling& t, int p, int q) {
  const int k = t.i + t.j + t.k - p - q;
  const bool is_half = p != q && (k == p || k == q);
  const double value = is_half ? 0.5 * t.value : t.value;
  return {k, static_cast<float>(value), value, t.i == t.k};
}

template <int kBands>
[[nodiscard]] constexpr Plan<kBands> make_plan() {
  constexpr int kWidth = kBands * kBands;
  constexpr auto kList = plan_triplings<kBands>();
  std::array<int, static_cast<std::size_t>(kWidth * kWidth)> counts{};
  std::array<bool, kList.size() + 1> used{};
  for (std::size_t n = 0; n < kList.size(); ++n) count_pair(counts, kWidth, kList, n, 1);
  Plan<kBands> plan;
  for (int placed = 0; placed < static_cast<int>(kList.size());) {
    const auto best = static_cast<int>(std::max_element(counts.begin(), counts.end()) - counts.begin());
    const int p = best / kWidth;
    const int q = best % kWidth;
    PlanGroup& group = plan.groups[static_cast<std::size_t>(plan.group_count++)];
    group = {p, q, placed, placed};
    for (std::size_t n = 0; n < kList.size(); ++n) {
      if (used[n] || !holds_pair(kList[n], p, q)) continue;
      used[n] = true;
      count_pair(counts, kWidth, kList, n, -1);
      plan.entries[static_cast<std::size_t>(placed++)] = entry_of(kList[n], p, q);
    }
    group.end = placed;
  }
  return plan;
}

template <int kBands>
inline constexpr Plan<kBands> kPlan = make_plan<kBands>();

}  // namespace plumbline::sh::detail
