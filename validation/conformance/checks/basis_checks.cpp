#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "prt/sh/quadrature.hpp"
#include "validation/checks/sh_checks.hpp"
#include "validation/conformance/check.hpp"
#include "validation/conformance/diagnosis.hpp"
#include "validation/conformance/truths.hpp"

namespace plumbline::conformance {
namespace {

constexpr const char* kBasis = "evaluate basis";
constexpr const char* kHemisphere = "hemisphere basis";

std::size_t size_of(int bands) {
  return static_cast<std::size_t>(bands) * static_cast<std::size_t>(bands);
}

/// The bands asked for, and more where there are more: mistakes like overflowing factorials need them.
std::vector<int> judged_bands(const Context& context) {
  constexpr int kMany = 12;
  const int most = context.subject.border().usable_bands(std::min(kMany, context.subject.raw().max_bands));
  if (most <= context.bands) return {context.bands};
  return {context.bands, most};
}

std::vector<Values> rows(const Values& values, std::size_t width) {
  std::vector<Values> result;
  for (auto first = values.begin(); first != values.end(); first += static_cast<std::ptrdiff_t>(width))
    result.emplace_back(first, first + static_cast<std::ptrdiff_t>(width));
  return result;
}

/// Gram matrix of the implementation's functions over nodes; expected: the unit matrix.
Pairs gram_pairs(const std::vector<Values>& y, const std::vector<sh::SphereNode>& nodes, std::size_t size) {
  Pairs pairs;
  for (std::size_t i = 0; i < size; ++i) {
    Values row(size, 0.0);
    Values unit(size, 0.0);
    unit[i] = 1.0;
    for (std::size_t k = 0; k < nodes.size(); ++k)
      for (std::size_t j = 0; j < size; ++j) row[j] += nodes[k].weight * y[k][i] * y[k][j];
    pairs.add(std::move(unit), std::move(row));
  }
  return pairs;
}

std::string place_of(std::size_t index) {
  const int l = static_cast<int>(std::sqrt(static_cast<double>(index) + 0.5));
  return fmt::format("band {}, m = {}", l, static_cast<int>(index) - l * (l + 1));
}

/// From the Gram matrix: functions of another length, then functions that are not orthogonal.
std::string gram_cause(const Pairs& gram, bool has_places) {
  const auto name = [&](std::size_t i) { return has_places ? place_of(i) : fmt::format("function {}", i); };
  std::vector<std::string> parts;
  const std::size_t size = gram.measured.size();
  double common = gram.measured[0][0];
  for (std::size_t i = 0; i < size; ++i) {
    if (!std::isfinite(gram.measured[i][i])) return fmt::format("{} is not finite", name(i));
    if (!(std::abs(gram.measured[i][i] - common) <= 1e-4 * std::abs(common))) common = std::nan("");
  }
  if (std::isfinite(common) && std::abs(common - 1.0) > 1e-4)
    parts.push_back(fmt::format("all functions are {}", in_words(std::sqrt(common))));
  for (std::size_t i = 0; i < size && std::isnan(common); ++i) {
    const double square = gram.measured[i][i];
    if (std::abs(square - 1.0) > 1e-4)
      parts.push_back(
          fmt::format("{} is {} (squared norm {:.6g})", name(i), in_words(std::sqrt(square)), square));
  }
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (std::abs(gram.measured[i][j]) > 1e-4)
        parts.push_back(
            fmt::format("{} and {} are not orthogonal ({:.4g})", name(i), name(j), gram.measured[i][j]));
  if (parts.empty()) return "a small error spread over the functions";
  constexpr std::size_t kMost = 4;
  const std::string rest = parts.size() > kMost ? fmt::format("; and {} more", parts.size() - kMost) : "";
  parts.resize(std::min(parts.size(), kMost));
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : "; ") + part;
  return text + rest;
}

std::vector<Judged> gram(const Context& context) {
  std::vector<Judged> results;
  for (const int bands : judged_bands(context)) {
    const std::vector<sh::SphereNode> nodes = sh::sphere_quadrature(bands);
    std::vector<Vec3d> directions;
    for (const sh::SphereNode& node : nodes) directions.push_back(node.direction);
    const Values y = must(context.subject.basis(bands, directions), "unit directions");
    const Pairs pairs = gram_pairs(rows(y, size_of(bands)), nodes, size_of(bands));
    const double error = pairs.error(context.ruler);
    // Values are wrong by rounding() each; their products integrate with weights that add up to 4 pi.
    const double bound = 4.0 * kPi * 2.0 * rounding(context, bands);
    results.push_back(
        judged(context, {kBasis, "Gram matrix", "Exact quadrature; rounding of the values", bands}, error,
               bound, context.ruler.accepts(error, bound) ? "" : gram_cause(pairs, true)));
  }
  return results;
}

std::vector<Judged> values(const Context& context) {
  std::vector<Judged> results;
  const std::vector<Vec3d> directions = checks::probe_directions();
  for (const int bands : judged_bands(context)) {
    const std::vector<Values> y =
        rows(must(context.subject.basis(bands, directions), "unit directions"), size_of(bands));
    Pairs pairs;
    for (std::size_t k = 0; k < directions.size(); ++k) pairs.add(truths::basis(bands, directions[k]), y[k]);
    results.push_back(
        judged_directions(context, {kBasis, "values and signs", "Definition in long double; rounding", bands},
                          directions, pairs, rounding(context, bands), 1e-5));
  }
  return results;
}

std::vector<Judged> addition_theorem(const Context& context) {
  const int bands = context.bands;
  const std::vector<Vec3d> directions = checks::probe_directions();
  const std::vector<Values> y =
      rows(must(context.subject.basis(bands, directions), "unit directions"), size_of(bands));
  Pairs pairs;
  for (std::size_t k = 1; k < directions.size(); ++k) {
    const Values a = truths::basis(bands, directions[k - 1]);
    const Values b = truths::basis(bands, directions[k]);
    Values right(static_cast<std::size_t>(bands), 0.0);
    Values sum(static_cast<std::size_t>(bands), 0.0);
    for (std::size_t l = 0; l < right.size(); ++l) {
      for (std::size_t i = l * l; i < (l + 1) * (l + 1); ++i) {
        right[l] += a[i] * b[i];
        sum[l] += y[k - 1][i] * y[k][i];
      }
    }
    pairs.add(right, sum);
  }
  const double bound = 2.0 * (2.0 * bands) * rounding(context, bands);
  return {judged_values(context,
                        {kBasis, "addition theorem", "sum over m of y y' = (2l + 1)/4 pi P_l", bands}, pairs,
                        bound, 1e-5)};
}

/// Near the poles sin^m theta is tiny: a pair +-m must keep its digits, not only its absolute size.
std::vector<Judged> poles(const Context& context) {
  // Another polar axis: its poles are elsewhere, and turning the answers to ours costs the digits in question.
  const auto& axes = context.subject.border().convention().axes;
  if (axes[2] != 0 && std::abs(axes[2]) != 3) return {};
  const int bands = context.bands;
  double worst = 0.0;
  double worst_angle = 0.0;
  int worst_m = 0;
  char worst_side = '+';
  for (double angle = 1e-1; angle > 0.5e-8; angle *= 0.1) {
    for (const double side : {1.0, -1.0}) {
      const Vec3d d(0.6 * std::sin(angle), 0.8 * std::sin(angle), side * std::cos(angle));
      const Values right = truths::basis(bands, d);
      const Values y = must(context.subject.basis(bands, {d}), "directions near the poles");
      for (int l = 1; l < bands; ++l) {
        for (int m = 1; m <= l; ++m) {
          const auto plus = static_cast<std::size_t>(l * (l + 1) + m);
          const auto minus = static_cast<std::size_t>(l * (l + 1) - m);
          const double pair = std::hypot(right[plus], right[minus]);
          const double error = std::hypot(y[plus] - right[plus], y[minus] - right[minus]) / pair;
          if (pair < 1e-290 || (context.subject.epsilon() > 1e-10 && pair < 1e-30))
            continue;  // near underflow
          const double next = context.ruler.worse(worst, error);
          if (next == worst) continue;
          worst = next;
          worst_angle = angle;
          worst_m = m;
          worst_side = side > 0.0 ? '+' : '-';
        }
      }
    }
  }
  // 4 n^2 roundings; relative, because x and y are given to full precision there.
  const double bound = 4.0 * bands * bands * context.subject.epsilon();
  const std::string cause = fmt::format(
      "digits of m > 0 are lost near the poles: {:.1g} of the pair m = +-{} at {:.0e} rad from {}z "
      "(sin theta from 1 - z^2, or from an angle close to pi?)",
      worst, worst_m, worst_angle, worst_side);
  return {judged(context,
                 {kBasis, "digits near the poles", "Relative to each pair +-m: 4 n^2 roundings", bands},
                 worst, bound, cause)};
}

/// Radiance of unit integral from z = 1 side of the hemisphere.
std::vector<Judged> hemisphere_gram(const Context& context) {
  const int bands = std::min(context.bands, 4);
  const std::size_t size = size_of(bands);
  const sh::GaussLegendre rule = sh::gauss_legendre(4 * bands);
  const int columns = 8 * bands;
  std::vector<sh::SphereNode> nodes;
  std::vector<Vec3d> directions;
  for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
    const double z = 0.5 * (1.0 + rule.nodes[k]);
    for (int c = 0; c < columns; ++c) {
      const double phi = 2.0 * kPi * (c + 0.5) / columns;
      const double r = std::sqrt((1.0 - z) * (1.0 + z));
      directions.emplace_back(r * std::cos(phi), r * std::sin(phi), z);
      nodes.push_back({directions.back(), 0.5 * rule.weights[k] * 2.0 * kPi / columns});
    }
  }
  const Values y = must(context.subject.hemisphere_basis(bands, directions), "directions of the hemisphere");
  const Pairs pairs = gram_pairs(rows(y, size), nodes, size);
  const double error = pairs.error(context.ruler);
  // Functions of a hemisphere are sqrt(2) larger and twice as steep; odd m of some are roots, which the rule's
  // 16 n nodes a ring and 4 n rings integrate to 1e-6.
  const double bound = 1e-6 + 100.0 * rounding(context, bands);
  return {judged(context, {kHemisphere, "Gram matrix over z > 0", "Quadrature over the hemisphere", bands},
                 error, bound, context.ruler.accepts(error, bound) ? "" : gram_cause(pairs, false))};
}

bool has_basis(const Implementation& i) {
  return i.evaluate_basis != nullptr;
}
bool has_hemisphere(const Implementation& i) {
  return i.evaluate_hemisphere_basis != nullptr;
}

}  // namespace

std::vector<Check> basis_checks() {
  return {{kBasis, "Gram matrix", has_basis, true, gram},
          {kBasis, "values and signs", has_basis, true, values},
          {kBasis, "addition theorem", has_basis, true, addition_theorem},
          {kBasis, "digits near the poles", has_basis, true, poles},
          {kHemisphere, "Gram matrix over z > 0", has_hemisphere, false, hemisphere_gram}};
}

}  // namespace plumbline::conformance
