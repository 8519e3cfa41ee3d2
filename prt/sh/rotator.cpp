#include "prt/sh/rotator.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <type_traits>

#include "prt/sh/rotator_kernels.hpp"
#include "reference/base/error.hpp"

namespace plumbline::sh {
namespace {

template <class Real>
constexpr bool is_sampled(int bands) {
  return std::is_same_v<Real, float> && bands >= 2 && bands <= rotator::kMostSampledBands;
}

// ---------------------------------------------------------------- values in fixed directions
//
// A function of degree l alone is known from its values v_k = f(d_k) in 2l + 1 directions: f_lm = sum over k of
// B_mk v_k, B the inverse of Y_km = y_lm(d_k). Of the turned function v_k = f(R^-1 d_k). The directions below were
// searched for, so that for every l to 7 the first 2l + 1 serve well: the Frobenius norm of B is no more than 1.6
// times its lower bound sqrt(4 pi) (which any set of directions for which Y's columns are orthogonal reaches).

constexpr std::array<std::array<double, 3>, 15> kDirections{{{-0.14, 0.12, 0.98},
                                                             {-0.89, -0.46, -0.06},
                                                             {-0.14, 0.52, -0.84},
                                                             {0.59, 0.72, 0.37},
                                                             {-0.21, -0.87, 0.45},
                                                             {-0.24, -0.48, 0.84},
                                                             {0.32, 0.20, 0.93},
                                                             {-0.11, -0.48, -0.87},
                                                             {-0.50, -0.73, 0.47},
                                                             {-0.37, -0.65, -0.67},
                                                             {0.65, 0.50, 0.57},
                                                             {0.69, -0.70, -0.19},
                                                             {0.97, -0.13, -0.20},
                                                             {0.38, 0.92, -0.09},
                                                             {0.89, 0.39, -0.23}}};

Vec3d direction(std::size_t k) {
  return glm::normalize(Vec3d(kDirections[k][0], kDirections[k][1], kDirections[k][2]));
}

// y_lm = q_l^m(z) Re (-x - iy)^m with q_l = a_l z q_(l-1) - b_l q_(l-2) (basis.cpp). Divided by its leading
// coefficient c_lm = q_m^m a_m+1 … a_l it is monic: p_l = z p_(l-1) - beta_l p_(l-2), beta_l = b_l / (a_l a_(l-1))
// = ((l - 1)^2 - m^2) / ((2l - 1)(2l - 3)).
void fill_recurrence(int bands, std::vector<float>& table) {
  for (int m = 0; m < bands; ++m) {
    double square = 1.0 / (4.0 * kPi);
    for (int k = 1; k <= m; ++k) square *= (2.0 * k + 1.0) / (2.0 * k);
    double scale = std::sqrt(m > 0 ? 2.0 * square : square) * (m % 2 == 1 ? -1.0 : 1.0);
    for (int l = m; l < bands; ++l) {
      if (l > m) scale *= std::sqrt((4.0 * l * l - 1.0) / (l * l - m * m));
      table[static_cast<std::size_t>(rotator::kScales + index(l, m))] = static_cast<float>(scale);
      table[static_cast<std::size_t>(rotator::kScales + index(l, -m))] = static_cast<float>(scale);
      if (l < m + 2) continue;
      const double beta = ((l - 1.0) * (l - 1.0) - m * m) / ((2.0 * l - 1.0) * (2.0 * l - 3.0));
      table[static_cast<std::size_t>(rotator::kRecurrence + index(l, m))] = static_cast<float>(beta);
    }
  }
}

std::vector<float> sample_tables(int bands) {
  std::vector<float> table(static_cast<std::size_t>(rotator::columns_start(bands)), 0.0F);
  for (std::size_t k = 0; k < static_cast<std::size_t>(2 * bands - 1); ++k) {
    for (int axis = 0; axis < 3; ++axis) {
      table[static_cast<std::size_t>(axis * rotator::kSamples) + k] = static_cast<float>(direction(k)[axis]);
    }
  }
  fill_recurrence(bands, table);
  for (int l = 1; l < bands; ++l) {
    const int count = 2 * l + 1;
    Eigen::MatrixXd values(count, count);
    for (int k = 0; k < count; ++k) {
      // The direction as the kernel has it, in float: its rounding is no error then.
      const auto at = static_cast<std::size_t>(k);
      const std::vector<double> y = evaluate_basis(
          l + 1, Vec3d(table[at], table[at + rotator::kSamples], table[at + 2 * rotator::kSamples]));
      for (int m = -l; m <= l; ++m) values(k, m + l) = y[static_cast<std::size_t>(index(l, m))];
    }
    const Eigen::MatrixXd inverse = values.inverse();
    float* columns = table.data() + rotator::columns_start(l);
    for (int k = 0; k < count; ++k) {
      for (int m = 0; m < count; ++m) {
        columns[k * rotator::result_width(l) + m] = static_cast<float>(inverse(m, k));
      }
    }
  }
  return table;
}

// ---------------------------------------------------------------- turns about z and exchanges of y and z
//
// Half a turn about the axis between y and z, P: (x, y, z) -> (-x, z, y), is its own inverse, and P Rz(b) P turns by
// b about P z = y. Its blocks take parity in y to parity in z and keep that in x, so that of the four classes of
// coefficients each goes to one: a quarter of the matrix is not zero.

/// m of place j of a row (rotator_kernels.hpp).
int degree_order(int row, int j) {
  const int m = row % 2 == 0 ? 2 * j : 2 * j + 1;
  return row < 2 ? m : -m;
}

template <class Real>
std::vector<Real> exchange_tables(int bands) {
  const glm::dmat3 half_turn(Vec3d(-1.0, 0.0, 0.0), Vec3d(0.0, 0.0, 1.0), Vec3d(0.0, 1.0, 0.0));
  const Rotation exchange(half_turn, bands);
  std::vector<Real> table;
  for (int l = 1; l < bands; ++l) {
    const std::span<const double> block = exchange.band(l);
    for (int row = 0; row < 4; ++row) {
      const int target = rotator::exchanged_row(l, row);
      for (int j = 0; j < rotator::row_size(l, row); ++j) {
        const bool is_dummy = row == 2 && j == 0;
        for (int i = 0; i < rotator::row_width(l); ++i) {
          const bool is_padding = i >= rotator::row_size(l, target) || (target == 2 && i == 0);
          const int to = degree_order(target, i) + l;
          const int from = degree_order(row, j) + l;
          table.push_back(is_dummy || is_padding
                              ? Real(0)
                              : static_cast<Real>(block[static_cast<std::size_t>(to * (2 * l + 1) + from)]));
        }
      }
    }
  }
  return table;
}

struct CosineSine {
  double cosine = 1.0;
  double sine = 0.0;
};

/// euler_of() without the angles.
std::array<CosineSine, 3> gamma_beta_alpha(const glm::dmat3& r) {
  const double sin_beta = std::sqrt(r[2].x * r[2].x + r[2].y * r[2].y);
  CosineSine alpha;
  if (sin_beta > 0.0) alpha = {r[2].x / sin_beta, r[2].y / sin_beta};
  const CosineSine gamma{alpha.cosine * r[1].y - alpha.sine * r[1].x,
                         alpha.cosine * r[0].y - alpha.sine * r[0].x};
  return {gamma, CosineSine{r[2].z, sin_beta}, alpha};
}

/// Cosines and sines of multiples, as the kernel wants them.
template <class Real>
void fill_turns(const std::array<CosineSine, 3>& angles, int bands, std::size_t stride, Real* turns) {
  for (const CosineSine& angle : angles) {
    CosineSine multiple;
    for (int m = 0; m < bands; ++m) {
      const std::size_t place = static_cast<std::size_t>(m / 2) + (m % 2 == 0 ? std::size_t{0} : stride);
      turns[place] = static_cast<Real>(multiple.cosine);
      turns[place + 2 * stride] = static_cast<Real>(multiple.sine);
      multiple = {multiple.cosine * angle.cosine - multiple.sine * angle.sine,
                  multiple.cosine * angle.sine + multiple.sine * angle.cosine};
    }
    turns += 4 * stride;
  }
}

template <class Real>
void rotate_exchanged(int bands, const Real* tables, const glm::dmat3& matrix, const Real* in, Real* out) {
  const auto stride = static_cast<std::size_t>(rotator::row_width(bands - 1));
  constexpr std::size_t kOnStack = 2 * rotator::kRowStep;
  const auto run = [&](Real* room) {
    fill_turns(gamma_beta_alpha(matrix), bands, stride, room);
    rotator::rotate_by_exchange(bands, tables, room, in, out, room + 12 * stride);
  };
  if (stride <= kOnStack) {
    std::array<Real, 20 * kOnStack> room{};
    run(room.data());
  } else {
    std::vector<Real> room(20 * stride);
    run(room.data());
  }
}

void rotate_sampled(int bands, const float* tables, const glm::dmat3& matrix, const float* in, float* out) {
  std::array<float, 9> rows{};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rows[static_cast<std::size_t>(3 * i + j)] = static_cast<float>(matrix[j][i]);
  }
  rotator::rotate_by_samples(bands, tables, rows.data(), in, out);
}

}  // namespace

