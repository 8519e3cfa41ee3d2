#include "prt/sh/functions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "prt/sh/basis.hpp"
#include "prt/sh/quadrature.hpp"
#include "reference/base/error.hpp"
#include "reference/base/parallel.hpp"

namespace plumbline::sh {
namespace {

std::size_t size_of(int bands) {
  return static_cast<std::size_t>(coefficient_count(bands));
}

double finite_value(const SphereFunction& f, const Vec3d& direction, const char* where) {
  const double value = f(direction);
  if (std::isfinite(value)) return value;
  throw InputError(std::string(where) + ": the function is not finite at (" + std::to_string(direction.x) +
                   ", " + std::to_string(direction.y) + ", " + std::to_string(direction.z) + ")");
}

std::uint64_t mix(std::uint64_t value) {
  value += 0x9E3779B97F4A7C15U;
  value = (value ^ (value >> 30U)) * 0xBF58476D1CE4E5B9U;
  value = (value ^ (value >> 27U)) * 0x94D049BB133111EBU;
  return value ^ (value >> 31U);
}

struct Point {
  double u = 0.0;
  double v = 0.0;
};

// ---------------------------------------------------------------- the (0, 2)-sequence of Sobol'

/// First dimension: the bits of the index mirrored (van der Corput). Bit 31 of the result stands for 1/2.
std::uint32_t mirrored_bits(std::uint32_t index) {
  std::uint32_t result = 0;
  for (int bit = 0; bit < 32; ++bit)
    result |= ((index >> static_cast<unsigned>(bit)) & 1U) << static_cast<unsigned>(31 - bit);
  return result;
}

/// Second dimension: direction numbers of the primitive polynomial x + 1, which are Pascal's triangle modulo 2.
std::uint32_t second_sobol(std::uint32_t index) {
  std::uint32_t result = 0;
  for (std::uint32_t direction = 0x80000000U; index != 0; index >>= 1U, direction ^= direction >> 1U) {
    if ((index & 1U) != 0) result ^= direction;
  }
  return result;
}

/// Owen's scrambling, by its definition: each bit is flipped or not by a coin that belongs to the bits before it.
double scrambled(std::uint32_t bits, std::uint64_t key) {
  std::uint32_t result = 0;
  for (unsigned bit = 0; bit < 32; ++bit) {
    const std::uint64_t before = bit == 0 ? 0 : bits >> (32U - bit);
    const std::uint64_t coin = mix(key ^ mix(before + (std::uint64_t{1} << bit)));
    const std::uint32_t own = (bits >> (31U - bit)) & 1U;
    result |= (own ^ static_cast<std::uint32_t>(coin & 1U)) << (31U - bit);
  }
  return (static_cast<double>(result) + 0.5) * 0x1p-32;
}

// ---------------------------------------------------------------- points and directions

/// The points of one replicate.
class Points {
 public:
  Points(const MonteCarloSettings& settings, std::uint64_t replicate) : settings_(settings) {
    rows_ = static_cast<std::size_t>(std::sqrt(static_cast<double>(settings.samples)));
    columns_ = settings.samples / rows_;
    first_ = replicate * 2 * settings.samples;
    // Two uniform numbers of 53 bits name the scrambling.
    for (std::uint64_t i = 0; i < 2; ++i) {
      keys_[i] = mix(static_cast<std::uint64_t>(settings.uniform(first_ + i) * 0x1p53) + (i << 60U));
    }
  }

  [[nodiscard]] std::size_t count() const {
    return settings_.points == PointSet::stratified ? rows_ * columns_ : settings_.samples;
  }
  [[nodiscard]] Point at(std::size_t k) const {
    if (settings_.points == PointSet::quasi_random) {
      const auto index = static_cast<std::uint32_t>(k);
      return {scrambled(mirrored_bits(index), keys_[0]), scrambled(second_sobol(index), keys_[1])};
    }
    const double u = settings_.uniform(first_ + 2 * k);
    const double v = settings_.uniform(first_ + 2 * k + 1);
    if (settings_.points == PointSet::independent) return {u, v};
    return {(static_cast<double>(k / columns_) + u) / static_cast<double>(rows_),
            (static_cast<double>(k % columns_) + v) / static_cast<double>(columns_)};
  }

