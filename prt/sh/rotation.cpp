#include "prt/sh/rotation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "reference/base/error.hpp"

namespace plumbline::sh {
namespace {

/// Largest element of R^T R - 1; NaN where an element is.
double departure_from_orthonormal(const glm::dmat3& r) {
  const glm::dmat3 gram = glm::transpose(r) * r;
  double result = 0.0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double error = std::abs(gram[i][j] - (i == j ? 1.0 : 0.0));
      if (!(error <= result)) result = error;
      if (std::isnan(result)) return result;
    }
  }
  return result;
}

/// Start of degree l's block: the sum of (2k + 1)^2 for k < l.
std::size_t block_start(int degree) {
  const auto l = static_cast<std::size_t>(degree);
  return l == 0 ? 0 : l * (2 * l - 1) * (2 * l + 1) / 3;
}

// ---------------------------------------------------------------- Ivanic & Ruedenberg
//
// y_lm is a sum of products y_1i y_(l-1)a, and so is what it becomes when turned. With R^l the block of degree l
// and r = R^1, for |n| < l
//
//   R^l_mn = (l^2 - n^2)^(-1/2) * sum over terms (i, a, weight) of row m of  weight r_i0 R^(l-1)_an
//
// and for n = l and -l, with 1 / sqrt(2l (2l - 1)) in front,
//
//   r_i1 R^(l-1)_a,l-1 - r_i,-1 R^(l-1)_a,1-l     and     r_i1 R^(l-1)_a,1-l + r_i,-1 R^(l-1)_a,l-1.
//
// The terms are the u, v, w times U, V, W of the paper's tables 1 and 2, with one misprint put right: V at m < 0 is
// P_1,m+1 (1 - d) + P_-1,-m-1 sqrt(1 + d) with d = 1 at m = -1, else 0, the mirror of m > 0. (By the accounts of those
// who implemented it the tables of 1996, and the corrections of 1998 as well, have other signs under the root or
// before d there; any of these makes the blocks from degree 2 on differ from quadrature.) The paper's harmonics lack
// the Condon-Shortley phase of odd m; since each product has m = +-i +-a, the phases of its factors multiply to that of
// the result, and the recursion is the same with it.

struct Term {
  int i = 0;
  int a = 0;
  double weight = 0.0;
};
struct Terms {
  std::array<Term, 5> list;
  std::size_t count = 0;

  void add(int i, int a, double weight) {
    if (weight != 0.0) list[count++] = {i, a, weight};
  }
};

Terms terms_of_row(int l, int m) {
  const auto root = [](double x) { return std::sqrt(x); };
  const int k = std::abs(m);
  Terms terms;
  terms.add(0, m, root(static_cast<double>(l - m) * (l + m)));
  if (m == 0) {
    const double v = -0.5 * root(2.0 * l * (l - 1.0));
    terms.add(1, 1, v);
    terms.add(-1, -1, v);
    return terms;
  }
  const double v = 0.5 * root((l + k - 1.0) * (l + k));
  const double w = -0.5 * root((l - k - 1.0) * (l - k));
  const double at_one = k == 1 ? root(2.0) : 1.0;  // sqrt(1 + delta)
  const double not_one = k == 1 ? 0.0 : 1.0;       // 1 - delta
  if (m > 0) {
    terms.add(1, m - 1, v * at_one);
    terms.add(-1, 1 - m, -v * not_one);
    terms.add(1, m + 1, w);
    terms.add(-1, -m - 1, w);
  } else {
    terms.add(1, m + 1, v * not_one);
    terms.add(-1, -m - 1, v * at_one);
    terms.add(1, m - 1, w);
    terms.add(-1, 1 - m, -w);
  }
  return terms;
}

/// Fills degree l from degree l - 1. r: block of degree 1.
void fill_block(int l, const double* r, const double* previous, double* block, std::vector<double>& scale) {
  const int size = 2 * l + 1;
  const int inner = 2 * l - 1;  // size of the previous block, columns n = 1-l … l-1
  scale.resize(static_cast<std::size_t>(inner));
  for (int n = 1 - l; n < l; ++n) {
    scale[static_cast<std::size_t>(n + l - 1)] = 1.0 / std::sqrt(static_cast<double>(l - n) * (l + n));
  }
  const double end_scale = 1.0 / std::sqrt(2.0 * l * (2.0 * l - 1.0));
  for (int m = -l; m <= l; ++m) {
    double* row = block + static_cast<std::ptrdiff_t>(m + l) * size;
    std::fill(row, row + size, 0.0);
    const Terms terms = terms_of_row(l, m);
    for (std::size_t t = 0; t < terms.count; ++t) {
      const Term& term = terms.list[t];
      const double* source = previous + static_cast<std::ptrdiff_t>(term.a + l - 1) * inner;
      const double* r_i = r + static_cast<std::ptrdiff_t>(term.i + 1) * 3;
      const double middle = term.weight * r_i[1];
      for (int n = 0; n < inner; ++n) row[n + 1] += middle * source[n];
      row[0] += term.weight * (r_i[2] * source[0] + r_i[0] * source[inner - 1]);
      row[size - 1] += term.weight * (r_i[2] * source[inner - 1] - r_i[0] * source[0]);
    }
    for (int n = 0; n < inner; ++n) row[n + 1] *= scale[static_cast<std::size_t>(n)];
    row[0] *= end_scale;
    row[size - 1] *= end_scale;
  }
}

