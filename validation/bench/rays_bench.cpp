// validation/bench/rays_bench.cpp: rays per second of bare Embree loops, of trace::RayCaster, and of the renderer itself.
//
// Rows: rays/SCENE/SET/CALL/THREADS, counter Mrays/s. Sets: primary (4 x 4 tiles, coherent), first_bounce (closest hit, cosine
// directions at the primary hits, pixel order), occlusion (the same rays, any hit), hemisphere (256 rays from each vertex, any hit).
// rays/SCENE/render and rays/SCENE/gather trace, interleaved: the integrator, then the very rays it asked for (recorded once), bare,
// in several call forms. `ratio` is the integrator's ray rate over that of the best form.
//
// The rays are counted and recorded by the linker's --wrap (CMakeLists.txt): every rtcIntersect… and rtcOccluded… of this process
// passes through here, whoever calls it. Nothing is compiled into the renderer for it; bare loops pass the same way.
#include <benchmark/benchmark.h>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#define PLUMBLINE_EMBREE 4
#else
#include <embree3/rtcore.h>
#define PLUMBLINE_EMBREE 3
#endif

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "reference/base/error.hpp"
#include "reference/base/parallel.hpp"
#include "reference/integrate/gather.hpp"
#include "reference/integrate/hemisphere.hpp"
#include "reference/integrate/render.hpp"
#include "reference/scene/camera.hpp"
#include "validation/study/preset.hpp"

namespace {

using namespace plumbline;
using trace::Ray;

// ---------------------------------------------------------------- recording

struct Recording {
  std::vector<Ray> closest;
  std::vector<Ray> any;
};
Recording* recording = nullptr;  // written by one thread only: integrators are recorded on one

void note(const RTCRay& ray, bool is_any) {
  if (recording == nullptr) [[likely]]
    return;
  (is_any ? recording->any : recording->closest)
      .push_back({{ray.org_x, ray.org_y, ray.org_z}, {ray.dir_x, ray.dir_y, ray.dir_z}, ray.tfar});
}

template <int N, class Rays>
void note_packet(const int* valid, const Rays& rays, bool is_any) {
  if (recording == nullptr) [[likely]]
    return;
  for (int k = 0; k < N; ++k) {
    if (valid[k] == 0) continue;
    (is_any ? recording->any : recording->closest)
        .push_back({{rays.org_x[k], rays.org_y[k], rays.org_z[k]},
                    {rays.dir_x[k], rays.dir_y[k], rays.dir_z[k]},
                    rays.tfar[k]});
  }
}

}  // namespace

// Embree 3 hands a context in front of the query, Embree 4 arguments behind it; streams are Embree 3's only.
#if PLUMBLINE_EMBREE == 4
#define PLUMBLINE_WRAP_SINGLE(NAME, ARGUMENTS, QUERY, RAY, IS_ANY)         \
  void __real_##NAME(RTCScene, QUERY*, ARGUMENTS*);                        \
  void __wrap_##NAME(RTCScene scene, QUERY* query, ARGUMENTS* arguments) { \
    note(RAY, IS_ANY);                                                     \
    __real_##NAME(scene, query, arguments);                                \
  }
#define PLUMBLINE_WRAP_PACKET(NAME, N, ARGUMENTS, QUERY, RAY, IS_ANY)                        \
  void __real_##NAME(const int*, RTCScene, QUERY*, ARGUMENTS*);                              \
  void __wrap_##NAME(const int* valid, RTCScene scene, QUERY* query, ARGUMENTS* arguments) { \
    note_packet<N>(valid, RAY, IS_ANY);                                                      \
    __real_##NAME(valid, scene, query, arguments);                                           \
  }
#else
#define PLUMBLINE_WRAP_SINGLE(NAME, ARGUMENTS, QUERY, RAY, IS_ANY)                 \
  void __real_##NAME(RTCScene, RTCIntersectContext*, QUERY*);                      \
  void __wrap_##NAME(RTCScene scene, RTCIntersectContext* context, QUERY* query) { \
    note(RAY, IS_ANY);                                                             \
    __real_##NAME(scene, context, query);                                          \
  }
