// reference/integrate/world.hpp: a scene under its lights, made ready for tracing.
#pragma once

#include "reference/integrate/emitters.hpp"
#include "reference/light/environment.hpp"
#include "reference/light/environment_sampler.hpp"
#include "reference/scene/scene.hpp"
#include "reference/trace/ray_caster.hpp"
#include "reference/trace/surface_table.hpp"

namespace plumbline::integrate {

/// Scene, light, hierarchy and sampling tables. Immutable; safe to use from many threads.
class World {
 public:
  World(scene::Scene scene, light::Environment environment);
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  const scene::Scene scene;
  const light::Environment environment;
  const trace::RayCaster caster;
  const trace::SurfaceTable surfaces;
  const EmitterTable emitters;
  const light::EnvironmentSampler environment_sampler;
  /// A constant sky without suns is sampled best by the cosine alone: zero variance where nothing blocks.
  const bool is_sky_sampled;
  const bool is_sky_black;
};

}  // namespace plumbline::integrate
