#include "prt/sh/lighting.hpp"

#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "reference/base/error.hpp"

namespace plumbline::sh {
namespace {

void require_consistent(const ShRgb& function, const char* where) {
  require_bands(function.bands);
  const auto expected = static_cast<std::size_t>(coefficient_count(function.bands));
  if (function.coefficients.size() != expected) {
    throw InputError(std::string(where) + ": expected " + std::to_string(expected) + " coefficients for " +
                     std::to_string(function.bands) + " bands, got " +
                     std::to_string(function.coefficients.size()));
  }
}

/// The sum over all coefficients, for many directions.
class BandLimitedFunction {
 public:
  explicit BandLimitedFunction(ShRgb function)
      : basis_(function.bands), coefficients_(std::move(function.coefficients)) {}

  [[nodiscard]] RgbD operator()(const Vec3d& direction) const {
    constexpr std::size_t kOnStack = 400;
    if (coefficients_.size() <= kOnStack) {
      std::array<double, kOnStack> values;
      return sum(direction, values);
    }
    std::vector<double> values(coefficients_.size());
    return sum(direction, values);
  }

 private:
  [[nodiscard]] RgbD sum(const Vec3d& direction, std::span<double> values) const {
    basis_.evaluate(direction.x, direction.y, direction.z, values);
    // Four sums at a time: one alone would wait for its own additions.
    std::array<RgbD, 4> sums{RgbD(0.0), RgbD(0.0), RgbD(0.0), RgbD(0.0)};
    const std::size_t size = coefficients_.size();
    std::size_t i = 0;
    for (; i + 4 <= size; i += 4) {
      for (std::size_t k = 0; k < 4; ++k) sums[k] += values[i + k] * coefficients_[i + k];
    }
    for (; i < size; ++i) sums[0] += values[i] * coefficients_[i];
    return (sums[0] + sums[1]) + (sums[2] + sums[3]);
  }

  Basis<double> basis_;
  std::vector<RgbD> coefficients_;
};

}  // namespace

RgbD evaluate(const ShRgb& function, const Vec3d& direction) {
  require_consistent(function, "sh::evaluate");
  return BandLimitedFunction(function)(direction);
}

double window_factor(Window window, int degree, int bands, double lambda) {
  require_bands(bands);
  if (degree < 0 || degree >= bands) {
    throw InputError("window_factor: expected a degree in 0 to " + std::to_string(bands - 1) + ", got " +
                     std::to_string(degree));
  }
  if (window == Window::laplacian && !(lambda >= 0.0 && std::isfinite(lambda))) {
    throw InputError("window_factor: expected a finite lambda >= 0, got " + std::to_string(lambda));
  }
  if (degree == 0) return 1.0;
  const double x = kPi * degree / bands;
  const double l = degree;
  switch (window) {
    case Window::none:
      return 1.0;
    case Window::hann:
      return 0.5 * (1.0 + std::cos(x));
    case Window::lanczos:
      return std::sin(x) / x;
    case Window::gauss:
      return std::exp(-0.5 * x * x);
    case Window::laplacian:
      return 1.0 / (1.0 + lambda * l * l * (l + 1.0) * (l + 1.0));
  }
  throw InputError("window_factor: no such window");
}

ShRgb windowed(ShRgb function, Window window, double lambda) {
  require_consistent(function, "sh::windowed");
  for (int l = 0; l < function.bands; ++l) {
    const double factor = window_factor(window, l, function.bands, lambda);
    for (int m = -l; m <= l; ++m) function.coefficients[static_cast<std::size_t>(index(l, m))] *= factor;
  }
  return function;
}

light::Environment band_limited_environment(const ShRgb& lighting, const std::string& name) {
  require_consistent(lighting, "sh::band_limited_environment");
  light::Environment environment;
  environment.name = name;
  // Shared, so that copies of the environment (and of its std::function) stay cheap.
  const auto function = std::make_shared<const BandLimitedFunction>(lighting);
  environment.sky = light::AnalyticSky{
      [function](const Vec3& direction) { return Rgb((*function)(glm::normalize(Vec3d(direction)))); }};
  return environment;
}

}  // namespace plumbline::sh
