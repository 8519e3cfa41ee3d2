// validation/checks/normal_maps.hpp: what the family of normal-mapped PRT judges by.
#pragma once

#include <vector>

#include "prt/sh/lighting.hpp"
#include "validation/checks/case.hpp"
#include "validation/checks/error_parts.hpp"
#include "validation/checks/verdicts.hpp"

namespace plumbline::checks {

/// At each vertex the most that exit radiance for unit albedo can be off, under any normal map and any shadow, when incident radiance is
/// kept to degree 2. The kernel max(0, cos) less its degrees 0 to 2, 1/4 + cos/2 + 5 (3 cos^2 - 1)/32, is within 3/32 (at the
/// horizon), and what arrives is the light where nothing blocks: |error| <= 3/(32 pi) times the integral of |light| over the hemisphere above the surface.
/// By 2048 quadrature nodes: the edge of the hemisphere costs about a percent.
[[nodiscard]] std::vector<Rgb> nine_terms_bounds(const scene::Scene& scene, const sh::ShRgb& light);

/// A difference that must be below 0: fails when it is above by more than chance (two-sided `significance`), passes when its 95 % interval
/// is below, else inconclusive. NaN fails.
[[nodiscard]] Finding judge_order(const Label& label, const metrics::Estimate& difference,
                                  double significance);

/// The family's findings about one scene and light. `seen` is the scene that the methods are given: `scene` itself, but in tests that
/// plant a fault.
[[nodiscard]] std::vector<Finding> judge_normal_maps(const NamedScene& scene, const scene::Scene& seen,
                                                     const light::Environment& environment, int bands,
                                                     const Budget& budget);

}  // namespace plumbline::checks
