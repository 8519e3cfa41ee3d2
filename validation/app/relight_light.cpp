#include "validation/app/relight_light.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "prt/sh/rotation.hpp"
#include "reference/base/error.hpp"
#include "reference/base/text.hpp"
#include "reference/scene/text.hpp"

namespace plumbline::app {
namespace {

// The name of a file may hold commas: the last one parts it from the weight.
MixOptions parse_mix(const std::string& text) {
  const std::size_t comma = text.find_last_of(',');
  if (comma != std::string::npos && comma > 0) {
    const std::optional<double> weight = scene::parse_number(std::string_view(text).substr(comma + 1));
    if (weight && *weight >= 0.0 && *weight <= 1.0)
      return {text.substr(0, comma), static_cast<float>(*weight)};
  }
  throw InputError(
      fmt::format("--mix: expected ENV2,WEIGHT with a weight from 0 to 1, got {}", quoted(one_line(text))));
}

light::Environment load_unturned(LightOptions options) {
  options.rotation_deg.clear();
  return load(options);
}

}  // namespace

void add_mix_option(CLI::App& verb, MixOptions& options) {
  const std::function<void(const std::string&)> read = [&options](const std::string& text) {
    options = parse_mix(text);
  };
  verb.add_option_function<std::string>("--mix", read,
                                        "mix in another light, which --rotate-env leaves as it stands: "
                                        "(1 - WEIGHT) ENV + WEIGHT ENV2")
      ->type_name("ENV2,WEIGHT");
}

std::string command_text(const MixOptions& options) {
  if (options.source.empty()) return "";
  return fmt::format(" --mix {}", quoted(fmt::format("{},{}", options.source, options.weight)));
}

ProjectedLight load_projected(const LightOptions& light, const MixOptions& mix, int bands, int threads) {
  ProjectedLight result;
  result.environment = load_unturned(light);
  result.coefficients = sh::project_radiance(result.environment, bands, threads);
  if (mix.source.empty()) return result;
  LightOptions other = light;
  other.source = mix.source;
  result.mixed_in = load_unturned(other);
  result.mixed_in_coefficients = sh::project_radiance(result.mixed_in, bands, threads);
  result.weight = mix.weight;
  return result;
}

// The coefficients are turned by the very matrix the environment is: in float, made a rotation to rounding again.
TurnedLight light_turned(const ProjectedLight& light, const Vec3& degrees_xyz) {
  TurnedLight result;
  const light::Environment turned = light::rotated(light.environment, degrees_xyz);
  const glm::dmat3 rotation =
      glm::dmat3(turned.rotation) * glm::transpose(glm::dmat3(light.environment.rotation));
  result.coefficients = sh::rotate(light.coefficients, rotation);
  if (light.mixed_in_coefficients.coefficients.empty()) {
    result.background = [turned](const Vec3& direction) { return light::radiance(turned, direction); };
    return result;
  }
  const auto weight = static_cast<double>(light.weight);
  for (std::size_t i = 0; i < result.coefficients.coefficients.size(); ++i) {
    RgbD& c = result.coefficients.coefficients[i];
    c = (1.0 - weight) * c + weight * light.mixed_in_coefficients.coefficients[i];
  }
  result.background = [turned, &light](const Vec3& direction) {
    return (1.0F - light.weight) * light::radiance(turned, direction) +
           light.weight * light::radiance(light.mixed_in, direction);
  };
  return result;
}

}  // namespace plumbline::app