#define PLUMBLINE_WRAP_PACKET(NAME, N, ARGUMENTS, QUERY, RAY, IS_ANY)                                \
  void __real_##NAME(const int*, RTCScene, RTCIntersectContext*, QUERY*);                            \
  void __wrap_##NAME(const int* valid, RTCScene scene, RTCIntersectContext* context, QUERY* query) { \
    note_packet<N>(valid, RAY, IS_ANY);                                                              \
    __real_##NAME(valid, scene, context, query);                                                     \
  }
#define PLUMBLINE_WRAP_STREAM(NAME, QUERY, RAY, IS_ANY)                                                \
  void __real_##NAME(RTCScene, RTCIntersectContext*, QUERY*, unsigned int, std::size_t);               \
  void __wrap_##NAME(RTCScene scene, RTCIntersectContext* context, QUERY* queries, unsigned int count, \
                     std::size_t stride) {                                                             \
    for (unsigned int k = 0; recording != nullptr && k < count; ++k) {                                 \
      const QUERY* query = reinterpret_cast<QUERY*>(reinterpret_cast<char*>(queries) + k * stride);    \
      note(RAY, IS_ANY);                                                                               \
    }                                                                                                  \
    __real_##NAME(scene, context, queries, count, stride);                                             \
  }
#endif

extern "C" {
PLUMBLINE_WRAP_SINGLE(rtcIntersect1, RTCIntersectArguments, RTCRayHit, query->ray, false)
PLUMBLINE_WRAP_SINGLE(rtcOccluded1, RTCOccludedArguments, RTCRay, *query, true)
PLUMBLINE_WRAP_PACKET(rtcIntersect4, 4, RTCIntersectArguments, RTCRayHit4, query->ray, false)
PLUMBLINE_WRAP_PACKET(rtcIntersect8, 8, RTCIntersectArguments, RTCRayHit8, query->ray, false)
PLUMBLINE_WRAP_PACKET(rtcIntersect16, 16, RTCIntersectArguments, RTCRayHit16, query->ray, false)
PLUMBLINE_WRAP_PACKET(rtcOccluded4, 4, RTCOccludedArguments, RTCRay4, *query, true)
PLUMBLINE_WRAP_PACKET(rtcOccluded8, 8, RTCOccludedArguments, RTCRay8, *query, true)
PLUMBLINE_WRAP_PACKET(rtcOccluded16, 16, RTCOccludedArguments, RTCRay16, *query, true)
#if PLUMBLINE_EMBREE == 3
PLUMBLINE_WRAP_STREAM(rtcIntersect1M, RTCRayHit, query->ray, false)
PLUMBLINE_WRAP_STREAM(rtcOccluded1M, RTCRay, *query, true)
#endif
}

namespace {

// ---------------------------------------------------------------- bare Embree

/// What goes with a query beside the rays, for both versions of Embree.
class Asking {
 public:
  explicit Asking(bool is_coherent) {
#if PLUMBLINE_EMBREE == 4
    rtcInitIntersectArguments(&intersect_);
    rtcInitOccludedArguments(&occluded_);
    if (is_coherent) intersect_.flags = occluded_.flags = RTC_RAY_QUERY_FLAG_COHERENT;
#else
    rtcInitIntersectContext(&context_);
    if (is_coherent) context_.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
#endif
  }
#if PLUMBLINE_EMBREE == 4
#define PLUMBLINE_ASK(NAME, VALID, SCENE, QUERY, ARGUMENTS) NAME(VALID SCENE, QUERY, &ARGUMENTS)
#else
#define PLUMBLINE_ASK(NAME, VALID, SCENE, QUERY, ARGUMENTS) NAME(VALID SCENE, &context_, QUERY)
#endif
  void operator()(RTCScene s, RTCRayHit& q) {
    PLUMBLINE_ASK(rtcIntersect1, , s, &q, intersect_);
  }
  void operator()(RTCScene s, RTCRay& q) {
    PLUMBLINE_ASK(rtcOccluded1, , s, &q, occluded_);
  }
#define PLUMBLINE_COMMA ,
  void operator()(RTCScene s, RTCRayHit4& q) {
    PLUMBLINE_ASK(rtcIntersect4, kAll PLUMBLINE_COMMA, s, &q, intersect_);
  }
  void operator()(RTCScene s, RTCRayHit8& q) {
    PLUMBLINE_ASK(rtcIntersect8, kAll PLUMBLINE_COMMA, s, &q, intersect_);
  }
  void operator()(RTCScene s, RTCRayHit16& q) {
    PLUMBLINE_ASK(rtcIntersect16, kAll PLUMBLINE_COMMA, s, &q, intersect_);
  }
  void operator()(RTCScene s, RTCRay4& q) {
    PLUMBLINE_ASK(rtcOccluded4, kAll PLUMBLINE_COMMA, s, &q, occluded_);
  }
  void operator()(RTCScene s, RTCRay8& q) {
    PLUMBLINE_ASK(rtcOccluded8, kAll PLUMBLINE_COMMA, s, &q, occluded_);
  }
  void operator()(RTCScene s, RTCRay16& q) {
    PLUMBLINE_ASK(rtcOccluded16, kAll PLUMBLINE_COMMA, s, &q, occluded_);
  }
#if PLUMBLINE_EMBREE == 3
  void operator()(RTCScene s, RTCRayHit* q, unsigned n) {
    rtcIntersect1M(s, &context_, q, n, sizeof(*q));
  }
  void operator()(RTCScene s, RTCRay* q, unsigned n) {
    rtcOccluded1M(s, &context_, q, n, sizeof(*q));
  }
#endif

