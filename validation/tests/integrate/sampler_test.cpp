#include "reference/integrate/sampler.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "reference/integrate/hemisphere.hpp"
#include "validation/metrics/statistics.hpp"

namespace plumbline::integrate {
namespace {

std::vector<Vec2> points(std::uint32_t count, int dimension_pair, std::uint64_t seed = 5) {
  std::vector<Vec2> result;
  for (std::uint32_t i = 0; i < count; ++i) {
    Sampler sampler(seed, 3, 2, i);
    Vec2 u(0.0F);
    for (int d = 0; d <= dimension_pair; ++d) u = sampler.next_2d();
    result.push_back(u);
  }
  return result;
}

// A (0, m, 2)-net: every elementary interval 2^-a x 2^-(m-a) holds exactly one of 2^m points. Scrambling must
// not destroy that.
bool is_net(const std::vector<Vec2>& net, int m) {
  for (int a = 0; a <= m; ++a) {
    std::set<std::pair<int, int>> boxes;
    for (const Vec2& u : net)
      boxes.emplace(static_cast<int>(std::ldexp(u.x, a)), static_cast<int>(std::ldexp(u.y, m - a)));
    if (boxes.size() != net.size()) return false;
  }
  return true;
}

TEST(Sampler, EveryPairOfDimensionsIsANet) {
  for (const int pair : {0, 1, 7}) {
    for (const int m : {1, 4, 8})
      EXPECT_TRUE(is_net(points(1U << m, pair), m)) << "pair " << pair << ", 2^" << m << " points";
  }
}

TEST(Sampler, NetTestSeesAPlantedFault) {
  std::vector<Vec2> broken = points(256, 0);
  broken[17] = broken[18];
  EXPECT_FALSE(is_net(broken, 8));
}

TEST(Sampler, StreamsAndRandomisationsAreUniform) {
  std::vector<double> values;
  for (std::uint64_t stream = 0; stream < 5000; ++stream) {
    Sampler sampler(1, stream, static_cast<std::uint32_t>(stream % 16), 0);
    for (int d = 0; d < 4; ++d) values.push_back(static_cast<double>(sampler.next_1d()));
  }
  EXPECT_GE(metrics::kolmogorov_smirnov_uniform(values).p, 1e-3);
}

TEST(Sampler, DimensionsAreUncorrelated) {
  constexpr int kCount = 20000;
  std::array<double, 6> products{};
  for (std::uint32_t stream = 0; stream < kCount; ++stream) {
    Sampler sampler(9, stream, 0, 1);
    std::array<double, 4> u{};
    for (double& value : u) value = static_cast<double>(sampler.next_1d()) - 0.5;
    std::size_t slot = 0;
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = a + 1; b < 4; ++b) products[slot++] += u[a] * u[b];
    }
  }
  const double standard_error = (1.0 / 12.0) / std::sqrt(static_cast<double>(kCount));
  for (const double sum : products) EXPECT_LE(std::abs(sum / kCount), 4.5 * standard_error);
}

TEST(Sampler, DependsOnItsArgumentsOnly) {
  Sampler a(1, 2, 3, 4);
  Sampler b(1, 2, 3, 4);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(a.next_2d(), b.next_2d());
  Sampler other(2, 2, 3, 4);
  Sampler again(1, 2, 3, 4);
  EXPECT_NE(again.next_2d(), other.next_2d());
}

Vec2 cosine_input(std::uint32_t i) {
  Sampler sampler(3, 0, 0, i);
  return sampler.next_2d();
}

// Moments of the cosine density: E[cos] = 2/3, E[cos^2] = 1/2, E[x^2] = 1/4.
TEST(Hemisphere, CosineMoments) {
  constexpr int kCount = 1 << 16;
  for (const Vec3 normal :
       {Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(0, 1, 0), glm::normalize(Vec3(1, -2, 0.5F))}) {
    double first = 0.0;
    double second = 0.0;
    for (std::uint32_t i = 0; i < kCount; ++i) {
      const Vec3 w = sample_cosine_hemisphere(normal, cosine_input(i));
      EXPECT_LE(std::abs(glm::length(w) - 1.0F), 1e-6F);
      const double cosine = static_cast<double>(glm::dot(w, normal));
      first += cosine;
      second += cosine * cosine;
    }
    // Variances 1/18 and 1/12 of independent points bound the error of stratified ones.
    EXPECT_LE(std::abs(first / kCount - 2.0 / 3.0), 4.0 * std::sqrt(1.0 / 18.0 / kCount));
    EXPECT_LE(std::abs(second / kCount - 0.5), 4.0 * std::sqrt(1.0 / 12.0 / kCount));
  }
}

}  // namespace
}  // namespace plumbline::integrate
