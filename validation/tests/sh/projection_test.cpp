// project_radiance() against closed forms, brute force and its own symmetries.
#include <gtest/gtest.h>

#include <random>
#include <tuple>

#include "prt/sh/lighting.hpp"
#include "prt/sh/quadrature.hpp"
#include "prt/sh/texels.hpp"
#include "prt/sh/zonal.hpp"
#include "reference/base/error.hpp"
#include "validation/tests/sh/oracle.hpp"

namespace plumbline::sh {
namespace {

using Coefficients = std::vector<RgbD>;

double largest_difference(const Coefficients& a, const Coefficients& b) {
  if (a.size() != b.size()) return std::nan("");
  double result = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double error = std::abs(a[i][c] - b[i][c]);
      result = std::isnan(result) || result >= error ? result : error;
    }
  }
  return result;
}

image::Image random_image(int width, int height, unsigned seed) {
  std::mt19937 bits(seed);
  image::Image result = image::make_image(width, height);
  for (Rgb& texel : result.pixels) {
    for (int c = 0; c < 3; ++c) texel[c] = static_cast<float>(bits() % 4096) / 1024.0F;
  }
  return result;
}

light::Environment environment_of(light::Sky sky) {
  light::Environment result;
  result.name = "test";
  result.sky = std::move(sky);
  return result;
}

light::Environment random_cube(int size, unsigned seed) {
  light::CubeMapSky cube;
  for (unsigned face = 0; face < 6; ++face) cube.faces[face] = random_image(size, size, seed + face);
  return environment_of(cube);
}

/// Sum of weight * radiance(direction) * y(direction), the radiance looked up as a camera ray does.
class BruteForce {
 public:
  BruteForce(const light::Environment& environment, int bands)
      : environment_(environment),
        basis_(bands),
        values_(static_cast<std::size_t>(bands * bands)),
        sum_(values_.size(), RgbD(0.0)) {}

  void add(const Vec3d& direction, double weight) {
    basis_.evaluate(direction.x, direction.y, direction.z, values_);
    const RgbD radiance(light::radiance(environment_, Vec3(direction)));
    for (std::size_t i = 0; i < values_.size(); ++i) sum_[i] += weight * values_[i] * radiance;
    solid_angle_ += weight;
  }
  [[nodiscard]] const Coefficients& sum() const { return sum_; }
  [[nodiscard]] double solid_angle() const { return solid_angle_; }

 private:
  const light::Environment& environment_;
  Basis<double> basis_;
  std::vector<double> values_;
  Coefficients sum_;
  double solid_angle_ = 0.0;
};

/// The slow definition for lat-long images: k x k Gauss nodes in (phi, theta) inside each texel. (In
/// cos(theta) instead, the root of odd m at the poles would leave 4e-5 of an 16 x 8 image even with 8 x 8
/// nodes.)
Coefficients lat_long_by_texels(const light::Environment& environment, int bands, std::size_t k) {
  const auto& image = std::get<light::LatLongSky>(environment.sky).image;
  const glm::dmat3 rotation(environment.rotation);
  const GaussLegendre rule = gauss_legendre(static_cast<int>(k));
  BruteForce brute(environment, bands);
  for (std::size_t node = 0; node < image.pixels.size() * k * k; ++node) {
    const auto texel = static_cast<int>(node / (k * k));
    const std::size_t i = node % k;
    const std::size_t j = node / k % k;
    const double u = (texel % image.width + 0.5 + 0.5 * rule.nodes[i]) / image.width;
    const double v = (texel / image.width + 0.5 + 0.5 * rule.nodes[j]) / image.height;
    const double phi = 2.0 * kPi * (u - 0.5);
    const double sine = std::sin(kPi * v);
    const Vec3d local(sine * std::cos(phi), std::cos(kPi * v), sine * std::sin(phi));
    const double cell = 2.0 * kPi / image.width * kPi / image.height;
    brute.add(glm::normalize(rotation * local), 0.25 * rule.weights[i] * rule.weights[j] * cell * sine);
  }
  EXPECT_LE(std::abs(brute.solid_angle() - 4.0 * kPi), 1e-11);  // thousands of terms
  return brute.sum();
}

// ---------------------------------------------------------------- constant and suns

TEST(ShProjection, ConstantSkyHasOneCoefficient) {
  const ShRgb result = project_radiance(environment_of(light::ConstantSky{Rgb(1.0F, 0.5F, 0.0F)}), 6);
  EXPECT_LE(std::abs(result.coefficients[0].r - 3.54490770181), 2e-12);
  EXPECT_EQ(result.coefficients[0].g, 0.5 * result.coefficients[0].r);
  EXPECT_EQ(result.coefficients[0].b, 0.0);
  for (std::size_t i = 1; i < 36; ++i) EXPECT_EQ(result.coefficients[i], RgbD(0.0)) << i;
}

