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

/// A ray that met something that reflects, with all that a gathering needs: 28 bytes, and no look at the scene. Shares in
/// 65535ths move the hit by less than 1e-5 of its triangle.
struct StoredHit {
  std::uint32_t points[3] = {};  // whose transfer is interpolated
  std::uint16_t shares[2] = {};  // of the second and third
  Rgb albedo{0.0F};              // times the ray's weight
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
  Bundle joint;  // of several sets: long streams of rays are fast
  Bundle escaped;
  BasisSums basis_sums;
  std::vector<Piece> pieces;
  std::vector<trace::Hit> hits;
  std::vector<std::vector<StoredHit>> stored;  // by set of the group
  std::vector<std::vector<double>> sums;       // likewise

  Tracing(const sh::BatchBasis<float>& basis, std::size_t count, std::size_t sets)
      : bundle(DirectionSampler::kMostTogether, 1),
        joint(DirectionSampler::kMostTogether, 1),
        escaped(DirectionSampler::kMostTogether, 1),
        basis_sums(basis, 1),
        hits(joint.capacity),
        stored(sets),
        sums(sets, std::vector<double>(count)) {}
};

/// Scratch of one task that gathers.
struct Gathering {
  std::vector<const float*> corners;
  std::vector<float> weights;
  Rows part;
  std::vector<double> sums;
};

/// Sets of directions are traced in groups of about so many rays a point.
constexpr std::size_t kGroupRays = 256;
/// Hits are kept for a group: a scene that could have more than so many, 0.9 GB, is traced set by set.
constexpr std::size_t kMostHits = std::size_t{1} << 25U;

std::size_t sets_together(std::size_t set_size, std::size_t points) {
  const std::size_t by_rays = std::max<std::size_t>(1, kGroupRays / set_size);
  return std::clamp<std::size_t>(kMostHits / std::max<std::size_t>(1, set_size * points), 1, by_rays);
}

/// Every set of directions has its own solution. Sets are traced in groups and solved one after the other.
class SetSolution {
 public:
  SetSolution(const IterativeWork& work, const Sides& sides, const Transfer& shape)
      : work_(work),
        sides_(sides),
        channels_(shape.channels),
        count_(static_cast<std::size_t>(sh::coefficient_count(shape.bands))),
        row_(padded_row(count_)),
        width_(row_ * static_cast<std::size_t>(channels_)),
        together_(sets_together(work.sampler->set_size(), sides.points.size())),
        hits_(together_ * sides.points.size()),
        first_(together_, Rows(sides.points.size() * width_)),
        last_(sides.points.size() * width_),
        next_(last_.size()),
        is_bounding_(work.max_bounces == kAllBounces),
        power_(sides.points.size()),
        next_power_(power_.size()) {}

  /// Makes term 0 of a set, in ascending order from 0; traces its group before.
  void start(std::uint32_t set);
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
  void set_first_term(std::size_t place, std::size_t point, const std::vector<double>& values);
  void trace_group(std::uint32_t first_set);
  void trace_point(std::size_t point, std::uint32_t first_set, Tracing& tracing);
  void trace_pieces(const trace::SurfacePoint& point, Tracing& tracing) const;
  void sort_piece(std::size_t first, const Piece& piece, Tracing& tracing) const;
  void gather_point(std::size_t point, Gathering& gathering);
  [[nodiscard]] double add_hit(const StoredHit& hit, Gathering& gathering) const;
  [[nodiscard]] std::vector<std::uint8_t> new_backs(const std::vector<std::uint8_t>& is_traced) const;

  const IterativeWork& work_;
  const Sides& sides_;
  int channels_;
  std::size_t count_;
  std::size_t row_;
  std::size_t width_;
  std::size_t together_;                      // sets in a group
  std::size_t place_ = 0;                     // of the set that is solved, in its group
  std::vector<std::vector<StoredHit>> hits_;  // [place][point]
  std::vector<Rows> first_;                   // term 0, by place
  Rows last_;
  Rows next_;
  bool is_bounding_;           // whether remainder() will be asked
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

std::uint16_t fraction16(float value) {
  return static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0F, 1.0F) * 65535.0F));
}

