#include "prt/transfer/bake.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

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
  if (settings.sets < 1 || settings.sets > kMostSets)
    throw InputError(fmt::format("sets: expected 1 to {}, got {}", kMostSets, settings.sets));
  if (settings.target_error > 0.0 && settings.sets < 4)
    throw InputError(fmt::format("sets: a target error needs 4 or more, got {}", settings.sets));
  if (settings.samples < settings.sets || settings.samples > (1 << 26)) {
    throw InputError(
        fmt::format("samples: expected {} to {}, got {}", settings.sets, 1 << 26, settings.samples));
  }
  if (!(settings.target_error >= 0.0) || !std::isfinite(settings.target_error))
    throw InputError(fmt::format("target error: expected 0 or more, got {}", settings.target_error));
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

/// One of the size asked for; with a target error others behind it, each of twice the size of the one before.
std::vector<DirectionSampler> make_samplers(const BakeSettings& settings) {
  std::vector<DirectionSampler> samplers;
  for (std::int64_t size = settings.samples / settings.sets;; size *= 2) {
    samplers.emplace_back(settings.method.sampling, settings.method.directions, settings.seed,
                          static_cast<std::size_t>(size), static_cast<std::uint32_t>(settings.sets));
    if (settings.target_error == 0.0 || 4 * size * settings.sets > kMostSamples) return samplers;
  }
}

/// One of the parts that PointBaker gives.
PointTransfer part_of(const SetStatistics& statistics, std::size_t part, std::size_t size) {
  const auto first = static_cast<std::ptrdiff_t>(part * size);
  const auto end = static_cast<std::ptrdiff_t>((part + 1) * size);
  return {{statistics.mean.begin() + first, statistics.mean.begin() + end},
          {statistics.standard_errors.begin() + first, statistics.standard_errors.begin() + end}};
}

