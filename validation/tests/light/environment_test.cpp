#include "reference/light/environment.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "reference/base/error.hpp"
#include "validation/tests/light/support.hpp"

namespace plumbline::light {
namespace {

using testing::Numbers;
using testing::special_directions;

// Mappings are float arithmetic of about 5 roundings (6e-8 each) on values up to 1.
constexpr double kUvTolerance = 2e-7;
constexpr int kRandomDirections = 100000;

std::vector<Vec3> many_directions() {
  std::vector<Vec3> result = special_directions();
  Numbers numbers;
  for (int i = 0; i < kRandomDirections; ++i) result.push_back(numbers.direction());
  return result;
}

// An angle between float directions: 3 components rounded to 6e-8, and uv to 1e-7 of half a turn or more.
constexpr double kAngleTolerance = 2e-6;

double angle_between(const Vec3& a, const Vec3& b) {
  return 2.0 * std::asin(std::min(1.0, 0.5 * glm::length(Vec3d(a) - Vec3d(b))));
}

bool is_inside_unit_square(const Vec2& uv) {
  return uv.x >= 0.0F && uv.x <= 1.0F && uv.y >= 0.0F && uv.y <= 1.0F;
}

TEST(LatLong, HasItsCentreAtPlusXAndPlusZToTheRight) {
  EXPECT_EQ(lat_long_from_direction({1, 0, 0}), Vec2(0.5F, 0.5F));
  EXPECT_EQ(lat_long_from_direction({0, 0, 1}), Vec2(0.75F, 0.5F));
  EXPECT_EQ(lat_long_from_direction({0, 0, -1}), Vec2(0.25F, 0.5F));
  EXPECT_EQ(lat_long_from_direction({0, 1, 0}).y, 0.0F);
  EXPECT_EQ(lat_long_from_direction({0, -1, 0}).y, 1.0F);
  EXPECT_EQ(lat_long_from_direction({-1, 0, 0.0F}), Vec2(1.0F, 0.5F));
  EXPECT_EQ(lat_long_from_direction({-1, 0, -0.0F}), Vec2(0.0F, 0.5F));
}

TEST(LatLong, IsTheFormulaOfTheConventions) {
  for (const Vec3& direction : many_directions()) {
    const Vec3d d(direction);
    const Vec2 uv = lat_long_from_direction(direction);
    const double u = 0.5 + std::atan2(d.z, d.x) / (2.0 * kPi);
    const double v = std::atan2(std::sqrt(d.x * d.x + d.z * d.z), d.y) / kPi;  // acos(y)
    ASSERT_LE(std::abs(static_cast<double>(uv.x) - u), kUvTolerance) << d.x << " " << d.y << " " << d.z;
    ASSERT_LE(std::abs(static_cast<double>(uv.y) - v), kUvTolerance) << d.x << " " << d.y << " " << d.z;
  }
}

TEST(LatLong, ReturnsToTheSameDirection) {
  for (const Vec3& direction : many_directions()) {
    const Vec2 uv = lat_long_from_direction(direction);
    ASSERT_TRUE(is_inside_unit_square(uv)) << uv.x << " " << uv.y;
    ASSERT_LE(angle_between(direction_from_lat_long(uv), direction), kAngleTolerance);
  }
}

TEST(AngularMap, HasItsCentreAtPlusZAndItsRimAtMinusZ) {
  EXPECT_EQ(angular_map_from_direction({0, 0, 1}), Vec2(0.5F, 0.5F));
  EXPECT_EQ(angular_map_from_direction({1, 0, 0}), Vec2(0.75F, 0.5F));
  EXPECT_EQ(angular_map_from_direction({0, 1, 0}), Vec2(0.5F, 0.25F));
  EXPECT_EQ(angular_map_from_direction({-1, 0, 0}), Vec2(0.25F, 0.5F));
  EXPECT_EQ(angular_map_from_direction({0, -1, 0}), Vec2(0.5F, 0.75F));
  const Vec2 rim = angular_map_from_direction({0, 0, -1});
  EXPECT_LE(std::abs(glm::length(rim - Vec2(0.5F)) - 0.5F), 1e-7F);
}

TEST(AngularMap, ReturnsToTheSameDirection) {
  for (const Vec3& direction : many_directions()) {
    const Vec2 uv = angular_map_from_direction(direction);
    ASSERT_TRUE(is_inside_unit_square(uv)) << uv.x << " " << uv.y;
    ASSERT_LE(angle_between(direction_from_angular_map(uv), direction), kAngleTolerance);
  }
}

// Around -Z the texel must come from the rim of the disc, from every side and at every distance.
TEST(AngularMap, SweepsTheRimInsideTheImage) {
  constexpr int kSize = 16;
  Environment environment;
  environment.sky = AngularMapSky{image::make_image(kSize, kSize, Rgb(1.0F))};
  for (const float away : {0.0F, 1e-42F, 1e-30F, 1e-22F, 1e-12F, 1e-6F, 1e-3F}) {
    for (int i = 0; i < 360; ++i) {
      const float phi = glm::radians(static_cast<float>(i));
      const Vec3 direction = glm::normalize(Vec3(away * std::cos(phi), away * std::sin(phi), -1.0F));
      const Vec2 uv = angular_map_from_direction(direction);
      ASSERT_TRUE(is_inside_unit_square(uv)) << "away " << away << " at " << i;
      ASSERT_GE(glm::length(uv - Vec2(0.5F)), 0.4995F) << "away " << away << " at " << i;
      ASSERT_EQ(radiance(environment, direction), Rgb(1.0F));
    }
  }
}

// The table of CONVENTIONS.md, written out again.
Vec3d opengl_face_point(int face, double s, double t) {
  switch (face) {
    case 0:
      return {1, -t, -s};
    case 1:
      return {-1, -t, s};
    case 2:
      return {s, 1, t};
    case 3:
      return {s, -1, -t};
    case 4:
      return {s, -t, 1};
    default:
      return {-s, -t, -1};
  }
}

TEST(CubeMap, HasOpenGlsFaces) {
  for (int face = 0; face < 6; ++face) {
    for (const double s : {-0.75, -0.25, 0.5}) {
      for (const double t : {-0.5, 0.25, 0.875}) {
        const Vec3 expected(glm::normalize(opengl_face_point(face, s, t)));
        const Vec2 uv(Vec3d(0.5 * s + 0.5, 0.5 * t + 0.5, 0.0));
        EXPECT_LE(glm::length(direction_from_cube({face, uv}) - expected), 1e-6F);
        const CubeCoordinate back = cube_from_direction(expected);
        EXPECT_EQ(back.face, face);
        EXPECT_LE(glm::length(back.uv - uv), 2e-7F);
      }
    }
  }
}

TEST(CubeMap, ReturnsToTheSameDirectionAlsoOnEdgesAndCorners) {
  for (const Vec3& direction : many_directions()) {
    const CubeCoordinate coordinate = cube_from_direction(direction);
    ASSERT_GE(coordinate.face, 0);
    ASSERT_LT(coordinate.face, 6);
    ASSERT_TRUE(is_inside_unit_square(coordinate.uv)) << coordinate.uv.x << " " << coordinate.uv.y;
    ASSERT_LE(angle_between(direction_from_cube(coordinate), direction), kAngleTolerance);
  }
}

// A point at least 1/50 of a texel from the borders belongs to its texel in images as large as they come.
TEST(EnvironmentMappings, AreExactToATexelAt8192) {
  Numbers numbers;
  const auto coordinate = [&](int count) {
    const int texel = static_cast<int>(numbers.next() * static_cast<float>(count));
    const double offset = 0.02 + 0.96 * static_cast<double>(numbers.next());
    return std::pair(texel, static_cast<float>((texel + offset) / count));
  };
  const auto index = [](float value, int count) {
    return static_cast<int>(value * static_cast<float>(count));
  };
  for (int i = 0; i < kRandomDirections; ++i) {
    const auto [x, u] = coordinate(8192);
    const auto [y, v] = coordinate(4096);
    const Vec2 lat_long = lat_long_from_direction(direction_from_lat_long({u, v}));
    ASSERT_EQ(std::pair(index(lat_long.x, 8192), index(lat_long.y, 4096)), std::pair(x, y));
    const CubeCoordinate cube = cube_from_direction(direction_from_cube({i % 6, {u, v}}));
    ASSERT_EQ(cube.face, i % 6);
    ASSERT_EQ(std::pair(index(cube.uv.x, 8192), index(cube.uv.y, 4096)), std::pair(x, y));
    if (glm::length(Vec2(u, v) - Vec2(0.5F)) > 0.499F) continue;
    const Vec2 angular = angular_map_from_direction(direction_from_angular_map({u, v}));
    ASSERT_EQ(std::pair(index(angular.x, 8192), index(angular.y, 4096)), std::pair(x, y));
  }
}

image::Image numbered_image(int width, int height) {
  image::Image result = image::make_image(width, height);
  for (std::size_t i = 0; i < result.pixels.size(); ++i) result.pixels[i] = Rgb(static_cast<float>(i + 1));
  return result;
}

TEST(EnvironmentRadiance, OfATexelCentreIsThatTexel) {
  const Environment environment = testing::lat_long_environment(numbered_image(8, 4));
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 8; ++x) {
      EXPECT_EQ(radiance(environment, testing::texel_centre(x, y, 8, 4)),
                Rgb(static_cast<float>(8 * y + x + 1)));
    }
  }
}

