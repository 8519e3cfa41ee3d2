#include "reference/scene/polygon.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <numeric>

#include "reference/base/error.hpp"

namespace plumbline::scene {
namespace {

// Twice the vector area (Newell's normal), of any simple polygon, plane or not.
Vec3d twice_vector_area(std::span<const Vec3> corners) {
  Vec3d sum(0.0);
  const Vec3d origin(corners[0]);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    sum += glm::cross(Vec3d(corners[i]) - origin, Vec3d(corners[i + 1]) - origin);
  }
  return sum;
}

double signed_area(std::span<const Vec3> p, const Vec3d& normal, std::size_t a, std::size_t b,
                   std::size_t c) {
  return glm::dot(normal, glm::cross(Vec3d(p[b]) - Vec3d(p[a]), Vec3d(p[c]) - Vec3d(p[a])));
}

std::vector<glm::uvec3> fan(const std::vector<std::uint32_t>& ring) {
  std::vector<glm::uvec3> triangles;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) triangles.emplace_back(ring[0], ring[i], ring[i + 1]);
  return triangles;
}

bool is_fan_right(std::span<const Vec3> corners, const Vec3d& normal) {
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    if (signed_area(corners, normal, 0, i, i + 1) < 0.0) return false;
  }
  return true;
}

// The corner at ring[i] can be cut off: it is convex and no other corner lies in the triangle.
bool is_ear(std::span<const Vec3> p, const Vec3d& normal, const std::vector<std::uint32_t>& ring,
            std::size_t i) {
  const std::size_t count = ring.size();
  const std::uint32_t a = ring[(i + count - 1) % count];
  const std::uint32_t b = ring[i];
  const std::uint32_t c = ring[(i + 1) % count];
  if (!(signed_area(p, normal, a, b, c) > 0.0)) return false;
  for (const std::uint32_t q : ring) {
    if (p[q] == p[a] || p[q] == p[b] || p[q] == p[c]) continue;
    if (signed_area(p, normal, a, b, q) >= 0.0 && signed_area(p, normal, b, c, q) >= 0.0 &&
        signed_area(p, normal, c, a, q) >= 0.0) {
      return false;
    }
  }
  return true;
}

std::vector<glm::uvec3> cut_ears(std::span<const Vec3> corners, const Vec3d& normal,
                                 std::vector<std::uint32_t> ring) {
  std::vector<glm::uvec3> triangles;
  std::size_t i = 0;
  std::size_t tried = 0;
  while (ring.size() > 3 && tried < ring.size()) {
    i %= ring.size();
    if (!is_ear(corners, normal, ring, i)) {
      ++i;
      ++tried;
      continue;
    }
    const std::size_t count = ring.size();
    triangles.emplace_back(ring[(i + count - 1) % count], ring[i], ring[(i + 1) % count]);
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(i));
    tried = 0;
  }
  for (const glm::uvec3& rest : fan(ring)) triangles.push_back(rest);
  return triangles;
}

}  // namespace

std::vector<glm::uvec3> triangulate(std::span<const Vec3> corners) {
  if (corners.size() < 3) return {};
  std::vector<std::uint32_t> ring(corners.size());
  std::iota(ring.begin(), ring.end(), 0U);
  if (corners.size() == 3) return fan(ring);
  const Vec3d normal = twice_vector_area(corners);
  if (is_fan_right(corners, normal)) return fan(ring);
  if (corners.size() > kMostConcaveCorners) {
    throw InputError(fmt::format("a polygon that is not convex has {} corners, at most {} are taken",
                                 corners.size(), kMostConcaveCorners));
  }
  return cut_ears(corners, normal, std::move(ring));
}

}  // namespace plumbline::scene
