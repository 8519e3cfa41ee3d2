#include <cmath>

#include "validation/conformance/faults/build.hpp"

namespace plumbline::conformance {
namespace {

using I = plumbline_implementation;

/// kChange(distribution, directions, densities, count) after our samples.
template <auto kChange>
plumbline_implementation samples_then() {
  return ours_with(
      &I::sample_directions, +[](std::int32_t distribution, std::uint64_t seed, std::uint64_t stream,
                                 std::size_t count, double* directions, double* densities) {
        const int status =
            plumbline_sh().sample_directions(distribution, seed, stream, count, directions, densities);
        for (std::size_t i = 0; i < count; ++i)
          kChange(distribution, i, count, directions + 3 * i, densities + i);
        return status;
      });
}

void set_height(double* d, double z) {
  const double phi = std::atan2(d[1], d[0]);
  const double radius = std::sqrt(1.0 - z * z);  // NaN for a z that is no cosine
  d[0] = radius * std::cos(phi);
  d[1] = radius * std::sin(phi);
  d[2] = z;
}

std::vector<Fault> sample_faults() {
  return {
      {"L1", "gentle introduction, GenerateSamples",
       "a = i + random/N for (i + random)/N: arguments beyond 1", "sample directions: unit directions",
       "not finite", samples_then<[](int, std::size_t i, std::size_t n, double* d, double*) {
         const double a = static_cast<double>(i % 7) + 0.5 * (1.0 - d[2]) / static_cast<double>(n);
         set_height(d, 1.0 - 2.0 * a);
       }>()},
      {"L3", "gentle introduction, Random", "rand() % 1000 / 1000: 1000 values",
       "sample directions: distinct values", "different values in 4096 samples",
       samples_then<[](int, std::size_t, std::size_t, double* d, double*) {
         set_height(d, 2.0 * std::floor(500.0 * (d[2] + 1.0)) / 1000.0 - 1.0);
       }>()},
      {"T32", "glue PrtBaker.cpp; SORT #35", "one direction set for all texels and threads",
       "sample directions: independent streams", "share one set of directions",
       ours_with(
           &I::sample_directions,
           +[](std::int32_t distribution, std::uint64_t seed, std::uint64_t, std::size_t count,
               double* directions, double* densities) {
             return plumbline_sh().sample_directions(distribution, seed, 0, count, directions, densities);
           })},
      {"T44", "seed ignored", "every run draws the same samples", "sample directions: independent seeds",
       "the seed changes nothing",
       ours_with(
           &I::sample_directions,
           +[](std::int32_t distribution, std::uint64_t, std::uint64_t stream, std::size_t count,
               double* directions, double* densities) {
             return plumbline_sh().sample_directions(distribution, 1, stream, count, directions, densities);
           })},
      {"T34", "shimmer #58", "density of the uniform hemisphere twice too large",
       "sample directions: densities", "densities are wrong",
       samples_then<[](int kind, std::size_t, std::size_t, double*, double* density) {
         if (kind == PLUMBLINE_SAMPLE_HEMISPHERE) *density *= 2.0;
       }>()},
      {"T35", "RayTracing TheRestOfYourLife issues 8 and 9", "cosine samples with x and y times 2",
       "sample directions: moments", "cosine distribution",
       samples_then<[](int kind, std::size_t, std::size_t, double* d, double*) {
         if (kind != PLUMBLINE_SAMPLE_COSINE) return;
         const double length = std::sqrt(4.0 * (d[0] * d[0] + d[1] * d[1]) + d[2] * d[2]);
         d[0] *= 2.0 / length;
         d[1] *= 2.0 / length;
         d[2] /= length;
       }>()},
      {"T37", "pbrt-v2 #58", "uniform directions where the cosine is meant", "sample directions: moments",
       "cosine distribution",
       samples_then<[](int kind, std::size_t, std::size_t, double* d, double* density) {
         if (kind != PLUMBLINE_SAMPLE_COSINE) return;
         set_height(d, d[2] * d[2]);
         *density = d[2] / kPi;
       }>()},
  };
}

// ---------------------------------------------------------------- means
double rounded_half(double v) {
  int exponent = 0;
  const double mantissa = std::frexp(v, &exponent);
  return std::ldexp(std::nearbyint(mantissa * 2048.0) / 2048.0, exponent);
}

std::vector<Fault> mean_faults() {
  return {
      {"T45a", "three-gpu-pathtracer #133", "running mean in single precision",
       "mean and error: 2^18 samples", "single precision",
       ours_with(
           &I::mean_and_error,
           +[](std::size_t count, const double* x, double* result) {
             const int status = plumbline_sh().mean_and_error(count, x, result);
             float mean = 0.0F;
             for (std::size_t i = 0; i < count; ++i)
               mean += (static_cast<float>(x[i]) - mean) / static_cast<float>(i + 1);
             result[0] = static_cast<double>(mean);
             return status;
           })},
      {"T45b", "DXRPathTracer #2, BakingLab #6", "16-bit accumulator", "mean and error: 2^18 samples",
       "single precision or less",
       ours_with(
           &I::mean_and_error,
           +[](std::size_t count, const double* x, double* result) {
             const int status = plumbline_sh().mean_and_error(count, x, result);
             double sum = 0.0;
             for (std::size_t i = 0; i < count; ++i) sum = rounded_half(sum + x[i]);
             result[0] = sum / static_cast<double>(count);
             return status;
           })},
      {"VAR", "google/benchmark statistics", "variance as E[x^2] - E[x]^2",
       "mean and error: error of values far from 0", "cancels",
       ours_with(
           &I::mean_and_error,
           +[](std::size_t count, const double* x, double* result) {
             double sum = 0.0;
             double squares = 0.0;
             for (std::size_t i = 0; i < count; ++i) {
               sum += x[i];
               squares += x[i] * x[i];
             }
             const auto n = static_cast<double>(count);
             result[0] = sum / n;
             result[1] = std::sqrt(std::fmax(0.0, squares / n - result[0] * result[0]) / (n - 1.0));
             return 0;
           })},
      {"SEM", "standard deviation for standard error", "not divided by the root of the count",
       "mean and error: known samples", "",
       ours_with(
           &I::mean_and_error,
           +[](std::size_t count, const double* x, double* result) {
             const int status = plumbline_sh().mean_and_error(count, x, result);
             result[1] *= std::sqrt(static_cast<double>(count));
             return status;
           })},
      {"T52a", "samplers that drop bad samples", "non-finite samples skipped",
       "mean and error: non-finite samples show", "skipped silently",
       ours_with(
           &I::mean_and_error,
           +[](std::size_t count, const double* x, double* result) {
             std::vector<double> kept;
             for (std::size_t i = 0; i < count; ++i)
               if (std::isfinite(x[i])) kept.push_back(x[i]);
             return plumbline_sh().mean_and_error(kept.size(), kept.data(), result);
           })},
  };
}

// ---------------------------------------------------------------- metrics
/// Only pairs that kTakes accepts, or all of them changed by kValue.
template <auto kTakes, auto kValue>
plumbline_implementation rmse_by() {
  return ours_with(
      &I::rmse, +[](std::size_t count, const double* a, const double* b, double* result) {
        double sum = 0.0;
        for (std::size_t i = 0; i < count; ++i)
          if (kTakes(a[i], b[i])) sum += std::pow(kValue(b[i]) - kValue(a[i]), 2);
        *result = std::sqrt(sum / static_cast<double>(count));
        return 0;
      });
}
double as_it_is(double v) {
  return v;
}
bool all_of_them(double, double) {
  return true;
}

std::vector<Fault> metric_faults() {
  return {
      {"T52b", "pbrt image.cpp", "the metric skips infinite errors", "rmse: non-finite values show",
       "Inf in the test", rmse_by<[](double a, double b) { return !std::isinf(a - b); }, as_it_is>()},
      {"T52c", "comparisons with NaN are false", "NaN never counts as a difference",
       "rmse: non-finite values show", "NaN in the test",
       rmse_by<[](double a, double b) { return std::abs(a - b) >= 0.0; }, as_it_is>()},
      {"T52d", "golden images as PNG", "compares 8-bit values", "rmse: known images", "8-bit",
       rmse_by<all_of_them, [](double v) { return std::isfinite(v) ? std::round(v * 255.0) / 255.0 : v; }>()},
      {"T52e", "the test image loaded twice", "compares an image with itself", "rmse: known images",
       "with itself",
       ours_with(
           &I::rmse, +[](std::size_t count, const double* a, const double*,
                         double* result) { return plumbline_sh().rmse(count, a, a, result); })},
  };
}

}  // namespace

std::vector<Fault> statistics_faults() {
  std::vector<Fault> all = sample_faults();
  for (const auto part : {mean_faults, metric_faults}) {
    const std::vector<Fault> more = part();
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

}  // namespace plumbline::conformance
