// validation/bench/sh_rotation_bench.cpp: turning SH coefficients, beside plain ways of doing it.
// The argument is the number of bands; items are functions turned.
#include <benchmark/benchmark.h>

#include <Eigen/Dense>
#include <random>
#include <vector>

#include "prt/sh/rotation.hpp"
#include "prt/sh/rotation_methods.hpp"
#include "prt/sh/rotator.hpp"

namespace {

using namespace plumbline;

constexpr std::size_t kRotations = 64;  // cycled through, so that no branch learns one rotation

std::vector<sh::RotationMatrix> rotations() {
  std::mt19937 bits(1);
  std::normal_distribution<double> normal;
  std::vector<sh::RotationMatrix> result;
  for (std::size_t i = 0; i < kRotations; ++i) {
    result.push_back(sh::rotation_from_quaternion({normal(bits), normal(bits), normal(bits), normal(bits)}));
  }
  return result;
}

template <class Real>
std::vector<Real> coefficients(std::size_t count) {
  std::mt19937 bits(2);
  std::uniform_real_distribution<Real> uniform(-1, 1);
  std::vector<Real> result(count);
  for (Real& x : result) x = uniform(bits);
  return result;
}

std::size_t size_of(const benchmark::State& state) {
  return static_cast<std::size_t>(state.range(0) * state.range(0));
}

/// Runs `turn(rotation)` for one rotation after the other.
template <class Turn>
void cycle(benchmark::State& state, const Turn& turn) {
  const std::vector<sh::RotationMatrix> all = rotations();
  std::size_t i = 0;
  for (auto _ : state) {
    turn(all[i]);
    i = (i + 1) % kRotations;
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()));
}

/// From a rotation to the turned coefficients, nothing prepared but constants.
template <class Real>
void rotate_one(benchmark::State& state) {
  const sh::Rotator<Real> rotator(static_cast<int>(state.range(0)));
  const std::vector<Real> in = coefficients<Real>(size_of(state));
  std::vector<Real> out(in.size());
  cycle(state, [&](const sh::RotationMatrix& r) {
    rotator.apply(r, in, out);
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  });
}
BENCHMARK(rotate_one<float>)->Name("sh_rotate_one_f32")->DenseRange(2, 10)->Arg(20);
BENCHMARK(rotate_one<double>)->Name("sh_rotate_one_f64")->Arg(3)->Arg(5)->Arg(10)->Arg(20);

/// The same from a plain 3x3 matrix, which is checked and made orthonormal each time.
void rotate_one_checked(benchmark::State& state) {
  const sh::Rotator<float> rotator(static_cast<int>(state.range(0)));
  const std::vector<float> in = coefficients<float>(size_of(state));
  std::vector<float> out(in.size());
  cycle(state, [&](const sh::RotationMatrix& r) {
    rotator.apply(r.matrix(), in, out);
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  });
}
BENCHMARK(rotate_one_checked)->Name("sh_rotate_one_checked_f32")->Arg(5);

void rotate_ivanic(benchmark::State& state) {
  const std::vector<double> in = coefficients<double>(size_of(state));
  std::vector<double> out(in.size());
  cycle(state, [&](const sh::RotationMatrix& r) {
    sh::Rotation(r, static_cast<int>(state.range(0))).apply(in, out);
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  });
}
BENCHMARK(rotate_ivanic)->Name("sh_rotate_ivanic_f64")->Arg(3)->Arg(5)->Arg(10)->Arg(20);

void build_ivanic(benchmark::State& state) {
  cycle(state, [&](const sh::RotationMatrix& r) {
    benchmark::DoNotOptimize(sh::Rotation(r, static_cast<int>(state.range(0))));
  });
}
BENCHMARK(build_ivanic)->Name("sh_rotation_build_f64")->Arg(3)->Arg(5)->Arg(10)->Arg(20);

void rotate_zxzxz(benchmark::State& state) {
  const sh::ZxzxzRotator rotator(static_cast<int>(state.range(0)));
  const std::vector<double> in = coefficients<double>(size_of(state));
  cycle(state, [&](const sh::RotationMatrix& r) { benchmark::DoNotOptimize(rotator.apply(in, r)); });
}
BENCHMARK(rotate_zxzxz)->Name("sh_rotate_zxzxz_f64")->Arg(5)->Arg(20);

void rotate_taylor(benchmark::State& state) {
  const std::vector<double> in = coefficients<double>(size_of(state));
  cycle(state, [&](const sh::RotationMatrix& r) { benchmark::DoNotOptimize(sh::rotate_by_taylor(in, r)); });
}
BENCHMARK(rotate_taylor)->Name("sh_rotate_taylor_f64")->Arg(5)->Arg(20);

void rotate_reprojection(benchmark::State& state) {
  const std::vector<double> in = coefficients<double>(size_of(state));
  cycle(state, [&](const sh::RotationMatrix& r) {
    benchmark::DoNotOptimize(sh::rotate_by_projection(in, r.matrix()));
  });
}
BENCHMARK(rotate_reprojection)->Name("sh_rotate_reprojection_f64")->Arg(3)->Arg(5)->Arg(10)->Arg(20);

/// One dense bands^2 x bands^2 matrix times a vector, the matrix given.
void rotate_dense(benchmark::State& state) {
  const auto size = static_cast<Eigen::Index>(size_of(state));
  const Eigen::MatrixXf matrix = Eigen::MatrixXf::Random(size, size);
  const Eigen::VectorXf in = Eigen::VectorXf::Random(size);
  Eigen::VectorXf out(size);
  for (auto _ : state) {
    out.noalias() = matrix * in;
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()));
}
BENCHMARK(rotate_dense)->Name("sh_rotate_dense_eigen_f32")->Arg(3)->Arg(5)->Arg(10)->Arg(20);

constexpr std::size_t kMany = 512;

void rotate_many(benchmark::State& state) {
  const sh::Rotation rotation(rotations()[0], static_cast<int>(state.range(0)));
  const std::vector<float> in = coefficients<float>(size_of(state) * kMany);
  std::vector<float> out(in.size());
  for (auto _ : state) {
    sh::apply_to_many(rotation, kMany, in, out);
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * kMany));
}
BENCHMARK(rotate_many)->Name("sh_rotate_many_f32")->Arg(3)->Arg(5)->Arg(10)->Arg(20);

/// The same as one dense matrix product.
void rotate_many_dense(benchmark::State& state) {
  const auto size = static_cast<Eigen::Index>(size_of(state));
  using RowMajor = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const RowMajor matrix = RowMajor::Random(size, size);
  const RowMajor in = RowMajor::Random(size, kMany);
  RowMajor out(size, kMany);
  for (auto _ : state) {
    out.noalias() = matrix * in;
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * kMany));
}
BENCHMARK(rotate_many_dense)->Name("sh_rotate_many_dense_eigen_f32")->Arg(5)->Arg(20);

}  // namespace
