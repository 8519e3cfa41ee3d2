#include "prt/transfer/horizon.hpp"

#include <algorithm>
#include <tuple>

namespace plumbline::transfer {
namespace {

constexpr std::uint32_t kLeaf = 8;
// Halves are halves by count: 2^32 positions make 29 levels.
constexpr std::size_t kDeepest = 64;

/// Largest n.q over a box.
double reach(const Vec3d& normal, const Vec3& low, const Vec3& high) {
  double sum = 0.0;
  for (int i = 0; i < 3; ++i)
    sum += std::max(normal[i] * static_cast<double>(low[i]), normal[i] * static_cast<double>(high[i]));
  return sum;
}

}  // namespace

Horizon::Horizon(const scene::Scene& scene) {
  std::vector<bool> is_used(scene.positions.size(), false);
  for (const glm::uvec3& corners : scene.triangles) {
    for (int k = 0; k < 3; ++k) is_used[corners[k]] = true;
  }
  for (std::size_t v = 0; v < is_used.size(); ++v) {
    if (is_used[v]) positions_.push_back(scene.positions[v]);
  }
  // Faceted meshes have every position many times.
  const auto is_before = [](const Vec3& a, const Vec3& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  };
  std::sort(positions_.begin(), positions_.end(), is_before);
  positions_.erase(std::unique(positions_.begin(), positions_.end()), positions_.end());
  boxes_.reserve(positions_.size() / kLeaf * 4 + 1);
  if (!positions_.empty()) build(0, static_cast<std::uint32_t>(positions_.size()));
}

std::uint32_t Horizon::build(std::uint32_t first, std::uint32_t end) {
  const auto me = static_cast<std::uint32_t>(boxes_.size());
  boxes_.push_back({positions_[first], positions_[first], first, end - first, 0});
  for (std::uint32_t i = first; i < end; ++i) {
    boxes_[me].low = glm::min(boxes_[me].low, positions_[i]);
    boxes_[me].high = glm::max(boxes_[me].high, positions_[i]);
  }
  if (end - first <= kLeaf) return me;
  const Vec3 size = boxes_[me].high - boxes_[me].low;
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const std::uint32_t middle = first + (end - first) / 2;
  std::nth_element(positions_.begin() + first, positions_.begin() + middle, positions_.begin() + end,
                   [axis](const Vec3& a, const Vec3& b) { return a[axis] < b[axis]; });
  boxes_[me].count = 0;
  build(first, middle);
  const std::uint32_t second = build(middle, end);
  boxes_[me].second = second;
  return me;
}

bool Horizon::is_empty_above(const trace::SurfacePoint& point) const {
  if (boxes_.empty()) return true;
  const Vec3d normal(point.geometric_normal);
  const double limit = glm::dot(normal, Vec3d(point.position)) + 0.5 * static_cast<double>(point.clearance);
  std::uint32_t waiting[kDeepest];
  std::size_t depth = 0;
  waiting[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t at = waiting[--depth];
    const Box& box = boxes_[at];
    if (reach(normal, box.low, box.high) <= limit) continue;
    if (box.count == 0) {
      waiting[depth++] = box.second;
      waiting[depth++] = at + 1;
      continue;
    }
    for (std::uint32_t i = box.first; i < box.first + box.count; ++i) {
      if (glm::dot(normal, Vec3d(positions_[i])) > limit) return false;
    }
  }
  return true;
}

}  // namespace plumbline::transfer
