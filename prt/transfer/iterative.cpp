#include "prt/transfer/iterative.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "prt/sh/basis.hpp"
#include "prt/transfer/bake.hpp"
#include "prt/transfer/basis_sums.hpp"
#include "prt/transfer/kernels.hpp"
#include "prt/transfer/set_statistics.hpp"
#include "reference/base/error.hpp"
#include "reference/base/parallel.hpp"

namespace plumbline::transfer {
namespace {

constexpr std::size_t kBlock = 64;  // points a task
constexpr std::uint32_t kNoSide = 0xFFFFFFFFU;

/// Sums of this many hits are floats before they become doubles.
constexpr std::size_t kFloatHits = 256;

/// A ray that met something that reflects: 12 bytes, for they are many. Barycentrics in 65535ths move the hit by less than 1e-5 of
/// its triangle.
struct StoredHit {
  std::uint32_t triangle = 0;  // doubled, plus 1 where its back is met
  std::uint16_t b1 = 0;
  std::uint16_t b2 = 0;
  float weight = 0.0F;
};

/// The two sides of vertices. Point v < vertices is the front of vertex v; the backs of vertices that double-sided
/// triangles use follow.
struct Sides {
  std::vector<trace::SurfacePoint> points;
  std::vector<std::uint32_t> back_of;  // by vertex; kNoSide where nothing shines there
};

Sides make_sides(const scene::Scene& scene, const std::vector<trace::SurfacePoint>& vertices) {
  Sides sides{vertices, std::vector<std::uint32_t>(vertices.size(), kNoSide)};
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    if (!scene.materials[scene.triangle_materials[t]].is_double_sided) continue;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t v = scene.triangles[t][k];
      if (sides.back_of[v] != kNoSide) continue;
      sides.back_of[v] = static_cast<std::uint32_t>(sides.points.size());
      trace::SurfacePoint back = vertices[v];
      back.geometric_normal = -back.geometric_normal;
      back.shading_normal = -back.shading_normal;
      sides.points.push_back(back);
    }
  }
  return sides;
}

/// Rows of padded coefficients, [point][channel][row].
using Rows = sh::AlignedVector<float>;

/// Scratch of one task that traces.
struct Tracing {
  Bundle bundle;
  Bundle escaped;
  BasisSums basis_sums;
  std::vector<trace::Hit> hits;
  std::vector<StoredHit> stored;
  std::vector<double> sums;

  Tracing(const sh::BatchBasis<float>& basis, std::size_t count)
      : bundle(DirectionSampler::kMostTogether, 1),
        escaped(DirectionSampler::kMostTogether, 1),
        basis_sums(basis, 1),
        hits(bundle.capacity),
        sums(count) {}
};

/// Scratch of one task that gathers.
struct Gathering {
  std::vector<const float*> corners;
  std::vector<float> weights;
  Rows part;
  std::vector<double> sums;
};

/// All of one set of directions: its own solution.
class SetSolution {
 public:
  SetSolution(const IterativeWork& work, const Sides& sides, const Transfer& shape)
      : work_(work),
        sides_(sides),
        channels_(shape.channels),
        count_(static_cast<std::size_t>(sh::coefficient_count(shape.bands))),
        row_(padded_row(count_)),
        width_(row_ * static_cast<std::size_t>(channels_)),
        hits_(sides.points.size()),
        last_(sides.points.size() * width_),
        next_(last_.size()),
        power_(sides.points.size()),
        next_power_(power_.size()) {}

  /// Traces the set and makes term 0.
  void trace_set(std::uint32_t set);
  /// Term k from term k-1.
  void bounce();

  /// [point][channel][row]
  [[nodiscard]] const Rows& term() const { return last_; }
  [[nodiscard]] std::size_t row() const { return row_; }
  [[nodiscard]] std::size_t width() const { return width_; }
  /// Bound on what any coefficient still gets from all bounces after the term; infinite where it cannot be bounded yet.
  [[nodiscard]] double remainder() const;