// integral of L max(0, z) = dot product of coefficients = pi.
TEST(ShProjection, WhiteSkyTimesClampedCosineIsPi) {
  const ShRgb white = project_radiance(environment_of(light::ConstantSky{Rgb(1.0F)}), 5);
  EXPECT_LE(std::abs(white.coefficients[0].g * clamped_cosine(5)[0] - kPi), 1e-15 * 4.0);
}

TEST(ShProjection, SunIsACapInItsDirection) {
  light::Environment environment = environment_of(light::ConstantSky{});
  environment.suns.push_back({glm::normalize(Vec3(0.3F, 0.8F, -0.4F)), kPi / 6.0, Rgb(2.0F, 4.0F, 8.0F)});
  const ShRgb result = project_radiance(environment, 6);
  // Along the sun's axis only z_l remains.
  const Vec3d axis = glm::normalize(Vec3d(environment.suns[0].direction));
  const std::vector<double> z{.237463788986, .383747515480, .429042765405,
                              .403001508580, .323786966186, .212409064572};
  double expected = 0.0;
  for (int l = 0; l < 6; ++l) {
    expected += z[static_cast<std::size_t>(l)] * std::sqrt((2.0 * l + 1.0) / (4.0 * kPi));
  }
  const RgbD value = evaluate(result, axis);
  EXPECT_LE(std::abs(value.r - 2.0 * expected), 2e-11);
  EXPECT_LE(std::abs(value.b - 8.0 * expected), 8e-11);
}

// A cap of 40 degrees drawn as an analytic sky converges as its jump allows: node spacing 0.35 degrees.
TEST(ShProjection, SunMatchesTheSameDiscInAnAnalyticSky) {
  light::Environment disc = environment_of(light::ConstantSky{});
  const Vec3 axis = glm::normalize(Vec3(-0.5F, 0.2F, 0.7F));
  disc.suns.push_back({axis, 40.0 * kPi / 180.0, Rgb(1.0F)});
  const auto limit = static_cast<float>(std::cos(40.0 * kPi / 180.0));
  const light::Environment drawn = environment_of(
      light::AnalyticSky{[=](const Vec3& w) { return Rgb(glm::dot(w, axis) >= limit ? 1.0F : 0.0F); }});
  EXPECT_LE(
      largest_difference(project_radiance(disc, 5).coefficients, project_radiance(drawn, 5).coefficients),
      2e-3);
}

// ---------------------------------------------------------------- lat-long images

TEST(ShProjection, WhiteLatLongImageIsTheWhiteSky) {
  for (const int height : {1, 2, 16, 100}) {
    const ShRgb result = project_radiance(
        environment_of(light::LatLongSky{image::make_image(2 * height, height, Rgb(1.0F))}), 8);
    EXPECT_LE(std::abs(result.coefficients[0].r - std::sqrt(4.0 * kPi)), 1e-13) << height;
    for (std::size_t i = 1; i < 64; ++i)
      EXPECT_LE(std::abs(result.coefficients[i].r), 1e-13) << height << " " << i;
  }
}

// The 8-node rule's own error at 5 bands and 22.5 degrees a texel is below 1e-15; both sum about a thousand
// terms.
TEST(ShProjection, AsymmetricLatLongMatchesBruteForce) {
  const light::Environment environment = environment_of(light::LatLongSky{random_image(16, 8, 3)});
  EXPECT_LE(largest_difference(project_radiance(environment, 5).coefficients,
                               lat_long_by_texels(environment, 5, 8)),
            1e-12);
}

TEST(ShProjection, RotatedLatLongMatchesBruteForce) {
  light::Environment environment = environment_of(light::LatLongSky{random_image(16, 8, 4)});
  environment = light::rotated(environment, Vec3(20.0F, -35.0F, 70.0F));
  // The rotation is a float matrix: orthonormal to 1e-7.
  EXPECT_LE(largest_difference(project_radiance(environment, 5).coefficients,
                               lat_long_by_texels(environment, 5, 8)),
            3e-6);
}

TEST(ShProjection, ManyBandsMatchBruteForce) {
  const light::Environment environment = environment_of(light::LatLongSky{random_image(24, 12, 5)});
  EXPECT_LE(largest_difference(project_radiance(environment, 20).coefficients,
                               lat_long_by_texels(environment, 20, 14)),
            1e-11);
}

TEST(ShProjection, CoarseImagesWithManyBandsAreExactToo) {
  const light::Environment environment = environment_of(light::LatLongSky{random_image(4, 2, 6)});
  EXPECT_LE(largest_difference(project_radiance(environment, 40).coefficients,
                               lat_long_by_texels(environment, 40, 60)),
            1e-11);
}

TEST(GaussCount, IsTheLeastThatReachesTheTolerance) {
  for (const double phase : {0.1, 1.0, 10.0, 100.0}) {
    const int count = gauss_count(phase, 1e-12);
    const auto error = [&](int k) {
      const GaussLegendre rule = gauss_legendre(k);
      double sum = 0.0;
      for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
        sum += 0.5 * rule.weights[i] * std::cos(0.5 * phase * rule.nodes[i]);
      }
      return std::abs(sum - std::sin(0.5 * phase) / (0.5 * phase));
    };
    EXPECT_LE(error(count), 1e-12) << phase;
    if (count > 4) {
      EXPECT_GE(error(count - 3), 1e-14) << phase;
    }
  }
}

