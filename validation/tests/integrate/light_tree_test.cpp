// Light chosen among many emitters, and drawn from one triangle: what is claimed as a density must be the density.
#include "reference/integrate/light_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <random>
#include <vector>

#include "pieces.hpp"
#include "reference/integrate/emitters.hpp"
#include "reference/light/spherical_triangle.hpp"
#include "reference/trace/ray_caster.hpp"
#include "validation/metrics/statistics.hpp"
#include "validation/truth/irradiance.hpp"

namespace plumbline {
namespace {

using integrate::EmitterSample;
using integrate::EmitterTable;
using integrate::LightBounds;
using integrate::LightTree;
using integrate::Receiver;

constexpr double kFalseAlarms = 1e-4;

/// Uniform numbers for tests.
class Uniform {
 public:
  explicit Uniform(unsigned seed) : random_(seed) {}
  double operator()() { return number_(random_); }
  Vec2 pair() {
    // Below 1 in float too.
    const auto next = [&] { return static_cast<float>(std::floor((*this)() * 0x1p24) * 0x1p-24); };
    const float x = next();
    return {x, next()};
  }
  Vec3d point(double low, double high) {
    const auto next = [&] { return low + (high - low) * (*this)(); };
    const double x = next();
    const double y = next();
    return {x, y, next()};
  }
  Vec3d direction() {
    for (;;) {
      const Vec3d v = point(-1.0, 1.0);
      const double length = glm::length(v);
      if (length > 0.1 && length < 1.0) return v / length;
    }
  }

