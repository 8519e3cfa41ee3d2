// validation/checks/bounces.hpp: interreflected transfer, bounce by bounce, against path-traced irradiance under the light
// it sees. Takes any way of baking, so that ways with a fault can be judged as ours is.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "prt/sh/lighting.hpp"
#include "reference/scene/scene.hpp"
#include "validation/checks/case.hpp"
#include "validation/checks/finding.hpp"

namespace plumbline::checks {

/// What light that bounced k times adds to a vertex's transfer vector: [bounce][coefficient], r, g, b.
using VertexTerms = std::vector<std::vector<RgbD>>;

struct TermsEffort {
  int bands = 3;
  int bounces = 3;     // terms 0 … bounces
  int samples = 1024;  // directions a vertex
  std::uint64_t seed = 0;
  int threads = 0;
};

/// A way of baking: terms of the named vertices of a scene. Another seed gives an independent answer.
struct TermsBaker {
  std::string name;
  std::function<std::vector<VertexTerms>(const scene::Scene& scene, std::span<const std::size_t> vertices,
                                         const TermsEffort& effort)>
      terms;
};
/// Random walks from each vertex: nothing is interpolated on the way.
[[nodiscard]] TermsBaker traced_terms();
/// Bounce k gathered from bounce k-1 of all vertices, interpolated over triangles.
[[nodiscard]] TermsBaker iterated_terms();

/// A scene, its light, and the path tracer's irradiance of every bounce, in two independent halves.
struct BounceCase {
  std::string name;
  scene::Scene scene;
  std::vector<std::size_t> vertices;
  sh::ShRgb light;
  int bounces = 3;
  std::vector<std::vector<RgbD>> halves[2];  // [vertex][bounce] mean
  std::vector<std::vector<RgbD>> errors[2];  // and its standard error
};
/// @param vertices  at most so many, evenly spread over the scene's
[[nodiscard]] BounceCase trace_bounces(const std::string& name, scene::Scene scene, std::size_t vertices,
                                       int samples, const Budget& budget);

/// corner, open-box and cornell without its lamp.
struct NamedShape {
  std::string name;
  scene::Scene scene;
};
[[nodiscard]] std::vector<NamedShape> bounce_shapes();

/// How a baker differs at one bounce, over the mean irradiance of that bounce.
struct BounceDifference {
  double mean_irradiance = 0.0;
  double bias = 0.0;            // mean over vertices and channels
  double standard_error = 0.0;  // of both sides
  double degrees_of_freedom = 0.0;
  double square = 0.0;  // mean squared difference, noise taken off
  double square_error = 0.0;
};
[[nodiscard]] std::vector<BounceDifference> measure_bounces(const BounceCase& one, const TermsBaker& baker,
                                                            const TermsEffort& effort);

/// Two findings a bounce: its mean is equal (two one-sided tests), and every vertex is (mean square without noise).
[[nodiscard]] std::vector<Finding> judge_bounces(const BounceCase& one, const TermsBaker& baker,
                                                 const TermsEffort& effort, const Budget& budget);

/// The vector of an infinite corner for three pairs of albedos at once, each to 1e-3 of its norm; white: T_00.
[[nodiscard]] std::vector<Finding> judge_corner(const TermsBaker& baker, const TermsEffort& effort);

}  // namespace plumbline::checks
