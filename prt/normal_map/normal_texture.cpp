#include "prt/normal_map/normal_texture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "reference/base/error.hpp"

namespace plumbline::normal_map {
namespace {

constexpr int kLargestSide = 4096;

Vec3d normal_at(double x, double y) {
  const double radius = std::hypot(x, y);
  if (radius >= 1.0) return {x / radius, y / radius, 0.0};
  return {x, y, std::sqrt(1.0 - radius * radius)};
}

}  // namespace

NormalTexture make_normal_texture(const NormalBasis& basis, int terms, int side) {
  (void)energy_kept(basis, terms);  // the range of terms
  if (side < 2 || side > kLargestSide) {
    throw InputError(fmt::format("normal texture: expected a side of 2 to {}, got {}", kLargestSide, side));
  }
  NormalTexture texture{side, terms, {}};
  std::array<double, kQuadraticCount> values{};
  const auto count = static_cast<std::size_t>(terms);
  texture.values.reserve(static_cast<std::size_t>(side) * static_cast<std::size_t>(side) * count);
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const Vec3d normal = normal_at(2.0 * (column + 0.5) / side - 1.0, 2.0 * (row + 0.5) / side - 1.0);
      evaluate_normal_functions(basis, normal, std::span(values).first(count));
      for (std::size_t k = 0; k < count; ++k) texture.values.push_back(static_cast<float>(values[k]));
    }
  }
  return texture;
}

void look_up(const NormalTexture& texture, const Vec3d& normal, std::span<double> values) {
  const auto terms = static_cast<std::size_t>(texture.terms);
  if (values.size() != terms) {
    throw InputError(fmt::format("normal texture: {} values for {} terms", values.size(), terms));
  }
  struct Place {
    std::size_t low;
    double weight_high;
  };
  const auto place = [&](double coordinate) {
    const double last = texture.side - 1.0;
    const double texel = std::clamp(0.5 * (coordinate + 1.0) * texture.side - 0.5, 0.0, last);
    const double low = std::min(std::floor(texel), last - 1.0);
    return Place{static_cast<std::size_t>(low), texel - low};
  };
  const Place x = place(normal.x);
  const Place y = place(normal.y);
  const auto side = static_cast<std::size_t>(texture.side);
  const auto at = [&](std::size_t row, std::size_t column, std::size_t k) {
    return static_cast<double>(texture.values[(row * side + column) * terms + k]);
  };
  for (std::size_t k = 0; k < terms; ++k) {
    const double low = std::lerp(at(y.low, x.low, k), at(y.low, x.low + 1, k), x.weight_high);
    const double high = std::lerp(at(y.low + 1, x.low, k), at(y.low + 1, x.low + 1, k), x.weight_high);
    values[k] = std::lerp(low, high, y.weight_high);
  }
}

}  // namespace plumbline::normal_map
