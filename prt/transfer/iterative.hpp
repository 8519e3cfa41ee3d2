// prt/transfer/iterative.hpp: interreflected transfer by the papers' iteration (method.hpp, Solver::iterative).
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "prt/sh/batch.hpp"
#include "prt/transfer/direction_sampler.hpp"
#include "prt/transfer/plan.hpp"
#include "prt/transfer/set_statistics.hpp"
#include "prt/transfer/transfer.hpp"
#include "reference/scene/scene.hpp"
#include "reference/trace/ray_caster.hpp"
#include "reference/trace/surface_point.hpp"
#include "reference/trace/surface_table.hpp"

namespace plumbline::transfer {

/// What an iteration needs; outlives it.
struct IterativeWork {
  const scene::Scene* scene = nullptr;
  const trace::RayCaster* caster = nullptr;
  const trace::SurfaceTable* surfaces = nullptr;
  const DirectionSampler* sampler = nullptr;
  const sh::BatchBasis<float>* basis = nullptr;
  const std::vector<trace::SurfacePoint>* vertices = nullptr;
  const std::vector<Above>* above = nullptr;  // by vertex, or empty
  int max_bounces = kAllBounces;
  int kept_terms = 0;
  int sets = kSets;
  double allowed_error = 0.0;  // root mean square of the vectors' errors, absolute; 0: none asked for
  int threads = 0;
  std::function<void(double fraction)> progress;
};

/// Fills coefficients, standard errors, terms, samples and remainder of a transfer whose bands, channels and number of vertices are set.
/// @throws InputError when light is still bouncing after kMostIterations
void solve_iteratively(const IterativeWork& work, Transfer& transfer);

}  // namespace plumbline::transfer
