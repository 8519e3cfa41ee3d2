#include "reference/integrate/allocation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace plumbline::integrate {
namespace {

constexpr double kLeastWeight = 0.25;
constexpr double kMostWeight = 8.0;

// Variance of one sample, all channels together; points of a sequence are taken as independent.
double variance(const RgbEstimate& estimate) {
  return glm::dot(estimate.standard_error, estimate.standard_error) * static_cast<double>(estimate.samples);
}

/// Mean over the 3 x 3 pixels around that have samples.
double smoothed(std::span<const RgbEstimate> pilot, int width, int height, int x, int y) {
  double sum = 0.0;
  int count = 0;
  for (int j = std::max(y - 1, 0); j <= std::min(y + 1, height - 1); ++j) {
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, width - 1); ++i) {
      const RgbEstimate& estimate =
          pilot[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)];
      if (estimate.samples == 0) continue;
      sum += variance(estimate);
      ++count;
    }
  }
  return count > 0 ? sum / count : 0.0;
}

}  // namespace

Allocation::Allocation(std::span<const RgbEstimate> pilot, int width, int height) {
  std::vector<double> deviations(pilot.size(), 0.0);
  double mean = 0.0;
  std::size_t sampled = 0;
  for (std::size_t p = 0; p < pilot.size(); ++p) {
    if (pilot[p].samples == 0) continue;
    const int x = static_cast<int>(p % static_cast<std::size_t>(width));
    const int y = static_cast<int>(p / static_cast<std::size_t>(width));
    deviations[p] = std::sqrt(smoothed(pilot, width, height, x, y));
    mean += deviations[p];
    ++sampled;
  }
  mean /= static_cast<double>(std::max<std::size_t>(sampled, 1));
  if (!(mean > 0.0) || !std::isfinite(mean)) return;  // no noise, or no idea of it: evenly
  weights_.assign(pilot.size(), 1.0F);
  double sum = 0.0;
  for (std::size_t p = 0; p < pilot.size(); ++p) {
    if (pilot[p].samples == 0) continue;
    const double weight = std::clamp(deviations[p] / mean, kLeastWeight, kMostWeight);
    weights_[p] = static_cast<float>(weight);
    sum += weight;
  }
  double even = 0.0;
  double dealt = 0.0;
  for (std::size_t p = 0; p < pilot.size(); ++p) {
    if (pilot[p].samples == 0) continue;
    weights_[p] = static_cast<float>(static_cast<double>(weights_[p]) * static_cast<double>(sampled) / sum);
    const double squared = deviations[p] * deviations[p];
    even += squared;
    dealt += squared / static_cast<double>(weights_[p]);
  }
  gain_ = dealt / even;
}

int Allocation::samples(std::size_t pixel, double mean, int randomisations) const {
  const double wanted = weights_.empty() ? mean : mean * static_cast<double>(weights_[pixel]);
  if (wanted < randomisations) return std::max(2, static_cast<int>(std::lround(wanted)));
  return randomisations * static_cast<int>(std::lround(wanted / randomisations));
}

}  // namespace plumbline::integrate