/// Splits one set's directions into those that escape and hits that reflect.
void SetSolution::sort_piece(std::size_t first, const Piece& piece, Tracing& tracing) const {
  const Bundle& joint = tracing.joint;
  Bundle& escaped = tracing.escaped;
  escaped.count = 0;
  for (std::size_t k = first; k < piece.end; ++k) {
    const trace::Hit& hit = tracing.hits[k];
    if (hit.triangle == trace::kNoSurface) {
      escaped.x[escaped.count] = joint.x[k];
      escaped.y[escaped.count] = joint.y[k];
      escaped.z[escaped.count] = joint.z[k];
      escaped.weight(0)[escaped.count++] = joint.weight(0)[k];
      continue;
    }
    const auto& surface = work_.surfaces->surface(hit.triangle);
    const bool is_front = work_.surfaces->hit(hit, {joint.x[k], joint.y[k], joint.z[k]}).is_front;
    if (!is_front && !surface.is_double_sided) continue;
    const Rgb albedo = work_.surfaces->albedo(hit);
    if (is_black(albedo)) continue;
    StoredHit stored{
        {}, {fraction16(hit.barycentrics.x), fraction16(hit.barycentrics.y)}, joint.weight(0)[k] * albedo};
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t vertex = work_.scene->triangles[hit.triangle][i];
      stored.points[i] = is_front ? vertex : sides_.back_of[vertex];
    }
    tracing.stored[piece.set].push_back(stored);
  }
}

/// Traces what has come together, and sorts it by sets.
void SetSolution::trace_pieces(const trace::SurfacePoint& point, Tracing& tracing) const {
  const Bundle& joint = tracing.joint;
  work_.caster->closest_from(point.position + point.clearance * point.geometric_normal,
                             {joint.x.data(), joint.y.data(), joint.z.data(), joint.count},
                             tracing.hits.data());
  std::size_t first = 0;
  for (const Piece& piece : tracing.pieces) {
    sort_piece(first, piece, tracing);
    tracing.basis_sums.add(tracing.escaped, tracing.sums[piece.set]);
    first = piece.end;
  }
  tracing.joint.count = 0;
  tracing.pieces.clear();
}

Above SetSolution::above(std::size_t point) const {
  return point < work_.above->size() ? (*work_.above)[point] : Above::something;
}

void SetSolution::set_first_term(std::size_t place, std::size_t point, const std::vector<double>& values) {
  for (int c = 0; c < channels_; ++c) {
    float* out = first_[place].data() + point * width_ + static_cast<std::size_t>(c) * row_;
    for (std::size_t i = 0; i < count_; ++i) out[i] = static_cast<float>(values[i]);
  }
}

void SetSolution::trace_point(std::size_t p, std::uint32_t first_set, Tracing& tracing) {
  const trace::SurfacePoint& point = sides_.points[p];
  const std::size_t size = work_.sampler->set_size();
  const bool is_flat = above(p) == Above::nothing_flat;
  for (std::uint32_t place = 0; place < together_; ++place) {
    tracing.stored[place].clear();
    std::fill(tracing.sums[place].begin(), tracing.sums[place].end(), 0.0);
    for (std::size_t first = 0; first < size && !is_flat; first += DirectionSampler::kMostTogether) {
      const std::size_t most = std::min(DirectionSampler::kMostTogether, size - first);
      if (tracing.joint.count + most > tracing.joint.capacity) trace_pieces(point, tracing);
      const DirectionSampler::Place drawn{p, first_set + place, first, most, 0};
      if (above(p) == Above::nothing) {
        work_.sampler->draw(point, drawn, tracing.bundle, DirectionSampler::Side::blocked);
        tracing.basis_sums.add(tracing.bundle, tracing.sums[place]);
        continue;
      }
      work_.sampler->draw(point, drawn, tracing.bundle);
      append(tracing.bundle, tracing.joint);
      tracing.pieces.push_back({place, tracing.joint.count});
    }
  }
  trace_pieces(point, tracing);
  for (std::size_t place = 0; place < together_; ++place) {
    const std::vector<StoredHit>& stored = tracing.stored[place];
    hits_[place * sides_.points.size() + p].assign(stored.begin(), stored.end());
    std::vector<double>& term = tracing.sums[place];
    for (double& value : term) value /= static_cast<double>(size);
    if (above(p) != Above::something) {  // what was summed is what the surface itself blocks
      const std::vector<double> exact = unshadowed_transfer(work_.basis->bands(), point.shading_normal);
      for (std::size_t i = 0; i < term.size(); ++i) term[i] = exact[i] - term[i];
    }
    set_first_term(place, p, term);
  }
}

