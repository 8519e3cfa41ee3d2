// reference/integrate/film.hpp: means that know how uncertain they are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "reference/base/vector.hpp"

namespace plumbline::integrate {

/// A mean with its standard error, per colour channel.
struct RgbEstimate {
  RgbD mean{0.0};
  RgbD standard_error{0.0};  // infinite when there is only one sample
  std::int64_t samples = 0;
};

/// Randomisations per round. Points within one are correlated (that is why they converge faster), so the
/// spread of single samples says nothing; the means of independent randomisations do. Truths: 15 degrees of
/// freedom.
inline constexpr int kRandomisations = 16;
/// The most and the fewest a run may ask for. Fewer make longer sequences, which converge faster, and a standard error of
/// fewer degrees of freedom: 2 leave one.
inline constexpr int kMostRandomisations = 32;
inline constexpr int kLeastRandomisations = 2;

/// Mean and standard error of n samples dealt round-robin to R = min(randomisations, n) independent ones:
///   mean = sum / n,  Var(mean) = R / (R - 1) * sum_r c_r^2 (m_r - mean)^2 / n^2,  c_r samples with mean m_r
///   in the r-th.
class RandomisedMean {
 public:
  explicit RandomisedMean(int samples, int randomisations = kRandomisations);

  /// The sample with this number, 0 <= index < samples.
  void add(int index, const RgbD& value);
  [[nodiscard]] RgbEstimate estimate() const;

 private:
  int samples_;
  int randomisations_;
  RgbD sums_[kMostRandomisations] = {};
};

/// Randomisation and place within it of a sample of a round.
struct SamplePlace {
  std::uint32_t randomisation = 0;
  std::uint32_t index = 0;
};
[[nodiscard]] SamplePlace sample_place(int round, int samples, int sample,
                                       int randomisations = kRandomisations);

/// Estimates of the same thing from independent rounds, weighted by their samples (weights that do not depend
/// on the values keep the mean unbiased).
[[nodiscard]] RgbEstimate combined(const RgbEstimate& a, const RgbEstimate& b);

/// Error of many estimates (pixels, points) as one number.
struct OverallError {
  double mean = 0.0;  // over all estimates and channels
  double relative =
      0.0;  // root of the mean squared standard error over that mean; infinite when it is not > 0
};
[[nodiscard]] OverallError overall_error(std::span<const RgbEstimate> estimates);

/// Samples that bring the relative error of `done` samples to the target, with a tenth to spare: at most three
/// times what there is (the error itself is an estimate), at least one for each randomisation.
[[nodiscard]] int samples_towards(double target_error, std::int64_t done, double relative_error);

}  // namespace plumbline::integrate