 private:
  alignas(64) static constexpr int kAll[16] = {-1, -1, -1, -1, -1, -1, -1, -1,
                                               -1, -1, -1, -1, -1, -1, -1, -1};
#if PLUMBLINE_EMBREE == 4
  RTCIntersectArguments intersect_;
  RTCOccludedArguments occluded_;
#else
  RTCIntersectContext context_;
#endif
};

/// Embree's own hierarchy over a scene, default quality.
class BareScene {
 public:
  explicit BareScene(const scene::Scene& scene)
      : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* positions = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                              sizeof(Vec3), scene.positions.size());
    std::memcpy(positions, scene.positions.data(), scene.positions.size() * sizeof(Vec3));
    void* triangles = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                              sizeof(glm::uvec3), scene.triangles.size());
    std::memcpy(triangles, scene.triangles.data(), scene.triangles.size() * sizeof(glm::uvec3));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~BareScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  BareScene(const BareScene&) = delete;
  BareScene& operator=(const BareScene&) = delete;
  [[nodiscard]] RTCScene get() const { return scene_; }

 private:
  RTCDevice device_;
  RTCScene scene_;
};

void put(const Ray& ray, RTCRay& out) {
  out.org_x = ray.origin.x;
  out.org_y = ray.origin.y;
  out.org_z = ray.origin.z;
  out.tnear = 0.0F;
  out.dir_x = ray.direction.x;
  out.dir_y = ray.direction.y;
  out.dir_z = ray.direction.z;
  out.time = 0.0F;
  out.tfar = ray.max_distance;
  out.mask = 0xFFFFFFFFU;
  out.id = 0;
  out.flags = 0;
}
void put(const Ray& ray, RTCRayHit& out) {
  put(ray, out.ray);
  out.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  out.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
}
template <class Packet>
void put_lane(const Ray& ray, std::size_t k, Packet& out) {
  if constexpr (requires { out.hit; }) {
    put_lane(ray, k, out.ray);
    out.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
    out.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
  } else {
    out.org_x[k] = ray.origin.x;
    out.org_y[k] = ray.origin.y;
    out.org_z[k] = ray.origin.z;
    out.tnear[k] = 0.0F;
    out.dir_x[k] = ray.direction.x;
    out.dir_y[k] = ray.direction.y;
    out.dir_z[k] = ray.direction.z;
    out.time[k] = 0.0F;
    out.tfar[k] = ray.max_distance;
    out.mask[k] = 0xFFFFFFFFU;
    out.id[k] = 0;
    out.flags[k] = 0;
  }
}

std::size_t is_hit(const RTCRay& query) {
  return query.tfar < 0.0F ? 1 : 0;
}
std::size_t is_hit(const RTCRayHit& query) {
  return query.hit.geomID != RTC_INVALID_GEOMETRY_ID ? 1 : 0;
}
template <class Packet>
std::size_t is_lane_hit(const Packet& query, std::size_t k) {
  if constexpr (requires { query.hit; }) {
    return query.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID ? 1 : 0;
  } else {
    return query.tfar[k] < 0.0F ? 1 : 0;
  }
}

// Each of these traces a chunk of rays and returns how many hit something.

