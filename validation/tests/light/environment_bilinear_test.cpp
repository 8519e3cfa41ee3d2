// The bilinear lookup of environment images: radiance() and EnvironmentSampler.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "reference/base/error.hpp"
#include "reference/light/environment_lookup.hpp"
#include "validation/tests/light/sampling.hpp"

namespace plumbline::light {
namespace {

using image::Image;
using testing::chi_squared;
using testing::ChiSquared;
using testing::Density;
using testing::Estimate;
using testing::Numbers;

// Coordinates are good to 2e-7 of an image's size (environment.hpp); a lookup is off by that many texels in u and in v,
// times the largest difference between texels, and by three roundings.
double lookup_error(int size, double range) {
  return range * (2.0 * 2e-7 * size + 3.0 * 0x1p-24);
}

Environment with_lookup(Environment environment, Lookup lookup) {
  environment.lookup = lookup;
  return environment;
}
Environment bilinear(Environment environment) {
  return with_lookup(std::move(environment), Lookup::bilinear);
}

Image random_image(int width, int height, float low = 0.0F, float high = 4.0F, unsigned seed = 5) {
  Numbers numbers(seed);
  Image image = image::make_image(width, height);
  for (Rgb& texel : image.pixels) {
    for (int c = 0; c < 3; ++c) texel[c] = low + (high - low) * numbers.next();
  }
  return image;
}

// Black, dim and bright texels: black regions wider than a texel, and six orders of magnitude.
Image contrasty_image(int width, int height) {
  Numbers numbers(7);
  Image image = image::make_image(width, height);
  for (Rgb& texel : image.pixels) {
    const float level = numbers.next();
    texel = level < 0.5F ? Rgb(0.0F) : std::pow(10.0F, 3.0F * level) * Rgb(1.0F, numbers.next(), 0.0F);
  }
  image.at(width / 3, height / 3) = Rgb(0.0F, 0.0F, 1e6F);
  return image;
}

Environment lat_long(Image image) {
  return bilinear(testing::lat_long_environment(std::move(image)));
}

Environment cube(const std::function<Image(unsigned face)>& face_image) {
  CubeMapSky sky;
  for (unsigned face = 0; face < 6; ++face) sky.faces.at(face) = face_image(face);
  Environment result;
  result.name = "test";
  result.sky = std::move(sky);
  return bilinear(std::move(result));
}

Environment angular_map(Image image) {
  Environment result;
  result.name = "test";
  result.sky = AngularMapSky{std::move(image)};
  return bilinear(std::move(result));
}

Image one_texel_sun_image(int width, int height, int x, int y) {
  Image image = image::make_image(width, height, Rgb(1.0F));
  image.at(x, y) = Rgb(1e5F);
  return image;
}
Environment one_texel_sun() {
  return lat_long(one_texel_sun_image(64, 32, 20, 9));
}

std::vector<Environment> all_kinds() {
  std::vector<Environment> result{lat_long(random_image(16, 8)),
                                  lat_long(random_image(9, 5, -1.0F, 1.0F)),
                                  lat_long(contrasty_image(64, 32)),
                                  lat_long(contrasty_image(3, 2)),
                                  lat_long(random_image(1, 1)),
                                  one_texel_sun(),
                                  cube([](unsigned face) { return random_image(4, 4, -1.0F, 1.0F, face); }),
                                  cube([](unsigned) { return contrasty_image(8, 8); }),
                                  angular_map(random_image(12, 12)),
                                  angular_map(contrasty_image(25, 25))};
  for (std::size_t i = 0, count = result.size(); i < count; ++i)
    result.push_back(rotated(result[i], {25, -130, 70}));
  return result;
}

// ---------------------------------------------------------------- quadrature

// Two Gauss nodes each way in u and cos(theta) of every block of a grid, in the environment's frame: exact for what is
// bilinear in these over a block.
void for_each_node(int across, int down,
                   const std::function<void(const Vec3d& direction, double weight)>& f) {
  const std::array<double, 2> nodes{0.5 - 0.5 / std::sqrt(3.0), 0.5 + 0.5 / std::sqrt(3.0)};
  for (int y = 0; y < down; ++y) {
    const double upper = std::cos(kPi * y / down);
    const double height = upper - std::cos(kPi * (y + 1) / down);
    for (int x = 0; x < across; ++x) {
      for (const double v : nodes) {
        const double cosine = upper - height * v;
        const double sine = std::sqrt((1.0 - cosine) * (1.0 + cosine));
        for (const double u : nodes) {
          const double phi = 2.0 * kPi * ((x + u) / across - 0.5);
          f({sine * std::cos(phi), cosine, sine * std::sin(phi)}, 0.25 * height * 2.0 * kPi / across);
        }
      }
    }
  }
}

// Of f over the sphere, the environment's rotation taken along.
double integral(const Environment& environment, int across, int down,
                const std::function<double(const Vec3& world)>& f) {
  const glm::dmat3 rotation(environment.rotation);
  double sum = 0.0;
  for_each_node(across, down, [&](const Vec3d& local, double weight) {
    sum += weight * f(Vec3(glm::normalize(rotation * local)));
  });
  return sum;
}

double red(const Environment& environment, const Vec3& direction) {
  return static_cast<double>(radiance(environment, direction).x);
}
double clamped_cosine(const Vec3& direction, const Vec3& normal) {
  return std::max(0.0, glm::dot(Vec3d(direction), Vec3d(normal)));
}

// ---------------------------------------------------------------- the lookup

TEST(BilinearLookup, IsNotTheDefault) {
  EXPECT_EQ(Environment{}.lookup, Lookup::nearest);
  const Image image = random_image(16, 8);
  const Environment environment = testing::lat_long_environment(image);
  Numbers numbers;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 direction = numbers.direction();
    const Texel texel = texel_at(lat_long_from_direction(direction), 16, 8);
    ASSERT_EQ(radiance(environment, direction), image.at(texel.x, texel.y));
  }
}

TEST(BilinearLookup, GivesTheTexelsAtTheirCentres) {
  const Image image = random_image(16, 8);
  const Image square = random_image(8, 8);
  const Environment map = lat_long(image);
  const Environment faces = cube([&](unsigned) { return square; });
  const Environment probe = angular_map(square);
  const auto expect_texel = [](const Environment& environment, const Vec3& direction, const Rgb& texel,
                               int size) {
    EXPECT_LE(static_cast<double>(max_magnitude(radiance(environment, direction) - texel)),
              lookup_error(size, 4.0));
  };
  for (int y = 0; y < 8; ++y) {
    for (int x = 0; x < 16; ++x) expect_texel(map, testing::texel_centre(x, y, 16, 8), image.at(x, y), 16);
    for (int x = 0; x < 8; ++x) {
      const Vec2 uv((static_cast<float>(x) + 0.5F) / 8.0F, (static_cast<float>(y) + 0.5F) / 8.0F);
      for (int face = 0; face < 6; ++face)
        expect_texel(faces, direction_from_cube({face, uv}), square.at(x, y), 8);
      if (glm::length(uv - Vec2(0.5F)) < 0.5F)
        expect_texel(probe, direction_from_angular_map(uv), square.at(x, y), 8);
    }
  }
}

// The definition in double: a sum over all texels of products of hats, periodic in u and clamped in v.
RgbD sum_of_hats(const Image& image, const Vec3d& d) {
  const double x = (0.5 + std::atan2(d.z, d.x) / (2.0 * kPi)) * image.width - 0.5;
  const double y =
      std::clamp(std::acos(std::clamp(d.y, -1.0, 1.0)) / kPi * image.height - 0.5, 0.0, image.height - 1.0);
  RgbD sum(0.0);
  for (int j = 0; j < image.height; ++j) {
    const double down = std::max(0.0, 1.0 - std::abs(y - j));
    for (int i = 0; i < image.width; ++i) {
      for (int turn = -1; turn <= 1; ++turn)
        sum += std::max(0.0, 1.0 - std::abs(x - i + turn * image.width)) * down * RgbD(image.at(i, j));
    }
  }
  return sum;
}

TEST(BilinearLookup, IsASumOfHats) {
  for (const auto& [width, height] :
       {std::pair(16, 8), std::pair(7, 5), std::pair(2, 1), std::pair(1, 1), std::pair(1, 3)}) {
    const Image image = random_image(width, height, -2.0F, 2.0F);
    const Environment environment = rotated(lat_long(image), {0, 90, 0});
    Numbers numbers;
    std::vector<Vec3> directions = testing::special_directions();
    for (int i = 0; i < 5000; ++i) directions.push_back(numbers.direction());
    for (const Vec3& direction : directions) {
      if (1.0F - std::abs(direction.y) < 1e-6F) continue;  // the azimuth of a pole is not defined
      const RgbD expected = sum_of_hats(image, Vec3d(direction));
      const RgbD found(radiance(environment, environment.rotation * direction));
      // acos(y) of the oracle knows the polar angle only to 6e-8 / sin(theta).
      const double polar = 6e-8 / std::sqrt(1.0 - static_cast<double>(direction.y * direction.y));
      const double tolerance = lookup_error(std::max(width, height), 4.0) + 4.0 * height * polar;
      for (int c = 0; c < 3; ++c) ASSERT_LE(std::abs(found[c] - expected[c]), tolerance);
    }
  }
}

// Steps of 1e-5 of the image across every texel border, every texel centre and the seam: at most the slope, 4 a texel
// in u and in v, times the step. The nearest lookup must jump somewhere.
TEST(BilinearLookup, IsContinuousAcrossTexelsAndTheSeam) {
  constexpr float kStep = 1e-5F;
  const auto largest_step = [&](const Environment& environment) {
    double largest = 0.0;
    for (int i = 0; i <= 32; ++i) {
      for (int j = 1; j <= 30; ++j) {
        const float u = static_cast<float>(i) / 32.0F;
        const float v = (static_cast<float>(j) + 0.3F) / 32.0F;
        const Rgb across = radiance(environment, direction_from_lat_long({u - kStep, v})) -
                           radiance(environment, direction_from_lat_long({u + kStep, v}));
        const float row = static_cast<float>(j) / 32.0F;
        const Rgb down = radiance(environment, direction_from_lat_long({u + 0.01F, row - kStep})) -
                         radiance(environment, direction_from_lat_long({u + 0.01F, row + kStep}));
        largest = std::max(
            {largest, static_cast<double>(max_magnitude(across)), static_cast<double>(max_magnitude(down))});
      }
    }
    return largest;
  };
  const Environment environment = lat_long(random_image(16, 16));
  const double bound = 4.0 * 16.0 * 2.0 * static_cast<double>(kStep) + 2.0 * lookup_error(16, 4.0);
  EXPECT_LE(largest_step(environment), bound);
  EXPECT_GT(largest_step(with_lookup(environment, Lookup::nearest)), 100.0 * bound);
}

TEST(BilinearLookup, ContinuesTheLastRowToThePole) {
  const Environment environment = lat_long(random_image(16, 8));
  for (int i = 0; i < 64; ++i) {
    const float u = (static_cast<float>(i) + 0.3F) / 64.0F;
    for (const float v : {0.001F, 0.03F, 0.0624F}) {
      for (const bool is_top : {true, false}) {
        const Rgb centre = radiance(environment, direction_from_lat_long({u, is_top ? 0.0625F : 0.9375F}));
        const Rgb beyond = radiance(environment, direction_from_lat_long({u, is_top ? v : 1.0F - v}));
        ASSERT_LE(static_cast<double>(max_magnitude(centre - beyond)), 2.0 * lookup_error(16, 4.0));
      }
    }
  }
}

// Each face by itself: six faces of one colour each stay so, up to their edges.
TEST(BilinearLookup, KeepsCubeFacesApart) {
  const Environment environment =
      cube([](unsigned face) { return image::make_image(2, 2, Rgb(std::exp2(static_cast<float>(face)))); });
  for (const Vec3& direction : testing::special_directions()) {
    const int face = cube_from_direction(direction).face;
    ASSERT_LE(std::abs(red(environment, direction) - std::exp2(face)), 1e-5) << face;
  }
}

// A light probe of 1 whose surround is black, of even and odd sizes.
TEST(BilinearLookup, KeepsTheSurroundOfALightProbeOut) {
  for (const int size : {1, 2, 3, 8, 31}) {
    Image image = image::make_image(size, size);
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x) {
        const double radius = std::hypot((2.0 * x + 1.0) / size - 1.0, (2.0 * y + 1.0) / size - 1.0);
        if (radius <= 1.0) image.at(x, y) = Rgb(1.0F);
      }
    }
    const Environment environment = angular_map(image);
    Numbers numbers;
    std::vector<Vec3> directions = testing::special_directions();
    for (int i = 0; i < 5000; ++i) directions.push_back(numbers.direction());
    for (const Vec3& direction : directions)
      ASSERT_LE(std::abs(red(environment, direction) - 1.0), 3e-7) << size;
  }
}

