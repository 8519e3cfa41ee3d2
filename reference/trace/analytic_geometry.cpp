#include "reference/trace/analytic_geometry.hpp"

#include <cmath>
#include <limits>
#include <optional>

#include "reference/trace/analytic.hpp"

namespace plumbline::trace {
namespace {

// Outwards by two floats a side: one for the rounding to float, one so that no box is flat.
void copy_padded(const scene::Extent& box, RTCBounds& out) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const auto down = [&](double x) {
    return std::nextafter(std::nextafter(static_cast<float>(x), -kInfinity), -kInfinity);
  };
  const auto up = [&](double x) {
    return std::nextafter(std::nextafter(static_cast<float>(x), kInfinity), kInfinity);
  };
  out.lower_x = down(box.low.x);
  out.lower_y = down(box.low.y);
  out.lower_z = down(box.low.z);
  out.upper_x = up(box.high.x);
  out.upper_y = up(box.high.y);
  out.upper_z = up(box.high.z);
}

void bound(const RTCBoundsFunctionArguments* args) {
  const auto& shapes = *static_cast<const AnalyticShapes*>(args->geometryUserPtr);
  const std::size_t i = args->primID;
  const std::size_t spheres = shapes.spheres.size();
  copy_padded(i < spheres ? scene::extent(shapes.spheres[i]) : scene::extent(shapes.discs[i - spheres]),
              *args->bounds_o);
}

std::optional<Crossing> crossing_of(const AnalyticShapes& shapes, std::size_t i, RTCRayN* ray, unsigned int n,
                                    unsigned int k) {
  const Vec3d origin(RTCRayN_org_x(ray, n, k), RTCRayN_org_y(ray, n, k), RTCRayN_org_z(ray, n, k));
  const Vec3d direction(RTCRayN_dir_x(ray, n, k), RTCRayN_dir_y(ray, n, k), RTCRayN_dir_z(ray, n, k));
  const double limit = RTCRayN_tfar(ray, n, k);
  if (limit < 0.0) return std::nullopt;  // Embree's mark for a ray that is done
  const std::size_t spheres = shapes.spheres.size();
  return i < spheres ? crossing(shapes.spheres[i], origin, direction, limit)
                     : crossing(shapes.discs[i - spheres], origin, direction, limit);
}

void intersect(const RTCIntersectFunctionNArguments* args) {
  const auto& shapes = *static_cast<const AnalyticShapes*>(args->geometryUserPtr);
  const unsigned int n = args->N;
  RTCRayN* ray = RTCRayHitN_RayN(args->rayhit, n);
  RTCHitN* hit = RTCRayHitN_HitN(args->rayhit, n);
  for (unsigned int k = 0; k < n; ++k) {
    if (args->valid[k] == 0) continue;
    const std::optional<Crossing> met = crossing_of(shapes, args->primID, ray, n, k);
    if (!met) continue;
    RTCRayN_tfar(ray, n, k) = static_cast<float>(met->distance);
    RTCHitN_u(hit, n, k) = met->coordinates.x;
    RTCHitN_v(hit, n, k) = met->coordinates.y;
    RTCHitN_primID(hit, n, k) = shapes.first_surface + args->primID;
    RTCHitN_geomID(hit, n, k) = args->geomID;
  }
}

void occlude(const RTCOccludedFunctionNArguments* args) {
  const auto& shapes = *static_cast<const AnalyticShapes*>(args->geometryUserPtr);
  for (unsigned int k = 0; k < args->N; ++k) {
    if (args->valid[k] == 0) continue;
    if (crossing_of(shapes, args->primID, args->ray, args->N, k)) {
      RTCRayN_tfar(args->ray, args->N, k) = -std::numeric_limits<float>::infinity();
    }
  }
}

}  // namespace

void attach_analytic_shapes(RTCDevice device, RTCScene hierarchy, AnalyticShapes& shapes) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry,
                                   static_cast<unsigned int>(shapes.spheres.size() + shapes.discs.size()));
  rtcSetGeometryUserData(geometry, &shapes);
  rtcSetGeometryBoundsFunction(geometry, bound, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect);
  rtcSetGeometryOccludedFunction(geometry, occlude);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(hierarchy, geometry);
  rtcReleaseGeometry(geometry);
}

}  // namespace plumbline::trace
