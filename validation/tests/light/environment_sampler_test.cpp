#include "reference/light/environment_sampler.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "reference/base/error.hpp"
#include "validation/tests/light/sampling.hpp"

namespace plumbline::light {
namespace {

using image::Image;
using testing::bin_counts;
using testing::bin_probabilities;
using testing::chi_squared;
using testing::ChiSquared;
using testing::Density;
using testing::Estimate;
using testing::estimate;
using testing::expect_agrees;
using testing::expect_shown;
using testing::irradiance;
using testing::kSeed;
using testing::Numbers;
using testing::total;

constexpr double kSunHalfAngle = 0.2665 * kPi / 180.0;

// ---------------------------------------------------------------- environments

// A lat-long image with black, dim and bright texels: 7 orders of magnitude.
Environment contrasty(int width, int height) {
  Numbers numbers(7);
  Image image = image::make_image(width, height);
  for (Rgb& texel : image.pixels) {
    const float level = numbers.next();
    texel = level < 0.2F ? Rgb(0.0F) : std::pow(10.0F, 3.0F * level) * Rgb(1.0F, numbers.next(), 0.0F);
  }
  image.at(width / 3, height / 3) = Rgb(0.0F, 0.0F, 1e6F);
  return testing::lat_long_environment(std::move(image));
}

Environment contrasty_cube(int side) {
  CubeMapSky sky;
  for (std::size_t face = 0; face < 6; ++face) {
    sky.faces[face] = std::get<LatLongSky>(contrasty(side, side).sky).image;
    sky.faces[face].at(0, static_cast<int>(face) % side) = Rgb(300.0F);
  }
  Environment result;
  result.name = "test";
  result.sky = std::move(sky);
  return result;
}

Environment contrasty_angular_map(int size) {
  Environment result;
  result.name = "test";
  result.sky = AngularMapSky{std::get<LatLongSky>(contrasty(size, size).sky).image};
  return result;
}

Environment one_texel_sun(float sky, float sun) {
  Image image = image::make_image(64, 32, Rgb(sky));
  image.at(20, 9) = Rgb(sun);
  return testing::lat_long_environment(std::move(image));
}

Environment signed_sky() {
  return testing::analytic_environment([](const Vec3& d) { return Rgb(d.y, 0.5F * d.x, -d.y); });
}

Environment with_suns(Environment environment) {
  environment.suns.push_back({glm::normalize(Vec3(1, 2, 3)), kSunHalfAngle, Rgb(5e4F, 4e4F, 3e4F)});
  environment.suns.push_back({glm::normalize(Vec3(-1, 0.5F, 0)), 0.5, Rgb(0, 2, 0)});
  environment.suns.push_back({glm::normalize(Vec3(-1, 0.7F, 0)), 0.3, Rgb(3, 0, 0)});  // overlaps the last
  return environment;
}

std::vector<Environment> all_kinds() {
  std::vector<Environment> result{make_builtin_environment("white"),
                                  make_builtin_environment("overcast"),
                                  make_builtin_environment("two-lobes"),
                                  make_builtin_environment("sun-sky"),
                                  contrasty(64, 32),
                                  contrasty(9, 5),
                                  contrasty_cube(8),
                                  contrasty_angular_map(24),
                                  one_texel_sun(1.0F, 1e5F),
                                  signed_sky(),
                                  with_suns(contrasty(32, 16)),
                                  with_suns(make_builtin_environment("black"))};
  for (std::size_t i = 0, count = result.size(); i < count; ++i) {
    result.push_back(rotated(result[i], {25, -130, 70}));
  }
  return result;
}

// ---------------------------------------------------------------- chi-squared

constexpr int kManySamples = 1000000;
constexpr int kBins = 32;

// `points` a bin makes every cell of the sampler's table exactly one point of the quadrature.
void expect_density(const Environment& environment, int points, const char* what) {
  const EnvironmentSampler sampler(environment);
  const Density pdf = [&](const Vec3& local) { return sampler.pdf(environment.rotation * local); };
  const glm::mat3 back = glm::transpose(environment.rotation);
  const ChiSquared result = chi_squared(bin_counts(sampler, kBins, kManySamples, back),
                                        bin_probabilities(pdf, kBins, points), kManySamples);
  EXPECT_LE(result.statistic, result.critical) << what << ", seed " << kSeed;
}

// ---------------------------------------------------------------- tests

TEST(EnvironmentSampler, GivesRadianceAndPdfOfItsDirection) {
  int kind = 0;
  for (const Environment& environment : all_kinds()) {
    const EnvironmentSampler sampler(environment);
    Numbers numbers;
    for (int i = 0; i < 5000; ++i) {
      const auto sample = sampler.sample(numbers.next_pair());
      ASSERT_TRUE(sample.has_value()) << kind;
      ASSERT_LE(std::abs(glm::length(Vec3d(sample->direction)) - 1.0), 2e-7) << kind;
      ASSERT_GT(sample->pdf, 0.0) << kind;
      ASSERT_EQ(sample->pdf, sampler.pdf(sample->direction)) << kind;
      ASSERT_EQ(sample->radiance, radiance(environment, sample->direction)) << kind;
    }
    ++kind;
  }
}

TEST(EnvironmentSampler, TakesEveryPairOfNumbers) {
  const float last = 1.0F - 0x1p-24F;
  int kind = 0;
  for (const Environment& environment : all_kinds()) {
    const EnvironmentSampler sampler(environment);
    for (const float x : {0.0F, 1e-40F, 0.5F, last}) {
      for (const float y : {0.0F, 1e-40F, 0.5F, last}) {
        const auto sample = sampler.sample({x, y});
        ASSERT_TRUE(sample.has_value()) << "kind " << kind << " at " << x << " " << y;
        ASSERT_TRUE(is_finite(sample->direction));
        ASSERT_TRUE(std::isfinite(sample->pdf));
      }
    }
    ++kind;
  }
}

TEST(EnvironmentSampler, HasAPositivePdfWhereThereIsRadiance) {
  for (const Environment& environment : all_kinds()) {
    const EnvironmentSampler sampler(environment);
    Numbers numbers(3);
    std::vector<Vec3> directions = testing::special_directions();
    for (int i = 0; i < 20000; ++i) directions.push_back(numbers.direction());
    for (const Vec3& direction : directions) {
      if (plumbline::is_black(radiance(environment, direction))) continue;
      ASSERT_GT(sampler.pdf(direction), 0.0);
    }
  }
}

// Texels whose neighbours are black: a direction that left its texel would find nothing.
TEST(EnvironmentSampler, StaysInsideItsTexel) {
  Image board = image::make_image(2048, 1024);
  for (int y = 0; y < board.height; ++y) {
    for (int x = 0; x < board.width; ++x) board.at(x, y) = Rgb((x + y) % 2 == 0 ? 1.0F : 0.0F);
  }
  CubeMapSky cube;
  for (Image& face : cube.faces) {
    face = image::make_image(256, 256);
    for (std::size_t i = 0; i < face.pixels.size(); ++i)
      face.pixels[i] = Rgb((i / 256 + i) % 2 == 0 ? 1.0F : 0.0F);
  }
  Environment cube_environment;
  cube_environment.sky = std::move(cube);
  const Environment plain = testing::lat_long_environment(std::move(board));
  for (const Environment& environment : {plain, rotated(plain, {10, 20, 30}), cube_environment}) {
    const EnvironmentSampler sampler(environment);
    Numbers numbers;
    for (int i = 0; i < 50000; ++i) {
      const auto sample = sampler.sample(numbers.next_pair());
      ASSERT_TRUE(sample.has_value());
      ASSERT_EQ(sample->radiance, Rgb(1.0F));
    }
  }
}

// Also in the smallest texels there are: the ring around a pole.
TEST(EnvironmentSampler, StaysInsideItsTexelAtThePole) {
  Image ring = image::make_image(4096, 2048);
  for (int x = 0; x < ring.width; x += 2) ring.at(x, 0) = Rgb(1.0F);
  for (int x = 1; x < ring.width; x += 2) ring.at(x, ring.height - 1) = Rgb(1.0F);
  const Environment environment = testing::lat_long_environment(std::move(ring));
  const EnvironmentSampler sampler(environment);
  Numbers numbers;
  for (int i = 0; i < 50000; ++i) {
    const auto sample = sampler.sample(numbers.next_pair());
    ASSERT_TRUE(sample.has_value());
    ASSERT_EQ(sample->radiance, Rgb(1.0F));
  }
}

// Texels are regions of constant density: the sum over them is the integral, to rounding.
TEST(EnvironmentSampler, HasAPdfThatIntegratesToOneOverLatLongTexels) {
  for (const auto& [width, height] : {std::pair(64, 32), std::pair(9, 5), std::pair(1, 1)}) {
    const Environment environment = contrasty(width, height);
    const EnvironmentSampler sampler(environment);
    double sum = 0.0;
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        sum += sampler.pdf(testing::texel_centre(x, y, width, height)) *
               testing::texel_solid_angle(y, width, height);
      }
    }
    EXPECT_LE(std::abs(sum - 1.0), 1e-10) << width << "x" << height;
  }
}

