// prt/transfer/point_baker.hpp: transfer of one point after the other, by directions that escape.
#pragma once

#include <cstdint>
#include <vector>

#include "prt/sh/basis.hpp"
#include "prt/sh/batch.hpp"
#include "prt/transfer/basis_sums.hpp"
#include "prt/transfer/bundle.hpp"
#include "prt/transfer/direction_sampler.hpp"
#include "prt/transfer/directions.hpp"
#include "prt/transfer/plan.hpp"
#include "prt/transfer/set_statistics.hpp"
#include "reference/trace/ray_caster.hpp"
#include "reference/trace/surface_point.hpp"
#include "reference/trace/surface_table.hpp"

namespace plumbline::transfer {

/// What all points of a bake share; outlives its bakers.
struct PointWork {
  const trace::RayCaster* caster = nullptr;
  const trace::SurfaceTable* surfaces = nullptr;            // nullptr: nothing reflects, visibility is enough
  const std::vector<DirectionSampler>* samplers = nullptr;  // make_samplers()
  const sh::BatchBasis<float>* basis = nullptr;
  std::uint64_t seed = 0;
  DirectionSets directions = DirectionSets::per_vertex;
  int channels = 1;
  int max_bounces = 0;
  int kept_terms = 0;
  int sets = kSets;
  double allowed_error = 0.0;  // of a vector, absolute; 0: none asked for
};

/// Statistics of [1 + kept terms][channel][bands^2]: the total, then the terms.
struct PointResult {
  SetStatistics statistics;
  std::int64_t samples = 0;  // directions drawn
  bool is_on_target = true;
};

/// Scratch of one thread. A direction from the point escapes, and adds its basis functions to term 0; or it meets a surface that
/// reflects, goes on from there in a cosine-distributed direction, and adds them, times the albedos passed, to the term of
/// the bounce after which it escapes. That is an unbiased estimate of every term: a Lambertian surface reflects albedo/pi of
/// its irradiance, and 1/pi times the cosine is the density of the directions drawn.
class PointBaker {
 public:
  explicit PointBaker(const PointWork& work);

  [[nodiscard]] PointResult run(const trace::SurfacePoint& point, std::uint64_t stream, Above above);

 private:
  struct Walk {
    trace::Hit hit;
    Vec3 direction{0.0F};  // that led to the hit
    Rgb throughput{1.0F};
  };

  [[nodiscard]] PointResult closed_form(const trace::SurfacePoint& point);
  void take_from_closed_form(const trace::SurfacePoint& point, SetStatistics& statistics);
  void add_visible_sets(const trace::SurfacePoint& point, std::uint64_t stream, std::uint32_t round,
                        Above above);
  void trace_pieces(const trace::SurfacePoint& point);
  void add_visible(std::uint32_t set);
  void add_walk_set(const trace::SurfacePoint& point, std::uint64_t stream, std::uint32_t set,
                    std::uint32_t round);
  [[nodiscard]] bool is_on_target(double count) const;
  void add_walks(const trace::SurfacePoint& point, RandomNumbers& numbers);
  void walk_on(int bounce, RandomNumbers& numbers);
  [[nodiscard]] bool reflect(Walk& walk, int bounce, RandomNumbers& numbers, trace::Ray& next) const;
  void keep_escaped(const Vec3& direction, const Rgb& throughput);
  void add_escaped(int bounce);

  PointWork work_;
  const DirectionSampler* sampler_ = nullptr;  // of the round
  std::size_t size_;                           // of a term: channels x bands^2
  std::size_t width_;                          // of a set: [1 + kept terms][channel][bands^2]
  Bundle bundle_;
  Bundle escaped_;
  Bundle joint_;  // directions of several sets on their way to the rays: long streams are fast
  std::vector<Piece> pieces_;
  BasisSums basis_sums_;
  sh::Basis<double> exact_basis_;
  std::vector<double> exact_;  // scratch: one direction's
  std::vector<std::uint8_t> is_hit_;
  std::vector<trace::Hit> hits_;
  std::vector<Walk> walks_;
  std::vector<double> totals_;  // [set][width]
  std::vector<double> sums_;    // [width] of one draw; first what no kept term holds, in the end the total
};

}  // namespace plumbline::transfer
