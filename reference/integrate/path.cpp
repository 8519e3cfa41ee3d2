#include "reference/integrate/path.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "reference/integrate/hemisphere.hpp"
#include "reference/integrate/meeting.hpp"

namespace plumbline::integrate {
namespace {

constexpr double kInvPi = 1.0 / kPi;

/// n.w, or 0 where the surface itself is in the way.
float received_cosine(const trace::SurfacePoint& point, const Vec3& direction) {
  if (!(glm::dot(point.geometric_normal, direction) > 0.0F)) return 0.0F;
  return std::max(0.0F, glm::dot(point.shading_normal, direction));
}

/// Splitting counts in the weights: n samples of density p_l beside one of density p_b (Veach's multi-sample power heuristic).
RgbD sky_by_light(const World& world, const trace::SurfacePoint& point, std::uint32_t splits, const Vec2& u) {
  const std::optional<light::DirectionSample> sample = world.environment_sampler.sample(u);
  if (!sample || is_black(sample->radiance)) return RgbD(0.0);
  const double cosine = received_cosine(point, sample->direction);
  if (!(cosine > 0.0)) return RgbD(0.0);
  if (!is_visible(world, point, sample->direction, std::numeric_limits<float>::infinity())) return RgbD(0.0);
  const double weight = power_heuristic(splits * sample->pdf, cosine * kInvPi);
  return RgbD(sample->radiance) * (weight * cosine / sample->pdf);
}

RgbD emitters_by_light(const World& world, const trace::SurfacePoint& point, float pick, const Vec2& u) {
  const std::optional<EmitterSample> sample = world.emitters.sample(point.position, pick, u);
  if (!sample) return RgbD(0.0);
  const double cosine = received_cosine(point, sample->direction);
  if (!(cosine > 0.0)) return RgbD(0.0);
  if (!is_mutually_visible(world, point, sample->on_emitter)) return RgbD(0.0);
  const double weight = power_heuristic(sample->pdf, cosine * kInvPi);
  return RgbD(sample->radiance) * (weight * cosine / sample->pdf);
}

/// One of the lights without extent, drawn in proportion to what it would send without obstacles.
RgbD punctual_by_light(const World& world, const trace::SurfacePoint& point, float pick) {
  const auto unshadowed = [&](const light::PunctualLight& light) {
    const light::PunctualSample sample = light::incident_from(light, point.position);
    return static_cast<double>(max_component(sample.irradiance)) *
           static_cast<double>(received_cosine(point, sample.direction));
  };
  double total = 0.0;
  for (const light::PunctualLight& light : world.scene.lights) total += unshadowed(light);
  if (!(total > 0.0)) return RgbD(0.0);
  double remaining = static_cast<double>(pick) * total;
  const light::PunctualLight* chosen = nullptr;
  double weight = 0.0;
  for (const light::PunctualLight& light : world.scene.lights) {
    const double power = unshadowed(light);
    if (!(power > 0.0)) continue;
    chosen = &light;
    weight = power;
    if (remaining < power) break;
    remaining -= power;
  }
  const light::PunctualSample sample = light::incident_from(*chosen, point.position);
  if (!is_visible(world, point, sample.direction, sample.distance)) return RgbD(0.0);
  const double cosine = received_cosine(point, sample.direction);
  return RgbD(sample.irradiance) * (cosine * total / weight);
}

/// Light samples of the sky at the first vertex: they are most of the noise of a scene under an HDR sky, and cost one shadow ray each.
constexpr std::uint32_t kSkySplits = 4;

RgbD sky_by_light(const World& world, const trace::SurfacePoint& point, std::uint32_t splits,
                  Sampler& sampler) {
  const Sampler::Pair pair = sampler.next_pair();
  RgbD sum(0.0);
  for (std::uint32_t s = 0; s < splits; ++s)
    sum += sky_by_light(world, point, splits, sampler.point(pair, s, splits));
  return sum / static_cast<double>(splits);
}

/// Irradiance straight from the lights, drawn from the lights; `splits` samples of the sky.
RgbD direct_by_light(const World& world, const trace::SurfacePoint& point, std::uint32_t splits,
                     Sampler& sampler) {
  RgbD sum(0.0);
  if (world.is_sky_sampled && !world.is_sky_black) sum += sky_by_light(world, point, splits, sampler);
  if (!world.emitters.is_empty()) {
    const float pick = sampler.next_1d();
    sum += emitters_by_light(world, point, pick, sampler.next_2d());
  }
  if (!world.scene.lights.empty()) sum += punctual_by_light(world, point, sampler.next_1d());
  return sum;
}

/// The environment seen along a cosine-distributed direction of density `pdf`: irradiance estimate pi L,
/// weighted.
RgbD sky_by_direction(const World& world, const Vec3& direction, std::uint32_t splits, double pdf) {
  if (world.is_sky_black) return RgbD(0.0);
  const double weight =
      world.is_sky_sampled ? power_heuristic(pdf, splits * world.environment_sampler.pdf(direction)) : 1.0;
  return RgbD(light::radiance(world.environment, direction)) * (kPi * weight);
}

RgbD emitter_by_direction(const World& world, const Meeting& meeting, const Vec3& direction, double pdf) {
  if (is_black(meeting.emission)) return RgbD(0.0);
  return RgbD(meeting.emission) * (kPi * power_heuristic(pdf, emitter_pdf(world, meeting, direction)));
}

/// Probability to go on. The first bounce always does: it carries most of the indirect light, and ending it
/// early costs more variance than its two rays cost time (measured on the Cornell box: variance x time 4.0
/// against 5.1 for the throughput itself). Later the root of what is left; and in white rooms a little less
/// than 1 from a patient number of bounces on, so that a path without a way out ends. Not much less: a light
/// that is reached late is weighed with the inverse of all probabilities before.
float survival(const Rgb& throughput, int bounce) {
  constexpr int kPatience = 64;
  constexpr float kForEver = 0.998F;
  if (bounce == 0) return is_black(throughput) ? 0.0F : 1.0F;
  const float limit = bounce < kPatience ? 1.0F : kForEver;
  return std::min(std::sqrt(max_component(throughput)), limit);
}

void add(BounceTerms& terms, int bounce, const RgbD& value) {
  const auto slot = static_cast<std::size_t>(bounce);
  if (terms.size() <= slot) terms.resize(slot + 1, RgbD(0.0));
  terms[slot] += value;
}

}  // namespace

void add_irradiance(const World& world, const trace::SurfacePoint& start, int max_bounces, Sampler& sampler,
                    BounceTerms& terms) {
  trace::SurfacePoint point = start;
  Rgb throughput(1.0F);
  for (int bounce = 0;; ++bounce) {
    // 1. Light drawn from the lights.
    const std::uint32_t splits = bounce == 0 ? kSkySplits : 1;
    add(terms, bounce, RgbD(throughput) * direct_by_light(world, point, splits, sampler));

    // 2. A direction in proportion to the cosine; below the surface nothing arrives.
    const Vec3 direction = sample_cosine_hemisphere(point.shading_normal, sampler.next_2d());
    const double cosine = received_cosine(point, direction);
    if (!(cosine > 0.0)) return;
    const double pdf = cosine * kInvPi;
    const trace::Ray ray{trace::ray_origin(point, direction), direction};

    // 3. On the last bounce only an emitter could still matter: without any, whether the sky is seen is
    // enough.
    const bool is_last = bounce == max_bounces;
    if (is_last && !world.is_any_emissive) {
      if (!world.is_sky_black && !world.caster.is_occluded(ray)) {
        add(terms, bounce, RgbD(throughput) * sky_by_direction(world, direction, splits, pdf));
      }
      return;
    }
    const std::optional<Meeting> meeting = meet(world, ray);

    // 4. Light met by that direction.
    if (!meeting) {
      add(terms, bounce, RgbD(throughput) * sky_by_direction(world, direction, splits, pdf));
      return;
    }
    add(terms, bounce, RgbD(throughput) * emitter_by_direction(world, *meeting, direction, pdf));
    if (is_last) return;

    // 5. On to the next vertex: (albedo / pi) E cos / pdf = albedo E, then Russian roulette.
    throughput *= meeting->albedo;
    const float probability = survival(throughput, bounce);
    if (!(sampler.next_1d() < probability)) return;
    throughput /= probability;
    point = meeting->point;
  }
}

CameraSample sample_radiance(const World& world, const trace::Ray& ray, int max_bounces, Sampler& sampler,
                             BounceTerms& terms) {
  CameraSample result;
  terms.clear();
  const std::optional<Meeting> meeting = meet(world, ray);
  if (!meeting) {
    result.emission = light::radiance(world.environment, ray.direction);
    return result;
  }
  result.emission = meeting->emission;
  result.albedo = meeting->albedo;
  result.point = meeting->point;
  result.distance = meeting->distance;
  result.is_hit = true;
  if (is_black(result.albedo)) return result;
  add_irradiance(world, meeting->point, max_bounces, sampler, terms);
  for (RgbD& term : terms) term *= RgbD(result.albedo) * kInvPi;
  return result;
}

}  // namespace plumbline::integrate
