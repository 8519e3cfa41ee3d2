// Random directions, means and errors, image metrics: the statistics that other results rest on.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "validation/conformance/check.hpp"
#include "validation/conformance/diagnosis.hpp"
#include "validation/metrics/statistics.hpp"

namespace plumbline::conformance {
namespace {

constexpr const char* kSamples = "sample directions";
constexpr const char* kMean = "mean and error";
constexpr const char* kRmse = "rmse";
constexpr double kSignificance = 1e-4;
constexpr std::size_t kCount = 1 << 16;
constexpr std::array kDistributions{PLUMBLINE_SAMPLE_SPHERE, PLUMBLINE_SAMPLE_HEMISPHERE,
                                    PLUMBLINE_SAMPLE_COSINE};
constexpr std::array kNames{"sphere", "hemisphere", "cosine"};

using Samples = Subject::Samples;

Samples drawn(const Context& context, int distribution, std::uint64_t seed, std::uint64_t stream,
              std::size_t count) {
  const std::optional<Samples> samples = context.subject.sample_directions(distribution, seed, stream, count);
  if (!samples) throw Refusal{"refuses to sample directions"};
  return *samples;
}

/// Moments of each distribution: E[z], E[z^2], E[x^2], E[x^2 y^2].
constexpr std::array<std::array<double, 4>, 3> kMoments{{{0.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 15.0},
                                                         {0.5, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 15.0},
                                                         {2.0 / 3.0, 0.5, 0.25, 1.0 / 24.0}}};

std::vector<Judged> validity(const Context& context) {
  double bad = 0.0;
  double density_error = 0.0;
  for (const int distribution : kDistributions) {
    const Samples samples = drawn(context, distribution, 1, 0, kCount);
    for (std::size_t i = 0; i < kCount; ++i) {
      const Vec3d& d = samples.directions[i];
      const bool is_unit = std::abs(glm::dot(d, d) - 1.0) <= 16.0 * context.subject.epsilon();
      const bool is_above = distribution == PLUMBLINE_SAMPLE_SPHERE || d.z >= 0.0;
      if (!is_unit || !is_above) bad += 1.0;
      const double density = distribution == PLUMBLINE_SAMPLE_SPHERE       ? 1.0 / (4.0 * kPi)
                             : distribution == PLUMBLINE_SAMPLE_HEMISPHERE ? 1.0 / (2.0 * kPi)
                                                                           : d.z / kPi;
      density_error = context.ruler.worse(density_error, std::abs(samples.densities[i] - density));
    }
  }
  return {
      judged(context, {kSamples, "unit directions", "Unit length, finite, above z = 0 for the hemisphere"},
             bad, 0.0,
             fmt::format("{:g} of {} directions are not finite, not of unit length or below the surface", bad,
                         3 * kCount)),
      judged(context, {kSamples, "densities", "1/4 pi, 1/2 pi, z/pi; rounding"}, density_error,
             16.0 * context.subject.epsilon(), fmt::format("densities are wrong by {:.3g}", density_error))};
}

std::vector<Judged> moments(const Context& context) {
  double worst = 0.0;
  std::string where = "none";
  std::size_t tests = 0;
  for (std::size_t k = 0; k < kDistributions.size(); ++k) {
    const Samples samples = drawn(context, kDistributions.at(k), 2, 0, kCount);
    std::array<metrics::RunningMoments, 4> sums;
    for (const Vec3d& d : samples.directions) {
      const std::array<double, 4> values{d.z, d.z * d.z, d.x * d.x, d.x * d.x * d.y * d.y};
      for (std::size_t m = 0; m < values.size(); ++m) sums.at(m).add(values.at(m));
    }
    constexpr std::array kWhich{"E[z]", "E[z^2]", "E[x^2]", "E[x^2 y^2]"};
    for (std::size_t m = 0; m < sums.size(); ++m) {
      const metrics::Estimate e = sums.at(m).estimate();
      ++tests;
      const double z = std::abs(e.mean - kMoments.at(k).at(m)) / e.standard_error;
      const double next = context.ruler.worse(worst, z);
      if (next != worst || std::isnan(next))
        where = fmt::format("{} of the {} distribution is {:.4f}, should be {:.4f}", kWhich.at(m),
                            kNames.at(k), e.mean, kMoments.at(k).at(m));
      worst = next;
    }
  }
  const double bound = metrics::two_sided_z(metrics::sidak(kSignificance, tests));
  Judged result = judged(
      context, {kSamples, "moments", "Closed forms; largest |z| of 12 tests, significance 1e-4 in all"},
      worst, bound, where);
  result.finding.unit = "standard errors";
  result.finding.seed = 2;
  return {result};
}

std::vector<Judged> distinct(const Context& context) {
  constexpr std::size_t kDraws = 4096;
  const Samples samples = drawn(context, PLUMBLINE_SAMPLE_SPHERE, 3, 0, kDraws);
  std::set<double> heights;
  for (const Vec3d& d : samples.directions) heights.insert(d.z);
  const auto repeated = static_cast<double>(kDraws - heights.size());
  // Floats between -1 and 1 have 2^24 values and more: 4096 draws repeat one in two runs.
  return {judged(
      context, {kSamples, "distinct values", "4096 draws from 2^24 values: 0.5 repeated; bound 20"}, repeated,
      20.0,
      fmt::format("only {} different values in {} samples: a coarse random number generator, the error stops "
                  "falling there",
                  heights.size(), kDraws))};
}

std::vector<Judged> streams(const Context& context) {
  const Samples a = drawn(context, PLUMBLINE_SAMPLE_SPHERE, 4, 0, kCount);
  const Samples again = drawn(context, PLUMBLINE_SAMPLE_SPHERE, 4, 0, kCount);
  const Samples b = drawn(context, PLUMBLINE_SAMPLE_SPHERE, 4, 1, kCount);
  const Samples c = drawn(context, PLUMBLINE_SAMPLE_SPHERE, 5, 0, kCount);
  double differing = 0.0;
  for (std::size_t i = 0; i < kCount; ++i) differing += a.directions[i] != again.directions[i] ? 1.0 : 0.0;
  const auto correlation = [&](const Samples& other) {
    metrics::RunningMoments product;
    for (std::size_t i = 0; i < kCount; ++i)
      product.add(3.0 * glm::dot(a.directions[i], other.directions[i]));
    const metrics::Estimate e = product.estimate();
    return e.standard_error > 0.0 ? std::abs(e.mean) / e.standard_error : HUGE_VAL;
  };
  const double bound = metrics::two_sided_z(metrics::sidak(kSignificance, 2));
  return {judged(context, {kSamples, "repeatable", "Same seed and stream, same bits"}, differing, 0.0,
                 "the same seed and stream give other samples"),
          judged(context, {kSamples, "independent streams", "Correlation of two streams, in standard errors"},
                 correlation(b), bound,
                 "all streams share one set of directions: errors are correlated, variance is a lie"),
          judged(context, {kSamples, "independent seeds", "Correlation of two seeds, in standard errors"},
                 correlation(c), bound, "the seed changes nothing")};
}

// ---------------------------------------------------------------- mean and error
Values mean_of(const Context& context, const Values& samples) {
  return must(context.subject.mean_and_error(samples), "two samples or more");
}

std::vector<Judged> small_means(const Context& context) {
  Pairs pairs;
  pairs.add({2.5, std::sqrt(5.0 / 12.0)}, mean_of(context, {1.0, 2.0, 3.0, 4.0}));
  pairs.add({0.0, 1.0}, mean_of(context, {-1.0, 1.0}));
  const double bound = 64.0 * context.subject.epsilon();
  return {judged_values(context, {kMean, "known samples", "sqrt(sum (x - mean)^2/(n (n - 1)))"}, pairs, bound,
                        1e-6)};
}

std::vector<Judged> large_offset(const Context& context) {
  Values samples;
  const double offset = context.subject.epsilon() > 1e-10 ? 1e3 : 1e8;
  for (int i = 0; i < 1000; ++i) samples.push_back(offset + (i % 2 == 0 ? 0.0 : 1.0));
  const Values answer = mean_of(context, samples);
  const double expected = std::sqrt(0.25 / 999.0);
  const double error = std::abs(answer[1] / expected - 1.0);
  return {judged(
      context, {kMean, "error of values far from 0", "Spread 0.5 about 1e8: n eps |offset|/spread"}, error,
      1e-3, fmt::format("standard error {:.4g} for {:.4g}: E[x^2] - E[x]^2 cancels", answer[1], expected))};
}

std::vector<Judged> long_sum(const Context& context) {
  constexpr std::size_t kLong = 1 << 18;
  Values samples(kLong, 0.1);
  samples[0] = 1000.0;
  const double expected = (1000.0 + 0.1 * (static_cast<double>(kLong) - 1.0)) / static_cast<double>(kLong);
  const double error = std::abs(mean_of(context, samples)[0] / expected - 1.0);
  return {judged(context, {kMean, "2^18 samples", "Sums in double: 1e-10"}, error, 1e-10,
                 fmt::format("mean wrong by {:.2g}: accumulated in single precision or less", error))};
}

std::vector<Judged> visible_nan(const Context& context) {
  double hidden = 0.0;
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    const Answer answer = context.subject.mean_and_error({1.0, bad, 2.0, 3.0});
    if (answer && std::isfinite((*answer)[0])) hidden += 1.0;
  }
  return {judged(context, {kMean, "non-finite samples show", "Counted, never skipped"}, hidden, 0.0,
                 fmt::format("{:g} of 3 non-finite samples are skipped silently", hidden))};
}

// ---------------------------------------------------------------- rmse
double rmse_of(const Context& context, const Values& a, const Values& b) {
  return must(context.subject.rmse(a, b), "two images")[0];
}

std::vector<Judged> known_rmse(const Context& context) {
  Pairs pairs;
  pairs.add({0.0}, {rmse_of(context, {1.0, 2.0, 3.0}, {1.0, 2.0, 3.0})});
  pairs.add({std::sqrt(12.5)}, {rmse_of(context, {0.0, 0.0}, {3.0, 4.0})});
  pairs.add({1e-4}, {rmse_of(context, {0.5, 0.5, 0.5}, {0.5001, 0.4999, 0.5001})});
  pairs.add({1.0}, {rmse_of(context, {10.0, 100.0}, {11.0, 99.0})});
  Judged result = judged_values(context, {kRmse, "known images", "Definition; rounding"}, pairs,
                                1e-9 + 64.0 * context.subject.epsilon(), 1e-6);
  if (!result.cause.empty()) {
    const double small = pairs.measured[2][0];
    const double apart = pairs.measured[1][0];
    if (apart == 0.0)
      result.cause = "0 for different images: an image is compared with itself";
    else if (small == 0.0 || small > 1e-3)
      result.cause = "differences below 1/255 are lost: compares 8-bit values";
    result.finding.detail = result.cause;
  }
  return {result};
}

std::vector<Judged> visible_in_rmse(const Context& context) {
  double hidden = 0.0;
  std::string which;
  const double nan = std::nan("");
  const std::array<std::pair<double, double>, 4> cases{
      {{nan, 1.0}, {1.0, nan}, {HUGE_VAL, 1.0}, {1.0, HUGE_VAL}}};
  constexpr std::array kCases{"NaN in the reference", "NaN in the test", "Inf in the reference",
                              "Inf in the test"};
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const Answer answer = context.subject.rmse({1.0, cases.at(k).first, 2.0}, {1.0, cases.at(k).second, 2.0});
    if (!answer || !std::isfinite((*answer)[0])) continue;
    hidden += 1.0;
    which += fmt::format("{}{}", which.empty() ? "" : ", ", kCases.at(k));
  }
  return {judged(context, {kRmse, "non-finite values show", "Counted, never skipped"}, hidden, 0.0,
                 "non-finite values are skipped silently: " + which)};
}

bool has_samples(const Implementation& i) {
  return i.sample_directions != nullptr;
}
bool has_mean(const Implementation& i) {
  return i.mean_and_error != nullptr;
}
bool has_rmse(const Implementation& i) {
  return i.rmse != nullptr;
}

}  // namespace

std::vector<Check> sampling_checks() {
  return {{kSamples, "directions and densities", has_samples, false, validity},
          {kSamples, "moments", has_samples, false, moments},
          {kSamples, "distinct values", has_samples, false, distinct},
          {kSamples, "seeds and streams", has_samples, false, streams},
          {kMean, "known samples", has_mean, false, small_means},
          {kMean, "error of values far from 0", has_mean, false, large_offset},
          {kMean, "2^18 samples", has_mean, false, long_sum},
          {kMean, "non-finite samples show", has_mean, false, visible_nan},
          {kRmse, "known images", has_rmse, false, known_rmse},
          {kRmse, "non-finite values show", has_rmse, false, visible_in_rmse}};
}

}  // namespace plumbline::conformance
