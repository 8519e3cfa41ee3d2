// Light times transfer: against plain sums in double, at every width of vectors.
#include "prt/relight/cpu.hpp"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "prt/sh/basis.hpp"
#include "reference/base/error.hpp"

namespace plumbline::relight {
namespace {

struct Case {
  transfer::Transfer transfer;
  sh::ShRgb lighting;
};

Case make_case(int bands, int channels, std::size_t vertices) {
  std::mt19937 bits(static_cast<unsigned>(bands * 10 + channels));
  std::normal_distribution<double> normal;
  Case result;
  result.transfer.bands = bands;
  result.transfer.channels = channels;
  result.transfer.vertices = vertices;
  const auto count = static_cast<std::size_t>(sh::coefficient_count(bands));
  result.transfer.coefficients.resize(vertices * count * static_cast<std::size_t>(channels));
  for (float& t : result.transfer.coefficients) t = static_cast<float>(normal(bits));
  result.lighting.bands = bands;
  for (std::size_t i = 0; i < count; ++i)
    result.lighting.coefficients.emplace_back(normal(bits), 1e3 * normal(bits), 1e-3 * normal(bits));
  return result;
}

/// The definition, and what float may be off it: (n^2 + 1) 2^-24 sum |T_i l_i|, the last float of a result a unit
/// more.
struct Truth {
  double value = 0.0;
  double allowance = 0.0;
};

Truth truth_of(const Case& one, std::size_t vertex, int channel) {
  const auto row = one.transfer.vector(vertex, channel);
  Truth truth;
  double size = 0.0;
  for (std::size_t i = 0; i < row.size(); ++i) {
    const double term = static_cast<double>(row[i]) * one.lighting.coefficients[i][channel];
    truth.value += term;
    size += std::abs(term);
  }
  truth.allowance = static_cast<double>(row.size() + 1) * 0x1p-24 * size * (1.0 + 1e-4);
  return truth;
}

/// Values outside their allowance (a NaN is), counted.
std::size_t wrong_values(const Case& one, const std::vector<Rgb>& result) {
  std::size_t wrong = 0;
  for (std::size_t v = 0; v < result.size(); ++v) {
    for (int c = 0; c < 3; ++c) {
      const Truth truth = truth_of(one, v, c);
      if (!(std::abs(static_cast<double>(result[v][c]) - truth.value) <= truth.allowance)) ++wrong;
    }
  }
  return wrong;
}

/// Every instruction set of this machine in turn.
template <class Body>
void for_every_set(const Body& body) {
  for (std::int64_t sets = hwy::SupportedTargets(); sets != 0; sets &= sets - 1) {
    hwy::GetChosenTarget().Update(sets & -sets);
    body(hwy::TargetName(sets & -sets));
  }
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

TEST(RelightCpu, EqualsTheSumInDoubleAtEveryWidthAndNumberOfBands) {
  for_every_set([](const char* set) {
    for (const int bands : {1, 2, 3, 4, 5, 6, 8, 11}) {
      for (const int channels : {1, 3}) {
        const Case one = make_case(bands, channels, 37);
        EXPECT_EQ(wrong_values(one, unit_albedo_exit_radiance(one.transfer, one.lighting)), 0U)
            << set << ", " << bands << " bands, " << channels << " channels";
      }
    }
  });
}

TEST(RelightCpu, TheComparisonFindsASlip) {
  Case one = make_case(5, 3, 37);
  std::vector<Rgb> result = unit_albedo_exit_radiance(one.transfer, one.lighting);
  result[36].z = std::nextafter(result[36].z * (1.0F + 1e-4F), 1e9F);
  EXPECT_EQ(wrong_values(one, result), 1U);
  std::swap(one.lighting.coefficients[20].x, one.lighting.coefficients[21].x);
  EXPECT_GE(wrong_values(one, result), 37U);
}

TEST(RelightCpu, AnyNumberOfVerticesAndThreadsGivesTheSameBits) {
  const Case all = make_case(5, 3, 5001);
  const std::vector<Rgb> expected = unit_albedo_exit_radiance(all.transfer, all.lighting, 1);
  EXPECT_EQ(wrong_values(all, expected), 0U);
  for (const int threads : {0, 2, 5})
    EXPECT_EQ(unit_albedo_exit_radiance(all.transfer, all.lighting, threads), expected) << threads;
  for (const std::size_t vertices : {0U, 1U, 2U, 3U, 873U, 874U, 875U}) {
    Case some = all;
    some.transfer.vertices = vertices;
    some.transfer.coefficients.resize(vertices * 75);
    const std::vector<Rgb> result = unit_albedo_exit_radiance(some.transfer, some.lighting);
    EXPECT_TRUE(std::equal(result.begin(), result.end(), expected.begin())) << vertices;
    EXPECT_EQ(result.size(), vertices);
  }
}

TEST(RelightCpu, WritesInItsPlacesOnly) {
  for_every_set([](const char* set) {
    const Case one = make_case(5, 1, 9);
    std::vector<Rgb> places(11, Rgb(-7.0F));
    unit_albedo_exit_radiance(make_blocks(one.transfer), one.lighting, std::span(places).subspan(1, 9));
    EXPECT_EQ(places.front(), Rgb(-7.0F)) << set;
    EXPECT_EQ(places.back(), Rgb(-7.0F)) << set;
    EXPECT_EQ(wrong_values(one, {places.begin() + 1, places.end() - 1}), 0U) << set;
  });
}

TEST(RelightCpu, NanStaysAtItsVertex) {
  for_every_set([](const char* set) {
    for (const int channels : {1, 3}) {
      for (const int bands : {1, 3, 5}) {
        Case one = make_case(bands, channels, 8);
        const std::size_t row = one.transfer.coefficients.size() / 8;
        one.transfer.coefficients[4 * row] = std::numeric_limits<float>::quiet_NaN();
        one.transfer.coefficients[4 * row - 1 + row] = std::numeric_limits<float>::infinity();
        const std::vector<Rgb> result = unit_albedo_exit_radiance(one.transfer, one.lighting);
        EXPECT_FALSE(std::isfinite(result[4].x)) << set;
        EXPECT_FALSE(std::isfinite(result[4].z)) << set;
        for (const std::size_t v : {0U, 1U, 2U, 3U, 5U, 6U, 7U})
          EXPECT_TRUE(is_finite(result[v])) << set << " " << bands << " " << v;
      }
    }
  });
}

TEST(RelightCpu, MoreBandsOfLightAreLeftOutAndFewerRefused) {
  const Case three = make_case(3, 1, 5);
  sh::ShRgb five = make_case(5, 1, 1).lighting;
  std::copy(three.lighting.coefficients.begin(), three.lighting.coefficients.end(),
            five.coefficients.begin());
  EXPECT_EQ(unit_albedo_exit_radiance(three.transfer, five),
            unit_albedo_exit_radiance(three.transfer, three.lighting));
  EXPECT_THROW((void)unit_albedo_exit_radiance(make_case(5, 1, 5).transfer, three.lighting), InputError);
  transfer::Transfer short_one = three.transfer;
  short_one.coefficients.pop_back();
  EXPECT_THROW((void)make_blocks(short_one), InputError);
  std::vector<Rgb> places(4);
  EXPECT_THROW(unit_albedo_exit_radiance(make_blocks(three.transfer), three.lighting, places), InputError);
}

}  // namespace
}  // namespace plumbline::relight
