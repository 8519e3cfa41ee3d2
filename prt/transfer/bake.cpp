#include "prt/transfer/bake.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "prt/sh/basis.hpp"
#include "prt/sh/zonal.hpp"
#include "prt/transfer/directions.hpp"
#include "reference/base/error.hpp"
#include "reference/base/parallel.hpp"

namespace plumbline::transfer {
namespace {

// Independent shifts of the point set; the spread of their means is the standard error.
constexpr int kShifts = 16;

void require_valid(const BakeSettings& settings) {
  sh::require_bands(settings.bands);
  if (settings.kind == Kind::interreflected) {
    throw InputError("transfer: interreflected cannot be baked by this version; unshadowed and shadowed can");
  }
  if (settings.samples < kShifts || settings.samples > (1 << 26)) {
    throw InputError(fmt::format("samples: expected {} to {}, got {}", kShifts, 1 << 26, settings.samples));
  }
}

/// y_i summed over the unblocked directions of one shift.
struct VisibleSum {
  const trace::RayCaster& caster;
  const trace::SurfacePoint& point;
  const sh::Basis<double>& basis;
  std::vector<double> values;  // scratch

  VisibleSum(const trace::RayCaster& c, const trace::SurfacePoint& p, const sh::Basis<double>& b)
      : caster(c), point(p), basis(b), values(static_cast<std::size_t>(b.coefficient_count())) {}

  void add(const Vec3d& direction, std::vector<double>& sum) {
    const Vec3 ray_direction = glm::normalize(Vec3(direction));
    if (!(glm::dot(ray_direction, point.geometric_normal) > 0.0F))
      return;  // the surface itself is in the way
    if (caster.is_occluded({trace::ray_origin(point, ray_direction), ray_direction})) return;
    basis.evaluate(direction.x, direction.y, direction.z, values);
    for (std::size_t i = 0; i < values.size(); ++i) sum[i] += values[i];
  }
};

PointTransfer shadowed_at(const trace::RayCaster& caster, const trace::SurfacePoint& point,
                          const sh::Basis<double>& basis, int samples, std::uint64_t seed,
                          std::uint64_t stream) {
  const auto count = static_cast<std::size_t>(basis.coefficient_count());
  std::vector<double> sum(count, 0.0);
  std::vector<double> squares(count, 0.0);
  std::vector<double> shift_sum(count);
  VisibleSum visible(caster, point, basis);
  // The same number of points for every shift: the few that are left over are not used.
  const int per_shift = samples / kShifts;
  for (std::uint32_t r = 0; r < kShifts; ++r) {
    std::fill(shift_sum.begin(), shift_sum.end(), 0.0);
    const glm::dvec2 shift = random_shift(seed, stream, r);
    for (int s = 0; s < per_shift; ++s) {
      visible.add(cosine_direction(Vec3d(point.shading_normal),
                                   shifted_lattice_point(static_cast<std::uint64_t>(s), shift)),
                  shift_sum);
    }
    for (std::size_t i = 0; i < count; ++i) {
      const double mean = shift_sum[i] / per_shift;
      sum[i] += mean;
      squares[i] += mean * mean;
    }
  }
  PointTransfer result{std::vector<double>(count), std::vector<double>(count)};
  for (std::size_t i = 0; i < count; ++i) {
    const double mean = sum[i] / kShifts;
    const double variance = std::max(0.0, squares[i] / kShifts - mean * mean) / (kShifts - 1);
    result.coefficients[i] = mean;
    result.standard_errors[i] = std::sqrt(variance);
  }
  return result;
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
  return shadowed_at(caster, point, sh::Basis<double>(bands), samples, seed, stream);
}

Transfer bake(const scene::Scene& scene, const BakeSettings& settings) {
  require_valid(settings);
  scene::refuse_primitives(scene, "transfer");
  const bool is_traced = settings.kind != Kind::unshadowed;
  const auto count = static_cast<std::size_t>(sh::coefficient_count(settings.bands));
  Transfer result;
  result.bands = settings.bands;
  result.kind = settings.kind;
  result.vertices = scene.positions.size();
  result.seed = settings.seed;
  result.coefficients.resize(result.vertices * count);
  if (is_traced) {
    result.samples = settings.samples / kShifts * kShifts;
    result.standard_errors.resize(result.coefficients.size());
  }
  const trace::RayCaster caster(scene);
  const std::vector<trace::SurfacePoint> points = trace::vertex_points(scene);
  const sh::Basis<double> basis(settings.bands);
  constexpr std::size_t kBlock = 64;
  const std::size_t blocks = (result.vertices + kBlock - 1) / kBlock;
  std::atomic<std::size_t> done{0};
  parallel_for(blocks, settings.threads, [&](std::size_t block) {
    const std::size_t end = std::min(result.vertices, (block + 1) * kBlock);
    for (std::size_t v = block * kBlock; v < end; ++v) {
      PointTransfer point;
      if (is_traced) {
        point = shadowed_at(caster, points[v], basis, settings.samples, settings.seed, v);
        std::copy(point.standard_errors.begin(), point.standard_errors.end(),
                  result.standard_errors.begin() + static_cast<std::ptrdiff_t>(v * count));
      } else {
        point.coefficients = unshadowed_transfer(settings.bands, points[v].shading_normal);
      }
      std::transform(point.coefficients.begin(), point.coefficients.end(),
                     result.coefficients.begin() + static_cast<std::ptrdiff_t>(v * count),
                     [](double value) { return static_cast<float>(value); });
    }
    if (settings.progress)
      settings.progress(static_cast<double>(done.fetch_add(1) + 1) / static_cast<double>(blocks));
  });
  return result;
}

}  // namespace plumbline::transfer
