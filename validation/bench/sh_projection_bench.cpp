// validation/bench/sh_projection_bench.cpp: RGB images onto 5 bands, one thread, beside reading the image once
// (machine_read/6291456, machine_read/4718592) and beside transform libraries. Items are images.
#include <benchmark/benchmark.h>
#include <fftw3.h>
#include <libsharp/sharp_almhelpers.h>
#include <libsharp/sharp_geomhelpers.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "prt/sh/lighting.hpp"
#include "validation/bench/instruction_set.hpp"

namespace plumbline::bench {
namespace {

image::Image noise(int width, int height) {
  std::mt19937 bits(1);
  image::Image result = image::make_image(width, height);
  for (Rgb& texel : result.pixels) {
    for (int c = 0; c < 3; ++c) texel[c] = static_cast<float>(bits() % 4096) / 1024.0F;
  }
  return result;
}

light::Environment lat_long() {
  light::Environment result;
  result.name = "lat-long";
  result.sky = light::LatLongSky{noise(1024, 512)};
  return result;
}

light::Environment cube_map() {
  light::Environment result;
  result.name = "cube";
  light::CubeMapSky sky;
  for (image::Image& face : sky.faces) face = noise(256, 256);
  result.sky = sky;
  return result;
}

void time_projection(benchmark::State& state, const light::Environment& environment) {
  const InstructionSet set(state.range(1));
  if (!set.is_available(state)) return;
  for (auto _ : state) {
    sh::ShRgb result = sh::project_radiance(environment, static_cast<int>(state.range(0)), 1);
    benchmark::DoNotOptimize(result.coefficients.data());
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()));
}

void sh_project_lat_long(benchmark::State& state) {
  static const light::Environment environment = lat_long();
  time_projection(state, environment);
}
BENCHMARK(sh_project_lat_long)->ArgsProduct({{3, 5, 10}, {kBest}})->ArgsProduct({{5}, {kAvx2, kSsse3}});

void sh_project_cube(benchmark::State& state) {
  static const light::Environment environment = cube_map();
  time_projection(state, environment);
}
BENCHMARK(sh_project_cube)->ArgsProduct({{3, 5, 10}, {kBest}})->ArgsProduct({{5}, {kAvx2, kSsse3}});

/// libsharp's map2alm with Fejer's weights, the three channels one after the other; samples, not texel integrals.
void peer_sharp_lat_long(benchmark::State& state) {
  const auto bands = static_cast<int>(state.range(0));
  image::Image image = noise(1024, 512);
  sharp_geom_info* geometry = nullptr;
  sharp_alm_info* layout = nullptr;
  sharp_make_fejer1_geom_info(512, 1024, std::numbers::pi / 1024.0, 3, 3 * 1024, &geometry);
  sharp_make_triangular_alm_info(bands - 1, bands - 1, 1, &layout);
  std::vector<std::complex<float>> alm(static_cast<std::size_t>(bands * (bands + 1) / 2));
  for (auto _ : state) {
    for (int c = 0; c < 3; ++c) {
      void* alms[] = {alm.data()};
      void* maps[] = {&image.pixels[0].x + c};
      sharp_execute(SHARP_MAP2ALM, 0, alms, maps, geometry, layout, 0, nullptr, nullptr);
    }
    benchmark::ClobberMemory();
  }
  sharp_destroy_geom_info(geometry);
  sharp_destroy_alm_info(layout);
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()));
}
BENCHMARK(peer_sharp_lat_long)->Arg(5);

/// A projection by FFT of every row and Legendre functions of its middle.
void peer_fftw_lat_long(benchmark::State& state) {
  constexpr int kWidth = 1024;
  constexpr int kHeight = 512;
  const auto bands = static_cast<int>(state.range(0));
  image::Image image = noise(kWidth, kHeight);
  const int size[] = {kWidth};
  const int transforms = kHeight;
  std::vector<std::complex<float>> spectrum(static_cast<std::size_t>(kHeight) * (kWidth / 2 + 1));
  const sh::Basis<double> basis(bands);
  std::vector<double> y(static_cast<std::size_t>(bands * bands));
  std::vector<RgbD> sum(y.size());
  fftwf_plan plans[3];
  for (int c = 0; c < 3; ++c) {
    plans[c] = fftwf_plan_many_dft_r2c(1, size, transforms, &image.pixels[0].x + c, nullptr, 3, 3 * kWidth,
                                       reinterpret_cast<fftwf_complex*>(spectrum.data()), nullptr, 1,
                                       kWidth / 2 + 1, FFTW_ESTIMATE);
  }
  for (auto _ : state) {
    std::fill(sum.begin(), sum.end(), RgbD(0.0));
    for (int c = 0; c < 3; ++c) {
      fftwf_execute(plans[c]);
      for (int row = 0; row < kHeight; ++row) {
        const double theta = std::numbers::pi * (row + 0.5) / kHeight;
        basis.evaluate(std::sin(theta), 0.0, std::cos(theta), y);
        const std::complex<float>* f = spectrum.data() + static_cast<std::ptrdiff_t>(row) * (kWidth / 2 + 1);
        for (int l = 0; l < bands; ++l) {
          for (int m = 0; m <= l; ++m) {
            const double q = y[static_cast<std::size_t>(sh::index(l, m))] * std::sin(theta);
            sum[static_cast<std::size_t>(sh::index(l, m))][c] += q * static_cast<double>(f[m].real());
            if (m > 0)
              sum[static_cast<std::size_t>(sh::index(l, -m))][c] -= q * static_cast<double>(f[m].imag());
          }
        }
      }
    }
    benchmark::DoNotOptimize(sum.data());
  }
  for (fftwf_plan plan : plans) fftwf_destroy_plan(plan);
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()));
}
BENCHMARK(peer_fftw_lat_long)->Arg(5);

/// What one writes without a library: direction, solid angle and basis of every pixel.
void peer_plain_lat_long(benchmark::State& state) {
  const auto bands = static_cast<int>(state.range(0));
  const image::Image image = noise(1024, 512);
  const sh::Basis<double> basis(bands);
  std::vector<double> y(static_cast<std::size_t>(bands * bands));
  std::vector<RgbD> sum(y.size());
  for (auto _ : state) {
    std::fill(sum.begin(), sum.end(), RgbD(0.0));
    for (int row = 0; row < image.height; ++row) {
      const double theta = kPi * (row + 0.5) / image.height;
      const double weight = std::sin(theta) * 2.0 * kPi * kPi / image.width / image.height;
      for (int column = 0; column < image.width; ++column) {
        const double phi = 2.0 * kPi * (column + 0.5) / image.width;
        basis.evaluate(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta), y);
        const RgbD radiance = weight * RgbD(image.at(column, row));
        for (std::size_t i = 0; i < y.size(); ++i) sum[i] += y[i] * radiance;
      }
    }
    benchmark::DoNotOptimize(sum.data());
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()));
}
BENCHMARK(peer_plain_lat_long)->Arg(5);

}  // namespace
}  // namespace plumbline::bench
