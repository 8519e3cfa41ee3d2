#include "prt/transfer/direction_sampler.hpp"

#include <algorithm>
#include <cmath>

#include "prt/transfer/directions.hpp"
#include "prt/transfer/kernels.hpp"

namespace plumbline::transfer {
namespace {

// 48 MiB.
constexpr std::size_t kMostKept = std::size_t{1} << 22U;

/// Keeps the directions on one side of the geometric plane, in their order.
void keep_side(const trace::SurfacePoint& point, bool is_leaving, std::size_t count, Bundle& bundle) {
  const Vec3 g = point.geometric_normal;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const float x = bundle.x[k];
    const float y = bundle.y[k];
    const float z = bundle.z[k];
    bundle.x[kept] = x;
    bundle.y[kept] = y;
    bundle.z[kept] = z;
    kept += (x * g.x + y * g.y + z * g.z > 0.0F) == is_leaving ? 1 : 0;
  }
  bundle.count = kept;
}

void set_weights(Bundle& bundle, float weight) {
  for (int c = 0; c < bundle.channels; ++c) std::fill_n(bundle.weight(c), bundle.count, weight);
}

}  // namespace

DirectionSampler::DirectionSampler(Sampling sampling, DirectionSets sets, std::uint64_t seed,
                                   std::size_t set_size, std::uint32_t kept_sets)
    : sampling_(sampling), sets_(sets), seed_(seed), set_size_(set_size) {
  if (sampling != Sampling::qmc) {
    columns_ = static_cast<std::size_t>(std::sqrt(static_cast<double>(set_size)));
    set_size_ = set_size / columns_ * columns_;
    if (sampling == Sampling::uniform && sets == DirectionSets::shared) keep_sphere(kept_sets);
    return;
  }
  const std::size_t points = std::min(set_size, kMostTogether) + sh::kBlockDirections - 1;
  const std::size_t table = points / sh::kBlockDirections * sh::kBlockDirections;
  cosine_.resize(table);
  sine_.resize(table);
  height_.resize(table);
  for (std::size_t i = 0; i < table; ++i) {
    const double azimuth = 2.0 * kPi * kGoldenTurn * static_cast<double>(i);
    cosine_[i] = static_cast<float>(std::cos(azimuth));
    sine_[i] = static_cast<float>(std::sin(azimuth));
    height_[i] = static_cast<float>(static_cast<double>(i) / static_cast<double>(set_size));
  }
}

void DirectionSampler::draw(const trace::SurfacePoint& point, const Place& place, Bundle& bundle,
                            Side side) const {
  Place mine = place;
  if (sets_ == DirectionSets::shared) mine.stream = 0;
  mine.randomisation += mine.round * kSetsARound;
  switch (sampling_) {
    case Sampling::qmc:
      return draw_lattice(point, mine, side, bundle);
    case Sampling::cosine:
      return draw_cosine_grid(point, mine, side, bundle);
    case Sampling::uniform:
      return draw_uniform_grid(point, mine, side, bundle);
  }
}

// What the surface blocks is closer to the shading plane than the normals' angle d: 1 - u.y = |2 (i + shift.y)/n - 1| is at most
// sin^2 d. Those are a few points in the middle of the lattice; one more at both ends makes up for rounding.
DirectionSampler::Place DirectionSampler::blocked_part(const trace::SurfacePoint& point, const Place& place,
                                                       double shift) const {
  const auto cosine = static_cast<double>(glm::dot(point.shading_normal, point.geometric_normal));
  const double share = cosine > 0.0 ? std::max(0.0, 1.0 - cosine * cosine) + 1e-6 : 1.0;
  const auto n = static_cast<double>(set_size_);
  const double low = std::floor(0.5 * n * (1.0 - share) - shift) - 1.0;
  const double high = std::ceil(0.5 * n * (1.0 + share) - shift) + 2.0;
  Place part = place;
  part.first = std::max(place.first, static_cast<std::size_t>(std::max(0.0, low)));
  const std::size_t end = std::min(place.first + place.count, static_cast<std::size_t>(std::max(0.0, high)));
  part.count = end > part.first ? end - part.first : 0;
  return part;
}