// One texel alone: its solid angle is dphi (cos t0 - cos t1).
TEST(ShProjection, SingleTexelHasItsExactSolidAngle) {
  image::Image image = image::make_image(64, 32);
  image.at(5, 3) = Rgb(1.0F);
  const ShRgb result = project_radiance(environment_of(light::LatLongSky{image}), 4);
  const double solid_angle = 2.0 * kPi / 64.0 * (std::cos(kPi * 3.0 / 32.0) - std::cos(kPi * 4.0 / 32.0));
  EXPECT_LE(std::abs(result.coefficients[0].r * std::sqrt(4.0 * kPi) / solid_angle - 1.0), 1e-13);
}

// A texel's coefficients point where the texel is: centre of the image +X, three quarters +Z, top +Y.
TEST(ShProjection, LatLongAxesAreTheConventions) {
  const auto bright_at = [](int x, int y) {
    image::Image image = image::make_image(400, 200);
    image.at(x, y) = image.at(x - 1, y) = image.at(x, y - 1) = image.at(x - 1, y - 1) = Rgb(1.0F);
    const Coefficients c = project_radiance(environment_of(light::LatLongSky{image}), 2).coefficients;
    return glm::normalize(Vec3d(-c[3].r, -c[1].r, c[2].r));
  };
  EXPECT_LE(glm::length(bright_at(200, 100) - Vec3d(1, 0, 0)), 1e-4);
  EXPECT_LE(glm::length(bright_at(300, 100) - Vec3d(0, 0, 1)), 1e-4);
  EXPECT_LE(glm::length(bright_at(200, 2) - Vec3d(0, 1, 0)), 0.05);
}

TEST(ShProjection, IsTheSameForAnyNumberOfThreads) {
  const light::Environment environment = environment_of(light::LatLongSky{random_image(64, 32, 6)});
  const Coefficients one = project_radiance(environment, 6, 1).coefficients;
  EXPECT_EQ(one, project_radiance(environment, 6, 2).coefficients);
  EXPECT_EQ(one, project_radiance(environment, 6, 5).coefficients);
  const light::Environment cube = random_cube(8, 6);
  EXPECT_EQ(project_radiance(cube, 6, 1).coefficients, project_radiance(cube, 6, 3).coefficients);
}

TEST(ShProjection, IsLinear) {
  const image::Image a = random_image(32, 16, 7);
  const image::Image b = random_image(32, 16, 8);
  image::Image sum = a;
  for (std::size_t i = 0; i < sum.pixels.size(); ++i) sum.pixels[i] = 2.0F * a.pixels[i] + 3.0F * b.pixels[i];
  const Coefficients pa = project_radiance(environment_of(light::LatLongSky{a}), 5).coefficients;
  const Coefficients pb = project_radiance(environment_of(light::LatLongSky{b}), 5).coefficients;
  Coefficients expected = pa;
  for (std::size_t i = 0; i < expected.size(); ++i) expected[i] = 2.0 * pa[i] + 3.0 * pb[i];
  // The texels are multiples of 2^-10: their sum is exact in float.
  EXPECT_LE(
      largest_difference(project_radiance(environment_of(light::LatLongSky{sum}), 5).coefficients, expected),
      1e-12);
}

/// Coefficients after turning the function about z: pairs (m, -m) turn by m times the angle.
Coefficients turned_about_z(const Coefficients& c, int bands, double angle) {
  Coefficients result = c;
  for (int l = 0; l < bands; ++l) {
    for (int m = 1; m <= l; ++m) {
      const auto plus = static_cast<std::size_t>(index(l, m));
      const auto minus = static_cast<std::size_t>(index(l, -m));
      result[plus] = std::cos(m * angle) * c[plus] - std::sin(m * angle) * c[minus];
      result[minus] = std::sin(m * angle) * c[plus] + std::cos(m * angle) * c[minus];
    }
  }
  return result;
}

TEST(ShProjection, TurningTheEnvironmentAboutZTurnsThePairs) {
  std::vector<light::Environment> environments{environment_of(light::LatLongSky{random_image(32, 16, 9)}),
                                               random_cube(6, 9),
                                               environment_of(light::AngularMapSky{random_image(24, 24, 9)}),
                                               light::make_builtin_environment("two-lobes")};
  environments[0].suns.push_back({glm::normalize(Vec3(0.6F, -0.1F, 0.7F)), 0.2, Rgb(3.0F)});
  for (const light::Environment& environment : environments) {
    const Coefficients still = project_radiance(environment, 6).coefficients;
    const Coefficients moved =
        project_radiance(light::rotated(environment, Vec3(0.0F, 0.0F, 30.0F)), 6).coefficients;
    // The float rotation matrix is good to 6e-8, times the degree and coefficients of size up to about 10.
    EXPECT_LE(largest_difference(moved, turned_about_z(still, 6, kPi / 6.0)), 5e-6);
    EXPECT_GE(largest_difference(moved, turned_about_z(still, 6, -kPi / 6.0)), 1e-2);
  }
}

