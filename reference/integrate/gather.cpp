#include "reference/integrate/gather.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "reference/base/error.hpp"
#include "reference/base/parallel.hpp"

namespace plumbline::integrate {
namespace {

constexpr int kFirstRound =
    256;  // of a run towards a target: fewer could miss a small light and see "no error"
constexpr std::int64_t kPatience = 1 << 16;

void require_valid(const GatherSettings& settings) {
  if (settings.samples < 1)
    throw InputError(fmt::format("samples: expected at least 1, got {}", settings.samples));
  if (settings.max_bounces < 0)
    throw InputError(fmt::format("bounces: expected 0 or more, got {}", settings.max_bounces));
  if (settings.target_error && !(*settings.target_error > 0.0))
    throw InputError(fmt::format("target error: expected > 0, got {}", *settings.target_error));
}

void require_limit(const GatherSettings& settings) {
  if (settings.max_bounces == kAllBounces) throw InputError("bounces: per-bounce irradiance needs a limit");
}

struct Round {
  int number = 0;
  int samples = 0;
};

/// The samples of one round at one point; `bounces` = how many parts are wanted, 0 for the sum alone.
BouncesEstimate gather_round(const World& world, const trace::SurfacePoint& point, std::uint64_t stream,
                             const GatherSettings& settings, Round round, std::size_t bounces) {
  RandomisedMean sum(round.samples);
  std::vector<RandomisedMean> parts(bounces, RandomisedMean(round.samples));
  BounceTerms terms;
  for (int s = 0; s < round.samples; ++s) {
    const SamplePlace place = sample_place(round.number, round.samples, s);
    Sampler sampler(settings.seed, stream, place.randomisation, place.index);
    terms.clear();
    add_irradiance(world, point, settings.max_bounces, sampler, terms);
    RgbD value(0.0);
    for (const RgbD& term : terms) value += term;
    sum.add(s, value);
    for (std::size_t k = 0; k < std::min(bounces, terms.size()); ++k) parts[k].add(s, terms[k]);
  }
  BouncesEstimate result{sum.estimate(), {}};
  for (const RandomisedMean& part : parts) result.bounces.push_back(part.estimate());
  return result;
}

BouncesEstimate combined(const BouncesEstimate& a, const BouncesEstimate& b) {
  BouncesEstimate result{combined(a.irradiance, b.irradiance), b.bounces};
  for (std::size_t k = 0; k < a.bounces.size(); ++k) result.bounces[k] = combined(a.bounces[k], b.bounces[k]);
  return result;
}

/// Error of the sums. @throws InputError when it can never be relative to anything.
OverallError error_of(const std::vector<BouncesEstimate>& estimates) {
  std::vector<RgbEstimate> sums;
  for (const BouncesEstimate& estimate : estimates) sums.push_back(estimate.irradiance);
  const OverallError error = overall_error(sums);
  const bool is_hopeless = sums.front().samples >= kPatience && !std::isfinite(error.relative);
  if (std::isnan(error.relative) || is_hopeless) {
    throw InputError(
        fmt::format("target error: no error can be relative to a mean irradiance of {} ({} samples)",
                    error.mean, sums.front().samples));
  }
  return error;
}

void add_round(const World& world, std::span<const trace::SurfacePoint> points,
               const GatherSettings& settings, Round round, std::size_t bounces,
               std::vector<BouncesEstimate>& results) {
  std::atomic<std::size_t> done{0};
  parallel_for(points.size(), settings.threads, [&](std::size_t i) {
    results[i] = combined(results[i], gather_round(world, points[i], i, settings, round, bounces));
    const std::size_t count = done.fetch_add(1) + 1;
    if (settings.progress && !settings.target_error)
      settings.progress(static_cast<double>(count) / static_cast<double>(points.size()));
  });
}

std::vector<BouncesEstimate> gather(const World& world, std::span<const trace::SurfacePoint> points,
                                    const GatherSettings& settings, std::size_t bounces) {
  std::vector<BouncesEstimate> results(points.size());
  if (points.empty()) return results;
  Round round{0, settings.target_error ? kFirstRound : settings.samples};
  for (;; ++round.number) {
    add_round(world, points, settings, round, bounces, results);
    if (!settings.target_error) return results;
    const double error = error_of(results).relative;
    const bool is_done = error <= *settings.target_error;
    const double ratio = *settings.target_error / error;
    if (settings.progress) settings.progress(is_done ? 1.0 : ratio * ratio);
    if (is_done) return results;
    round.samples = samples_towards(*settings.target_error, results.front().irradiance.samples, error);
  }
}

}  // namespace

RgbEstimate gather_irradiance(const World& world, const trace::SurfacePoint& point, std::uint64_t stream,
                              const GatherSettings& settings) {
  require_valid(settings);
  return gather_round(world, point, stream, settings, {0, settings.samples}, 0).irradiance;
}

std::vector<RgbEstimate> gather_irradiance(const World& world, std::span<const trace::SurfacePoint> points,
                                           const GatherSettings& settings) {
  require_valid(settings);
  std::vector<RgbEstimate> results;
  for (const BouncesEstimate& estimate : gather(world, points, settings, 0))
    results.push_back(estimate.irradiance);
  return results;
}

std::vector<RgbEstimate> gather_bounces(const World& world, const trace::SurfacePoint& point,
                                        std::uint64_t stream, const GatherSettings& settings) {
  require_valid(settings);
  require_limit(settings);
  const std::size_t bounces = static_cast<std::size_t>(settings.max_bounces) + 1;
  return gather_round(world, point, stream, settings, {0, settings.samples}, bounces).bounces;
}

std::vector<BouncesEstimate> gather_bounces(const World& world, std::span<const trace::SurfacePoint> points,
                                            const GatherSettings& settings) {
  require_valid(settings);
  require_limit(settings);
  return gather(world, points, settings, static_cast<std::size_t>(settings.max_bounces) + 1);
}

}  // namespace plumbline::integrate