 private:
  std::mt19937_64 random_;
  std::uniform_real_distribution<double> number_{0.0, 1.0};
};

/// Small emissive triangles in the box; brightness over three orders, every fifth two-sided.
scene::Scene random_triangles(int count, double low, double high, double size, unsigned seed) {
  scene::Scene scene;
  Uniform random(seed);
  for (int i = 0; i < count; ++i) {
    const double radiance = std::pow(10.0, 3.0 * random() - 2.0);
    const auto material = test::add_material(scene, Rgb(0.0F), Rgb(static_cast<float>(radiance)), i % 5 == 0);
    const Vec3d a = random.point(low, high);
    const Vec3d b = a + size * random.direction();
    const Vec3d c = a + size * random.direction();
    test::add_triangle(scene, Vec3(a), Vec3(b), Vec3(c), material);
  }
  return scene;
}

std::vector<LightBounds> bounds_of(const scene::Scene& scene) {
  std::vector<LightBounds> lights;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t)
    lights.push_back(integrate::light_bounds(integrate::make_emissive_triangle(scene, t)));
  return lights;
}

std::vector<Receiver> random_receivers(int count, double low, double high, unsigned seed) {
  Uniform random(seed);
  std::vector<Receiver> receivers;
  for (int i = 0; i < count; ++i) {
    Receiver receiver{Vec3(random.point(low, high)), {}};
    if (i % 3 != 0) receiver.normal = Vec3(random.direction());
    receivers.push_back(receiver);
  }
  return receivers;
}

std::vector<double> probabilities(const LightTree& tree, const Receiver& receiver, std::size_t count) {
  std::vector<double> result;
  for (std::uint32_t i = 0; i < count; ++i) result.push_back(tree.probability(receiver, i));
  return result;
}

// ---------------------------------------------------------------- the choice of one light

// Where bounds promise light that their parts cannot send the draw comes to nothing; lights that shine everywhere leave no
// such place, and a receiver without a normal none either.
TEST(LightTree, ProbabilitiesAddUpToOne) {
  for (const int count : {1, 2, 4, 5, 37, 2000}) {
    std::vector<LightBounds> lights = bounds_of(random_triangles(count, -1, 1, 0.2, 1));
    for (LightBounds& light : lights) light.cos_spread = -1.0;
    const LightTree tree(lights);
    for (Receiver receiver : random_receivers(60, -3, 3, 2)) {
      receiver.normal.reset();
      const std::vector<double> p = probabilities(tree, receiver, lights.size());
      // A way of n turns has at most 3 n roundings of 1.1e-16, the sum one a light.
      EXPECT_NEAR(std::accumulate(p.begin(), p.end(), 0.0), 1.0, 1e-12);
      EXPECT_GT(*std::min_element(p.begin(), p.end()), 0.0);
    }
  }
}

TEST(LightTree, ProbabilitiesAndTheDrawsOfNothingAddUpToOne) {
  constexpr int kSamples = 10000;
  const std::vector<LightBounds> lights = bounds_of(random_triangles(300, -1, 1, 0.2, 1));
  const LightTree tree(lights);
  const std::vector<Receiver> receivers = random_receivers(60, -3, 3, 2);
  const double z = metrics::two_sided_z(metrics::sidak(kFalseAlarms, receivers.size()));
  Uniform random(3);
  for (const Receiver& receiver : receivers) {
    const std::vector<double> p = probabilities(tree, receiver, lights.size());
    const double sum = std::accumulate(p.begin(), p.end(), 0.0);
    double drawn = 0.0;
    for (int s = 0; s < kSamples; ++s) drawn += tree.sample(receiver, random()) ? 1.0 / kSamples : 0.0;
    EXPECT_LE(sum, 1.0 + 1e-12);
    // Four draws for shares next to 0 and 1, where the count is Poisson's and not normal.
    const double deviation = std::sqrt(std::max(0.0, sum * (1.0 - sum)) / kSamples);
    EXPECT_NEAR(drawn, sum, z * deviation + 4.0 / kSamples);
    if (sum > 0.1) {
      EXPECT_GT(std::abs(drawn - 0.5 * sum), z * deviation + 4.0 / kSamples) << "planted: half of it";
    }
  }
}

TEST(LightTree, NothingToChooseFromGivesNothing) {
  const LightTree none;
  EXPECT_TRUE(none.is_empty());
  EXPECT_FALSE(none.sample({Vec3(0.0F), {}}, 0.5));
  const std::vector<LightBounds> lights = bounds_of(random_triangles(100, -1, 1, 0.1, 3));
  EXPECT_FALSE(LightTree(lights).sample({Vec3(0, 5, 0), Vec3(0, 1, 0)}, 0.5)) << "all below the horizon";
  EXPECT_TRUE(LightTree(lights).sample({Vec3(0, 5, 0), Vec3(0, -1, 0)}, 0.5));
}

TEST(LightTree, SampleReturnsTheProbabilityToTheBitAndAUniformRest) {
  const std::vector<LightBounds> lights = bounds_of(random_triangles(500, -1, 1, 0.2, 4));
  const LightTree tree(lights);
  Uniform random(5);
  std::vector<double> rests;
  for (const Receiver& receiver : random_receivers(4000, -2, 2, 6)) {
    const auto choice = tree.sample(receiver, random());
    if (!choice) continue;
    EXPECT_EQ(choice->probability, tree.probability(receiver, choice->light));
    rests.push_back(choice->rest);
  }
  ASSERT_GT(rests.size(), 3000U);
  EXPECT_GT(metrics::kolmogorov_smirnov_uniform(rests).p, kFalseAlarms);
}

/// p of the hypothesis that sample() has the claimed probabilities.
double p_of_frequencies(const LightTree& tree, const Receiver& receiver, const std::vector<double>& claimed,
                        Uniform& random) {
  constexpr int kSamples = 20000;
  std::vector<double> observed(claimed.size() + 1, 0.0);  // the last: nothing drawn
  std::vector<double> expected;
  for (const double p : claimed) expected.push_back(kSamples * p);
  const double nothing = 1.0 - std::accumulate(claimed.begin(), claimed.end(), 0.0);
  expected.push_back(kSamples * std::max(0.0, nothing));
  for (int s = 0; s < kSamples; ++s) {
    const auto choice = tree.sample(receiver, random());
    observed[choice ? choice->light : claimed.size()] += 1.0;
  }
  return metrics::chi_squared(observed, expected).p;
}

TEST(LightTree, FrequenciesAreTheProbabilities) {
  const std::vector<LightBounds> lights = bounds_of(random_triangles(300, -1, 1, 0.2, 7));
  const LightTree tree(lights);
  const std::vector<Receiver> receivers = random_receivers(20, -1.5, 1.5, 8);
  const double level = metrics::sidak(kFalseAlarms, receivers.size());
  Uniform random(9);
  for (const Receiver& receiver : receivers) {
    std::vector<double> claimed = probabilities(tree, receiver, lights.size());
    EXPECT_GT(p_of_frequencies(tree, receiver, claimed, random), level);
    // Planted: the density of a receiver that looks the other way, or sits elsewhere.
    Receiver wrong = receiver;
    wrong.position += Vec3(0.3F, 0, 0);
    claimed = probabilities(tree, wrong, lights.size());
    EXPECT_LT(p_of_frequencies(tree, receiver, claimed, random), level);
  }
}

/// What a light sends to a receiver without obstacles, from `points` x `points` places on it.
double received(const integrate::EmissiveTriangle& triangle, const Receiver& receiver, int points) {
  double sum = 0.0;
  for (int i = 0; i < points; ++i) {
    for (int j = 0; i + j < points; ++j) {
      const double b = (i + 1.0 / 3.0) / points;
      const double c = (j + 1.0 / 3.0) / points;
      const Vec3d on = (1.0 - b - c) * Vec3d(triangle.corners[0]) + b * Vec3d(triangle.corners[1]) +
                       c * Vec3d(triangle.corners[2]);
      const Vec3d towards = on - Vec3d(receiver.position);
      double emitted = -glm::dot(towards, Vec3d(triangle.normal));
      if (triangle.is_double_sided) emitted = std::abs(emitted);
      const double cosine = receiver.normal ? glm::dot(towards, Vec3d(*receiver.normal)) : 1.0;
      sum += std::max(0.0, emitted) * std::max(0.0, cosine);
    }
  }
  return sum;
}

TEST(LightTree, WhatCanSendLightCanBeDrawn) {
  for (const double size : {0.01, 1.0}) {
    const scene::Scene scene = random_triangles(1000, -1, 1, size, 10);
    const std::vector<LightBounds> lights = bounds_of(scene);
    const LightTree tree(lights);
    int hidden = 0;
    for (const Receiver& receiver : random_receivers(60, -2, 2, 11)) {
      for (std::uint32_t t = 0; t < lights.size(); ++t) {
        const bool can_send = received(integrate::make_emissive_triangle(scene, t), receiver, 4) > 0.0;
        const double p = tree.probability(receiver, t);
        if (can_send) {
          EXPECT_GT(p, 0.0);
        }
        hidden += p == 0.0 ? 1 : 0;
      }
    }
    EXPECT_GT(hidden, 0) << "a tree that never prunes proves nothing";
  }
}

TEST(LightTree, LightsInOnePlaceOrInARowAreBuiltAndDrawn) {
  for (const Vec3d& step : {Vec3d(0.0), Vec3d(1.0, 0.0, 0.0), Vec3d(1e-7, 0.0, 0.0)}) {
    std::vector<LightBounds> lights;
    for (int i = 0; i < 1000; ++i) {
      const Vec3d at = Vec3d(3.0) + static_cast<double>(i) * step;
      lights.push_back({at, at, Vec3d(0, 1, 0), -1.0, false, 1.0});
    }
    const LightTree tree(lights);
    const std::vector<double> p = probabilities(tree, {Vec3(0.0F), {}}, lights.size());
    EXPECT_NEAR(std::accumulate(p.begin(), p.end(), 0.0), 1.0, 1e-12);
    EXPECT_GT(*std::min_element(p.begin(), p.end()), 0.0);
  }
}

// Distances that shrink by half defeat any balance: the way must still fit its bits.
TEST(LightTree, LightsThatConvergeKeepTheirWays) {
  std::vector<LightBounds> lights;
  for (int i = 0; i < 400; ++i) {
    const Vec3d at(std::ldexp(1.0, -i), 0.0, 0.0);
    lights.push_back({at, at, Vec3d(0, 1, 0), -1.0, false, 1.0});
  }
  const LightTree tree(lights);
  const Receiver receiver{Vec3(0.5F, 0.5F, 0.0F), {}};
  const std::vector<double> p = probabilities(tree, receiver, lights.size());
  EXPECT_NEAR(std::accumulate(p.begin(), p.end(), 0.0), 1.0, 1e-12);
  Uniform random(12);
  EXPECT_GT(p_of_frequencies(tree, receiver, p, random), kFalseAlarms);
}

// ---------------------------------------------------------------- a point of one triangle

TEST(SphericalTriangle, SolidAngleIsTheClosedForm) {
  const light::SphericalTriangle known = light::spherical_triangle({1, 0, 1}, {0, 1, 1}, {-1, -1, 2});
  EXPECT_NEAR(known.solid_angle, 0.748996398184, 1e-11);
  EXPECT_NEAR(light::spherical_triangle({1, 0, 0}, {0, 1, 0}, {0, 0, 1}).solid_angle, 0.5 * kPi, 1e-14);
  EXPECT_EQ(light::spherical_triangle({1, 0, 0}, {2, 1, 0}, {1, 1, 0}).solid_angle, 0.0);
}

/// The share of a triangle's solid angle that a corner's part has: a, and the points `s` and `t` of the way from a to b and
/// c.
double corner_share(const Vec3d& a, const Vec3d& b, const Vec3d& c, double s, double t) {
  return truth::triangle_solid_angle(a, a + s * (b - a), a + t * (c - a)) /
         truth::triangle_solid_angle(a, b, c);
}

/// p of the hypothesis that directions drawn by `draw` fall into the four parts of a triangle (by the middles of its
/// edges) in proportion to their solid angles.
double p_of_quarters(const Vec3d& a, const Vec3d& b, const Vec3d& c, const std::function<Vec3d(Vec2)>& draw) {
  constexpr int kSamples = 20000;
  Uniform random(13);
  std::vector<double> observed(4, 0.0);
  for (int i = 0; i < kSamples; ++i) {
    const Vec3d d = draw(random.pair());
    Vec3d weights(glm::dot(d, glm::cross(b, c)), glm::dot(d, glm::cross(c, a)),
                  glm::dot(d, glm::cross(a, b)));
    weights /= weights.x + weights.y + weights.z;
    EXPECT_GE(std::min({weights.x, weights.y, weights.z}), -1e-9);
    const int part = weights.x > 0.5 ? 0 : weights.y > 0.5 ? 1 : weights.z > 0.5 ? 2 : 3;
    observed[static_cast<std::size_t>(part)] += 1.0;
  }
  std::vector<double> expected{corner_share(a, b, c, 0.5, 0.5), corner_share(b, c, a, 0.5, 0.5),
                               corner_share(c, a, b, 0.5, 0.5)};
  expected.push_back(1.0 - expected[0] - expected[1] - expected[2]);
  for (double& e : expected) e *= kSamples;
  return metrics::chi_squared(observed, expected).p;
}

TEST(SphericalTriangle, DirectionsAreUniformBySolidAngle) {
  struct Shape {
    Vec3d a, b, c;
    bool is_flat_alike;  // by area would be the same within what the test sees
  };
  const std::vector<Shape> shapes = {
      {{1, 0, 1}, {0, 1, 1}, {-1, -1, 2}, false},
      {{1, -0.5, 1e-3}, {-1, -0.5, 1e-3}, {0, 1, 1e-3}, false},    // eye next to the middle
      {{1, 0, 1e-3}, {0, 1, 1e-3}, {0.01, 0.01, 1e-3}, false},     // eye next to a corner
      {{-1, 0, 0.01}, {1, 0, 0.01}, {0, 1e-3, 0.02}, false},       // sliver across
      {{0.1, 0, 1e-3}, {1, 0.01, 1e-3}, {1, -0.01, 1e-3}, false},  // edge-on
      {{1, 0, 100}, {0, 1, 100}, {0, 0, 100}, true},               // far
      {{1e-2, 0, 10}, {0, 1e-2, 10}, {0, 0, 10}, true},            // tiny: 5e-7 sr
  };
  const double level = metrics::sidak(kFalseAlarms, shapes.size());
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    SCOPED_TRACE(i);
    const Shape& s = shapes[i];
    const light::SphericalTriangle seen = light::spherical_triangle(s.a, s.b, s.c);
    EXPECT_GT(p_of_quarters(s.a, s.b, s.c, [&](Vec2 u) { return light::sample_spherical_triangle(seen, u); }),
              level);
    const auto by_area = [&](Vec2 u) {
      const double root = std::sqrt(static_cast<double>(u.x));
      return glm::normalize((1.0 - root) * s.a + root * (1.0 - static_cast<double>(u.y)) * s.b +
                            root * static_cast<double>(u.y) * s.c);
    };
    EXPECT_EQ(p_of_quarters(s.a, s.b, s.c, by_area) > level, s.is_flat_alike) << "planted: uniform by area";
  }
}