template <class Query>
std::size_t trace_singly(RTCScene scene, std::span<const Ray> rays, bool is_coherent) {
  Asking ask(is_coherent);
  std::size_t hits = 0;
  for (const Ray& ray : rays) {
    Query query;
    put(ray, query);
    ask(scene, query);
    hits += is_hit(query);
  }
  return hits;
}

template <class Packet, std::size_t N, class Single>
std::size_t trace_packets(RTCScene scene, std::span<const Ray> rays, bool is_coherent) {
  Asking ask(is_coherent);
  std::size_t hits = 0;
  std::size_t first = 0;
  for (; first + N <= rays.size(); first += N) {
    Packet query;
    for (std::size_t k = 0; k < N; ++k) put_lane(rays[first + k], k, query);
    ask(scene, query);
    for (std::size_t k = 0; k < N; ++k) hits += is_lane_hit(query, k);
  }
  return hits + trace_singly<Single>(scene, rays.subspan(first), is_coherent);
}

#if PLUMBLINE_EMBREE == 3
constexpr std::size_t kStream = 256;

template <class Query>
std::size_t trace_streams(RTCScene scene, std::span<const Ray> rays, bool is_coherent) {
  Asking ask(is_coherent);
  std::size_t hits = 0;
  std::array<Query, kStream> queries;
  for (std::size_t first = 0; first < rays.size(); first += kStream) {
    const std::size_t count = std::min(kStream, rays.size() - first);
    for (std::size_t k = 0; k < count; ++k) put(rays[first + k], queries[k]);
    ask(scene, queries.data(), static_cast<unsigned>(count));
    for (std::size_t k = 0; k < count; ++k) hits += is_hit(queries[k]);
  }
  return hits;
}
#endif

using Tracer = std::size_t (*)(RTCScene scene, std::span<const Ray> rays, bool is_coherent);
struct Form {
  const char* name;
  Tracer closest;
  Tracer any;
};
constexpr Form kForms[] = {
    {"1", trace_singly<RTCRayHit>, trace_singly<RTCRay>},
    {"x4", trace_packets<RTCRayHit4, 4, RTCRayHit>, trace_packets<RTCRay4, 4, RTCRay>},
    {"x8", trace_packets<RTCRayHit8, 8, RTCRayHit>, trace_packets<RTCRay8, 8, RTCRay>},
    {"x16", trace_packets<RTCRayHit16, 16, RTCRayHit>, trace_packets<RTCRay16, 16, RTCRay>},
#if PLUMBLINE_EMBREE == 3
    {"1M", trace_streams<RTCRayHit>, trace_streams<RTCRay>},
#endif
};

// ---------------------------------------------------------------- scenes and their rays

constexpr int kSide = 512;
constexpr int kTile = 4;
constexpr std::uint32_t kHemisphere = 256;
constexpr std::size_t kChunk = 4096;

/// Everything about a scene that the rows share.
struct Stage {
  explicit Stage(study::Preset preset)
      : world(std::move(preset.scene), light::load_environment(preset.environment)), bare(world.scene) {}
  integrate::World world;
  BareScene bare;
  std::vector<trace::SurfacePoint> vertices;  // some, in runs of neighbours
  std::vector<Ray> primary, first_bounce, hemisphere;
};

std::vector<Ray> primary_rays(const scene::Camera& camera, int tile) {
  std::vector<Ray> rays;
  for (int y0 = 0; y0 < kSide; y0 += tile)
    for (int x0 = 0; x0 < kSide; x0 += tile)
      for (int k = 0; k < tile * tile; ++k) {
        const auto x = static_cast<float>(x0 + k % tile) + 0.5F;
        const auto y = static_cast<float>(y0 + k / tile) + 0.5F;
        rays.push_back({camera.eye, scene::ray_direction(camera, x, y, kSide, kSide)});
      }
  return rays;
}

Ray cosine_ray(const trace::SurfacePoint& point, std::uint64_t stream, std::uint32_t index) {
  integrate::Sampler sampler(1, stream, 0, index);
  const Vec3 direction = integrate::sample_cosine_hemisphere(point.geometric_normal, sampler.next_2d());
  return {trace::ray_origin(point, direction), direction};
}