// pdf r^3 is constant over a texel of the face, r = 1 / (largest component of the direction).
TEST(EnvironmentSampler, HasAPdfThatIntegratesToOneOverCubeTexels) {
  constexpr int kSide = 8;
  const Environment environment = contrasty_cube(kSide);
  const EnvironmentSampler sampler(environment);
  double sum = 0.0;
  for (int i = 0; i < 6 * kSide * kSide; ++i) {
    const Vec2 uv((static_cast<float>(i % kSide) + 0.5F) / kSide,
                  (static_cast<float>(i / kSide % kSide) + 0.5F) / kSide);
    const Vec3 direction = direction_from_cube({i / (kSide * kSide), uv});
    sum += sampler.pdf(direction) * std::pow(static_cast<double>(max_magnitude(direction)), 3.0) * 4.0 /
           (kSide * kSide);
  }
  EXPECT_LE(std::abs(sum - 1.0), 1e-6);  // three roundings of the float directions
}

// 256 x 128 cells for analytic skies, 64 x 32 for a small angular map.
TEST(EnvironmentSampler, HasAPdfThatIntegratesToOneOverCells) {
  for (const Environment& environment :
       {make_builtin_environment("overcast"), make_builtin_environment("two-lobes"), signed_sky(),
        contrasty_angular_map(24), contrasty_angular_map(8)}) {
    const EnvironmentSampler sampler(environment);
    const auto bins = bin_probabilities([&](const Vec3& d) { return sampler.pdf(d); }, 64, 12);
    double sum = 0.0;
    for (const double bin : bins) sum += bin;
    EXPECT_LE(std::abs(sum - 1.0), 1e-9);
  }
}