TEST(BilinearLookup, StaysInsideTheImageForEveryDirection) {
  std::vector<Vec3> directions = testing::special_directions();
  const float nan = std::nanf("");
  directions.insert(directions.end(), {Vec3(0.0F), Vec3(nan), Vec3(nan, 0, 1), Vec3(0, -1, nan)});
  for (const Environment& environment :
       {lat_long(random_image(9, 1, 1.0F, 2.0F)),
        cube([](unsigned) { return random_image(3, 3, 1.0F, 2.0F); }),
        angular_map(random_image(3, 3, 1.0F, 2.0F)), angular_map(random_image(1, 1, 1.0F, 2.0F))}) {
    for (const Vec3& direction : directions) {
      ASSERT_GE(red(environment, direction), 1.0 - 1e-6);
      ASSERT_LE(red(environment, direction), 2.0 + 1e-6);
    }
  }
}

TEST(BilinearLookup, TurnsWithTheEnvironment) {
  const Environment plain = lat_long(random_image(16, 8));
  const Environment turned = rotated(plain, {20, -35, 140});
  Numbers numbers;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 direction = numbers.direction();
    if (std::abs(direction.y) > 0.99F)
      continue;  // turning there and back moves the azimuth by 2e-7 / sin(theta)
    const Rgb difference = radiance(turned, turned.rotation * direction) - radiance(plain, direction);
    ASSERT_LE(static_cast<double>(max_magnitude(difference)), 10.0 * lookup_error(16, 4.0));
  }
}

