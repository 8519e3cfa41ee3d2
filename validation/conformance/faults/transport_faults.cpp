#include "validation/conformance/faults/transport_faults.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "prt/sh/basis.hpp"
#include "prt/transfer/directions.hpp"
#include "reference/base/parallel.hpp"
#include "reference/light/environment.hpp"
#include "reference/scene/shapes.hpp"
#include "reference/trace/ray_caster.hpp"
#include "reference/trace/surface_point.hpp"

namespace plumbline::conformance {
namespace {

using checks::TermsBaker;
using checks::TermsEffort;
using checks::VertexTerms;

/// How a walk goes wrong. As it stands: not at all.
struct Slips {
  float sight = std::numeric_limits<float>::infinity();  // nothing beyond is seen
  double bounce_factor = 1.0;                            // of every bounce
  bool takes_albedo_twice = false;
  bool takes_own_albedo = false;  // of the surface left, not of the one met
  bool reflects_on_backs = false;
  bool forgets_to_normalise = false;   // interpolated normals, at bounces
  bool starts_on_surface = false;      // rays leave without clearance
  float lift = 0.0F;                   // rays start this far above the surface
  bool is_uniform = false;             // directions without the cosine, weighted as if with it
  bool keeps_roulette_weight = false;  // half of the walks end at each bounce, the others go on unchanged
  bool ignores_blockers = false;       // at the first step: direct light comes through
  bool sees_below_horizon = false;     // the cosine is not clamped
};

/// The length that an interpolated normal has before it is made a unit vector.
double normal_length(const scene::Scene& scene, const trace::Hit& hit) {
  const glm::uvec3 corners = scene.triangles[hit.triangle];
  const Vec2 b = hit.barycentrics;
  return static_cast<double>(glm::length((1.0F - b.x - b.y) * scene.normals[corners.x] +
                                         b.x * scene.normals[corners.y] + b.y * scene.normals[corners.z]));
}

/// One walk after the other from one vertex; what escapes at step k adds to term k.
class Walker {
 public:
  Walker(const scene::Scene& scene, const trace::RayCaster& caster, const Slips& slips,
         const TermsEffort& effort)
      : scene_(scene), caster_(caster), slips_(slips), effort_(effort), basis_(effort.bands) {}

  VertexTerms terms(const trace::SurfacePoint& vertex, const Rgb& albedo, std::size_t stream) const {
    const auto count = static_cast<std::size_t>(basis_.coefficient_count());
    VertexTerms sums(static_cast<std::size_t>(effort_.bounces) + 1, std::vector<RgbD>(count, RgbD(0.0)));
    transfer::RandomNumbers random(effort_.seed, stream, 0);
    for (int s = 0; s < effort_.samples; ++s) walk(vertex, albedo, random, sums);
    for (auto& term : sums)
      for (RgbD& value : term) value /= effort_.samples;
    return sums;
  }

 private:
  Vec3d direction(const trace::SurfacePoint& at, transfer::RandomNumbers& random, double& weight) const {
    const double x = random.next();
    const double y = random.next();
    const Vec3d normal(at.shading_normal);
    if (!slips_.is_uniform && !slips_.sees_below_horizon) return transfer::cosine_direction(normal, {x, y});
    const Vec3d w = transfer::sphere_direction({x, y});
    const double cosine = glm::dot(w, normal);
    if (slips_.sees_below_horizon) {
      weight *= 4.0 * cosine;  // 4 pi times cosine over pi
      return w;
    }
    return cosine < 0.0 ? -w : w;
  }

  void walk(trace::SurfacePoint at, Rgb left, transfer::RandomNumbers& random, VertexTerms& sums) const {
    RgbD throughput(1.0);
    std::vector<double> values(static_cast<std::size_t>(basis_.coefficient_count()));
    for (std::size_t k = 0; k < sums.size(); ++k) {
      double weight = 1.0;
      const Vec3d w = direction(at, random, weight);
      throughput *= weight;
      const Vec3 ray = glm::normalize(Vec3(w));
      if (!slips_.sees_below_horizon && !(glm::dot(ray, at.geometric_normal) > 0.0F)) return;
      const Vec3 origin = slips_.starts_on_surface
                              ? at.position
                              : trace::ray_origin(at, ray) + slips_.lift * at.geometric_normal;
      const std::optional<trace::Hit> hit = caster_.closest_hit({origin, ray, slips_.sight});
      if (!hit || (slips_.ignores_blockers && k == 0)) {
        basis_.evaluate(w.x, w.y, w.z, values);
        for (std::size_t i = 0; i < values.size(); ++i) sums[k][i] += throughput * values[i];
      }
      if (!hit || !bounce(*hit, ray, random, at, left, throughput)) return;
    }
  }

