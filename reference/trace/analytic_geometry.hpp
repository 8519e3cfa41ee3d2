// reference/trace/analytic_geometry.hpp: spheres and discs as one of Embree's user geometries.
#pragma once

#include <cstdint>
#include <vector>

#include "reference/scene/scene.hpp"
#include "reference/trace/embree.hpp"

namespace plumbline::trace {

/// The primitives of a scene, spheres first. Embree keeps a pointer to it: it must not move or end before the
/// hierarchy does.
struct AnalyticShapes {
  std::vector<scene::Sphere> spheres;
  std::vector<scene::Disc> discs;
  std::uint32_t first_surface = 0;  // number of the first sphere among the scene's surfaces
};

/// Adds them to a hierarchy in the making. A hit's primID is the *surface number* (triangles come first), its
/// u and v are the point's coordinates (analytic.hpp). Errors are left on the device for the caller to find.
void attach_analytic_shapes(RTCDevice device, RTCScene hierarchy, AnalyticShapes& shapes);

}  // namespace plumbline::trace
