#include "reference/trace/ray_caster.hpp"

#include <algorithm>
#include <cstring>
#include <string>

#include "reference/base/error.hpp"
#include "reference/trace/analytic_geometry.hpp"
#include "reference/trace/embree.hpp"

namespace plumbline::trace {
namespace {

// Embree's own error codes as one line. No exception may pass through its C frames, so every call is followed
// by this.
void throw_on_error(RTCDevice device, const char* where) {
  const RTCError error = rtcGetDeviceError(device);
  if (error == RTC_ERROR_NONE) return;
  const char* reason = error == RTC_ERROR_OUT_OF_MEMORY     ? "out of memory"
                       : error == RTC_ERROR_UNSUPPORTED_CPU ? "this processor is not supported"
                       : error == RTC_ERROR_CANCELLED       ? "cancelled"
                                                            : "invalid use";
  throw DeviceError(std::string("Embree: ") + where + ": " + reason);
}

RTCRay make_ray(const Ray& ray) {
  RTCRay result;
  result.org_x = ray.origin.x;
  result.org_y = ray.origin.y;
  result.org_z = ray.origin.z;
  result.tnear = 0.0F;
  result.dir_x = ray.direction.x;
  result.dir_y = ray.direction.y;
  result.dir_z = ray.direction.z;
  result.time = 0.0F;
  result.tfar = ray.max_distance;
  result.mask = 0xFFFFFFFFU;
  result.id = 0;
  result.flags = 0;
  return result;
}

// Embree reads shared vertex buffers in 16-byte steps, so it gets its own padded copy.
void copy_positions(RTCGeometry geometry, const scene::Scene& scene) {
  auto* out = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), scene.positions.size()));
  if (out == nullptr) throw DeviceError("Embree: vertices: out of memory");
  std::memcpy(out, scene.positions.data(), scene.positions.size() * sizeof(Vec3));
}

void copy_triangles(RTCGeometry geometry, const scene::Scene& scene) {
  auto* out = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                                                  RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t),
                                                                  scene.triangles.size()));
  if (out == nullptr) throw DeviceError("Embree: triangles: out of memory");
  std::memcpy(out, scene.triangles.data(), scene.triangles.size() * sizeof(glm::uvec3));
}

void attach_triangles(RTCDevice device, RTCScene hierarchy, const scene::Scene& scene) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  copy_positions(geometry, scene);
  copy_triangles(geometry, scene);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(hierarchy, geometry);
  rtcReleaseGeometry(geometry);
}

}  // namespace

struct RayCaster::Impl {
  AnalyticShapes shapes;
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

RayCaster::RayCaster(const scene::Scene& scene) : impl_(std::make_unique<Impl>()) {
  impl_->device = rtcNewDevice(nullptr);
  if (impl_->device == nullptr) throw_on_error(nullptr, "device");
  impl_->scene = rtcNewScene(impl_->device);
  throw_on_error(impl_->device, "scene");
  if (!scene.triangles.empty()) attach_triangles(impl_->device, impl_->scene, scene);
  if (scene::primitive_count(scene) > 0) {
    impl_->shapes = {scene.spheres, scene.discs, static_cast<std::uint32_t>(scene.triangles.size())};
    // The boxes are tight around curved surfaces: the faster traversal may miss one that a ray only grazes.
    rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);
    attach_analytic_shapes(impl_->device, impl_->scene, impl_->shapes);
  }
  rtcCommitScene(impl_->scene);
  throw_on_error(impl_->device, "building the hierarchy");
}

RayCaster::~RayCaster() = default;
RayCaster::RayCaster(RayCaster&&) noexcept = default;
RayCaster& RayCaster::operator=(RayCaster&&) noexcept = default;

std::optional<Hit> RayCaster::closest_hit(const Ray& ray) const {
  RTCRayHit query;
  query.ray = make_ray(ray);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
#if PLUMBLINE_EMBREE == 4
  rtcIntersect1(impl_->scene, &query);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(impl_->scene, &context, &query);
#endif
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return Hit{query.hit.primID, Vec2(query.hit.u, query.hit.v), query.ray.tfar};
}

