#include "validation/conformance/border.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "prt/sh/quadrature.hpp"
#include "reference/base/error.hpp"
#include "validation/checks/sh_checks.hpp"

namespace plumbline::conformance {
namespace {

std::size_t size_of(int bands) {
  return static_cast<std::size_t>(bands) * static_cast<std::size_t>(bands);
}

/// Index l(l+1)+m of the function at each place of band l, from l^2 on.
std::vector<std::size_t> sources(const sh::Convention& convention, int degree) {
  std::vector<std::size_t> result(static_cast<std::size_t>(2 * degree + 1));
  for (int m = -degree; m <= degree; ++m) {
    const int place = sh::position(convention.arrangement, degree, m) - degree * degree;
    result.at(static_cast<std::size_t>(place)) = static_cast<std::size_t>(sh::index(degree, m));
  }
  return result;
}

int degree_of(std::size_t index) {
  return static_cast<int>(std::sqrt(static_cast<double>(index) + 0.5));
}

/// Factor of c_i for i = l(l+1)+m: sign, norm and quantity.
double weight_of(const sh::Convention& convention, std::size_t index) {
  const int l = degree_of(index);
  return sh::coefficient_factor(convention, l, static_cast<int>(index) - l * (l + 1));
}

std::vector<double> plain_band(const sh::Convention& convention, int degree) {
  const std::vector<std::size_t> source = sources(convention, degree);
  std::vector<double> q(size_of(2 * degree + 1), 0.0);
  for (std::size_t place = 0; place < source.size(); ++place)
    q[place * source.size() + source[place] - size_of(degree)] = 1.0;
  return q;
}

/// Q of every degree: integral of y_i(their frame) y_j(our frame), i in their order.
std::vector<std::vector<double>> turned_bands(const sh::Convention& convention, int max_bands) {
  std::vector<std::vector<double>> result;
  for (int l = 0; l < max_bands; ++l) result.emplace_back(size_of(2 * l + 1), 0.0);
  for (const sh::SphereNode& node : sh::sphere_quadrature(max_bands)) {
    const std::vector<double> theirs =
        checks::textbook_basis(max_bands, sh::apply(convention.axes, node.direction));
    const std::vector<double> ours = checks::textbook_basis(max_bands, node.direction);
    for (int l = 0; l < max_bands; ++l) {
      const std::vector<std::size_t> source = sources(convention, l);
      std::vector<double>& q = result[static_cast<std::size_t>(l)];
      for (std::size_t i = 0; i < source.size(); ++i)
        for (std::size_t j = 0; j < source.size(); ++j)
          q[i * source.size() + j] += node.weight * theirs[source[i]] * ours[size_of(l) + j];
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

std::vector<double> times(std::vector<double> values, const std::vector<double>& weights) {
  for (std::size_t i = 0; i < values.size(); ++i) values[i] *= weights[i];
  return values;
}
std::vector<double> over(std::vector<double> values, const std::vector<double>& weights) {
  for (std::size_t i = 0; i < values.size(); ++i) values[i] /= weights[i];
  return values;
}

bool is_permutation(const int32_t (&axes)[3]) {
  std::array<int, 3> magnitudes{std::abs(axes[0]), std::abs(axes[1]), std::abs(axes[2])};
  std::sort(magnitudes.begin(), magnitudes.end());
  return magnitudes == std::array<int, 3>{1, 2, 3} || magnitudes == std::array<int, 3>{0, 0, 0};
}

bool fits(const plumbline_convention& convention, const std::vector<Vec3d>& directions,
          const std::vector<double>& values) {
  constexpr double kTolerance = 1e-3;
  for (std::size_t k = 0; k < directions.size(); ++k) {
    const std::vector<double> expected = convention_basis(convention, 3, directions[k]);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      if (!(std::abs(values[k * expected.size() + i] - expected[i]) <=
            kTolerance * std::max(1.0, std::abs(expected[i]))))
        return false;
    }
  }
  return true;
}

}  // namespace

plumbline_convention own_convention() {
  return {PLUMBLINE_INDEX_L_SQUARED,   PLUMBLINE_SIGN_CONDON_SHORTLEY, PLUMBLINE_NORM_ORTHONORMAL, {1, 2, 3},
          PLUMBLINE_QUANTITY_RADIANCE, PLUMBLINE_LAYOUT_INTERLEAVED};
}

std::string to_string(const plumbline_convention& c) {
  const sh::Convention known = sh_convention(c);
  const auto or_unknown = [](int32_t value, const std::string& text, const char* what) {
    return value != 0 ? text : fmt::format("{} unknown", what);
  };
  return fmt::format("{}; {}; {}; {}; {}; {}",
                     or_unknown(c.index_order, sh::to_string(known.arrangement), "index order"),
                     or_unknown(c.sign, sh::to_string(known.sign), "sign"),
                     or_unknown(c.norm, sh::to_string(known.normalization, known.role), "norm"),
                     or_unknown(c.axes[0], sh::to_string(known.axes), "axes"),
                     or_unknown(c.quantity, sh::to_string(known.quantity), "quantity"),
                     or_unknown(c.layout, sh::to_string(known.layout), "layout"));
}

std::string fault_of(const plumbline_convention& c) {
  const auto check = [](const char* name, int32_t value, int32_t last) {
    return value >= 0 && value <= last
               ? std::string()
               : fmt::format("convention.{} = {}, expected 0 to {}", name, value, last);
  };
  for (const std::string& fault :
       {check("index_order", c.index_order, PLUMBLINE_INDEX_ZERO_FIRST),
        check("sign", c.sign, PLUMBLINE_SIGN_POSITIVE), check("norm", c.norm, PLUMBLINE_NORM_POLYNOMIAL),
        check("quantity", c.quantity, PLUMBLINE_QUANTITY_IRRADIANCE_OVER_PI_TWICE),
        check("layout", c.layout, PLUMBLINE_LAYOUT_PLANAR)}) {
    if (!fault.empty()) return fault;
  }
  if (is_permutation(c.axes)) return {};
  return fmt::format("convention.axes = {{{}, {}, {}}}, expected 1, 2, 3 in any order and sign, or all 0",
                     c.axes[0], c.axes[1], c.axes[2]);
}

sh::Convention sh_convention(const plumbline_convention& c) {
  constexpr std::array kArrangements{sh::Arrangement::ascending, sh::Arrangement::ascending,
                                     sh::Arrangement::descending, sh::Arrangement::xyz,
                                     sh::Arrangement::zero_first};
  constexpr std::array kNorms{sh::Normalization::orthonormal,  sh::Normalization::orthonormal,
                              sh::Normalization::four_pi,      sh::Normalization::schmidt,
                              sh::Normalization::unnormalized, sh::Normalization::polynomial};
  constexpr std::array kQuantities{sh::Quantity::radiance,
                                   sh::Quantity::radiance,
                                   sh::Quantity::radiance_over_pi,
                                   sh::Quantity::radiance_over_4pi,
                                   sh::Quantity::irradiance,
                                   sh::Quantity::irradiance_over_pi,
                                   sh::Quantity::irradiance_over_pi_twice};
  if (const std::string fault = fault_of(c); !fault.empty()) throw InputError(fault);
  sh::Convention result;
  result.arrangement = kArrangements.at(static_cast<std::size_t>(c.index_order));
  result.sign = c.sign == PLUMBLINE_SIGN_POSITIVE ? sh::Sign::positive : sh::Sign::condon_shortley;
  result.normalization = kNorms.at(static_cast<std::size_t>(c.norm));
  result.quantity = kQuantities.at(static_cast<std::size_t>(c.quantity));
  result.layout = c.layout == PLUMBLINE_LAYOUT_PLANAR ? sh::Layout::planar : sh::Layout::interleaved;
  for (std::size_t k = 0; k < 3 && c.axes[0] != 0; ++k) {
    result.axes.axis.at(k) = std::abs(c.axes[k]) - 1;
    result.axes.sign.at(k) = c.axes[k] > 0 ? 1 : -1;
  }
  return result;
}

Border::Border(const plumbline_convention& convention, int max_bands)
    : declared_(convention), convention_(sh_convention(convention)) {
  const int bands = usable_bands(max_bands);
  for (int l = 0; l < bands; ++l)
    for (const std::size_t source : sources(convention_, l))
      weights_.push_back(weight_of(convention_, source));
  sh::Convention radiance = convention_;
  radiance.quantity = sh::Quantity::radiance;
  for (int l = 0; l < bands; ++l)
    for (const std::size_t source : sources(radiance, l))
      basis_weights_.push_back(weight_of(radiance, source));
  if (convention_.axes == sh::SignedAxes{}) {
    for (int l = 0; l < bands; ++l) bands_.push_back(plain_band(convention_, l));
  } else {
    bands_ = turned_bands(convention_, bands);
  }
}

bool Border::knows_basis() const {
  return declared_.index_order != 0 && declared_.sign != 0 && declared_.norm != 0 && declared_.axes[0] != 0;
}

bool Border::knows_coefficients() const {
  return knows_basis() && declared_.quantity != 0;
}

int Border::usable_bands(int bands) const {
  const bool is_limited =
      declared_.quantity >= PLUMBLINE_QUANTITY_IRRADIANCE || declared_.norm == PLUMBLINE_NORM_POLYNOMIAL;
  return is_limited ? std::min(bands, 3) : bands;
}

std::vector<double> Border::to_theirs(int bands, const std::vector<double>& ours) const {
  return times(multiplied(bands_, bands, ours, false), weights_);
}
std::vector<double> Border::to_ours(int bands, const std::vector<double>& theirs) const {
  return multiplied(bands_, bands, over(theirs, weights_), true);
}
std::vector<double> Border::dual_to_theirs(int bands, const std::vector<double>& ours) const {
  return over(multiplied(bands_, bands, ours, false), weights_);
}
std::vector<double> Border::dual_to_ours(int bands, const std::vector<double>& theirs) const {
  return multiplied(bands_, bands, times(theirs, weights_), true);
}
std::vector<double> Border::basis_to_ours(int bands, const std::vector<double>& theirs) const {
  return multiplied(bands_, bands, times(theirs, basis_weights_), true);
}

std::vector<double> Border::rgb_to_ours(int bands, const std::vector<double>& theirs) const {
  const std::size_t count = size_of(bands);
  std::vector<double> result(3 * count);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    std::vector<double> one(count);
    for (std::size_t i = 0; i < count; ++i) {
      one[i] = theirs[convention_.layout == sh::Layout::planar ? channel * count + i : 3 * i + channel];
    }
    one = to_ours(bands, one);
    for (std::size_t i = 0; i < count; ++i) result[3 * i + channel] = one[i];
  }
  return result;
}

std::vector<double> convention_basis(const plumbline_convention& convention, int bands,
                                     const Vec3d& direction) {
  sh::Convention known = sh_convention(convention);
  known.quantity = sh::Quantity::radiance;
  const std::vector<double> textbook = checks::textbook_basis(bands, sh::apply(known.axes, direction));
  std::vector<double> result;
  for (int l = 0; l < bands; ++l)
    for (const std::size_t source : sources(known, l))
      result.push_back(textbook[source] / weight_of(known, source));
  return result;
}

std::optional<plumbline_convention> convention_of_basis(const std::vector<Vec3d>& directions,
                                                        const std::vector<double>& values) {
  for (const sh::SignedAxes& axes : sh::all_signed_axes()) {
    for (const int32_t sign : {PLUMBLINE_SIGN_CONDON_SHORTLEY, PLUMBLINE_SIGN_POSITIVE}) {
      for (int32_t norm = PLUMBLINE_NORM_ORTHONORMAL; norm <= PLUMBLINE_NORM_POLYNOMIAL; ++norm) {
        for (int32_t order = PLUMBLINE_INDEX_L_SQUARED; order <= PLUMBLINE_INDEX_ZERO_FIRST; ++order) {
          plumbline_convention convention = own_convention();
          convention.index_order = order;
          convention.sign = sign;
          convention.norm = norm;
          for (std::size_t k = 0; k < 3; ++k) convention.axes[k] = (axes.axis.at(k) + 1) * axes.sign.at(k);
          if (fits(convention, directions, values)) return convention;
        }
      }
    }
  }
  return std::nullopt;
}

}  // namespace plumbline::conformance