// For an image the density is the magnitude over its integral, in exact proportion.
TEST(EnvironmentSampler, IsInProportionToALatLongImage) {
  const Environment environment = contrasty(64, 32);
  const EnvironmentSampler sampler(environment);
  double power = 0.0;
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x) {
      power += testing::texel_solid_angle(y, 64, 32) *
               static_cast<double>(max_component(radiance(environment, testing::texel_centre(x, y, 64, 32))));
    }
  }
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x) {
      const Vec3 centre = testing::texel_centre(x, y, 64, 32);
      const double expected = static_cast<double>(max_component(radiance(environment, centre))) / power;
      // A texel has at least 1e-5 of its row, known to 65 parts in 2^32; rows likewise.
      EXPECT_LE(std::abs(sampler.pdf(centre) - expected), 0.01 * expected);
      if (expected > 1e-3) {
        EXPECT_LE(std::abs(sampler.pdf(centre) / expected - 1.0), 1e-4);
      }
    }
  }
}

TEST(EnvironmentSampler, SamplesItsPdfOnALatLongImage) {
  const Environment map = contrasty(32, 16);
  expect_density(map, 1, "lat-long");
  expect_density(rotated(map, {25, -130, 70}), 1, "turned lat-long");
}

TEST(EnvironmentSampler, SamplesItsPdfOfOtherSkies) {
  expect_density(make_builtin_environment("white"), 1, "white");
  expect_density(make_builtin_environment("two-lobes"), 8, "two lobes");
  expect_density(contrasty_angular_map(24), 2, "angular map");
}

