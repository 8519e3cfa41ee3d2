#include "reference/light/punctual.hpp"

#include <gtest/gtest.h>

#include <array>

namespace plumbline::light {
namespace {

// Float results of double arithmetic: one rounding, relative 6e-8.
constexpr float kRounding = 2e-7F;

TEST(PunctualLight, PointLightFallsWithTheSquareOfTheDistance) {
  const PunctualSample sample =
      incident_from(PointLight{{1.0F, 2.0F, 3.0F}, {8.0F, 4.0F, 2.0F}}, {1.0F, 0.0F, 3.0F});
  EXPECT_EQ(sample.direction, Vec3(0.0F, 1.0F, 0.0F));
  EXPECT_EQ(sample.distance, 2.0F);
  EXPECT_EQ(sample.irradiance, Rgb(2.0F, 1.0F, 0.5F));
}

TEST(PunctualLight, GivesTheClosedFormOnAPlane) {
  // E = I h / (h^2 + x^2)^(3/2), I = 1, h = 2, x = 1
  const PunctualSample sample = incident_from(PointLight{{1.0F, 2.0F, 0.0F}, Rgb(1.0F)}, Vec3(0.0F));
  EXPECT_LE(std::abs(sample.irradiance.x * sample.direction.y - 0.178885438F), kRounding);
}

TEST(PunctualLight, DirectionalLightComesFromInfinity) {
  const PunctualSample sample = incident_from(DirectionalLight{{0.0F, -1.0F, 0.0F}, Rgb(3.0F)}, Vec3(5.0F));
  EXPECT_EQ(sample.direction, Vec3(0.0F, 1.0F, 0.0F));
  EXPECT_TRUE(std::isinf(sample.distance));
  EXPECT_EQ(sample.irradiance, Rgb(3.0F));
}

// The spot at height 1 shines straight down; the point lies `angle` off its axis.
float spot_at(float angle, float inner, float outer) {
  const SpotLight spot{{0.0F, 1.0F, 0.0F}, {0.0F, -1.0F, 0.0F}, Rgb(1.0F), inner, outer};
  const Vec3 point(std::sin(angle), 1.0F - std::cos(angle), 0.0F);
  return incident_from(spot, point).irradiance.x;
}

TEST(PunctualLight, SpotIsFullInsideAndDarkOutsideItsCone) {
  EXPECT_LE(std::abs(spot_at(0.0F, 0.3F, 0.6F) - 1.0F), kRounding);
  EXPECT_LE(std::abs(spot_at(0.29F, 0.3F, 0.6F) - 1.0F), 1e-6F);
  EXPECT_EQ(spot_at(0.61F, 0.3F, 0.6F), 0.0F);
  EXPECT_EQ(spot_at(3.0F, 0.3F, 0.6F), 0.0F);
}

TEST(PunctualLight, SpotRampIsTheSquareOfALineInTheCosine) {
  const double inner = 0.3;
  const double outer = 0.6;
  for (const double angle : {0.35, 0.45, 0.55}) {
    const double ramp = (std::cos(angle) - std::cos(outer)) / (std::cos(inner) - std::cos(outer));
    const float value = spot_at(static_cast<float>(angle), 0.3F, 0.6F);
    // the angle's own rounding, 6e-8, is amplified by the ramp's slope (about 5)
    EXPECT_LE(std::abs(static_cast<double>(value) - ramp * ramp), 2e-6) << "angle " << angle;
  }
}

TEST(PunctualLight, IsSingularAtItsOwnPosition) {
  const PunctualSample sample = incident_from(PointLight{Vec3(1.0F), Rgb(1.0F)}, Vec3(1.0F));
  EXPECT_TRUE(std::isinf(sample.irradiance.x));
  EXPECT_TRUE(std::isnan(sample.direction.x));
}

}  // namespace
}  // namespace plumbline::light
