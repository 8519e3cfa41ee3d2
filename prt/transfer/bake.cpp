#include "prt/transfer/bake.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

#include "prt/sh/basis.hpp"
#include "prt/sh/zonal.hpp"
#include "prt/transfer/iterative.hpp"
#include "prt/transfer/point_baker.hpp"
#include "prt/transfer/reflecting.hpp"
#include "reference/base/error.hpp"
#include "reference/base/parallel.hpp"

namespace plumbline::transfer {
namespace {

constexpr std::size_t kBlock = 64;  // vertices a task

void require_valid(const BakeSettings& settings) {
  sh::require_bands(settings.bands);
  if (settings.samples < kSets || settings.samples > (1 << 26))
    throw InputError(fmt::format("samples: expected {} to {}, got {}", kSets, 1 << 26, settings.samples));
  if (settings.max_bounces < 0)
    throw InputError(fmt::format("bounces: expected 0 or more, got {}", settings.max_bounces));
  if (settings.kept_terms < 0)
    throw InputError(fmt::format("terms: expected 0 or more to keep, got {}", settings.kept_terms));
}

/// How many terms there are to keep.
int terms_to_keep(const BakeSettings& settings) {
  const int bounces = settings.kind == Kind::interreflected ? settings.max_bounces : 0;
  return settings.kept_terms <= bounces ? settings.kept_terms : bounces + 1;
}

std::size_t coefficients(int bands) {
  return static_cast<std::size_t>(sh::coefficient_count(bands));
}

DirectionSampler make_sampler(const BakeSettings& settings) {
  return {settings.method.sampling, settings.method.directions, settings.seed,
          static_cast<std::size_t>(settings.samples / kSets)};
}

/// One of the parts that PointBaker gives.
PointTransfer part_of(const SetStatistics& statistics, std::size_t part, std::size_t size) {
  PointTransfer result{std::vector<double>(size), std::vector<double>(size)};
  for (std::size_t i = 0; i < size; ++i) {
    result.coefficients[i] = statistics.mean[part * size + i];
    result.standard_errors[i] = statistics.standard_error(part * size + i);
  }
  return result;
}

/// Puts a part into row `vertex` of two arrays.
void store(const SetStatistics& statistics, std::size_t part, std::size_t size, std::size_t vertex,
           std::vector<float>& values, std::vector<float>& errors) {
  for (std::size_t i = 0; i < size; ++i) {
    values[vertex * size + i] = static_cast<float>(statistics.mean[part * size + i]);
    errors[vertex * size + i] = static_cast<float>(statistics.standard_error(part * size + i));
  }
}

/// Calls body(first vertex, end) for blocks of vertices on all threads.
template <class Body>
void for_vertices(std::size_t vertices, const BakeSettings& settings, const Body& body) {
  const std::size_t blocks = (vertices + kBlock - 1) / kBlock;
  std::atomic<std::size_t> done{0};
  parallel_for(blocks, settings.threads, [&](std::size_t block) {
    body(block * kBlock, std::min(vertices, (block + 1) * kBlock));
    if (settings.progress)
      settings.progress(static_cast<double>(done.fetch_add(1) + 1) / static_cast<double>(blocks));
  });
}

void bake_unshadowed(const std::vector<trace::SurfacePoint>& points, const BakeSettings& settings,
                     Transfer& result) {
  const std::size_t count = coefficients(result.bands);
  result.coefficients.resize(result.vertices * count);
  for_vertices(result.vertices, settings, [&](std::size_t first, std::size_t end) {
    for (std::size_t v = first; v < end; ++v) {
      const std::vector<double> exact = unshadowed_transfer(result.bands, points[v].shading_normal);
      for (std::size_t i = 0; i < count; ++i)
        result.coefficients[v * count + i] = static_cast<float>(exact[i]);
    }
  });
}

void bake_points(const PointWork& work, const std::vector<trace::SurfacePoint>& points,
                 const BakeSettings& settings, Transfer& result) {
  const std::size_t size = coefficients(result.bands) * static_cast<std::size_t>(result.channels);
  result.coefficients.resize(result.vertices * size);
  result.standard_errors.resize(result.coefficients.size());
  result.terms.assign(static_cast<std::size_t>(work.kept_terms),
                      {result.coefficients, result.standard_errors});
  for_vertices(result.vertices, settings, [&](std::size_t first, std::size_t end) {
    PointBaker baker(work);
    for (std::size_t v = first; v < end; ++v) {
      const SetStatistics statistics = baker.run(points[v], v);
      store(statistics, 0, size, v, result.coefficients, result.standard_errors);
      for (std::size_t k = 0; k < result.terms.size(); ++k)
        store(statistics, k + 1, size, v, result.terms[k].coefficients, result.terms[k].standard_errors);
    }
  });
}

/// Whether the three channels of all vectors are the same bits.
bool is_gray(const std::vector<float>& values, std::size_t count) {
  for (std::size_t row = 0; row < values.size(); row += 3 * count) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(row);
    const auto step = static_cast<std::ptrdiff_t>(count);
    if (!std::equal(first, first + step, first + step) || !std::equal(first, first + step, first + 2 * step))
      return false;
  }
  return true;
}

void keep_first_channel(std::vector<float>& values, std::size_t count) {
  std::size_t kept = 0;
  for (std::size_t row = 0; row < values.size(); row += 3 * count) {
    for (std::size_t i = 0; i < count; ++i) values[kept++] = values[row + i];
  }
  values.resize(kept);
}

/// Coloured surfaces that nothing sees leave the transfer gray.
void merge_equal_channels(Transfer& transfer) {
  const std::size_t count = coefficients(transfer.bands);
  if (transfer.channels != 3 || !is_gray(transfer.coefficients, count) ||
      !is_gray(transfer.standard_errors, count))
    return;
  transfer.channels = 1;
  keep_first_channel(transfer.coefficients, count);
  keep_first_channel(transfer.standard_errors, count);
  for (Term& term : transfer.terms) {
    keep_first_channel(term.coefficients, count);
    keep_first_channel(term.standard_errors, count);
  }
}

}  // namespace

