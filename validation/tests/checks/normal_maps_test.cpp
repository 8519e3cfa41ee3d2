// The family of normal-mapped PRT: right methods pass, planted faults do not.
#include "validation/checks/normal_maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "prt/normal_map/normal_basis.hpp"
#include "reference/scene/builtin.hpp"

namespace plumbline::checks {
namespace {

Budget small_budget() {
  Budget budget;
  budget.width = 96;
  budget.height = 72;
  budget.image_samples = 16;
  budget.bake_samples = 128;
  return budget;
}

std::vector<Finding> judged(const std::function<void(scene::Scene&)>& fault) {
  const NamedScene scene{"normal-mapped", scene::make_builtin_scene("normal-mapped"), ""};
  scene::Scene seen = scene.scene;
  fault(seen);
  return judge_normal_maps(scene, seen, light::make_builtin_environment("two-lobes"), 3, small_budget());
}

std::size_t failures(const std::vector<Finding>& findings) {
  std::size_t count = 0;
  for (const Finding& finding : findings) count += finding.verdict == Verdict::fail ? 1U : 0U;
  return count;
}

TEST(NormalMapsFamily, PassesWhatIsRight) {
  const std::vector<Finding> findings = judged([](scene::Scene&) {});
  EXPECT_EQ(findings.size(), 7U);
  EXPECT_EQ(failures(findings), 0U);
  EXPECT_EQ(findings[0].verdict, Verdict::pass) << findings[0].measured << " " << findings[0].bound;
}

TEST(NormalMapsFamily, CatchesAMapThatLeansTheOtherWay) {
  const std::vector<Finding> findings = judged([](scene::Scene& s) {
    for (scene::Material& material : s.materials) material.normal_scale = -1.0F;
  });
  EXPECT_EQ(findings[0].verdict, Verdict::fail) << findings[0].measured << " " << findings[0].bound;
}

TEST(NormalMapsFamily, CatchesAnIgnoredMap) {
  const std::vector<Finding> findings = judged([](scene::Scene& s) {
    for (scene::Material& material : s.materials) material.normal_scale = 0.0F;
  });
  EXPECT_EQ(findings[0].verdict, Verdict::fail) << findings[0].measured << " " << findings[0].bound;
}

TEST(NormalMapsFamily, CatchesGreenUpsideDown) {
  const std::vector<Finding> findings = judged([](scene::Scene& s) {
    for (glm::vec4& tangent : s.tangents) tangent.w = -tangent.w;
  });
  EXPECT_EQ(findings[0].verdict, Verdict::fail) << findings[0].measured << " " << findings[0].bound;
}

TEST(NormalMapsFamily, OrderNeedsAClearDifference) {
  const Label label{"f", "n", "s", "d"};
  EXPECT_EQ(judge_order(label, {-1.0, 0.1}, 1e-4).verdict, Verdict::pass);
  EXPECT_EQ(judge_order(label, {-0.1, 0.1}, 1e-4).verdict, Verdict::inconclusive);
  EXPECT_EQ(judge_order(label, {0.1, 0.1}, 1e-4).verdict, Verdict::inconclusive);
  EXPECT_EQ(judge_order(label, {1.0, 0.1}, 1e-4).verdict, Verdict::fail);
  EXPECT_EQ(judge_order(label, {std::numeric_limits<double>::quiet_NaN(), 0.1}, 1e-4).verdict, Verdict::fail);
}

// Of a white sky of 1 over one hemisphere: 3/(32 pi) 2 pi. The kernel's own error is found by looking at it.
TEST(NormalMapsFamily, TheBoundIsTheKernelsLargestError) {
  scene::Scene scene;
  scene.normals = {{0.0F, 0.0F, 1.0F}, glm::normalize(Vec3(1.0F, 2.0F, -0.5F))};
  sh::ShRgb white{1, {RgbD(std::sqrt(4.0 * kPi))}};
  for (const Rgb& bound : nine_terms_bounds(scene, white))
    EXPECT_NEAR(bound.x, 2.0 * 3.0 / 32.0, 0.02 * 0.1875);
  double largest = 0.0;
  for (int i = -1000; i <= 1000; ++i) {
    const double c = i / 1000.0;
    const normal_map::Quadratic lobe = normal_map::reflected({std::sqrt(1.0 - c * c), 0.0, c});
    const normal_map::Quadratic up = normal_map::reflected({0.0, 0.0, 1.0});
    // sum_lm (A_l/pi) y_lm(n) y_lm(+z): the kernel of degree 2 over pi; y_lm(+z) = reflected / (A_l/pi).
    const double factors[9] = {1.0, 2.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0, 0.25, 0.25, 0.25, 0.25, 0.25};
    double kernel = 0.0;
    for (std::size_t j = 0; j < 9; ++j) kernel += lobe[j] * up[j] / factors[j];
    largest = std::max(largest, std::abs(std::max(0.0, c) / kPi - kernel));
  }
  EXPECT_NEAR(largest, 3.0 / (32.0 * kPi), 1e-12);
}

}  // namespace
}  // namespace plumbline::checks
