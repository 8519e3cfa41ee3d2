#include "prt/sh/identify_trials.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>

#include "prt/sh/convention_layout.hpp"
#include "prt/sh/half_functions.hpp"
#include "reference/base/error.hpp"

namespace plumbline::sh {
namespace {

constexpr std::array kArrangements{Arrangement::ascending, Arrangement::descending, Arrangement::xyz,
                                   Arrangement::zero_first};
constexpr std::array kHalfFunctions{Functions::h_basis_4, Functions::h_basis_6, Functions::h_basis_4_half_dc,
                                    Functions::cosine_lightmap};
/// Residual of a convention for which no positive factor is near the numbers.
constexpr double kHopeless = std::numeric_limits<double>::infinity();
constexpr std::array kHalfLayouts{Layout::interleaved, Layout::planar, Layout::rgba};

double squared(const RgbD& v) {
  return glm::dot(v, v);
}
double squared(const std::vector<RgbD>& rows) {
  double sum = 0.0;
  for (const RgbD& row : rows) sum += squared(row);
  return sum;
}

/// The numbers' rows with their sizes.
struct Target {
  std::vector<RgbD> rows;
  double size = 0.0;       // squared
  double variation = 0.0;  // squared, without the first row
};
Target target_of(std::vector<RgbD> rows) {
  const double size = squared(rows);
  const double variation = size - squared(rows[0]);
  return {std::move(rows), size, variation};
}

double fraction(double part, double whole) {
  if (whole > 0.0) return part / whole;
  return part > 0.0 ? 1.0 : 0.0;
}

/// What a convention would make of the light, before any free factor: value of (l, m) at its place.
std::vector<RgbD> expected_rows(const ShRgb& light, const Convention& convention,
                                const std::vector<double>& factors, const std::vector<std::size_t>& places) {
  std::vector<RgbD> rows(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) rows[places[i]] = factors[i] * light.coefficients[i];
  if (convention.quantity == Quantity::radiance_minus_half) rows[0] -= RgbD(factors[0] * std::sqrt(kPi));
  return rows;
}

/// Least squares: the factor that brings `from` nearest to `to` in places [begin, end). None below the noise floor: a
/// factor that is zero or negative explains nothing.
std::optional<double> fitted(const std::vector<RgbD>& from, const Target& to, std::size_t begin,
                             std::size_t end) {
  double product = 0.0;
  double size = 0.0;
  for (std::size_t i = begin; i < end; ++i) {
    product += glm::dot(from[i], to.rows[i]);
    size += squared(from[i]);
  }
  if (!(product > 0.0 && size > 0.0)) return std::nullopt;
  const bool is_noise = product <= kNoiseFloor * std::sqrt(size * to.size);
  return is_noise ? std::nullopt : std::optional(product / size);
}

/// Takes a factor for each range of rows from the numbers; false where there is none.
bool fit_factors(std::vector<RgbD>& expected, const Target& target, const std::vector<std::size_t>& limits,
                 std::vector<double>& factors) {
  for (std::size_t k = 0; k + 1 < limits.size(); ++k) {
    const std::optional<double> factor = fitted(expected, target, limits[k], limits[k + 1]);
    if (!factor) return false;
    factors.push_back(*factor);
    for (std::size_t i = limits[k]; i < limits[k + 1]; ++i) expected[i] *= *factor;
  }
  return true;
}

/// Takes what is free from the numbers, and measures what remains.
void fit(Trial& trial, std::vector<RgbD>& expected, const Target& target, Freedom freedom) {
  std::vector<std::size_t> limits{0};  // where ranges with a factor of their own end
  if (freedom == Freedom::scale) limits.push_back(expected.size());
  if (freedom == Freedom::degrees) {
    for (std::size_t l = 1; l * l <= expected.size(); ++l) limits.push_back(l * l);
  }
  std::vector<double> factors;
  const bool is_fitted = fit_factors(expected, target, limits, factors);
  if (freedom == Freedom::scale && is_fitted) trial.scale = factors.front();
  if (freedom == Freedom::degrees) trial.convention.factors = factors;
  double residual = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) residual += squared(target.rows[i] - expected[i]);
  trial.squared_residual = is_fitted ? fraction(residual, target.size) : kHopeless;
  trial.squared_variation = fraction(target.variation, target.size);
  trial.rows = expected.size();
}

std::vector<double> factors_of(Convention convention, int bands) {
  if (convention.quantity == Quantity::custom)
    convention.factors.assign(static_cast<std::size_t>(bands), 1.0);
  std::vector<double> factors;
  for (int l = 0; l < bands; ++l) {
    for (int m = -l; m <= l; ++m) factors.push_back(coefficient_factor(convention, l, m));
  }
  return factors;
}

std::vector<std::size_t> places_of(Arrangement arrangement, int bands) {
  std::vector<std::size_t> places;
  for (int l = 0; l < bands; ++l) {
    for (int m = -l; m <= l; ++m) places.push_back(static_cast<std::size_t>(position(arrangement, l, m)));
  }
  return places;
}

/// The light of random numbers, always the same, every degree of one size.
ShRgb random_light(int bands) {
  std::mt19937 bits(20041U);
  ShRgb light{bands, {}};
  for (int i = 0; i < coefficient_count(bands); ++i) {
    const auto next = [&bits] { return static_cast<double>(bits()) / 2147483648.0 - 0.5; };  // in [-0.5, 1.5)
    const double r = next();
    const double g = next();
    light.coefficients.emplace_back(r, g, next());
  }
  light.coefficients[0] += RgbD(3.0);  // a mean that nothing divides by zero with
  return light;
}

}  // namespace