/// Irradiance by light sampling alone, nothing in the way: the terms' moments.
metrics::RunningMoments irradiance_by_light(const EmitterTable& emitters, const Receiver& receiver,
                                            int samples, Uniform& random) {
  metrics::RunningMoments moments;
  for (int i = 0; i < samples; ++i) {
    const Vec2 pick = random.pair();
    const auto sample = emitters.sample(receiver, pick, random.pair());
    double term = 0.0;
    if (sample) {
      const double cosine = static_cast<double>(glm::dot(*receiver.normal, sample->direction));
      term = static_cast<double>(sample->radiance.y) * std::max(0.0, cosine) / sample->pdf;
    }
    moments.add(term);
  }
  return moments;
}

double relative_deviation(const metrics::RunningMoments& moments) {
  return std::sqrt(moments.variance()) / moments.mean();
}

/// Above a triangle that shines up, and what is said of it.
scene::Scene shining_up() {
  scene::Scene scene;
  test::add_triangle(scene, {-1, 0, -1}, {0, 0, 1.5F}, {1, 0, -1},
                     test::add_material(scene, Rgb(0.0F), Rgb(1.0F)));
  return scene;
}

TEST(EmissiveTriangle, VarianceStaysBoundedNextToIt) {
  const scene::Scene scene = shining_up();
  const EmitterTable emitters(scene);
  Uniform random(14);
  for (const Vec3& foot : {Vec3(0, 0, 0), Vec3(0.3F, 0, -0.8F), Vec3(0, 0, 1.49F), Vec3(0.99F, 0, -0.999F)}) {
    for (const float height : {1.0F, 1e-1F, 1e-3F, 1e-4F}) {
      SCOPED_TRACE(testing::Message() << foot.x << " " << foot.z << " height " << height);
      const Receiver receiver{foot + Vec3(0, height, 0), Vec3(0, -1, 0)};
      std::vector<Vec3d> corners;
      for (const Vec3& c : scene.positions) corners.push_back(Vec3d(c) - Vec3d(receiver.position));
      const double truth = truth::polygon_irradiance(corners, Vec3d(0, -1, 0), 1.0);
      const metrics::RunningMoments moments = irradiance_by_light(emitters, receiver, 20000, random);
      EXPECT_LE(relative_deviation(moments), 1.0);
      EXPECT_NEAR(moments.mean(), truth, 4.0 * moments.estimate().standard_error + 2e-6 * truth);
      const Receiver behind{foot - Vec3(0, height, 0), Vec3(0, 1, 0)};
      EXPECT_EQ(irradiance_by_light(emitters, behind, 100, random).mean(), 0.0) << "its back is dark";
    }
  }
}

