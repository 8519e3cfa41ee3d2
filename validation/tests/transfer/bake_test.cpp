#include "prt/transfer/bake.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "../integrate/pieces.hpp"
#include "prt/sh/basis.hpp"
#include "prt/sh/lighting.hpp"
#include "prt/transfer/directions.hpp"
#include "reference/base/error.hpp"
#include "reference/scene/builtin.hpp"
#include "validation/metrics/statistics.hpp"

namespace plumbline::transfer {
namespace {

BakeSettings settings_of(Kind kind, int bands = 5, int samples = 4096) {
  BakeSettings settings;
  settings.kind = kind;
  settings.bands = bands;
  settings.samples = samples;
  return settings;
}

/// Largest |T - truth| in standard errors beyond the rounding of a float basis, 7e-7 (sh/batch.hpp) along rounded directions.
double worst_z(const PointTransfer& point, const std::vector<double>& truth) {
  double worst = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double difference = std::max(0.0, std::abs(point.coefficients[i] - truth[i]) - 1e-6);
    worst = std::max(worst, difference / std::max(point.standard_errors[i], 1e-7));
  }
  return worst;
}

TEST(UnshadowedTransfer, IsTheConvolvedCosine) {
  // n = +z: T_l0 = A_l y_l0(z) / pi with A = pi, 2 pi / 3, pi / 4, 0, -pi / 24
  const std::vector<double> t = unshadowed_transfer(5, {0, 0, 1});
  const double expected[] = {1.0, 2.0 / 3.0, 0.25, 0.0, -1.0 / 24.0};
  for (int l = 0; l < 5; ++l) {
    for (int m = -l; m <= l; ++m) {
      const double truth = m == 0 ? expected[l] * std::sqrt((2 * l + 1) / (4.0 * kPi)) : 0.0;
      EXPECT_LE(std::abs(t[static_cast<std::size_t>(sh::index(l, m))] - truth), 1e-14) << l << ' ' << m;
    }
  }
}

TEST(ShadowedTransfer, EqualsUnshadowedWhenNothingBlocks) {
  const scene::Scene scene = test::nothing_in_the_way();
  const trace::RayCaster caster(scene);
  for (const Vec3 normal :
       {Vec3(0, 1, 0), glm::normalize(Vec3(2, 3, 6)), glm::normalize(Vec3(-1, 0.2F, 0.1F))}) {
    const PointTransfer traced =
        shadowed_transfer(caster, trace::free_point(Vec3(0.0F), normal), 5, 1 << 14, 3, 0);
    const std::vector<double> truth = unshadowed_transfer(5, normal);
    EXPECT_LE(worst_z(traced, truth), 6.0);  // 25 values of Student's t with 15 degrees of freedom
    for (std::size_t i = 0; i < truth.size(); ++i) EXPECT_LE(traced.standard_errors[i], 1e-3);
    // The same check rejects a transfer that has lost its 1/pi, and one with the other sign convention.
    std::vector<double> wrong = truth;
    for (double& value : wrong) value *= kPi;
    EXPECT_GT(worst_z(traced, wrong), 100.0);
    wrong = truth;
    for (const int i : {1, 3}) wrong[static_cast<std::size_t>(i)] *= -1.0;
    EXPECT_GT(worst_z(traced, wrong), 100.0);
  }
}

// M12, direct part: next to the edge of an infinite corner, for a floor with n = z and a wall with n = y,
// without the Condon-Shortley sign: .443113463, .325735008, .511663354, 0, 0, .429042765, .247707956, 0, 0
// (irradiance; transfer has 1/pi).
TEST(ShadowedTransfer, MatchesTheInfiniteCorner) {
  constexpr float kHuge = 1000.0F;
  scene::Scene scene;
  const std::uint32_t material = test::add_material(scene, Rgb(0.8F));
  test::add_quad(scene, {-kHuge, 0, 0}, {2 * kHuge, 0, 0}, {0, kHuge, 0}, material);  // floor z = 0, up +z
  test::add_quad(scene, {-kHuge, 0, 0}, {0, 0, kHuge}, {2 * kHuge, 0, 0}, material);  // wall y = 0, facing +y
  const trace::RayCaster caster(scene);
  const double irradiance[] = {0.443113463, 0.325735008, 0.511663354, 0.0, 0.0,
                               0.429042765, 0.247707956, 0.0,         0.0};
  const double sign[] = {1, -1, 1, -1, 1, -1, 1, -1, 1};  // Condon-Shortley
  const PointTransfer traced =
      shadowed_transfer(caster, trace::free_point({0, 1e-3F, 0}, {0, 0, 1}), 3, 1 << 16, 1, 0);
  for (std::size_t i = 0; i < 9; ++i) {
    const double truth = sign[i] * irradiance[i] / kPi;
    EXPECT_LE(std::abs(traced.coefficients[i] - truth), 4.5 * traced.standard_errors[i] + 2e-6)
        << i;  // quads end at an angle of 1e-6
  }
  EXPECT_LE(traced.standard_errors[0], 1e-3 * 0.141);
}

TEST(Bake, WhiteLightOnAConvexMeshGivesOne) {
  scene::Scene scene = scene::make_builtin_scene("convex");
  const Transfer baked = bake(scene, settings_of(Kind::shadowed));
  sh::ShRgb white{5, std::vector<RgbD>(25, RgbD(0.0))};
  white.coefficients[0] = RgbD(std::sqrt(4.0 * kPi));
  for (std::size_t v = 0; v < baked.vertices; ++v) {
    EXPECT_LE(std::abs(static_cast<double>(baked.vector(v, 0)[0]) * std::sqrt(4.0 * kPi) - 1.0), 1e-6)
        << v;  // every ray escapes
  }
}

TEST(Bake, StandardErrorsAreHonest) {
  const scene::Scene scene = scene::make_builtin_scene("corner");
  const trace::RayCaster caster(scene);
  const trace::SurfacePoint point = trace::vertex_points(scene)[0];
  const PointTransfer exact = shadowed_transfer(caster, point, 3, 1 << 18, 999, 0);
  std::vector<double> p;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    const PointTransfer rough = shadowed_transfer(caster, point, 3, 256, seed, 5);
    for (const std::size_t i : {0U, 2U}) {
      if (rough.standard_errors[i] > 0.0) {
        p.push_back(metrics::two_sided_p_student(
            (rough.coefficients[i] - exact.coefficients[i]) / rough.standard_errors[i], 15));
      }
    }
  }
  EXPECT_GE(p.size(), 300U);
  EXPECT_GE(metrics::kolmogorov_smirnov_uniform(p).p, 1e-4);
}

