// Transfer that leaves the normal open: against hand integrals, against the path tracer's probes, and against itself in other forms.
#include "prt/normal_map/local_transfer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "prt/normal_map/normal_texture.hpp"
#include "prt/normal_map/view.hpp"
#include "prt/sh/basis.hpp"
#include "reference/base/error.hpp"
#include "reference/integrate/probe.hpp"
#include "reference/scene/builtin.hpp"
#include "reference/scene/normal_map.hpp"

namespace plumbline::normal_map {
namespace {

/// One square facing +z with tangents along +x, nothing in its way.
scene::Scene lone_square() {
  scene::Scene scene;
  scene.positions = {{-1.0F, -1.0F, 0.0F}, {1.0F, -1.0F, 0.0F}, {1.0F, 1.0F, 0.0F}, {-1.0F, 1.0F, 0.0F}};
  scene.normals.assign(4, Vec3(0.0F, 0.0F, 1.0F));
  scene.tangents.assign(4, glm::vec4(1.0F, 0.0F, 0.0F, 1.0F));
  scene.triangles = {{0U, 1U, 2U}, {0U, 2U, 3U}};
  scene.triangle_materials = {0U, 0U};
  scene.materials = {{.name = "m"}};
  return scene;
}

LocalTransfer square_transfer(int bands, int samples) {
  LocalBakeSettings settings;
  settings.bands = bands;
  settings.samples = samples;
  return bake_incident_radiance(lone_square(), settings);
}

/// A light of three bands that is different in every coefficient.
sh::ShRgb uneven_light(int bands) {
  sh::ShRgb light{bands, {}};
  for (int i = 0; i < bands * bands; ++i) {
    light.coefficients.emplace_back(i == 0 ? 3.0 : std::sin(1.7 * i), i == 0 ? 2.0 : std::cos(2.3 * i),
                                    i == 0 ? 2.5 : 0.5 * std::sin(0.9 * i));
  }
  return light;
}

const std::vector<Vec3d> kNormals = {{0.0, 0.0, 1.0},
                                     glm::normalize(Vec3d(0.4, -0.3, 0.8)),
                                     glm::normalize(Vec3d(-0.5, 0.6, 0.5)),
                                     glm::normalize(Vec3d(0.0, 0.7, 0.7))};

// The half-sphere integrals of y_j y_i. Tolerance: log(N)^2 / N = 5.7e-3 for a two-dimensional point set of N = 16384.
TEST(LocalTransfer, OfAnOpenPlaneIsTheHalfSpheresGramMatrix) {
  const LocalTransfer transfer = square_transfer(3, 1 << 14);
  const std::span<const float> m = transfer.matrix(2);
  const auto at = [&](int j, int i) { return static_cast<double>(m[static_cast<std::size_t>(9 * j + i)]); };
  constexpr double kTolerance = 5.7e-3;
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(at(i, i), 0.5, kTolerance) << i;  // the whole sphere would give 1
  EXPECT_NEAR(at(0, 2), std::sqrt(3.0) / 4.0, kTolerance);
  EXPECT_NEAR(at(2, 6), std::sqrt(15.0) / 16.0, kTolerance);
  EXPECT_NEAR(at(3, 7), std::sqrt(45.0) / 16.0, kTolerance);
  EXPECT_NEAR(at(1, 5), std::sqrt(45.0) / 16.0, kTolerance);
  EXPECT_NEAR(at(0, 6), 0.0, kTolerance);
  EXPECT_NEAR(at(1, 3), 0.0, kTolerance);
}

// A white sky over an open plane: a white surface reflects 1 along its own normal, of which degree 0 and 1 carry a half each.
TEST(LocalTransfer, ReflectsAWhiteSkyWhole) {
  sh::ShRgb white{3, std::vector<RgbD>(9, RgbD(0.0))};
  white.coefficients[0] = RgbD(std::sqrt(4.0 * kPi));
  const std::vector<Rgb> rows = lit_rows(square_transfer(3, 1 << 14), white);
  Fragment f;
  f.weights = {1.0F, 0.0F, 0.0F};
  f.normal = f.in_frame = {0.0, 0.0, 1.0};
  EXPECT_NEAR(shade_in_world(rows)(f).x, 1.0F, 5.7e-3);
}

// The path tracer gathers the same nine integrals with its own sampling, under the same light, at vertices with shadows around.
TEST(LocalTransfer, AgreesWithPathTracedProbes) {
  const scene::Scene scene = scene::make_builtin_scene("normal-mapped");
  const sh::ShRgb light = uneven_light(3);
  LocalBakeSettings settings;
  settings.bands = 3;
  settings.samples = 1 << 12;
  const std::vector<Rgb> rows = lit_rows(bake_incident_radiance(scene, settings), light);
  const integrate::World world(scene, sh::band_limited_environment(light, "uneven"));
  const std::vector<trace::SurfacePoint> points = trace::vertex_points(scene);
  double largest = 0.0;
  double largest_of_unshadowed = 0.0;
  for (const std::size_t v : {std::size_t{1200}, std::size_t{1224}, std::size_t{2600}, std::size_t{5000}}) {
    const Vec3d up(points[v].geometric_normal);
    const integrate::SphereFunctions functions{9, [&](const Vec3d& direction, std::span<double> values) {
                                                 sh::Basis<double>(3).evaluate(direction.x, direction.y,
                                                                               direction.z, values);
                                                 if (glm::dot(direction, up) > 0.0) return;
                                                 std::fill(values.begin(), values.end(), 0.0);
                                               }};
    integrate::GatherSettings gather;
    gather.samples = 1 << 14;
    gather.max_bounces = 0;
    const std::vector<integrate::RgbEstimate> probe =
        integrate::gather_probe(world, points[v], functions, v, gather);
    for (std::size_t j = 0; j < 9; ++j) {
      // 4 standard errors of the probe; the bake's own error is that of 4096 points, log(N)^2 / N = 0.017 of the light's size.
      const double allowed = 4.0 * probe[j].standard_error.x + 0.017 * 3.0;
      largest =
          std::max(largest, std::abs(probe[j].mean.x - static_cast<double>(rows[9 * v + j].x)) / allowed);
      const double open = light.coefficients[j].x;
      largest_of_unshadowed = std::max(largest_of_unshadowed, std::abs(probe[j].mean.x - open) / allowed);
    }
  }
  EXPECT_LE(largest, 1.0);
  EXPECT_GE(largest_of_unshadowed, 3.0);  // the comparison fails for a light that nothing blocks
}

TEST(LocalTransfer, TheTangentFrameOnlyTurnsTheAxes) {
  const scene::Scene scene = scene::make_builtin_scene("normal-mapped");
  LocalBakeSettings settings;
  settings.bands = 2;
  settings.samples = 16;
  const LocalTransfer world = bake_incident_radiance(scene, settings);
  const LocalTransfer tangent = in_tangent_frames(world, scene);
  const sh::ShRgb light = uneven_light(2);
  const std::vector<Rgb> in_world = lit_rows(world, light);
  const std::vector<Rgb> in_frame = lit_rows(tangent, light);
  double difference_without_turning = 0.0;
  for (const std::uint32_t v : {1000U, 3000U, 6000U}) {
    const auto frame = scene::tangent_frame(scene, {v, v, v}, {1.0F, 0.0F, 0.0F}, scene.normals[v]);
    ASSERT_TRUE(frame.has_value());
    for (const Vec3d& normal : kNormals) {
      Fragment f;
      f.corners = {v, v, v};
      f.weights = {1.0F, 0.0F, 0.0F};
      f.in_frame = normal;
      f.normal = Vec3d(scene::to_world(*frame, Vec3(normal)));
      EXPECT_LE(glm::length(shade_in_world(in_world)(f) - shade_in_frame(in_frame)(f)), 1e-5F) << v;
      f.normal = normal;
      difference_without_turning = std::max(
          difference_without_turning,
          static_cast<double>(glm::length(shade_in_world(in_world)(f) - shade_in_frame(in_frame)(f))));
    }
  }
  EXPECT_GE(difference_without_turning, 0.1);
}

TEST(LocalTransfer, NineTermsLoseNothingAndFewerLoseWhatTheirEnergySays) {
  const NormalBasis basis = make_normal_basis(NormalWeight::uniform);
  const LocalTransfer tangent = square_transfer(3, 64);
  const sh::ShRgb light = uneven_light(3);
  const std::vector<Rgb> all = lit_rows(tangent, light);
  std::array<double, 10> error{};
  for (int terms = 1; terms <= 9; ++terms) {
    const std::vector<Rgb> rows = lit_rows(compressed(tangent, basis, terms), light);
    for (const Vec3d& normal : kNormals) {
      std::array<double, 9> u{};
      evaluate_normal_functions(basis, normal, std::span(u).first(static_cast<std::size_t>(terms)));
      double sum = 0.0;
      for (std::size_t k = 0; k < static_cast<std::size_t>(terms); ++k)
        sum += u[k] * static_cast<double>(rows[k].x);
      double full = 0.0;
      for (std::size_t j = 0; j < 9; ++j) full += reflected(normal)[j] * static_cast<double>(all[j].x);
      double& largest = error[static_cast<std::size_t>(terms)];
      largest = std::max(largest, std::abs(sum - full));
    }
  }
  EXPECT_LE(error[9], 1e-5);
  EXPECT_GE(error[4], 1e-3);
  EXPECT_GE(error[1], error[6]);
}

// Bilinear interpolation is second-order: twice the side, a quarter of the error.
TEST(NormalTexture, ConvergesToTheFunctionsWithItsSide) {
  const NormalBasis basis = make_normal_basis(NormalWeight::cosine);
  const auto largest_error = [&](int side) {
    const NormalTexture texture = make_normal_texture(basis, 6, side);
    double largest = 0.0;
    for (int i = 0; i < 4000; ++i) {
      const double radius = 0.8 * std::sqrt((i + 0.5) / 4000.0);
      const Vec3d normal(radius * std::cos(2.4 * i), radius * std::sin(2.4 * i),
                         std::sqrt(1.0 - radius * radius));
      std::array<double, 6> exact{};
      std::array<double, 6> found{};
      evaluate_normal_functions(basis, normal, exact);
      look_up(texture, normal, found);
      for (std::size_t k = 0; k < 6; ++k) largest = std::max(largest, std::abs(found[k] - exact[k]));
    }
    return largest;
  };
  const double coarse = largest_error(32);
  EXPECT_NEAR(std::log2(coarse / largest_error(64)), 2.0, 0.3);
  EXPECT_LE(largest_error(128), 1e-2);
}

TEST(NormalTexture, RefusesSizesAndTermsOutOfRange) {
  const NormalBasis basis = make_normal_basis(NormalWeight::cosine);
  EXPECT_THROW((void)make_normal_texture(basis, 4, 1), InputError);
  EXPECT_THROW((void)make_normal_texture(basis, 0, 64), InputError);
  std::array<double, 3> values{};
  EXPECT_THROW(look_up(make_normal_texture(basis, 4, 8), {0.0, 0.0, 1.0}, values), InputError);
}

TEST(HalfLife2, WeightsAreOneDirectionEachAndSumToOne) {
  const double third = std::sqrt(1.0 / 3.0);
  const Vec3d weights = half_life_2_weights({-std::sqrt(1.0 / 6.0), std::sqrt(0.5), third});
  EXPECT_NEAR(weights.y, 1.0, 1e-12);
  for (const Vec3d& normal : kNormals) {
    const Vec3d w = half_life_2_weights(normal);
    EXPECT_NEAR(w.x + w.y + w.z, 1.0, 1e-12);
    EXPECT_GE(std::min({w.x, w.y, w.z}), 0.0);
  }
}

// At the three directions the basis is exact: what it stores there is what the nine terms give.
TEST(HalfLife2, IsExactAlongItsDirections) {
  const LocalTransfer tangent = square_transfer(3, 64);
  const sh::ShRgb light = uneven_light(3);
  Fragment f;
  f.weights = {1.0F, 0.0F, 0.0F};
  f.in_frame = {std::sqrt(2.0 / 3.0), 0.0, std::sqrt(1.0 / 3.0)};
  const Rgb full = shade_in_frame(lit_rows(tangent, light))(f);
  EXPECT_LE(glm::length(shade_half_life_2(lit_rows(half_life_2(tangent), light))(f) - full), 1e-5F);
  f.in_frame = {0.0, 0.0, 1.0};
  const Rgb between = shade_half_life_2(lit_rows(half_life_2(tangent), light))(f);
  EXPECT_GE(glm::length(between - shade_in_frame(lit_rows(tangent, light))(f)), 1e-3F);
}

// The shipped weights are one choice of numbers for (nearly) the same three functions, the fit is the best.
TEST(HalfLife2, TheFitIsCloserThanTheShippedWeights) {
  const LocalTransfer tangent = square_transfer(3, 256);
  const sh::ShRgb light = uneven_light(3);
  const Shader full = shade_in_frame(lit_rows(tangent, light));
  const Shader shipped = shade_half_life_2(lit_rows(half_life_2(tangent), light));
  const Shader fitted = shade_half_life_2_fitted(lit_rows(half_life_2_fitted(tangent), light));
  double error_shipped = 0.0;
  double error_fitted = 0.0;
  for (int i = 0; i < 2000; ++i) {  // cosine-weighted, as the fit
    const double radius = std::sqrt((i + 0.5) / 2000.0);
    Fragment f;
    f.weights = {1.0F, 0.0F, 0.0F};
    f.in_frame = {radius * std::cos(2.4 * i), radius * std::sin(2.4 * i), std::sqrt(1.0 - radius * radius)};
    const Vec3d off_shipped(shipped(f) - full(f));
    const Vec3d off_fitted(fitted(f) - full(f));
    error_shipped += glm::dot(off_shipped, off_shipped);
    error_fitted += glm::dot(off_fitted, off_fitted);
  }
  EXPECT_LE(error_fitted, error_shipped);
  EXPECT_GE(error_fitted, 1e-6 * error_shipped);  // three functions are not nine
}

// Nothing shadows: the ratio is 1 up to what the hemisphere below the plane adds to the unshadowed light.
TEST(RatioMethod, WithTheUnshadowedValueIsUnshadowed) {
  const scene::Scene scene = lone_square();
  const sh::ShRgb light = uneven_light(3);
  std::vector<Rgb> open;
  const Quadratic weights = reflected({0.0, 0.0, 1.0});
  RgbD sum(0.0);
  for (std::size_t j = 0; j < 9; ++j) sum += weights[j] * light.coefficients[j];
  open.assign(4, Rgb(sum));
  Fragment f;
  f.corners = {0U, 1U, 2U};
  f.weights = {0.2F, 0.3F, 0.5F};
  f.normal = {0.0, 0.0, 1.0};
  EXPECT_LE(glm::length(shade_by_ratio(scene, open, light)(f) - Rgb(sum)), 1e-5F);
  for (Rgb& value : open) value *= 0.5F;
  EXPECT_LE(glm::length(shade_by_ratio(scene, open, light)(f) - 0.5F * Rgb(sum)), 1e-5F);
  EXPECT_THROW((void)shade_by_ratio(scene, open, uneven_light(2)), InputError);
}

TEST(LocalTransfer, SameBitsForAnyNumberOfThreadsAndOtherSeedsDiffer) {
  LocalBakeSettings settings;
  settings.bands = 2;
  settings.samples = 32;
  settings.threads = 1;
  const scene::Scene scene = scene::make_builtin_scene("normal-mapped");
  const std::vector<float> one = bake_incident_radiance(scene, settings).matrices;
  settings.threads = 3;
  EXPECT_EQ(bake_incident_radiance(scene, settings).matrices, one);
  settings.seed = 1;
  EXPECT_NE(bake_incident_radiance(scene, settings).matrices, one);
}

TEST(LocalTransfer, RefusesWhatItCannotDo) {
  LocalBakeSettings settings;
  settings.samples = 15;
  EXPECT_THROW((void)bake_incident_radiance(lone_square(), settings), InputError);
  settings.samples = 16;
  settings.bands = 0;
  EXPECT_THROW((void)bake_incident_radiance(lone_square(), settings), InputError);
  const LocalTransfer transfer = square_transfer(3, 16);
  EXPECT_THROW((void)lit_rows(transfer, uneven_light(2)), InputError);
  scene::Scene without = lone_square();
  without.tangents.clear();
  EXPECT_THROW((void)in_tangent_frames(transfer, without), InputError);
  const NormalBasis basis = make_normal_basis(NormalWeight::uniform);
  EXPECT_THROW((void)compressed(half_life_2(transfer), basis, 4), InputError);
  EXPECT_THROW((void)compressed(transfer, basis, 10), InputError);
}

}  // namespace
}  // namespace plumbline::normal_map
