// The brute-force tracer on its own against closed forms, then as a second opinion on the path tracer.
#include "validation/truth/brute_tracer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "reference/base/error.hpp"
#include "reference/integrate/gather.hpp"
#include "reference/scene/shapes.hpp"
#include "validation/tests/integrate/pieces.hpp"
#include "validation/truth/irradiance.hpp"

namespace plumbline::truth {
namespace {

using metrics::Estimate;
using Channels = std::array<Estimate, 3>;

constexpr double kFamily = 1e-4;  // chance that any comparison of this file raises a false alarm
constexpr double kMargin = 0.01;  // of the truth: what two opinions may differ by and still be called equal
// Chance of calling equal what differs by more than kMargin. Every comparison must pass, so no family of them
// raises this.
constexpr double kFalseEquality = 1e-4;
constexpr std::uint64_t kSeed = 19370501;

// ---------------------------------------------------------------- the cases

struct Case {
  scene::Scene scene;
  light::Environment environment;
  Vec3 position{0.0F};
  Vec3 normal{0.0F, 1.0F, 0.0F};
  int max_bounces = 0;
  struct Fault {
    std::string name;
    std::function<void(Case&)> plant;
  };
  std::vector<Fault> faults;  // each must be noticed when the path tracer is given it
};

light::Environment coloured_sky(std::function<Rgb(const Vec3&)> radiance) {
  light::Environment environment;
  environment.name = "coloured";
  environment.sky = light::AnalyticSky{std::move(radiance)};
  return environment;
}

light::Environment bright_gradient() {
  return coloured_sky(
      [](const Vec3& w) { return Rgb(1.2F) + Rgb(0.3F, 0.5F, 0.8F) * w.y + Rgb(0.3F, 0.1F, 0.0F) * w.x; });
}

void dim(Case& wrong, std::size_t material) {
  wrong.scene.materials[material].albedo *= 0.95F;
}

void flip_sidedness(Case& wrong, std::size_t material) {
  wrong.scene.materials[material].is_double_sided = !wrong.scene.materials[material].is_double_sided;
}

/// A room without a ceiling, every side of another colour.
Case open_box() {
  Case c;
  const Vec3 x(1, 0, 0);
  const Vec3 y(0, 1, 0);
  const Vec3 z(0, 0, 1);
  const Vec3 o(0.0F);
  test::add_quad(c.scene, o, z, x, test::add_material(c.scene, {0.7F, 0.7F, 0.7F}));
  test::add_quad(c.scene, o, x, y, test::add_material(c.scene, {0.2F, 0.8F, 0.3F}));
  test::add_quad(c.scene, z, y, x, test::add_material(c.scene, {0.9F, 0.5F, 0.1F}));
  test::add_quad(c.scene, o, y, z, test::add_material(c.scene, {0.4F, 0.4F, 0.9F}));
  test::add_quad(c.scene, x, z, y, test::add_material(c.scene, {0.8F, 0.75F, 0.85F}));
  c.environment = light::make_builtin_environment("overcast");
  c.position = {0.4F, 0.5F, 0.55F};
  c.normal = {0.8F, 0.6F, 0.0F};
  c.max_bounces = 3;
  c.faults = {{"a wall 5 % darker", [](Case& wrong) { dim(wrong, 4); }},
              {"one bounce less", [](Case& wrong) { --wrong.max_bounces; }},
              {"sky upside down", [](Case& wrong) {
                 wrong.environment = light::rotated(wrong.environment, {180.0F, 0.0F, 0.0F});
               }}};
  return c;
}

/// Light from two quads only, met by chance.
Case two_emitters() {
  Case c;
  test::add_quad(c.scene, {-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, test::add_material(c.scene, {0.6F, 0.5F, 0.4F}));
  test::add_quad(c.scene, {-2, 0, -2}, {4, 0, 0}, {0, 3, 0}, test::add_material(c.scene, {0.7F, 0.6F, 0.8F}));
  test::add_quad(c.scene, {-1.5F, 2, -1.5F}, {3, 0, 0}, {0, 0, 3},
                 test::add_material(c.scene, Rgb(0.3F), {4, 3, 2}));
  test::add_quad(c.scene, {1.5F, 0, -1}, {0, 0, 2}, {0, 1.5F, 0},
                 test::add_material(c.scene, Rgb(0.0F), {1, 2, 5}));
  c.environment = test::no_sky();
  c.position = {0.2F, 0.0F, 0.1F};
  c.max_bounces = 2;
  c.faults = {{"an emitter 5 % brighter", [](Case& wrong) { wrong.scene.materials[2].emission *= 1.05F; }},
              {"an emitter turned round", [](Case& wrong) {
                 for (const std::size_t t : {6U, 7U})
                   std::swap(wrong.scene.triangles[t].y, wrong.scene.triangles[t].z);
               }}};
  return c;
}

/// One sheet shines and reflects on both sides, the other shows its dark back.
Case sheets() {
  Case c;
  test::add_quad(c.scene, {-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, test::add_material(c.scene, Rgb(0.5F)));
  test::add_quad(c.scene, {-1.5F, 0.2F, -1}, {0, 0, 2}, {1, 1.2F, 0},
                 test::add_material(c.scene, {0.9F, 0.6F, 0.3F}, Rgb(0.3F), true));
  test::add_quad(c.scene, {0.4F, 1.2F, -1}, {0, 0, 2}, {1, -0.8F, 0},
                 test::add_material(c.scene, {0.9F, 0.8F, 0.7F}, Rgb(0.3F), false));
  c.environment = bright_gradient();
  c.max_bounces = 4;
  c.faults = {{"a dark back lit", [](Case& wrong) { flip_sidedness(wrong, 2); }},
              {"a lit back dark", [](Case& wrong) { flip_sidedness(wrong, 1); }}};
  return c;
}

/// Radiance below zero on one side, as band-limited light has.
Case signed_sky() {
  Case c;
  test::add_quad(c.scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, test::add_material(c.scene, {0.8F, 0.6F, 0.4F}));
  test::add_quad(c.scene, {-1, 0, -1}, {0, 1, 0}, {0, 0, 2}, test::add_material(c.scene, {0.5F, 0.7F, 0.9F}));
  const auto radiance = [](const Vec3& w) { return Rgb(1.0F, 1.5F, 2.0F) + Rgb(2.0F) * w.x; };
  c.environment = coloured_sky(radiance);
  c.position = {0.1F, 0.2F, 0.0F};
  c.normal = glm::normalize(Vec3(-0.4F, 0.5F, 0.2F));
  c.max_bounces = 3;
  c.faults = {{"a sky cut off at zero", [radiance](Case& wrong) {
                 wrong.environment =
                     coloured_sky([radiance](const Vec3& w) { return glm::max(radiance(w), Rgb(0.0F)); });
               }}};
  return c;
}

/// An icosahedron that passes for a sphere: its shading normals are up to 37 degrees off its faces.
Case coarse_sphere() {
  Case c;
  test::add_quad(c.scene, {-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, test::add_material(c.scene, Rgb(0.5F)));
  const std::uint32_t round = test::add_material(c.scene, {0.9F, 0.7F, 0.5F});
  const scene::Mesh ball = scene::placed(scene::make_icosphere(0), {0.0, 1.2, 0.0});
  scene::append(c.scene, ball, round);
  c.environment = bright_gradient();
  c.position = {0.8F, 0.1F, 0.3F};
  c.normal = glm::normalize(Vec3(-0.5F, 1.0F, 0.0F));
  c.max_bounces = 3;
  c.faults = {{"flat normals", [](Case& wrong) {
                 const std::size_t first = wrong.scene.positions.size() - 12;
                 Case flat = wrong;
                 flat.scene.positions.resize(first);
                 flat.scene.normals.resize(first);
                 flat.scene.triangles.resize(2);
                 flat.scene.triangle_materials.resize(2);
                 scene::append(flat.scene,
                               scene::faceted(scene::placed(scene::make_icosphere(0), {0.0, 1.2, 0.0})), 1);
                 wrong.scene = flat.scene;
               }}};
  return c;
}

/// Vertex colours and a texture.
Case painted() {
  Case c;
  test::add_quad(c.scene, {-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, test::add_material(c.scene, Rgb(0.9F)));
  test::add_quad(c.scene, {-1, 0, -1}, {2, 0, 0}, {0, 2, 0}, test::add_material(c.scene, Rgb(0.9F)));
  image::Image checks{2, 1, {Rgb(0.9F, 0.2F, 0.1F), Rgb(0.1F, 0.5F, 0.9F)}};
  c.scene.textures.push_back({checks, scene::Wrap::kClamp, scene::Wrap::kClamp});
  c.scene.materials[0].albedo_texture = 0;
  for (std::size_t v = 0; v < c.scene.positions.size(); ++v) {
    const Vec3 p = c.scene.positions[v];
    c.scene.texcoords.emplace_back(0.5F + 0.5F * p.x, 0.5F);
    const bool is_wall = v >= 6;
    c.scene.vertex_colors.push_back(is_wall ? Rgb(0.5F - 0.4F * p.x, 1.0F - 0.4F * p.y, 0.6F) : Rgb(1.0F));
  }
  c.environment = test::white_sky();
  c.position = {-0.5F, 0.4F, -0.4F};
  c.normal = glm::normalize(Vec3(0.0F, 0.2F, -1.0F));
  c.max_bounces = 2;
  c.faults = {{"vertex colours mixed up",
               [](Case& wrong) { std::swap(wrong.scene.vertex_colors[6], wrong.scene.vertex_colors[7]); }},
              {"texture mirrored", [](Case& wrong) {
                 for (Vec2& uv : wrong.scene.texcoords) uv.x = 1.0F - uv.x;
               }}};
  return c;
}

struct NamedCase {
  const char* name;
  Case (*make)();
};
constexpr std::array kCases{NamedCase{"OpenBox", open_box},
                            NamedCase{"TwoEmitters", two_emitters},
                            NamedCase{"Sheets", sheets},
                            NamedCase{"SignedSky", signed_sky},
                            NamedCase{"CoarseSphere", coarse_sphere},
                            NamedCase{"Painted", painted}};
constexpr std::size_t kClosedForms = 7;  // calls of expect_closed_form in this file
constexpr std::size_t kComparisons = 3 * kCases.size() + kClosedForms;

double significance() {
  return metrics::sidak(kFamily, kComparisons);
}

// ---------------------------------------------------------------- on its own, against closed forms

Channels brute(const Case& c, int samples) {
  return brute_force_irradiance(c.scene, c.environment, Vec3d(c.position), glm::normalize(Vec3d(c.normal)),
                                {samples, c.max_bounces, kSeed});
}

bool is_compatible(const Estimate& estimate, double truth) {
  return metrics::two_sided_p((estimate.mean - truth) / estimate.standard_error) >= significance() &&
         metrics::equivalent(estimate, truth, kMargin * std::abs(truth), kFalseEquality);
}

/// Green is enough: the closed forms are for gray light.
void expect_closed_form(const Case& c, double truth) {
  const Estimate estimate = brute(c, 1 << 19)[1];
  EXPECT_TRUE(is_compatible(estimate, truth))
      << "estimate " << estimate.mean << " +- " << estimate.standard_error << ", truth " << truth << ", seed "
      << kSeed;
  EXPECT_FALSE(is_compatible(estimate, 1.02 * truth)) << "an error of 2 % would pass";
  EXPECT_FALSE(is_compatible(estimate, 0.98 * truth)) << "an error of -2 % would pass";
}

TEST(BruteTracer, WhiteFurnaceIsPi) {
  Case c = signed_sky();  // a floor and a wall
  for (scene::Material& material : c.scene.materials) material = {"", Rgb(1.0F), Rgb(0.0F), -1, true};
  c.environment = test::white_sky();
  c.max_bounces = 1000;
  expect_closed_form(c, kPi);
}

TEST(BruteTracer, ParallelRectangleOfLight) {
  Case c;
  test::add_quad(c.scene, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2},
                 test::add_material(c.scene, Rgb(0.0F), Rgb(1.0F)));
  c.environment = test::no_sky();
  expect_closed_form(c, kPi * centred_rectangle_form_factor(2.0, 2.0, 1.0));
}

TEST(BruteTracer, OvercastSky) {
  Case c;
  c.scene = test::nothing_in_the_way();
  c.environment = light::make_builtin_environment("overcast");
  expect_closed_form(c, overcast_irradiance(0.0, 1.0));
  c.normal = {0, 0, 1};
  expect_closed_form(c, overcast_irradiance(kPi / 2.0, 1.0));
}

// Bounce k of a closed room whose walls all shine with radiance 1 adds pi albedo^k.
TEST(BruteTracer, FurnaceAtEveryBounceCount) {
  Case c;
  test::add_room(c.scene, 1.0F, test::add_material(c.scene, Rgb(0.5F), Rgb(1.0F)));
  c.environment = test::white_sky();  // outside, never seen
  c.position = {0.3F, 0.0F, 0.6F};
  for (const auto& [bounces, truth] :
       {std::pair(0, kPi), std::pair(1, 1.5 * kPi), std::pair(60, 2.0 * kPi)}) {
    SCOPED_TRACE(bounces);
    c.max_bounces = bounces;
    expect_closed_form(c, truth);
  }
}

TEST(BruteTracer, DarkBacksBlock) {
  Case c;
  test::add_quad(c.scene, {-1, 0.5F, -1}, {0, 0, 2}, {2, 0, 0},
                 test::add_material(c.scene, Rgb(1.0F), Rgb(1.0F)));  // faces up, hides the light above it
  test::add_quad(c.scene, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2},
                 test::add_material(c.scene, Rgb(1.0F), Rgb(1.0F)));
  c.environment = test::no_sky();
  c.max_bounces = 5;
  c.position = {0.0F, 0.49F, 0.0F};
  const Estimate inside_shadow = brute(c, 1000)[1];
  EXPECT_LE(inside_shadow.mean, 0.01 * kPi);  // only past the rim: elevations below 0.01 / 1
  for (scene::Material& material : c.scene.materials) material.is_double_sided = true;
  EXPECT_GT(brute(c, 1000)[1].mean, 2.5);
}

TEST(BruteTracer, SameSeedSameBits) {
  const Case c = open_box();
  const Channels once = brute(c, 100);
  const Channels again = brute(c, 100);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(once[k].mean, again[k].mean);
}

TEST(BruteTracer, RefusesWhatItCannotDo) {
  const auto refuses = [](const std::function<void(Case&)>& change) {
    Case c = open_box();
    change(c);
    EXPECT_THROW((void)brute(c, 100), InputError);
  };
  refuses([](Case& c) { c.scene.lights.emplace_back(light::PointLight{}); });
  refuses([](Case& c) { c.max_bounces = -1; });
  refuses([](Case& c) { c.max_bounces = integrate::kAllBounces; });
  refuses([](Case& c) { c.normal = Vec3(0.0F); });
  refuses([](Case& c) { c.scene.materials[0].albedo = Rgb(NAN); });
  EXPECT_THROW((void)brute(open_box(), 1), InputError);
}

// ---------------------------------------------------------------- as a second opinion on the path tracer

Channels path_traced(const Case& c, int samples) {
  const integrate::World world(c.scene, c.environment);
  integrate::GatherSettings settings;
  settings.samples = samples;
  settings.max_bounces = c.max_bounces;
  settings.seed = kSeed + 1;
  const integrate::RgbEstimate e =
      integrate::gather_irradiance(world, trace::free_point(c.position, c.normal), 0, settings);
  return {Estimate{e.mean.x, e.standard_error.x}, Estimate{e.mean.y, e.standard_error.y},
          Estimate{e.mean.z, e.standard_error.z}};
}

/// What two opinions on three channels come to.
struct Comparison {
  double smallest_p = 1.0;     // Welch's t: that chance alone makes them differ so much
  double largest_error = 0.0;  // standard error of the difference over the mean
  bool is_equivalent = true;   // surely within kMargin, every channel
};

Comparison compare(const Channels& brute_force, int samples, const Channels& traced) {
  Comparison result;
  for (std::size_t k = 0; k < 3; ++k) {
    const Estimate& a = brute_force[k];
    const Estimate& b = traced[k];
    const double p = metrics::welch(a, static_cast<std::size_t>(samples), b, integrate::kRandomisations).p;
    result.smallest_p = std::min(result.smallest_p, p);
    const Estimate difference{a.mean - b.mean, std::hypot(a.standard_error, b.standard_error)};
    result.largest_error = std::max(result.largest_error, difference.standard_error / std::abs(a.mean));
    result.is_equivalent &= metrics::equivalent(difference, 0.0, kMargin * std::abs(a.mean), kFalseEquality);
  }
  return result;
}

class SecondOpinion : public testing::TestWithParam<NamedCase> {};

TEST_P(SecondOpinion, AgreesAndNoticesFaults) {
  constexpr int kPaths = 1 << 20;
  const Case c = GetParam().make();
  const Channels opinion = brute(c, kPaths);
  const Channels traced = path_traced(c, 1 << 17);
  const Comparison right = compare(opinion, kPaths, traced);
  EXPECT_GE(right.smallest_p, significance()) << "seed " << kSeed;
  EXPECT_TRUE(right.is_equivalent) << "relative standard error " << right.largest_error;
  for (const Case::Fault& fault : c.faults) {
    Case wrong = c;
    fault.plant(wrong);
    const Comparison planted = compare(opinion, kPaths, path_traced(wrong, 1 << 15));
    EXPECT_LT(planted.smallest_p, significance()) << fault.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, SecondOpinion, testing::ValuesIn(kCases),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

}  // namespace
}  // namespace plumbline::truth