/// Puts a part into row `vertex` of two arrays.
void store(const SetStatistics& statistics, std::size_t part, std::size_t size, std::size_t vertex,
           std::vector<float>& values, std::vector<float>& errors) {
  for (std::size_t i = 0; i < size; ++i) {
    values[vertex * size + i] = static_cast<float>(statistics.mean[part * size + i]);
    errors[vertex * size + i] = static_cast<float>(statistics.standard_errors[part * size + i]);
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

void bake_points(const PointWork& work, const std::vector<trace::SurfacePoint>& points, const Plan& plan,
                 const BakeSettings& settings, Transfer& result) {
  const std::size_t size = coefficients(result.bands) * static_cast<std::size_t>(result.channels);
  result.coefficients.resize(result.vertices * size);
  result.standard_errors.resize(result.coefficients.size());
  result.terms.assign(static_cast<std::size_t>(work.kept_terms),
                      {result.coefficients, result.standard_errors});
  std::vector<std::int64_t> samples(result.vertices);
  std::atomic<std::size_t> above_target{0};
  for_vertices(result.vertices, settings, [&](std::size_t first, std::size_t end) {
    PointBaker baker(work);
    for (std::size_t v = first; v < end; ++v) {
      const PointResult point =
          baker.run(points[v], v, plan.above.empty() ? Above::something : plan.above[v]);
      samples[v] = point.samples;
      if (!point.is_on_target) above_target.fetch_add(1);
      store(point.statistics, 0, size, v, result.coefficients, result.standard_errors);
      for (std::size_t k = 0; k < result.terms.size(); ++k)
        store(point.statistics, k + 1, size, v, result.terms[k].coefficients,
              result.terms[k].standard_errors);
    }
  });
  result.above_target = above_target;
  result.samples = static_cast<std::int64_t>(work.samplers->front().set_size()) * work.sets;
  double sum = 0.0;
  for (const std::int64_t count : samples) {
    result.samples = std::max(result.samples, count);
    sum += static_cast<double>(count);
  }
  result.mean_samples = sum / static_cast<double>(std::max<std::size_t>(1, result.vertices));
}

/// Whether anything may be above any vertex.
bool needs_rays(const Plan& plan) {
  return plan.above.empty() ||
         std::find(plan.above.begin(), plan.above.end(), Above::something) != plan.above.end();
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

/// One set has no spread.
void forget_errors(Transfer& transfer) {
  transfer.standard_errors.clear();
  for (Term& term : transfer.terms) term.standard_errors.clear();
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
  const std::vector<DirectionSampler> samplers = make_samplers(settings);
  PointWork work;
  work.caster = &caster;
  work.samplers = &samplers;
  work.basis = &basis;
  work.seed = seed;
  return part_of(PointBaker(work).run(point, stream, Above::something).statistics, 0, coefficients(bands));
}

PointTerms interreflected_transfer(const scene::Scene& scene, const trace::RayCaster& caster,
                                   const trace::SurfacePoint& point, const BakeSettings& settings,
                                   std::uint64_t stream) {
  require_valid(settings);
  scene::refuse_primitives(scene, "transfer");
  BakeSettings reflecting = settings;
  reflecting.kind = Kind::interreflected;
  const sh::BatchBasis<float> basis(settings.bands);
  const std::vector<DirectionSampler> samplers = make_samplers(settings);
  const trace::SurfaceTable surfaces(scene);
  PointTerms result;
  result.channels = is_gray(scene) ? 1 : 3;
  const PointWork work{&caster,
                       &surfaces,
                       &samplers,
                       &basis,
                       settings.seed,
                       settings.method.directions,
                       result.channels,
                       settings.max_bounces,
                       terms_to_keep(reflecting),
                       settings.sets,
                       settings.target_error * unshadowed_norm(settings.bands)};
  const SetStatistics statistics = PointBaker(work).run(point, stream, Above::something).statistics;
  const std::size_t size = coefficients(settings.bands) * static_cast<std::size_t>(result.channels);
  result.total = part_of(statistics, 0, size);
  for (int k = 0; k < work.kept_terms; ++k)
    result.terms.push_back(part_of(statistics, static_cast<std::size_t>(k) + 1, size));
  return result;
}

double unshadowed_norm(int bands) {
  double sum = 0.0;
  for (int l = 0; l < bands; ++l) {
    const double factor = sh::clamped_cosine_factor(l) / kPi;
    sum += factor * factor * (2 * l + 1) / (4.0 * kPi);
  }
  return std::sqrt(sum);
}

Transfer bake(const scene::Scene& scene, const BakeSettings& settings) {
  require_valid(settings);
  scene::refuse_primitives(scene, "transfer");
  return bake(scene, settings, make_plan(scene, trace::vertex_points(scene), settings));
}

Transfer bake(const scene::Scene& scene, const BakeSettings& settings, const Plan& plan) {
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
  const std::vector<DirectionSampler> samplers = make_samplers(settings);
  const sh::BatchBasis<float> basis(settings.bands);
  std::optional<trace::RayCaster> caster;
  if (needs_rays(plan)) caster.emplace(scene);
  std::optional<trace::SurfaceTable> surfaces;
  if (plan.is_reflecting) surfaces.emplace(scene);
  result.target_error = settings.target_error;
  result.bounces = is_interreflected ? settings.max_bounces : 0;
  result.channels = plan.channels;
  const int kept = terms_to_keep(settings);
  const double allowed_error = settings.target_error * unshadowed_norm(settings.bands);
  if (plan.is_reflecting && settings.method.solver == Solver::iterative) {
    solve_iteratively(
        {&scene, &*caster, &*surfaces, &samplers.front(), &basis, &points, &plan.above, settings.max_bounces,
         kept, settings.sets, allowed_error, settings.threads, settings.progress},
        result);
  } else {
    bake_points({caster ? &*caster : nullptr, surfaces ? &*surfaces : nullptr, &samplers, &basis,
                 settings.seed, settings.method.directions, result.channels,
                 plan.is_reflecting ? result.bounces : 0, kept, settings.sets, allowed_error},
                points, plan, settings, result);
  }
  merge_equal_channels(result);
  if (settings.sets == 1) forget_errors(result);
  return result;
}

}  // namespace plumbline::transfer
