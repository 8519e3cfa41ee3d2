#include "validation/checks/gl_agreement.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "gl_context.hpp"
#include "gl_scenes.hpp"

namespace plumbline::checks {
namespace {

using relight::gl::Context;
using relight::gl::Provider;
using relight::gl::Renderer;

std::string text_of(const UlpHistogram& histogram) {
  std::string text;
  for (std::size_t k = 0; k < UlpHistogram::kBins; ++k) {
    if (histogram.counts[k] > 0)
      text += fmt::format(" {}:{}", k == 0 ? 0 : 1 << (k - 1), histogram.counts[k]);
  }
  return text;
}

void print(const std::string& name, const GlAgreement& a) {
  fmt::print(
      "{}\n  inside {} sky {} edges {} (farthest {:.5f} of {:.5f}) depths {} unexplained {}\n"
      "  vertices: relative {:.2e}, of terms {:.2e}, ulps{}\n  samples: relative {:.2e}, of terms {:.2e}, "
      "ulps{}\n",
      name, a.inside, a.sky, a.at_edges, a.farthest_edge, a.edge_width, a.at_depths, a.unexplained,
      a.vertices_relative, a.vertices_of_terms, text_of(a.vertices), a.samples_relative, a.samples_of_terms,
      text_of(a.samples));
}

const std::vector<test::RelitScene>& scenes() {
  static const std::vector<test::RelitScene> all = {test::plaza_in_the_sun(), test::bunny_in_the_city(),
                                                    test::textures()};
  return all;
}

GlAgreement agreement(const Context& context, const test::RelitScene& s,
                      const relight::gl::RendererSettings& settings, const std::vector<Rgb>& cpu,
                      const scene::Camera& camera) {
  Renderer renderer(context, s.baked.scene, s.baked.transfer, settings);
  return gl_agreement(context, renderer, s.baked, s.lighting, cpu, camera, 400, 300);
}

class GlAgreementOn : public test::OnEachProvider {};
INSTANTIATE_TEST_SUITE_P(Providers, GlAgreementOn, testing::Values(Provider::osmesa, Provider::egl),
                         test::name_of);

// Each relative to itself, against sums that were rounded once. (Without doubles on either side, relative differences have no
// bound: where light of both signs cancels, what is left is as small as one likes.)
TEST_P(GlAgreementOn, ThreeScenesEqualTheCpuInsideTriangles) {
  const auto context = test::context_of(GetParam());
  if (!context) return;
  for (const test::RelitScene& s : scenes()) {
    const GlAgreement a = agreement(*context, s, {}, test::rounded_sums(s), s.baked.scene.cameras.front());
    print(s.name, a);
    EXPECT_LE(a.samples_relative, 1e-5) << s.name;
    EXPECT_LE(a.vertices_relative, 1e-5) << s.name;
    EXPECT_EQ(a.unexplained, 0U) << s.name;
    EXPECT_LE(a.at_depths, a.inside / 10000) << s.name;
    EXPECT_GE(a.inside, 10000U) << s.name;  // the scene is in the image
  }
}

// … and against what the CPU makes of light and transfer, in whatever arithmetic: n^2 + 2 roundings of the terms at most.
TEST_P(GlAgreementOn, ThreeScenesEqualTheCpusSumsToTheRoundingOfTheirTerms) {
  const auto context = test::context_of(GetParam());
  if (!context) return;
  for (const test::RelitScene& s : scenes()) {
    const std::vector<Rgb> cpu = relight::unit_albedo_exit_radiance(s.baked.transfer, s.lighting);
    const GlAgreement a = agreement(*context, s, {}, cpu, s.baked.scene.cameras.front());
    print(s.name, a);
    const double bound = (s.lighting.bands * s.lighting.bands + 2.0) * std::ldexp(1.0, -24);
    EXPECT_LE(a.vertices_of_terms, bound) << s.name;
    EXPECT_LE(a.samples_of_terms, bound) << s.name;
    EXPECT_LE(bound, 1e-5);
  }
}

// Given the vertices' values, the image itself is the CPU's to a few roundings of its own: weights, sum, texture, product.
TEST_P(GlAgreementOn, TheImageAloneEqualsTheCpus) {
  const auto context = test::context_of(GetParam());
  if (!context) return;
  for (const test::RelitScene& s : scenes()) {
    Renderer renderer(*context, s.baked.scene, s.baked.transfer, {});
    renderer.set_light(s.lighting);
    const std::vector<Rgb> same = renderer.unit_albedo_exit_radiance();
    const GlAgreement a =
        gl_agreement(*context, renderer, s.baked, s.lighting, same, s.baked.scene.cameras.front(), 200, 150);
    EXPECT_EQ(a.vertices_relative, 0.0);
    EXPECT_LE(a.samples_of_terms, 16.0 * std::numeric_limits<float>::epsilon()) << s.name;
  }
}

// What drivers without doubles do: every term and sum is rounded, (n^2 + 2) 2^-24 of the terms in all, whatever their order.
TEST_P(GlAgreementOn, FloatSumsStayWithinTheirBound) {
  const auto context = test::context_of(GetParam());
  if (!context) return;
  const test::RelitScene s = test::textures();
  relight::gl::RendererSettings settings;
  settings.allows_double = false;
  EXPECT_EQ(Renderer(*context, s.baked.scene, s.baked.transfer, settings).sums(), "float");
  const GlAgreement a =
      agreement(*context, s, settings, test::rounded_sums(s), s.baked.scene.cameras.front());
  EXPECT_LE(a.vertices_of_terms, 12.0 * std::ldexp(1.0, -24));
  EXPECT_GT(a.vertices_of_terms, 0.0);  // it is another arithmetic
}

TEST_P(GlAgreementOn, WhatIsWrongIsSeen) {
  const auto context = test::context_of(GetParam());
  if (!context) return;
  const test::RelitScene s = test::textures();
  const scene::Camera camera = s.baked.scene.cameras.front();
  const std::vector<Rgb> cpu = test::rounded_sums(s);
  // … a light that is 2e-5 brighter
  std::vector<Rgb> brighter = cpu;
  for (Rgb& value : brighter) value *= 1.0F + 2e-5F;
  EXPECT_GT(agreement(*context, s, {}, brighter, camera).samples_relative, 1e-5);
  // … channels mixed up
  std::vector<Rgb> mixed = cpu;
  for (Rgb& value : mixed) std::swap(value.x, value.y);
  EXPECT_GT(agreement(*context, s, {}, mixed, camera).samples_of_terms, 1e-2);
  // … half precision
  EXPECT_GT(agreement(*context, s, {relight::gl::Storage::f16}, cpu, camera).vertices_of_terms, 1e-5);
  // … NaN
  std::vector<Rgb> not_a_number = cpu;
  for (Rgb& value : not_a_number) value.z = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(agreement(*context, s, {}, not_a_number, camera).samples_relative <= 1e-5);
  // … a scene that stands elsewhere
  test::RelitScene moved = s;
  for (Vec3& p : moved.baked.scene.positions) p.x += 0.05F;
  Renderer renderer(*context, moved.baked.scene, moved.baked.transfer, {});
  EXPECT_GT(gl_agreement(*context, renderer, s.baked, s.lighting, cpu, camera, 400, 300).unexplained, 100U);
}

// Tiles that are narrower than the image, and do not divide it, give the same samples.
TEST_P(GlAgreementOn, TilesDoNotShow) {
  const auto context = test::context_of(GetParam());
  if (!context) return;
  const test::RelitScene s = test::textures();
  const relight::ViewSettings view{100, 75, 3, 0};
  const auto image_of = [&](int tile) {
    Renderer renderer(*context, s.baked.scene, s.baked.transfer,
                      {relight::gl::Storage::f32, relight::gl::Target::f32, true, tile});
    renderer.set_light(s.lighting);
    return relight::gl::render_view(renderer, s.baked.scene.cameras.front(), view,
                                    [](const Vec3& d) { return Rgb(d); });
  };
  const image::LayeredImage whole = image_of(1024);
  const image::LayeredImage tiled = image_of(64);
  // Corners are rounded to the subpixel grid of each tile alike, but where a triangle is clipped it is cut elsewhere.
  std::size_t apart = 0;
  for (const auto& [name, values] : whole.channels) {
    for (std::size_t i = 0; i < values.size(); ++i)
      apart += values[i] == tiled.channels.at(name)[i] ? 0U : 1U;
  }
  EXPECT_LE(apart, 75U * 100U / 200U);
  EXPECT_EQ(whole.channels.size(), 10U);
}

TEST(UlpHistogram, CountsFloatsBetween) {
  EXPECT_EQ(ulps_apart(1.0F, 1.0F), 0U);
  EXPECT_EQ(ulps_apart(0.0F, -0.0F), 0U);
  EXPECT_EQ(ulps_apart(1.0F, std::nextafter(1.0F, 2.0F)), 1U);
  EXPECT_EQ(ulps_apart(-1.0F, std::nextafter(-1.0F, 0.0F)), 1U);
  const float least = std::numeric_limits<float>::denorm_min();
  EXPECT_EQ(ulps_apart(least, -least), 2U);
  UlpHistogram histogram;
  add(histogram, 1.0F, 1.0F);
  add(histogram, 1.0F, 1.0F + 3.0F * std::numeric_limits<float>::epsilon());
  add(histogram, 1.0F, std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(histogram.counts[0], 1U);
  EXPECT_EQ(histogram.counts[2], 1U);
  EXPECT_EQ(histogram.counts[UlpHistogram::kBins - 1], 1U);
}

}  // namespace
}  // namespace plumbline::checks