// The same by area: E = integral of cos^2/d^2 over a triangle at height h: its second moment grows with 1/h^2.
TEST(EmissiveTriangle, ByAreaTheVarianceWouldGrow) {
  const scene::Scene scene = shining_up();
  const double area = integrate::make_emissive_triangle(scene, 0).area;
  const EmitterTable emitters(scene);
  const Receiver receiver{Vec3(0, 1e-3F, 0), Vec3(0, -1, 0)};
  Uniform random(15);
  metrics::RunningMoments moments;
  for (int i = 0; i < 200000; ++i) {
    const double root = std::sqrt(random());
    const double b = root * random();
    const Vec3d on = (1.0 - root) * Vec3d(-1, 0, -1) + (root - b) * Vec3d(0, 0, 1.5) + b * Vec3d(1, 0, -1);
    const Vec3d offset = on - Vec3d(receiver.position);
    const double squared = glm::dot(offset, offset);
    moments.add(area * offset.y * offset.y / (squared * squared));
  }
  EXPECT_GT(relative_deviation(moments), 10.0);
  EXPECT_LE(relative_deviation(irradiance_by_light(emitters, receiver, 20000, random)), 1.0);
}

// Edge-on, in the plane, on the triangle itself: no NaN, no light that is not there.
TEST(EmissiveTriangle, EdgeOnAndInThePlaneNothingGoesWrong) {
  scene::Scene scene;
  test::add_triangle(scene, {-1, 7, -1}, {0, 7, 1.5F}, {1, 7, -1},
                     test::add_material(scene, Rgb(0), Rgb(1), true));
  const integrate::EmissiveTriangle triangle = integrate::make_emissive_triangle(scene, 0);
  Uniform random(16);
  const float next = std::nextafter(7.0F, 8.0F);
  for (const Vec3& at : {Vec3(0, 7, 0), Vec3(0, next, 0), Vec3(2, 7, 0), Vec3(2, next, 0), Vec3(2, 7.001F, 0),
                         Vec3(-1, 7, -1), Vec3(0.5F, 7, -1)}) {
    for (int i = 0; i < 2000; ++i) {
      const auto sample = integrate::sample_triangle(triangle, at, random.pair());
      if (!sample) continue;
      EXPECT_TRUE(is_finite(sample->direction));
      EXPECT_TRUE(std::isfinite(sample->pdf) && sample->pdf > 0.0);
      // In the plane it is drawn by area, and its light 1/pdf = A cos_e/d^2 is that of the points' rounding, 32
      // float epsilons of 7, for a height: what a receiver clearly out of the plane is sent is far above that.
      const double d = static_cast<double>(glm::length(sample->on_emitter.position - at));
      const double rounded = triangle.area * 32.0 * 1.2e-7 * 7.0 / (d * d * d);
      if (at.y == 7.0F) {
        EXPECT_LE(1.0 / sample->pdf, rounded);
      }
      if (at.y == 7.001F) {
        EXPECT_GT(1.0 / sample->pdf, rounded);
      }
    }
  }
}