// ---------------------------------------------------------------- the sampler

TEST(BilinearSampler, GivesRadianceAndPdfOfItsDirection) {
  const float last = 1.0F - 0x1p-24F;
  int kind = 0;
  for (const Environment& environment : all_kinds()) {
    const EnvironmentSampler sampler(environment);
    Numbers numbers;
    std::vector<Vec2> pairs;
    for (const float x : {0.0F, 1e-40F, 0.5F, last}) {
      for (const float y : {0.0F, 1e-40F, 0.5F, last}) pairs.emplace_back(x, y);
    }
    for (int i = 0; i < 5000; ++i) pairs.push_back(numbers.next_pair());
    for (const Vec2& pair : pairs) {
      const auto sample = sampler.sample(pair);
      ASSERT_TRUE(sample.has_value()) << kind << " at " << pair.x << " " << pair.y;
      ASSERT_LE(std::abs(glm::length(Vec3d(sample->direction)) - 1.0), 2e-7) << kind;
      ASSERT_GT(sample->pdf, 0.0) << kind;
      ASSERT_TRUE(std::isfinite(sample->pdf)) << kind;
      ASSERT_EQ(sample->pdf, sampler.pdf(sample->direction)) << kind;
      ASSERT_EQ(sample->radiance, radiance(environment, sample->direction)) << kind;
    }
    ++kind;
  }
}

