#include "reference/light/environment_sampler.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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

// How far the middle of a cell may be from its corners: the diagonal of the largest cell, on the equator of a lat-long grid
// and in the middle of a cube's face.
double cell_radius(const LatLongDensity& density) {
  return kPi * std::hypot(0.5 / density.table().rows(), 1.0 / density.table().columns());
}
double cell_radius(const BilinearLatLongDensity& density) {
  return kPi * std::hypot(0.5 / (density.table().rows() - 1), 1.0 / density.table().columns());
}
double cell_radius(const CubeDensity& density) {
  return std::sqrt(2.0) / density.table().columns();
}

// The texel of a cell that a direction was drawn in, of images looked up by nearest texel: its own radiance counts, even where
// rounding has carried the direction over the border. None for others.
const Rgb* texel_of(const Environment& environment, const TexelTable::Pick& cell) {
  if (environment.lookup != Lookup::nearest) return nullptr;
  if (const auto* sky = std::get_if<LatLongSky>(&environment.sky))
    return &sky->image.at(cell.column, cell.row);
  if (const auto* sky = std::get_if<CubeMapSky>(&environment.sky)) {
    const int side = sky->faces[0].width;
    return &sky->faces.at(static_cast<std::size_t>(cell.row / side)).at(cell.column, cell.row % side);
  }
  return nullptr;
}

}  // namespace

EnvironmentSampler::EnvironmentSampler(const Environment& environment)
    : environment_(&environment), to_world_(environment.rotation) {
  SkyPart sky = make_sky_density(environment.sky, environment.lookup, environment.name);
  sky_ = std::move(sky.density);
  sky_power_ = sky.power;
  add_blocks();
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
    if (power > 0.0) cones_.push_back({&sun, power, 1.0 / omega, power});
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
  return Vec3(to_world_ * local_direction);
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
  const auto result = sample_towards(to_world(glm::normalize(sample_of(sky_, x, y))));
  return result ? result : sample_towards(to_world(glm::normalize(centre_of(sky_, x, y))));
}

std::optional<DirectionSample> EnvironmentSampler::sample_cones(double x, double y) const {
  std::size_t chosen = 0;
  while (chosen + 1 < cones_.size() && x >= cones_[chosen].probability) {
    x -= cones_[chosen].probability;
    ++chosen;
  }
  return sample_towards(inside_cone(cones_[chosen], x / cones_[chosen].probability, y));
}

void EnvironmentSampler::add_blocks() {
  std::visit(
      [&](const auto& density) {
        if constexpr (requires { density.table(); }) {
          const auto centre = [&](int row, int column) {
            return glm::normalize(density.place({row, column, 0.5, 0.5}).direction);
          };
          blocks_ = SkyBlocks(density.table(), centre, cell_radius(density));
        }
      },
      sky_);
}

// Power times the mean clamped cosine of the cone's axis, smoothed over its half angle as the nodes of SkyBlocks are.
double EnvironmentSampler::cone_weight(const Cone& cone, const Vec3d& local_normal) const {
  const double half_angle = cone.sun->half_angle_rad;
  const double reach = half_angle < 0.5 * kPi ? std::sin(half_angle) : 1.0;
  const double cosine = glm::dot(local_normal, Vec3d(cone.sun->direction));
  if (cosine < -reach - kUnitTolerance && half_angle < 0.5 * kPi) return 0.0;
  const double cut = (cosine + reach) * (cosine + reach) / (4.0 * reach);
  return cone.power * std::max(cosine >= reach ? cosine : cut, 0.05);
}

EnvironmentSampler::Lobe EnvironmentSampler::lobe(const Vec3& normal) const {
  Lobe result;
  result.normal = normal;
  const Vec3 local = to_environment_frame(*environment_, normal);
  double sky_total = 0.0;
  if (std::holds_alternative<UniformDensity>(sky_)) {
    sky_total = 0.25 * sky_power_;  // the cosine's mean over the sphere
  } else if (!std::holds_alternative<NoDensity>(sky_)) {
    result.sky = blocks_.lobe(local);
    sky_total = static_cast<double>(result.sky.total) * sky_power_;
  }
  for (const Cone& cone : cones_) result.cone_total += cone_weight(cone, Vec3d(local));
  if (!(sky_total > 0.0 && result.cone_total > 0.0)) {
    result.sky_probability = sky_total > 0.0 ? 1.0 : 0.0;
  } else {
    result.sky_probability =
        std::clamp(sky_total / (sky_total + result.cone_total), kLeastShare, 1.0 - kLeastShare);
  }
  return result;
}