 private:
  template <class Body>
  void for_points(const Body& body) const;
  [[nodiscard]] Above above(std::size_t point) const;
  void set_first_term(std::size_t point, const std::vector<double>& values, double scale);
  void trace_point(std::size_t point, std::uint32_t set, Tracing& tracing);
  void gather_point(std::size_t point, Gathering& gathering);
  [[nodiscard]] double add_hit(const StoredHit& hit, Gathering& gathering) const;
  [[nodiscard]] std::uint32_t side_of(const StoredHit& hit, int corner) const;
  [[nodiscard]] std::vector<std::uint8_t> new_backs(const std::vector<std::uint8_t>& is_traced) const;

  const IterativeWork& work_;
  const Sides& sides_;
  int channels_;
  std::size_t count_;
  std::size_t row_;
  std::size_t width_;
  std::vector<std::vector<StoredHit>> hits_;  // by point
  Rows last_;
  Rows next_;
  std::vector<double> power_;  // K^k 1 (remainder())
  std::vector<double> next_power_;
  std::vector<double> norms_;  // of K^1 … K^k
};

/// Calls body(first point, end) for blocks of points on all threads.
template <class Body>
void SetSolution::for_points(const Body& body) const {
  const std::size_t points = sides_.points.size();
  parallel_for((points + kBlock - 1) / kBlock, work_.threads,
               [&](std::size_t block) { body(block * kBlock, std::min(points, (block + 1) * kBlock)); });
}

std::uint32_t SetSolution::side_of(const StoredHit& hit, int corner) const {
  const std::uint32_t vertex = work_.scene->triangles[hit.triangle / 2][corner];
  return hit.triangle % 2 == 0 ? vertex : sides_.back_of[vertex];
}

std::uint16_t fraction16(float value) {
  return static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0F, 1.0F) * 65535.0F));
}

/// Splits a traced bundle into directions that escape and hits that reflect.
void sort_bundle(const trace::SurfaceTable& surfaces, Tracing& tracing) {
  const Bundle& bundle = tracing.bundle;
  Bundle& escaped = tracing.escaped;
  escaped.count = 0;
  for (std::size_t k = 0; k < bundle.count; ++k) {
    const trace::Hit& hit = tracing.hits[k];
    if (hit.triangle == trace::kNoSurface) {
      escaped.x[escaped.count] = bundle.x[k];
      escaped.y[escaped.count] = bundle.y[k];
      escaped.z[escaped.count] = bundle.z[k];
      escaped.weight(0)[escaped.count++] = bundle.weight(0)[k];
      continue;
    }
    const auto& surface = surfaces.surface(hit.triangle);
    if (surface.is_uniform && is_black(surface.albedo)) continue;
    const bool is_front = surfaces.hit(hit, {bundle.x[k], bundle.y[k], bundle.z[k]}).is_front;
    if (!is_front && !surface.is_double_sided) continue;
    tracing.stored.push_back({2 * hit.triangle + (is_front ? 0U : 1U), fraction16(hit.barycentrics.x),
                              fraction16(hit.barycentrics.y), bundle.weight(0)[k]});
  }
}

Above SetSolution::above(std::size_t point) const {
  return point < work_.above->size() ? (*work_.above)[point] : Above::something;
}

void SetSolution::set_first_term(std::size_t point, const std::vector<double>& values, double scale) {
  for (int c = 0; c < channels_; ++c) {
    float* out = last_.data() + point * width_ + static_cast<std::size_t>(c) * row_;
    for (std::size_t i = 0; i < count_; ++i) out[i] = static_cast<float>(values[i] * scale);
  }
}

