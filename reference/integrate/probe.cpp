#include "reference/integrate/probe.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <optional>

#include "reference/base/error.hpp"
#include "reference/base/parallel.hpp"
#include "reference/integrate/meeting.hpp"

namespace plumbline::integrate {
namespace {

constexpr double kUniformPdf = 0.25 / kPi;  // of directions drawn uniformly over the sphere

/// Archimedes: the height on the axis is uniform.
Vec3 uniform_direction(const Vec2& u) {
  const double z = 1.0 - 2.0 * static_cast<double>(u.x);
  const double radius = std::sqrt(std::fmax(0.0, 1.0 - z * z));
  const double phi = 2.0 * kPi * static_cast<double>(u.y);
  return Vec3(Vec3d(radius * std::cos(phi), radius * std::sin(phi), z));
}

/// The coefficients of one probe in the making.
class Expansion {
 public:
  Expansion(const SphereFunctions& functions, int samples)
      : functions_(functions), values_(functions.count), means_(functions.count, RandomisedMean(samples)) {}

  /// Adds to one sample light that arrives from one direction: weighted radiance over density [W m^-2].
  void add(int sample, const Vec3& direction, const RgbD& light) {
    if (light == RgbD(0.0)) return;
    evaluate(direction);
    for (std::size_t i = 0; i < values_.size(); ++i) means_[i].add(sample, values_[i] * light);
  }
  /// Adds to the result light that is known exactly.
  void add_to(std::vector<RgbEstimate>& coefficients, const Vec3& direction, const RgbD& light) {
    evaluate(direction);
    for (std::size_t i = 0; i < values_.size(); ++i) coefficients[i].mean += values_[i] * light;
  }
  [[nodiscard]] std::vector<RgbEstimate> estimates() const {
    std::vector<RgbEstimate> result;
    for (const RandomisedMean& mean : means_) result.push_back(mean.estimate());
    return result;
  }

 private:
  void evaluate(const Vec3& direction) { functions_.evaluate(glm::normalize(Vec3d(direction)), values_); }