// The sky's samples go through the stages side by side; those of a sun are left alone (x < 0).
template <class Density>
void EnvironmentSampler::sample_sky(const Density& density, const Lobe& lobe,
                                    std::span<const glm::dvec2> numbers,
                                    std::span<LobeSample> samples) const {
  if constexpr (requires { density.table(); }) {
    std::array<SkyBlocks::Pick, kMostTogether> picks;
    for (std::size_t i = 0; i < numbers.size(); ++i)
      picks[i] =
          numbers[i].x < 0.0 ? SkyBlocks::Pick{} : blocks_.pick_block(lobe.sky, numbers[i].x, numbers[i].y);
    for (std::size_t i = 0; i < numbers.size(); ++i) blocks_.pick_row(density.table(), picks[i]);
    for (std::size_t i = 0; i < numbers.size(); ++i) blocks_.pick_column(density.table(), picks[i]);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (!(picks[i].probability > 0.0)) continue;
      const PlacedDirection placed = density.place(picks[i].cell);
      const Vec3 direction = to_world(placed.direction);
      const Rgb* texel = texel_of(*environment_, picks[i].cell);
      samples[i] = {direction, lobe.sky_probability * picks[i].probability * placed.density, texel,
                    texel != nullptr ? Rgb(0.0F) : sky_radiance(*environment_, direction)};
      if (texel != nullptr) __builtin_prefetch(texel);
    }
  } else {
    // The same from everywhere: by the cosine alone (cos^2 uniform).
    const Vec3d local_normal(to_environment_frame(*environment_, lobe.normal));
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const double cosine = std::sqrt(1.0 - std::max(numbers[i].x, 0.0));
      if (numbers[i].x < 0.0 || !(cosine > 0.0)) continue;
      const Vec3 direction = to_world(around(local_normal, std::sqrt(2.0 - 2.0 * cosine), numbers[i].y));
      samples[i] = {direction, lobe.sky_probability * cosine / kPi, nullptr,
                    sky_radiance(*environment_, direction)};
    }
  }
}

LobeSample EnvironmentSampler::sample_cones(const Lobe& lobe, double x, double y) const {
  const Vec3d local_normal(to_environment_frame(*environment_, lobe.normal));
  double target = x * lobe.cone_total;
  for (std::size_t k = 0; k < cones_.size(); ++k) {
    const double weight = cone_weight(cones_[k], local_normal);
    if (!(weight > 0.0)) continue;
    if (target >= weight && k + 1 < cones_.size()) {
      target -= weight;
      continue;
    }
    const double probability = (1.0 - lobe.sky_probability) * weight / lobe.cone_total;
    return {inside_cone(cones_[k], std::min(target / weight, 1.0), y), probability * cones_[k].density,
            &cones_[k].sun->radiance};
  }
  return {};
}

void EnvironmentSampler::sample(const Lobe& lobe, std::span<const Vec2> points,
                                std::span<LobeSample> samples) const {
  std::array<glm::dvec2, kMostTogether> numbers;
  bool has_sky = false;
  for (std::size_t i = 0; i < points.size(); ++i) {
    samples[i] = {};
    glm::dvec2& number = numbers[i] = with_low_bits(points[i]);
    if (number.x < lobe.sky_probability) {
      number.x /= lobe.sky_probability;
      has_sky = true;
      continue;
    }
    if (lobe.cone_total > 0.0) {
      samples[i] =
          sample_cones(lobe, (number.x - lobe.sky_probability) / (1.0 - lobe.sky_probability), number.y);
    }
    number.x = -1.0;
  }
  if (!has_sky) return;
  const auto drawn = std::span(numbers).first(points.size());
  std::visit([&](const auto& density) { sample_sky(density, lobe, drawn, samples); }, sky_);
}

std::optional<DirectionSample> EnvironmentSampler::sample(const Lobe& lobe, Vec2 u) const {
  LobeSample result;
  sample(lobe, std::span(&u, 1), std::span(&result, 1));
  if (!(result.pdf > 0.0)) return std::nullopt;
  return DirectionSample{result.direction, result.pdf, result.radiance()};
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