TEST(BilinearSampler, HasAPositivePdfWhereThereIsRadiance) {
  int kind = 0;
  for (const Environment& environment : all_kinds()) {
    const EnvironmentSampler sampler(environment);
    Numbers numbers(3);
    std::vector<Vec3> directions = testing::special_directions();
    for (int i = 0; i < 20000; ++i) directions.push_back(numbers.direction());
    for (const Vec3& direction : directions) {
      if (plumbline::is_black(radiance(environment, direction))) continue;
      ASSERT_GT(sampler.pdf(direction), 0.0) << kind;
    }
    ++kind;
  }
}

// Blocks of half a texel, in which the density is bilinear in u and cos(theta): only rounding is left.
TEST(BilinearSampler, HasAPdfThatIntegratesToOneOverALatLongImage) {
  for (const auto& [width, height] :
       {std::pair(64, 32), std::pair(9, 5), std::pair(2, 3), std::pair(1, 2), std::pair(1, 1)}) {
    const Environment environment = lat_long(contrasty_image(width, height));
    const EnvironmentSampler sampler(environment);
    const double sum = integral(environment, 2 * width, 2 * height,
                                [&](const Vec3& direction) { return sampler.pdf(direction); });
    EXPECT_LE(std::abs(sum - 1.0), lookup_error(std::max(width, height), 1.0)) << width << "x" << height;
  }
}