/// Degree 1: (y_1-1, y_10, y_11) = sqrt(3/4 pi) (-y, z, -x).
void fill_first_block(const glm::dmat3& rotation, double* block) {
  constexpr std::array<int, 3> axis{1, 2, 0};
  constexpr std::array<double, 3> sign{-1.0, 1.0, -1.0};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      block[3 * row + column] = sign[row] * sign[column] * rotation[axis[column]][axis[row]];
    }
  }
}

std::size_t require_lengths(int bands, std::size_t in, std::size_t out) {
  const auto count = static_cast<std::size_t>(coefficient_count(bands));
  if (in != count || out != count) {
    throw InputError("sh::Rotation::apply: expected " + std::to_string(count) +
                     " coefficients in and out, got " + std::to_string(in) + " and " + std::to_string(out));
  }
  return count;
}

template <class Real>
void apply_blocks(int bands, const double* block, std::span<const Real> in, std::span<Real> out) {
  const std::size_t count = require_lengths(bands, in.size(), out.size());
  std::size_t first = 0;
  for (std::size_t size = 1; first < count; first += size, size += 2) {
    for (std::size_t row = 0; row < size; ++row) {
      double sum = 0.0;
      for (std::size_t column = 0; column < size; ++column) {
        sum += block[column] * static_cast<double>(in[first + column]);
      }
      out[first + row] = static_cast<Real>(sum);
      block += size;
    }
  }
}

}  // namespace

int bands_of(std::size_t count, const char* where) {
  const auto bands = static_cast<int>(std::lround(std::sqrt(static_cast<double>(count))));
  if (bands < 1 || bands > kMaxBands || static_cast<std::size_t>(coefficient_count(bands)) != count) {
    throw InputError(std::string(where) + ": expected bands^2 coefficients for 1 to " +
                     std::to_string(kMaxBands) + " bands, got " + std::to_string(count));
  }
  return bands;
}

// Newton-Schulz, X <- X (3 - X^T X) / 2, converges to the polar factor, the nearest rotation; the departure e
// becomes 3/4 e^2, so that two steps take 1e-4 to rounding.
RotationMatrix::RotationMatrix(const glm::dmat3& matrix) : matrix_(matrix) {
  const double departure = departure_from_orthonormal(matrix);
  if (!(departure <= kTolerance) || !(glm::determinant(matrix) > 0.0)) {
    throw InputError("rotation: expected orthonormal columns and determinant 1, got determinant " +
                     std::to_string(glm::determinant(matrix)) + " and a departure of " +
                     std::to_string(departure) + " from orthonormal");
  }
  if (departure <= 4e-16) return;
  for (int step = 0; step < 2; ++step) {
    matrix_ = matrix_ * (1.5 * glm::dmat3(1.0) - 0.5 * (glm::transpose(matrix_) * matrix_));
  }
}

RotationMatrix rotation_from_quaternion(const glm::dquat& quaternion) {
  const double largest = std::max(std::max(std::abs(quaternion.w), std::abs(quaternion.x)),
                                  std::max(std::abs(quaternion.y), std::abs(quaternion.z)));
  const bool is_finite = std::isfinite(quaternion.w) && std::isfinite(quaternion.x) &&
                         std::isfinite(quaternion.y) && std::isfinite(quaternion.z);
  if (!(is_finite && largest > 0.0)) {
    throw InputError("rotation: expected a quaternion that is finite and not zero");
  }
  // Scaled first, so that the squares neither overflow nor vanish.
  const glm::dquat scaled(quaternion.w / largest, quaternion.x / largest, quaternion.y / largest,
                          quaternion.z / largest);
  return RotationMatrix(glm::mat3_cast(glm::normalize(scaled)));
}

