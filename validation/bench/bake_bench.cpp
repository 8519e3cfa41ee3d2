// validation/bench/bake_bench.cpp: what a bake costs.
//
// bake/bunny/rays/threads:N        a shadowed bake of the bunny in turn with bare Embree loops over the same kind of rays: one-vertex
//                                  bundles, in several call forms. `ratio` is the bake's rays per second over the best form's.
// bake/bunny/bounces/threads:N     interreflected bakes of 3 bounces, both solvers, over the shadowed bake at equal samples
// bake/error/SCENE/…/samples:N     seconds and root mean square error of the coefficients; `gain` is how many times longer the papers'
//                                  directions (one stratified grid on the sphere, shared by all vertices) take to the same error with
//                                  the same rays and sums, `gain on loop` the papers' loop over them, a ray at a time
// bake/skip/SCENE                  what the plan saves (design: at least 10 on a convex mesh)
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
#include <chrono>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "prt/sh/basis.hpp"
#include "prt/transfer/bake.hpp"
#include "prt/transfer/direction_sampler.hpp"
#include "prt/transfer/directions.hpp"
#include "reference/base/error.hpp"
#include "reference/base/parallel.hpp"
#include "reference/scene/builtin.hpp"
#include "reference/scene/shapes.hpp"
#include "validation/study/preset.hpp"

