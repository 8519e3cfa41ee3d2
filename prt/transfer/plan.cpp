#include "prt/transfer/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "prt/transfer/bake.hpp"
#include "prt/transfer/horizon.hpp"
#include "prt/transfer/reflecting.hpp"
#include "reference/base/parallel.hpp"

namespace plumbline::transfer {
namespace {

constexpr std::size_t kBlock = 256;  // points a task

// Computed normals of flat faces differ from the plane's own in their last bits.
constexpr float kRounding = 4.0F * std::numeric_limits<float>::epsilon();

Above above(const Horizon& horizon, const trace::SurfacePoint& point) {
  if (!horizon.is_empty_above(point)) return Above::something;
  return max_magnitude(point.shading_normal - point.geometric_normal) <= kRounding ? Above::nothing_flat
                                                                                   : Above::nothing;
}

void plan_rays(const scene::Scene& scene, const std::vector<trace::SurfacePoint>& points, int threads,
               Plan& plan) {
  const Horizon horizon(scene);
  plan.above.resize(points.size());
  parallel_for((points.size() + kBlock - 1) / kBlock, threads, [&](std::size_t block) {
    const std::size_t end = std::min(points.size(), (block + 1) * kBlock);
    for (std::size_t v = block * kBlock; v < end; ++v) plan.above[v] = above(horizon, points[v]);
  });
  const auto count = [&](Above kind) { return std::count(plan.above.begin(), plan.above.end(), kind); };
  const auto flat = count(Above::nothing_flat);
  const auto curved = count(Above::nothing);
  if (flat > 0) {
    plan.skips.push_back({"visibility rays and sampling",
                          fmt::format("{} of {} vertices", flat, points.size()),
                          "nothing lies above their plane: the vector has its closed form",
                          "within the standard errors: exact"});
  }
  if (curved > 0) {
    plan.skips.push_back({"visibility rays", fmt::format("{} of {} vertices", curved, points.size()),
                          "nothing lies above their plane: only what the surface itself blocks is sampled",
                          "within the standard errors: less noise"});
  }
}

void plan_bounces(const scene::Scene& scene, const BakeSettings& settings, Plan& plan) {
  if (settings.is_skipping && settings.max_bounces > 0) {
    if (is_black(scene)) {
      plan.is_reflecting = false;
      plan.skips.push_back(
          {"interreflection", "all vertices", "no surface reflects anything", "rounding at most"});
    } else if (!plan.above.empty() && std::none_of(plan.above.begin(), plan.above.end(),
                                                   [](Above kind) { return kind == Above::something; })) {
      plan.is_reflecting = false;
      plan.skips.push_back(
          {"interreflection", "all vertices", "no vertex has anything above it", "rounding at most"});
    }
  }
  if (!plan.is_reflecting) return;
  const bool is_one = settings.is_skipping && is_gray(scene);
  plan.channels = is_one ? 1 : 3;
  if (is_one)
    plan.skips.push_back({"two of three colour channels", "all vertices", "every albedo is gray", "none"});
}

}  // namespace

Plan make_plan(const scene::Scene& scene, const std::vector<trace::SurfacePoint>& points,
               const BakeSettings& settings) {
  Plan plan;
  plan.is_reflecting = settings.kind == Kind::interreflected;
  if (settings.kind == Kind::unshadowed) {
    if (settings.is_skipping && settings.bands > 3) {
      plan.skips.push_back({"odd bands above 1", "all vertices",
                            "a cosine lobe has no energy there (A_l = 0)", "none: exactly 0"});
    }
    return plan;
  }
  if (settings.is_skipping) plan_rays(scene, points, settings.threads, plan);
  if (plan.is_reflecting) plan_bounces(scene, settings, plan);
  return plan;
}

std::string to_text(const Plan& plan) {
  if (plan.skips.empty()) return "the plan skips nothing\n";
  std::string text;
  for (const Skip& skip : plan.skips) {
    text += fmt::format("the plan skips {} at {}: {} (change of the result: {})\n", skip.what, skip.where,
                        skip.why, skip.change);
  }
  return text;
}

}  // namespace plumbline::transfer