TEST(EnvironmentRadiance, WrapsAtTheSeamAndClosesAtThePoles) {
  const Environment environment = testing::lat_long_environment(numbered_image(8, 4));
  const float below = 0.1F;  // into row 2, as y < 0
  EXPECT_EQ(radiance(environment, glm::normalize(Vec3(-1, -below, 1e-6F))), Rgb(24.0F));
  EXPECT_EQ(radiance(environment, glm::normalize(Vec3(-1, -below, -1e-6F))), Rgb(17.0F));
  EXPECT_EQ(radiance(environment, glm::normalize(Vec3(-1, -below, 0.0F))), Rgb(24.0F));
  EXPECT_LE(radiance(environment, {0, 1, 0}).x, 8.0F);
  EXPECT_GE(radiance(environment, {0, -1, 0}).x, 25.0F);
}

TEST(EnvironmentRadiance, StaysInsideTheImageForEveryDirection) {
  Environment cube;
  cube.sky = CubeMapSky{{numbered_image(3, 3), numbered_image(3, 3), numbered_image(3, 3),
                         numbered_image(3, 3), numbered_image(3, 3), numbered_image(3, 3)}};
  Environment angular;
  angular.sky = AngularMapSky{numbered_image(3, 3)};
  Environment lat_long = testing::lat_long_environment(numbered_image(9, 1));
  const float nan = std::nanf("");
  std::vector<Vec3> directions = special_directions();
  directions.insert(directions.end(), {Vec3(0.0F), Vec3(nan), Vec3(nan, 0, 1), Vec3(0, -1, nan)});
  for (const Vec3& direction : directions) {
    for (const Environment* environment : {&cube, &angular, &lat_long}) {
      const float value = radiance(*environment, direction).x;
      ASSERT_GE(value, 1.0F);
      ASSERT_LE(value, 9.0F);
    }
  }
}