std::vector<ShRgb> turned_lights(const ShRgb& light, int bands) {
  const int kept = std::min(bands, light.bands);
  const auto count = static_cast<std::ptrdiff_t>(coefficient_count(kept));
  const ShRgb low{kept, {light.coefficients.begin(), light.coefficients.begin() + count}};
  std::vector<ShRgb> turned;
  for (const SignedAxes& axes : all_signed_axes()) {
    Convention convention;
    convention.axes = axes;
    turned.push_back(to_ours(from_ours(low, convention), {}, kept).ours);
  }
  return turned;
}

std::vector<Convention> scalings(int bands, Freedom freedom) {
  std::vector<Quantity> quantities{Quantity::radiance,           Quantity::irradiance,
                                   Quantity::irradiance_over_pi, Quantity::radiance_over_pi,
                                   Quantity::radiance_over_4pi,  Quantity::irradiance_over_pi_twice};
  if (freedom == Freedom::none) quantities.push_back(Quantity::radiance_minus_half);
  if (freedom == Freedom::degrees) quantities = {Quantity::custom};
  std::vector<Convention> all;
  for (const Normalization normalization :
       {Normalization::orthonormal, Normalization::four_pi, Normalization::schmidt,
        Normalization::unnormalized, Normalization::polynomial}) {
    if (normalization == Normalization::polynomial && bands > 3) continue;
    const bool is_per_degree =
        normalization == Normalization::four_pi || normalization == Normalization::schmidt;
    if (is_per_degree && freedom == Freedom::degrees) continue;
    for (const Role role : {Role::expansion, Role::projection}) {
      if (normalization == Normalization::orthonormal && role == Role::projection) continue;
      for (const Quantity quantity : quantities) {
        Convention convention;
        convention.normalization = normalization;
        convention.role = role;
        convention.quantity = quantity;
        all.push_back(convention);
      }
    }
  }
  return all;
}

std::vector<Trial> sphere_trials(std::span<const double> values, const Split& split,
                                 const std::vector<ShRgb>& lights, Freedom freedom) {
  const Target target = target_of(rows_of(values, split));
  const std::vector<SignedAxes> axes = all_signed_axes();
  std::vector<Trial> trials;
  for (const Convention& scaling : scalings(split.bands, freedom)) {
    const std::vector<double> factors = factors_of(scaling, split.bands);
    for (const Arrangement arrangement : kArrangements) {
      const std::vector<std::size_t> places = places_of(arrangement, split.bands);
      for (std::size_t a = 0; a < axes.size(); ++a) {
        Trial trial{scaling, split, 1.0, 0.0, 0.0, 0};
        trial.convention.arrangement = arrangement;
        trial.convention.axes = axes[a];
        trial.convention.layout = split.layout;
        std::vector<RgbD> expected = expected_rows(lights[a], scaling, factors, places);
        fit(trial, expected, target, freedom);
        if (trial.squared_residual < kHopeless) trials.push_back(std::move(trial));
      }
    }
  }
  return trials;
}

bool is_half_count(std::size_t count) {
  for (const std::size_t functions : {std::size_t{4}, std::size_t{6}}) {
    for (const Layout layout : kHalfLayouts) {
      if (packed_count(layout, functions) == count) return true;
    }
  }
  return false;
}

std::vector<Trial> half_trials(std::span<const double> values, const std::vector<ShRgb>& lights) {
  const std::vector<SignedAxes> axes = all_signed_axes();
  std::vector<Trial> trials;
  for (const Functions functions : kHalfFunctions) {
    for (const Layout layout : kHalfLayouts) {
      Convention convention;
      convention.functions = functions;
      convention.layout = layout;
      if (value_count(convention, 1) != values.size()) continue;
      const std::size_t count = half_function_count(functions);
      Target target = target_of(unpacked_rows(values, layout, count));
      if (functions == Functions::cosine_lightmap) {  // the others vary about 1/2
        target.variation = 0.0;
        for (std::size_t i = 1; i < count; ++i) target.variation += squared(target.rows[i] - RgbD(0.5));
      }
      for (const Quantity quantity :
           {Quantity::radiance, Quantity::irradiance, Quantity::irradiance_over_pi}) {
        convention.quantity = quantity;
        for (std::size_t a = 0; a < axes.size(); ++a) {
          convention.axes = SignedAxes{};
          std::vector<RgbD> expected = unpacked_rows(from_ours(lights[a], convention), layout, count);
          convention.axes = axes[a];
          trials.push_back({convention, {layout, false, 0}, 1.0, 0.0, 0.0, 0});
          fit(trials.back(), expected, target, Freedom::none);
        }
      }
    }
  }
  return trials;
}

Fingerprint fingerprint(const Convention& convention, const Split& split, double scale) {
  constexpr int kBandsOfHalf = 4;  // enough to tell functions on a hemisphere apart
  const std::vector<double> values =
      from_ours(random_light(split.bands > 0 ? split.bands : kBandsOfHalf), convention);
  const std::size_t count = split.is_one_channel ? values.size() / 3 : values.size();
  std::mt19937 bits(4U);
  Fingerprint sums{};
  double size = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    for (double& sum : sums) sum += values[i] * (0.5 + static_cast<double>(bits()) / 4294967296.0);
    size += std::abs(values[i]);
  }
  // Relative numbers and a logarithm of the size, so that one tolerance serves all scales.
  return {sums[0] / size, sums[1] / size + std::log(scale * size)};
}

}  // namespace plumbline::sh
