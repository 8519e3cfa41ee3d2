#include "prt/normal_map/normal_basis.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "prt/sh/basis.hpp"
#include "prt/sh/quadrature.hpp"
#include "prt/sh/zonal.hpp"
#include "reference/base/error.hpp"

namespace plumbline::normal_map {
namespace {

using Gram = Eigen::Matrix<double, static_cast<int>(kQuadraticCount), static_cast<int>(kQuadraticCount)>;

// A^T W A of the matrix with one row a normal. In z the integrands have degree 4, with the cosine 5: three Gauss nodes are exact.
// In azimuth they have frequencies up to 4: five equal steps or more are.
Gram gram(NormalWeight weight) {
  constexpr int kHeights = 4;
  constexpr int kAzimuths = 8;
  const sh::GaussLegendre gauss = sh::gauss_legendre(kHeights);
  Gram result = Gram::Zero();
  double total = 0.0;
  for (std::size_t i = 0; i < gauss.nodes.size(); ++i) {
    const double z = 0.5 * (gauss.nodes[i] + 1.0);
    const double sine = std::sqrt(1.0 - z * z);
    const double share = gauss.weights[i] * (weight == NormalWeight::cosine ? z : 1.0);
    for (int j = 0; j < kAzimuths; ++j) {
      const double azimuth = 2.0 * kPi * j / kAzimuths;
      const Quadratic row = reflected({sine * std::cos(azimuth), sine * std::sin(azimuth), z});
      const Eigen::Map<const Eigen::Matrix<double, static_cast<int>(kQuadraticCount), 1>> a(row.data());
      result += share * a * a.transpose();
      total += share;
    }
  }
  return result / total;
}

void require_term(int k) {
  constexpr int kLast = static_cast<int>(kQuadraticCount) - 1;
  if (k < 0 || k > kLast) throw InputError(fmt::format("normal basis: term {} is outside 0 to {}", k, kLast));
}

}  // namespace

Quadratic reflected(const Vec3d& normal) {
  static const sh::Basis<double> basis(kQuadraticBands);
  static const std::array<double, kQuadraticBands> factors = {sh::clamped_cosine_factor(0) / kPi,
                                                              sh::clamped_cosine_factor(1) / kPi,
                                                              sh::clamped_cosine_factor(2) / kPi};
  Quadratic result{};
  basis.evaluate(normal.x, normal.y, normal.z, result);
  for (std::size_t i = 0; i < kQuadraticCount; ++i) result[i] *= factors[i == 0 ? 0 : (i < 4 ? 1 : 2)];
  return result;
}

// A = U S V^T means A^T W A = V S^2 V^T: the small symmetric eigenproblem gives V and S, and U = A V S^-1. No normal is ever
// sampled, so there is no number of rows to choose. The smallest of the squared singular values is 2e-3 of the largest: squaring
// costs 3 of 16 digits.
NormalBasis make_normal_basis(NormalWeight weight) {
  const Eigen::SelfAdjointEigenSolver<Gram> solver(gram(weight));
  NormalBasis result;
  result.weight = weight;
  for (std::size_t k = 0; k < kQuadraticCount; ++k) {
    const auto column = static_cast<Eigen::Index>(kQuadraticCount - 1 - k);  // eigenvalues ascend
    result.singular_values[k] = std::sqrt(solver.eigenvalues()[column]);
    Quadratic& vector = result.light_vectors[k];
    for (std::size_t j = 0; j < kQuadraticCount; ++j) {
      vector[j] = solver.eigenvectors()(static_cast<Eigen::Index>(j), column);
    }
  }
  return result;
}

double energy_kept(const NormalBasis& basis, int terms) {
  require_term(terms - 1);
  double kept = 0.0;
  double all = 0.0;
  for (std::size_t k = 0; k < kQuadraticCount; ++k) {
    const double energy = basis.singular_values[k] * basis.singular_values[k];
    all += energy;
    if (k < static_cast<std::size_t>(terms)) kept += energy;
  }
  return kept / all;
}

void evaluate_normal_functions(const NormalBasis& basis, const Vec3d& normal, std::span<double> values) {
  if (values.size() > kQuadraticCount) require_term(static_cast<int>(values.size()) - 1);
  const Quadratic row = reflected(normal);
  for (std::size_t k = 0; k < values.size(); ++k) {
    double sum = 0.0;
    for (std::size_t j = 0; j < kQuadraticCount; ++j) sum += row[j] * basis.light_vectors[k][j];
    values[k] = sum / basis.singular_values[k];
  }
}

Quadratic light_row(const NormalBasis& basis, int k) {
  require_term(k);
  Quadratic result = basis.light_vectors[static_cast<std::size_t>(k)];
  for (double& value : result) value *= basis.singular_values[static_cast<std::size_t>(k)];
  return result;
}

}  // namespace plumbline::normal_map