// ---------------------------------------------------------------- cube maps and angular maps

TEST(CubeTexel, HasTheKnownSolidAngles) {
  EXPECT_LE(std::abs(cube_texel_solid_angle(4, 0, 0) - .0814555875954), 1e-13);
  EXPECT_LE(std::abs(cube_texel_solid_angle(4, 1, 0) - .120392633606), 1e-12);
  EXPECT_LE(std::abs(cube_texel_solid_angle(4, 3, 2) - .120392633606), 1e-12);
  EXPECT_LE(std::abs(cube_texel_solid_angle(4, 2, 1) - .201357920790), 1e-12);
  EXPECT_THROW(static_cast<void>(cube_texel_solid_angle(4, 4, 0)), InputError);
}

TEST(CubeTexel, SolidAnglesOfAllFacesAddUpToTheSphere) {
  for (const int size : {1, 3, 8, 64}) {
    double sum = 0.0;
    for (int y = 0; y < size; ++y) {
      for (int x = 0; x < size; ++x) sum += 6.0 * cube_texel_solid_angle(size, x, y);
    }
    EXPECT_LE(std::abs(sum - 4.0 * kPi), 1e-15 * 6.0 * size * size + 1e-14) << size;
  }
}

TEST(ShProjection, CubeMapMatchesBruteForce) {
  constexpr int kSize = 4;
  constexpr int kNodes = 12;
  const light::Environment environment = random_cube(kSize, 20);
  const GaussLegendre rule = gauss_legendre(kNodes);
  BruteForce brute(environment, 5);
  for (int face = 0; face < 6; ++face) {
    for (int cell = 0; cell < kSize * kSize * kNodes * kNodes; ++cell) {
      const auto i = static_cast<std::size_t>(cell % kNodes);
      const auto j = static_cast<std::size_t>(cell / kNodes % kNodes);
      const int texel = cell / (kNodes * kNodes);
      const double u = (texel % kSize + 0.5 + 0.5 * rule.nodes[i]) / kSize;
      const double v = (texel / kSize + 0.5 + 0.5 * rule.nodes[j]) / kSize;
      const double s = 2.0 * u - 1.0;
      const double t = 2.0 * v - 1.0;
      const double square = 1.0 + s * s + t * t;
      const Vec3d d(light::direction_from_cube({face, Vec2(u, v)}));
      brute.add(glm::normalize(d),
                rule.weights[i] * rule.weights[j] / (kSize * kSize * square * std::sqrt(square)));
    }
  }
  EXPECT_LE(std::abs(brute.solid_angle() - 4.0 * kPi), 1e-10);
  // The mapping under test answers in float.
  EXPECT_LE(largest_difference(project_radiance(environment, 5).coefficients, brute.sum()), 2e-6);
}

/// The slow definition for cube maps: Gauss nodes inside each texel of each face, in the world's frame.
Coefficients cube_by_texels(const light::Environment& environment, int bands, int nodes) {
  const auto& cube = std::get<light::CubeMapSky>(environment.sky);
  const glm::dmat3 rotation(environment.rotation);
  const Basis<double> basis(bands);
  const GaussLegendre rule = gauss_legendre(nodes);
  std::vector<double> values(static_cast<std::size_t>(bands * bands));
  Coefficients sum(values.size(), RgbD(0.0));
  std::vector<ImageNode> texel;
  for (int face = 0; face < 6; ++face) {
    const image::Image& image = cube.faces[static_cast<std::size_t>(face)];
    for (int k = 0; k < image.width * image.width; ++k) {
      texel.clear();
      append_cube_nodes(face, texel_rectangle(image.width, k % image.width, k / image.width), rule, texel);
      const RgbD radiance(image.at(k % image.width, k / image.width));
      for (const ImageNode& node : texel) {
        const Vec3d d = rotation * node.direction;
        basis.evaluate(d.x, d.y, d.z, values);
        for (std::size_t i = 0; i < values.size(); ++i) sum[i] += node.weight * values[i] * radiance;
      }
    }
  }
  return sum;
}

// Relative to a light of size 4 over the sphere: the texel rule promises 1e-9 (for these phases), more nodes are exact.
TEST(ShProjection, CubeFacesBySymmetryMatchTheirTexels) {
  for (const int size : {2, 3, 8, 17}) {
    const light::Environment environment = random_cube(size, 20);
    EXPECT_LE(
        largest_difference(project_radiance(environment, 5).coefficients, cube_by_texels(environment, 5, 12)),
        4.0 * 4.0 * kPi * 1e-9)
        << size;
  }
}
// The rotation is a float matrix: orthonormal to 1e-7, which the turned faces see differently.
TEST(ShProjection, RotatedCubeFacesMatchTheirTexels) {
  const light::Environment environment = light::rotated(random_cube(6, 25), Vec3(20.0F, -35.0F, 70.0F));
  EXPECT_LE(
      largest_difference(project_radiance(environment, 5).coefficients, cube_by_texels(environment, 5, 12)),
      3e-6);
}
TEST(ShProjection, TheTexelComparisonSeesAMirroredFace) {
  light::Environment environment = random_cube(4, 20);
  const Coefficients truth = cube_by_texels(environment, 5, 12);
  image::Image& face = std::get<light::CubeMapSky>(environment.sky).faces[2];
  for (int y = 0; y < 4; ++y) std::swap(face.at(0, y), face.at(3, y));
  EXPECT_GT(largest_difference(project_radiance(environment, 5).coefficients, truth), 1e-3);
}

