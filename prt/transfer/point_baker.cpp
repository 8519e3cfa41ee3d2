#include "prt/transfer/point_baker.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "prt/sh/basis.hpp"
#include "prt/sh/zonal.hpp"
#include "prt/transfer/bake.hpp"

namespace plumbline::transfer {
namespace {

// Bounces that every walk is allowed before roulette may end it, so that the strong ones keep their low noise.
constexpr int kSafeBounces = 1;
// A walk between white surfaces ends too.
constexpr float kLargestSurvival = 0.95F;
constexpr int kWhiteBounces = 16;  // before that, nothing but its albedos ends a walk

// Choices of walks are other numbers than the shifts of sets.
constexpr std::uint64_t kWalkSeed = 0xA0761D6478BD642FULL;

trace::DirectionArrays arrays(const Bundle& bundle) {
  return {bundle.x.data(), bundle.y.data(), bundle.z.data(), bundle.count};
}

/// Russian roulette: survivors carry what the others leave. The chance is the throughput's own size, so that all survivors
/// weigh about the same.
bool survives(Rgb& throughput, int bounce, RandomNumbers& numbers) {
  if (bounce <= kSafeBounces) return true;
  float chance = max_component(throughput);
  if (bounce > kWhiteBounces) chance = std::min(chance, kLargestSurvival);
  if (chance >= 1.0F) return true;
  if (!(numbers.next() < static_cast<double>(chance))) return false;
  throughput /= chance;
  return true;
}

}  // namespace

PointBaker::PointBaker(const PointWork& work)
    : work_(work),
      size_(static_cast<std::size_t>(work.channels * sh::coefficient_count(work.basis->bands()))),
      width_(size_ * static_cast<std::size_t>(1 + work.kept_terms)),
      bundle_(DirectionSampler::kMostTogether, work.channels),
      escaped_(DirectionSampler::kMostTogether, work.channels),
      joint_(DirectionSampler::kMostTogether, work.channels),
      basis_sums_(*work.basis, work.channels),
      exact_basis_(work.basis->bands()),
      exact_(static_cast<std::size_t>(exact_basis_.coefficient_count())),
      is_hit_(bundle_.capacity),
      hits_(work.surfaces != nullptr ? bundle_.capacity : 0),
      totals_(static_cast<std::size_t>(work.sets) * width_),
      sums_(width_) {
  walks_.reserve(hits_.size());
}

PointResult PointBaker::run(const trace::SurfacePoint& point, std::uint64_t stream, Above above) {
  if (above == Above::nothing_flat) return closed_form(point);
  std::fill(totals_.begin(), totals_.end(), 0.0);
  PointResult result;
  std::size_t count = 0;
  // Rounds of 1, 1, 2, 4, … times the first: every one doubles what there is, by a larger and so better spread set.
  for (std::uint32_t round = 0;; ++round) {
    sampler_ = &(*work_.samplers)[round == 0 ? 0 : round - 1];
    if (work_.surfaces == nullptr || above == Above::nothing) {
      add_visible_sets(point, stream, round, above);
    } else {
      for (std::uint32_t set = 0; set < static_cast<std::uint32_t>(work_.sets); ++set)
        add_walk_set(point, stream, set, round);
    }
    count += sampler_->set_size();
    if (work_.allowed_error == 0.0) break;
    result.is_on_target = is_on_target(static_cast<double>(count));
    if (result.is_on_target || round == work_.samplers->size()) break;
  }
  result.samples = static_cast<std::int64_t>(count) * work_.sets;
  result.statistics = statistics_of(totals_, width_, static_cast<double>(count),
                                    work_.allowed_error == 0.0 ? Half::all : Half::odd);
  if (above == Above::nothing) take_from_closed_form(point, result.statistics);
  return result;
}

/// Nothing is above the plane, and the cosine is about its normal. Nothing bounces.
PointResult PointBaker::closed_form(const trace::SurfacePoint& point) {
  PointResult result{{std::vector<double>(width_, 0.0), std::vector<double>(width_, 0.0)}, 0, true};
  take_from_closed_form(point, result.statistics);
  return result;
}

/// Nothing is above the plane: what was summed is what the surface itself blocks of an unshadowed vector, T_lm = A_l y_lm / pi.
void PointBaker::take_from_closed_form(const trace::SurfacePoint& point, SetStatistics& statistics) {
  const int bands = exact_basis_.bands();
  const Vec3d normal = glm::normalize(Vec3d(point.shading_normal));
  exact_basis_.evaluate(normal.x, normal.y, normal.z, exact_);
  const std::size_t filled = work_.kept_terms > 0 ? 2 * size_ : size_;  // the total and term 0
  for (std::size_t first = 0; first < filled; first += exact_.size()) {
    for (int l = 0; l < bands; ++l) {
      const double factor = sh::clamped_cosine_factor(l) / kPi;
      for (int i = sh::index(l, -l); i <= sh::index(l, l); ++i) {
        const auto at = static_cast<std::size_t>(i);
        statistics.mean[first + at] = factor * exact_[at] - statistics.mean[first + at];
      }
    }
  }
}

void PointBaker::add_walk_set(const trace::SurfacePoint& point, std::uint64_t stream, std::uint32_t set,
                              std::uint32_t round) {
  const std::size_t count = sampler_->set_size();
  std::fill(sums_.begin(), sums_.end(), 0.0);
  RandomNumbers numbers(work_.seed ^ kWalkSeed, work_.directions == DirectionSets::shared ? 0 : stream,
                        set + round * DirectionSampler::kSetsARound);
  for (std::size_t first = 0; first < count; first += DirectionSampler::kMostTogether) {
    sampler_->draw(point,
                   {stream, set, first, std::min(DirectionSampler::kMostTogether, count - first), round},
                   bundle_);
    add_walks(point, numbers);
  }
  for (std::size_t i = size_; i < width_; ++i) sums_[i % size_] += sums_[i];
  double* const total = totals_.data() + set * width_;
  for (std::size_t i = 0; i < width_; ++i) total[i] += sums_[i];
}

/// By the even sets alone: the odd ones state the error (BakeSettings::target_error).
bool PointBaker::is_on_target(double count) const {
  const std::size_t vector = size_ / static_cast<std::size_t>(work_.channels);
  for (std::size_t channel = 0; channel < size_; channel += vector) {
    double squares = 0.0;
    for (std::size_t i = channel; i < channel + vector; ++i) {
      const double error = standard_error(totals_, width_, i, Half::even) / count;
      squares += error * error;
    }
    if (!(std::sqrt(squares) <= work_.allowed_error)) return false;
  }
  return true;
}

void PointBaker::add_visible_sets(const trace::SurfacePoint& point, std::uint64_t stream, std::uint32_t round,
                                  Above above) {
  const std::size_t count = sampler_->set_size();
  joint_.count = 0;
  pieces_.clear();
  for (std::uint32_t set = 0; set < static_cast<std::uint32_t>(work_.sets); ++set) {
    for (std::size_t first = 0; first < count; first += DirectionSampler::kMostTogether) {
      const std::size_t most = std::min(DirectionSampler::kMostTogether, count - first);
      if (joint_.count + most > joint_.capacity) trace_pieces(point);  // before the bundle is filled anew
      if (above == Above::nothing) {
        sampler_->draw(point, {stream, set, first, most, round}, bundle_, DirectionSampler::Side::blocked);
        add_visible(set);
        continue;
      }
      sampler_->draw(point, {stream, set, first, most, round}, bundle_);
      append(bundle_, joint_);
      pieces_.push_back({set, joint_.count});
    }
  }
  trace_pieces(point);
}

/// Traces what has come together; what escapes goes back to the bundle, set by set. No branch depends on a ray.
void PointBaker::trace_pieces(const trace::SurfacePoint& point) {
  const Vec3 origin = point.position + point.clearance * point.geometric_normal;
  work_.caster->occluded_from(origin, arrays(joint_), is_hit_.data());
  std::size_t k = 0;
  for (const Piece& piece : pieces_) {
    std::size_t kept = 0;
    for (; k < piece.end; ++k) {
      bundle_.x[kept] = joint_.x[k];
      bundle_.y[kept] = joint_.y[k];
      bundle_.z[kept] = joint_.z[k];
      for (int c = 0; c < work_.channels; ++c) bundle_.weight(c)[kept] = joint_.weight(c)[k];
      kept += is_hit_[k] == 0 ? 1 : 0;
    }
    bundle_.count = kept;
    add_visible(piece.set);
  }
  joint_.count = 0;
  pieces_.clear();
}

/// The bundle escapes: it is all there is of the total, and of term 0.
void PointBaker::add_visible(std::uint32_t set) {
  double* const total = totals_.data() + set * width_;
  if (work_.kept_terms == 0) return basis_sums_.add(bundle_, {total, size_});
  std::fill(sums_.begin(), sums_.end(), 0.0);
  basis_sums_.add(bundle_, {sums_.data(), size_});
  for (std::size_t i = 0; i < size_; ++i) {
    total[i] += sums_[i];
    total[size_ + i] += sums_[i];
  }
}

void PointBaker::add_walks(const trace::SurfacePoint& point, RandomNumbers& numbers) {
  const Vec3 origin = point.position + point.clearance * point.geometric_normal;
  work_.caster->closest_from(origin, arrays(bundle_), hits_.data());
  walks_.clear();
  for (std::size_t k = 0; k < bundle_.count; ++k) {
    const Vec3 direction(bundle_.x[k], bundle_.y[k], bundle_.z[k]);
    const Rgb weight(bundle_.weight(0)[k]);
    if (hits_[k].triangle == trace::kNoSurface) {
      keep_escaped(direction, weight);
    } else {
      walks_.push_back({hits_[k], direction, weight});
    }
  }
  add_escaped(0);
  for (int bounce = 1; bounce <= work_.max_bounces && !walks_.empty(); ++bounce) {
    walk_on(bounce, numbers);
    add_escaped(bounce);
  }
  if (escaped_.count > 0) basis_sums_.add(escaped_, {sums_.data(), size_});
  escaped_.count = 0;
}

/// One more bounce of all walks.
void PointBaker::walk_on(int bounce, RandomNumbers& numbers) {
  std::size_t alive = 0;
  for (Walk walk : walks_) {
    trace::Ray ray;
    if (!reflect(walk, bounce, numbers, ray)) continue;
    walk.direction = ray.direction;
    if (const auto hit = work_.caster->closest_hit(ray)) {
      walk.hit = *hit;
      walks_[alive++] = walk;
    } else {
      keep_escaped(ray.direction, walk.throughput);
    }
  }
  walks_.resize(alive);
}

bool PointBaker::reflect(Walk& walk, int bounce, RandomNumbers& numbers, trace::Ray& next) const {
  const trace::SurfaceHit seen = work_.surfaces->hit(walk.hit, walk.direction);
  if (!seen.is_front && !work_.surfaces->surface(walk.hit.triangle).is_double_sided) return false;
  walk.throughput *= work_.surfaces->albedo(walk.hit);
  if (is_black(walk.throughput) || !survives(walk.throughput, bounce, numbers)) return false;
  const double x = numbers.next();
  const Vec3 direction(cosine_direction(Vec3d(seen.point.shading_normal), {x, numbers.next()}));
  if (!(glm::dot(direction, seen.point.geometric_normal) > 0.0F)) return false;  // the surface is in the way
  next = {trace::ray_origin(seen.point, direction), direction};
  return true;
}

void PointBaker::keep_escaped(const Vec3& direction, const Rgb& throughput) {
  const std::size_t k = escaped_.count++;
  escaped_.x[k] = direction.x;
  escaped_.y[k] = direction.y;
  escaped_.z[k] = direction.z;
  for (int c = 0; c < work_.channels; ++c) escaped_.weight(c)[k] = throughput[c];
}

/// What escaped after a bounce goes to its term, where that is kept; else it waits: a direction drawn escapes once at most.
void PointBaker::add_escaped(int bounce) {
  if (bounce >= work_.kept_terms || escaped_.count == 0) return;
  basis_sums_.add(escaped_, {sums_.data() + size_ * static_cast<std::size_t>(1 + bounce), size_});
  escaped_.count = 0;
}

}  // namespace plumbline::transfer
