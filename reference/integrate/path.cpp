#include "reference/integrate/path.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

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

/// What the lights are chosen for: they count by the cosine with the shading normal.
Receiver receiver_at(const trace::SurfacePoint& point) {
  return {point.position, point.shading_normal};
}

/// Samples of the lights and directions followed at the first vertex: its light is most of the noise of an image, and the
/// camera ray is paid already. Powers of two.
constexpr std::uint32_t kSkySplits = 8;
constexpr std::uint32_t kEmitterSplits = 2;
constexpr std::uint32_t kDirectionSplits = 4;
/// Vertices whose samples are points of one sequence over the whole pixel; deeper ones are so rarely alike from path to path
/// that independent numbers serve as well.
constexpr int kStratifiedVertices = 3;

/// Where a vertex takes its random numbers from.
struct VertexDraws {
  Sampler::Pair light;
  Sampler::Pair emitter;
  Sampler::Pair direction;
};
using PathDraws = std::array<VertexDraws, kStratifiedVertices>;

PathDraws make_draws(Sampler& sampler) {
  PathDraws draws;
  for (VertexDraws& vertex : draws) vertex = {sampler.next_pair(), sampler.next_pair(), sampler.next_pair()};
  return draws;
}

/// Sample `split` of `splits` of one vertex; `draws` is null for vertices beyond the stratified ones.
struct Draw {
  const VertexDraws* draws = nullptr;
  std::uint32_t split = 0;
  std::uint32_t splits = 1;

  [[nodiscard]] Vec2 light(Sampler& sampler) const {
    return draws != nullptr ? sampler.point(draws->light, split, splits) : sampler.independent_2d();
  }
  [[nodiscard]] Vec2 emitter(Sampler& sampler) const {
    return draws != nullptr ? sampler.point(draws->emitter, split, splits) : sampler.independent_2d();
  }
  [[nodiscard]] Vec2 direction(Sampler& sampler) const {
    return draws != nullptr ? sampler.point(draws->direction, split, splits) : sampler.independent_2d();
  }
};

/// Irradiance from the sky and its suns, drawn nearly in proportion to radiance times cosine: a direction followed by chance
/// has nothing to add to that estimate.
RgbD sky_by_light(const World& world, const trace::SurfacePoint& point, std::uint32_t count,
                  const Draw& first, Sampler& sampler) {
  std::array<Vec2, kSkySplits> points;
  std::array<light::LobeSample, kSkySplits> samples;
  Draw draw = first;
  for (std::uint32_t s = 0; s < count; ++s, ++draw.split) points[s] = draw.light(sampler);
  world.environment_sampler.sample(world.environment_sampler.lobe(point.shading_normal),
                                   std::span(points).first(count), std::span(samples).first(count));
  // Light below the horizon needs no ray.
  std::array<trace::Ray, kSkySplits> rays;
  std::array<const light::LobeSample*, kSkySplits> senders;
  std::array<double, kSkySplits> weights;
  std::size_t left = 0;
  for (std::uint32_t s = 0; s < count; ++s) {
    const light::LobeSample& sample = samples[s];
    if (!(sample.pdf > 0.0)) continue;
    const double cosine = received_cosine(point, sample.direction);
    if (!(cosine > 0.0)) continue;
    rays[left] = {trace::ray_origin(point, sample.direction), sample.direction};
    senders[left] = &sample;
    weights[left++] = cosine / sample.pdf;
  }
  RgbD sum(0.0);
  if (left == 0) return sum;
  const std::uint32_t occluded = left == 1 ? static_cast<std::uint32_t>(world.caster.is_occluded(rays[0]))
                                           : world.caster.occluded(std::span(rays).first(left));
  for (std::size_t i = 0; i < left; ++i) {
    if ((occluded >> i & 1U) == 0U) sum += RgbD(senders[i]->radiance()) * weights[i];
  }
  return sum;
}

/// How many samples of one vertex draw from the sky and from emitters, and how many follow a direction: the last two count in
/// the weights (Veach's multi-sample power heuristic).
struct Counts {
  std::uint32_t sky = 1;
  std::uint32_t emitter = 1;
  std::uint32_t direction = 1;
};