// The grid of an angular map's table is 64 x 32, 50 x 2 cells around +Y for 25 texels. A cube's texels are not lines of
// the grid: midpoint errors along their borders.
TEST(BilinearSampler, HasAPdfThatIntegratesToOneForOtherLayouts) {
  const auto sum = [](const Environment& environment, int across) {
    const EnvironmentSampler sampler(environment);
    return integral(environment, across, across / 2,
                    [&](const Vec3& direction) { return sampler.pdf(direction); });
  };
  EXPECT_LE(std::abs(sum(angular_map(random_image(12, 12)), 64) - 1.0), 1e-9);
  EXPECT_LE(
      std::abs(sum(cube([](unsigned face) { return random_image(4, 4, 0.0F, 4.0F, face); }), 512) - 1.0),
      2e-3);
}

// Where the image varies slowly the density is the magnitude over its integral; beside a pole within 1/2 and 3/2.
TEST(BilinearSampler, IsNearlyInProportion) {
  const Image image = random_image(64, 32, 0.1F, 4.0F);
  const Environment environment = lat_long(image);
  const EnvironmentSampler sampler(environment);
  // One channel, so that the magnitude of the interpolated radiance is the interpolated magnitude.
  Image gray = image;
  for (Rgb& texel : gray.pixels) texel = Rgb(texel.x);
  const Environment gray_environment = lat_long(gray);
  const EnvironmentSampler gray_sampler(gray_environment);
  const double power =
      integral(gray_environment, 256, 128, [&](const Vec3& d) { return red(gray_environment, d); });
  Numbers numbers;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 direction = numbers.direction();
    const double ratio = gray_sampler.pdf(direction) * power / red(gray_environment, direction);
    // 1 -+ (h / 2) cot(theta) with theta the nearest border of the cell, to O(h^2), and as much for the integral.
    const double theta = std::acos(std::abs(static_cast<double>(direction.y)));
    const double h = kPi / 32.0;
    const double bound = theta > 2.0 * h ? 0.5 * h / std::tan(theta - 0.5 * h) + 0.02 : 1.0;
    ASSERT_LE(std::abs(std::log(ratio)), std::min(bound, std::log(2.1))) << theta;
    const double magnitude = static_cast<double>(max_magnitude(radiance(environment, direction)));
    ASSERT_GT(sampler.pdf(direction), 0.2 * magnitude / (4.0 * kPi * 4.0));
  }
}

constexpr int kManySamples = 500000;
constexpr int kBins = 32;

// Eight points a bin each way: the midpoint rule's error is far below a count.
ChiSquared held_against(const std::vector<double>& counts, const Density& pdf) {
  return chi_squared(counts, testing::bin_probabilities(pdf, kBins, 8), kManySamples);
}

