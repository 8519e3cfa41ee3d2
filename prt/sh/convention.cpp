#include "prt/sh/convention.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prt/sh/convention_layout.hpp"
#include "prt/sh/half_functions.hpp"
#include "prt/sh/quadrature.hpp"
#include "prt/sh/zonal.hpp"
#include "reference/base/error.hpp"

namespace plumbline::sh {
namespace {

/// L - 1/2 has this much less of y_00: half of the integral of y_00.
const double kHalfOfDc = 0.5 * std::sqrt(4.0 * kPi);

void require_axes(const SignedAxes& axes) {
  std::array<int, 3> seen{};
  for (std::size_t i = 0; i < 3; ++i) {
    const bool is_usable = axes.axis[i] >= 0 && axes.axis[i] < 3 && std::abs(axes.sign[i]) == 1;
    if (is_usable) ++seen[static_cast<std::size_t>(axes.axis[i])];
  }
  if (seen != std::array<int, 3>{1, 1, 1}) {
    throw InputError("sh::Convention: axes: expected each of 0, 1, 2 once, with signs +1 or -1");
  }
}

void require_finite(double value, const char* what, std::size_t i) {
  if (!std::isfinite(value)) throw InputError(fmt::format("{}[{}]: not finite: {}", what, i, value));
}

void require_light(const ShRgb& light) {
  require_bands(light.bands);
  const auto expected = static_cast<std::size_t>(coefficient_count(light.bands));
  if (light.coefficients.size() != expected) {
    throw InputError(fmt::format("sh::from_ours: expected {} coefficients for {} bands, got {}", expected,
                                 light.bands, light.coefficients.size()));
  }
  for (std::size_t i = 0; i < expected; ++i) {
    for (glm::length_t c = 0; c < 3; ++c) require_finite(light.coefficients[i][c], "coefficients", i);
  }
}

/// 1, y, z, x, xy, yz, 3z^2-1, xz, x^2-y^2 are y_lm without its constant: this is the constant.
double polynomial_constant(int l, int m) {
  if (l == 0) return std::sqrt(1.0 / (4.0 * kPi));
  if (l == 1) return std::sqrt(3.0 / (4.0 * kPi));
  if (l > 2) {
    throw InputError(fmt::format("sh::Convention: bare polynomials: expected degrees 0 to 2, got {}", l));
  }
  if (m == 0) return std::sqrt(5.0 / (16.0 * kPi));
  return std::sqrt((m == 2 ? 15.0 / 16.0 : 15.0 / 4.0) / kPi);
}

/// y_lm = K P_l|m|(cos theta) {cos m phi, 1, sin |m| phi}, K^2 = (2 - [m = 0]) (2l + 1)/(4 pi) (l-|m|)!/(l+|m|)!
double legendre_constant(int l, int m) {
  const int order = std::abs(m);
  const double log_ratio = std::lgamma(l - order + 1.0) - std::lgamma(l + order + 1.0);
  return std::sqrt((order == 0 ? 1.0 : 2.0) * (2.0 * l + 1.0) / (4.0 * kPi)) * std::exp(0.5 * log_ratio);
}

/// f of B_lm = f y_lm.
double function_scale(Normalization normalization, int l, int m) {
  switch (normalization) {
    case Normalization::orthonormal:
      return 1.0;
    case Normalization::four_pi:
      return std::sqrt(4.0 * kPi);
    case Normalization::schmidt:
      return std::sqrt(4.0 * kPi / (2.0 * l + 1.0));
    case Normalization::unnormalized:
      return 1.0 / legendre_constant(l, m);
    case Normalization::polynomial:
      return 1.0 / polynomial_constant(l, m);
  }
  throw InputError("sh::Convention: unknown normalisation");
}

double quantity_factor(const Convention& convention, int l) {
  switch (convention.quantity) {
    case Quantity::radiance:
    case Quantity::radiance_minus_half:
      return 1.0;
    case Quantity::irradiance:
      return clamped_cosine_factor(l);
    case Quantity::irradiance_over_pi:
      return clamped_cosine_factor(l) / kPi;
    case Quantity::irradiance_over_pi_twice:
      return clamped_cosine_factor(l) / (kPi * kPi);
    case Quantity::radiance_over_pi:
      return 1.0 / kPi;
    case Quantity::radiance_over_4pi:
      return 1.0 / (4.0 * kPi);
    case Quantity::custom:
      break;
  }
  const auto degree = static_cast<std::size_t>(l);
  if (degree >= convention.factors.size()) {
    throw InputError(fmt::format("sh::Convention: factors: expected one for degree {}, got {} factors", l,
                                 convention.factors.size()));
  }
  return convention.factors[degree];
}

// The light turned into other axes. Their frame sees L'(M w) = L(w), hence c'_i = integral of L(w) y_i(M w) dw.
// The integrand is a product of two functions of `bands` bands: the quadrature is exact.
ShRgb in_axes(const ShRgb& light, const SignedAxes& axes) {
  if (axes == SignedAxes{}) return light;
  const auto count = static_cast<std::size_t>(coefficient_count(light.bands));
  const Basis<double> basis(light.bands);
  std::vector<double> y(count);
  ShRgb turned{light.bands, std::vector<RgbD>(count, RgbD(0.0))};
  for (const SphereNode& node : sphere_quadrature(light.bands)) {
    const Vec3d& w = node.direction;
    basis.evaluate(w.x, w.y, w.z, y);
    RgbD radiance(0.0);
    for (std::size_t i = 0; i < count; ++i) radiance += y[i] * light.coefficients[i];
    const Vec3d theirs = apply(axes, w);
    basis.evaluate(theirs.x, theirs.y, theirs.z, y);
    for (std::size_t i = 0; i < count; ++i) turned.coefficients[i] += node.weight * y[i] * radiance;
  }
  return turned;
}

template <class Visit>
void for_each_coefficient(int bands, const Visit& visit) {
  for (int l = 0; l < bands; ++l) {
    for (int m = -l; m <= l; ++m) visit(l, m, static_cast<std::size_t>(index(l, m)));
  }
}

}  // namespace

// ---------------------------------------------------------------- axes

Vec3d apply(const SignedAxes& axes, const Vec3d& ours) {
  Vec3d theirs(0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    theirs[static_cast<glm::length_t>(i)] = axes.sign[i] * ours[static_cast<glm::length_t>(axes.axis[i])];
  }
  return theirs;
}

SignedAxes combined(const SignedAxes& first, const SignedAxes& second) {
  SignedAxes both;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto middle = static_cast<std::size_t>(second.axis[i]);
    both.axis[i] = first.axis[middle];
    both.sign[i] = second.sign[i] * first.sign[middle];
  }
  return both;
}