// Funk-Hecke: the convolution of the zonal kernel max(0, cos) with y_lm is A_l y_lm, and the kernel at n is
// what the integral holds.
std::vector<double> unshadowed_transfer(int bands, const Vec3& normal) {
  std::vector<double> result = sh::evaluate_basis(bands, glm::normalize(Vec3d(normal)));
  for (int l = 0; l < bands; ++l) {
    const double factor = sh::clamped_cosine_factor(l) / kPi;
    for (int m = -l; m <= l; ++m) result[static_cast<std::size_t>(sh::index(l, m))] *= factor;
  }
  return result;
}

PointTransfer shadowed_transfer(const trace::RayCaster& caster, const trace::SurfacePoint& point, int bands,
                                int samples, std::uint64_t seed, std::uint64_t stream) {
  BakeSettings settings;
  settings.bands = bands;
  settings.samples = samples;
  settings.seed = seed;
  require_valid(settings);
  const sh::BatchBasis<float> basis(bands);
  const DirectionSampler sampler = make_sampler(settings);
  PointWork work;
  work.caster = &caster;
  work.sampler = &sampler;
  work.basis = &basis;
  work.seed = seed;
  return part_of(PointBaker(work).run(point, stream), 0, coefficients(bands));
}

PointTerms interreflected_transfer(const scene::Scene& scene, const trace::RayCaster& caster,
                                   const trace::SurfacePoint& point, const BakeSettings& settings,
                                   std::uint64_t stream) {
  require_valid(settings);
  scene::refuse_primitives(scene, "transfer");
  BakeSettings reflecting = settings;
  reflecting.kind = Kind::interreflected;
  const sh::BatchBasis<float> basis(settings.bands);
  const DirectionSampler sampler = make_sampler(settings);
  const trace::SurfaceTable surfaces(scene);
  PointTerms result;
  result.channels = is_gray(scene) ? 1 : 3;
  const PointWork work{&caster,
                       &surfaces,
                       &sampler,
                       &basis,
                       settings.seed,
                       settings.method.directions,
                       result.channels,
                       settings.max_bounces,
                       terms_to_keep(reflecting)};
  const SetStatistics statistics = PointBaker(work).run(point, stream);
  const std::size_t size = coefficients(settings.bands) * static_cast<std::size_t>(result.channels);
  result.total = part_of(statistics, 0, size);
  for (int k = 0; k < work.kept_terms; ++k)
    result.terms.push_back(part_of(statistics, static_cast<std::size_t>(k) + 1, size));
  return result;
}

Transfer bake(const scene::Scene& scene, const BakeSettings& settings) {
  require_valid(settings);
  scene::refuse_primitives(scene, "transfer");
  const bool is_interreflected = settings.kind == Kind::interreflected;
  Transfer result;
  result.bands = settings.bands;
  result.kind = settings.kind;
  result.vertices = scene.positions.size();
  result.seed = settings.seed;
  result.method = settings.method;
  const std::vector<trace::SurfacePoint> points = trace::vertex_points(scene);
  if (settings.kind == Kind::unshadowed) {
    bake_unshadowed(points, settings, result);
    return result;
  }
  const DirectionSampler sampler = make_sampler(settings);
  const sh::BatchBasis<float> basis(settings.bands);
  const trace::RayCaster caster(scene);
  const trace::SurfaceTable surfaces(scene);
  result.samples = static_cast<std::int64_t>(sampler.set_size()) * kSets;
  result.bounces = is_interreflected ? settings.max_bounces : 0;
  result.channels = is_interreflected && !is_gray(scene) ? 3 : 1;
  const int kept = terms_to_keep(settings);
  if (is_interreflected && settings.method.solver == Solver::iterative) {
    solve_iteratively({&scene, &caster, &surfaces, &sampler, &basis, &points, settings.max_bounces, kept,
                       settings.threads, settings.progress},
                      result);
  } else {
    const PointWork work{&caster,
                         is_interreflected ? &surfaces : nullptr,
                         &sampler,
                         &basis,
                         settings.seed,
                         settings.method.directions,
                         result.channels,
                         result.bounces,
                         kept};
    bake_points(work, points, settings, result);
  }
  merge_equal_channels(result);
  return result;
}

}  // namespace plumbline::transfer