// ---------------------------------------------------------------- all together

TEST(EmitterTable, ThousandsOfTrianglesGiveTheSumOfLambertsFormula) {
  const scene::Scene scene = random_triangles(3000, 0.3, 2.0, 0.25, 17);  // wholly above y = 0
  const EmitterTable emitters(scene);
  Uniform random(18);
  for (const Vec3& at : {Vec3(1, 0, 1), Vec3(-1, 0, 0.5F), Vec3(2, 0, 2)}) {
    const Receiver receiver{at, Vec3(0, 1, 0)};
    double truth = 0.0;
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
      const integrate::EmissiveTriangle triangle = integrate::make_emissive_triangle(scene, t);
      std::vector<Vec3d> corners;
      for (const Vec3& c : triangle.corners) corners.push_back(Vec3d(c) - Vec3d(at));
      const bool is_front = glm::dot(corners[0], Vec3d(triangle.normal)) < 0.0;
      if (!is_front && !triangle.is_double_sided) continue;
      truth += truth::polygon_irradiance(corners, Vec3d(0, 1, 0), static_cast<double>(triangle.radiance.y));
    }
    const metrics::Estimate estimate = irradiance_by_light(emitters, receiver, 1 << 20, random).estimate();
    const auto agrees = [&](double mean) {
      return estimate.standard_error <= 0.002 * truth &&
             std::abs(mean - truth) <= 4.0 * estimate.standard_error + 2e-6 * truth;
    };
    EXPECT_TRUE(agrees(estimate.mean))
        << estimate.mean << " +- " << estimate.standard_error << ", truth " << truth;
    EXPECT_FALSE(agrees(1.01 * estimate.mean));
    EXPECT_FALSE(agrees(0.99 * estimate.mean));
    EXPECT_FALSE(agrees(NAN));
  }
}