SignedAxes inverse(const SignedAxes& axes) {
  SignedAxes back;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto ours = static_cast<std::size_t>(axes.axis[i]);
    back.axis[ours] = static_cast<int>(i);
    back.sign[ours] = axes.sign[i];
  }
  return back;
}

bool is_mirrored(const SignedAxes& axes) {
  const bool is_cyclic = (axes.axis[1] - axes.axis[0] + 3) % 3 == 1;
  return (axes.sign[0] * axes.sign[1] * axes.sign[2] > 0) != is_cyclic;
}

std::vector<SignedAxes> all_signed_axes() {
  std::vector<SignedAxes> all;
  std::array<int, 3> axis{0, 1, 2};
  do {
    for (unsigned bits = 0; bits < 8U; ++bits) {
      SignedAxes axes{axis, {}};
      for (unsigned i = 0; i < 3U; ++i) axes.sign[i] = (bits >> i & 1U) == 0U ? 1 : -1;
      all.push_back(axes);
    }
  } while (std::next_permutation(axis.begin(), axis.end()));
  return all;
}

// ---------------------------------------------------------------- conversion

double coefficient_factor(const Convention& convention, int l, int m) {
  if (l < 0 || std::abs(m) > l) {
    throw InputError(fmt::format("sh::coefficient_factor: expected |m| <= l, got l = {}, m = {}", l, m));
  }
  const double scale = function_scale(convention.normalization, l, m);
  const double sign = convention.sign == Sign::positive && m % 2 != 0 ? -1.0 : 1.0;
  const double factor =
      sign * quantity_factor(convention, l) * (convention.role == Role::expansion ? 1.0 / scale : scale);
  if (!std::isfinite(factor)) {
    throw InputError(
        fmt::format("sh::Convention: the factor of l = {}, m = {} is not finite: {}", l, m, factor));
  }
  return factor;
}