  const SphereFunctions& functions_;
  std::vector<double> values_;
  std::vector<RandomisedMean> means_;
};

struct Arrival {
  Vec3 direction{0.0F};
  RgbD light{0.0};
};

/// Sky and suns, drawn from their own density.
Arrival sky_by_light(const World& world, const trace::SurfacePoint& point, const Vec2& u) {
  const std::optional<light::DirectionSample> sample = world.environment_sampler.sample(u);
  if (!sample || is_black(sample->radiance)) return {};
  if (!is_visible(world, point, sample->direction, std::numeric_limits<float>::infinity())) return {};
  const double weight = power_heuristic(sample->pdf, kUniformPdf);
  return {sample->direction, RgbD(sample->radiance) * (weight / sample->pdf)};
}

Arrival emitter_by_light(const World& world, const trace::SurfacePoint& point, const Vec2& pick,
                         const Vec2& u) {
  const std::optional<EmitterSample> sample = world.emitters.sample({point.position, {}}, pick, u);
  if (!sample || !is_mutually_visible(world, point, sample->on_emitter)) return {};
  const double weight = power_heuristic(sample->pdf, kUniformPdf);
  return {sample->direction, RgbD(sample->radiance) * (weight / sample->pdf)};
}

RgbD sky_by_direction(const World& world, const Vec3& direction) {
  if (world.is_sky_black) return RgbD(0.0);
  const double weight =
      world.is_sky_sampled ? power_heuristic(kUniformPdf, world.environment_sampler.pdf(direction)) : 1.0;
  return RgbD(light::radiance(world.environment, direction)) * (weight / kUniformPdf);
}

/// albedo E / pi at a surface that was met.
RgbD reflected(const World& world, const trace::SurfacePoint& point, const Rgb& albedo, int max_bounces,
               Sampler& sampler) {
  if (max_bounces == 0 || is_black(albedo)) return RgbD(0.0);
  BounceTerms terms;
  add_irradiance(world, point, max_bounces == kAllBounces ? kAllBounces : max_bounces - 1, sampler, terms);
  RgbD irradiance(0.0);
  for (const RgbD& term : terms) irradiance += term;
  return RgbD(albedo) * irradiance / kPi;
}

// L_i = what is seen + what is reflected. What is seen has two estimates, drawn from the lights and drawn
// uniformly over the sphere, combined by the power heuristic; what is reflected has the second alone.
RgbD light_by_direction(const World& world, const trace::SurfacePoint& point, const Vec3& direction,
                        int max_bounces, Sampler& sampler) {
  const std::optional<Meeting> meeting = meet(world, {trace::ray_origin(point, direction), direction});
  if (!meeting) return sky_by_direction(world, direction);
  RgbD radiance = reflected(world, meeting->point, meeting->albedo, max_bounces, sampler);
  if (!is_black(meeting->emission)) {
    radiance += RgbD(meeting->emission) *
                power_heuristic(kUniformPdf, emitter_pdf(world, {point.position, {}}, *meeting, direction));
  }
  return radiance / kUniformPdf;
}

void add_sample(const World& world, const trace::SurfacePoint& point, int max_bounces, int sample,
                Sampler& sampler, Expansion& expansion) {
  const auto add = [&](const Arrival& arrival) { expansion.add(sample, arrival.direction, arrival.light); };
  const Vec3 direction = uniform_direction(sampler.next_2d());
  if (world.is_sky_sampled && !world.is_sky_black) add(sky_by_light(world, point, sampler.next_2d()));
  if (!world.emitters.is_empty()) {
    const Vec2 pick = sampler.next_2d();
    add(emitter_by_light(world, point, pick, sampler.next_2d()));
  }
  add({direction, light_by_direction(world, point, direction, max_bounces, sampler)});
}

/// Lights without extent: nothing is random about them.
void add_punctual(const World& world, const trace::SurfacePoint& point, Expansion& expansion,
                  std::vector<RgbEstimate>& coefficients) {
  for (const light::PunctualLight& light : world.scene.lights) {
    const light::PunctualSample sample = light::incident_from(light, point.position);
    if (!is_finite(sample.direction) || !is_finite(sample.irradiance)) {
      throw InputError(fmt::format("probe at ({}, {}, {}): a light is exactly there", point.position.x,
                                   point.position.y, point.position.z));
    }
    if (is_black(sample.irradiance)) continue;
    const Vec3 origin = trace::ray_origin(point, sample.direction);
    if (world.caster.is_occluded({origin, sample.direction, sample.distance})) continue;
    expansion.add_to(coefficients, sample.direction, RgbD(sample.irradiance));
  }
}

void require_valid(const GatherSettings& settings) {
  if (settings.samples < 1)
    throw InputError(fmt::format("samples: expected at least 1, got {}", settings.samples));
  if (settings.max_bounces < 0)
    throw InputError(fmt::format("bounces: expected 0 or more, got {}", settings.max_bounces));
  if (settings.target_error) throw InputError("target error: probes take a number of samples instead");
}

}  // namespace

std::vector<RgbEstimate> gather_probe(const World& world, const trace::SurfacePoint& point,
                                      const SphereFunctions& functions, std::uint64_t stream,
                                      const GatherSettings& settings) {
  require_valid(settings);
  Expansion expansion(functions, settings.samples);
  for (int s = 0; s < settings.samples; ++s) {
    const SamplePlace place = sample_place(0, settings.samples, s);
    Sampler sampler(settings.seed, stream, place.randomisation, place.index);
    add_sample(world, point, settings.max_bounces, s, sampler, expansion);
  }
  std::vector<RgbEstimate> coefficients = expansion.estimates();
  add_punctual(world, point, expansion, coefficients);
  return coefficients;
}

std::vector<std::vector<RgbEstimate>> gather_probes(const World& world,
                                                    std::span<const trace::SurfacePoint> points,
                                                    const SphereFunctions& functions,
                                                    const GatherSettings& settings) {
  require_valid(settings);
  std::vector<std::vector<RgbEstimate>> probes(points.size());
  std::atomic<std::size_t> done{0};
  parallel_for(points.size(), settings.threads, [&](std::size_t i) {
    probes[i] = gather_probe(world, points[i], functions, i, settings);
    const std::size_t count = done.fetch_add(1) + 1;
    if (settings.progress) settings.progress(static_cast<double>(count) / static_cast<double>(points.size()));
  });
  return probes;
}

}  // namespace plumbline::integrate