// The cube's density is smooth inside a texel: bins are its own texels, each with 8 x 8 points of quadrature.
TEST(EnvironmentSampler, SamplesItsPdfOnACube) {
  constexpr int kSide = 8;
  constexpr int kPoints = 8;
  const Environment environment = rotated(contrasty_cube(kSide), {90, 0, 0});
  const EnvironmentSampler sampler(environment);
  const auto bin_of = [&](const Vec3& world) {
    const CubeCoordinate c = cube_from_direction(glm::transpose(environment.rotation) * world);
    const auto cell = [](float u) { return std::min(static_cast<int>(u * kSide), kSide - 1); };
    return static_cast<std::size_t>((c.face * kSide + cell(c.uv.y)) * kSide + cell(c.uv.x));
  };
  std::vector<double> probabilities(6 * kSide * kSide);
  constexpr int kFine = kSide * kPoints;
  for (int i = 0; i < 6 * kFine * kFine; ++i) {
    const Vec2 uv((static_cast<float>(i % kFine) + 0.5F) / kFine,
                  (static_cast<float>(i / kFine % kFine) + 0.5F) / kFine);
    const Vec3 world = environment.rotation * direction_from_cube({i / (kFine * kFine), uv});
    const Vec2 st = 2.0F * uv - 1.0F;
    const double r = std::sqrt(1.0 + static_cast<double>(glm::dot(st, st)));
    probabilities[bin_of(world)] += sampler.pdf(world) * 4.0 / (kFine * kFine) / (r * r * r);
  }
  std::vector<double> counts(probabilities.size());
  Numbers numbers;
  for (int i = 0; i < kManySamples; ++i)
    counts[bin_of(sampler.sample(numbers.next_pair())->direction)] += 1.0;
  const ChiSquared result = chi_squared(counts, probabilities, kManySamples);
  EXPECT_LE(result.statistic, result.critical);
}

// Rings of equal solid angle about the sun's axis, and the rest of the sphere.
TEST(EnvironmentSampler, SamplesTheSunsConeUniformly) {
  constexpr int kRings = 16;
  for (const double half_angle : {kSunHalfAngle, 0.5, 2.5}) {
    const SunDisc sun{glm::normalize(Vec3(1, 2, 3)), half_angle, Rgb(1e4F)};
    const Environment environment = rotated(testing::sun_environment(sun, Rgb(1.0F)), {0, 90, 0});
    const EnvironmentSampler sampler(environment);
    const Vec3 axis = environment.rotation * sun.direction;
    const double longest = 2.0 * std::sin(0.5 * half_angle);
    const double omega = kPi * longest * longest;
    std::vector<double> counts(kRings + 1);
    std::vector<double> probabilities(kRings, sampler.pdf(axis) * omega / kRings);
    probabilities.push_back(sampler.pdf(-axis) * (4.0 * kPi - omega));
    Numbers numbers;
    for (int i = 0; i < kManySamples; ++i) {
      const double chord = glm::length(Vec3d(sampler.sample(numbers.next_pair())->direction) - Vec3d(axis));
      const double share = chord * chord / (longest * longest);
      counts[std::min(static_cast<std::size_t>(share * kRings), std::size_t{kRings})] += 1.0;
    }
    const ChiSquared result = chi_squared(counts, probabilities, kManySamples);
    EXPECT_LE(result.statistic, result.critical) << half_angle;
  }
}

