#include "reference/integrate/gather.hpp"

#include <atomic>

#include "reference/base/error.hpp"
#include "reference/base/parallel.hpp"

namespace plumbline::integrate {
namespace {

void require_samples(const GatherSettings& settings) {
  if (settings.samples < 1)
    throw InputError("samples: expected at least 1, got " + std::to_string(settings.samples));
  if (settings.max_bounces < 0)
    throw InputError("bounces: expected 0 or more, got " + std::to_string(settings.max_bounces));
}

Sampler sampler_of(const GatherSettings& settings, std::uint64_t stream, int sample) {
  const SamplePlace place = sample_place(0, settings.samples, sample);
  return {settings.seed, stream, place.randomisation, place.index};
}

}  // namespace

RgbEstimate gather_irradiance(const World& world, const trace::SurfacePoint& point, std::uint64_t stream,
                              const GatherSettings& settings) {
  require_samples(settings);
  RandomisedMean mean(settings.samples);
  BounceTerms terms;
  for (int s = 0; s < settings.samples; ++s) {
    Sampler sampler = sampler_of(settings, stream, s);
    terms.clear();
    add_irradiance(world, point, settings.max_bounces, sampler, terms);
    RgbD sum(0.0);
    for (const RgbD& term : terms) sum += term;
    mean.add(s, sum);
  }
  return mean.estimate();
}

std::vector<RgbEstimate> gather_irradiance(const World& world, std::span<const trace::SurfacePoint> points,
                                           const GatherSettings& settings) {
  require_samples(settings);
  std::vector<RgbEstimate> results(points.size());
  std::atomic<std::size_t> done{0};
  parallel_for(points.size(), settings.threads, [&](std::size_t i) {
    results[i] = gather_irradiance(world, points[i], i, settings);
    const std::size_t count = done.fetch_add(1) + 1;
    if (settings.progress) settings.progress(static_cast<double>(count) / static_cast<double>(points.size()));
  });
  return results;
}

std::vector<RgbEstimate> gather_bounces(const World& world, const trace::SurfacePoint& point,
                                        std::uint64_t stream, const GatherSettings& settings) {
  require_samples(settings);
  if (settings.max_bounces == kAllBounces) throw InputError("bounces: per-bounce irradiance needs a limit");
  const std::size_t count = static_cast<std::size_t>(settings.max_bounces) + 1;
  std::vector<RandomisedMean> means(count, RandomisedMean(settings.samples));
  BounceTerms terms;
  for (int s = 0; s < settings.samples; ++s) {
    Sampler sampler = sampler_of(settings, stream, s);
    terms.clear();
    add_irradiance(world, point, settings.max_bounces, sampler, terms);
    for (std::size_t k = 0; k < terms.size(); ++k) means[k].add(s, terms[k]);
  }
  std::vector<RgbEstimate> results;
  for (const RandomisedMean& mean : means) results.push_back(mean.estimate());
  return results;
}

}  // namespace plumbline::integrate