/// Points that were met and are not traced.
std::vector<std::uint8_t> SetSolution::new_backs(const std::vector<std::uint8_t>& is_traced) const {
  std::vector<std::uint8_t> is_new(is_traced.size(), 0);
  if (is_traced.size() == work_.vertices->size()) return is_new;  // nothing has a back that shines
  for (const std::vector<StoredHit>& hits : hits_) {
    for (const StoredHit& hit : hits) {
      for (const std::uint32_t point : hit.points) is_new[point] = is_traced[point] == 0 ? 1 : 0;
    }
  }
  return is_new;
}

void SetSolution::trace_group(std::uint32_t first_set) {
  for (std::vector<StoredHit>& hits : hits_) hits.clear();
  for (Rows& rows : first_) std::fill(rows.begin(), rows.end(), 0.0F);
  std::vector<std::uint8_t> is_due(sides_.points.size(), 0);
  std::fill_n(is_due.begin(), work_.vertices->size(), std::uint8_t{1});
  std::vector<std::uint8_t> is_traced(is_due.size(), 0);
  const auto is_set = [](std::uint8_t flag) { return flag != 0; };
  // Backs that nothing meets need no transfer; those that are met may meet others.
  while (std::any_of(is_due.begin(), is_due.end(), is_set)) {
    for_points([&](std::size_t first, std::size_t end) {
      Tracing tracing(*work_.basis, count_, together_);
      for (std::size_t p = first; p < end; ++p) {
        if (is_due[p] != 0) trace_point(p, first_set, tracing);
      }
    });
    for (std::size_t p = 0; p < is_due.size(); ++p) is_traced[p] |= is_due[p];
    is_due = new_backs(is_traced);
  }
}

void SetSolution::start(std::uint32_t set) {
  place_ = set % together_;
  if (place_ == 0) trace_group(set);
  last_ = first_[place_];
  std::fill(power_.begin(), power_.end(), 1.0);
  norms_.clear();
}

/// Lists the rows that a hit interpolates, with their weights. @return its part of K^k 1
double SetSolution::add_hit(const StoredHit& hit, Gathering& gathering) const {
  const float second = static_cast<float>(hit.shares[0]) / 65535.0F;
  const float third = static_cast<float>(hit.shares[1]) / 65535.0F;
  const float share[3] = {std::max(0.0F, 1.0F - second - third), second, third};
  double power = 0.0;
  for (int k = 0; k < 3; ++k) {
    gathering.corners.push_back(last_.data() + hit.points[k] * width_);
    for (int c = 0; c < channels_; ++c) gathering.weights.push_back(share[k] * hit.albedo[c]);
    if (is_bounding_) power += static_cast<double>(share[k]) * power_[hit.points[k]];
  }
  return power * static_cast<double>(max_component(hit.albedo));
}

void SetSolution::gather_point(std::size_t point, Gathering& gathering) {
  const std::vector<StoredHit>& hits = hits_[place_ * sides_.points.size() + point];
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
    solution.start(static_cast<std::uint32_t>(sets));
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
