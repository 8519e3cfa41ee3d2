// prt/transfer/bake.hpp: transfer vectors of a scene's vertices.
// [1] Sloan, Kautz & Snyder, "Precomputed Radiance Transfer for Real-Time Rendering in Dynamic, Low-Frequency
// Lighting
//     Environments", SIGGRAPH 2002. [2] Peers, "Deriving basic Precomputed Radiance Transfer", 2009, eq.
//     17-22. [3] Ramamoorthi & Hanrahan, "An Efficient Representation for Irradiance Environment Maps",
//     SIGGRAPH 2001.
#pragma once

#include <cstdint>
#include <functional>

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
};

/// T_i = (1/pi) integral y_i(w) V(w) max(0, n.w) dw at every vertex. Unshadowed (V = 1) has the closed form
/// T_lm = A_l y_lm(n) / pi [3]; shadowed is the mean of y_i V over cosine-distributed directions [2], each
/// vertex with its own randomly shifted point set, so that the error of one says nothing of its neighbour's.
/// @throws InputError for bands or samples out of range, a kind that cannot be baked, or a scene with exact
/// spheres or discs: transfer lives at vertices.
[[nodiscard]] Transfer bake(const scene::Scene& scene, const BakeSettings& settings);

/// Coefficients of one point, in double, for checks: bands^2 values and their standard errors.
struct PointTransfer {
  std::vector<double> coefficients;
  std::vector<double> standard_errors;
};
[[nodiscard]] std::vector<double> unshadowed_transfer(int bands, const Vec3& normal);
[[nodiscard]] PointTransfer shadowed_transfer(const trace::RayCaster& caster,
                                              const trace::SurfacePoint& point, int bands, int samples,
                                              std::uint64_t seed, std::uint64_t stream);

}  // namespace plumbline::transfer
