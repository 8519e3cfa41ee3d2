#include "prt/sh/basis.hpp"

#include <array>
#include <cmath>
#include <string>
#include <type_traits>
#include <utility>

#include "prt/sh/recurrence.hpp"
#include "reference/base/error.hpp"

namespace plumbline::sh {
namespace {

// The recurrence of recurrence.hpp, in double. The loops run over l outside and m inside, so that the inner ones have
// no dependence and vectorise. Row l holds q_l^l, then alpha, beta and gamma of m = 0 … l-1: 3 l + 1 numbers.

constexpr std::size_t row_start(int l) {
  return static_cast<std::size_t>(l) +
         3 * (static_cast<std::size_t>(l) * static_cast<std::size_t>(l - 1) / 2);
}

std::vector<double> recurrence_constants(int bands) {
  std::vector<double> constants(row_start(bands));
  const std::vector<double> starts = recurrence_starts<double>(bands);
  for (int l = 0; l < bands; ++l) {
    const auto length = static_cast<std::size_t>(l);
    double* row = constants.data() + row_start(l);
    *row++ = starts[length];
    for (int m = 0; m < l; ++m, ++row) {
      const RecurrenceStep<double> step = recurrence_step<double>(l, m);
      row[0] = step.alpha;
      row[length] = step.beta;
      row[2 * length] = step.gamma;
    }
  }
  return constants;
}

/// 1 - |z| of a unit vector, to all digits at the poles.
double height_below_pole(double x, double y, double z) {
  return (x * x + y * y) / (1.0 + std::abs(z));
}

template <class Store>
void evaluate_rows(int bands, const double* constants, double x, double y, double z, Store* values) {
  std::array<double, kMaxBands> q;
  std::array<double, kMaxBands> difference;
  std::array<double, kMaxBands> re;  // Re (-x - iy)^m
  std::array<double, kMaxBands> im;
  const double t = height_below_pole(x, y, z);
  const double sign = z < 0.0 ? -1.0 : 1.0;
  re[0] = recurrence_scale<double>(bands);
  im[0] = 0.0;
  for (int l = 0; l < bands; ++l) {
    const auto size = static_cast<std::size_t>(l);
    const double* alpha = constants + 1;
    const double* beta = alpha + l;
    const double* gamma = beta + l;
    for (std::size_t m = 0; m < size; ++m) {
      difference[m] = sign * (alpha[m] * difference[m] - beta[m] * t * q[m]);
      q[m] = sign * gamma[m] * q[m] + difference[m];
    }
    q[size] = constants[0];
    difference[size] = 0.0;
    constants = gamma + l;
    if (l > 0) {
      re[size] = y * im[size - 1] - x * re[size - 1];
      im[size] = -x * im[size - 1] - y * re[size - 1];
    }
    Store* centre = values + index(l, 0);
    for (int m = 0; m <= l; ++m) centre[m] = static_cast<Store>(q.data()[m] * re.data()[m]);
    for (int m = 1; m <= l; ++m) centre[-m] = static_cast<Store>(q.data()[m] * im.data()[m]);
  }
}

// The same recurrence as straight-line code for bands known at compile time, column by column.
template <int kL, int kM, class Store>
void store_pair(double q, double re, double im, Store* values) {
  values[index(kL, kM)] = static_cast<Store>(q * re);
  if constexpr (kM > 0) values[index(kL, -kM)] = static_cast<Store>(q * im);
}

/// What a direction is to the recurrence.
struct Place {
  double x;
  double y;
  double t;     // 1 - |z|
  double sign;  // of z
};

template <int kBands, int kM, class Store>
void evaluate_column(const double* constants, const Place& at, double re, double im, Store* values) {
  double difference = 0.0;
  double q = constants[row_start(kM)];
  store_pair<kM, kM>(q, re, im, values);
  const auto step = [&]<int kL>(std::integral_constant<int, kL>) {
    const double* row = constants + row_start(kL) + 1 + kM;
    if constexpr (kL > kM + 1) {
      difference = at.sign * (row[0] * difference - row[kL] * at.t * q);
    } else {
      difference = at.sign * (-row[kL] * at.t * q);
    }
    q = at.sign * row[2 * kL] * q + difference;
    store_pair<kL, kM>(q, re, im, values);
  };
  [&]<int... kStep>(std::integer_sequence<int, kStep...>) {
    (step(std::integral_constant<int, kM + 1 + kStep>{}), ...);
  }
  (std::make_integer_sequence<int, kBands - 1 - kM>{});
}

template <int kBands, class Store>
void evaluate_unrolled(const double* constants, double x, double y, double z, Store* values) {
  const Place at{x, y, height_below_pole(x, y, z), z < 0.0 ? -1.0 : 1.0};
  double re = recurrence_scale<double>(kBands);
  double im = 0.0;
  const auto column = [&]<int kM>(std::integral_constant<int, kM>) {
    if constexpr (kM > 0) {
      const double next = y * im - x * re;
      im = -x * im - y * re;
      re = next;
    }
    evaluate_column<kBands, kM>(constants, at, re, im, values);
  };
  [&]<int... kM>(std::integer_sequence<int, kM...>) {
    (column(std::integral_constant<int, kM>{}), ...);
  }
  (std::make_integer_sequence<int, kBands>{});
}

// The polynomials of up to five bands with their constants multiplied out.
constexpr int kClosedBands = 5;

template <int kBands, class Real>
void evaluate_closed(Real x, Real y, Real z, Real* out) {
  out[0] = Real(0.282094791773878143474);  // 1 / sqrt(4 pi)
  if constexpr (kBands > 1) {
    constexpr auto k1 = Real(0.4886025119029199215864);  // sqrt(3 / 4 pi)
    out[1] = -k1 * y;
    out[2] = k1 * z;
    out[3] = -k1 * x;
  }
  if constexpr (kBands > 2) {
    const Real zz = z * z;
    const Real re2 = x * x - y * y;
    const Real im2 = Real(2) * x * y;
    constexpr auto k20 = Real(0.9461746957575600180927);   // 3 sqrt(5 / 16 pi)
    constexpr auto k20c = Real(0.3153915652525200060309);  // sqrt(5 / 16 pi)
    constexpr auto k21 = Real(1.092548430592079070543);    // sqrt(15 / 4 pi)
    constexpr auto k22 = Real(0.5462742152960395352717);   // sqrt(15 / 16 pi)
    const Real q21 = -k21 * z;
    out[4] = k22 * im2;
    out[5] = q21 * y;
    out[6] = k20 * zz - k20c;
    out[7] = q21 * x;
    out[8] = k22 * re2;
    if constexpr (kBands > 3) {
      const Real re3 = x * re2 - y * im2;
      const Real im3 = x * im2 + y * re2;
      constexpr auto k30 = Real(1.865881662950576957072);    // 5 sqrt(7 / 16 pi)
      constexpr auto k30c = Real(1.119528997770346174243);   // 3 sqrt(7 / 16 pi)
      constexpr auto k31 = Real(2.285228997322328680790);    // 5 sqrt(21 / 32 pi)
      constexpr auto k31c = Real(0.4570457994644657361580);  // sqrt(21 / 32 pi)
      constexpr auto k32 = Real(1.445305721320277027695);    // sqrt(105 / 16 pi)
      constexpr auto k33 = Real(0.5900435899266435103456);   // sqrt(35 / 32 pi)
      const Real q31 = k31c - k31 * zz;
      const Real q32 = k32 * z;
      out[9] = -k33 * im3;
      out[10] = q32 * im2;
      out[11] = q31 * y;
      out[12] = z * (k30 * zz - k30c);
      out[13] = q31 * x;
      out[14] = q32 * re2;
      out[15] = -k33 * re3;
      if constexpr (kBands > 4) {
        constexpr auto k40 = Real(3.702494142032150633097);    // 105 / (16 sqrt(pi))
        constexpr auto k40b = Real(3.173566407456129114083);   // 90 / (16 sqrt(pi))
        constexpr auto k40c = Real(0.3173566407456129114083);  // 9 / (16 sqrt(pi))
        constexpr auto k41 = Real(4.683325804901024175665);    // 21 sqrt(5 / 32 pi)
        constexpr auto k41c = Real(2.007139630671867503856);   // 9 sqrt(5 / 32 pi)
        constexpr auto k42 = Real(3.311611435151460063324);    // 21 sqrt(5 / 64 pi)
        constexpr auto k42c = Real(0.4730873478787800090463);  // 3 sqrt(5 / 64 pi)
        constexpr auto k43 = Real(1.770130769779930531037);    // sqrt(315 / 32 pi)
        constexpr auto k44 = Real(0.6258357354491761345866);   // sqrt(315 / 256 pi)
        const Real q41 = z * (k41c - k41 * zz);
        const Real q42 = k42 * zz - k42c;
        const Real q43 = -k43 * z;
        out[16] = k44 * (Real(2) * re2 * im2);
        out[17] = q43 * im3;
        out[18] = q42 * im2;
        out[19] = q41 * y;
        out[20] = zz * (k40 * zz - k40b) + k40c;
        out[21] = q41 * x;
        out[22] = q42 * re2;
        out[23] = q43 * re3;
        out[24] = k44 * (re2 * re2 - im2 * im2);
      }
    }
  }
}

[[noreturn]] void refuse_short_values(std::size_t size, int bands) {
  throw InputError("sh::Basis::evaluate: expected room for " + std::to_string(coefficient_count(bands)) +
                   " values, got " + std::to_string(size));
}

}  // namespace

void require_bands(int bands) {
  if (bands < 1 || bands > kMaxBands) {
    throw InputError("bands: expected 1 to " + std::to_string(kMaxBands) + ", got " + std::to_string(bands));
  }
}

template <class Real>
Basis<Real>::Basis(int bands) : bands_(bands) {
  require_bands(bands);
  if (bands > kClosedBands) constants_ = recurrence_constants(bands);
}

template <class Real>
void Basis<Real>::evaluate(Real x, Real y, Real z, std::span<Real> values) const {
  if (values.size() < static_cast<std::size_t>(coefficient_count())) {
    refuse_short_values(values.size(), bands_);
  }
  Real* out = values.data();
  const double* constants = constants_.data();
  switch (bands_) {
    case 1:
      return evaluate_closed<1>(x, y, z, out);
    case 2:
      return evaluate_closed<2>(x, y, z, out);
    case 3:
      return evaluate_closed<3>(x, y, z, out);
    case 4:
      return evaluate_closed<4>(x, y, z, out);
    case 5:
      return evaluate_closed<5>(x, y, z, out);
    case 6:
      return evaluate_unrolled<6, Real>(constants, x, y, z, out);
    case 7:
      return evaluate_unrolled<7, Real>(constants, x, y, z, out);
    case 8:
      return evaluate_unrolled<8, Real>(constants, x, y, z, out);
    case 9:
      return evaluate_unrolled<9, Real>(constants, x, y, z, out);
    case 10:
      return evaluate_unrolled<10, Real>(constants, x, y, z, out);
    default:
      return evaluate_rows<Real>(bands_, constants, x, y, z, out);
  }
}

template class Basis<float>;
template class Basis<double>;

std::vector<double> evaluate_basis_by_recurrence(int bands, const Vec3d& direction) {
  require_bands(bands);
  const std::vector<double> constants = recurrence_constants(bands);
  std::vector<double> values(static_cast<std::size_t>(coefficient_count(bands)));
  evaluate_rows<double>(bands, constants.data(), direction.x, direction.y, direction.z, values.data());
  return values;
}

std::vector<double> evaluate_basis(int bands, const Vec3d& direction) {
  const Basis<double> basis(bands);
  std::vector<double> values(static_cast<std::size_t>(basis.coefficient_count()));
  basis.evaluate(direction.x, direction.y, direction.z, values);
  return values;
}

}  // namespace plumbline::sh