void SetSolution::trace_point(std::size_t p, std::uint32_t set, Tracing& tracing) {
  const trace::SurfacePoint& point = sides_.points[p];
  if (above(p) == Above::nothing_flat)
    return set_first_term(p, unshadowed_transfer(work_.basis->bands(), point.shading_normal), 1.0);
  const Vec3 origin = point.position + point.clearance * point.geometric_normal;
  const std::size_t size = work_.sampler->set_size();
  tracing.stored.clear();
  std::fill(tracing.sums.begin(), tracing.sums.end(), 0.0);
  for (std::size_t first = 0; first < size; first += DirectionSampler::kMostTogether) {
    work_.sampler->draw(point, {p, set, first, std::min(DirectionSampler::kMostTogether, size - first), 0},
                        tracing.bundle);
    Bundle& bundle = tracing.bundle;
    if (above(p) == Above::nothing) {
      tracing.basis_sums.add(bundle, tracing.sums);
      continue;
    }
    work_.caster->closest_from(origin, {bundle.x.data(), bundle.y.data(), bundle.z.data(), bundle.count},
                               tracing.hits.data());
    sort_bundle(*work_.surfaces, tracing);
    tracing.basis_sums.add(tracing.escaped, tracing.sums);
  }
  hits_[p].assign(tracing.stored.begin(), tracing.stored.end());
  set_first_term(p, tracing.sums, 1.0 / static_cast<double>(size));
}

/// Points that were met and are not traced.
std::vector<std::uint8_t> SetSolution::new_backs(const std::vector<std::uint8_t>& is_traced) const {
  std::vector<std::uint8_t> is_new(is_traced.size(), 0);
  for (const std::vector<StoredHit>& hits : hits_) {
    for (const StoredHit& hit : hits) {
      for (int k = 0; k < 3 && hit.triangle % 2 != 0; ++k) {
        const std::uint32_t side = side_of(hit, k);
        is_new[side] = is_traced[side] == 0 ? 1 : 0;
      }
    }
  }
  return is_new;
}

void SetSolution::trace_set(std::uint32_t set) {
  for (std::vector<StoredHit>& hits : hits_) hits.clear();
  std::fill(last_.begin(), last_.end(), 0.0F);
  std::vector<std::uint8_t> is_due(sides_.points.size(), 0);
  std::fill_n(is_due.begin(), work_.vertices->size(), std::uint8_t{1});
  std::vector<std::uint8_t> is_traced(is_due.size(), 0);
  const auto is_set = [](std::uint8_t flag) { return flag != 0; };
  // Backs that nothing meets need no transfer; those that are met may meet others.
  while (std::any_of(is_due.begin(), is_due.end(), is_set)) {
    for_points([&](std::size_t first, std::size_t end) {
      Tracing tracing(*work_.basis, count_);
      for (std::size_t p = first; p < end; ++p) {
        if (is_due[p] != 0) trace_point(p, set, tracing);
      }
    });
    for (std::size_t p = 0; p < is_due.size(); ++p) is_traced[p] |= is_due[p];
    is_due = sides_.points.size() > work_.vertices->size() ? new_backs(is_traced)
                                                           : std::vector<std::uint8_t>(is_due.size(), 0);
  }
  std::fill(power_.begin(), power_.end(), 1.0);
  norms_.clear();
}

/// Lists the rows that a hit interpolates, with their weights. @return its part of K^k 1
double SetSolution::add_hit(const StoredHit& hit, Gathering& gathering) const {
  const Vec2 b(static_cast<float>(hit.b1) / 65535.0F, static_cast<float>(hit.b2) / 65535.0F);
  const Rgb albedo = hit.weight * work_.surfaces->albedo({hit.triangle / 2, b, 0.0F});
  const auto strongest = static_cast<double>(max_component(albedo));
  const float share[3] = {std::max(0.0F, 1.0F - b.x - b.y), b.x, b.y};
  double power = 0.0;
  for (int k = 0; k < 3; ++k) {
    const std::uint32_t side = side_of(hit, k);
    gathering.corners.push_back(last_.data() + side * width_);
    for (int c = 0; c < channels_; ++c) gathering.weights.push_back(share[k] * albedo[c]);
    power += static_cast<double>(share[k]) * strongest * power_[side];
  }
  return power;
}