  /// To the other end of the ray; false where the walk ends.
  bool bounce(const trace::Hit& hit, const Vec3& ray, transfer::RandomNumbers& random,
              trace::SurfacePoint& at, Rgb& left, RgbD& throughput) const {
    const trace::SurfaceHit met = trace::surface_hit(scene_, hit, ray);
    const scene::Material& material = scene_.materials[scene_.triangle_materials[hit.triangle]];
    if (!met.is_front && !material.is_double_sided && !slips_.reflects_on_backs) return false;
    const Rgb albedo = scene::albedo_at(scene_, hit.triangle, hit.barycentrics);
    throughput *= RgbD(slips_.takes_own_albedo ? left : albedo) * slips_.bounce_factor;
    if (slips_.takes_albedo_twice) throughput *= RgbD(albedo);
    if (slips_.forgets_to_normalise) throughput *= normal_length(scene_, hit);
    if (slips_.keeps_roulette_weight && random.next() < 0.5) return false;
    at = met.point;
    left = albedo;
    return true;
  }

  const scene::Scene& scene_;
  const trace::RayCaster& caster_;
  const Slips& slips_;
  const TermsEffort& effort_;
  sh::Basis<double> basis_;
};

TermsBaker walking(const std::string& name, const Slips& slips) {
  return {name, [slips](const scene::Scene& scene, std::span<const std::size_t> vertices,
                        const TermsEffort& effort) {
            const trace::RayCaster caster(scene);
            const std::vector<trace::SurfacePoint> points = trace::vertex_points(scene);
            const std::vector<Rgb> albedos = scene::vertex_albedos(scene);
            const Walker walker(scene, caster, slips, effort);
            std::vector<VertexTerms> result(vertices.size());
            parallel_for(vertices.size(), effort.threads, [&](std::size_t i) {
              result[i] = walker.terms(points[vertices[i]], albedos[vertices[i]], vertices[i]);
            });
            return result;
          }};
}

/// The right walks, their terms put together wrongly.
TermsBaker rearranged(const std::string& name, void (*rearrange)(VertexTerms& terms)) {
  const TermsBaker right = walking(name, {});
  return {name, [right, rearrange](const scene::Scene& scene, std::span<const std::size_t> vertices,
                                   const TermsEffort& effort) {
            std::vector<VertexTerms> result = right.terms(scene, vertices, effort);
            for (VertexTerms& terms : result) rearrange(terms);
            return result;
          }};
}

// T_(k+1) = (1 + K) T_k: what the last step adds is K T_(k-1) = sum_j C(k-1, j-1) K^j T_0.
void feed_back_all(VertexTerms& terms) {
  const VertexTerms right = terms;
  for (std::size_t k = 1; k < terms.size(); ++k) {
    std::fill(terms[k].begin(), terms[k].end(), RgbD(0.0));
    double binomial = 1.0;
    for (std::size_t j = 1; j <= k; ++j) {
      for (std::size_t i = 0; i < terms[k].size(); ++i) terms[k][i] += binomial * right[j][i];
      binomial *= static_cast<double>(k - j) / static_cast<double>(j);
    }
  }
}

void lose_first_bounce(VertexTerms& terms) {
  for (std::size_t k = 1; k + 1 < terms.size(); ++k) terms[k] = terms[k + 1];
  std::fill(terms.back().begin(), terms.back().end(), RgbD(0.0));
}

void lose_last_bounce(VertexTerms& terms) {
  std::fill(terms.back().begin(), terms.back().end(), RgbD(0.0));
}

void break_with_nan(VertexTerms& terms) {
  terms[1][0].x = std::numeric_limits<double>::quiet_NaN();
}

void swap_channels(VertexTerms& terms) {
  for (std::size_t k = 1; k < terms.size(); ++k)
    for (RgbD& value : terms[k]) std::swap(value.x, value.y);
}

}  // namespace

TermsBaker plain_terms() {
  return walking("plain walks", {});
}

std::vector<TransportFault> seeded_transport_faults() {
  std::vector<TransportFault> all;
  const auto slip = [&](const char* name, const char* wrong, const char* check, const Slips& slips) {
    all.push_back({name, wrong, check, walking(name, slips)});
  };
  const auto order = [&](const char* name, const char* wrong, const char* check,
                         void (*rearrange)(VertexTerms&)) {
    all.push_back({name, wrong, check, rearranged(name, rearrange)});
  };
  order("M11", "T <- (1 + K) T: all bounces reflected again, not the last", "open-box / M11, bounce 2",
        feed_back_all);
  slip("M12", "a bounce without 1/pi", "open-box / M12, bounce 1", {.bounce_factor = kPi});
  slip("T28", "a bounce without the 4 pi of its directions, and 1/pi with them: a quarter",
       "open-box / T28, bounce 1", {.bounce_factor = 0.25});
  order("M25", "one bounce missing", "open-box / M25, bounce 1", lose_first_bounce);
  order("T42", "a bounce limit one short", "open-box / T42, bounce 3", lose_last_bounce);
  slip("T29", "interpolated normals not normalised at bounces", "rounded / T29, bounce 1",
       {.forgets_to_normalise = true});
  slip("T31", "occluders farther than 100 vanish", "far box / T31, bounce 0", {.sight = 100.0F});
  slip("T33", "albedo twice at every bounce", "open-box / T33, bounce 1", {.takes_albedo_twice = true});
  slip("T48", "the receiver's albedo in place of the emitter's", "infinite corner, albedos 0.5 and 0.8 / T48",
       {.takes_own_albedo = true});
  slip("T37", "directions uniform over the hemisphere, without the cosine", "open-box / T37, bounce 1",
       {.is_uniform = true});
  slip("L4", "cosine not clamped below the horizon", "open-box / L4, bounce 0", {.sees_below_horizon = true});
  slip("T41", "Russian roulette without its weight", "open-box / T41, bounce 2",
       {.keeps_roulette_weight = true});
  slip("BACK", "back faces of single-sided surfaces reflect", "lid / BACK, bounce 1",
       {.reflects_on_backs = true});
  slip("T43a", "rays start on the surface and meet it", "rounded / T43a, bounce 0",
       {.starts_on_surface = true});
  slip("T43b", "rays start so far off the surface that they pass what is near", "lid / T43b, bounce 0",
       {.lift = 0.3F});
  slip("T12", "direct light comes through what blocks it", "open-box / T12, bounce 0",
       {.ignores_blockers = true});
  order("NAN", "a value that is no number", "open-box / NAN, bounce 1", break_with_nan);
  order("RGB", "red and green of the bounces exchanged", "infinite corner, albedos 0.8 and 0.8 / RGB",
        swap_channels);
  return all;
}

namespace {

/// Everything a thousand times as large: what is near in a small scene is far in it.
scene::Scene scaled(scene::Scene scene, float factor) {
  for (Vec3& position : scene.positions) position *= factor;
  return scene;
}

/// A floor under the back of a single-sided plate, which blocks and must not reflect.
scene::Scene under_a_lid() {
  scene::Scene scene;
  const auto material = scene::add_material(scene, {.name = "white", .albedo = Rgb(0.8F)});
  scene::append(scene, scene::make_grid({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, 4, 4), material);
  scene::append(scene, scene::make_grid({-1, 0.8, 1}, {2, 0, 0}, {0, 0, -2}, 1, 1), material);  // front above
  scene::append(scene, scene::make_grid({-1, 0, -1}, {2, 0, 0}, {0, 0.7, 0}, 2, 2), material);
  return scene;
}

/// A floor and a wall whose vertex normals lean by 50 degrees to either side, so that between them they are short. All
/// of it is turned, so that no computed point lies in its plane exactly.
scene::Scene rounded() {
  scene::Scene scene;
  const auto material = scene::add_material(scene, {.name = "white", .albedo = Rgb(0.8F)});
  scene::append(scene, scene::make_grid({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, 4, 4), material);
  scene::Mesh wall = scene::make_grid({-1, 0, -1}, {2, 0, 0}, {0, 2, 0}, 1, 1);
  for (std::size_t v = 0; v < wall.normals.size(); ++v) {
    const float lean = wall.positions[v].x < 0.0F ? -1.0F : 1.0F;
    wall.normals[v] = glm::normalize(wall.normals[v] + Vec3(1.2F * lean, 0.0F, 0.0F));
  }
  scene::append(scene, wall, material);
  const glm::mat3 turn = light::rotated({}, {20.0F, 35.0F, 50.0F}).rotation;
  for (Vec3& position : scene.positions) position = turn * position;
  for (Vec3& normal : scene.normals) normal = glm::normalize(turn * normal);
  return scene;
}

}  // namespace

TransportTrial prepare_trial(const checks::Budget& budget) {
  TransportTrial trial;
  trial.budget = budget;
  trial.effort.samples = 512;
  trial.effort.seed = budget.seed;
  trial.effort.threads = budget.threads;
  trial.corner_effort = trial.effort;
  trial.corner_effort.samples = 1 << 18;
  trial.corner_effort.bounces = 4;
  constexpr std::size_t kVertices = 24;
  constexpr int kPaths = 4096;
  for (const checks::NamedShape& shape : checks::bounce_shapes()) {
    if (shape.name != "open-box") continue;
    trial.cases.push_back(checks::trace_bounces(shape.name, shape.scene, kVertices, kPaths, budget));
    trial.cases.push_back(
        checks::trace_bounces("far box", scaled(shape.scene, 1000.0F), kVertices, kPaths, budget));
  }
  trial.cases.push_back(checks::trace_bounces("lid", under_a_lid(), kVertices, kPaths, budget));
  trial.cases.push_back(checks::trace_bounces("rounded", rounded(), kVertices, kPaths, budget));
  return trial;
}

std::vector<checks::Finding> run_trial(const TransportTrial& trial, const TermsBaker& baker) {
  std::vector<checks::Finding> all = checks::judge_corner(baker, trial.corner_effort);
  for (const checks::BounceCase& one : trial.cases) {
    for (checks::Finding& finding : checks::judge_bounces(one, baker, trial.effort, trial.budget))
      all.push_back(std::move(finding));
  }
  return all;
}

}  // namespace plumbline::conformance
