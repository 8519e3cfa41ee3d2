#include "validation/conformance/diagnosis.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "prt/sh/zonal.hpp"
#include "reference/base/vector.hpp"
#include "validation/conformance/border.hpp"

namespace plumbline::conformance {
namespace {

using Vectors = std::vector<std::vector<double>>;

struct NamedFactor {
  double value;
  const char* name;
};

constexpr double kSqrtPi = 1.7724538509055160273;
constexpr double kSqrt2 = 1.4142135623730950488;
constexpr std::array kFactors{NamedFactor{kPi, "pi"},
                              NamedFactor{4.0 * kPi, "4 pi"},
                              NamedFactor{2.0 * kPi, "2 pi"},
                              NamedFactor{kPi * kPi, "pi^2"},
                              NamedFactor{kSqrtPi, "sqrt(pi)"},
                              NamedFactor{2.0 * kSqrtPi, "sqrt(4 pi)"},
                              NamedFactor{2.0, "2"},
                              NamedFactor{kSqrt2, "sqrt(2)"},
                              NamedFactor{3.0, "3"},
                              NamedFactor{4.0, "4"},
                              NamedFactor{1.5, "3/2"},
                              NamedFactor{1.25, "5/4"},
                              NamedFactor{4.0 / 3.0, "4/3"},
                              NamedFactor{kPi / 2.0, "pi/2"},
                              NamedFactor{2.0 * kPi / 3.0, "2 pi/3"},
                              NamedFactor{4.0 / kPi, "4/pi"},
                              NamedFactor{8.0, "8"},
                              NamedFactor{1.7320508075688772, "sqrt(3)"},
                              NamedFactor{2.0 / kSqrtPi, "2/sqrt(pi)"}};

bool is_near(double a, double b, double relative) {
  return std::abs(a - b) <= relative * std::max(std::abs(a), std::abs(b));
}

/// What is usually behind one factor on everything.
std::string usual_reason(double factor, double tolerance) {
  const std::array<std::pair<double, const char*>, 9> reasons{{
      {1.0 / (4.0 * kPi), "a sum divided by the number of samples without 4 pi"},
      {4.0 * kPi, "4 pi applied twice"},
      {1.0 / kPi, "1/pi applied twice, or E/pi where E is asked"},
      {kPi, "1/pi is missing, or E where E/pi is asked"},
      {std::sqrt(4.0 * kPi), "4 pi norm where orthonormal was declared"},
      {1.0 / std::sqrt(4.0 * kPi), "4 pi norm where orthonormal was declared"},
      {0.5, "a stray 1/2, or a hemisphere's integral for a sphere's"},
      {2.0 / kSqrtPi, "orthonormal c_00 where 4 times the mean radiance is meant"},
      {-1.0, "negated"},
  }};
  for (const auto& [value, reason] : reasons)
    if (is_near(factor, value, tolerance)) return fmt::format(" ({})", reason);
  return {};
}

double largest(const Vectors& vectors) {
  double result = 0.0;
  for (const auto& v : vectors)
    for (const double x : v) result = std::max(result, std::abs(x));
  return result;
}

/// Largest |a - b|; NaN counts as infinite.
double distance(const Vectors& a, const Vectors& b) {
  double result = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    for (std::size_t i = 0; i < a[k].size(); ++i) {
      const double error = std::abs(a[k][i] - b[k][i]);
      result = error <= result ? result : std::isnan(error) ? HUGE_VAL : error;
    }
  }
  return result;
}

using Map = std::function<std::vector<double>(const std::vector<double>&)>;

Vectors mapped(const Vectors& vectors, const Map& map) {
  Vectors result;
  for (const auto& v : vectors) result.push_back(map(v));
  return result;
}

/// Best factor a with b = a e, over all samples.
double fitted_factor(const Vectors& expected, const Vectors& measured) {
  double num = 0.0;
  double den = 0.0;
  for (std::size_t k = 0; k < expected.size(); ++k) {
    for (std::size_t i = 0; i < expected[k].size(); ++i) {
      num += expected[k][i] * measured[k][i];
      den += expected[k][i] * expected[k][i];
    }
  }
  return den > 0.0 ? num / den : 0.0;
}

Vectors scaled(const Vectors& vectors, double factor) {
  return mapped(vectors, [factor](std::vector<double> v) {
    for (double& x : v) x *= factor;
    return v;
  });
}

bool explains(const Vectors& hypothesis, const Evidence& e) {
  const double scale = std::max(largest(hypothesis), largest(e.measured));
  return scale > 0.0 && distance(hypothesis, e.measured) <= e.tolerance * scale;
}

std::string and_factor(double factor, double tolerance) {
  return is_near(factor, 1.0, tolerance) ? "" : fmt::format(", and all is {}", in_words(factor));
}

int degree_of(std::size_t index) {
  return static_cast<int>(std::sqrt(static_cast<double>(index) + 0.5));
}
std::string place_name(std::size_t index) {
  const int l = degree_of(index);
  return fmt::format("band {}, m = {}", l, static_cast<int>(index) - l * (l + 1));
}

// ---------------------------------------------------------------- the hypotheses
using Cause = std::optional<std::string>;

Cause not_numbers(const Evidence& e) {
  std::vector<std::string> places;
  std::size_t count = 0;
  for (const auto& v : e.measured) {
    for (std::size_t i = 0; i < v.size(); ++i) {
      if (std::isfinite(v[i])) continue;
      if (++count == 1) places.push_back(fmt::format("{} is {}", place_name(i), v[i]));
    }
  }
  if (count == 0) return std::nullopt;
  return fmt::format("{} values are not finite, the first: {}", count, places.front());
}

Cause all_zero(const Evidence& e) {
  if (largest(e.measured) > 0.0) return std::nullopt;
  return "everything is 0";
}

Cause one_factor(const Evidence& e) {
  const double factor = fitted_factor(e.expected, e.measured);
  if (!explains(scaled(e.expected, factor), e)) return std::nullopt;
  return fmt::format("all values are {}{}", in_words(factor), usual_reason(factor, e.tolerance));
}

Map signs(const std::function<bool(int l, int m)>& is_negated) {
  return [is_negated](std::vector<double> v) {
    for (std::size_t i = 0; i < v.size(); ++i) {
      const int l = degree_of(i);
      if (is_negated(l, static_cast<int>(i) - l * (l + 1))) v[i] = -v[i];
    }
    return v;
  };
}

Map reordered(const std::function<int(int l, int m)>& source) {
  return [source](const std::vector<double>& v) {
    std::vector<double> result(v.size());
    for (std::size_t i = 0; i < v.size(); ++i) {
      const int l = degree_of(i);
      result[i] = v[static_cast<std::size_t>(l * (l + 1) + source(l, static_cast<int>(i) - l * (l + 1)))];
    }
    return result;
  };
}

struct NamedMap {
  Map map;
  std::string cause;
};

std::vector<NamedMap> sign_and_order_maps() {
  const auto odd = [](int m) { return m % 2 != 0; };
  return {
      {signs([odd](int, int m) { return odd(m); }),
       "odd m have the other sign: Condon-Shortley phase (or turned by 180 degrees about z)"},
      {signs([odd](int l, int) { return odd(l); }), "odd bands are negated: the direction is reversed"},
      {signs([odd](int l, int m) { return odd(m) && l == 1; }),
       "m = -1 and m = 1 of band 1 have the other sign, the higher bands are right"},
      {signs([](int l, int) { return l == 1; }), "band 1 is negated"},
      {signs([](int l, int) { return l > 0; }), "all bands above 0 are negated"},
      {signs([](int l, int) { return l == 2; }), "band 2 is negated"},
      {reordered([](int, int m) { return -m; }), "m and -m are exchanged"},
      {reordered([](int l, int m) { return l != 1    ? m
                                           : m == -1 ? 1
                                           : m == 0  ? -1
                                                     : 0; }),
       "band 1 is in the order x, y, z instead of y, z, x"},
      {reordered([](int l, int m) {
         const int place = m + l;
         return place % 2 == 1 ? (place + 1) / 2 : -place / 2;
       }),
       "within each band the order is m = 0, 1, -1, 2, -2 instead of -l ... l"},
  };
}

std::string axis_name(int axis) {
  constexpr std::array kNames{"-z", "-y", "-x", "", "x", "y", "z"};
  return kNames.at(static_cast<std::size_t>(axis + 3));
}

std::string axes_cause(const std::array<int32_t, 3>& a) {
  const std::string list =
      fmt::format("x, y, z are read as {}, {}, {}", axis_name(a[0]), axis_name(a[1]), axis_name(a[2]));
  int parity = a[0] * a[1] * a[2] > 0 ? 1 : -1;
  const std::array<int, 3> p{std::abs(a[0]), std::abs(a[1]), std::abs(a[2])};
  const bool is_even = (p[0] % 3 + 1) == p[1] && (p[1] % 3 + 1) == p[2];
  if (!is_even) parity = -parity;
  const bool is_swap = p != std::array<int, 3>{1, 2, 3};
  return fmt::format("{}: {}",
                     is_swap ? (parity > 0 ? "axes are swapped" : "axes are swapped and mirrored")
                             : (parity > 0 ? "turned by 180 degrees" : "an axis is mirrored"),
                     list);
}

std::vector<NamedMap> axis_maps(int bands) {
  std::vector<NamedMap> result;
  std::array<int32_t, 3> order{1, 2, 3};
  do {
    for (const unsigned negative : {0U, 1U, 2U, 4U, 3U, 5U, 6U, 7U}) {
      plumbline_convention convention = own_convention();
      std::array<int32_t, 3> axes = order;
      for (unsigned k = 0; k < 3; ++k)
        if ((negative >> k & 1U) != 0U) axes.at(k) = -axes.at(k);
      if (axes == std::array<int32_t, 3>{1, 2, 3}) continue;
      std::copy(axes.begin(), axes.end(), convention.axes);
      const Border border(convention, bands);
      result.push_back({[border, bands](const std::vector<double>& v) { return border.to_theirs(bands, v); },
                        axes_cause(axes)});
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return result;
}

Cause by_maps(const Evidence& e, const std::vector<NamedMap>& maps) {
  for (const NamedMap& candidate : maps) {
    const Vectors hypothesis = mapped(e.expected, candidate.map);
    const double factor = fitted_factor(hypothesis, e.measured);
    if (factor > 0.0 && explains(scaled(hypothesis, factor), e))
      return candidate.cause + and_factor(factor, std::max(e.tolerance, 1e-3));
  }
  return std::nullopt;
}

/// Factor of each band; none where a band has nothing in it.
std::vector<std::optional<double>> band_factors(const Evidence& e) {
  std::vector<std::optional<double>> result;
  const double scale = largest(e.expected);
  for (int l = 0; l < e.bands; ++l) {
    const auto part = [l](const Vectors& vectors) {
      return mapped(vectors, [l](const std::vector<double>& v) {
        return std::vector<double>(v.begin() + l * l, v.begin() + (l + 1) * (l + 1));
      });
    };
    const Vectors expected = part(e.expected);
    if (largest(expected) <= 2.0 * e.tolerance * scale) {
      result.emplace_back();
    } else {
      result.emplace_back(fitted_factor(expected, part(e.measured)));
    }
  }
  return result;
}

Vectors with_band_factors(const Evidence& e, const std::vector<std::optional<double>>& factors) {
  return mapped(e.expected, [&](std::vector<double> v) {
    for (std::size_t i = 0; i < v.size(); ++i)
      v[i] *= factors[static_cast<std::size_t>(degree_of(i))].value_or(1.0);
    return v;
  });
}

struct BandCause {
  std::function<double(int l)> factor;
  const char* text;
};

std::vector<BandCause> band_causes() {
  const auto cosine = [](int l) { return sh::clamped_cosine_factor(l); };
  const auto root = [](int l) { return std::sqrt(4.0 * kPi / (2.0 * l + 1.0)); };
  return {
      {[cosine](int l) { return cosine(l) / kPi; },
       "coefficients are those of irradiance / pi: the clamped cosine (1, 2/3, 1/4) is already in them"},
      {cosine,
       "coefficients are those of irradiance: the clamped cosine (pi, 2 pi/3, pi/4) is already in them"},
      {[cosine](int l) { return kPi / cosine(l); },
       "coefficients are those of radiance times pi: the clamped cosine's factors (1, 2/3, 1/4) are missing"},
      {[cosine](int l) { return 1.0 / cosine(l); },
       "the clamped cosine's factors (pi, 2 pi/3, pi/4) are missing"},
      {root, "sqrt(4 pi/(2l + 1)) is applied once too often"},
      {[root](int l) { return 1.0 / root(l); },
       "sqrt(4 pi/(2l + 1)) is missing: the zonal coefficient c_l used for the factor A_l"},
      {[](int l) { return std::sqrt(2.0 * l + 1.0); },
       "the norm lacks sqrt(2l + 1) (semi-Schmidt, N3D mixed up)"},
      {[](int l) { return 1.0 / std::sqrt(2.0 * l + 1.0); },
       "the norm has one sqrt(2l + 1) too few (semi-Schmidt where orthonormal was declared)"},
      {[](int l) { return 2.0 * l + 1.0; }, "the factor 2l + 1 is applied once too often"},
      {[](int l) { return l == 1 ? -1.0 : 1.0; }, "band 1 is negated"},
      {[](int l) { return l == 2 ? -1.0 : 1.0; }, "band 2 is negated"},
  };
}

Cause window_cause(const std::vector<std::optional<double>>& factors, double tolerance) {
  if (factors.size() < 3 || !factors[0] || !factors[1] || !is_near(*factors[0], 1.0, tolerance))
    return std::nullopt;
  const double lambda = (1.0 / *factors[1] - 1.0) / 4.0;
  const auto n = static_cast<double>(factors.size());
  bool is_laplacian = lambda > 0.0;
  bool is_hann = true;
  bool is_lanczos = true;
  for (std::size_t l = 1; l < factors.size(); ++l) {
    if (!factors[l]) continue;
    const auto ll = static_cast<double>(l);
    const double x = kPi * ll / n;
    is_laplacian &=
        is_near(*factors[l], 1.0 / (1.0 + lambda * ll * ll * (ll + 1.0) * (ll + 1.0)), 5.0 * tolerance);
    is_hann &= is_near(*factors[l], 0.5 * (1.0 + std::cos(x)), 5.0 * tolerance);
    is_lanczos &= is_near(*factors[l], std::sin(x) / x, 5.0 * tolerance);
  }
  if (is_laplacian) return fmt::format("windowed: factors 1/(1 + {:.4g} l^2 (l + 1)^2)", lambda);
  if (is_hann) return "windowed: Hann factors";
  if (is_lanczos) return "windowed: Lanczos factors";
  return std::nullopt;
}

bool agree(const std::vector<std::optional<double>>& factors, const BandCause& cause, double scale,
           double tolerance) {
  for (std::size_t l = 0; l < factors.size(); ++l) {
    if (!factors[l]) continue;
    const double wanted = scale * cause.factor(static_cast<int>(l));
    if (!(std::abs(*factors[l] - wanted) <= 5.0 * tolerance * std::max(std::abs(scale), std::abs(wanted))))
      return false;
  }
  return true;
}

std::string list_of_bands(const std::vector<std::optional<double>>& factors, double tolerance) {
  std::vector<std::string> parts;
  for (std::size_t l = 0; l < factors.size(); ++l) {
    if (!factors[l] || is_near(*factors[l], 1.0, tolerance)) continue;
    parts.push_back(std::abs(*factors[l]) <= tolerance
                        ? fmt::format("band {} is missing", l)
                        : fmt::format("band {} is {}", l, in_words(*factors[l])));
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}

/// One wrong band among right ones: band 0, or one of at least three.
bool is_one_band(const std::vector<std::optional<double>>& factors, double tolerance) {
  std::size_t wrong = 0;
  std::size_t known = 0;
  for (const std::optional<double>& factor : factors) {
    known += factor ? 1U : 0U;
    wrong += factor && !is_near(*factor, 1.0, 2.0 * tolerance) ? 1U : 0U;
  }
  const bool is_first = factors[0] && !is_near(*factors[0], 1.0, 2.0 * tolerance);
  return wrong == 1 && known > 1 && (is_first || known > 2) &&
         !(factors[1] && is_near(*factors[1], -1.0, tolerance));
}

Cause by_bands(const Evidence& e) {
  const std::vector<std::optional<double>> factors = band_factors(e);
  if (!explains(with_band_factors(e, factors), e)) return std::nullopt;
  if (Cause window = window_cause(factors, e.tolerance)) return window;
  if (is_one_band(factors, e.tolerance)) return list_of_bands(factors, std::max(1e-9, e.tolerance));
  for (const BandCause& cause : band_causes())
    if (agree(factors, cause, 1.0, e.tolerance)) return cause.text;
  if (factors[0]) {
    for (const BandCause& cause : band_causes()) {
      const double scale = *factors[0] / cause.factor(0);
      if (std::isfinite(scale) && agree(factors, cause, scale, e.tolerance))
        return cause.text + and_factor(scale, e.tolerance);
    }
  }
  return list_of_bands(factors, std::max(1e-9, e.tolerance));
}

/// Rows are coefficients, columns samples.
std::vector<double> row_of(const Vectors& vectors, std::size_t index) {
  std::vector<double> row;
  for (const auto& v : vectors) row.push_back(v[index]);
  return row;
}
bool is_multiple(const std::vector<double>& of, const std::vector<double>& row, double factor, double slack) {
  for (std::size_t k = 0; k < row.size(); ++k)
    if (!(std::abs(row[k] - factor * of[k]) <= slack)) return false;
  return true;
}
double norm2(const std::vector<double>& row) {
  double sum = 0.0;
  for (const double x : row) sum += x * x;
  return sum;
}

/// What happened to one coefficient.
std::string coefficient_cause(const Evidence& e, std::size_t i, double slack) {
  const std::vector<double> expected = row_of(e.expected, i);
  const std::vector<double> measured = row_of(e.measured, i);
  if (is_multiple(expected, measured, 0.0, slack)) return fmt::format("{} is missing", place_name(i));
  if (norm2(expected) > slack * slack) {
    double factor = 0.0;
    for (std::size_t k = 0; k < expected.size(); ++k) factor += expected[k] * measured[k];
    factor /= norm2(expected);
    if (is_multiple(expected, measured, factor, slack) && (e.expected.size() > 1 || std::abs(factor) > 1e-9))
      return fmt::format("{} is {}", place_name(i), in_words(factor));
  }
  for (std::size_t j = 0; j < e.expected.front().size(); ++j) {
    const std::vector<double> other = row_of(e.expected, j);
    if (j == i || norm2(other) <= slack * slack) continue;
    for (const double sign : {1.0, -1.0})
      if (is_multiple(other, measured, sign, slack))
        return fmt::format("{} holds {}{}", place_name(i), sign < 0.0 ? "minus " : "", place_name(j));
  }
  return fmt::format("{} is another function", place_name(i));
}

Cause by_coefficients(const Evidence& e) {
  const double slack = e.tolerance * largest(e.expected);
  std::vector<std::string> parts;
  std::size_t wrong = 0;
  const std::size_t count = e.expected.front().size();
  for (std::size_t i = 0; i < count; ++i) {
    if (is_multiple(row_of(e.expected, i), row_of(e.measured, i), 1.0, slack)) continue;
    if (++wrong <= 4) parts.push_back(coefficient_cause(e, i, slack));
  }
  if (wrong == 0) return "a small error spread over the values";
  if (wrong > std::max<std::size_t>(4, count / 2)) return std::nullopt;
  return fmt::format("{}{}", fmt::join(parts, "; "),
                     wrong > 4 ? fmt::format("; and {} more", wrong - 4) : "");
}

std::string worst_place(const Evidence& e) {
  double worst = 0.0;
  std::string text = "no two values agree";
  for (std::size_t k = 0; k < e.expected.size(); ++k) {
    for (std::size_t i = 0; i < e.expected[k].size(); ++i) {
      const double error = std::abs(e.expected[k][i] - e.measured[k][i]);
      if (error <= worst) continue;
      worst = error;
      text = fmt::format("largest error at {}: {:.6g} for {:.6g}", place_name(i), e.measured[k][i],
                         e.expected[k][i]);
    }
  }
  return text;
}

/// The same with fewer bands, for what costs much and needs few.
Evidence first_bands(const Evidence& e, int bands) {
  Evidence result{std::min(bands, e.bands), e.expected, e.measured, e.tolerance};
  const auto count = static_cast<std::size_t>(result.bands * result.bands);
  for (Vectors* vectors : {&result.expected, &result.measured})
    for (auto& v : *vectors) v.resize(count);
  return result;
}

}  // namespace

std::string in_words(double factor) {
  constexpr double kClose = 1e-3;
  if (is_near(factor, 1.0, 1e-6)) return "right";
  const std::string sign = factor < 0.0 ? "negated and " : "";
  const double size = std::abs(factor);
  if (is_near(size, 1.0, kClose) && factor < 0.0) return "of the wrong sign";
  for (const NamedFactor& named : kFactors) {
    if (is_near(size, named.value, kClose))
      return fmt::format("{}{} times too {}", sign, named.name, named.value > 1.0 ? "large" : "small");
    if (is_near(size, 1.0 / named.value, kClose))
      return fmt::format("{}{} times too {}", sign, named.name, named.value > 1.0 ? "small" : "large");
  }
  return size >= 1.0 ? fmt::format("{}{:.4g} times too large", sign, size)
                     : fmt::format("{}{:.4g} times what it should be", sign, size);
}

std::string diagnose(const Evidence& e) {
  if (e.expected.empty() || e.expected.front().empty()) return "nothing to compare";
  if (const Cause cause = not_numbers(e)) return *cause;
  if (const Cause cause = all_zero(e)) return *cause;
  if (explains(e.expected, e)) return "a small error, " + worst_place(e);
  if (const Cause cause = one_factor(e)) return *cause;
  if (const Cause cause = by_maps(e, sign_and_order_maps())) return *cause;
  if (const Cause cause = by_bands(e)) return *cause;
  const Evidence few = first_bands(e, 4);
  if (!explains(few.expected, few)) {
    if (const Cause cause = by_maps(few, axis_maps(few.bands))) return *cause;
  }
  if (const Cause cause = by_coefficients(e)) return *cause;
  return worst_place(e);
}

std::string diagnose_values(const std::vector<double>& expected, const std::vector<double>& measured,
                            double tolerance) {
  Evidence e{1, {}, {}, tolerance};
  for (const double v : expected) e.expected.push_back({v});
  for (const double v : measured) e.measured.push_back({v});
  for (std::size_t i = 0; i < measured.size(); ++i)
    if (!std::isfinite(measured[i]))
      return fmt::format("a value is {} where {:.6g} is right", measured[i], expected[i]);
  if (const Cause cause = all_zero(e)) return *cause;
  if (const Cause cause = one_factor(e)) return *cause;
  std::size_t worst = 0;
  const auto error = [&](std::size_t i) { return std::abs(measured[i] - expected[i]); };
  for (std::size_t i = 1; i < measured.size(); ++i)
    if (error(i) > error(worst)) worst = i;
  return fmt::format("{:.6g} where {:.6g} is right", measured[worst], expected[worst]);
}

}  // namespace plumbline::conformance
