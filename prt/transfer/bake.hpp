// prt/transfer/bake.hpp: transfer vectors of a scene's vertices.
// [1] Sloan, Kautz & Snyder, "Precomputed Radiance Transfer for Real-Time Rendering in Dynamic, Low-Frequency
// Lighting
//     Environments", SIGGRAPH 2002. [2] Peers, "Deriving basic Precomputed Radiance Transfer", 2009, eq.
//     17-22. [3] Ramamoorthi & Hanrahan, "An Efficient Representation for Irradiance Environment Maps",
//     SIGGRAPH 2001.
#pragma once

#include <cstdint>
#include <functional>

#include "prt/transfer/plan.hpp"
#include "prt/transfer/set_statistics.hpp"
#include "prt/transfer/transfer.hpp"
#include "reference/scene/scene.hpp"
#include "reference/trace/ray_caster.hpp"
#include "reference/trace/surface_point.hpp"

namespace plumbline::transfer {

struct BakeSettings {
  int bands = 5;
  Kind kind = Kind::shadowed;
  int samples = 1024;  // directions a vertex
  std::uint64_t seed = 0;
  int threads = 0;  // 0 = all there are; never changes the result
  std::function<void(double fraction)> progress;
  Method method;
  /// Relative; 0: none. Every vertex draws directions, `samples` first and then twice as many again and again, until the root of
  /// its vector's summed squared standard errors is at most this times the norm of an unshadowed vector, which is the same
  /// for all normals; at most kMostSamples. One half of the 16 sets decides when to stop, the other half gives the standard
  /// errors, so that those say nothing about luck; the mean is that of all. They have 7 degrees of freedom then, else 15.
  /// Solver::iterative adds sets instead, until the root mean square over all vertices is there; what decides and what is
  /// stated are one there, which a mean over many vertices makes harmless.
  double target_error = 0.0;
  /// Independent sets that the directions are split into, 1 to kMostSets; 1 gives no standard errors. Fewer are better spread.
  int sets = kSets;
  bool is_skipping = true;  // what the plan finds unnecessary (plan.hpp)
  // Of interreflected transfer:
  int max_bounces = kAllBounces;
  int kept_terms = 0;  // bounces 0 … kept_terms-1 are kept apart, as far as there are any
};

/// Transfer vectors of every vertex (CONVENTIONS.md#radiometry): T_0 for light that comes straight from afar,
///   T_0,i = (1/pi) integral y_i(w) V(w) max(0, n.w) dw,
/// and with interreflection the sum of T_k for k up to the last bounce,
///   T_k,i(p) = (1/pi) integral (1 - V(w)) albedo(q) T_k-1,i(q) max(0, n.w) dw,   q = what w meets from p.
/// The receiver's own albedo is not in it. A back face reflects nothing unless it is double-sided; it then does with the
/// transfer of its own side, which is computed for that and not kept: the transfer of a vertex is that of the side its
/// normal is on. Albedos of textures and vertex colours are those at q.
///
/// Unshadowed (V = 1) has the closed form T_lm = A_l y_lm(n) / pi [3]. Otherwise directions come in 16 independent sets, whose
/// spread gives the standard errors; with Solver::iterative these 16 are solved one by one, so that the errors of what is
/// gathered are in them too. What they do not hold there: interpolation, and a bias at returns to the same vertex
/// (bounces 2 and more), of the order of one over the directions in a set, times how much of such light there is.
///
/// With kAllBounces the walks of the traced solver end by Russian roulette. The iterative one stops when a bound on all that
/// is left is below 1e-4 of a white furnace's T_00 (Transfer::remainder).
///
/// Three channels where a surface that could reflect is not gray and they differ, else one.
/// @throws InputError for bands, samples or bounces out of range, a scene with exact spheres or discs (transfer lives at
/// vertices), or when light is still bouncing after kMostIterations of the iterative solver.
[[nodiscard]] Transfer bake(const scene::Scene& scene, const BakeSettings& settings);
/// The same, by a plan made before with the same arguments.
[[nodiscard]] Transfer bake(const scene::Scene& scene, const BakeSettings& settings, const Plan& plan);

inline constexpr int kMostSets = 64;
/// Directions a vertex at most where an error is asked for.
inline constexpr std::int64_t kMostSamples = std::int64_t{1} << 22;
/// Norm of an unshadowed vector: sum over l of (A_l/pi)^2 (2l+1)/(4 pi), its root.
[[nodiscard]] double unshadowed_norm(int bands);

/// Bounces that Solver::iterative computes at most where none is named.
inline constexpr int kMostIterations = 1000;

/// Coefficients of one point, in double, for checks: values and their standard errors, [channel][bands^2].
struct PointTransfer {
  std::vector<double> coefficients;
  std::vector<double> standard_errors;
};
[[nodiscard]] std::vector<double> unshadowed_transfer(int bands, const Vec3& normal);
[[nodiscard]] PointTransfer shadowed_transfer(const trace::RayCaster& caster,
                                              const trace::SurfacePoint& point, int bands, int samples,
                                              std::uint64_t seed, std::uint64_t stream);

/// Interreflected transfer of any point by the traced solver, `settings.kind` or `solver` whatever they are.
struct PointTerms {
  int channels = 1;
  PointTransfer total;
  std::vector<PointTransfer> terms;  // settings.kept_terms, or fewer where max_bounces is lower
};
/// @throws InputError as bake() does
[[nodiscard]] PointTerms interreflected_transfer(const scene::Scene& scene, const trace::RayCaster& caster,
                                                 const trace::SurfacePoint& point,
                                                 const BakeSettings& settings, std::uint64_t stream);

}  // namespace plumbline::transfer
