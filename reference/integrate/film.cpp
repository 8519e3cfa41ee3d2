#include "reference/integrate/film.hpp"

#include <algorithm>
#include <limits>

namespace plumbline::integrate {

RandomisedMean::RandomisedMean(int samples)
    : samples_(samples), randomisations_(std::min(kRandomisations, samples)) {}

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

SamplePlace sample_place(int round, int samples, int sample) {
  const int randomisations = std::min(kRandomisations, samples);
  return {static_cast<std::uint32_t>(round * kRandomisations + sample % randomisations),
          static_cast<std::uint32_t>(sample / randomisations)};
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

}  // namespace plumbline::integrate