// The checker must find what is wrong: densities with the usual mistakes.
TEST(EnvironmentSampler, IsFoundWrongByPlantedFaults) {
  const Environment environment = contrasty(32, 16);
  const EnvironmentSampler sampler(environment);
  const Density right = [&](const Vec3& d) { return sampler.pdf(d); };
  const Density half_texel_off = [&](const Vec3& d) {
    const Vec2 uv = lat_long_from_direction(d);
    return sampler.pdf(direction_from_lat_long({uv.x + 0.51F / 32.0F, uv.y}));
  };
  const Density without_sine = [&](const Vec3& d) {
    return sampler.pdf(d) * (4.0 / kPi) *
           std::sqrt(1.0 - static_cast<double>(d.y) * static_cast<double>(d.y));
  };
  const Density one_per_cent_uniform = [&](const Vec3& d) {
    return 0.99 * sampler.pdf(d) + 0.01 / (4.0 * kPi);
  };
  const auto counts = bin_counts(sampler, kBins, kManySamples, glm::mat3(1.0F));
  const auto passes = [&](const Density& pdf) {
    return chi_squared(counts, bin_probabilities(pdf, kBins, 1), kManySamples).passes();
  };
  EXPECT_TRUE(passes(right));
  EXPECT_FALSE(passes(half_texel_off));
  EXPECT_FALSE(passes(without_sine));
  EXPECT_FALSE(passes(one_per_cent_uniform));
}

TEST(EnvironmentSampler, GivesTheFluxOfAOneTexelSun) {
  const double omega = testing::texel_solid_angle(9, 64, 32);
  expect_shown(total(one_texel_sun(0.0F, 1e5F)), 1e5 * omega, "black sky");
  expect_shown(total(one_texel_sun(1.0F, 1e5F)), (1e5 - 1.0) * omega + 4.0 * kPi, "sky of 1");
}

// Upward irradiance of one texel: int cos t sin t dt dphi = dphi (sin^2 t1 - sin^2 t0) / 2.
TEST(EnvironmentSampler, GivesTheIrradianceOfAOneTexelSun) {
  const double s0 = std::sin(9.0 * kPi / 32.0);
  const double s1 = std::sin(10.0 * kPi / 32.0);
  const double texel = kPi / 64.0 * (s1 * s1 - s0 * s0);
  expect_shown(irradiance(one_texel_sun(0.0F, 1e5F), {0, 1, 0}), 1e5 * texel, "black sky");
  expect_shown(irradiance(one_texel_sun(1.0F, 1e5F), {0, 1, 0}), (1e5 - 1.0) * texel + kPi, "sky of 1");
  const Environment turned = rotated(one_texel_sun(1.0F, 1e5F), {90, 0, 0});
  expect_shown(irradiance(turned, {0, 0, 1}), (1e5 - 1.0) * texel + kPi, "turned");
}

TEST(EnvironmentSampler, GivesPiUnderAWhiteSky) {
  expect_shown(irradiance(make_builtin_environment("white"), {0.6, 0, -0.8}), kPi, "white");
}

// A lobe max(0, a cos t - b) has the flux pi (a - b)^2 / a: pi / 5 and pi / 4.
TEST(EnvironmentSampler, GivesTheFluxOfTwoLobes) {
  expect_shown(total(make_builtin_environment("two-lobes")), 9.0 * kPi / 20.0, "flux");
}