template <class Real>
Rotator<Real>::Rotator(int bands) : bands_(bands) {
  require_bands(bands);
  if constexpr (std::is_same_v<Real, float>) {
    if (is_sampled<Real>(bands)) {
      tables_ = sample_tables(bands);
      return;
    }
  }
  tables_ = exchange_tables<Real>(bands);
}

template <class Real>
void Rotator<Real>::apply(const RotationMatrix& rotation, std::span<const Real> in,
                          std::span<Real> out) const {
  const auto count = static_cast<std::size_t>(coefficient_count(bands_));
  if (in.size() != count || out.size() != count) {
    throw InputError("sh::Rotator::apply: expected " + std::to_string(count) +
                     " coefficients in and out, got " + std::to_string(in.size()) + " and " +
                     std::to_string(out.size()));
  }
  if constexpr (std::is_same_v<Real, float>) {
    if (is_sampled<Real>(bands_)) {
      return rotate_sampled(bands_, tables_.data(), rotation.matrix(), in.data(), out.data());
    }
  }
  rotate_exchanged(bands_, tables_.data(), rotation.matrix(), in.data(), out.data());
}

template <class Real>
void Rotator<Real>::apply(const glm::dmat3& rotation, std::span<const Real> in, std::span<Real> out) const {
  apply(RotationMatrix(rotation), in, out);
}

template class Rotator<float>;
template class Rotator<double>;

void apply_to_many(const Rotation& rotation, std::size_t count, std::span<const float> in,
                   std::span<float> out) {
  const std::size_t expected = static_cast<std::size_t>(coefficient_count(rotation.bands())) * count;
  if (in.size() != expected || out.size() != expected) {
    throw InputError("sh::apply_to_many: expected " + std::to_string(expected) + " numbers in and out, got " +
                     std::to_string(in.size()) + " and " + std::to_string(out.size()));
  }
  std::vector<float> blocks;
  for (int l = 0; l < rotation.bands(); ++l) {
    for (const double element : rotation.band(l)) blocks.push_back(static_cast<float>(element));
  }
  rotator::apply_blocks_to_many(rotation.bands(), blocks.data(), count, in.data(), out.data());
}

}  // namespace plumbline::sh
