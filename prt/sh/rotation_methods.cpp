#include "prt/sh/rotation_methods.hpp"

#include <cmath>
#include <string>

#include "prt/sh/quadrature.hpp"
#include "reference/base/error.hpp"

namespace plumbline::sh {
namespace {

std::size_t at(int l, int m) {
  return static_cast<std::size_t>(index(l, m));
}

glm::dmat3 quarter_turn_about_x() {
  return glm::dmat3(Vec3d(1.0, 0.0, 0.0), Vec3d(0.0, 0.0, 1.0), Vec3d(0.0, -1.0, 0.0));
}

}  // namespace

std::vector<double> rotate_by_projection(const std::vector<double>& coefficients, const glm::dmat3& matrix) {
  const int bands = bands_of(coefficients.size(), "sh::rotate_by_projection");
  const Basis<double> basis(bands);
  const glm::dmat3 inverse = glm::transpose(matrix);
  std::vector<double> values(coefficients.size());
  std::vector<double> result(coefficients.size(), 0.0);
  for (const SphereNode& node : sphere_quadrature(bands)) {
    const Vec3d d = glm::normalize(inverse * node.direction);
    basis.evaluate(d.x, d.y, d.z, values);
    double value = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) value += values[i] * coefficients[i];
    basis.evaluate(node.direction.x, node.direction.y, node.direction.z, values);
    for (std::size_t i = 0; i < values.size(); ++i) result[i] += node.weight * value * values[i];
  }
  return result;
}

// cos m(phi - a) = cos ma cos m phi + sin ma sin m phi, and sin likewise.
std::vector<double> rotate_z(const std::vector<double>& coefficients, double angle_rad) {
  const int bands = bands_of(coefficients.size(), "sh::rotate_z");
  std::vector<double> result = coefficients;
  for (int m = 1; m < bands; ++m) {
    const double c = std::cos(m * angle_rad);
    const double s = std::sin(m * angle_rad);
    for (int l = m; l < bands; ++l) {
      const double even = coefficients[at(l, m)];
      const double odd = coefficients[at(l, -m)];
      result[at(l, m)] = c * even - s * odd;
      result[at(l, -m)] = s * even + c * odd;
    }
  }
  return result;
}

ZxzxzRotator::ZxzxzRotator(int bands) : quarter_turn_(quarter_turn_about_x(), bands) {}

// Rx(90) takes y to z and z to -y, so Rx(-90) Rz(b) Rx(90) turns about Rx(-90) z = y.
std::vector<double> ZxzxzRotator::apply(const std::vector<double>& coefficients,
                                        const RotationMatrix& rotation) const {
  const EulerZyz angles = euler_of(rotation);
  std::vector<double> turned(coefficients.size());
  quarter_turn_.apply(rotate_z(coefficients, angles.gamma_rad), turned);
  turned = rotate_z(turned, angles.beta_rad);
  std::vector<double> back(coefficients.size());
  quarter_turn_.apply_inverse(turned, back);
  return rotate_z(back, angles.alpha_rad);
}

// With L+- Y_lm = sqrt((l -+ m)(l +- m + 1)) Y_l,m+-1 of the complex harmonics (Condon-Shortley phase), turning by t
// about y, x, z changes f at the rate of -i L_y f, -i L_x f and -i L_z f, where L_y = (L+ - L-)/2i and
// L_x = (L+ + L-)/2. The real ones are sqrt(2) Re and sqrt(2) Im of Y_lm, m > 0, and Y_l,-1 = -conj(Y_l1) closes the
// row at m = 0. With c_m = sqrt((l - m)(l + m + 1)) / 2 (times sqrt(2) at m = 0), coupling m to m + 1:
//
//   y:  y_m  -> -c_m y_m+1,   y_m+1 -> c_m y_m,   the same for the sines (m >= 1)
//   x:  y_m  ->  c_m y_-(m+1), y_m+1 -> c_m y_-m, y_-m -> -c_m y_m+1, y_-(m+1) -> -c_m y_m
//   z:  y_m  ->  m y_-m,      y_-m -> -m y_m.
std::vector<double> rotation_derivative(const std::vector<double>& coefficients, const Vec3d& axis) {
  const int bands = bands_of(coefficients.size(), "sh::rotation_derivative");
  const std::vector<double>& f = coefficients;
  std::vector<double> result(f.size(), 0.0);
  for (int l = 1; l < bands; ++l) {
    for (int m = 0; m <= l; ++m) {
      result[at(l, -m)] += axis.z * m * f[at(l, m)];
      if (m > 0) result[at(l, m)] -= axis.z * m * f[at(l, -m)];
      if (m == l) break;
      const double c = std::sqrt((m == 0 ? 2.0 : 1.0) * (l - m) * (l + m + 1.0)) / 2.0;
      const std::size_t even = at(l, m);
      const std::size_t odd = at(l, -m);
      const std::size_t next_even = at(l, m + 1);
      const std::size_t next_odd = at(l, -m - 1);
      result[next_even] -= axis.y * c * f[even];
      result[even] += axis.y * c * f[next_even];
      result[next_odd] += axis.x * c * f[even];
      result[even] -= axis.x * c * f[next_odd];
      if (m == 0) continue;
      result[next_odd] -= axis.y * c * f[odd];
      result[odd] += axis.y * c * f[next_odd];
      result[odd] += axis.x * c * f[next_even];
      result[next_even] -= axis.x * c * f[odd];
    }
  }
  return result;
}

std::vector<double> rotate_y_by_taylor(const std::vector<double>& coefficients, double beta_rad, int terms) {
  if (terms < 1) {
    throw InputError("sh::rotate_y_by_taylor: expected at least 1 term, got " + std::to_string(terms));
  }
  std::vector<double> power = coefficients;
  std::vector<double> result = coefficients;
  for (int k = 1; k <= terms; ++k) {
    power = rotation_derivative(power, Vec3d(0.0, beta_rad / k, 0.0));
    for (std::size_t i = 0; i < result.size(); ++i) result[i] += power[i];
  }
  return result;
}

std::vector<double> rotate_by_taylor(const std::vector<double>& coefficients, const RotationMatrix& rotation,
                                     int terms) {
  const EulerZyz angles = euler_of(rotation);
  return rotate_z(rotate_y_by_taylor(rotate_z(coefficients, angles.gamma_rad), angles.beta_rad, terms),
                  angles.alpha_rad);
}

}  // namespace plumbline::sh
