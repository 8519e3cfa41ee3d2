// validation/app/relight_light.hpp: the lights of `plumbline relight`: projected once, then turned and mixed as
// coefficients.
#pragma once

#include "prt/sh/lighting.hpp"
#include "validation/app/common.hpp"

namespace plumbline::app {

/// --mix ENV2,WEIGHT: (1 - weight) of the light and `weight` of another.
struct MixOptions {
  std::string source;
  float weight = 0.0F;  // 0 to 1
};
void add_mix_option(CLI::App& verb, MixOptions& options);
/// The option as words of a shell command, a blank in front; empty when it was not given.
[[nodiscard]] std::string command_text(const MixOptions& options);

/// Both lights, as loaded and as coefficients. What --rotate-env asks for is done by light_turned.
struct ProjectedLight {
  light::Environment environment;
  light::Environment mixed_in;  // black without --mix
  sh::ShRgb coefficients;
  sh::ShRgb mixed_in_coefficients;
  float weight = 0.0F;
};
/// @param light  --env and how it is read, which holds for the light mixed in too
[[nodiscard]] ProjectedLight load_projected(const LightOptions& light, const MixOptions& mix, int bands,
                                            int threads);

/// The light of one picture: the environment turned by these degrees (as --rotate-env), what is mixed in as it stands.
struct TurnedLight {
  sh::ShRgb coefficients;
  std::function<Rgb(const Vec3& direction)> background;  // radiance; valid as long as the ProjectedLight
};
[[nodiscard]] TurnedLight light_turned(const ProjectedLight& light, const Vec3& degrees_xyz);

}  // namespace plumbline::app