namespace {

using namespace plumbline;
using transfer::BakeSettings;
using transfer::Kind;
using transfer::Solver;
using transfer::Transfer;

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// "bunny" (needs glmark2-data), "ball" (smooth, 10,242 vertices), "faceted-ball", or a built-in scene.
scene::Scene make_scene(const std::string& name) {
  if (name == "bunny") return study::make_bunny_on_ground(180.0F);
  if (name == "ball" || name == "faceted-ball") {
    scene::Scene scene;
    const scene::Mesh ball = scene::make_icosphere(5);
    scene::append(scene, name == "ball" ? ball : scene::faceted(ball), scene::add_material(scene, {}));
    return scene;
  }
  return scene::make_builtin_scene(name);
}

/// body(scene) unless data is missing.
void with_scene(benchmark::State& state, const std::string& name,
                const std::function<void(const scene::Scene&)>& body) {
  try {
    body(make_scene(name));
  } catch (const InputError& error) {
    state.SkipWithError(error.what());
  }
}

BakeSettings settings_of(Kind kind, int samples, int threads) {
  BakeSettings settings;
  settings.kind = kind;
  settings.samples = samples;
  settings.threads = threads;
  return settings;
}

// ---------------------------------------------------------------- rays per second

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

/// Directions that one vertex sends rays in.
constexpr std::size_t kPerVertex = 256;
struct VertexRays {
  Vec3 origin{0.0F};
  std::uint32_t count = 0;
  float x[kPerVertex];
  float y[kPerVertex];
  float z[kPerVertex];
};

/// What a bake of 256 samples would ask: 16 sets of 16.
std::vector<VertexRays> bake_rays(const scene::Scene& scene) {
  const std::vector<trace::SurfacePoint> points = trace::vertex_points(scene);
  const transfer::DirectionSampler sampler(transfer::Sampling::qmc, transfer::DirectionSets::per_vertex, 0,
                                           kPerVertex / transfer::kSets);
  std::vector<VertexRays> rays(points.size());
  parallel_for(points.size(), 0, [&](std::size_t v) {
    transfer::Bundle bundle(transfer::DirectionSampler::kMostTogether, 1);
    rays[v].origin = points[v].position + points[v].clearance * points[v].geometric_normal;
    for (std::uint32_t set = 0; set < transfer::kSets; ++set) {
      sampler.draw(points[v], {v, set, 0, sampler.set_size(), 0}, bundle);
      for (std::size_t k = 0; k < bundle.count; ++k) {
        const std::uint32_t at = rays[v].count++;
        rays[v].x[at] = bundle.x[k];
        rays[v].y[at] = bundle.y[k];
        rays[v].z[at] = bundle.z[k];
      }
    }
  });
  return rays;
}

template <class Query>
void put(const VertexRays& rays, std::size_t k, Query& out) {
  out.org_x = rays.origin.x;
  out.org_y = rays.origin.y;
  out.org_z = rays.origin.z;
  out.tnear = 0.0F;
  out.dir_x = rays.x[k];
  out.dir_y = rays.y[k];
  out.dir_z = rays.z[k];
  out.time = 0.0F;
  out.tfar = std::numeric_limits<float>::infinity();
  out.mask = 0xFFFFFFFFU;
  out.id = 0;
  out.flags = 0;
}

#if PLUMBLINE_EMBREE == 4
#define PLUMBLINE_CONTEXT       \
  RTCOccludedArguments context; \
  rtcInitOccludedArguments(&context)
#define PLUMBLINE_OCCLUDED1(SCENE, QUERY) rtcOccluded1(SCENE, QUERY, &context)
#define PLUMBLINE_OCCLUDED8(SCENE, QUERY) rtcOccluded8(kAll, SCENE, QUERY, &context)
#else
#define PLUMBLINE_CONTEXT      \
  RTCIntersectContext context; \
  rtcInitIntersectContext(&context)
#define PLUMBLINE_OCCLUDED1(SCENE, QUERY) rtcOccluded1(SCENE, &context, QUERY)
#define PLUMBLINE_OCCLUDED8(SCENE, QUERY) rtcOccluded8(kAll, SCENE, &context, QUERY)
#endif

std::size_t bare_singly(RTCScene scene, const VertexRays& rays) {
  PLUMBLINE_CONTEXT;
  std::size_t hits = 0;
  for (std::size_t k = 0; k < rays.count; ++k) {
    RTCRay query;
    put(rays, k, query);
    PLUMBLINE_OCCLUDED1(scene, &query);
    hits += query.tfar < 0.0F ? 1 : 0;
  }
  return hits;
}

std::size_t bare_packets(RTCScene scene, const VertexRays& rays) {
  alignas(32) static constexpr int kAll[8] = {-1, -1, -1, -1, -1, -1, -1, -1};
  PLUMBLINE_CONTEXT;
  std::size_t hits = 0;
  for (std::size_t first = 0; first + 8 <= rays.count; first += 8) {
    RTCRay8 query;
    for (std::size_t k = 0; k < 8; ++k) {
      query.org_x[k] = rays.origin.x;
      query.org_y[k] = rays.origin.y;
      query.org_z[k] = rays.origin.z;
      query.tnear[k] = 0.0F;
      query.dir_x[k] = rays.x[first + k];
      query.dir_y[k] = rays.y[first + k];
      query.dir_z[k] = rays.z[first + k];
      query.time[k] = 0.0F;
      query.tfar[k] = std::numeric_limits<float>::infinity();
      query.mask[k] = 0xFFFFFFFFU;
      query.id[k] = 0;
      query.flags[k] = 0;
    }
    PLUMBLINE_OCCLUDED8(scene, &query);
    for (std::size_t k = 0; k < 8; ++k) hits += query.tfar[k] < 0.0F ? 1 : 0;
  }
  return hits;
}

#if PLUMBLINE_EMBREE == 3
std::size_t bare_stream(RTCScene scene, const VertexRays& rays) {
  PLUMBLINE_CONTEXT;
  RTCRay queries[kPerVertex];
  for (std::size_t k = 0; k < rays.count; ++k) put(rays, k, queries[k]);
  rtcOccluded1M(scene, &context, queries, rays.count, sizeof(RTCRay));
  std::size_t hits = 0;
  for (std::size_t k = 0; k < rays.count; ++k) hits += queries[k].tfar < 0.0F ? 1 : 0;
  return hits;
}
#endif

using Tracer = std::size_t (*)(RTCScene scene, const VertexRays& rays);
struct Form {
  const char* name;
  Tracer trace;
};
constexpr Form kForms[] = {
    {"1", bare_singly},
    {"x8", bare_packets},
#if PLUMBLINE_EMBREE == 3
    {"1M", bare_stream},
#endif
};

void run_rays(benchmark::State& state, int threads) {
  with_scene(state, "bunny", [&](const scene::Scene& scene) {
    const BareScene bare(scene);
    const std::vector<VertexRays> rays = bake_rays(scene);
    double count = 0.0;
    for (const VertexRays& vertex : rays) count += vertex.count;
    BakeSettings settings = settings_of(Kind::shadowed, 1024, threads);
    settings.is_skipping = false;
    const double baked = 4.0 * count;  // 1024 instead of 256 a vertex
    std::vector<double> own;
    std::map<std::string, std::vector<double>> others;
    for (auto _ : state) {
      own.push_back(seconds_of([&] { benchmark::DoNotOptimize(transfer::bake(scene, settings)); }));
      state.SetIterationTime(own.back());
      for (const Form& form : kForms) {
        others[form.name].push_back(seconds_of([&] {
          constexpr std::size_t kBlock = 64;
          parallel_for((rays.size() + kBlock - 1) / kBlock, threads, [&](std::size_t block) {
            std::size_t hits = 0;
            for (std::size_t v = block * kBlock; v < std::min(rays.size(), (block + 1) * kBlock); ++v)
              hits += form.trace(bare.get(), rays[v]);
            benchmark::DoNotOptimize(hits);
          });
        }));
      }
    }
    double best = 0.0;
    for (const auto& [name, seconds] : others) {
      state.counters["bare " + name] = count * 1e-6 / median(seconds);
      best = std::max(best, count * 1e-6 / median(seconds));
    }
    state.counters["Mrays/s"] = baked * 1e-6 / median(own);
    state.counters["ratio"] = baked * 1e-6 / median(own) / best;
  });
}

void run_bounces(benchmark::State& state, int threads) {
  with_scene(state, "bunny", [&](const scene::Scene& scene) {
    std::vector<double> shadowed;
    std::map<Solver, std::vector<double>> bounced;
    for (auto _ : state) {
      const BakeSettings direct = settings_of(Kind::shadowed, 1024, threads);
      shadowed.push_back(seconds_of([&] { benchmark::DoNotOptimize(transfer::bake(scene, direct)); }));
      state.SetIterationTime(shadowed.back());
      for (const Solver solver : {Solver::traced, Solver::iterative}) {
        BakeSettings settings = settings_of(Kind::interreflected, 1024, threads);
        settings.max_bounces = 3;
        settings.method.solver = solver;
        bounced[solver].push_back(
            seconds_of([&] { benchmark::DoNotOptimize(transfer::bake(scene, settings)); }));
      }
    }
    for (const auto& [solver, seconds] : bounced)
      state.counters[std::string(to_string(solver)) + "/shadowed"] = median(seconds) / median(shadowed);
  });
}

// ---------------------------------------------------------------- error against time

struct Way {
  const char* name;
  transfer::Method method;
  int sets;
};
constexpr Way kPapers = {
    "papers", {Solver::traced, transfer::Sampling::uniform, transfer::DirectionSets::shared}, 1};
constexpr Way kWays[] = {
    kPapers,
    {"cosine",
     {Solver::traced, transfer::Sampling::cosine, transfer::DirectionSets::per_vertex},
     transfer::kSets},
    {"qmc", {Solver::traced, transfer::Sampling::qmc, transfer::DirectionSets::per_vertex}, transfer::kSets},
    {"qmc-four-sets", {Solver::traced, transfer::Sampling::qmc, transfer::DirectionSets::per_vertex}, 4},
    {"qmc-one-set", {Solver::traced, transfer::Sampling::qmc, transfer::DirectionSets::per_vertex}, 1},
};
constexpr const char* kLoop = "papers' loop";
constexpr int kFewest = 64;
constexpr int kMost = 4096;

struct Measured {
  double seconds = 0.0;
  double rmse = 0.0;
};

/// Root mean square difference of all coefficients, the reference's own noise taken off.
double rmse(const Transfer& transfer, const Transfer& truth) {
  double sum = 0.0;
  for (std::size_t i = 0; i < truth.coefficients.size(); ++i) {
    sum += std::pow(static_cast<double>(transfer.coefficients[i] - truth.coefficients[i]), 2) -
           std::pow(static_cast<double>(truth.standard_errors[i]), 2);
  }
  return std::sqrt(std::max(0.0, sum) / static_cast<double>(truth.coefficients.size()));
}

Measured measure(const scene::Scene& scene, const Transfer& truth, const Way& way, int samples, int threads) {
  BakeSettings settings = settings_of(Kind::shadowed, samples, threads);
  settings.method = way.method;
  settings.sets = way.sets;
  settings.seed = 1;
  settings.is_skipping = false;
  Transfer baked;
  Measured result;
  result.seconds = seconds_of([&] { baked = transfer::bake(scene, settings); });
  result.rmse = rmse(baked, truth);
  return result;
}

/// The papers' loop: basis functions once a direction; at each vertex, of each direction above the horizon, a ray and a sum.
Transfer bake_in_a_loop(const scene::Scene& scene, int bands, int samples, int threads) {
  const int side = static_cast<int>(std::sqrt(samples));
  const auto count = static_cast<std::size_t>(side * side);
  std::vector<Vec3> directions;
  std::vector<std::vector<double>> basis;
  for (std::size_t cell = 0; cell < count; ++cell) {
    const glm::dvec2 jitter = transfer::random_shift(transfer::cell_seed(1, cell), 0, 0);
    const auto at = glm::dvec2(static_cast<double>(cell % static_cast<std::size_t>(side)),
                               static_cast<double>(cell / static_cast<std::size_t>(side)));
    const Vec3d direction = transfer::sphere_direction((at + jitter) / static_cast<double>(side));
    directions.emplace_back(direction);
    basis.push_back(sh::evaluate_basis(bands, direction));
  }
  const trace::RayCaster caster(scene);
  const std::vector<trace::SurfacePoint> points = trace::vertex_points(scene);
  const auto size = static_cast<std::size_t>(bands * bands);
  Transfer result;
  result.coefficients.resize(points.size() * size);
  parallel_for(points.size(), threads, [&](std::size_t v) {
    std::vector<double> sum(size, 0.0);
    for (std::size_t k = 0; k < count; ++k) {
      const float cosine = glm::dot(directions[k], points[v].shading_normal);
      if (!(cosine > 0.0F) || !(glm::dot(directions[k], points[v].geometric_normal) > 0.0F)) continue;
      if (caster.is_occluded({trace::ray_origin(points[v], directions[k]), directions[k]})) continue;
      for (std::size_t i = 0; i < size; ++i) sum[i] += static_cast<double>(cosine) * basis[k][i];
    }
    for (std::size_t i = 0; i < size; ++i)
      result.coefficients[v * size + i] = static_cast<float>(4.0 * sum[i] / static_cast<double>(count));
  });
  return result;
}

/// Seconds of a curve at an error, by straight lines between its points on logarithmic axes, extended at both ends.
double seconds_at(const std::vector<Measured>& curve, double error) {
  std::size_t k = 0;
  while (k + 2 < curve.size() && curve[k + 1].rmse > error) ++k;
  const double slope =
      std::log(curve[k + 1].seconds / curve[k].seconds) / std::log(curve[k + 1].rmse / curve[k].rmse);
  return curve[k].seconds * std::exp(slope * std::log(error / curve[k].rmse));
}

using Curves = std::map<std::string, std::vector<Measured>>;

/// Measured once for all rows of a scene.
const Curves& curves_of(const std::string& name, int threads) {
  static std::map<std::string, Curves> all;
  Curves& curves = all[name];
  if (!curves.empty()) return curves;
  const scene::Scene scene = make_scene(name);
  BakeSettings exact = settings_of(Kind::shadowed, 4 * kMost, threads);
  exact.seed = 99;
  exact.is_skipping = false;
  const Transfer truth = transfer::bake(scene, exact);
  for (int samples = kFewest; samples <= kMost; samples *= 4) {
    Measured loop;
    Transfer baked;
    loop.seconds = seconds_of([&] { baked = bake_in_a_loop(scene, exact.bands, samples, threads); });
    loop.rmse = rmse(baked, truth);
    curves[kLoop].push_back(loop);
    for (const Way& way : kWays) curves[way.name].push_back(measure(scene, truth, way, samples, threads));
  }
  return curves;
}

void run_error(benchmark::State& state, const std::string& scene, const Way& way, int samples, int threads) {
  try {
    for (auto _ : state) {
      const Curves& curves = curves_of(scene, threads);
      std::size_t place = 0;
      for (int n = kFewest; n < samples; n *= 4) ++place;
      const Measured& here = curves.at(way.name)[place];
      state.SetIterationTime(here.seconds);
      state.counters["rmse"] = here.rmse;
      state.counters["gain on loop"] = seconds_at(curves.at(kLoop), here.rmse) / here.seconds;
      state.counters["gain"] = seconds_at(curves.at(kPapers.name), here.rmse) / here.seconds;
    }
  } catch (const InputError& error) {
    state.SkipWithError(error.what());
  }
}

// ---------------------------------------------------------------- what the plan saves

void run_skip(benchmark::State& state, const std::string& name, Kind kind, int threads) {
  with_scene(state, name, [&](const scene::Scene& scene) {
    std::vector<double> with;
    std::vector<double> without;
    std::vector<double> planning;
    for (auto _ : state) {
      BakeSettings settings = settings_of(kind, 1024, threads);
      planning.push_back(seconds_of(
          [&] { benchmark::DoNotOptimize(make_plan(scene, trace::vertex_points(scene), settings)); }));
      with.push_back(seconds_of([&] { benchmark::DoNotOptimize(transfer::bake(scene, settings)); }));
      state.SetIterationTime(with.back());
      settings.is_skipping = false;
      without.push_back(seconds_of([&] { benchmark::DoNotOptimize(transfer::bake(scene, settings)); }));
    }
    state.counters["saves"] = median(without) / median(with);
    state.counters["plan ms"] = 1e3 * median(planning);
  });
}

int register_rows() {
  constexpr int kThreads = 2;
  const auto add = [](const std::string& name, int iterations, const auto& body) {
    benchmark::RegisterBenchmark(name.c_str(), body)
        ->Unit(benchmark::kMillisecond)
        ->UseManualTime()
        ->Iterations(iterations);
  };
  for (const int threads : {1, kThreads}) {
    add(fmt::format("bake/bunny/rays/threads:{}", threads), 3,
        [=](benchmark::State& state) { run_rays(state, threads); });
  }
  add(fmt::format("bake/bunny/bounces/threads:{}", kThreads), 2,
      [](benchmark::State& state) { run_bounces(state, kThreads); });
  for (const char* scene : {"open-box", "bunny"}) {
    for (const Way& way : kWays) {
      for (int samples = kFewest; samples <= kMost; samples *= 4) {
        add(fmt::format("bake/error/{}/{}/samples:{}", scene, way.name, samples), 1,
            [=, &way](benchmark::State& state) { run_error(state, scene, way, samples, kThreads); });
      }
    }
  }
  for (const char* scene : {"faceted-ball", "ball", "convex", "bunny"}) {
    for (const Kind kind : {Kind::shadowed, Kind::interreflected}) {
      add(fmt::format("bake/skip/{}/{}", scene, to_string(kind)), 3,
          [=](benchmark::State& state) { run_skip(state, scene, kind, kThreads); });
    }
  }
  return 0;
}
const int kRegistered = register_rows();

}  // namespace