// No half turn to fold where the number of columns is odd; 70 columns end in the middle of a vector and of a chunk.
TEST(ShProjection, AnyNumberOfColumnsMatchesBruteForce) {
  for (const int width : {1, 7, 15, 70, 150}) {
    const light::Environment environment = environment_of(light::LatLongSky{random_image(width, 6, 8)});
    const std::size_t nodes = width < 10 ? 20 : 8;
    EXPECT_LE(largest_difference(project_radiance(environment, 4).coefficients,
                                 lat_long_by_texels(environment, 4, nodes)),
              1e-11)
        << width;
  }
}

// Against a fine grid in (theta, phi) about +Z: its midpoint error at the texels' edges is a few texels'
// worth of 1e-3.
TEST(ShProjection, AngularMapMatchesBruteForce) {
  const light::Environment environment = environment_of(light::AngularMapSky{random_image(8, 8, 30)});
  constexpr int kRows = 400;
  BruteForce brute(environment, 4);
  for (int row = 0; row < kRows; ++row) {
    const double theta = kPi * (row + 0.5) / kRows;
    const double weight = (std::cos(kPi * row / kRows) - std::cos(kPi * (row + 1.0) / kRows)) * kPi / kRows;
    for (int column = 0; column < 2 * kRows; ++column) {
      const double phi = kPi * (column + 0.37) / kRows;
      brute.add(Vec3d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)),
                weight);
    }
  }
  EXPECT_LE(largest_difference(project_radiance(environment, 4).coefficients, brute.sum()), 5e-3);
}

TEST(ShProjection, WhiteAngularMapIsTheWhiteSky) {
  const ShRgb result =
      project_radiance(environment_of(light::AngularMapSky{image::make_image(64, 64, Rgb(1.0F))}), 6);
  EXPECT_LE(std::abs(result.coefficients[0].r - std::sqrt(4.0 * kPi)), 1e-13);
  for (std::size_t i = 1; i < 36; ++i) EXPECT_LE(std::abs(result.coefficients[i].r), 1e-6) << i;
}

// ---------------------------------------------------------------- bilinear images

light::Environment bilinear(light::Environment environment) {
  environment.lookup = light::Lookup::bilinear;
  return environment;
}

/// The same image with texels of -2 … 2.
light::Environment signed_lat_long(int width, int height, unsigned seed) {
  image::Image image = random_image(width, height, seed);
  for (Rgb& texel : image.pixels) texel -= Rgb(2.0F);
  return bilinear(environment_of(light::LatLongSky{image}));
}

