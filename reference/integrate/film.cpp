#include "reference/integrate/film.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumbline::integrate {

RandomisedMean::RandomisedMean(int samples, int randomisations)
    : samples_(samples), randomisations_(std::min(randomisations, samples)) {}

void RandomisedMean::add(int index, const RgbD& value) {
  sums_[index % randomisations_] += value;
}

RgbEstimate RandomisedMean::estimate() const {
  RgbEstimate result;
  result.samples = samples_;
  const double n = samples_;
  for (int r = 0; r < randomisations_; ++r) result.mean += sums_[r];
  result.mean /= n;
  if (randomisations_ < 2) {
    result.standard_error = RgbD(std::numeric_limits<double>::infinity());
    return result;
  }
  RgbD squares(0.0);
  for (int r = 0; r < randomisations_; ++r) {
    const int count = samples_ / randomisations_ + (r < samples_ % randomisations_ ? 1 : 0);
    const RgbD deviation = sums_[r] - static_cast<double>(count) * result.mean;  // c_r (m_r - mean)
    squares += deviation * deviation;
  }
  const double groups = randomisations_;
  result.standard_error = glm::sqrt(squares * (groups / (groups - 1.0))) / n;
  return result;
}

SamplePlace sample_place(int round, int samples, int sample, int randomisations) {
  const int used = std::min(randomisations, samples);
  return {static_cast<std::uint32_t>(round * kMostRandomisations + sample % used),
          static_cast<std::uint32_t>(sample / used)};
}

RgbEstimate combined(const RgbEstimate& a, const RgbEstimate& b) {
  if (a.samples == 0) return b;
  if (b.samples == 0) return a;
  RgbEstimate result;
  result.samples = a.samples + b.samples;
  const double wa = static_cast<double>(a.samples) / static_cast<double>(result.samples);
  const double wb = 1.0 - wa;
  result.mean = wa * a.mean + wb * b.mean;
  const RgbD ea = wa * a.standard_error;
  const RgbD eb = wb * b.standard_error;
  result.standard_error = glm::sqrt(ea * ea + eb * eb);
  return result;
}

OverallError overall_error(std::span<const RgbEstimate> estimates) {
  double sum = 0.0;
  double variance = 0.0;
  double values = 0.0;
  for (const RgbEstimate& estimate : estimates) {
    if (estimate.samples == 0) continue;  // another shard's
    sum += estimate.mean.x + estimate.mean.y + estimate.mean.z;
    variance += glm::dot(estimate.standard_error, estimate.standard_error);
    values += 3.0;
  }
  if (values == 0.0) return {};
  const double root = std::sqrt(variance / values);
  const double mean = sum / values;
  if (root == 0.0) return {mean, 0.0};
  return {mean, mean > 0.0 ? root / mean : std::numeric_limits<double>::infinity()};
}

// The standard error falls at least as fast as the root of the samples: n (e / target)^2 are enough.
int samples_towards(double target_error, std::int64_t done, double relative_error) {
  constexpr double kMaxRound = 1 << 20;
  const double ratio = relative_error / target_error;
  const double missing = static_cast<double>(done) * (ratio * ratio - 1.0);
  double wanted = 3.0 * static_cast<double>(done);
  if (std::isfinite(missing)) wanted = std::min(wanted, 1.1 * missing);
  return static_cast<int>(std::clamp(std::ceil(wanted), static_cast<double>(kRandomisations), kMaxRound));
}

}  // namespace plumbline::integrate
