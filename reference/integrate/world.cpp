#include "reference/integrate/world.hpp"

#include <algorithm>
#include <utility>

namespace plumbline::integrate {
namespace {

bool is_constant(const light::Environment& environment) {
  return std::holds_alternative<light::ConstantSky>(environment.sky) && environment.suns.empty();
}

bool is_any_emissive_in(const scene::Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(),
                     [](const scene::Material& material) { return !is_black(material.emission); });
}

}  // namespace

World::World(scene::Scene scene_value, light::Environment environment_value)
    : scene(std::move(scene_value)),
      environment(std::move(environment_value)),
      caster(scene),
      emitters(scene),
      environment_sampler(environment),
      is_sky_sampled(!is_constant(environment)),
      is_sky_black(light::is_black(environment)),
      is_any_emissive(is_any_emissive_in(scene)) {}

}  // namespace plumbline::integrate