/// The slow definition: k x k Gauss nodes in (phi, theta) inside each quarter of a texel, where the interpolant is
/// smooth; the radiance looked up as a camera ray does.
Coefficients lat_long_by_quarters(const light::Environment& environment, int bands, std::size_t k) {
  const auto& image = std::get<light::LatLongSky>(environment.sky).image;
  const glm::dmat3 rotation(environment.rotation);
  const GaussLegendre rule = gauss_legendre(static_cast<int>(k));
  BruteForce brute(environment, bands);
  const int across = 2 * image.width;
  const int down = 2 * image.height;
  for (int y = 0; y < down; ++y) {
    for (std::size_t j = 0; j < k; ++j) {
      const double theta = kPi * (y + 0.5 + 0.5 * rule.nodes[j]) / down;
      for (std::size_t i = 0; i < static_cast<std::size_t>(across) * k; ++i) {
        const double phi =
            2.0 * kPi * ((static_cast<double>(i / k) + 0.5 + 0.5 * rule.nodes[i % k]) / across - 0.5);
        const Vec3d local(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
        brute.add(glm::normalize(rotation * local), 0.25 * rule.weights[i % k] * rule.weights[j] * 2.0 * kPi /
                                                        across * kPi / down * std::sin(theta));
      }
    }
  }
  EXPECT_LE(std::abs(brute.solid_angle() - 4.0 * kPi), 1e-11);
  return brute.sum();
}

// The lookup answers in float: coordinates to 2e-7 of the image, so texels to 3.2e-6 in u and 1.6e-6 in v, times
// differences of up to 4; thousands of them, of either sign.
constexpr double kFloatLookup = 4.0 * (3.2e-6 + 1.6e-6);

TEST(ShProjection, BilinearLatLongMatchesBruteForce) {
  for (const light::Environment& environment :
       {bilinear(environment_of(light::LatLongSky{random_image(16, 8, 3)})), signed_lat_long(16, 8, 4),
        signed_lat_long(5, 3, 5), signed_lat_long(1, 1, 6), signed_lat_long(2, 1, 7)}) {
    const Coefficients found = project_radiance(environment, 5).coefficients;
    EXPECT_LE(largest_difference(found, lat_long_by_quarters(environment, 5, 20)), kFloatLookup);
    light::Environment nearest = environment;
    nearest.lookup = light::Lookup::nearest;
    const auto& image = std::get<light::LatLongSky>(environment.sky).image;
    if (image.width > 4) {
      EXPECT_GT(largest_difference(found, project_radiance(nearest, 5).coefficients), 1e-2);
    }
  }
}

TEST(ShProjection, RotatedBilinearLatLongMatchesBruteForce) {
  const light::Environment environment =
      light::rotated(signed_lat_long(16, 8, 4), Vec3(20.0F, -35.0F, 70.0F));
  EXPECT_LE(largest_difference(project_radiance(environment, 5).coefficients,
                               lat_long_by_quarters(environment, 5, 20)),
            kFloatLookup + 3e-6);
}

/// The lat-long interpolant once more, in double and without the lookup: texel by texel, hats in phi and theta
/// integrated by Gauss nodes over their own support.
Coefficients lat_long_by_hats(const image::Image& image, int bands) {
  const GaussLegendre rule = gauss_legendre(20);
  const Basis<double> basis(bands);
  std::vector<double> values(static_cast<std::size_t>(bands * bands));
  Coefficients sum(values.size(), RgbD(0.0));
  const auto each_node = [&](int texel, int count, bool is_clamped, const auto& f) {
    for (const double side : {-1.0, 1.0}) {
      const bool is_border = is_clamped && (side < 0.0 ? texel == 0 : texel == count - 1);
      const double length = is_border ? 0.5 : 1.0;
      for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
        const double offset = length * (0.5 + 0.5 * rule.nodes[k]);
        f((texel + 0.5 + side * offset) / count,
          0.5 * rule.weights[k] * length / count * (is_border ? 1.0 : 1.0 - offset));
      }
    }
  };
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      each_node(y, image.height, true, [&](double v, double weight_v) {
        each_node(x, image.width, false, [&](double u, double weight_u) {
          const double sine = std::sin(kPi * v);
          const double phi = 2.0 * kPi * (u - 0.5);
          basis.evaluate(sine * std::cos(phi), std::cos(kPi * v), sine * std::sin(phi), values);
          const RgbD radiance = weight_u * weight_v * 2.0 * kPi * kPi * sine * RgbD(image.at(x, y));
          for (std::size_t i = 0; i < values.size(); ++i) sum[i] += values[i] * radiance;
        });
      });
    }
  }
  return sum;
}

// 20 nodes over at most 180 degrees at 12 bands leave 1e-15; the rest is the rounding of thousands of terms.
TEST(ShProjection, BilinearLatLongIsExactToRounding) {
  for (const auto& [width, height, bands] :
       {std::tuple(16, 8, 5), std::tuple(4, 2, 12), std::tuple(2, 1, 5)}) {
    const image::Image image = random_image(width, height, 8);
    EXPECT_LE(largest_difference(
                  project_radiance(bilinear(environment_of(light::LatLongSky{image})), bands).coefficients,
                  lat_long_by_hats(image, bands)),
              1e-11)
        << width << "x" << height;
  }
}

TEST(ShProjection, WhiteBilinearImagesAreTheWhiteSky) {
  const image::Image map = image::make_image(16, 8, Rgb(1.0F));
  const image::Image square = image::make_image(8, 8, Rgb(1.0F));
  const std::vector<light::Sky> skies{light::LatLongSky{map},
                                      light::CubeMapSky{{square, square, square, square, square, square}},
                                      light::AngularMapSky{square}};
  const std::vector<double> tolerances{1e-13, 1e-8, 1e-6};
  for (std::size_t k = 0; k < skies.size(); ++k) {
    const ShRgb result = project_radiance(bilinear(environment_of(skies[k])), 6);
    EXPECT_LE(std::abs(result.coefficients[0].r - std::sqrt(4.0 * kPi)), 1e-12) << k;
    for (std::size_t i = 1; i < 36; ++i)
      EXPECT_LE(std::abs(result.coefficients[i].r), tolerances[k]) << k << " " << i;
  }
}

/// Twelve Gauss nodes each way inside each quarter of a cube's texels.
Coefficients cube_by_quarters(const light::Environment& environment, int size, int bands) {
  const GaussLegendre rule = gauss_legendre(12);
  const glm::dmat3 rotation(environment.rotation);
  BruteForce brute(environment, bands);
  const int cells = 2 * size;
  for (int face = 0; face < 6; ++face) {
    for (int cell = 0; cell < cells * cells; ++cell) {
      for (std::size_t node = 0; node < 144; ++node) {
        const double s = 2.0 * (cell % cells + 0.5 + 0.5 * rule.nodes[node % 12]) / cells - 1.0;
        const double t = 2.0 * (cell / cells + 0.5 + 0.5 * rule.nodes[node / 12]) / cells - 1.0;
        const double square = 1.0 + s * s + t * t;
        const Vec3d d(light::direction_from_cube({face, Vec2(0.5 + 0.5 * s, 0.5 + 0.5 * t)}));
        brute.add(glm::normalize(rotation * d), rule.weights[node % 12] * rule.weights[node / 12] /
                                                    (cells * cells * square * std::sqrt(square)));
      }
    }
  }
  return brute.sum();
}