// pdf() of what a ray meets is the density of sample(): along the direction drawn, the first hit is mostly what was drawn.
TEST(EmitterTable, DensityOfWhatIsMetIsThatOfWhatWasDrawn) {
  scene::Scene scene = random_triangles(200, -1, 1, 0.4, 19);
  const auto bright = test::add_material(scene, Rgb(0.0F), Rgb(1.0F));
  scene.spheres.push_back({{1.5F, 0, 0}, 0.3F, bright});
  scene.discs.push_back({{-1.5F, 0, 0}, {1, 0, 0}, 0.5F, bright});
  const EmitterTable emitters(scene);
  const trace::RayCaster caster(scene);
  Uniform random(20);
  int compared = 0;
  for (const Receiver& receiver : random_receivers(4000, -1, 1, 21)) {
    const Vec2 pick = random.pair();
    const auto sample = emitters.sample(receiver, pick, random.pair());
    if (!sample) continue;
    const auto hit = caster.closest_hit({receiver.position, sample->direction});
    if (!hit) continue;
    const trace::SurfaceHit seen = trace::surface_hit(scene, *hit, sample->direction);
    const float gap = glm::length(seen.point.position - sample->on_emitter.position);
    const float cosine = -glm::dot(seen.point.geometric_normal, sample->direction);
    if (gap > 1e-5F || cosine < 0.05F) continue;  // hidden; or so oblique that float directions differ
    const double pdf = emitters.pdf(receiver, hit->triangle, seen.point, hit->distance, sample->direction);
    // Position and direction in float, 1e-6 each, over a cosine of 0.05 and a distance of 0.05 at least.
    const double tolerance = 4e-5 / std::min(1.0, static_cast<double>(hit->distance));
    EXPECT_NEAR(pdf / sample->pdf, 1.0, tolerance);
    ++compared;
  }
  EXPECT_GT(compared, 1000);
}

