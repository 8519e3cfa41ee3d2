// validation/bench/sh_product_bench.cpp: products of SH vectors, beside the ways others take. Items are products.
// Names: WHAT/BANDS or WHAT/BANDS/SET with the sets of instruction_set.hpp.
#include <benchmark/benchmark.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <random>
#include <vector>

#include "prt/sh/basis.hpp"
#include "prt/sh/product.hpp"
#include "prt/sh/quadrature.hpp"
#include "validation/bench/instruction_set.hpp"

namespace plumbline::bench {
namespace {

constexpr int kBlocks = 4;  // 64 pairs: the largest case, 3 x 9 KiB, stays in cache

std::size_t size_of(int bands) {
  return static_cast<std::size_t>(sh::coefficient_count(bands));
}

template <class Real>
std::vector<Real> random_values(std::size_t count, unsigned seed) {
  std::mt19937 bits(seed);
  std::vector<Real> values(count);
  for (Real& value : values) value = static_cast<Real>(static_cast<double>(bits()) / 2147483648.0 - 1.0);
  return values;
}

template <class Real>
struct Pair {
  std::vector<Real> a, b, out;
  explicit Pair(std::size_t count)
      : a(random_values<Real>(count, 1)), b(random_values<Real>(count, 2)), out(count) {}
};

template <class Work>
void time_products(benchmark::State& state, int count, const Work& work) {
  for (auto _ : state) {
    work();
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * count);
}

template <class Real>
void sh_product(benchmark::State& state) {
  Pair<Real> p(size_of(static_cast<int>(state.range(0))));
  time_products(state, 1, [&] {
    sh::multiply(std::span<const Real>(p.a), std::span<const Real>(p.b), std::span<Real>(p.out));
  });
}
BENCHMARK(sh_product<float>)->Name("sh_product_f32")->DenseRange(2, 8)->Arg(10)->Arg(12)->Arg(16);
BENCHMARK(sh_product<double>)->Name("sh_product_f64")->DenseRange(2, 8)->Arg(10)->Arg(12)->Arg(16);

void sh_square_f32(benchmark::State& state) {
  Pair<float> p(size_of(static_cast<int>(state.range(0))));
  time_products(state, 1, [&] { sh::square(std::span<const float>(p.a), std::span<float>(p.out)); });
}
BENCHMARK(sh_square_f32)->DenseRange(2, 6);

void sh_product_blocks_f32(benchmark::State& state) {
  const InstructionSet set(state.range(1));
  if (!set.is_available(state)) return;
  const auto bands = static_cast<int>(state.range(0));
  Pair<float> p(size_of(bands) * sh::kProductLanes * kBlocks);
  time_products(state, sh::kProductLanes * kBlocks, [&] { sh::multiply_blocks(bands, p.a, p.b, p.out); });
}
BENCHMARK(sh_product_blocks_f32)->ArgsProduct({{2, 3, 4, 5, 6, 8}, {kBest}});
BENCHMARK(sh_product_blocks_f32)->ArgsProduct({{5}, {kAvx512, kAvx2, kSsse3}});

void sh_square_blocks_f32(benchmark::State& state) {
  const auto bands = static_cast<int>(state.range(0));
  Pair<float> p(size_of(bands) * sh::kProductLanes * kBlocks);
  time_products(state, sh::kProductLanes * kBlocks, [&] { sh::square_blocks(bands, p.a, p.out); });
}
BENCHMARK(sh_square_blocks_f32)->DenseRange(2, 6);

void sh_zonal_product_f64(benchmark::State& state) {
  const auto bands = static_cast<int>(state.range(0));
  const std::vector<double> zonal = random_values<double>(static_cast<std::size_t>(bands), 3);
  const std::vector<double> f = random_values<double>(size_of(bands), 4);
  time_products(state, 1, [&] { benchmark::DoNotOptimize(sh::zonal_product(zonal, f)); });
}
BENCHMARK(sh_zonal_product_f64)->Arg(5)->Arg(10)->Arg(16);

// ---------------------------------------------------------------- what others do

/// All n^6 terms.
void sh_product_dense_f32(benchmark::State& state) {
  const auto bands = static_cast<int>(state.range(0));
  const std::size_t n = size_of(bands);
  std::vector<float> tensor(n * n * n);
  for (std::size_t i = 0; i < tensor.size(); ++i) {
    tensor[i] = static_cast<float>(sh::tripling_coefficient(
        static_cast<int>(i / (n * n)), static_cast<int>(i / n % n), static_cast<int>(i % n)));
  }
  Pair<float> p(n);
  time_products(state, 1, [&] {
    for (std::size_t i = 0; i < n; ++i) {
      float sum = 0.0F;
      for (std::size_t j = 0; j < n; ++j) {
        float row = 0.0F;
        for (std::size_t k = 0; k < n; ++k) row += tensor[(i * n + j) * n + k] * p.b[k];
        sum += row * p.a[j];
      }
      p.out[i] = sum;
    }
  });
}
BENCHMARK(sh_product_dense_f32)->DenseRange(3, 6);

/// The list of all (i, j, k) that are not 0, each with its own multiplications.
void sh_product_sparse_f32(benchmark::State& state) {
  struct Entry {
    int i, j, k;
    float value;
  };
  const auto bands = static_cast<int>(state.range(0));
  std::vector<Entry> entries;
  for (const sh::Tripling& t : sh::tripling_coefficients(bands)) {
    std::array<int, 3> places{t.i, t.j, t.k};
    do {
      entries.push_back({places[0], places[1], places[2], static_cast<float>(t.value)});
    } while (std::next_permutation(places.begin(), places.end()));
  }
  Pair<float> p(size_of(bands));
  time_products(state, 1, [&] {
    std::fill(p.out.begin(), p.out.end(), 0.0F);
    for (const Entry& e : entries) {
      p.out[static_cast<std::size_t>(e.k)] +=
          e.value * p.a[static_cast<std::size_t>(e.i)] * p.b[static_cast<std::size_t>(e.j)];
    }
  });
}
BENCHMARK(sh_product_sparse_f32)->DenseRange(3, 6)->Arg(8)->Arg(10);

/// Evaluate, multiply, project, with the basis at the nodes kept.
void sh_product_quadrature_f32(benchmark::State& state) {
  using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic>;
  const auto bands = static_cast<int>(state.range(0));
  const std::vector<sh::SphereNode> nodes = sh::sphere_quadrature((3 * bands - 1) / 2);
  Matrix forward(static_cast<Eigen::Index>(nodes.size()), bands * bands);
  Matrix backward(bands * bands, static_cast<Eigen::Index>(nodes.size()));
  for (Eigen::Index row = 0; row < forward.rows(); ++row) {
    const sh::SphereNode& node = nodes[static_cast<std::size_t>(row)];
    const std::vector<double> y = sh::evaluate_basis(bands, node.direction);
    for (Eigen::Index i = 0; i < forward.cols(); ++i) {
      forward(row, i) = static_cast<float>(y[static_cast<std::size_t>(i)]);
      backward(i, row) = static_cast<float>(node.weight * y[static_cast<std::size_t>(i)]);
    }
  }
  Pair<float> p(size_of(bands));
  const Eigen::Map<const Eigen::VectorXf> a(p.a.data(), bands * bands);
  const Eigen::Map<const Eigen::VectorXf> b(p.b.data(), bands * bands);
  Eigen::Map<Eigen::VectorXf> out(p.out.data(), bands * bands);
  Eigen::VectorXf at_a(forward.rows());
  Eigen::VectorXf at_b(forward.rows());
  time_products(state, 1, [&] {
    at_a.noalias() = forward * a;
    at_b.noalias() = forward * b;
    at_a.array() *= at_b.array();
    out.noalias() = backward * at_a;
  });
}
BENCHMARK(sh_product_quadrature_f32)->DenseRange(3, 6)->Arg(8)->Arg(10);

/// The product matrix is known: what remains is a matrix times a vector.
void sh_product_eigen_matrix_f32(benchmark::State& state) {
  const auto bands = static_cast<int>(state.range(0));
  Pair<float> p(size_of(bands));
  const std::vector<double> matrix = sh::product_matrix({p.a.begin(), p.a.end()});
  const Eigen::MatrixXf m =
      Eigen::Map<const Eigen::MatrixXd>(matrix.data(), bands * bands, bands * bands).cast<float>();
  const Eigen::Map<const Eigen::VectorXf> b(p.b.data(), bands * bands);
  Eigen::Map<Eigen::VectorXf> out(p.out.data(), bands * bands);
  time_products(state, 1, [&] { out.noalias() = m * b; });
}
BENCHMARK(sh_product_eigen_matrix_f32)->DenseRange(3, 6);

/// And with the matrix built each time.
void sh_product_matrix_f64(benchmark::State& state) {
  const std::vector<double> a = random_values<double>(size_of(static_cast<int>(state.range(0))), 1);
  time_products(state, 1, [&] { benchmark::DoNotOptimize(sh::product_matrix(a)); });
}
BENCHMARK(sh_product_matrix_f64)->DenseRange(3, 6);

}  // namespace
}  // namespace plumbline::bench