/// 2048 vertices at most, as 64 runs of 32 that follow each other in the file.
std::vector<trace::SurfacePoint> some_vertices(const scene::Scene& scene) {
  constexpr std::size_t kRuns = 64, kRun = 32;
  std::vector<trace::SurfacePoint> all = trace::vertex_points(scene);
  if (all.size() <= kRuns * kRun) return all;
  std::vector<trace::SurfacePoint> some;
  for (std::size_t run = 0; run < kRuns; ++run) {
    const std::size_t first = run * (all.size() - kRun) / (kRuns - 1);
    some.insert(some.end(), all.begin() + static_cast<std::ptrdiff_t>(first),
                all.begin() + static_cast<std::ptrdiff_t>(first + kRun));
  }
  return some;
}

void add_rays(const scene::Scene& vertex_scene, Stage& stage) {
  const scene::Camera& camera = stage.world.scene.cameras.front();
  stage.primary = primary_rays(camera, kTile);
  std::uint64_t pixel = 0;
  for (const Ray& ray : primary_rays(camera, 1)) {
    ++pixel;
    const std::optional<trace::Hit> hit = stage.world.caster.closest_hit(ray);
    if (!hit) continue;
    stage.first_bounce.push_back(
        cosine_ray(trace::surface_hit(stage.world.scene, *hit, ray.direction).point, pixel, 0));
  }
  stage.vertices = some_vertices(vertex_scene);
  for (std::size_t v = 0; v < stage.vertices.size(); ++v)
    for (std::uint32_t k = 0; k < kHemisphere; ++k)
      stage.hemisphere.push_back(cosine_ray(stage.vertices[v], v, k));
}

/// Made on first use and kept; nullptr where the data is missing.
const Stage* stage_of(const std::string& name, benchmark::State& state) {
  static std::map<std::string, std::unique_ptr<Stage>> stages;
  std::unique_ptr<Stage>& stage = stages[name];
  if (stage) return stage.get();
  try {
    stage = std::make_unique<Stage>(study::make_preset(name));
    // A flat mesh repeats its vertices once a face; points to gather at are the mesh's own.
    add_rays(name == "bunny" ? study::make_bunny_on_ground(180.0F) : stage->world.scene, *stage);
  } catch (const InputError& error) {
    state.SkipWithError(error.what());
    return nullptr;
  }
  return stage.get();
}

// ---------------------------------------------------------------- rows

/// body(chunk of rays) on `threads` threads. @return the hits.
std::size_t in_chunks(std::span<const Ray> rays, int threads,
                      const std::function<std::size_t(std::span<const Ray>)>& body) {
  const std::size_t chunks = (rays.size() + kChunk - 1) / kChunk;
  std::vector<std::size_t> hits(chunks, 0);
  parallel_for(chunks, threads, [&](std::size_t i) {
    hits[i] = body(rays.subspan(i * kChunk, std::min(kChunk, rays.size() - i * kChunk)));
  });
  std::size_t sum = 0;
  for (const std::size_t count : hits) sum += count;
  return sum;
}

struct Set {
  const char* name;
  std::vector<Ray> Stage::*rays;
  bool is_any;
  bool is_coherent;
  std::vector<std::string> forms;
};
const std::vector<Set> kSets = {{"primary", &Stage::primary, false, true, {"1", "x8", "x16"}},
                                {"first_bounce", &Stage::first_bounce, false, false, {"1", "x4", "x8", "1M"}},
                                {"occlusion", &Stage::first_bounce, true, false, {"1", "x8", "1M"}},
                                {"hemisphere", &Stage::hemisphere, true, false, {"1", "1M"}}};

std::size_t trace_with_caster(const trace::RayCaster& caster, std::span<const Ray> rays, bool is_any) {
  std::size_t hits = 0;
  for (const Ray& ray : rays) {
    if (is_any ? caster.is_occluded(ray) : caster.closest_hit(ray).has_value()) ++hits;
  }
  return hits;
}

