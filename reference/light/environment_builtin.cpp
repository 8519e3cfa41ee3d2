#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reference/base/error.hpp"
#include "reference/light/environment.hpp"
#include "reference/light/environment_lookup.hpp"

namespace plumbline::light {
namespace {

Environment constant(const Rgb& radiance) {
  Environment result;
  result.sky = ConstantSky{radiance};
  return result;
}

Environment analytic(std::function<Rgb(const Vec3&)> radiance) {
  Environment result;
  result.sky = AnalyticSky{std::move(radiance)};
  return result;
}

// CIE standard overcast sky (Moon and Spencer 1942), Z the zenith distance: L = L_zenith (1 + 2 cos Z) / 3.
Rgb overcast_radiance(const Vec3& direction) {
  return direction.y < 0.0F ? Rgb(0.0F) : Rgb((1.0F + 2.0F * direction.y) / 3.0F);
}

// max(0, 5 cos t - 4) + max(0, -4 sin(t - pi) cos(p - 2.5) - 3): two cones about +z and (cos 2.5, sin 2.5,
// 0). -sin(t - pi) = sin t, and sin t cos(p - 2.5) is the cosine to the second axis.
Rgb two_lobes_radiance(const Vec3& direction) {
  static const auto kAxisX = static_cast<float>(std::cos(2.5));
  static const auto kAxisY = static_cast<float>(std::sin(2.5));
  const float first = 5.0F * direction.z - 4.0F;
  const float second = 4.0F * (direction.x * kAxisX + direction.y * kAxisY) - 3.0F;
  return Rgb(std::max(0.0F, first) + std::max(0.0F, second));
}

// Sky: L(y) = zenith + (horizon - zenith) (1 - y)^3 for y >= 0, a dim brown below. Its irradiance on the
// ground is 2 pi int L y dy = pi (0.9 zenith + 0.1 horizon), since int (1 - y)^3 y dy = 1/20: luminance 1.25.
// Sun: pi sin^2(half angle) L cos 45 deg = 3.77 in luminance, three times the sky's.
constexpr Rgb kZenith(0.15F, 0.35F, 0.85F);
constexpr Rgb kHorizon(0.8F, 0.9F, 1.0F);
constexpr Rgb kGround(0.06F, 0.05F, 0.04F);
constexpr Rgb kSun(84000.0F, 78000.0F, 66000.0F);
constexpr double kSunHalfAngleDegrees = 0.2665;

Rgb clear_sky_radiance(const Vec3& direction) {
  if (direction.y < 0.0F) return kGround;
  const float below_zenith = 1.0F - direction.y;
  return kZenith + (kHorizon - kZenith) * (below_zenith * below_zenith * below_zenith);
}

Environment sun_sky() {
  Environment result = analytic(clear_sky_radiance);
  const auto up = static_cast<float>(std::sqrt(0.5));
  result.suns.push_back({Vec3(0.5F, up, 0.5F), kSunHalfAngleDegrees * (kPi / 180.0), kSun});
  return result;
}

struct Entry {
  const char* name;
  const char* description;
  Environment (*make)();
};

constexpr std::array kEntries{
    Entry{"white", "radiance 1 from everywhere", [] { return constant(Rgb(1.0F)); }},
    Entry{"black", "no light", [] { return constant(Rgb(0.0F)); }},
    Entry{"overcast", "CIE overcast sky, (1 + 2 cos t) / 3 with t from +Y, zenith radiance 1; black below",
          [] { return analytic(overcast_radiance); }},
    Entry{"two-lobes", "the papers' analytic light: two smooth cones, about +Z and near -X +Y",
          [] { return analytic(two_lobes_radiance); }},
    Entry{
        "sun-sky",
        "blue sky 0.15 0.35 0.85 at the zenith, 0.8 0.9 1.0 at the horizon, brown ground 0.06 0.05 0.04, and "
        "a sun of half angle 0.2665 degrees and radiance 84000 78000 66000, 45 degrees up between +X and +Z",
        sun_sky},
};

}  // namespace

std::vector<BuiltinEnvironment> builtin_environments() {
  std::vector<BuiltinEnvironment> result;
  for (const Entry& entry : kEntries) result.push_back({entry.name, entry.description});
  return result;
}

Environment make_builtin_environment(const std::string& name) {
  std::string known;
  for (const Entry& entry : kEntries) {
    if (name == entry.name) {
      Environment result = entry.make();
      result.name = "builtin:" + name;
      return result;
    }
    known += fmt::format("{}{}", known.empty() ? "" : ", ", entry.name);
  }
  throw InputError(fmt::format("builtin:{}: no such environment; there are {}", name, known));
}

}  // namespace plumbline::light
