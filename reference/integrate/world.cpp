#include "reference/integrate/world.hpp"

#include <utility>

namespace plumbline::integrate {
namespace {

bool is_constant(const light::Environment& environment) {
  return std::holds_alternative<light::ConstantSky>(environment.sky) && environment.suns.empty();
}

}  // namespace

World::World(scene::Scene scene_value, light::Environment environment_value)
    : scene(std::move(scene_value)),
      environment(std::move(environment_value)),
      caster(scene),
      surfaces(scene),
      emitters(scene),
      environment_sampler(environment),
      is_sky_sampled(!is_constant(environment)),
      is_sky_black(light::is_black(environment)) {}

}  // namespace plumbline::integrate