TEST(ShProjection, BilinearCubeMapMatchesBruteForce) {
  for (const int size : {1, 4}) {
    const light::Environment environment = bilinear(random_cube(size, 20));
    EXPECT_LE(largest_difference(project_radiance(environment, 5).coefficients,
                                 cube_by_quarters(environment, size, 5)),
              4e-6);
    const light::Environment turned = light::rotated(environment, Vec3(90.0F, 0.0F, -90.0F));
    EXPECT_LE(largest_difference(project_radiance(turned, 5).coefficients, cube_by_quarters(turned, size, 5)),
              4e-6);
  }
}

// Continuous but for the rim, where all directions are -Z: the midpoint rule's error is that of kinks, O(h^2) with h =
// 0.45 degrees, 50 times smaller than a texel: 4 / 50^2 of the little solid angle around the kinks.
TEST(ShProjection, BilinearAngularMapMatchesBruteForce) {
  for (const int size : {7, 8}) {
    light::Environment environment =
        bilinear(environment_of(light::AngularMapSky{random_image(size, size, 30)}));
    environment = light::rotated(environment, Vec3(0.0F, 90.0F, 0.0F));
    const glm::dmat3 rotation(environment.rotation);
    constexpr int kRows = 400;
    BruteForce brute(environment, 4);
    for (int row = 0; row < kRows; ++row) {
      const double theta = kPi * (row + 0.5) / kRows;
      const double weight = (std::cos(kPi * row / kRows) - std::cos(kPi * (row + 1.0) / kRows)) * kPi / kRows;
      for (int column = 0; column < 2 * kRows; ++column) {
        const double phi = kPi * (column + 0.37) / kRows;
        brute.add(rotation * Vec3d(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                   std::cos(theta)),
                  weight);
      }
    }
    EXPECT_LE(largest_difference(project_radiance(environment, 4).coefficients, brute.sum()), 2e-4) << size;
  }
}

TEST(ShProjection, OfBilinearImagesIsTheSameForAnyNumberOfThreads) {
  for (const light::Environment& environment :
       {signed_lat_long(64, 32, 6), bilinear(random_cube(8, 6)),
        bilinear(environment_of(light::AngularMapSky{random_image(16, 16, 6)}))}) {
    const Coefficients one = project_radiance(environment, 6, 1).coefficients;
    EXPECT_EQ(one, project_radiance(environment, 6, 3).coefficients);
  }
}

// ---------------------------------------------------------------- analytic skies

/// integral_c^1 (a x - b) P_l(x) dx times 2 pi sqrt((2l + 1)/(4 pi)): z_l of max(0, a cos t - b), c = b / a.
std::vector<double> lobe(int bands, double a, double b) {
  const GaussLegendre rule = gauss_legendre(bands);
  std::vector<double> zonal(static_cast<std::size_t>(bands), 0.0);
  const double c = b / a;
  for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
    const double x = 0.5 * (1.0 + c) + 0.5 * (1.0 - c) * rule.nodes[k];
    const std::vector<double> p = legendre(bands, x);
    for (std::size_t l = 0; l < zonal.size(); ++l) {
      zonal[l] += 0.5 * (1.0 - c) * rule.weights[k] * (a * x - b) * p[l] *
                  std::sqrt(kPi * (2.0 * static_cast<double>(l) + 1.0));
    }
  }
  return zonal;
}

/// The papers' light is two zonal lobes, max(0, 5 c - 4) about +z and max(0, 4 c - 3) about (cos 2.5,
/// sin 2.5, 0): exact.
std::vector<double> two_lobes_coefficients(int bands) {
  std::vector<double> result = rotate_zonal(lobe(bands, 5.0, 4.0), Vec3d(0.0, 0.0, 1.0));
  const std::vector<double> second =
      rotate_zonal(lobe(bands, 4.0, 3.0), Vec3d(std::cos(2.5), std::sin(2.5), 0.0));
  for (std::size_t i = 0; i < result.size(); ++i) result[i] += second[i];
  return result;
}

// The kinks cost O(h^2) with h = 0.35 degrees.
TEST(ShProjection, TwoLobesMatchTheirClosedForm) {
  const Coefficients result = project_radiance(light::make_builtin_environment("two-lobes"), 10).coefficients;
  const std::vector<double> expected = two_lobes_coefficients(10);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_LE(std::abs(result[i].r - expected[i]), 1e-6) << i;
    EXPECT_EQ(result[i].r, result[i].b) << i;
  }
}

