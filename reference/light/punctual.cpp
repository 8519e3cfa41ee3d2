#include "reference/light/punctual.hpp"

#include <algorithm>
#include <limits>

namespace plumbline::light {
namespace {

struct Towards {
  Vec3d direction;
  double distance;
};

Towards towards(Vec3 light_position, Vec3 point) {
  const Vec3d offset = Vec3d(light_position) - Vec3d(point);
  const double distance = glm::length(offset);
  return {offset / distance, distance};
}

PunctualSample point_sample(const Towards& path, Rgb radiant_intensity, double attenuation) {
  const RgbD irradiance = RgbD(radiant_intensity) * (attenuation / (path.distance * path.distance));
  return {Vec3(path.direction), static_cast<float>(path.distance), Rgb(irradiance)};
}

double spot_attenuation(const SpotLight& light, Vec3d from_light) {
  const double cos_inner = std::cos(static_cast<double>(light.inner_angle_rad));
  const double cos_outer = std::cos(static_cast<double>(light.outer_angle_rad));
  const double cos_angle = glm::dot(Vec3d(light.direction), from_light);
  const double ramp = (cos_angle - cos_outer) / std::max(0.001, cos_inner - cos_outer);
  const double clamped = std::clamp(ramp, 0.0, 1.0);
  return clamped * clamped;
}

struct IncidentFrom {
  Vec3 point;

  PunctualSample operator()(const PointLight& light) const {
    return point_sample(towards(light.position, point), light.radiant_intensity, 1.0);
  }
  PunctualSample operator()(const SpotLight& light) const {
    const Towards path = towards(light.position, point);
    return point_sample(path, light.radiant_intensity, spot_attenuation(light, -path.direction));
  }
  PunctualSample operator()(const DirectionalLight& light) const {
    return {-light.direction, std::numeric_limits<float>::infinity(), light.irradiance};
  }
};

}  // namespace

PunctualSample incident_from(const PunctualLight& light, Vec3 point) {
  return std::visit(IncidentFrom{point}, light);
}

}  // namespace plumbline::light
