// Rotation, products, exponentials, zonal rotation, windows, dominant direction, misuse of arrays.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "prt/sh/product.hpp"
#include "prt/sh/zonal.hpp"
#include "validation/conformance/faults/build.hpp"

namespace plumbline::conformance {
namespace {

using I = plumbline_implementation;

void other_signs(int n, const double* in, double* out) {
  for (int l = 0; l < n; ++l)
    for (int m = -l; m <= l; ++m) out[at(l, m)] = m % 2 != 0 ? -in[at(l, m)] : in[at(l, m)];
}

int rotate_other_sign(std::int32_t n, const double* r, const double* in, double* out) {
  std::vector<double> c(count_of(n));
  other_signs(n, in, c.data());
  const int status = plumbline_sh().rotate(n, r, c.data(), out);
  other_signs(n, std::vector<double>(out, out + count_of(n)).data(), out);
  return status;
}

int rotate_transposed(std::int32_t n, const double* r, const double* in, double* out) {
  const double t[9] = {r[0], r[3], r[6], r[1], r[4], r[7], r[2], r[5], r[8]};
  return plumbline_sh().rotate(n, t, in, out);
}

/// Rz(gamma) Ry(beta) Rz(alpha) for Rz(alpha) Ry(beta) Rz(gamma).
int rotate_reversed(std::int32_t n, const double* r, const double* in, double* out) {
  const double beta = std::acos(std::fmin(1.0, std::fmax(-1.0, r[8])));
  const double alpha = std::atan2(r[5], r[2]);
  const double gamma = std::atan2(r[7], -r[6]);
  const auto about = [](double angle, const Vec3d& axis) {
    return glm::dmat3(glm::rotate(glm::dmat4(1.0), angle, axis));
  };
  const glm::dmat3 m = about(gamma, {0, 0, 1}) * about(beta, {0, 1, 0}) * about(alpha, {0, 0, 1});
  double rows[9];
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) rows[3 * row + column] = m[column][row];
  return plumbline_sh().rotate(n, rows, in, out);
}

int rotate_with_band_1_signs(std::int32_t n, const double* r, const double* in, double* out) {
  const int status = plumbline_sh().rotate(n, r, in, out);
  if (1 < n) {
    const double x = -in[3];
    const double y = -in[1];
    const double z = in[2];
    out[3] = -(r[0] * x - r[1] * y + r[2] * z);  // one sign of the 3 x 3 block
    out[1] = -(r[3] * x + r[4] * y + r[5] * z);
    out[2] = r[6] * x + r[7] * y + r[8] * z;
  }
  return status;
}

std::vector<Fault> rotation_faults() {
  return {
      {"M21", "sh-lib #1, LichtFeld #883", "rotation right for the other sign convention",
       "rotate: 13 rotations", "other sign convention", ours_with(&I::rotate, rotate_other_sign)},
      {"M22", "SHTOOLS #184", "rotation and basis of different phase when it is not the default",
       "rotate: fits its own basis", "do not belong together", ours_with(&I::rotate, rotate_other_sign)},
      {"T15a", "andrewwillmott/sh-lib #1", "a sign in the block of band 1", "rotate: energy of each band", "",
       ours_with(&I::rotate, rotate_with_band_1_signs)},
      {"T15b", "row and column vectors mixed up", "transposed rotation", "rotate: 13 rotations", "transposed",
       ours_with(&I::rotate, rotate_transposed)},
      {"T15c", "Euler angles in the other order", "order of composition", "rotate: 13 rotations",
       "order of composition", ours_with(&I::rotate, rotate_reversed)},
      {"T10b", "A_l and c_l confused", "rotate_zonal lacks sqrt(4 pi/(2l + 1))", "rotate zonal: random lobes",
       "sqrt(4 pi/(2l + 1)) is missing",
       ours_with(
           &I::rotate_zonal,
           +[](std::int32_t n, const double* zonal, const double* axis, double* out) {
             const int status = plumbline_sh().rotate_zonal(n, zonal, axis, out);
             scale_bands(n, out, 1, [](int l) { return std::sqrt((2.0 * l + 1.0) / (4.0 * kPi)); });
             return status;
           })},
  };
}

// ---------------------------------------------------------------- products and exponentials
using Values = std::vector<double>;

/// exp(a + f) = e^a (1 + f + f^2/2 + ...), the constant's share a = scale f_0, `terms` terms; kSlip reads the wrong index.
template <int kTerms, bool kSlips>
int series(std::int32_t n, const double* in, double* out, double scale) {
  Values f(in, in + count_of(n));
  const double factor = std::exp(f[0] * scale);
  f[0] = 0.0;
  Values power(f.size(), 0.0);
  power[0] = std::sqrt(4.0 * kPi);
  Values sum = power;
  for (int k = 1; k <= kTerms; ++k) {
    power = sh::product(power, f);
    for (double& v : power) v /= k;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += kSlips ? power[i == 0 ? 0 : i - 1] : power[i];
  }
  for (std::size_t i = 0; i < sum.size(); ++i) out[i] = factor * sum[i];
  return 0;
}

std::vector<Fault> product_faults() {
  return {
      {"M8", "sebh/HLSL-SH shProduct", "terms of other functions: y w, z w, w w of band 1",
       "multiply: each pair", "wrong terms",
       ours_with(
           &I::multiply,
           +[](std::int32_t n, const double* a, const double* b, double* out) {
             const int status = plumbline_sh().multiply(n, a, b, out);
             if (1 < n) out[2] += 0.2820948 * (a[1] * b[3] + a[3] * b[1]);
             if (2 < n) out[6] -= 0.0616 * a[3] * b[3];
             return status;
           })},
      {"T13", "sebh/HLSL-SH #1", "plus for minus in one term", "multiply: (1 + z)^2", "",
       ours_with(
           &I::multiply,
           +[](std::int32_t n, const double* a, const double* b, double* out) {
             const int status = plumbline_sh().multiply(n, a, b, out);
             if (2 < n) out[6] -= 2.0 * 0.252313252202 * a[2] * b[2];
             return status;
           })},
      {"S18", "0.282 left out", "product without the constant 1/sqrt(4 pi) of y_00",
       "multiply: against quadrature", "sqrt(4 pi) times too large",
       ours_with(
           &I::multiply,
           +[](std::int32_t n, const double* a, const double* b, double* out) {
             const int status = plumbline_sh().multiply(n, a, b, out);
             scale_bands(n, out, 1, [](int) { return std::sqrt(4.0 * kPi); });
             return status;
           })},
      {"M14a", "shexp-demo vert.glsl", "exp(f_0 / sqrt(4/pi)) for exp(f_0 / sqrt(4 pi))",
       "exponential: constants", "the constant part is exp(3.142 a)",
       ours_with(
           &I::exponential, +[](std::int32_t n, const double* in,
                                double* out) { return series<6, false>(n, in, out, std::sqrt(kPi) / 2.0); })},
      {"M14b", "shexp-demo, PS-9 path", "integer 1/i ends the series after one term",
       "exponential: beats the first order", "terms beyond the first",
       ours_with(
           &I::exponential,
           +[](std::int32_t n, const double* in, double* out) {
             return series<1, false>(n, in, out, 1.0 / std::sqrt(4.0 * kPi));
           })},
      {"M14c", "shexp-demo, PS-9 path", "g[i] += a[j]: an index slips", "exponential: small functions",
       "band",
       ours_with(
           &I::exponential,
           +[](std::int32_t n, const double* in, double* out) {
             return series<6, true>(n, in, out, 1.0 / std::sqrt(4.0 * kPi));
           })},
      {"S8", "log of the coefficient", "log(f_0) where log(f_0 / sqrt(4 pi)) is meant",
       "logarithm: constants", "",
       ours_with(
           &I::logarithm,
           +[](std::int32_t n, const double* in, double* out) {
             std::fill_n(out, count_of(n), 0.0);
             out[0] = std::log(in[0]) * std::sqrt(4.0 * kPi);
             for (std::size_t i = 1; i < count_of(n); ++i) out[i] = in[i] * std::sqrt(4.0 * kPi) / in[0];
             return 0;
           })},
      {"LOGNAN", "logarithm by eigenvalues without clipping", "NaN where the function is not positive",
       "logarithm: functions that are not positive", "NaN",
       ours_with(
           &I::logarithm,
           +[](std::int32_t n, const double* in, double* out) {
             const Values c(in, in + count_of(n));
             const Values result = truths::composed(n, c, [](double v) { return std::log(v); });
             std::copy(result.begin(), result.end(), out);
             return 0;
           })},
      {"EXPNAN", "product series without scaling", "Inf - Inf for large functions",
       "exponential: large functions", "NaN",
       ours_with(
           &I::exponential,
           +[](std::int32_t n, const double* in, double* out) {
             const int status = series<8, false>(n, in, out, 1.0 / std::sqrt(4.0 * kPi));
             if (std::abs(out[0]) > 1e6) out[0] = std::nan("");
             return status;
           })},
  };
}

// ---------------------------------------------------------------- windows, directions, arrays
/// lambda from the energy of m >= -1 only.
int window_by_part(std::int32_t n, const double* in, double* out) {
  double energy = 0.0;
  for (int l = 2; l < n; ++l)
    for (int m = -1; m <= l; ++m) energy += in[at(l, m)] * in[at(l, m)] * l * l;
  const double lambda = 0.002 * energy / std::max(1e-12, in[0] * in[0]);
  std::copy(in, in + count_of(n), out);
  scale_bands(n, out, 1, [lambda](int l) { return 1.0 / (1.0 + lambda * l * l * (l + 1.0) * (l + 1.0)); });
  return 0;
}

std::vector<Fault> other_faults() {
  return {
      {"M9", "Probulator shFindWindowingLambda", "sum over m from -1 instead of -l",
       "window: the same however", "depends on how the function is turned",
       ours_with(&I::window, window_by_part)},
      {"T16", "Filament #744, Babylon #13809", "the window scales band 0 too", "window: one factor a band",
       "band 0", unary_then<&I::window, [](int, double* out) { out[0] *= 0.9; }>()},
      {"T17b", "StereoKit #1293", "NaN for zero coefficients", "dominant direction: no light", "NaN",
       ours_with(
           &I::dominant_direction,
           +[](std::int32_t, const double* c, double* direction) {
             const double length = std::sqrt(c[1] * c[1] + c[2] * c[2] + c[3] * c[3]);
             direction[0] = -c[3] / length;
             direction[1] = -c[1] / length;
             direction[2] = c[2] / length;
             return 0;
           })},
      {"GUARD", "off by one", "writes one coefficient too many", "rotate zonal: random lobes",
       "writes outside its output",
       ours_with(
           &I::rotate_zonal,
           +[](std::int32_t n, const double* zonal, const double* axis, double* out) {
             const int status = plumbline_sh().rotate_zonal(n, zonal, axis, out);
             out[count_of(n)] = 0.0;
             return status;
           })},
      {"PART", "fixed at 3 bands", "leaves higher bands unwritten", "rotate zonal: random lobes", "unwritten",
       ours_with(
           &I::rotate_zonal,
           +[](std::int32_t n, const double* zonal, const double* axis, double* out) {
             return plumbline_sh().rotate_zonal(std::min(n, 3), zonal, axis, out);
           })},
      {"CONST", "in-place scaling", "changes its input", "relight: transfer . light", "changes its input",
       ours_with(
           &I::relight,
           +[](std::int32_t n, const double* transfer, const double* light, double* result) {
             const int status = plumbline_sh().relight(n, transfer, light, result);
             const_cast<double*>(light)[0] += 1.0;
             return status;
           })},
      {"REFUSE", "half-finished port", "refuses what the contract asks for", "rotate: 13 rotations",
       "refuses",
       ours_with(
           &I::rotate, +[](std::int32_t, const double*, const double*, double*) { return 1; })},
  };
}

}  // namespace

std::vector<Fault> operation_faults() {
  std::vector<Fault> all = rotation_faults();
  for (const auto part : {product_faults, other_faults}) {
    const std::vector<Fault> more = part();
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

}  // namespace plumbline::conformance