// Facing +z: 2 pi int (5 c - 4) c dc over 0.8 … 1 = 2 pi (5/3 (1 - .8^3) - 2 (1 - .8^2)), and half the second
// lobe's section of the sphere, by the midpoint rule.
TEST(EnvironmentSampler, GivesTheIrradianceOfTwoLobes) {
  const Environment environment = make_builtin_environment("two-lobes");
  constexpr int kWidth = 1024;
  constexpr int kHeight = 512;
  double expected = 0.0;
  double first_lobe = 0.0;
  for (int y = 0; y < kHeight; ++y) {
    const double omega = testing::texel_solid_angle(y, kWidth, kHeight);
    for (int x = 0; x < kWidth; ++x) {
      const Vec3d d(testing::texel_centre(x, y, kWidth, kHeight));
      const double value = omega * static_cast<double>(radiance(environment, Vec3(d)).x) * std::max(0.0, d.z);
      expected += value;
      first_lobe += d.z > 0.75 ? value : 0.0;
    }
  }
  const double closed_form = 2.0 * kPi * (5.0 / 3.0 * (1.0 - 0.512) - 2.0 * (1.0 - 0.64));
  EXPECT_LE(std::abs(first_lobe - closed_form), 1e-4 * closed_form);  // midpoint rule, (pi / 512)^2 = 4e-5
  expect_shown(irradiance(environment, {0, 0, 1}), expected, "facing +z");
}

// CIE overcast: horizontal 7 pi / 9, vertical (pi / 2 + 4 / 3) / 3.
TEST(EnvironmentSampler, GivesTheIrradianceOfAnOvercastSky) {
  const Environment overcast = make_builtin_environment("overcast");
  expect_shown(irradiance(overcast, {0, 1, 0}), 7.0 * kPi / 9.0, "horizontal");
  expect_shown(irradiance(overcast, {1, 0, 0}), (kPi / 2.0 + 4.0 / 3.0) / 3.0, "vertical");
  EXPECT_EQ(irradiance(overcast, {0, -1, 0}, 10000).mean, 0.0);
  const Environment turned = rotated(overcast, {90, 0, 0});
  expect_shown(irradiance(turned, {0, 0, 1}), 7.0 * kPi / 9.0, "turned");
}

// What its description says of sun-sky: sky pi (0.9 zenith + 0.1 horizon), sun pi sin^2 a L cos 45 deg, about
// three times as much.
TEST(EnvironmentSampler, GivesTheIrradianceOfTheClearSky) {
  const Environment both = make_builtin_environment("sun-sky");
  Environment sky_only = both;
  sky_only.suns.clear();
  const double sky = kPi * (0.9 * 0.15 + 0.1 * 0.8);  // red
  const double sun = kPi * std::pow(std::sin(kSunHalfAngle), 2.0) * 84000.0 * std::sqrt(0.5);
  expect_shown(irradiance(sky_only, {0, 1, 0}), sky, "sky");
  expect_shown(irradiance(both, {0, 1, 0}), sky + sun, "sky and sun");
  Environment sun_only = both;
  sun_only.sky = ConstantSky{};
  const auto upward = [](const Vec3& d, const Rgb& radiance) {
    return static_cast<double>(luminance(radiance) * std::max(0.0F, d.y));
  };
  EXPECT_LE(std::abs(estimate(sun_only, upward).mean / estimate(sky_only, upward).mean - 3.0), 0.1);
}

// pi sin^2 a for a cap of half angle a at the zenith.
TEST(EnvironmentSampler, GivesTheIrradianceOfCaps) {
  const double thirty = kPi / 6.0;
  const float diagonal = static_cast<float>(std::sqrt(0.5));
  const auto cap = [&](const Vec3& direction) {
    return testing::sun_environment({direction, thirty, Rgb(1.0F)});
  };
  expect_shown(irradiance(cap({0, 1, 0}), {0, 1, 0}), kPi / 4.0, "zenith");
  expect_shown(irradiance(cap({diagonal, diagonal, 0}), {0, 1, 0}), 0.555360367270, "45 degrees");
  const Environment function = testing::analytic_environment(
      [](const Vec3& d) { return Rgb(static_cast<double>(d.y) >= std::cos(kPi / 6.0) ? 1.0F : 0.0F); });
  expect_shown(irradiance(function, {0, 1, 0}), kPi / 4.0, "as a function");
  expect_agrees(total(testing::sun_environment({{0, 1, 0}, kPi, Rgb(1.0F)})), 4.0 * kPi, "whole sphere");
}