int position(Arrangement arrangement, int l, int m) {
  const int first = l * l;
  switch (arrangement) {
    case Arrangement::ascending:
      return first + l + m;
    case Arrangement::descending:
      return first + l - m;
    case Arrangement::xyz:
      return l == 1 ? first + (m + 2) % 3 : first + l + m;  // m = -1, 0, 1 is y, z, x
    case Arrangement::zero_first:
      return first + (m > 0 ? 2 * m - 1 : -2 * m);
  }
  throw InputError("sh::Convention: unknown arrangement");
}

std::vector<double> from_ours(const ShRgb& ours, const Convention& convention) {
  require_light(ours);
  require_axes(convention.axes);
  ShRgb theirs = in_axes(ours, convention.axes);
  if (convention.functions != Functions::sphere) {
    for_each_coefficient(ours.bands, [&](int l, int, std::size_t i) {
      theirs.coefficients[i] *= quantity_factor(convention, l);
    });
    return packed_values(half_function_values(theirs, convention.functions, convention.sign),
                         convention.layout);
  }
  if (convention.quantity == Quantity::radiance_minus_half) theirs.coefficients[0] -= RgbD(kHalfOfDc);
  std::vector<RgbD> rows(theirs.coefficients.size());
  for_each_coefficient(ours.bands, [&](int l, int m, std::size_t i) {
    rows[static_cast<std::size_t>(position(convention.arrangement, l, m))] =
        coefficient_factor(convention, l, m) * theirs.coefficients[i];
  });
  return packed_values(rows, convention.layout);
}

Converted to_ours(std::span<const double> values, const Convention& convention, int bands) {
  require_bands(bands);
  require_axes(convention.axes);
  if (convention.functions != Functions::sphere) {
    throw InputError(fmt::format(
        "sh::to_ours: {}: they see only half of the directions and do not determine a light on the sphere",
        to_string(convention.functions)));
  }
  for (std::size_t i = 0; i < values.size(); ++i) require_finite(values[i], "values", i);
  const std::vector<RgbD> rows =
      unpacked_rows(values, convention.layout, static_cast<std::size_t>(coefficient_count(bands)));
  Converted result;
  ShRgb theirs{bands, std::vector<RgbD>(rows.size(), RgbD(0.0))};
  for_each_coefficient(bands, [&](int l, int m, std::size_t i) {
    const double factor = coefficient_factor(convention, l, m);
    if (factor != 0.0) {
      theirs.coefficients[i] =
          rows[static_cast<std::size_t>(position(convention.arrangement, l, m))] / factor;
    } else if (result.lost_degrees.empty() || result.lost_degrees.back() != l) {
      result.lost_degrees.push_back(l);
    }
  });
  if (convention.quantity == Quantity::radiance_minus_half) theirs.coefficients[0] += RgbD(kHalfOfDc);
  result.ours = in_axes(theirs, inverse(convention.axes));
  return result;
}

std::size_t value_count(const Convention& convention, int bands) {
  require_bands(bands);
  if (convention.functions != Functions::sphere) {
    return packed_count(convention.layout, half_function_count(convention.functions));
  }
  (void)coefficient_factor(convention, bands - 1, 0);  // refuses degrees that the convention does not have
  return packed_count(convention.layout, static_cast<std::size_t>(coefficient_count(bands)));
}

