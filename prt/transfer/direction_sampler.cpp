#include "prt/transfer/direction_sampler.hpp"

#include <algorithm>
#include <cmath>

#include "prt/transfer/directions.hpp"
#include "prt/transfer/kernels.hpp"

namespace plumbline::transfer {
namespace {

/// Keeps the directions that leave the surface, in their order. Lattice and grids have all weights the same, or in place.
void keep_leaving(const trace::SurfacePoint& point, std::size_t count, Bundle& bundle) {
  const Vec3 g = point.geometric_normal;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const float x = bundle.x[k];
    const float y = bundle.y[k];
    const float z = bundle.z[k];
    bundle.x[kept] = x;
    bundle.y[kept] = y;
    bundle.z[kept] = z;
    kept += x * g.x + y * g.y + z * g.z > 0.0F ? 1 : 0;
  }
  bundle.count = kept;
}

void set_weights(Bundle& bundle, float weight) {
  for (int c = 0; c < bundle.channels; ++c) std::fill_n(bundle.weight(c), bundle.count, weight);
}

}  // namespace

DirectionSampler::DirectionSampler(Sampling sampling, DirectionSets sets, std::uint64_t seed,
                                   std::size_t set_size)
    : sampling_(sampling), sets_(sets), seed_(seed), set_size_(set_size) {
  if (sampling != Sampling::qmc) {
    columns_ = static_cast<std::size_t>(std::sqrt(static_cast<double>(set_size)));
    set_size_ = set_size / columns_ * columns_;
    return;
  }
  const std::size_t points = std::min(set_size, kMostTogether) + sh::kBlockDirections - 1;
  const std::size_t table = points / sh::kBlockDirections * sh::kBlockDirections;
  cosine_.resize(table);
  sine_.resize(table);
  height_.resize(table);
  for (std::size_t i = 0; i < table; ++i) {
    const glm::dvec2 u = shifted_lattice_point(i, glm::dvec2(0.0));
    cosine_[i] = static_cast<float>(std::cos(2.0 * kPi * u.x));
    sine_[i] = static_cast<float>(std::sin(2.0 * kPi * u.x));
    height_[i] = std::min(static_cast<float>(u.y), kBelowOne);
  }
}

void DirectionSampler::draw(const trace::SurfacePoint& point, const Place& place, Bundle& bundle) const {
  Place mine = place;
  if (sets_ == DirectionSets::shared) mine.stream = 0;
  if (sampling_ == Sampling::qmc) {
    mine.first += mine.repeat * set_size_;
  } else {
    mine.randomisation += mine.repeat * kRepeatedSets;
  }
  switch (sampling_) {
    case Sampling::qmc:
      return draw_lattice(point, mine, bundle);
    case Sampling::cosine:
      return draw_cosine_grid(point, mine, bundle);
    case Sampling::uniform:
      return draw_uniform_grid(point, mine, bundle);
  }
}

// Point first + k of a shifted lattice is point k of the same lattice, shifted by point `first` more.
void DirectionSampler::draw_lattice(const trace::SurfacePoint& point, const Place& place,
                                    Bundle& bundle) const {
  const glm::dvec2 start =
      shifted_lattice_point(place.first, random_shift(seed_, place.stream, place.randomisation));
  const auto [tangent, bitangent] = tangents(Vec3d(point.shading_normal));
  LatticeFrame frame{};
  for (int i = 0; i < 3; ++i) {
    frame.tangent[i] = static_cast<float>(tangent[i]);
    frame.bitangent[i] = static_cast<float>(bitangent[i]);
    frame.normal[i] = point.shading_normal[i];
  }
  frame.start_cosine = static_cast<float>(std::cos(2.0 * kPi * start.x));
  frame.start_sine = static_cast<float>(std::sin(2.0 * kPi * start.x));
  frame.start_height = std::min(static_cast<float>(start.y), kBelowOne);
  const std::size_t whole =
      (place.count + sh::kBlockDirections - 1) / sh::kBlockDirections * sh::kBlockDirections;
  lattice_directions(frame, cosine_.data(), sine_.data(), height_.data(), whole, bundle.x.data(),
                     bundle.y.data(), bundle.z.data());
  keep_leaving(point, place.count, bundle);
  set_weights(bundle, 1.0F);
}

void DirectionSampler::draw_cosine_grid(const trace::SurfacePoint& point, const Place& place,
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
  keep_leaving(point, place.count, bundle);
  set_weights(bundle, 1.0F);
}

// (1/pi) integral = (1/pi) (4 pi / N) sum: the weight is 4 max(0, n.w).
void DirectionSampler::draw_uniform_grid(const trace::SurfacePoint& point, const Place& place,
                                         Bundle& bundle) const {
  const std::size_t rows = set_size_ / columns_;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < place.count; ++k) {
    const std::size_t cell = place.first + k;
    const glm::dvec2 jitter = random_shift(cell_seed(seed_, cell), place.stream, place.randomisation);
    const glm::dvec2 u((static_cast<double>(cell % columns_) + jitter.x) / static_cast<double>(columns_),
                       (static_cast<double>(cell / columns_) + jitter.y) / static_cast<double>(rows));
    const Vec3 direction(sphere_direction(u));
    const float cosine = glm::dot(direction, point.shading_normal);
    if (!(cosine > 0.0F) || !(glm::dot(direction, point.geometric_normal) > 0.0F)) continue;
    bundle.x[kept] = direction.x;
    bundle.y[kept] = direction.y;
    bundle.z[kept] = direction.z;
    for (int c = 0; c < bundle.channels; ++c) bundle.weight(c)[kept] = 4.0F * cosine;
    ++kept;
  }
  bundle.count = kept;
}

}  // namespace plumbline::transfer