// The sun's disc of half angle 0.2665 degrees: E = 1 for L = 14713.0969712, in all directions of the sun.
TEST(EnvironmentSampler, GivesTheIrradianceOfTheSun) {
  Numbers numbers;
  for (int i = 0; i < 5; ++i) {
    const Vec3 direction = numbers.direction();
    const Environment sun = testing::sun_environment({direction, kSunHalfAngle, Rgb(14713.0969712F)});
    // A float direction is off by 3e-8 across the axis, 1e-5 of the radius: 2 E sin a of 3e-8 a sample.
    const Estimate found = irradiance(sun, glm::normalize(Vec3d(direction)), 20000);
    EXPECT_LE(std::abs(found.mean - 1.0), 1e-6 + 4.0 * found.standard_error);
    EXPECT_LE(found.standard_error, 1e-6);
  }
}

TEST(EnvironmentSampler, GivesSkyAndSunsTogether) {
  Environment environment = make_builtin_environment("overcast");
  environment.suns.push_back({{0, 1, 0}, kSunHalfAngle, Rgb(14713.0969712F)});
  environment.suns.push_back({{0, 1, 0}, kPi / 6.0, Rgb(1.0F)});
  const double expected = 7.0 * kPi / 9.0 + 1.0 + kPi / 4.0;
  expect_shown(irradiance(environment, {0, 1, 0}), expected, "together");
  const Environment turned = rotated(environment, {0, 0, -90});
  expect_shown(irradiance(turned, {1, 0, 0}), expected, "turned");
}

// In the shade of a bright sun the sky still gets its share of samples.
TEST(EnvironmentSampler, KeepsSamplingTheSkyBesideABrightSun) {
  const Environment environment = testing::sun_environment({{0, 1, 0}, kSunHalfAngle, Rgb(1e9F)}, Rgb(1.0F));
  const EnvironmentSampler sampler(environment);
  EXPECT_GE(sampler.pdf({0, -1, 0}), 0.0999 / (4.0 * kPi));
  expect_agrees(irradiance(environment, {0, -1, 0}), kPi, "facing away");
}

TEST(EnvironmentSampler, TakesSignedRadiance) {
  const Environment environment = signed_sky();  // red: y
  expect_shown(irradiance(environment, {0, 1, 0}), 2.0 * kPi / 3.0, "up");
  expect_shown(irradiance(environment, {0, -1, 0}), -2.0 * kPi / 3.0, "down");
  const Estimate flux = total(environment);
  EXPECT_LE(std::abs(flux.mean), 4.0 * flux.standard_error);
}

// The cube +Z = 1 sends 4 pi / 6, and onto a plane that faces it 4 / sqrt(2) atan(1 / sqrt(2)).
TEST(EnvironmentSampler, GivesTheIrradianceOfACubeFace) {
  CubeMapSky sky;
  for (Image& face : sky.faces) face = image::make_image(2, 2);
  sky.faces[4] = image::make_image(2, 2, Rgb(1.0F));
  Environment environment;
  environment.sky = sky;
  expect_shown(total(environment), 2.0 * kPi / 3.0, "flux");
  const double expected = 4.0 / std::sqrt(2.0) * std::atan(1.0 / std::sqrt(2.0));
  expect_shown(irradiance(environment, {0, 0, 1}), expected, "facing");
}