TEST(EnvironmentRadiance, AddsTheSunsInsideTheirDiscs) {
  constexpr double kHalfAngle = 0.2665 * kPi / 180.0;
  Environment environment = testing::sun_environment({{0, 0, 1}, kHalfAngle, Rgb(5.0F)}, Rgb(1.0F));
  environment.suns.push_back({{0, 0, 1}, 2.0 * kHalfAngle, Rgb(0, 10, 0)});
  const auto at = [&](double angle) {
    return radiance(environment, Vec3(Vec3d(std::sin(angle), 0.0, std::cos(angle))));
  };
  EXPECT_EQ(at(0.0), Rgb(6, 16, 6));
  EXPECT_EQ(at(0.9999 * kHalfAngle), Rgb(6, 16, 6));
  EXPECT_EQ(at(1.0001 * kHalfAngle), Rgb(1, 11, 1));
  EXPECT_EQ(at(2.0001 * kHalfAngle), Rgb(1, 1, 1));
}

TEST(EnvironmentRadiance, OfAWholeSphereSunComesFromEverywhere) {
  const Environment environment = testing::sun_environment({{0, 0, 1}, kPi, Rgb(2.0F)});
  for (const Vec3& direction : special_directions()) ASSERT_EQ(radiance(environment, direction), Rgb(2.0F));
}

// Six colours, one an axis, in the order +X -X +Y -Y +Z -Z.
Environment six_colours() {
  return testing::analytic_environment([](const Vec3& d) {
    const CubeCoordinate coordinate = cube_from_direction(d);
    return Rgb(static_cast<float>(coordinate.face));
  });
}

float colour(const Environment& environment, const Vec3& direction) {
  return radiance(environment, direction).x;
}

TEST(EnvironmentRotation, TurnsRightHandedAboutEachAxis) {
  const Environment about_x = rotated(six_colours(), {90, 0, 0});
  EXPECT_EQ(colour(about_x, {0, 0, 1}), 2.0F);  // +Y went to +Z
  EXPECT_EQ(colour(about_x, {0, -1, 0}), 4.0F);
  const Environment about_y = rotated(six_colours(), {0, 90, 0});
  EXPECT_EQ(colour(about_y, {1, 0, 0}), 4.0F);  // +Z went to +X
  EXPECT_EQ(colour(about_y, {0, 0, -1}), 0.0F);
  const Environment about_z = rotated(six_colours(), {0, 0, 90});
  EXPECT_EQ(colour(about_z, {0, 1, 0}), 0.0F);  // +X went to +Y
  EXPECT_EQ(colour(about_z, {-1, 0, 0}), 2.0F);
}