std::uint32_t RayCaster::occluded(std::span<const Ray> rays) const {
  constexpr int kActive = -1;
  alignas(32) int active[kMostTogether] = {};
  RTCRay8 query;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    active[i] = kActive;
    query.org_x[i] = rays[i].origin.x;
    query.org_y[i] = rays[i].origin.y;
    query.org_z[i] = rays[i].origin.z;
    query.tnear[i] = 0.0F;
    query.dir_x[i] = rays[i].direction.x;
    query.dir_y[i] = rays[i].direction.y;
    query.dir_z[i] = rays[i].direction.z;
    query.time[i] = 0.0F;
    query.tfar[i] = rays[i].max_distance;
    query.mask[i] = 0xFFFFFFFFU;
    query.id[i] = 0;
    query.flags[i] = 0;
  }
#if PLUMBLINE_EMBREE == 4
  rtcOccluded8(active, impl_->scene, &query);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded8(active, impl_->scene, &context, &query);
#endif
  std::uint32_t result = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) result |= query.tfar[i] < 0.0F ? 1U << i : 0U;
  return result;
}

#if PLUMBLINE_EMBREE == 4

// Packets of 8 that share their origin.
void RayCaster::occluded_from(const Vec3& origin, const DirectionArrays& directions,
                              std::uint8_t* is_hit) const {
  for (std::size_t first = 0; first < directions.count; first += kMostTogether) {
    const std::size_t count = std::min(kMostTogether, directions.count - first);
    Ray rays[kMostTogether];
    for (std::size_t k = 0; k < count; ++k) {
      rays[k] = {origin, {directions.x[first + k], directions.y[first + k], directions.z[first + k]}};
    }
    const std::uint32_t bits = occluded({rays, count});
    for (std::size_t k = 0; k < count; ++k) is_hit[first + k] = (bits >> k & 1U) != 0 ? 1 : 0;
  }
}

void RayCaster::closest_from(const Vec3& origin, const DirectionArrays& directions, Hit* hits) const {
  for (std::size_t k = 0; k < directions.count; ++k) {
    hits[k] =
        closest_hit({origin, {directions.x[k], directions.y[k], directions.z[k]}}).value_or(Hit{kNoSurface});
  }
}

#else

void RayCaster::occluded_from(const Vec3& origin, const DirectionArrays& directions,
                              std::uint8_t* is_hit) const {
  constexpr std::size_t kStream = 256;
  RTCRay queries[kStream];
  const RTCRay blank = make_ray({origin, Vec3(0.0F)});
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (std::size_t first = 0; first < directions.count; first += kStream) {
    const std::size_t count = std::min(kStream, directions.count - first);
    for (std::size_t k = 0; k < count; ++k) {
      queries[k] = blank;
      queries[k].dir_x = directions.x[first + k];
      queries[k].dir_y = directions.y[first + k];
      queries[k].dir_z = directions.z[first + k];
    }
    rtcOccluded1M(impl_->scene, &context, queries, static_cast<unsigned>(count), sizeof(RTCRay));
    for (std::size_t k = 0; k < count; ++k) is_hit[first + k] = queries[k].tfar < 0.0F ? 1 : 0;
  }
}

void RayCaster::closest_from(const Vec3& origin, const DirectionArrays& directions, Hit* hits) const {
  constexpr std::size_t kStream = 256;
  RTCRayHit queries[kStream];
  RTCRayHit blank;
  blank.ray = make_ray({origin, Vec3(0.0F)});
  blank.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  blank.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (std::size_t first = 0; first < directions.count; first += kStream) {
    const std::size_t count = std::min(kStream, directions.count - first);
    for (std::size_t k = 0; k < count; ++k) {
      queries[k] = blank;
      queries[k].ray.dir_x = directions.x[first + k];
      queries[k].ray.dir_y = directions.y[first + k];
      queries[k].ray.dir_z = directions.z[first + k];
    }
    rtcIntersect1M(impl_->scene, &context, queries, static_cast<unsigned>(count), sizeof(RTCRayHit));
    for (std::size_t k = 0; k < count; ++k) {
      const RTCRayHit& query = queries[k];
      const bool is_hit = query.hit.geomID != RTC_INVALID_GEOMETRY_ID;
      hits[first + k] = {is_hit ? query.hit.primID : kNoSurface, Vec2(query.hit.u, query.hit.v),
                         query.ray.tfar};
    }
  }
}

#endif

bool RayCaster::is_occluded(const Ray& ray) const {
  RTCRay query = make_ray(ray);
#if PLUMBLINE_EMBREE == 4
  rtcOccluded1(impl_->scene, &query);
#else
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(impl_->scene, &context, &query);
#endif
  return query.tfar < 0.0F;  // Embree's mark for "something is in the way"
}

}  // namespace plumbline::trace