/// `form` nullptr = trace::RayCaster.
void run_row(benchmark::State& state, const std::string& name, const Set& set, const Form* form,
             int threads) {
  const Stage* stage = stage_of(name, state);
  if (stage == nullptr) return;
  const std::vector<Ray>& rays = stage->*set.rays;
  std::size_t hits = 0;
  for (auto _ : state) {
    hits = in_chunks(rays, threads, [&](std::span<const Ray> chunk) {
      if (form == nullptr) return trace_with_caster(stage->world.caster, chunk, set.is_any);
      return (set.is_any ? form->any : form->closest)(stage->bare.get(), chunk, set.is_coherent);
    });
  }
  const auto count = static_cast<double>(rays.size());
  state.counters["Mrays/s"] = benchmark::Counter(count * 1e-6, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["hit"] = static_cast<double>(hits) / count;
}

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

/// `integrate(threads)` traces; its rays are recorded on one thread, then both are timed in turn.
void run_ratio(benchmark::State& state, const Stage& stage, int threads,
               const std::function<void(int threads)>& integrate) {
  Recording rays;
  recording = &rays;
  integrate(1);
  recording = nullptr;
  const double count = static_cast<double>(rays.closest.size() + rays.any.size());
  std::vector<double> own;
  std::map<std::string, std::vector<double>> bare;
  const Form& single = kForms[0];
  const auto replay = [&](const std::vector<Ray>& list, Tracer tracer) {
    return seconds_of([&] {
      in_chunks(list, threads,
                [&](std::span<const Ray> chunk) { return tracer(stage.bare.get(), chunk, false); });
    });
  };
  for (auto _ : state) {
    own.push_back(seconds_of([&] { integrate(threads); }));
    state.SetIterationTime(own.back());
    const double closest = replay(rays.closest, single.closest);
    for (const Form& form : kForms) bare[form.name].push_back(closest + replay(rays.any, form.any));
  }
  double best = 0.0;
  for (const auto& [form, seconds] : bare) {
    const double rate = count * 1e-6 / median(seconds);
    state.counters["bare " + form] = rate;
    best = std::max(best, rate);
  }
  const double rate = count * 1e-6 / median(own);
  state.counters["Mrays/s"] = rate;
  state.counters["ratio"] = rate / best;
  state.counters["Mrays"] = count * 1e-6;
  state.counters["any"] = static_cast<double>(rays.any.size()) / count;
}

void run_render(benchmark::State& state, const std::string& name, int threads) {
  const Stage* stage = stage_of(name, state);
  if (stage == nullptr) return;
  run_ratio(state, *stage, threads, [&](int used) {
    integrate::RenderSettings settings;
    settings.samples_per_pixel = 4;
    settings.max_bounces = 8;
    settings.threads = used;
    benchmark::DoNotOptimize(integrate::render(stage->world, stage->world.scene.cameras.front(), settings));
  });
}

void run_gather(benchmark::State& state, const std::string& name, int threads) {
  const Stage* stage = stage_of(name, state);
  if (stage == nullptr) return;
  // As many points for a scene of few vertices, so that the work is alike.
  std::vector<trace::SurfacePoint> points;
  while (points.size() < 2048) points.insert(points.end(), stage->vertices.begin(), stage->vertices.end());
  run_ratio(state, *stage, threads, [&](int used) {
    integrate::GatherSettings settings;
    settings.samples = 64;
    settings.max_bounces = 8;
    settings.threads = used;
    benchmark::DoNotOptimize(integrate::gather_irradiance(stage->world, points, settings));
  });
}

int register_rows() {
  const auto add = [](const std::string& name, const auto& body) {
    return benchmark::RegisterBenchmark(name.c_str(), body)->Unit(benchmark::kMillisecond);
  };
  for (const std::string& scene : study::preset_names()) {
    for (const int threads : {1, 2}) {
      for (const Set& set : kSets) {
        for (const Form& form : kForms) {
          if (std::find(set.forms.begin(), set.forms.end(), form.name) == set.forms.end()) continue;
          add(fmt::format("rays/{}/{}/{}/threads:{}", scene, set.name, form.name, threads),
              [=, &set, &form](benchmark::State& state) { run_row(state, scene, set, &form, threads); })
              ->UseRealTime();
        }
        add(fmt::format("rays/{}/{}/caster/threads:{}", scene, set.name, threads),
            [=, &set](benchmark::State& state) { run_row(state, scene, set, nullptr, threads); })
            ->UseRealTime();
      }
      add(fmt::format("rays/{}/render/threads:{}", scene, threads),
          [=](benchmark::State& state) { run_render(state, scene, threads); })
          ->UseManualTime()
          ->Iterations(5);
      add(fmt::format("rays/{}/gather/threads:{}", scene, threads),
          [=](benchmark::State& state) { run_gather(state, scene, threads); })
          ->UseManualTime()
          ->Iterations(5);
    }
  }
  return 0;
}
const int kRegistered = register_rows();

}  // namespace