TEST(EnvironmentRotation, IsAboutXThenYThenZ) {
  const Environment together = rotated(six_colours(), {90, 90, 90});
  const Environment one_by_one = rotated(rotated(rotated(six_colours(), {90, 0, 0}), {0, 90, 0}), {0, 0, 90});
  EXPECT_EQ(together.rotation, one_by_one.rotation);
  // +Y -> +Z (about X) -> +X (about Y) -> +Y (about Z); in the opposite order +Y -> -X -> +Z -> -Y.
  EXPECT_EQ(colour(together, {0, 1, 0}), 2.0F);
}

TEST(EnvironmentRotation, TakesTheSunsAlong) {
  Environment environment = testing::sun_environment({{0, 1, 0}, 0.01, Rgb(1.0F)});
  environment = rotated(environment, {90, 0, 0});
  EXPECT_EQ(radiance(environment, {0, 0, 1}), Rgb(1.0F));
  EXPECT_EQ(radiance(environment, {0, 1, 0}), Rgb(0.0F));
}

TEST(EnvironmentRotation, OfAnyAngleLooksUpTheTurnedBackDirection) {
  const Environment plain = testing::analytic_environment([](const Vec3& d) { return Rgb(d); });
  const Environment turned = rotated(plain, {20, -35, 140});
  Numbers numbers;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 direction = numbers.direction();
    ASSERT_LE(glm::length(radiance(turned, turned.rotation * direction) - Rgb(direction)), 1e-6F);
  }
}

TEST(EnvironmentBuiltin, AreAllMadeAndDescribedInOneLine) {
  const auto all = builtin_environments();
  ASSERT_GE(all.size(), 5U);
  for (const BuiltinEnvironment& entry : all) {
    EXPECT_EQ(load_environment("builtin:" + entry.name).name, "builtin:" + entry.name);
    EXPECT_FALSE(entry.description.empty());
    EXPECT_EQ(entry.description.find('\n'), std::string::npos);
  }
}

TEST(EnvironmentBuiltin, HaveTheRadianceOfTheirDefinitions) {
  EXPECT_EQ(radiance(make_builtin_environment("white"), {0, 1, 0}), Rgb(1.0F));
  const Environment overcast = make_builtin_environment("overcast");
  EXPECT_EQ(radiance(overcast, {0, 1, 0}), Rgb(1.0F));
  EXPECT_EQ(radiance(overcast, {1, 0, 0}), Rgb(1.0F / 3.0F));
  EXPECT_EQ(radiance(overcast, {0.6F, -0.8F, 0}), Rgb(0.0F));
  EXPECT_EQ(radiance(make_builtin_environment("two-lobes"), {0, 0, 1}), Rgb(1.0F));
  EXPECT_TRUE(is_black(make_builtin_environment("black")));
  EXPECT_FALSE(is_black(make_builtin_environment("sun-sky")));
  EXPECT_EQ(make_builtin_environment("sun-sky").suns.size(), 1U);
}

// The formula of the papers as it is printed, in double.
TEST(EnvironmentBuiltin, TwoLobesIsThePapersFormula) {
  const Environment environment = make_builtin_environment("two-lobes");
  Numbers numbers;
  for (int i = 0; i < 10000; ++i) {
    const Vec3d d(numbers.direction());
    const double theta = std::atan2(std::sqrt(d.x * d.x + d.y * d.y), d.z);
    const double phi = std::atan2(d.y, d.x);
    const double expected = std::max(0.0, 5.0 * std::cos(theta) - 4.0) +
                            std::max(0.0, -4.0 * std::sin(theta - kPi) * std::cos(phi - 2.5) - 3.0);
    const Rgb found = radiance(environment, Vec3(d));
    ASSERT_LE(std::abs(static_cast<double>(found.x) - expected), 2e-6);  // 5 terms of size 5, rounded to 6e-8
  }
}

TEST(EnvironmentBuiltin, ListsTheNamesForAnUnknownOne) {
  try {
    (void)load_environment("builtin:withe");
    FAIL() << "accepted an unknown name";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "builtin:withe: no such environment; there are white, black, overcast, two-lobes, sun-sky");
  }
}

}  // namespace
}  // namespace plumbline::light
