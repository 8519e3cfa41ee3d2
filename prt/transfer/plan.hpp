// prt/transfer/plan.hpp: what a bake need not do, found out before the work.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "prt/transfer/transfer.hpp"
#include "reference/scene/scene.hpp"
#include "reference/trace/surface_point.hpp"

namespace plumbline::transfer {

struct BakeSettings;

/// What is above a point. something: rays tell. nothing: no ray can meet anything; the vector is its closed form less what the
/// surface's own plane cuts off, and that alone is sampled. nothing_flat: besides, the shading normal is that of the plane,
/// which cuts off nothing.
enum class Above : std::uint8_t { something, nothing, nothing_flat };

/// One thing left out, for people and for JSON.
struct Skip {
  std::string what;   // "visibility rays"
  std::string where;  // "60 of 60 vertices"
  std::string why;
  std::string change;  // what it does to the result: "none", "within the standard errors: exact"
};

struct Plan {
  std::vector<Above> above;    // by vertex; empty: rays everywhere
  bool is_reflecting = false;  // whether bounces are computed
  int channels = 1;
  std::vector<Skip> skips;
};

/// Looks at the scene alone; costs a fraction of a thousandth of the rays it may save. With settings.is_skipping unset nothing
/// is left out.
/// @param points  trace::vertex_points(scene)
[[nodiscard]] Plan make_plan(const scene::Scene& scene, const std::vector<trace::SurfacePoint>& points,
                             const BakeSettings& settings);

/// "skips visibility rays at 60 of 60 vertices: …", a line each; one line that says so where nothing is skipped.
[[nodiscard]] std::string to_text(const Plan& plan);

}  // namespace plumbline::transfer
