#include "validation/conformance/border.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "prt/sh/quadrature.hpp"
#include "prt/sh/zonal.hpp"
#include "reference/base/error.hpp"
#include "validation/checks/sh_checks.hpp"

namespace plumbline::conformance {
namespace {

std::size_t size_of(int bands) {
  return static_cast<std::size_t>(bands) * static_cast<std::size_t>(bands);
}

/// m of the function at `place` 0 … 2l of band l.
int azimuthal_number(const plumbline_convention& convention, int degree, int place) {
  if (convention.index_order != PLUMBLINE_INDEX_ZERO_FIRST) return place - degree;
  return place % 2 == 1 ? (place + 1) / 2 : -place / 2;
}

double sign_of(const plumbline_convention& convention, int m) {
  return convention.sign == PLUMBLINE_SIGN_POSITIVE && m % 2 != 0 ? -1.0 : 1.0;
}

double norm_of(const plumbline_convention& convention, int degree) {
  switch (convention.norm) {
    case PLUMBLINE_NORM_FOUR_PI:
      return std::sqrt(4.0 * kPi);
    case PLUMBLINE_NORM_SEMI_SCHMIDT:
      return std::sqrt(4.0 * kPi / (2.0 * degree + 1.0));
    default:
      return 1.0;
  }
}

Vec3d polar_frame(const plumbline_convention& convention, const Vec3d& w) {
  if (convention.axes[0] == 0) return w;
  Vec3d result;
  for (int k = 0; k < 3; ++k) {
    const int axis = convention.axes[k];
    result[k] = axis > 0 ? w[axis - 1] : -w[-axis - 1];
  }
  return result;
}

/// Constant and sign of the function in front of its bare polynomial, l <= 2.
double polynomial_constant(const plumbline_convention& convention, int degree, int m) {
  constexpr std::array<double, 9> kSquares{1.0, 3.0, 3.0, 3.0, 15.0, 15.0, 1.25, 15.0, 3.75};
  const auto place = static_cast<std::size_t>(degree * (degree + 1) + m);
  if (place >= kSquares.size()) return 0.0;
  const double sign = m % 2 != 0 && convention.sign != PLUMBLINE_SIGN_POSITIVE ? -1.0 : 1.0;
  return sign * std::sqrt(kSquares.at(place) / (4.0 * kPi)) * norm_of(convention, degree);
}

double multiplier(const plumbline_convention& convention, int degree, int m) {
  const double cosine = sh::clamped_cosine_factor(degree);
  switch (convention.premultiplication) {
    case PLUMBLINE_PREMULTIPLIED_RADIANCE_OVER_PI:
      return 1.0 / kPi;
    case PLUMBLINE_PREMULTIPLIED_IRRADIANCE:
      return cosine;
    case PLUMBLINE_PREMULTIPLIED_IRRADIANCE_OVER_PI:
      return cosine / kPi;
    case PLUMBLINE_PREMULTIPLIED_POLYNOMIAL:
      return cosine / kPi * polynomial_constant(convention, degree, m);
    default:
      return 1.0;
  }
}

bool is_plain(const plumbline_convention& c) {
  return c.axes[0] == 0 || (c.axes[0] == 1 && c.axes[1] == 2 && c.axes[2] == 3);
}

std::vector<double> plain_band(const plumbline_convention& convention, int degree) {
  const int width = 2 * degree + 1;
  std::vector<double> q(size_of(width), 0.0);
  for (int place = 0; place < width; ++place) {
    const int m = azimuthal_number(convention, degree, place);
    q[static_cast<std::size_t>(place * width + m + degree)] = sign_of(convention, m);
  }
  return q;
}

/// Q of every degree: integral of the convention's unit-length functions times ours.
std::vector<std::vector<double>> turned_bands(const plumbline_convention& convention, int max_bands) {
  std::vector<std::vector<double>> result;
  for (int l = 0; l < max_bands; ++l) result.emplace_back(size_of(2 * l + 1), 0.0);
  plumbline_convention unit = convention;
  unit.norm = PLUMBLINE_NORM_ORTHONORMAL;
  for (const sh::SphereNode& node : sh::sphere_quadrature(max_bands)) {
    const std::vector<double> theirs = convention_basis(unit, max_bands, node.direction);
    const std::vector<double> ours = checks::textbook_basis(max_bands, node.direction);
    for (int l = 0; l < max_bands; ++l) {
      const auto width = static_cast<std::size_t>(2 * l + 1);
      const auto first = size_of(l);
      for (std::size_t i = 0; i < width; ++i)
        for (std::size_t j = 0; j < width; ++j)
          result[static_cast<std::size_t>(l)][i * width + j] +=
              node.weight * theirs[first + i] * ours[first + j];
    }
  }
  return result;
}

/// out_i = sum_j M_ij in_j in each band, or with the transposed.
std::vector<double> multiplied(const std::vector<std::vector<double>>& matrices, int bands,
                               const std::vector<double>& in, bool is_transposed) {
  std::vector<double> out(size_of(bands), 0.0);
  for (int l = 0; l < bands; ++l) {
    const std::vector<double>& q = matrices[static_cast<std::size_t>(l)];
    const auto width = static_cast<std::size_t>(2 * l + 1);
    for (std::size_t i = 0; i < width; ++i) {
      for (std::size_t j = 0; j < width; ++j) {
        const double entry = is_transposed ? q[j * width + i] : q[i * width + j];
        if (entry != 0.0) out[size_of(l) + i] += entry * in[size_of(l) + j];  // 0 * Inf would spread NaN
      }
    }
  }
  return out;
}

bool is_permutation(const int32_t (&axes)[3]) {
  std::array<int, 3> magnitudes{std::abs(axes[0]), std::abs(axes[1]), std::abs(axes[2])};
  std::sort(magnitudes.begin(), magnitudes.end());
  return magnitudes == std::array<int, 3>{1, 2, 3} || magnitudes == std::array<int, 3>{0, 0, 0};
}

/// All signed permutations, the plainest first: no swap before swaps, few reversals before many.
std::vector<std::array<int32_t, 3>> all_axes() {
  std::vector<std::array<int32_t, 3>> result;
  std::array<int32_t, 3> order{1, 2, 3};
  do {
    for (const unsigned signs : {0U, 1U, 2U, 4U, 3U, 5U, 6U, 7U}) {
      std::array<int32_t, 3> axes = order;
      for (unsigned k = 0; k < 3; ++k)
        if ((signs >> k & 1U) != 0U) axes.at(k) = -axes.at(k);
      result.push_back(axes);
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return result;
}

bool fits(const plumbline_convention& convention, const std::vector<Vec3d>& directions,
          const std::vector<double>& values) {
  constexpr double kTolerance = 1e-3;
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const std::vector<double> expected = convention_basis(convention, 3, directions[k]);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      if (!(std::abs(values[k * expected.size() + i] - expected[i]) <=
            kTolerance * norm_of(convention, 2)))
        return false;
    }
  }
  return true;
}

}  // namespace

plumbline_convention own_convention() {
  return {PLUMBLINE_INDEX_L_SQUARED,
          PLUMBLINE_SIGN_CONDON_SHORTLEY,
          PLUMBLINE_NORM_ORTHONORMAL,
          {1, 2, 3},
          PLUMBLINE_PREMULTIPLIED_RADIANCE,
          PLUMBLINE_LAYOUT_INTERLEAVED};
}

std::string to_string(const plumbline_convention& c) {
  constexpr std::array kIndex{"index unknown", "index l(l+1)+m", "index m = 0, 1, -1, ..."};
  constexpr std::array kSign{"sign unknown", "Condon-Shortley", "no Condon-Shortley"};
  constexpr std::array kNorm{"norm unknown", "orthonormal", "4 pi norm", "semi-Schmidt norm"};
  constexpr std::array kPre{"multiplication unknown", "radiance",        "radiance / pi",
                            "irradiance",             "irradiance / pi", "irradiance / pi as bare polynomials"};
  constexpr std::array kLayout{"layout unknown", "interleaved", "planar"};
  constexpr std::array kAxis{"-z", "-y", "-x", "?", "x", "y", "z"};
  const auto at = [](const auto& names, int32_t i) { return names.at(static_cast<std::size_t>(i)); };
  return fmt::format("{}, {}, {}, axes {} {} {}, {}, {}", at(kIndex, c.index_order), at(kSign, c.sign),
                     at(kNorm, c.norm), at(kAxis, c.axes[0] + 3), at(kAxis, c.axes[1] + 3),
                     at(kAxis, c.axes[2] + 3), at(kPre, c.premultiplication), at(kLayout, c.layout));
}

std::string fault_of(const plumbline_convention& c) {
  const auto check = [](const char* name, int32_t value, int32_t last) {
    return value >= 0 && value <= last ? std::string() : fmt::format("{} = {} (0 to {})", name, value, last);
  };
  for (const std::string& fault :
       {check("convention.index_order", c.index_order, PLUMBLINE_INDEX_ZERO_FIRST),
        check("convention.sign", c.sign, PLUMBLINE_SIGN_POSITIVE),
        check("convention.norm", c.norm, PLUMBLINE_NORM_SEMI_SCHMIDT),
        check("convention.premultiplication", c.premultiplication, PLUMBLINE_PREMULTIPLIED_POLYNOMIAL),
        check("convention.layout", c.layout, PLUMBLINE_LAYOUT_PLANAR)}) {
    if (!fault.empty()) return fault;
  }
  if (is_permutation(c.axes)) return {};
  return fmt::format("convention.axes = {{{}, {}, {}}} (each of 1, 2, 3 once, with a sign; or all 0)", c.axes[0],
                     c.axes[1], c.axes[2]);
}

Border::Border(const plumbline_convention& convention, int max_bands) : convention_(convention) {
  if (const std::string fault = fault_of(convention); !fault.empty()) throw InputError(fault);
  if (is_plain(convention)) {
    for (int l = 0; l < max_bands; ++l) bands_.push_back(plain_band(convention, l));
  } else {
    bands_ = turned_bands(convention, max_bands);
  }
}

bool Border::knows_basis() const {
  return convention_.index_order != 0 && convention_.sign != 0 && convention_.norm != 0 && convention_.axes[0] != 0;
}

bool Border::knows_coefficients() const {
  return knows_basis() && convention_.premultiplication != 0;
}

int Border::usable_bands(int bands) const {
  return convention_.premultiplication >= PLUMBLINE_PREMULTIPLIED_IRRADIANCE ? std::min(bands, 3) : bands;
}

// c' = W Q c with W = P S^-1 diagonal, so that t' = W^-1 Q t keeps t' . c' = t . c.
std::vector<double> Border::to_theirs(int bands, const std::vector<double>& ours) const {
  return weighted(multiplied(bands_, bands, ours, false), bands, 1.0);
}
std::vector<double> Border::to_ours(int bands, const std::vector<double>& theirs) const {
  return multiplied(bands_, bands, weighted(theirs, bands, -1.0), true);
}
std::vector<double> Border::dual_to_theirs(int bands, const std::vector<double>& ours) const {
  return weighted(multiplied(bands_, bands, ours, false), bands, -1.0);
}
std::vector<double> Border::dual_to_ours(int bands, const std::vector<double>& theirs) const {
  return multiplied(bands_, bands, weighted(theirs, bands, 1.0), true);
}

std::vector<double> Border::weighted(std::vector<double> values, int bands, double power) const {
  for (int l = 0; l < bands; ++l) {
    for (int place = 0; place <= 2 * l; ++place) {
      const int m = azimuthal_number(convention_, l, place);
      const double weight = multiplier(convention_, l, m) / norm_of(convention_, l);
      values[size_of(l) + static_cast<std::size_t>(place)] *= power > 0.0 ? weight : 1.0 / weight;
    }
  }
  return values;
}

std::vector<double> Border::basis_to_ours(int bands, const std::vector<double>& theirs) const {
  std::vector<double> result = theirs;
  for (int l = 0; l < bands; ++l)
    for (std::size_t i = size_of(l); i < size_of(l + 1); ++i) result[i] /= norm_of(convention_, l);
  return multiplied(bands_, bands, result, true);
}

std::vector<double> Border::rgb_to_ours(int bands, const std::vector<double>& theirs) const {
  const std::size_t count = size_of(bands);
  std::vector<double> result(3 * count);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    std::vector<double> one(count);
    for (std::size_t i = 0; i < count; ++i) {
      one[i] = theirs[convention_.layout == PLUMBLINE_LAYOUT_PLANAR ? channel * count + i : 3 * i + channel];
    }
    one = to_ours(bands, one);
    for (std::size_t i = 0; i < count; ++i) result[3 * i + channel] = one[i];
  }
  return result;
}

