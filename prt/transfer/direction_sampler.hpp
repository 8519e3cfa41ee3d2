// prt/transfer/direction_sampler.hpp: the directions of a bake, in sets.
#pragma once

#include <cstdint>
#include <vector>

#include "prt/transfer/bundle.hpp"
#include "prt/transfer/method.hpp"
#include "reference/trace/surface_point.hpp"

namespace plumbline::transfer {

/// Draws sets of directions. A set is numbered by the stream (whose point it is) and its randomisation; sets are independent of
/// each other, the directions in one are not.
class DirectionSampler {
 public:
  /// Directions that one call draws at most.
  static constexpr std::size_t kMostTogether = 1024;

  /// @param set_size  directions wanted in a set; grids take the largest rows x columns within it
  /// @param kept_sets  shared directions on the sphere are the same everywhere: so many sets are drawn once and kept
  DirectionSampler(Sampling sampling, DirectionSets sets, std::uint64_t seed, std::size_t set_size,
                   std::uint32_t kept_sets = 0);

  /// Directions in a set.
  [[nodiscard]] std::size_t set_size() const { return set_size_; }

  struct Place {
    std::uint64_t stream = 0;
    std::uint32_t randomisation = 0;  // below kSetsARound where there are rounds
    std::size_t first = 0;            // of the set
    std::size_t count = 0;            // <= kMostTogether
    std::uint32_t round = 0;          // sets of different rounds are independent
  };
  static constexpr std::uint32_t kSetsARound = 64;
  /// Which directions above the shading plane are wanted: those that leave the surface, above its geometric plane, or those
  /// that the surface itself blocks.
  enum class Side { leaving, blocked };
  /// Fills the bundle (all channels alike) with the directions wanted. The sum of weight y over a set, over set_size(), estimates (1/pi) integral y max(0, n.w) dw.
  void draw(const trace::SurfacePoint& point, const Place& place, Bundle& bundle,
            Side side = Side::leaving) const;

 private:
  void draw_lattice(const trace::SurfacePoint& point, const Place& all, Side side, Bundle& bundle) const;
  void draw_cosine_grid(const trace::SurfacePoint& point, const Place& place, Side side,
                        Bundle& bundle) const;
  void draw_uniform_grid(const trace::SurfacePoint& point, const Place& place, Side side,
                         Bundle& bundle) const;

  [[nodiscard]] Place blocked_part(const trace::SurfacePoint& point, const Place& place, double shift) const;
  [[nodiscard]] Vec3 on_sphere(std::size_t cell, std::uint64_t stream, std::uint32_t randomisation) const;
  void keep_sphere(std::uint32_t sets);

  Sampling sampling_;
  DirectionSets sets_;
  std::uint64_t seed_;
  std::size_t set_size_;
  std::size_t columns_ = 1;
  // The lattice's first kMostTogether points: cos and sin of the azimuth, and i/n.
  sh::AlignedVector<float> cosine_;
  sh::AlignedVector<float> sine_;
  sh::AlignedVector<float> height_;
  std::vector<Vec3> sphere_;  // [set][direction], of shared sets on the sphere
};

}  // namespace plumbline::transfer
