#include "reference/light/environment_sampler.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <variant>

#include "reference/base/error.hpp"
#include "reference/light/environment_lookup.hpp"

namespace plumbline::light {
namespace {

// Where there are both a sky and suns, each gets at least this share. In proportion to power alone the sky
// beside a bright sun would get one sample in 10^5, and every point in shadow would be noise.
constexpr double kLeastShare = 0.1;
constexpr double kUnitTolerance = 1e-5;

// A float random number has 24 bits: too few to choose one of 2^25 texels, or to place a sample inside a
// texel of low probability. The missing low bits are filled with a hash of both numbers (the finaliser of
// SplitMix64): the same numbers give the same sample, and what was a lattice becomes uniform.
std::uint64_t scrambled(std::uint64_t bits) {
  bits = (bits ^ (bits >> 30U)) * 0xBF58476D1CE4E5B9U;
  bits = (bits ^ (bits >> 27U)) * 0x94D049BB133111EBU;
  return bits ^ (bits >> 31U);
}

double with_low_bits(float number, std::uint64_t low_28_bits) {
  constexpr double kLast = 0x1p24 - 1.0;
  const double scaled =
      number > 0.0F ? std::min(std::floor(static_cast<double>(number) * 0x1p24), kLast) : 0.0;
  return (scaled + static_cast<double>(low_28_bits) * 0x1p-28) * 0x1p-24;
}

glm::dvec2 with_low_bits(const Vec2& u) {
  constexpr std::uint64_t kMask = (1U << 28U) - 1U;
  const std::uint64_t both = (static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(u.x)) << 32U) |
                             std::bit_cast<std::uint32_t>(u.y);
  const std::uint64_t hash = scrambled(both + 0x9E3779B97F4A7C15U);
  return {with_low_bits(u.x, hash & kMask), with_low_bits(u.y, hash >> 36U)};
}

void require_usable(const SunDisc& sun, const std::string& name) {
  if (!is_finite(sun.radiance)) {
    throw InputError(fmt::format("{}: the radiance ({}, {}, {}) of a sun is not finite", name, sun.radiance.x,
                                 sun.radiance.y, sun.radiance.z));
  }
  const double length = glm::length(Vec3d(sun.direction));
  if (!(std::abs(length - 1.0) <= kUnitTolerance)) {
    throw InputError(fmt::format("{}: the direction of a sun has length {}, expected 1", name, length));
  }
  if (!(sun.half_angle_rad > 0.0 && sun.half_angle_rad <= kPi)) {
    throw InputError(
        fmt::format("{}: the half angle of a sun is {}, expected in (0, pi]", name, sun.half_angle_rad));
  }
}

double pdf_of(const SkyDensity& density, const Vec3& local_direction) {
  return std::visit([&](const auto& kind) { return kind.pdf(local_direction); }, density);
}
Vec3d sample_of(const SkyDensity& density, double x, double y) {
  return std::visit([&](const auto& kind) { return kind.sample(x, y); }, density);
}
Vec3d centre_of(const SkyDensity& density, double x, double y) {
  return std::visit([&](const auto& kind) { return kind.centre(x, y); }, density);
}

// A direction whose chord to the axis has this length: 1 - cos a = chord^2 / 2, sin a = chord sqrt(1 -
// chord^2 / 4).
Vec3d around(const Vec3d& axis, double chord, double turns) {
  const Vec3d other = std::abs(axis.y) < 0.9 ? Vec3d(0.0, 1.0, 0.0) : Vec3d(1.0, 0.0, 0.0);
  const Vec3d across = glm::normalize(glm::cross(other, axis));
  const Vec3d along = glm::cross(axis, across);
  const double phi = 2.0 * kPi * turns;
  const double sine = chord * std::sqrt(std::max(0.0, 1.0 - 0.25 * chord * chord));
  return (1.0 - 0.5 * chord * chord) * axis + sine * (std::cos(phi) * across + std::sin(phi) * along);
}

}  // namespace

