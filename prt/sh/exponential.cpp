#include "prt/sh/exponential.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <string>
#include <utility>

#include "prt/sh/basis.hpp"
#include "prt/sh/exponential_steps.hpp"
#include "prt/sh/logarithm.hpp"
#include "prt/sh/quadrature.hpp"
#include "reference/base/error.hpp"

namespace plumbline::sh {
namespace {

const double kRootFourPi = std::sqrt(4.0 * kPi);

int require_input(const std::vector<double>& f, const char* where) {
  const int bands = static_cast<int>(std::lround(std::sqrt(static_cast<double>(f.size()))));
  if (f.empty() || bands > kMaxProductBands || static_cast<std::size_t>(bands * bands) != f.size()) {
    throw InputError(std::string(where) + ": expected n^2 coefficients, 1 <= n <= " +
                     std::to_string(kMaxProductBands) + ", got " + std::to_string(f.size()));
  }
  for (const double value : f) {
    if (!std::isfinite(value)) {
      throw InputError(std::string(where) + ": expected finite coefficients, got " + std::to_string(value));
    }
  }
  return bands;
}

std::vector<double> require_finite_result(std::vector<double> result, const char* where) {
  for (const double value : result) {
    if (!std::isfinite(value)) throw InputError(std::string(where) + ": the result is beyond double's range");
  }
  return result;
}

std::vector<double> without_mean(std::vector<double> f) {
  f[0] = 0.0;
  return f;
}

void scale(std::vector<double>& f, double factor) {
  for (double& value : f) value *= factor;
}

std::vector<double> series(const std::vector<double>& f, int degree, const char* where) {
  if (degree < 0)
    throw InputError(std::string(where) + ": expected degree >= 0, got " + std::to_string(degree));
  std::vector<double> power(f.size(), 0.0);
  power[0] = kRootFourPi;
  std::vector<double> sum = power;
  for (int k = 1; k <= degree; ++k) {
    power = k == 1 ? f : product(power, f);
    scale(power, 1.0 / k);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += power[i];
  }
  return sum;
}

/// y_l0 at the nodes: row l.
std::vector<std::vector<double>> zonal_basis(int bands, const GaussLegendre& rule) {
  std::vector<std::vector<double>> rows(static_cast<std::size_t>(bands));
  for (std::size_t n = 0; n < rule.nodes.size(); ++n) {
    const double z = rule.nodes[n];
    const double radius = std::sqrt((1.0 - z) * (1.0 + z));
    const std::vector<double> y = evaluate_basis(bands, Vec3d(radius, 0.0, z));
    for (int l = 0; l < bands; ++l) {
      rows[static_cast<std::size_t>(l)].push_back(y[static_cast<std::size_t>(index(l, 0))]);
    }
  }
  return rows;
}

/// Log visibilities of spheres of angular radius 1, 3 … 89 degrees without their mean, of norm 1, at the nodes.
std::vector<std::vector<double>> blocker_shapes(int bands, const std::vector<std::vector<double>>& basis) {
  std::vector<std::vector<double>> shapes;
  for (int degrees = 1; degrees < 90; degrees += 2) {
    std::vector<double> log = zonal_logarithm(sphere_visibility(bands, degrees * kPi / 180.0)).coefficients;
    log[0] = 0.0;
    double square_sum = 0.0;
    for (const double value : log) square_sum += value * value;
    if (square_sum == 0.0) continue;
    std::vector<double> shape(basis[0].size(), 0.0);
    for (std::size_t l = 1; l < log.size(); ++l) {
      for (std::size_t n = 0; n < shape.size(); ++n) shape[n] += log[l] / std::sqrt(square_sum) * basis[l][n];
    }
    shapes.push_back(shape);
  }
  return shapes;
}

// exp(m s) for a shape s of norm 1 and mean 0, on the orthogonal vectors 1 and m s (eq. 3.29):
// a = <exp, 1> / 4 pi, b = <exp, m s> / m^2. By Parseval the inner products are integrals of the functions. The
// sum of squared errors over several shapes is least at the mean of their a and b.
LinearTable fit_linear_table(int bands) {
  constexpr int kSteps = 128;
  LinearTable table{kLargestTabled / kSteps, {1.0}, {1.0}};
  const GaussLegendre rule = gauss_legendre(64 + 16 * bands);
  const std::vector<std::vector<double>> shapes = blocker_shapes(bands, zonal_basis(bands, rule));
  for (int step = 1; step <= kSteps; ++step) {
    const double m = step * table.step;
    double a = 0.0;
    double b = 0.0;
    for (const std::vector<double>& shape : shapes) {
      for (std::size_t n = 0; n < rule.nodes.size(); ++n) {
        const double weighted = 2.0 * kPi * rule.weights[n] * std::exp(m * shape[n]);
        a += weighted / (4.0 * kPi);
        b += weighted * shape[n] / m;
      }
    }
    const double count = static_cast<double>(shapes.size());
    table.a.push_back(shapes.empty() ? 1.0 : a / count);
    table.b.push_back(shapes.empty() ? 1.0 : b / count);
  }
  return table;
}

/// exp(f0 / sqrt(4 pi)) (a 1 + b f^), |f^| within the table.
std::vector<double> linear(const LinearTable& table, const std::vector<double>& f, double magnitude) {
  const detail::LinearFactors factors = detail::linear_factors(table, magnitude);
  const double mean = std::exp(f[0] / kRootFourPi);
  std::vector<double> result = f;
  scale(result, mean * factors.b);
  result[0] = mean * factors.a * kRootFourPi;
  return result;
}

std::vector<double> isolated(const std::vector<double>& f, int degree, const char* where) {
  std::vector<double> result = series(without_mean(f), degree, where);
  scale(result, std::exp(f[0] / kRootFourPi));
  return result;
}

// The mean is scaled with the rest, so that what is squared is always about exp(f / 2^k): of a visibility (f <= 0)
// no intermediate result is much above 1, however large |f^| is.
template <class Start>
std::vector<double> scaled_and_squared(const std::vector<double>& f, const Start& start, const char* where) {
  const double magnitude = magnitude_without_mean(f);
  if (!(magnitude <= kLargestMagnitude)) {
    throw InputError(std::string(where) + ": expected |f^| <= " + std::to_string(kLargestMagnitude) +
                     ", got " + std::to_string(magnitude));
  }
  const int squarings = detail::squarings_for(magnitude);
  std::vector<double> scaled = f;
  scale(scaled, std::ldexp(1.0, -squarings));
  std::vector<double> result = start(scaled);
  for (int k = 0; k < squarings; ++k) result = square(result);
  return require_finite_result(std::move(result), where);
}

/// Row by row, so that sums of half a million terms lose no more than sums of a thousand.
std::vector<double> project_exponential(const std::vector<double>& f, int bands, int points) {
  const Basis<double> basis(bands);
  std::vector<double> y(f.size());
  std::vector<double> row(f.size(), 0.0);
  std::vector<double> result(f.size(), 0.0);
  int column = 0;
  for (const SphereNode& node : sphere_quadrature(points)) {
    basis.evaluate(node.direction.x, node.direction.y, node.direction.z, y);
    double value = 0.0;
    for (std::size_t i = 0; i < f.size(); ++i) value += f[i] * y[i];
    const double weighted = node.weight * std::exp(value);
    for (std::size_t i = 0; i < f.size(); ++i) row[i] += weighted * y[i];
    if (++column < 2 * points) continue;
    column = 0;
    for (std::size_t i = 0; i < f.size(); ++i) result[i] += std::exchange(row[i], 0.0);
  }
  return result;
}

}  // namespace

double magnitude_without_mean(const std::vector<double>& f) {
  double largest = 0.0;  // scaled by it, the squares neither overflow nor vanish
  for (std::size_t i = 1; i < f.size(); ++i) largest = std::max(largest, std::abs(f[i]));
  if (largest == 0.0) return 0.0;
  double sum = 0.0;
  for (std::size_t i = 1; i < f.size(); ++i) sum += (f[i] / largest) * (f[i] / largest);
  return largest * std::sqrt(sum);
}

std::vector<double> exponential_series(const std::vector<double>& f, int degree) {
  require_input(f, "sh::exponential_series");
  return require_finite_result(series(f, degree, "sh::exponential_series"), "sh::exponential_series");
}

std::vector<double> exponential_isolated(const std::vector<double>& f, int degree) {
  require_input(f, "sh::exponential_isolated");
  return require_finite_result(isolated(f, degree, "sh::exponential_isolated"), "sh::exponential_isolated");
}

std::vector<double> exponential_of_matrix(const std::vector<double>& f) {
  require_input(f, "sh::exponential_of_matrix");
  const std::vector<double> matrix = product_matrix(f);
  const auto n = static_cast<Eigen::Index>(f.size());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(
      Eigen::Map<const Eigen::MatrixXd>(matrix.data(), n, n));
  const Eigen::VectorXd values = solver.eigenvalues().array().exp();
  const Eigen::VectorXd first = solver.eigenvectors().row(0).transpose();
  const Eigen::VectorXd result = kRootFourPi * (solver.eigenvectors() * values.cwiseProduct(first));
  return require_finite_result({result.data(), result.data() + n}, "sh::exponential_of_matrix");
}

const LinearTable& linear_table(int bands) {
  if (bands < 1 || bands > kMaxProductBands) {
    throw InputError("sh::linear_table: expected 1 to " + std::to_string(kMaxProductBands) + " bands, got " +
                     std::to_string(bands));
  }
  static std::array<std::once_flag, kMaxProductBands + 1> flags;
  static std::array<LinearTable, kMaxProductBands + 1> tables;
  const auto n = static_cast<std::size_t>(bands);
  std::call_once(flags[n], [bands, n] { tables[n] = fit_linear_table(bands); });
  return tables[n];
}

std::vector<double> exponential_linear(const std::vector<double>& f) {
  const int bands = require_input(f, "sh::exponential_linear");
  const double magnitude = magnitude_without_mean(f);
  if (magnitude > kLargestTabled) {
    throw InputError("sh::exponential_linear: expected |f^| <= " + std::to_string(kLargestTabled) + ", got " +
                     std::to_string(magnitude));
  }
  return require_finite_result(linear(linear_table(bands), f, magnitude), "sh::exponential_linear");
}

std::vector<double> exponential_hybrid(const std::vector<double>& f) {
  const LinearTable& table = linear_table(require_input(f, "sh::exponential_hybrid"));
  return scaled_and_squared(
      f, [&table](const std::vector<double>& g) { return linear(table, g, magnitude_without_mean(g)); },
      "sh::exponential_hybrid");
}

std::vector<float> exponential_hybrid(const std::vector<float>& f) {
  const std::vector<double> result = exponential_hybrid(std::vector<double>(f.begin(), f.end()));
  std::vector<float> rounded;
  for (const double value : result) rounded.push_back(static_cast<float>(value));
  for (const float value : rounded) {
    if (!std::isfinite(value)) throw InputError("sh::exponential_hybrid: the result is beyond float's range");
  }
  return rounded;
}

std::vector<double> exponential(const std::vector<double>& f) {
  require_input(f, "sh::exponential");
  return scaled_and_squared(
      f, [](const std::vector<double>& g) { return isolated(g, 2, "sh::exponential"); }, "sh::exponential");
}

Reprojected exponential_by_quadrature(const std::vector<double>& f) {
  const int bands = require_input(f, "sh::exponential_by_quadrature");
  constexpr int kMostPoints = 512;
  constexpr double kRounding = 1e-13;
  int points = 4 * bands;
  Reprojected result{project_exponential(f, bands, points), 0.0};
  do {
    points *= 2;
    std::vector<double> finer = project_exponential(f, bands, points);
    result.uncertainty = 0.0;
    double largest = 0.0;
    for (std::size_t i = 0; i < f.size(); ++i) {
      result.uncertainty = std::max(result.uncertainty, std::abs(finer[i] - result.coefficients[i]));
      largest = std::max(largest, std::abs(finer[i]));
    }
    result.coefficients = require_finite_result(std::move(finer), "sh::exponential_by_quadrature");
    if (result.uncertainty <= kRounding * largest) break;
  } while (points * 2 <= kMostPoints);
  return result;
}

}  // namespace plumbline::sh
