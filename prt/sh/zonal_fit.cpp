#include "prt/sh/zonal_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <string>

#include "prt/sh/quadrature.hpp"
#include "prt/sh/rotation_methods.hpp"
#include "prt/sh/zonal.hpp"
#include "reference/base/error.hpp"

namespace plumbline::sh {
namespace {

using Axes = std::vector<Vec3d>;

/// A function's degree l as a column.
Eigen::Map<const Eigen::VectorXd> degree_of(const std::vector<double>& f, int l) {
  return {f.data() + l * l, 2 * l + 1};
}

/// With the axes given the rest is linear: per degree l the columns y_l(axis), and their weights by least squares (of
/// least norm where there are more lobes than 2l + 1).
class LinearPart {
 public:
  LinearPart(const std::vector<double>& f, const Axes& axes)
      : f_(f), bands_(bands_of(f.size(), "fit_zonal")) {
    const auto count = static_cast<Eigen::Index>(axes.size());
    for (const Vec3d& axis : axes) basis_.push_back(evaluate_basis(bands_, axis));
    for (int l = 0; l < bands_; ++l) {
      Eigen::MatrixXd columns(2 * l + 1, count);
      for (Eigen::Index i = 0; i < count; ++i)
        columns.col(i) = degree_of(basis_[static_cast<std::size_t>(i)], l);
      solvers_.emplace_back(columns);
      weights_.emplace_back(solvers_.back().solve(degree_of(f, l)));
      columns_.push_back(std::move(columns));
    }
  }

  [[nodiscard]] int bands() const { return bands_; }
  [[nodiscard]] const std::vector<double>& basis(std::size_t lobe) const { return basis_[lobe]; }
  /// Weight of y_l(axis): sqrt(4 pi/(2l + 1)) z_l.
  [[nodiscard]] double weight(int l, std::size_t lobe) const {
    return weights_[static_cast<std::size_t>(l)](static_cast<Eigen::Index>(lobe));
  }
  /// What the columns of each degree cannot make of v.
  [[nodiscard]] Eigen::VectorXd rest_of(const Eigen::VectorXd& v) const {
    Eigen::VectorXd rest = v;
    for (int l = 0; l < bands_; ++l) {
      const auto at = static_cast<std::size_t>(l);
      rest.segment(l * l, 2 * l + 1) -= columns_[at] * solvers_[at].solve(v.segment(l * l, 2 * l + 1));
    }
    return rest;
  }
  [[nodiscard]] Eigen::VectorXd residual() const {
    return rest_of(Eigen::Map<const Eigen::VectorXd>(f_.data(), static_cast<Eigen::Index>(f_.size())));
  }

 private:
  std::vector<double> f_;
  int bands_;
  std::vector<std::vector<double>> basis_;
  std::vector<Eigen::MatrixXd> columns_;
  std::vector<Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>> solvers_;
  std::vector<Eigen::VectorXd> weights_;
};

struct Tangents {
  Vec3d first;
  Vec3d second;
};
Tangents tangents_of(const Vec3d& axis) {
  const Vec3d across = std::abs(axis.z) < 0.8 ? Vec3d(0.0, 0.0, 1.0) : Vec3d(1.0, 0.0, 0.0);
  const Vec3d first = glm::normalize(glm::cross(axis, across));
  return {first, glm::cross(axis, first)};
}

/// d residual / d (turn of each axis about its two tangents), Kaufman's form: the columns' own change, projected.
Eigen::MatrixXd jacobian_of(const LinearPart& part, const Axes& axes) {
  const auto size = static_cast<Eigen::Index>(coefficient_count(part.bands()));
  Eigen::MatrixXd jacobian(size, 2 * static_cast<Eigen::Index>(axes.size()));
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const Tangents tangents = tangents_of(axes[i]);
    Eigen::Index column = 2 * static_cast<Eigen::Index>(i);
    for (const Vec3d& about : {tangents.first, tangents.second}) {
      const std::vector<double> change = rotation_derivative(part.basis(i), about);
      Eigen::VectorXd weighted(size);
      for (int l = 0; l < part.bands(); ++l) {
        weighted.segment(l * l, 2 * l + 1) = part.weight(l, i) * degree_of(change, l);
      }
      jacobian.col(column++) = -part.rest_of(weighted);
    }
  }
  return jacobian;
}

Axes turned(const Axes& axes, const Eigen::VectorXd& step) {
  Axes result;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const Tangents tangents = tangents_of(axes[i]);
    const auto at = 2 * static_cast<Eigen::Index>(i);
    const Vec3d about = step(at) * tangents.first + step(at + 1) * tangents.second;
    const double angle = glm::length(about);
    const Vec3d ahead = angle > 0.0 ? glm::cross(about / angle, axes[i]) : Vec3d(0.0);
    result.push_back(glm::normalize(std::cos(angle) * axes[i] + std::sin(angle) * ahead));
  }
  return result;
}

struct Refined {
  Axes axes;
  double square = 0.0;  // of the residual
};