RotationMatrix rotation_from_euler(const EulerZyz& angles) {
  if (!(std::isfinite(angles.alpha_rad) && std::isfinite(angles.beta_rad) &&
        std::isfinite(angles.gamma_rad))) {
    throw InputError("rotation: expected finite Euler angles");
  }
  const auto about_z = [](double angle) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    return glm::dmat3(Vec3d(c, s, 0.0), Vec3d(-s, c, 0.0), Vec3d(0.0, 0.0, 1.0));
  };
  const double c = std::cos(angles.beta_rad);
  const double s = std::sin(angles.beta_rad);
  const glm::dmat3 about_y(Vec3d(c, 0.0, -s), Vec3d(0.0, 1.0, 0.0), Vec3d(s, 0.0, c));
  return RotationMatrix(about_z(angles.alpha_rad) * about_y * about_z(angles.gamma_rad));
}

// R z = (sin b cos a, sin b sin a, cos b), and the middle row of Rz(-a) R = Ry(b) Rz(c) is (sin c, cos c, 0).
EulerZyz euler_of(const RotationMatrix& rotation) {
  const glm::dmat3& r = rotation.matrix();
  const double sin_beta = std::hypot(r[2].x, r[2].y);
  const double sin_alpha = sin_beta > 0.0 ? r[2].y / sin_beta : 0.0;
  const double cos_alpha = sin_beta > 0.0 ? r[2].x / sin_beta : 1.0;
  const double sin_gamma = cos_alpha * r[0].y - sin_alpha * r[0].x;
  const double cos_gamma = cos_alpha * r[1].y - sin_alpha * r[1].x;
  return {std::atan2(sin_alpha, cos_alpha), std::atan2(sin_beta, r[2].z), std::atan2(sin_gamma, cos_gamma)};
}

Rotation::Rotation(const RotationMatrix& rotation, int bands) : bands_(bands) {
  require_bands(bands);
  blocks_.resize(block_start(bands));
  blocks_[0] = 1.0;
  if (bands > 1) fill_first_block(rotation.matrix(), blocks_.data() + 1);
  std::vector<double> scale;
  for (int l = 2; l < bands; ++l) {
    fill_block(l, blocks_.data() + 1, blocks_.data() + block_start(l - 1), blocks_.data() + block_start(l),
               scale);
  }
}

Rotation::Rotation(const glm::dmat3& rotation, int bands) : Rotation(RotationMatrix(rotation), bands) {}

std::span<const double> Rotation::band(int degree) const {
  if (degree < 0 || degree >= bands_) {
    throw InputError("sh::Rotation::band: expected a degree in 0 to " + std::to_string(bands_ - 1) +
                     ", got " + std::to_string(degree));
  }
  const std::size_t start = block_start(degree);
  return std::span(blocks_).subspan(start, block_start(degree + 1) - start);
}

void Rotation::apply(std::span<const double> in, std::span<double> out) const {
  apply_blocks<double>(bands_, blocks_.data(), in, out);
}
void Rotation::apply_inverse(std::span<const double> in, std::span<double> out) const {
  const std::size_t count = require_lengths(bands_, in.size(), out.size());
  std::fill(out.begin(), out.end(), 0.0);
  const double* block = blocks_.data();
  std::size_t first = 0;
  for (std::size_t size = 1; first < count; first += size, size += 2) {
    for (std::size_t row = 0; row < size; ++row, block += size) {
      for (std::size_t column = 0; column < size; ++column) {
        out[first + column] += block[column] * in[first + row];
      }
    }
  }
}
void Rotation::apply(std::span<const float> in, std::span<float> out) const {
  apply_blocks<float>(bands_, blocks_.data(), in, out);
}

std::vector<double> rotate(const std::vector<double>& coefficients, const glm::dmat3& rotation) {
  std::vector<double> result(coefficients.size());
  Rotation(rotation, bands_of(coefficients.size(), "sh::rotate")).apply(coefficients, result);
  return result;
}

ShRgb rotate(const ShRgb& function, const glm::dmat3& rotation) {
  if (bands_of(function.coefficients.size(), "sh::rotate") != function.bands) {
    throw InputError("sh::rotate: expected " + std::to_string(function.bands) + " bands, got " +
                     std::to_string(function.coefficients.size()) + " coefficients");
  }
  const Rotation matrices(rotation, function.bands);
  ShRgb result = function;
  std::vector<double> in(function.coefficients.size());
  std::vector<double> out(in.size());
  for (int channel = 0; channel < 3; ++channel) {
    for (std::size_t i = 0; i < in.size(); ++i) in[i] = function.coefficients[i][channel];
    matrices.apply(in, out);
    for (std::size_t i = 0; i < out.size(); ++i) result.coefficients[i][channel] = out[i];
  }
  return result;
}

}  // namespace plumbline::sh
