// reference/light/punctual.hpp: lights without extent (KHR_lights_punctual).
#pragma once

#include <variant>

#include "reference/base/vector.hpp"

namespace plumbline::light {

/// Radiant intensity [W sr^-1] in every direction: irradiance I cos / d^2.
struct PointLight {
  Vec3 position{0.0F};
  Rgb radiant_intensity{0.0F};
};

/// A point light that shines into a cone around `direction` (unit, away from the light), with glTF's angular
/// falloff: full inside inner_angle_rad, none outside outer_angle_rad.
struct SpotLight {
  Vec3 position{0.0F};
  Vec3 direction{0.0F, 0.0F, -1.0F};
  Rgb radiant_intensity{0.0F};
  float inner_angle_rad = 0.0F;
  float outer_angle_rad = 0.785398F;
};

/// Parallel light: `irradiance` [W m^-2] on a plane that faces it; `direction` (unit) is the way the light
/// travels.
struct DirectionalLight {
  Vec3 direction{0.0F, 0.0F, -1.0F};
  Rgb irradiance{0.0F};
};

using PunctualLight = std::variant<PointLight, SpotLight, DirectionalLight>;

/// What a light without extent sends to a point.
struct PunctualSample {
  Vec3 direction{0.0F};   // unit, from the point to the light
  float distance = 0.0F;  // infinity for parallel light
  Rgb irradiance{0.0F};   // on a plane that faces the light
};
/// Irradiance I / d^2, times the squared ramp of KHR_lights_punctual for a spot light:
///   clamp((cos(angle) - cos(outer)) / max(0.001, cos(inner) - cos(outer)), 0, 1)^2
/// At the light's own position the direction is undefined (NaN) and the irradiance infinite.
[[nodiscard]] PunctualSample incident_from(const PunctualLight& light, Vec3 point);

}  // namespace plumbline::light
