// reference/trace/ray_caster.hpp: the ray query; reference/trace is the only code that knows Embree.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "reference/base/vector.hpp"
#include "reference/scene/scene.hpp"

namespace plumbline::trace {

struct Ray {
  Vec3 origin{0.0F};
  Vec3 direction{0.0F};  // unit
  float max_distance = std::numeric_limits<float>::infinity();
};

struct Hit {
  std::uint32_t triangle = 0;  // or the number of another surface of the scene (scene.hpp)
  Vec2 barycentrics{0.0F};  // weights of the triangle's second and third vertex; other surfaces: analytic.hpp
  float distance = 0.0F;
};

/// Unit directions as three arrays of the same length.
struct DirectionArrays {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* z = nullptr;
  std::size_t count = 0;
};

/// Hit::triangle of a ray that met nothing.
inline constexpr std::uint32_t kNoSurface = std::numeric_limits<std::uint32_t>::max();

/// The bounding volume hierarchy over a scene's triangles, spheres and discs. Both faces of a surface stop a
/// ray.
/// Safe to query from many threads.
class RayCaster {
 public:
  /// @throws DeviceError when Embree fails.
  explicit RayCaster(const scene::Scene& scene);
  ~RayCaster();
  RayCaster(RayCaster&&) noexcept;
  RayCaster& operator=(RayCaster&&) noexcept;
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;

  [[nodiscard]] std::optional<Hit> closest_hit(const Ray& ray) const;
  [[nodiscard]] bool is_occluded(const Ray& ray) const;
  /// The same for up to kMostTogether rays, best of one origin: bit i is set when rays[i] meets something. Faster than one by
  /// one where there are four or more (plumbline_bench, rays/).
  static constexpr std::size_t kMostTogether = 8;
  [[nodiscard]] std::uint32_t occluded(std::span<const Ray> rays) const;

  /// Many rays without end from one origin: is_hit[i] is 1 where direction i meets something, else 0. The fastest form there
  /// is for a bake (plumbline_bench, rays/hemisphere): Embree 3's streams, Embree 4's packets.
  void occluded_from(const Vec3& origin, const DirectionArrays& directions, std::uint8_t* is_hit) const;
  /// The same for closest hits; hits[i].triangle is kNoSurface where there is none.
  void closest_from(const Vec3& origin, const DirectionArrays& directions, Hit* hits) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace plumbline::trace