TEST(BilinearSampler, SamplesItsPdf) {
  const Environment map = lat_long(contrasty_image(32, 16));
  for (const Environment& environment :
       {map, rotated(map, {25, -130, 70}), lat_long(random_image(8, 4)), one_texel_sun(),
        cube([](unsigned face) { return random_image(4, 4, 0.0F, 4.0F, face); }),
        angular_map(random_image(12, 12))}) {
    const EnvironmentSampler sampler(environment);
    const auto counts =
        testing::bin_counts(sampler, kBins, kManySamples, glm::transpose(environment.rotation));
    const ChiSquared result =
        held_against(counts, [&](const Vec3& local) { return sampler.pdf(environment.rotation * local); });
    EXPECT_LE(result.statistic, result.critical);
  }
}

TEST(BilinearSampler, IsFoundWrongByPlantedFaults) {
  const Environment environment = lat_long(contrasty_image(32, 16));
  const EnvironmentSampler sampler(environment);
  const EnvironmentSampler by_texels(testing::lat_long_environment(contrasty_image(32, 16)));
  const auto counts = testing::bin_counts(sampler, kBins, kManySamples, glm::mat3(1.0F));
  const auto passes = [&](const Density& pdf) { return held_against(counts, pdf).passes(); };
  EXPECT_TRUE(passes([&](const Vec3& d) { return sampler.pdf(d); }));
  EXPECT_FALSE(passes([&](const Vec3& d) { return by_texels.pdf(d); }));
  EXPECT_FALSE(passes([&](const Vec3& d) { return 0.99 * sampler.pdf(d) + 0.01 / (4.0 * kPi); }));
  EXPECT_FALSE(passes([&](const Vec3& d) {  // off by a quarter of a texel
    const Vec2 uv = lat_long_from_direction(d);
    return sampler.pdf(direction_from_lat_long({uv.x + 0.25F / 32.0F, uv.y}));
  }));
  EXPECT_FALSE(passes([&](const Vec3& d) {  // without the sine
    return sampler.pdf(d) * (4.0 / kPi) *
           std::sqrt(1.0 - static_cast<double>(d.y) * static_cast<double>(d.y));
  }));
}

// A sun of one texel, 10^5 : 1, at the polar angle 9.5 pi / 32. With X = L cos / p the estimate of irradiance, density
// and radiance in the ratio r^-1 … r (1.0432, the step of sin(theta) over half a cell there; 1 where the sky is
// constant),
//   E[X^2] = int L^2 cos^2 / p <= r^2 int L int L cos^2,
// and the relative variance is at most r^2 int L int L cos^2 / (int L cos)^2 - 1.
TEST(BilinearSampler, KeepsTheVarianceOfAOneTexelSunBounded) {
  constexpr double kRatio = 1.05;
  const Vec3 up(0, 1, 0);
  const Environment environment = one_texel_sun();
  const auto integrate = [&](const std::function<double(const Vec3&)>& f) {
    return integral(environment, 512, 256, f);
  };
  const double expected =
      integrate([&](const Vec3& d) { return red(environment, d) * clamped_cosine(d, up); });
  const double first = integrate([&](const Vec3& d) { return red(environment, d); });
  const double second =
      integrate([&](const Vec3& d) { return red(environment, d) * std::pow(clamped_cosine(d, up), 2.0); });
  const double bound = kRatio * kRatio * first * second / (expected * expected) - 1.0;

  const Estimate found = testing::irradiance(environment, Vec3d(up));
  testing::expect_shown(found, expected, "irradiance");
  const double variance =
      testing::kSamples * std::pow(found.standard_error / expected, 2.0);  // of one sample, relative
  EXPECT_LE(variance, bound);
  EXPECT_LE(bound, 0.2);  // what makes it worth having

  // The density that is constant over texels, as the nearest lookup has it.
  const Environment nearest = with_lookup(environment, Lookup::nearest);
  const EnvironmentSampler naive(nearest);
  const double naive_second = integrate([&](const Vec3& d) {
    return std::pow(red(environment, d) * clamped_cosine(d, up), 2.0) / naive.pdf(d);
  });
  EXPECT_GT(naive_second / (expected * expected) - 1.0, 50.0 * bound);

  const Environment turned = rotated(environment, {90, 0, 0});  // up becomes +Z
  testing::expect_shown(testing::irradiance(turned, {0, 0, 1}), expected, "turned");
}