// A constant angular map, and one with a bright texel beside the rim.
TEST(EnvironmentSampler, GivesTheFluxOfAngularMaps) {
  Environment environment;
  environment.sky = AngularMapSky{image::make_image(32, 32, Rgb(2.0F))};
  expect_shown(total(environment), 8.0 * kPi, "constant");
  Image image = image::make_image(32, 32);
  image.at(16, 12) = Rgb(100.0F);
  environment.sky = AngularMapSky{image};
  // int sin(pi r) / r over the texel, in units of the disc, times pi: by the midpoint rule.
  double omega = 0.0;
  for (int i = 0; i < 64 * 64; ++i) {
    const double x = (i % 64 + 0.5) / 64.0 / 16.0;
    const double y = (3.0 + (static_cast<double>(i / 64) + 0.5) / 64.0) / 16.0;
    const double r = std::sqrt(x * x + y * y);
    omega += kPi * std::sin(kPi * r) / r / (16.0 * 16.0 * 64.0 * 64.0);
  }
  expect_shown(total(environment), 100.0 * omega, "one texel");
}

// A photograph with a sun in it, against the sum over its texels.
TEST(EnvironmentSampler, GivesTheIrradianceOfAPhotograph) {
  const std::filesystem::path city = "/usr/share/blender/datafiles/studiolights/world/city.exr";
  ASSERT_TRUE(std::filesystem::exists(city)) << city << " is missing: `ci/install data` brings it";
  const Environment environment = load_environment(city.string());
  const Image& image = std::get<LatLongSky>(environment.sky).image;
  double expected = 0.0;
  for (int y = 0; y < image.height / 2; ++y) {
    const double s0 = std::sin(kPi * y / image.height);
    const double s1 = std::sin(kPi * (y + 1) / image.height);
    for (int x = 0; x < image.width; ++x) {
      expected += static_cast<double>(image.at(x, y).x) * kPi / image.width * (s1 * s1 - s0 * s0);
    }
  }
  expect_shown(irradiance(environment, {0, 1, 0}), expected, "city");
}

TEST(EnvironmentSampler, OfBlackGivesNone) {
  Environment dark_map = testing::lat_long_environment(image::make_image(8, 4));
  Environment dark_angular;
  dark_angular.sky = AngularMapSky{image::make_image(4, 4)};
  Environment dark_sun = testing::sun_environment({{0, 1, 0}, 0.1, Rgb(0.0F)});
  for (const Environment& environment :
       {make_builtin_environment("black"), dark_map, dark_angular, dark_sun}) {
    const EnvironmentSampler sampler(environment);
    EXPECT_TRUE(sampler.is_black());
    EXPECT_FALSE(sampler.sample({0.5F, 0.5F}).has_value());
    EXPECT_EQ(sampler.pdf({0, 1, 0}), 0.0);
  }
  EXPECT_FALSE(EnvironmentSampler(make_builtin_environment("white")).is_black());
}

TEST(EnvironmentSampler, RefusesWhatCannotBeSampled) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const auto refuses = [](const Environment& environment) {
    EXPECT_THROW(EnvironmentSampler{environment}, InputError);
  };
  refuses(testing::lat_long_environment(Image{}));
  refuses(testing::lat_long_environment(image::make_image(8, 4, Rgb(0, nan, 0))));
  refuses(testing::analytic_environment([=](const Vec3&) { return Rgb(nan); }));
  refuses(testing::analytic_environment({}));
  refuses(testing::sun_environment({{0, 2, 0}, 0.1, Rgb(1.0F)}));
  refuses(testing::sun_environment({{0, 1, 0}, 0.0, Rgb(1.0F)}));
  refuses(testing::sun_environment({{0, 1, 0}, 4.0, Rgb(1.0F)}));
  refuses(testing::sun_environment({{0, 1, 0}, 0.1, Rgb(nan)}));
  Environment uneven = contrasty_cube(4);
  std::get<CubeMapSky>(uneven.sky).faces[3] = image::make_image(2, 2, Rgb(1.0F));
  refuses(uneven);
}

}  // namespace
}  // namespace plumbline::light
