#include "validation/metrics/ssim.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "reference/base/error.hpp"

namespace plumbline::metrics {
namespace {

constexpr int kRadius = 5;
constexpr double kSigma = 1.5;
constexpr double kC1 = 0.01 * 0.01;
constexpr double kC2 = 0.03 * 0.03;

// First and second moments of a window: weighted means of a, b, a a, b b, a b.
using Moments = std::array<double, 5>;

std::array<double, 2 * kRadius + 1> window() {
  std::array<double, 2 * kRadius + 1> weights{};
  for (int i = -kRadius; i <= kRadius; ++i) {
    weights[static_cast<std::size_t>(i + kRadius)] = std::exp(-i * i / (2.0 * kSigma * kSigma));
  }
  return weights;
}

// Weighted mean of at(i) over i = centre - 5 ... centre + 5, as far as that lies in 0 ... count - 1. A cut
// window of two dimensions is the product of two cut windows of one, so renormalising each renormalises both.
template <typename At>
Moments window_mean(int centre, int count, const At& at) {
  static const auto weights = window();
  Moments sum{};
  double weight_sum = 0.0;
  for (int i = std::max(centre - kRadius, 0); i <= std::min(centre + kRadius, count - 1); ++i) {
    const double weight = weights[static_cast<std::size_t>(i - centre + kRadius)];
    const Moments values = at(i);
    for (std::size_t m = 0; m < sum.size(); ++m) sum[m] += weight * values[m];
    weight_sum += weight;
  }
  for (double& value : sum) value /= weight_sum;
  return sum;
}

double similarity(const Moments& moments) {
  const auto [a, b, aa, bb, ab] = moments;
  const double luminance = (2.0 * a * b + kC1) / (a * a + b * b + kC1);
  const double structure = (2.0 * (ab - a * b) + kC2) / ((aa - a * a) + (bb - b * b) + kC2);
  return luminance * structure;
}

}  // namespace

double ssim(std::span<const float> a, std::span<const float> b, int width, int height) {
  const auto count =
      static_cast<std::size_t>(std::max(width, 0)) * static_cast<std::size_t>(std::max(height, 0));
  if (count == 0 || a.size() != count || b.size() != count) {
    throw InputError(
        fmt::format("ssim: both images must hold width * height > 0 values, hold {} and {} for {} x {}",
                    a.size(), b.size(), width, height));
  }
  const auto index = [width](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  };
  std::vector<Moments> rows(count);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      rows[index(x, y)] = window_mean(x, width, [&](int i) -> Moments {
        const double va = a[index(i, y)];
        const double vb = b[index(i, y)];
        return {va, vb, va * va, vb * vb, va * vb};
      });
    }
  }
  double sum = 0.0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      sum += similarity(window_mean(y, height, [&](int i) { return rows[index(x, i)]; }));
    }
  }
  return sum / static_cast<double>(count);
}

}  // namespace plumbline::metrics