// Suns of one texel, 10^5 : 1, at the border of a face and of the disc. With p >= 0.95 L_max / (L_max omega_raised) on
// the sun's support the relative variance is below omega_raised / (0.95 omega), omega = int L / L_max: 9 on a cube (3 x
// 3 texels, no uniform share), 17 on an angular map, whose table adds half a texel on all sides, and 26 at its rim,
// where the texels inwards are up to three times as large.
TEST(BilinearSampler, EstimatesTheFluxOfOneTexelSunsInOtherLayouts) {
  const auto expect_flux = [](const Environment& environment, double bound, const char* what) {
    const double expected =
        integral(environment, 1024, 512, [&](const Vec3& d) { return red(environment, d); });
    const Estimate found = testing::total(environment);
    // A kink or jump that is no line of the grid: 1e-3 of the flux.
    EXPECT_LE(std::abs(found.mean - expected), 4.0 * found.standard_error + 1e-3 * expected) << what;
    EXPECT_LE(testing::kSamples * std::pow(found.standard_error / expected, 2.0), bound) << what;
  };
  expect_flux(cube([](unsigned face) {
                return face == 2 ? one_texel_sun_image(8, 8, 0, 3) : image::make_image(8, 8, Rgb(1.0F));
              }),
              9.0, "cube");
  expect_flux(angular_map(one_texel_sun_image(24, 24, 16, 9)), 17.0, "angular map");
  expect_flux(angular_map(one_texel_sun_image(24, 24, 23, 12)), 26.0, "rim");
}

TEST(BilinearSampler, TakesSignedImages) {
  for (const Environment& environment :
       {lat_long(random_image(16, 8, -1.0F, 1.0F)),
        rotated(lat_long(random_image(16, 8, -1.0F, 1.0F)), {0, 40, 90}),
        cube([](unsigned face) { return random_image(4, 4, -1.0F, 1.0F, face); })}) {
    const Vec3 normal = glm::normalize(Vec3(1, 2, -2));
    const double expected = integral(environment, 512, 256, [&](const Vec3& d) {
      return red(environment, d) * clamped_cosine(d, normal);
    });
    const Estimate found = testing::irradiance(environment, Vec3d(normal));
    EXPECT_LE(std::abs(found.mean - expected),
              4.0 * found.standard_error + 2e-4);  // kinks and jumps in the grid
    EXPECT_GT(found.standard_error, 0.0);
  }
}

TEST(BilinearSampler, OfBlackGivesNoneAndRefusesNonFiniteTexels) {
  const float nan = std::nanf("");
  for (const Environment& environment :
       {lat_long(image::make_image(8, 4)), cube([](unsigned) { return image::make_image(2, 2); }),
        angular_map(image::make_image(4, 4))}) {
    const EnvironmentSampler sampler(environment);
    EXPECT_TRUE(sampler.is_black());
    EXPECT_FALSE(sampler.sample({0.5F, 0.5F}).has_value());
  }
  EXPECT_THROW(EnvironmentSampler{lat_long(Image{})}, InputError);
  EXPECT_THROW(EnvironmentSampler{lat_long(image::make_image(8, 4, Rgb(0, nan, 0)))}, InputError);
  EXPECT_THROW(EnvironmentSampler{cube([=](unsigned) { return image::make_image(2, 2, Rgb(nan)); })},
               InputError);
  EXPECT_THROW(EnvironmentSampler{angular_map(image::make_image(4, 4, Rgb(nan)))}, InputError);
}

}  // namespace
}  // namespace plumbline::light