 private:
  const MonteCarloSettings& settings_;
  std::size_t rows_ = 0;
  std::size_t columns_ = 0;
  std::uint64_t first_ = 0;
  std::array<std::uint64_t, 2> keys_{};
};

struct Sampled {
  Vec3d direction;
  double inverse_density = 0.0;  // [sr]
};

// Uniform: z uniform in [-1, 1], density 1/(4 pi). Cosine: z^2 uniform in [0, 1], density z/pi.
Sampled sampled(const Point& point, DirectionDensity density) {
  const double phi = 2.0 * kPi * point.v;
  if (density == DirectionDensity::uniform) {
    const double z = 1.0 - 2.0 * point.u;
    const double radius = 2.0 * std::sqrt(point.u * (1.0 - point.u));
    return {Vec3d(radius * std::cos(phi), radius * std::sin(phi), z), 4.0 * kPi};
  }
  const double z = std::sqrt(1.0 - point.u);
  const double radius = std::sqrt(point.u);
  return {Vec3d(radius * std::cos(phi), radius * std::sin(phi), z), kPi / z};
}

std::vector<double> replicate_mean(const SphereFunction& f, int bands, const MonteCarloSettings& settings,
                                   const Points& points) {
  const Basis<double> basis(bands);
  std::vector<double> y(size_of(bands));
  std::vector<double> sum(y.size(), 0.0);
  for (std::size_t k = 0; k < points.count(); ++k) {
    const Sampled sample = sampled(points.at(k), settings.density);
    const double value =
        finite_value(f, sample.direction, "sh::estimate_projection") * sample.inverse_density;
    if (value == 0.0) continue;
    basis.evaluate(sample.direction.x, sample.direction.y, sample.direction.z, y);
    for (std::size_t i = 0; i < y.size(); ++i) sum[i] += value * y[i];
  }
  for (double& value : sum) value /= static_cast<double>(points.count());
  return sum;
}

void require_settings(const MonteCarloSettings& settings) {
  constexpr std::size_t kMaxSamples = std::size_t{1} << 32U;
  if (settings.samples < 1 || settings.samples > kMaxSamples) {
    throw InputError("sh::estimate_projection: samples: expected 1 to 2^32, got " +
                     std::to_string(settings.samples));
  }
  if (settings.replicates < 2) {
    throw InputError("sh::estimate_projection: replicates: expected at least 2, got " +
                     std::to_string(settings.replicates));
  }
}

}  // namespace

std::vector<double> project_function(const SphereFunction& f, int bands, int function_bands) {
  require_bands(bands);
  if (function_bands == 0) function_bands = bands;
  require_bands(function_bands);
  if (function_bands < bands) {
    throw InputError("sh::project_function: expected function_bands >= bands, got " +
                     std::to_string(function_bands) + " < " + std::to_string(bands));
  }
  const Basis<double> basis(bands);
  std::vector<double> y(size_of(bands));
  std::vector<double> result(y.size(), 0.0);
  for (const SphereNode& node : sphere_quadrature((bands + function_bands + 1) / 2)) {
    const double value = node.weight * finite_value(f, node.direction, "sh::project_function");
    basis.evaluate(node.direction.x, node.direction.y, node.direction.z, y);
    for (std::size_t i = 0; i < y.size(); ++i) result[i] += value * y[i];
  }
  return result;
}

UniformSource uniform_source(std::uint64_t seed) {
  const std::uint64_t key = mix(seed);
  return [key](std::uint64_t index) { return static_cast<double>(mix(key ^ mix(index)) >> 11U) * 0x1p-53; };
}

MonteCarloProjection estimate_projection(const SphereFunction& f, int bands,
                                         const MonteCarloSettings& settings) {
  require_bands(bands);
  require_settings(settings);
  const auto replicates = static_cast<std::size_t>(settings.replicates);
  std::vector<std::vector<double>> means(replicates);
  std::vector<std::size_t> counts(replicates);
  parallel_for(replicates, settings.threads, [&](std::size_t r) {
    const Points points(settings, r);
    means[r] = replicate_mean(f, bands, settings, points);
    counts[r] = points.count();
  });
  MonteCarloProjection result;
  for (const std::size_t count : counts) result.evaluations += count;
  const auto count = static_cast<double>(replicates);
  for (std::size_t i = 0; i < size_of(bands); ++i) {
    double mean = 0.0;
    for (const std::vector<double>& one : means) mean += one[i] / count;
    double square = 0.0;
    for (const std::vector<double>& one : means) square += (one[i] - mean) * (one[i] - mean);
    result.coefficients.push_back(mean);
    result.standard_errors.push_back(std::sqrt(square / (count * (count - 1.0))));
  }
  return result;
}

}  // namespace plumbline::sh
