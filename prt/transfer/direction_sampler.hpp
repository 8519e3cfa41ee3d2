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
    std::uint32_t randomisation = 0;  // below kRepeatedSets where there are repeats
    std::size_t first = 0;            // of the set
    std::size_t count = 0;            // <= kMostTogether
    std::uint32_t repeat = 0;         // as many directions again, drawn anew
  };
  static constexpr std::uint32_t kRepeatedSets = 64;
  /// Fills the bundle (all channels alike) with those of the directions that leave the point's surface, above its geometric
  /// and its shading plane. The sum of weight y over a set, over set_size(), estimates (1/pi) integral y max(0, n.w) dw.
  void draw(const trace::SurfacePoint& point, const Place& place, Bundle& bundle) const;

 private:
  void draw_lattice(const trace::SurfacePoint& point, const Place& place, Bundle& bundle) const;
  void draw_cosine_grid(const trace::SurfacePoint& point, const Place& place, Bundle& bundle) const;
  void draw_uniform_grid(const trace::SurfacePoint& point, const Place& place, Bundle& bundle) const;

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