EnvironmentSampler::EnvironmentSampler(const Environment& environment) : environment_(&environment) {
  SkyPart sky = make_sky_density(environment.sky, environment.lookup, environment.name);
  sky_ = std::move(sky.density);
  add_cones();
  double cone_power = 0.0;
  for (const Cone& cone : cones_) cone_power += cone.probability;
  share(sky.power, cone_power);
}

// Leaves the power of each in its probability.
void EnvironmentSampler::add_cones() {
  for (const SunDisc& sun : environment_->suns) {
    require_usable(sun, environment_->name);
    const double omega = solid_angle(sun);
    const double power = static_cast<double>(max_magnitude(sun.radiance)) * omega;
    if (power > 0.0) cones_.push_back({&sun, power, 1.0 / omega});
  }
}

void EnvironmentSampler::share(double sky_power, double cone_power) {
  const bool has_sky = !std::holds_alternative<NoDensity>(sky_);
  is_black_ = !has_sky && cones_.empty();
  if (is_black_) return;
  if (!has_sky || cones_.empty()) {
    sky_probability_ = has_sky ? 1.0 : 0.0;
  } else {
    sky_probability_ = std::clamp(sky_power / (sky_power + cone_power), kLeastShare, 1.0 - kLeastShare);
  }
  for (Cone& cone : cones_) cone.probability *= (1.0 - sky_probability_) / cone_power;
}

Vec3 EnvironmentSampler::to_world(const Vec3d& local_direction) const {
  return Vec3(glm::normalize(glm::dmat3(environment_->rotation) * local_direction));
}

// Uniform in solid angle: 1 - cos a, and so the square of the chord, is uniform. A direction that rounding
// put outside the disc is drawn in by more than the rounding, at worst onto the axis.
Vec3 EnvironmentSampler::inside_cone(const Cone& cone, double x, double y) const {
  constexpr double kRounding = 5e-7;
  const Vec3d axis = glm::normalize(Vec3d(cone.sun->direction));
  const double chord = 2.0 * std::sin(0.5 * cone.sun->half_angle_rad) * std::sqrt(y);
  const Vec3 direction = to_world(around(axis, chord, x));
  if (contains(*cone.sun, to_environment_frame(*environment_, direction))) return direction;
  return to_world(around(axis, std::max(0.0, chord - kRounding), x));
}

std::optional<DirectionSample> EnvironmentSampler::sample_towards(const Vec3& direction) const {
  const double density = pdf(direction);
  if (!(density > 0.0)) return std::nullopt;
  return DirectionSample{direction, density, radiance(*environment_, direction)};
}

// Turning a direction rounds it to 6e-8, which near a pole of the environment is a large angle of azimuth:
// the direction may leave its texel. That is harmless unless it meets a black one; then the texel's centre is
// given.
std::optional<DirectionSample> EnvironmentSampler::sample_sky(double x, double y) const {
  const auto result = sample_towards(to_world(sample_of(sky_, x, y)));
  return result ? result : sample_towards(to_world(centre_of(sky_, x, y)));
}

std::optional<DirectionSample> EnvironmentSampler::sample_cones(double x, double y) const {
  std::size_t chosen = 0;
  while (chosen + 1 < cones_.size() && x >= cones_[chosen].probability) {
    x -= cones_[chosen].probability;
    ++chosen;
  }
  return sample_towards(inside_cone(cones_[chosen], x / cones_[chosen].probability, y));
}

std::optional<DirectionSample> EnvironmentSampler::sample(Vec2 u) const {
  if (is_black_) return std::nullopt;
  const glm::dvec2 numbers = with_low_bits(u);
  if (numbers.x < sky_probability_) return sample_sky(numbers.x / sky_probability_, numbers.y);
  return sample_cones(numbers.x - sky_probability_, numbers.y);
}

double EnvironmentSampler::pdf(const Vec3& direction) const {
  if (is_black_) return 0.0;
  const Vec3 local = to_environment_frame(*environment_, direction);
  double result = sky_probability_ * pdf_of(sky_, local);
  for (const Cone& cone : cones_) {
    if (contains(*cone.sun, local)) result += cone.probability * cone.density;
  }
  return result;
}

}  // namespace plumbline::light