void SetSolution::gather_point(std::size_t point, Gathering& gathering) {
  const std::vector<StoredHit>& hits = hits_[point];
  const double scale = 1.0 / static_cast<double>(work_.sampler->set_size());
  gathering.sums.assign(width_, 0.0);
  double power = 0.0;
  for (std::size_t first = 0; first < hits.size(); first += kFloatHits) {
    const std::size_t end = std::min(hits.size(), first + kFloatHits);
    gathering.corners.clear();
    gathering.weights.clear();
    for (std::size_t h = first; h < end; ++h) power += add_hit(hits[h], gathering);
    gathering.part.assign(width_, 0.0F);
    add_rows(gathering.corners.data(), gathering.weights.data(), end - first, channels_, row_,
             gathering.part.data());
    for (std::size_t i = 0; i < width_; ++i) gathering.sums[i] += static_cast<double>(gathering.part[i]);
  }
  float* out = next_.data() + point * width_;
  for (std::size_t i = 0; i < width_; ++i) out[i] = static_cast<float>(gathering.sums[i] * scale);
  next_power_[point] = power * scale;
}

void SetSolution::bounce() {
  for_points([&](std::size_t first, std::size_t end) {
    Gathering gathering;
    for (std::size_t p = first; p < end; ++p) gather_point(p, gathering);
  });
  std::swap(last_, next_);
  std::swap(power_, next_power_);
  norms_.push_back(*std::max_element(power_.begin(), power_.end()));
}

// The iteration is T_k = K T_k-1 with K >= 0, so |T_k+j| <= ||K^j|| max |T_k| with ||K^j|| = max K^j 1, the largest row sum.
// With c = ||K^k|| < 1 and j = q k + r, ||K^j|| <= c^q ||K^r||: the sum over j >= 1 is at most (||K^1|| + … + ||K^k||)/(1 - c).
double SetSolution::remainder() const {
  float largest = 0.0F;
  for (const float value : last_) largest = std::max(largest, std::abs(value));
  if (largest == 0.0F) return 0.0;
  if (norms_.empty() || !(norms_.back() < 1.0)) return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (const double norm : norms_) sum += norm;
  return static_cast<double>(largest) * sum / (1.0 - norms_.back());
}

/// Mean and squared deviations over sets, in the arrays of the result; finish() turns the latter into standard errors. The
/// arithmetic is double, what is kept between sets float: an error of 6e-8 a set.
void add_set(const Rows& values, std::size_t row, std::size_t count, int set, int threads, Term& term) {
  const double sets = set + 1;
  const std::size_t vectors = term.coefficients.size() / count;
  parallel_for((vectors + kBlock - 1) / kBlock, threads, [&](std::size_t block) {
    for (std::size_t v = block * kBlock; v < std::min(vectors, (block + 1) * kBlock); ++v) {
      const float* from = values.data() + v * row;
      float* means = term.coefficients.data() + v * count;
      float* squares = term.standard_errors.data() + v * count;
      for (std::size_t i = 0; i < count; ++i) {
        const auto value = static_cast<double>(from[i]);
        const double difference = value - static_cast<double>(means[i]);
        const double mean = static_cast<double>(means[i]) + difference / sets;
        means[i] = static_cast<float>(mean);
        squares[i] = static_cast<float>(static_cast<double>(squares[i]) + difference * (value - mean));
      }
    }
  });
}

/// sum += term, as far as there are vertices: backs are not kept.
void accumulate(const Rows& term, int threads, Rows& sum) {
  constexpr std::size_t kTogether = std::size_t{1} << 14U;
  parallel_for((sum.size() + kTogether - 1) / kTogether, threads, [&](std::size_t block) {
    for (std::size_t i = block * kTogether; i < std::min(sum.size(), (block + 1) * kTogether); ++i)
      sum[i] += term[i];
  });
}

void finish(Term& term, int sets) {
  for (float& value : term.standard_errors)
    value =
        sets == 1 ? 0.0F : static_cast<float>(std::sqrt(static_cast<double>(value) / (sets * (sets - 1.0))));
}

