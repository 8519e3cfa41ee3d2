#include "prt/compress/affine.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <limits>

namespace plumbline::compress {
namespace {

using Matrix = Eigen::MatrixXd;
using ConstRow = Eigen::Map<const Eigen::VectorXf>;
using ConstRowD = Eigen::Map<const Eigen::VectorXd>;

/// On the stack: one is made for each distance.
using StackVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxDimension, 1>;

constexpr std::size_t kBlock = 256;  // members that are centred at a time

Eigen::Index index(std::size_t i) {
  return static_cast<Eigen::Index>(i);
}

ConstRow row(std::span<const float> x) {
  return {x.data(), index(x.size())};
}

std::vector<double> mean_of(const Vectors& vectors, std::span<const std::uint32_t> members) {
  std::vector<double> mean(vectors.dimension, 0.0);
  Eigen::Map<Eigen::VectorXd> sum(mean.data(), index(mean.size()));
  for (const std::uint32_t i : members) sum += row(vectors[i]).cast<double>();
  if (!members.empty()) sum /= static_cast<double>(members.size());
  return mean;
}

/// Columns x - mean of members [first, first + count).
Matrix centred(const Vectors& vectors, std::span<const std::uint32_t> members,
               const std::vector<double>& mean) {
  Matrix columns(index(vectors.dimension), index(members.size()));
  const ConstRowD centre(mean.data(), index(mean.size()));
  for (std::size_t i = 0; i < members.size(); ++i) {
    columns.col(index(i)) = row(vectors[members[i]]).cast<double>() - centre;
  }
  return columns;
}

Matrix scatter_matrix(const Vectors& vectors, std::span<const std::uint32_t> members,
                      const std::vector<double>& mean) {
  Matrix scatter = Matrix::Zero(index(vectors.dimension), index(vectors.dimension));
  for (std::size_t first = 0; first < members.size(); first += kBlock) {
    const auto block = members.subspan(first, std::min(kBlock, members.size() - first));
    scatter.selfadjointView<Eigen::Lower>().rankUpdate(centred(vectors, block, mean));
  }
  return scatter;
}

/// Eigenvalues, falling and not below 0, and the first `components` eigenvectors; where the eigenvalue is nothing but rounding, the
/// axis stays 0. `to_axis` makes a vector of the space of an eigenvector.
template <class ToAxis>
void take_axes(const Eigen::SelfAdjointEigenSolver<Matrix>& solver, std::size_t components, Affine& affine,
               const ToAxis& to_axis) {
  const std::size_t count = static_cast<std::size_t>(solver.eigenvalues().size());
  affine.eigenvalues.assign(std::max(count, components), 0.0);
  for (std::size_t k = 0; k < count; ++k) {
    affine.eigenvalues[k] = std::max(0.0, solver.eigenvalues()[index(count - 1 - k)]);
  }
  const double rounding =
      static_cast<double>(count) * std::numeric_limits<double>::epsilon() * affine.eigenvalues.front();
  const std::size_t dimension = affine.mean.size();
  for (std::size_t k = 0; k < std::min(components, count); ++k) {
    if (!(affine.eigenvalues[k] > rounding)) continue;
    Eigen::Map<Eigen::VectorXd>(affine.axes.data() + k * dimension, index(dimension)) =
        to_axis(solver.eigenvectors().col(index(count - 1 - k))).normalized();
  }
}

}  // namespace

double sum_of_squares(const Vectors& vectors) {
  double sum = 0.0;
  for (const float x : vectors.values) sum += static_cast<double>(x) * static_cast<double>(x);
  return sum;
}

// With the columns of A the centred vectors, the axes are the eigenvectors u of the scatter matrix A A^T with the largest
// eigenvalues (Eckart & Young 1936). With fewer vectors than dimensions those of the smaller Gram matrix A^T A are found
// instead: A^T A v = s v gives A A^T (A v) = s (A v).
Affine fit_affine(const Vectors& vectors, std::span<const std::uint32_t> members, std::size_t components) {
  Affine affine;
  affine.mean = mean_of(vectors, members);
  affine.axes.assign(components * vectors.dimension, 0.0);
  if (members.empty() || components == 0) {
    affine.eigenvalues.assign(components, 0.0);
    return affine;
  }
  if (members.size() < vectors.dimension) {
    const Matrix columns = centred(vectors, members, affine.mean);
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(columns.transpose() * columns);
    take_axes(solver, components, affine, [&](const auto& v) -> Eigen::VectorXd { return columns * v; });
  } else {
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(scatter_matrix(vectors, members, affine.mean));
    take_axes(solver, components, affine, [](const auto& v) -> Eigen::VectorXd { return v; });
  }
  return affine;
}

// x - mean less its parts along the axes, and only then squared: |x - mean|^2 - sum of squared weights would lose the
// distance in the rounding of the two where it is small.
double squared_distance(const Affine& affine, std::span<const float> x) {
  const ConstRowD mean(affine.mean.data(), index(affine.mean.size()));
  if (affine.axes.empty()) return (row(x).cast<double>() - mean).squaredNorm();
  StackVector rest = row(x).cast<double>() - mean;
  for (std::size_t k = 0; k < affine.components(); ++k) {
    const ConstRowD axis(affine.axis(k).data(), index(x.size()));
    rest -= axis.dot(rest) * axis;
  }
  return rest.squaredNorm();
}

std::vector<double> weights_of(const Affine& affine, std::span<const float> x) {
  const ConstRowD mean(affine.mean.data(), index(affine.mean.size()));
  const Eigen::VectorXd offset = row(x).cast<double>() - mean;
  std::vector<double> weights(affine.components());
  for (std::size_t k = 0; k < weights.size(); ++k) {
    weights[k] = ConstRowD(affine.axis(k).data(), index(x.size())).dot(offset);
  }
  return weights;
}

}  // namespace plumbline::compress
