// validation/bench/sh_basis_bench.cpp: the SH basis at many directions, beside what it could at best take and what others
// take. Items are directions. Names: WHAT/BANDS/SET with the sets of instruction_set.hpp.
#include <benchmark/benchmark.h>
#include <gsl/gsl_sf_legendre.h>

#include <boost/math/special_functions/spherical_harmonic.hpp>
#include <cmath>
#include <random>

#include "prt/sh/batch.hpp"
#include "validation/bench/instruction_set.hpp"

namespace plumbline::bench {
namespace {

constexpr std::size_t kInCache = 256;
constexpr std::size_t kMany = 100000;

template <class Real>
struct Sphere {
  std::vector<Real> x, y, z;
  explicit Sphere(std::size_t count) {
    std::mt19937 bits(1);
    std::normal_distribution<double> normal;
    for (std::size_t k = 0; k < count; ++k) {
      const Vec3d d = glm::normalize(Vec3d(normal(bits), normal(bits), normal(bits)));
      x.push_back(static_cast<Real>(d.x));
      y.push_back(static_cast<Real>(d.y));
      z.push_back(static_cast<Real>(d.z));
    }
  }
  [[nodiscard]] sh::Directions<Real> spans() const { return {x, y, z}; }
};

std::size_t size_of(int bands) {
  return static_cast<std::size_t>(sh::coefficient_count(bands));
}

template <class Work>
void time_directions(benchmark::State& state, std::size_t count, const Work& work) {
  for (auto _ : state) {
    work();
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations() * count));
}

template <class Real, std::size_t kCount>
void sh_basis_blocked(benchmark::State& state) {
  const InstructionSet set(state.range(1));
  if (!set.is_available(state)) return;
  const auto bands = static_cast<int>(state.range(0));
  const Sphere<Real> in(kCount);
  const sh::BatchBasis<Real> basis(bands);
  const std::span<Real> values = arena<Real>(sh::blocked_size(bands, kCount));
  time_directions(state, kCount, [&] { basis.evaluate_blocked(in.spans(), values); });
}
BENCHMARK(sh_basis_blocked<float, kInCache>)
    ->Name("sh_basis_blocked_f32")
    ->ArgsProduct({{3, 4, 5, 6, 8, 10, 20, 64}, {kBest}})
    ->ArgsProduct({{3, 5, 6, 8, 10, 20}, {kAvx2, kSsse3, kScalar}});
BENCHMARK(sh_basis_blocked<double, kInCache>)
    ->Name("sh_basis_blocked_f64")
    ->ArgsProduct({{3, 5, 10, 20}, {kBest, kAvx2, kSsse3, kScalar}});
BENCHMARK(sh_basis_blocked<float, kMany>)
    ->Name("sh_basis_blocked_f32_100k")
    ->ArgsProduct({{3, 5, 10, 20}, {kBest}});

template <class Real, std::size_t kCount>
void sh_basis_rows(benchmark::State& state) {
  const InstructionSet set(state.range(1));
  if (!set.is_available(state)) return;
  const auto bands = static_cast<int>(state.range(0));
  const Sphere<Real> in(kCount);
  const sh::BatchBasis<Real> basis(bands);
  const std::span<Real> values = arena<Real>(kCount * size_of(bands));
  time_directions(state, kCount, [&] { basis.evaluate(in.spans(), values); });
}
BENCHMARK(sh_basis_rows<float, kInCache>)
    ->Name("sh_basis_rows_f32")
    ->ArgsProduct({{3, 4, 5, 6, 8, 10, 20}, {kBest}})
    ->ArgsProduct({{5, 10, 20}, {kAvx2, kSsse3}});
BENCHMARK(sh_basis_rows<double, kInCache>)->Name("sh_basis_rows_f64")->ArgsProduct({{5, 10, 20}, {kBest}});
BENCHMARK(sh_basis_rows<float, kMany>)
    ->Name("sh_basis_rows_f32_100k")
    ->ArgsProduct({{3, 5, 10, 20}, {kBest}});

template <class Real, std::size_t kCount>
void sh_sum_rgb(benchmark::State& state) {
  const InstructionSet set(state.range(1));
  if (!set.is_available(state)) return;
  const auto bands = static_cast<int>(state.range(0));
  const Sphere<Real> in(kCount);
  sh::ShRgb function{bands, {}};
  for (std::size_t i = 0; i < size_of(bands); ++i) {
    function.coefficients.emplace_back(1.0 / (1.0 + static_cast<double>(i)));
  }
  const sh::BatchFunction<Real> sum(function);
  std::vector<Real> r(kCount), g(kCount), b(kCount);
  time_directions(state, kCount, [&] { sum.evaluate(in.spans(), {r, g, b}); });
}
BENCHMARK(sh_sum_rgb<float, kMany>)
    ->Name("sh_sum_rgb_f32")
    ->ArgsProduct({{3, 5, 10, 20}, {kBest}})
    ->ArgsProduct({{5, 10}, {kAvx2, kSsse3}});
BENCHMARK(sh_sum_rgb<double, kMany>)->Name("sh_sum_rgb_f64")->ArgsProduct({{5, 10}, {kBest}});

// ---------------------------------------------------------------- limits and peers

/// The library's loop over single directions, each writing its row.
template <class Real>
void sh_basis_single(benchmark::State& state) {
  const auto bands = static_cast<int>(state.range(0));
  const Sphere<Real> in(kInCache);
  const sh::Basis<Real> basis(bands);
  const std::span<Real> values = arena<Real>(kInCache * size_of(bands));
  time_directions(state, kInCache, [&] {
    for (std::size_t k = 0; k < kInCache; ++k) {
      basis.evaluate(in.x[k], in.y[k], in.z[k], values.subspan(k * size_of(bands)));
    }
  });
}
BENCHMARK(sh_basis_single<double>)->Name("sh_basis_single_f64")->Arg(5)->Arg(10)->Arg(20);
BENCHMARK(sh_basis_single<float>)->Name("sh_basis_single_f32")->Arg(5)->Arg(10)->Arg(20);

/// Combines Legendre values of m >= 0 with the azimuth by a plain recursion; legendre(l, m) includes the normalisation.
template <class Legendre>
void combine(int bands, double x, double y, double z, const Legendre& legendre, double* out) {
  const double sine = std::sqrt((1.0 - z) * (1.0 + z));
  const double cos_phi = sine > 0.0 ? x / sine : 1.0;
  const double sin_phi = sine > 0.0 ? y / sine : 0.0;
  double c = 1.0;
  double s = 0.0;
  for (int m = 0; m < bands; ++m) {
    for (int l = m; l < bands; ++l) {
      const double value = (m > 0 ? std::sqrt(2.0) : 1.0) * legendre(l, m);
      out[sh::index(l, m)] = value * c;
      if (m > 0) out[sh::index(l, -m)] = value * s;
    }
    const double next = c * cos_phi - s * sin_phi;
    s = s * cos_phi + c * sin_phi;
    c = next;
  }
}

void peer_gsl(benchmark::State& state) {
  const auto bands = static_cast<int>(state.range(0));
  const Sphere<double> in(kInCache);
  const std::span<double> values = arena<double>(kInCache * size_of(bands));
  const auto degree = static_cast<std::size_t>(bands - 1);
  std::vector<double> plm(gsl_sf_legendre_array_n(degree));
  time_directions(state, kInCache, [&] {
    for (std::size_t k = 0; k < kInCache; ++k) {
      gsl_sf_legendre_array_e(GSL_SF_LEGENDRE_SPHARM, degree, in.z[k], -1.0, plm.data());
      const auto at = [&](int l, int m) {
        return plm[gsl_sf_legendre_array_index(static_cast<std::size_t>(l), static_cast<std::size_t>(m))];
      };
      combine(bands, in.x[k], in.y[k], in.z[k], at, values.data() + k * size_of(bands));
    }
  });
}
BENCHMARK(peer_gsl)->Arg(5)->Arg(10)->Arg(20);

void peer_std_sph_legendre(benchmark::State& state) {
  const auto bands = static_cast<int>(state.range(0));
  const Sphere<double> in(kInCache);
  const std::span<double> values = arena<double>(kInCache * size_of(bands));
  time_directions(state, kInCache, [&] {
    for (std::size_t k = 0; k < kInCache; ++k) {
      const double theta = std::acos(in.z[k]);
      const auto at = [&](int l, int m) {
        return std::sph_legendre(static_cast<unsigned>(l), static_cast<unsigned>(m), theta);
      };
      combine(bands, in.x[k], in.y[k], in.z[k], at, values.data() + k * size_of(bands));
    }
  });
}
BENCHMARK(peer_std_sph_legendre)->Arg(5)->Arg(10);

void peer_boost(benchmark::State& state) {
  const auto bands = static_cast<int>(state.range(0));
  const Sphere<double> in(8);
  const std::span<double> values = arena<double>(size_of(bands));
  time_directions(state, 8, [&] {
    for (std::size_t k = 0; k < 8; ++k) {
      const double theta = std::acos(in.z[k]);
      const double phi = std::atan2(in.y[k], in.x[k]);
      for (int l = 0; l < bands; ++l) {
        for (int m = -l; m <= l; ++m) {
          const auto n = static_cast<unsigned>(l);
          values[static_cast<std::size_t>(sh::index(l, m))] =
              m < 0 ? boost::math::spherical_harmonic_i(n, -m, theta, phi)
                    : boost::math::spherical_harmonic_r(n, m, theta, phi);
        }
      }
    }
  });
}
BENCHMARK(peer_boost)->Arg(5);

/// What one writes without a library: the normalised recurrence, direction after direction, in double.
void peer_plain_loop(benchmark::State& state) {
  const auto bands = static_cast<int>(state.range(0));
  const Sphere<double> in(kInCache);
  const std::span<double> values = arena<double>(kInCache * size_of(bands));
  std::vector<double> a(size_of(bands)), b(size_of(bands)), starts(static_cast<std::size_t>(bands));
  for (int m = 0; m < bands; ++m) {
    double square = (m > 0 ? 2.0 : 1.0) / (4.0 * kPi);
    for (int k = 1; k <= m; ++k) square *= (2.0 * k + 1.0) / (2.0 * k);
    starts[static_cast<std::size_t>(m)] = std::sqrt(square);
    for (int l = m + 1; l < bands; ++l) {
      const double gap = static_cast<double>(l * l - m * m);
      const auto i = static_cast<std::size_t>(sh::index(l, m));
      a[i] = std::sqrt((4.0 * l * l - 1.0) / gap);
      b[i] =
          l == m + 1 ? 0.0 : std::sqrt((2.0 * l + 1.0) / (2.0 * l - 3.0) * ((l - 1) * (l - 1) - m * m) / gap);
    }
  }
  time_directions(state, kInCache, [&] {
    for (std::size_t k = 0; k < kInCache; ++k) {
      double* out = values.data() + k * size_of(bands);
      double re = 1.0;
      double im = 0.0;
      for (int m = 0; m < bands; ++m) {
        double previous = 0.0;
        double q = starts[static_cast<std::size_t>(m)];
        for (int l = m; l < bands; ++l) {
          const auto i = static_cast<std::size_t>(sh::index(l, m));
          if (l > m) {
            const double next = a[i] * in.z[k] * q - b[i] * previous;
            previous = q;
            q = next;
          }
          out[i] = q * re;
          out[sh::index(l, -m)] = q * (m > 0 ? im : re);
        }
        const double next = in.y[k] * im - in.x[k] * re;
        im = -in.x[k] * im - in.y[k] * re;
        re = next;
      }
    }
  });
}
BENCHMARK(peer_plain_loop)->Arg(5)->Arg(10)->Arg(20);

}  // namespace
}  // namespace plumbline::bench