RgbD emitters_by_light(const World& world, const trace::SurfacePoint& point, const Counts& counts,
                       const Vec2& pick, const Vec2& u) {
  const std::optional<EmitterSample> sample = world.emitters.sample(receiver_at(point), pick, u);
  if (!sample) return RgbD(0.0);
  const double cosine = received_cosine(point, sample->direction);
  if (!(cosine > 0.0)) return RgbD(0.0);
  if (!is_mutually_visible(world, point, sample->on_emitter)) return RgbD(0.0);
  const double weight = power_heuristic(counts.emitter * sample->pdf, counts.direction * cosine * kInvPi);
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

/// Irradiance straight from the lights, drawn from the lights. `split`: which of the vertex' walks this is.
RgbD direct_by_light(const World& world, const trace::SurfacePoint& point, const Counts& counts,
                     const VertexDraws* draws, std::uint32_t split, std::uint32_t splits, Sampler& sampler) {
  RgbD sum(0.0);
  if (world.is_sky_sampled && !world.is_sky_black) {
    const Draw first{draws, split * counts.sky, splits * counts.sky};
    sum += sky_by_light(world, point, counts.sky, first, sampler) / static_cast<double>(counts.sky);
  }
  const Draw first{draws, split * counts.emitter, splits * counts.emitter};
  if (!world.emitters.is_empty()) {
    RgbD emitters(0.0);
    for (Draw draw = first; draw.split < first.split + counts.emitter; ++draw.split) {
      const Vec2 pick = draw.light(sampler);
      emitters += emitters_by_light(world, point, counts, pick, draw.emitter(sampler));
    }
    sum += emitters / static_cast<double>(counts.emitter);
  }
  if (!world.scene.lights.empty()) sum += punctual_by_light(world, point, first.emitter(sampler).y);
  return sum;
}

/// A constant sky seen along a cosine-distributed direction: irradiance estimate pi L.
RgbD sky_by_direction(const World& world, const Vec3& direction) {
  if (world.is_sky_black || world.is_sky_sampled) return RgbD(0.0);
  return RgbD(light::radiance(world.environment, direction)) * kPi;
}

RgbD emitter_by_direction(const World& world, const trace::SurfacePoint& point, const Meeting& meeting,
                          const Counts& counts, const Vec3& direction, double pdf) {
  if (is_black(meeting.emission)) return RgbD(0.0);
  const double by_light = emitter_pdf(world, receiver_at(point), meeting, direction);
  return RgbD(meeting.emission) * (kPi * power_heuristic(counts.direction * pdf, counts.emitter * by_light));
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

/// What one path carries from vertex to vertex.
struct Walk {
  trace::SurfacePoint point;
  Rgb throughput{1.0F};
  int bounce = 0;
  Counts counts;
  Draw draw;
};

/// Follows one direction from the walk's vertex to the next. False where the path ends.
bool step(const World& world, int max_bounces, double share, Sampler& sampler, BounceTerms& terms,
          Walk& walk) {
  // 1. A direction in proportion to the cosine; below the surface nothing arrives.
  const Vec3 direction = sample_cosine_hemisphere(walk.point.shading_normal, walk.draw.direction(sampler));
  const double cosine = received_cosine(walk.point, direction);
  if (!(cosine > 0.0)) return false;
  const trace::Ray ray{trace::ray_origin(walk.point, direction), direction};
  const RgbD weight = RgbD(walk.throughput) * share;

  // 2. On the last bounce only an emitter could still matter. Without any, whether the sky is seen is enough; and a sky that is
  // sampled as a light has been counted.
  const bool is_last = walk.bounce == max_bounces;
  if (is_last && world.emitters.is_empty()) {
    if (!world.is_sky_sampled && !world.is_sky_black && !world.caster.is_occluded(ray))
      add(terms, walk.bounce, weight * sky_by_direction(world, direction));
    return false;
  }

  // 3. Light met by that direction.
  const std::optional<Meeting> meeting = meet(world, ray);
  if (!meeting) {
    add(terms, walk.bounce, weight * sky_by_direction(world, direction));
    return false;
  }
  add(terms, walk.bounce,
      weight * emitter_by_direction(world, walk.point, *meeting, walk.counts, direction, cosine * kInvPi));
  if (is_last) return false;

  // 4. On to the next vertex: (albedo / pi) E cos / pdf = albedo E, then Russian roulette.
  walk.throughput *= meeting->albedo;
  const float probability = survival(walk.throughput, walk.bounce);
  if (!(sampler.independent_1d() < probability)) return false;
  walk.throughput /= probability;
  walk.point = meeting->point;
  return true;
}

}  // namespace

void add_irradiance(const World& world, const trace::SurfacePoint& start, int max_bounces, Sampler& sampler,
                    BounceTerms& terms) {
  const PathDraws draws = make_draws(sampler);
  const Counts counts{kSkySplits, kEmitterSplits, kDirectionSplits};
  add(terms, 0, direct_by_light(world, start, counts, &draws[0], 0, 1, sampler));
  const double share = 1.0 / counts.direction;
  for (std::uint32_t s = 0; s < counts.direction; ++s) {
    Walk walk{start, Rgb(1.0F), 0, counts, {&draws[0], s, counts.direction}};
    while (step(world, max_bounces, share, sampler, terms, walk)) {
      ++walk.bounce;
      const auto depth = static_cast<std::size_t>(walk.bounce);
      walk.draw.draws = depth < draws.size() ? &draws[depth] : nullptr;
      walk.counts = {};
      add(terms, walk.bounce,
          RgbD(walk.throughput) * share *
              direct_by_light(world, walk.point, walk.counts, walk.draw.draws, s, counts.direction, sampler));
    }
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
