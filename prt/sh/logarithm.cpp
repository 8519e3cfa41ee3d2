#include "prt/sh/logarithm.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "prt/sh/basis.hpp"
#include "prt/sh/quadrature.hpp"
#include "prt/sh/zonal.hpp"
#include "reference/base/error.hpp"

namespace plumbline::sh {
namespace {

void require_finite_input(const std::vector<double>& g, double floor, const char* where) {
  for (const double value : g) {
    if (!std::isfinite(value)) {
      throw InputError(std::string(where) + ": expected finite coefficients, got " + std::to_string(value));
    }
  }
  if (!(floor > 0.0) || !std::isfinite(floor)) {
    throw InputError(std::string(where) + ": expected floor > 0, got " + std::to_string(floor));
  }
}

/// log x / (x - 1), 1 at x = 1. Near 1 x - 1 is exact and log1p keeps its digits; far below 1 it would lose x.
double log_quotient(double x) {
  const double difference = x - 1.0;
  if (difference == 0.0) return 1.0;
  return (std::abs(difference) < 0.5 ? std::log1p(difference) : std::log(x)) / difference;
}

// M 1 = g and so (M - I) 1 = g - 1: without clipping the formula is log(M) 1, the inverse of exp(M) 1. With
// clipping only q(D) sees the floor, g - 1 stays as it is, so that an eigenvalue x < floor ends up as
// log(floor) (x - 1)/(floor - 1), slightly below log(floor).
Logarithm logarithm_of(const Eigen::MatrixXd& matrix, const std::vector<double>& g, double floor) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  Eigen::VectorXd difference = Eigen::Map<const Eigen::VectorXd>(g.data(), matrix.rows());
  difference[0] -= std::sqrt(4.0 * kPi);
  Eigen::VectorXd turned = solver.eigenvectors().transpose() * difference;
  Logarithm result;
  result.eigenvalues = static_cast<int>(matrix.rows());
  result.smallest = solver.eigenvalues()[0];
  for (Eigen::Index i = 0; i < turned.size(); ++i) {
    const double value = solver.eigenvalues()[i];
    if (value < floor) {
      ++result.clipped;
      result.energy += solver.eigenvectors()(0, i) * solver.eigenvectors()(0, i);
    }
    turned[i] *= log_quotient(std::max(value, floor));
  }
  const Eigen::VectorXd log = solver.eigenvectors() * turned;
  result.coefficients.assign(log.data(), log.data() + log.size());
  return result;
}

}  // namespace

Logarithm logarithm(const std::vector<double>& g, double floor) {
  require_finite_input(g, floor, "sh::logarithm");
  const std::vector<double> matrix = product_matrix(g);
  const auto n = static_cast<Eigen::Index>(g.size());
  return logarithm_of(Eigen::Map<const Eigen::MatrixXd>(matrix.data(), n, n), g, floor);
}

Logarithm zonal_logarithm(const std::vector<double>& zonal, double floor) {
  require_finite_input(zonal, floor, "sh::zonal_logarithm");
  const auto bands = static_cast<int>(zonal.size());
  require_bands(bands);
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(bands, bands);
  for (int i = 0; i < bands; ++i) {
    for (int j = 0; j < bands; ++j) {
      for (int k = std::abs(i - j); k < bands && k <= i + j; k += 2) {
        matrix(i, j) +=
            zonal[static_cast<std::size_t>(k)] * tripling_coefficient(index(i, 0), index(j, 0), index(k, 0));
      }
    }
  }
  return logarithm_of(matrix, zonal, floor);
}

Logarithm logarithm_by_quadrature(const std::vector<double>& g, double floor, int points) {
  require_finite_input(g, floor, "sh::logarithm_by_quadrature");
  const auto bands = static_cast<int>(std::lround(std::sqrt(static_cast<double>(g.size()))));
  const Basis<double> basis(bands);
  std::vector<double> y(static_cast<std::size_t>(basis.coefficient_count()));
  if (y.size() != g.size()) throw InputError("sh::logarithm_by_quadrature: expected n^2 coefficients");
  Logarithm result;
  result.coefficients.assign(g.size(), 0.0);
  result.smallest = std::numeric_limits<double>::infinity();
  for (const SphereNode& node : sphere_quadrature(points)) {
    basis.evaluate(node.direction.x, node.direction.y, node.direction.z, y);
    double value = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i) value += g[i] * y[i];
    result.smallest = std::min(result.smallest, value);
    ++result.eigenvalues;
    if (value < floor) {
      ++result.clipped;
      result.energy += node.weight / (4.0 * kPi);
    }
    const double weighted = node.weight * std::log(std::max(value, floor));
    for (std::size_t i = 0; i < y.size(); ++i) result.coefficients[i] += weighted * y[i];
  }
  return result;
}

std::vector<double> sphere_visibility(int bands, double angular_radius_rad) {
  std::vector<double> zonal = cap(bands, angular_radius_rad);
  for (double& value : zonal) value = -value;
  zonal[0] += std::sqrt(4.0 * kPi);
  return zonal;
}

}  // namespace plumbline::sh