// Green, "Spherical Harmonic Lighting: The Gritty Details" (2003), lists coefficients of this light estimated
// from 10 000 stratified samples, good to about 1e-3. The list as it is handed down has fifteen numbers for
// sixteen functions: y_3-3 (-0.2496) is left out, so that everything after it is one place early, and y_22
// has the opposite sign. The other signs are ours: the Condon-Shortley phase is in, theta is from +z, phi
// from +x to +y.
TEST(ShProjection, TwoLobesAgreeWithThePublishedEstimate) {
  const std::vector<double> published{0.39925,  -0.21075, 0.28687,  0.28277,  -0.31530,
                                      -0.00040, 0.13159,  0.00098,  -0.09359, -0.00072,
                                      0.12290,  0.30458,  -0.16427, -0.00062, -0.09126};
  const std::vector<double> ours = two_lobes_coefficients(4);
  for (std::size_t i = 0; i < published.size(); ++i) {
    const std::size_t place = i < 9 ? i : i + 1;
    const double expected = place == 8 ? -ours[place] : ours[place];
    EXPECT_LE(std::abs(published[i] - expected), 1.5e-3) << i;
  }
  EXPECT_LE(std::abs(ours[9] + 0.2496), 1e-4);
}

TEST(ShProjection, OvercastSkyMatchesItsClosedForm) {
  // (1 + 2 c)/3 over the hemisphere about +Y: z_l from the same integrals, split at the horizon where it
  // jumps.
  const GaussLegendre rule = gauss_legendre(20);
  std::vector<double> zonal(6, 0.0);
  for (std::size_t k = 0; k < rule.nodes.size(); ++k) {
    const double x = 0.5 * (1.0 + rule.nodes[k]);
    const std::vector<double> p = legendre(6, x);
    for (std::size_t l = 0; l < 6; ++l) {
      zonal[l] += 0.5 * rule.weights[k] * (1.0 + 2.0 * x) / 3.0 * p[l] *
                  std::sqrt(kPi * (2.0 * static_cast<double>(l) + 1.0));
    }
  }
  const std::vector<double> expected = rotate_zonal(zonal, Vec3d(0.0, 1.0, 0.0));
  const Coefficients result = project_radiance(light::make_builtin_environment("overcast"), 6).coefficients;
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_LE(std::abs(result[i].g - expected[i]), 5e-7) << i;
}

TEST(ShProjection, OfABandLimitedEnvironmentIsTheIdentity) {
  for (const int bands : {1, 4, 7, 12}) {
    std::mt19937 bits(17);
    ShRgb function{bands, {}};
    for (int i = 0; i < coefficient_count(bands); ++i) {
      function.coefficients.emplace_back(static_cast<double>(bits() % 2001) / 1000.0 - 1.0, 0.5, -0.25);
    }
    const ShRgb again = project_radiance(band_limited_environment(function, "again"), bands);
    // Directions and radiance are float, values are of size `bands`.
    EXPECT_LE(largest_difference(again.coefficients, function.coefficients), 1e-6 * bands) << bands;
  }
}

TEST(ShProjection, KeepsTheLowDegreesOfMoreBands) {
  const light::Environment environment = environment_of(light::LatLongSky{random_image(32, 16, 12)});
  Coefficients many = project_radiance(environment, 12).coefficients;
  many.resize(16);
  EXPECT_LE(largest_difference(many, project_radiance(environment, 4).coefficients), 1e-12);
}

// ---------------------------------------------------------------- refusals

TEST(ShProjection, RefusesWhatItCannotProject) {
  const auto refused = [](const light::Environment& environment, int bands) {
    EXPECT_THROW(static_cast<void>(project_radiance(environment, bands)), InputError);
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const light::Environment good = environment_of(light::ConstantSky{Rgb(1.0F)});
  refused(good, 0);
  refused(good, kMaxBands + 1);
  refused(environment_of(light::ConstantSky{Rgb(nan)}), 3);
  refused(environment_of(light::LatLongSky{}), 3);
  refused(environment_of(light::CubeMapSky{}), 3);
  refused(environment_of(light::AngularMapSky{image::make_image(4, 8)}), 3);
  refused(environment_of(light::AnalyticSky{[=](const Vec3& d) { return Rgb(d.x > 0.9F ? nan : 1.0F); }}), 3);
  light::Environment bad = good;
  bad.suns.push_back({Vec3(0.0F), 0.1, Rgb(1.0F)});
  refused(bad, 3);
  bad = good;
  bad.rotation[0][0] = 2.0F;
  refused(bad, 3);
  bad.rotation[0][0] = nan;
  refused(bad, 3);
}

TEST(ShProjection, NamesTheNonFiniteTexel) {
  image::Image image = image::make_image(8, 4, Rgb(1.0F));
  image.at(5, 2).g = std::numeric_limits<float>::infinity();
  try {
    static_cast<void>(project_radiance(environment_of(light::LatLongSky{image}), 3));
    FAIL() << "projected an infinite texel";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("(5, 2)"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace plumbline::sh