Refined refined(const std::vector<double>& f, Axes axes) {
  constexpr int kSteps = 100;
  double damping = 1e-3;
  LinearPart part(f, axes);
  Eigen::VectorXd residual = part.residual();
  double square = residual.squaredNorm();
  for (int step = 0; step < kSteps && damping < 1e12; ++step) {
    const Eigen::MatrixXd jacobian = jacobian_of(part, axes);
    Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
    const double scale = normal.diagonal().maxCoeff();
    if (!(scale > 0.0)) break;
    normal.diagonal().array() += damping * scale;
    const Eigen::VectorXd move = normal.ldlt().solve(-jacobian.transpose() * residual);
    if (!(move.norm() > 1e-15)) break;
    const Axes candidate = turned(axes, move);
    LinearPart next(f, candidate);
    const Eigen::VectorXd next_residual = next.residual();
    if (next_residual.squaredNorm() < square) {
      axes = candidate;
      part = LinearPart(f, axes);
      residual = next_residual;
      square = residual.squaredNorm();
      damping = std::max(1e-12, 0.1 * damping);
    } else {
      damping *= 10.0;
    }
  }
  return {axes, square};
}

/// The grid's axes at which one lobe takes most of f, no two of them neighbours; best first.
Axes best_axes(const std::vector<double>& f, std::size_t count) {
  struct Candidate {
    double energy;
    Vec3d axis;
  };
  const int bands = bands_of(f.size(), "fit_zonal");
  std::vector<Candidate> candidates;
  for (const SphereNode& node : sphere_quadrature(std::max(8, 2 * bands))) {
    double energy = 0.0;
    for (const double z : closest_lobe(f, node.direction).zonal) energy += z * z;
    candidates.push_back({energy, node.direction});
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.energy > b.energy; });
  const double near = std::cos(1.0 / std::max(1, bands - 1));
  Axes result;
  for (const Candidate& candidate : candidates) {
    const bool is_new = std::none_of(result.begin(), result.end(), [&](const Vec3d& other) {
      return glm::dot(other, candidate.axis) > near;
    });
    if (is_new) result.push_back(candidate.axis);
    if (result.size() == count) break;
  }
  return result;
}

std::vector<double> as_vector(const Eigen::VectorXd& v) {
  return {v.data(), v.data() + v.size()};
}

ZonalFit fit_of(const std::vector<double>& f, const Refined& best) {
  const LinearPart part(f, best.axes);
  ZonalFit fit;
  for (std::size_t i = 0; i < best.axes.size(); ++i) {
    ZonalLobe lobe{best.axes[i], {}};
    for (int l = 0; l < part.bands(); ++l) {
      lobe.zonal.push_back(part.weight(l, i) * std::sqrt((2.0 * l + 1.0) / (4.0 * kPi)));
    }
    fit.lobes.push_back(std::move(lobe));
  }
  double norm = 0.0;
  for (const double c : f) norm += c * c;
  fit.relative_error = norm > 0.0 ? std::sqrt(best.square / norm) : 0.0;
  return fit;
}

}  // namespace

std::vector<double> sum_of_lobes(std::span<const ZonalLobe> lobes) {
  if (lobes.empty()) throw InputError("sum_of_lobes: expected at least 1 lobe");
  std::vector<double> sum(lobes[0].zonal.size() * lobes[0].zonal.size(), 0.0);
  for (const ZonalLobe& lobe : lobes) {
    if (lobe.zonal.size() != lobes[0].zonal.size()) {
      throw InputError("sum_of_lobes: expected lobes of " + std::to_string(lobes[0].zonal.size()) +
                       " bands, got " + std::to_string(lobe.zonal.size()));
    }
    const std::vector<double> turned_lobe = rotate_zonal(lobe.zonal, lobe.axis);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += turned_lobe[i];
  }
  return sum;
}

// The sum of y_lm^2 over m, the denominator of eq. 3.58, is (2l + 1)/(4 pi) in every direction.
ZonalLobe closest_lobe(const std::vector<double>& coefficients, const Vec3d& axis) {
  const int bands = bands_of(coefficients.size(), "closest_lobe");
  const std::vector<double> y = evaluate_basis(bands, axis);
  ZonalLobe lobe{axis, {}};
  for (int l = 0; l < bands; ++l) {
    lobe.zonal.push_back(std::sqrt(4.0 * kPi / (2.0 * l + 1.0)) *
                         degree_of(y, l).dot(degree_of(coefficients, l)));
  }
  return lobe;
}

ZonalFit fit_zonal(const std::vector<double>& coefficients, int lobes) {
  if (lobes < 1) throw InputError("fit_zonal: expected at least 1 lobe, got " + std::to_string(lobes));
  for (const double c : coefficients) {
    if (!std::isfinite(c)) throw InputError("fit_zonal: a coefficient is not finite");
  }
  constexpr std::size_t kStarts = 4;
  Refined best{{}, 0.0};
  std::vector<double> rest = coefficients;
  for (int lobe = 0; lobe < lobes; ++lobe) {
    Refined next;
    for (const Vec3d& start : best_axes(rest, kStarts)) {
      Axes axes = best.axes;
      axes.push_back(start);
      Refined candidate = refined(coefficients, std::move(axes));
      if (next.axes.empty() || candidate.square < next.square) next = std::move(candidate);
    }
    best = std::move(next);
    rest = as_vector(LinearPart(coefficients, best.axes).residual());
  }
  return fit_of(coefficients, best);
}

}  // namespace plumbline::sh