TEST(Bake, DependsOnSeedAndNotOnThreads) {
  const scene::Scene scene = scene::make_builtin_scene("corner");
  BakeSettings settings = settings_of(Kind::shadowed, 4, 256);
  settings.threads = 1;
  const Transfer one = bake(scene, settings);
  settings.threads = 2;
  EXPECT_EQ(one.coefficients, bake(scene, settings).coefficients);
  settings.seed = 1;
  EXPECT_NE(one.coefficients, bake(scene, settings).coefficients);
}

TEST(Bake, RefusesWhatItCannotDo) {
  const scene::Scene scene = scene::make_builtin_scene("corner");
  EXPECT_THROW((void)bake(scene, settings_of(Kind::shadowed, 0)), InputError);
  EXPECT_THROW((void)bake(scene, settings_of(Kind::shadowed, 5, 0)), InputError);
  const scene::Scene exact = scene::make_builtin_scene("exact-sphere-on-plane");
  EXPECT_THROW((void)bake(exact, settings_of(Kind::unshadowed)), InputError);
}

// The bake's own directions: E[cos] = 2/3 for the cosine density (variance 1/18), uniform shifts.
TEST(Directions, HaveTheCosineDensity) {
  const Vec3d normal = glm::normalize(Vec3d(1, 2, -2));
  double sum = 0.0;
  constexpr int kCount = 4096;
  for (std::uint64_t i = 0; i < kCount; ++i) {
    const Vec3d w = cosine_direction(normal, lattice_point(i, kCount, random_shift(1, 2, 3)));
    EXPECT_LE(std::abs(glm::length(w) - 1.0), 1e-14);
    sum += glm::dot(w, normal);
  }
  EXPECT_LE(std::abs(sum / kCount - 2.0 / 3.0), 4.0 * std::sqrt(1.0 / 18.0 / kCount));
  std::vector<double> shifts;
  for (std::uint64_t stream = 0; stream < 2000; ++stream) shifts.push_back(random_shift(0, stream, 0).x);
  EXPECT_GE(metrics::kolmogorov_smirnov_uniform(shifts).p, 1e-3);
}

}  // namespace
}  // namespace plumbline::transfer