std::vector<double> convention_basis(const plumbline_convention& convention, int bands, const Vec3d& direction) {
  const std::vector<double> textbook = checks::textbook_basis(bands, polar_frame(convention, direction));
  std::vector<double> result(textbook.size());
  for (int l = 0; l < bands; ++l) {
    for (int place = 0; place <= 2 * l; ++place) {
      const int m = azimuthal_number(convention, l, place);
      result[size_of(l) + static_cast<std::size_t>(place)] =
          norm_of(convention, l) * sign_of(convention, m) * textbook[static_cast<std::size_t>(l * (l + 1) + m)];
    }
  }
  return result;
}

std::optional<plumbline_convention> convention_of_basis(const std::vector<Vec3d>& directions,
                                                        const std::vector<double>& values) {
  for (const std::array<int32_t, 3>& axes : all_axes()) {
    for (const int32_t sign : {PLUMBLINE_SIGN_CONDON_SHORTLEY, PLUMBLINE_SIGN_POSITIVE}) {
      for (int32_t norm = PLUMBLINE_NORM_ORTHONORMAL; norm <= PLUMBLINE_NORM_SEMI_SCHMIDT; ++norm) {
        for (const int32_t order : {PLUMBLINE_INDEX_L_SQUARED, PLUMBLINE_INDEX_ZERO_FIRST}) {
          plumbline_convention convention = own_convention();
          convention.index_order = order;
          convention.sign = sign;
          convention.norm = norm;
          std::copy(axes.begin(), axes.end(), convention.axes);
          if (fits(convention, directions, values)) return convention;
        }
      }
    }
  }
  return std::nullopt;
}

}  // namespace plumbline::conformance