std::optional<int> bands_of_count(const Convention& convention, std::size_t count) {
  if (convention.functions != Functions::sphere) return std::nullopt;
  for (int bands = 1; bands <= kMaxBands; ++bands) {
    const auto rows = static_cast<std::size_t>(coefficient_count(bands));
    if (rows > count) break;
    if (!is_packable(convention.layout, rows) || packed_count(convention.layout, rows) != count) continue;
    if (convention.normalization == Normalization::polynomial && bands > 3) continue;
    if (convention.quantity == Quantity::custom && bands > static_cast<int>(convention.factors.size()))
      continue;
    return bands;
  }
  return std::nullopt;
}

// ---------------------------------------------------------------- words

std::string to_string(Arrangement arrangement) {
  switch (arrangement) {
    case Arrangement::ascending:
      return "l(l+1)+m";
    case Arrangement::descending:
      return "l(l+1)-m";
    case Arrangement::xyz:
      return "l(l+1)+m, but degree 1 as x, y, z";
    case Arrangement::zero_first:
      return "m = 0, 1, -1, 2, -2, ...";
  }
  return "?";
}

std::string to_string(Sign sign) {
  return sign == Sign::condon_shortley ? "Condon-Shortley" : "positive";
}

std::string to_string(Normalization normalization, Role role) {
  const std::string use = role == Role::expansion ? " (expansion)" : " (projection)";
  switch (normalization) {
    case Normalization::orthonormal:
      return "orthonormal";
    case Normalization::four_pi:
      return "4 pi" + use;
    case Normalization::schmidt:
      return "Schmidt" + use;
    case Normalization::unnormalized:
      return "unnormalised" + use;
    case Normalization::polynomial:
      return "bare polynomials" + use;
  }
  return "?";
}

std::string to_string(const SignedAxes& axes) {
  std::string text;
  for (std::size_t i = 0; i < 3; ++i) {
    if (i > 0) text += ", ";
    if (axes.sign[i] < 0) text += "-";
    text += "xyz"[axes.axis[i]];
  }
  return text;
}

std::string to_string(Quantity quantity) {
  switch (quantity) {
    case Quantity::radiance:
      return "radiance L";
    case Quantity::irradiance:
      return "irradiance E";
    case Quantity::irradiance_over_pi:
      return "E/pi";
    case Quantity::radiance_over_pi:
      return "L/pi";
    case Quantity::radiance_over_4pi:
      return "L/4 pi";
    case Quantity::irradiance_over_pi_twice:
      return "E/pi^2";
    case Quantity::radiance_minus_half:
      return "L - 1/2";
    case Quantity::custom:
      return "L times factors";
  }
  return "?";
}

std::string to_string(Layout layout) {
  switch (layout) {
    case Layout::interleaved:
      return "rows of r, g, b";
    case Layout::planar:
      return "planar r, g, b";
    case Layout::rgba:
      return "rows of four";
    case Layout::splat:
      return "degree 0, then the rest planar";
    case Layout::cosine_sine:
      return "c[2][l][m] a channel";
    case Layout::packed:
      return "SHA, SHB, SHC";
    case Layout::packed_square:
      return "SHA, SHB, SHC with 3z^2-1";
  }
  return "?";
}

std::string to_string(Functions functions) {
  switch (functions) {
    case Functions::sphere:
      return "spherical harmonics";
    case Functions::h_basis_4:
      return "H-basis, 4 functions";
    case Functions::h_basis_6:
      return "H-basis, 6 functions";
    case Functions::h_basis_4_half_dc:
      return "H-basis, 4 functions, the first 1/(2 sqrt(pi))";
    case Functions::cosine_lightmap:
      return "means over cosine-distributed directions";
  }
  return "?";
}

}  // namespace plumbline::sh
