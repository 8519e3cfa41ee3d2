// prt/transfer/horizon.hpp: which points have nothing above them.
#pragma once

#include <cstdint>
#include <vector>

#include "reference/scene/scene.hpp"
#include "reference/trace/surface_point.hpp"

namespace plumbline::transfer {

/// A hierarchy of boxes over the vertices that triangles use, to ask whether any lies above a plane. On a convex mesh only boxes
/// near the plane's point reach above it: the cost of a question grows like the logarithm of the mesh.
class Horizon {
 public:
  explicit Horizon(const scene::Scene& scene);

  /// Whether no ray that leaves the point's surface can meet anything: all triangles lie on or below the plane through the
  /// point, perpendicular to its geometric normal, up to half the clearance that rays start above it with.
  [[nodiscard]] bool is_empty_above(const trace::SurfacePoint& point) const;

 private:
  struct Box {
    Vec3 low{0.0F};
    Vec3 high{0.0F};
    std::uint32_t first = 0;  // of the positions in a leaf
    std::uint32_t count = 0;  // 0: an inner box; its first half is the next one
    std::uint32_t second = 0;
  };
  std::uint32_t build(std::uint32_t first, std::uint32_t end);

  std::vector<Vec3> positions_;
  std::vector<Box> boxes_;
};

}  // namespace plumbline::transfer