// The integral of pdf() over directions is what sample() returns of its trials; binned by octants, their frequencies.
TEST(EmitterTable, DensityOverDirectionsIsTheFrequencyOfSamples) {
  const scene::Scene scene = random_triangles(12, -1, 1, 1.5, 22);
  const EmitterTable emitters(scene);
  const auto octant = [](const Vec3& d) {
    return (d.x > 0.0F ? 1U : 0U) + (d.y > 0.0F ? 2U : 0U) + (d.z > 0.0F ? 4U : 0U);
  };
  constexpr int kSamples = 400000;
  for (const Receiver& receiver : random_receivers(6, -1, 1, 23)) {
    Uniform random(24);
    std::array<metrics::RunningMoments, 8> drawn;
    std::array<metrics::RunningMoments, 8> integral;
    for (int i = 0; i < kSamples; ++i) {
      const Vec2 pick = random.pair();
      const auto sample = emitters.sample(receiver, pick, random.pair());
      const Vec3d uniform = random.direction();
      // All that the direction meets, hidden or not: the density is that of the lights without obstacles.
      double density = 0.0;
      for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        const integrate::EmissiveTriangle triangle = integrate::make_emissive_triangle(scene, t);
        const Vec3d a = Vec3d(triangle.corners[0]) - Vec3d(receiver.position);
        const Vec3d b = Vec3d(triangle.corners[1]) - Vec3d(receiver.position);
        const Vec3d c = Vec3d(triangle.corners[2]) - Vec3d(receiver.position);
        const double fall = glm::dot(uniform, Vec3d(triangle.normal));
        const double distance = glm::dot(a, Vec3d(triangle.normal)) / fall;
        if (!(distance > 0.0)) continue;
        const double side = fall > 0.0 ? 1.0 : -1.0;
        if (side > 0.0 && !triangle.is_double_sided) continue;
        if (side * glm::dot(uniform, glm::cross(b, c)) < 0.0 ||
            side * glm::dot(uniform, glm::cross(c, a)) < 0.0 ||
            side * glm::dot(uniform, glm::cross(a, b)) < 0.0) {
          continue;
        }
        trace::SurfacePoint point;
        point.geometric_normal = static_cast<float>(-side) * triangle.normal;
        density += emitters.pdf(receiver, t, point, static_cast<float>(distance), Vec3(uniform));
      }
      for (unsigned o = 0; o < 8; ++o) {
        drawn[o].add(sample && octant(sample->direction) == o ? 1.0 : 0.0);
        integral[o].add(octant(Vec3(uniform)) == o ? 4.0 * kPi * density : 0.0);
      }
    }
    for (std::size_t o = 0; o < 8; ++o) {
      const metrics::Estimate a = drawn[o].estimate();
      const metrics::Estimate b = integral[o].estimate();
      if (a.mean == 0.0 && b.mean == 0.0) continue;
      const auto p = [&](double scale) {
        return metrics::welch({scale * b.mean, scale * b.standard_error}, kSamples, a, kSamples).p;
      };
      EXPECT_GT(p(1.0), metrics::sidak(kFalseAlarms, 48))
          << "octant " << o << ": " << a.mean << " " << b.mean;
      if (a.mean > 0.05) {
        EXPECT_LT(p(1.25), metrics::sidak(kFalseAlarms, 48)) << "planted: a quarter off";
      }
    }
  }
}

}  // namespace
}  // namespace plumbline