/// Root mean square over all vectors, of which each has `count` coefficients, of their errors after `sets` sets.
double vector_error(const Term& term, std::size_t count, int sets) {
  double squares = 0.0;
  for (const float value : term.standard_errors) squares += static_cast<double>(value);
  const double vectors =
      static_cast<double>(std::max<std::size_t>(1, term.coefficients.size())) / static_cast<double>(count);
  return std::sqrt(squares / (vectors * sets * (sets - 1.0)));
}

/// 1e-4 of T_00 in a white furnace, 1/sqrt(4 pi): the largest there can be.
const double kNegligible = 1e-4 / std::sqrt(4.0 * kPi);

struct Solved {
  Term total;
  std::vector<Term> terms;
};

[[noreturn]] void refuse_endless_light(double remainder) {
  throw InputError(
      fmt::format("bounces: after {} of them a coefficient may still miss {:.3g}: light hardly leaves this "
                  "scene; name a number of bounces, or take the traced solver",
                  kMostIterations, remainder));
}

/// Bounces one set's light until it is used up. @return the bound on what is left out
double add_solution(const IterativeWork& work, int set, std::size_t count, SetSolution& solution,
                    Solved& solved) {
  const auto add = [&](const Rows& values, Term& term) {
    add_set(values, solution.row(), count, set, work.threads, term);
  };
  Rows sum(work.vertices->size() * solution.width());
  double remainder = 0.0;
  int k = 0;
  for (;; ++k) {
    accumulate(solution.term(), work.threads, sum);
    if (k < work.kept_terms) add(solution.term(), solved.terms[static_cast<std::size_t>(k)]);
    if (k == work.max_bounces) break;
    if (work.max_bounces == kAllBounces) {
      remainder = solution.remainder();
      if (remainder <= kNegligible) break;
      if (k == kMostIterations) refuse_endless_light(remainder);
    }
    solution.bounce();
  }
  add(sum, solved.total);
  std::fill(sum.begin(), sum.end(), 0.0F);
  for (++k; k < work.kept_terms; ++k) add(sum, solved.terms[static_cast<std::size_t>(k)]);
  return remainder;
}

}  // namespace

void solve_iteratively(const IterativeWork& work, Transfer& transfer) {
  const auto count = static_cast<std::size_t>(sh::coefficient_count(transfer.bands));
  const std::size_t size = transfer.vertices * count * static_cast<std::size_t>(transfer.channels);
  Solved solved{{std::vector<float>(size), std::vector<float>(size)}, {}};
  solved.terms.assign(static_cast<std::size_t>(work.kept_terms), solved.total);
  const Sides sides = make_sides(*work.scene, *work.vertices);
  SetSolution solution(work, sides, transfer);
  const auto set_size = static_cast<std::int64_t>(work.sampler->set_size());
  const std::int64_t most = work.allowed_error > 0.0 ? kMostSamples / set_size : 0;
  transfer.remainder = 0.0;
  int sets = 0;
  bool is_on_target = true;
  do {
    solution.trace_set(static_cast<std::uint32_t>(sets));
    transfer.remainder = std::max(transfer.remainder, add_solution(work, sets, count, solution, solved));
    ++sets;
    is_on_target = work.allowed_error == 0.0 ||
                   vector_error(solved.total, count, std::max(2, sets)) <= work.allowed_error;
    if (work.progress) work.progress(std::min(1.0, static_cast<double>(sets) / work.sets));
  } while (sets < work.sets || (!is_on_target && sets < most));
  finish(solved.total, sets);
  for (Term& term : solved.terms) finish(term, sets);
  transfer.samples = set_size * sets;
  transfer.mean_samples = static_cast<double>(transfer.samples);
  transfer.above_target = is_on_target ? 0 : transfer.vertices;
  transfer.coefficients = std::move(solved.total.coefficients);
  transfer.standard_errors = std::move(solved.total.standard_errors);
  transfer.terms = std::move(solved.terms);
}

}  // namespace plumbline::transfer