// Azimuths and steps from point `first` on are those from 0 on, turned and moved.
void DirectionSampler::draw_lattice(const trace::SurfacePoint& point, const Place& all, Side side,
                                    Bundle& bundle) const {
  const glm::dvec2 shift = random_shift(seed_, all.stream, all.randomisation);
  const Place place = side == Side::blocked ? blocked_part(point, all, shift.y) : all;
  bundle.count = 0;
  if (place.count == 0) return;
  const double azimuth = 2.0 * kPi * (shift.x + static_cast<double>(place.first) * kGoldenTurn);
  const auto [tangent, bitangent] = tangents(Vec3d(point.shading_normal));
  LatticeFrame frame{};
  for (int i = 0; i < 3; ++i) {
    frame.tangent[i] = static_cast<float>(tangent[i]);
    frame.bitangent[i] = static_cast<float>(bitangent[i]);
    frame.normal[i] = point.shading_normal[i];
  }
  frame.start_cosine = static_cast<float>(std::cos(azimuth));
  frame.start_sine = static_cast<float>(std::sin(azimuth));
  frame.start_height =
      static_cast<float>((static_cast<double>(place.first) + shift.y) / static_cast<double>(set_size_));
  const std::size_t whole =
      (place.count + sh::kBlockDirections - 1) / sh::kBlockDirections * sh::kBlockDirections;
  lattice_directions(frame, cosine_.data(), sine_.data(), height_.data(), whole, bundle.x.data(),
                     bundle.y.data(), bundle.z.data());
  keep_side(point, side == Side::leaving, place.count, bundle);
  set_weights(bundle, 1.0F);
}

/// One direction of a grid on the sphere.
Vec3 DirectionSampler::on_sphere(std::size_t cell, std::uint64_t stream, std::uint32_t randomisation) const {
  const glm::dvec2 jitter = random_shift(cell_seed(seed_, cell), stream, randomisation);
  const glm::dvec2 u(
      (static_cast<double>(cell % columns_) + jitter.x) / static_cast<double>(columns_),
      (static_cast<double>(cell / columns_) + jitter.y) / static_cast<double>(set_size_ / columns_));
  return Vec3(sphere_direction(u));
}

/// Where all vertices share the sets, they are drawn once.
void DirectionSampler::keep_sphere(std::uint32_t sets) {
  if (sets * set_size_ > kMostKept) return;
  for (std::uint32_t set = 0; set < sets; ++set) {
    for (std::size_t cell = 0; cell < set_size_; ++cell) sphere_.push_back(on_sphere(cell, 0, set));
  }
}

void DirectionSampler::draw_cosine_grid(const trace::SurfacePoint& point, const Place& place, Side side,
                                        Bundle& bundle) const {
  const Vec3d normal(point.shading_normal);
  const std::size_t rows = set_size_ / columns_;
  for (std::size_t k = 0; k < place.count; ++k) {
    const std::size_t cell = place.first + k;
    const glm::dvec2 jitter = random_shift(cell_seed(seed_, cell), place.stream, place.randomisation);
    const glm::dvec2 u((static_cast<double>(cell % columns_) + jitter.x) / static_cast<double>(columns_),
                       (static_cast<double>(cell / columns_) + jitter.y) / static_cast<double>(rows));
    const Vec3 direction(cosine_direction(normal, u));
    bundle.x[k] = direction.x;
    bundle.y[k] = direction.y;
    bundle.z[k] = direction.z;
  }
  keep_side(point, side == Side::leaving, place.count, bundle);
  set_weights(bundle, 1.0F);
}

// (1/pi) integral = (1/pi) (4 pi / N) sum: the weight is 4 max(0, n.w).
void DirectionSampler::draw_uniform_grid(const trace::SurfacePoint& point, const Place& place, Side side,
                                         Bundle& bundle) const {
  std::size_t kept = 0;
  const std::size_t start = place.randomisation * set_size_ + place.first;
  const bool is_kept = start + place.count <= sphere_.size();
  for (std::size_t k = 0; k < place.count; ++k) {
    const Vec3 direction =
        is_kept ? sphere_[start + k] : on_sphere(place.first + k, place.stream, place.randomisation);
    const float cosine = glm::dot(direction, point.shading_normal);
    const bool is_leaving = glm::dot(direction, point.geometric_normal) > 0.0F;
    if (!(cosine > 0.0F) || is_leaving != (side == Side::leaving)) continue;
    bundle.x[kept] = direction.x;
    bundle.y[kept] = direction.y;
    bundle.z[kept] = direction.z;
    for (int c = 0; c < bundle.channels; ++c) bundle.weight(c)[kept] = 4.0F * cosine;
    ++kept;
  }
  bundle.count = kept;
}

}  // namespace plumbline::transfer
