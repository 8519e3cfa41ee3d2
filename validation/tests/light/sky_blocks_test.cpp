#include "reference/light/sky_blocks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "validation/tests/light/sampling.hpp"

namespace plumbline::light {
namespace {

using testing::chi_squared;
using testing::Estimate;
using testing::Numbers;

// ---------------------------------------------------------------- cells

struct Grid {
  TexelTable table;
  SkyBlocks blocks;
  int rows = 0;
  int columns = 0;
  [[nodiscard]] Vec3d centre(int row, int column) const {
    return Vec3d(testing::texel_centre(column, row, columns, rows));
  }
};

// Weights over five orders of magnitude, a fifth of them 0.
Grid make_grid(int rows, int columns) {
  Grid grid;
  grid.rows = rows;
  grid.columns = columns;
  Numbers numbers(7);
  std::vector<double> weights(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns));
  for (double& weight : weights) {
    const double number = static_cast<double>(numbers.next());
    weight =
        number < 0.2 && weights.size() > 1 ? 0.0 : std::pow(10.0, 5.0 * static_cast<double>(numbers.next()));
  }
  grid.table = TexelTable(rows, columns, [&](int row, std::span<double> out) {
    for (std::size_t x = 0; x < out.size(); ++x) {
      out[x] = weights[static_cast<std::size_t>(row) * out.size() + x] *
               testing::texel_solid_angle(row, columns, rows);
    }
  });
  grid.blocks = SkyBlocks(
      grid.table, [&](int row, int column) { return grid.centre(row, column); },
      kPi * std::hypot(0.5 / rows, 1.0 / columns));
  return grid;
}

const std::vector<std::pair<int, int>> kSizes = {{1, 1}, {1, 2}, {4, 8}, {33, 66}, {128, 256}, {96, 16}};

TEST(SkyBlocks, ProbabilitiesSumToOne) {
  for (const auto& [rows, columns] : kSizes) {
    const Grid grid = make_grid(rows, columns);
    Numbers numbers;
    for (int k = 0; k < 20; ++k) {
      const SkyBlocks::Lobe lobe = grid.blocks.lobe(numbers.direction());
      double sum = 0.0;
      for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column)
          sum += grid.blocks.probability(grid.table, lobe, row, column);
      }
      // Weights are floats: 2048 of them, each rounded once. Less than 1 is allowed where a group near the horizon has no
      // block above it.
      EXPECT_LE(sum, 1.0 + 1e-5) << rows << "x" << columns;
      EXPECT_GE(sum, 0.9) << rows << "x" << columns;
    }
  }
}

TEST(SkyBlocks, ReachEveryCellThatSendsLight) {
  for (const auto& [rows, columns] : kSizes) {
    const Grid grid = make_grid(rows, columns);
    Numbers numbers;
    for (int k = 0; k < 20; ++k) {
      const Vec3 normal = numbers.direction();
      const SkyBlocks::Lobe lobe = grid.blocks.lobe(normal);
      for (int row = 0; row < rows; ++row) {
        for (int column = 0; column < columns; ++column) {
          const bool sends = grid.table.probability(row, column) > 0.0 &&
                             glm::dot(grid.centre(row, column), Vec3d(normal)) > 0.0;
          if (sends) {
            EXPECT_GT(grid.blocks.probability(grid.table, lobe, row, column), 0.0)
                << rows << "x" << columns << " cell " << row << " " << column;
          }
        }
      }
    }
  }
}

TEST(SkyBlocks, PickCellsAsOftenAsTheirProbabilitySays) {
  constexpr int kPicks = 200000;
  const Grid grid = make_grid(32, 64);
  for (const Vec3 normal : {Vec3(0.0F, 1.0F, 0.0F), Vec3(0.6F, 0.0F, -0.8F)}) {
    const SkyBlocks::Lobe lobe = grid.blocks.lobe(normal);
    std::vector<double> counts(32 * 64);
    std::vector<double> probabilities(counts.size());
    Numbers numbers;
    for (int k = 0; k < kPicks; ++k) {
      const auto pick = grid.blocks.pick(grid.table, lobe, static_cast<double>(numbers.next()),
                                         static_cast<double>(numbers.next()));
      if (!(pick.probability > 0.0)) continue;
      EXPECT_NEAR(
          pick.probability / grid.blocks.probability(grid.table, lobe, pick.cell.row, pick.cell.column), 1.0,
          1e-5);
      counts[static_cast<std::size_t>(pick.cell.row * 64 + pick.cell.column)] += 1.0;
    }
    for (int i = 0; i < 32 * 64; ++i)
      probabilities[static_cast<std::size_t>(i)] = grid.blocks.probability(grid.table, lobe, i / 64, i % 64);
    EXPECT_TRUE(chi_squared(counts, probabilities, kPicks).passes());
    std::rotate(probabilities.begin(), probabilities.begin() + 1, probabilities.end());  // the column beside
    EXPECT_FALSE(chi_squared(counts, probabilities, kPicks).passes());
  }
}

// ---------------------------------------------------------------- whole environments

// Irradiance by the lobe, red channel, with the spread of one sample relative to the mean.
struct LobeEstimate {
  Estimate irradiance;
  double relative_deviation = 0.0;
};
LobeEstimate by_lobe(const Environment& environment, const Vec3& normal, int samples = testing::kSamples) {
  const EnvironmentSampler sampler(environment);
  const auto lobe = sampler.lobe(normal);
  Numbers numbers;
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < samples; ++i) {
    const auto sample = sampler.sample(lobe, numbers.next_pair());
    if (!sample) continue;
    const double cosine = std::max(0.0, glm::dot(Vec3d(sample->direction), Vec3d(normal)));
    const double value = static_cast<double>(sample->radiance.x) * cosine / sample->pdf;
    sum += value;
    squares += value * value;
  }
  const double mean = sum / samples;
  const double variance = std::max(0.0, squares / samples - mean * mean);
  return {{mean, std::sqrt(variance / (samples - 1))}, std::sqrt(variance) / std::abs(mean)};
}

image::Image gray_photograph(int width, int height) {
  image::Image image = image::make_image(width, height);
  Numbers numbers(3);
  for (Rgb& texel : image.pixels) texel = Rgb(0.1F + numbers.next());
  image.at(width / 3, height / 4) = Rgb(2e4F);  // a sun
  image.at(width / 3 + 1, height / 4) = Rgb(1e4F);
  return image;
}

Environment turned(Environment environment) {
  return rotated(std::move(environment), Vec3(20.0F, 50.0F, -35.0F));
}

std::vector<Environment> environments() {
  std::vector<Environment> result;
  result.push_back(testing::lat_long_environment(gray_photograph(64, 32)));
  result.push_back(turned(testing::lat_long_environment(gray_photograph(256, 128))));
  result.push_back(testing::lat_long_environment(gray_photograph(2, 1)));
  result.push_back(turned(testing::lat_long_environment(gray_photograph(40, 20))));
  result.back().lookup = Lookup::bilinear;
  Environment cube;
  cube.name = "cube";
  CubeMapSky faces;
  for (image::Image& face : faces.faces) face = gray_photograph(24, 24);
  cube.sky = faces;
  result.push_back(turned(cube));
  cube.lookup = Lookup::bilinear;
  result.push_back(cube);
  for (const char* name : {"overcast", "two-lobes", "sun-sky"})
    result.push_back(turned(make_builtin_environment(name)));
  result.push_back(testing::sun_environment({Vec3(0.0F, 0.6F, 0.8F), 0.2, Rgb(50.0F)}, Rgb(1.0F)));
  result.push_back(testing::sun_environment({Vec3(0.0F, 1.0F, 0.0F), 2.0, Rgb(3.0F)}, Rgb(0.2F)));
  result.push_back(testing::analytic_environment([](const Vec3& w) { return Rgb(w.x + 0.3F * w.y); }));
  return result;
}

// The same integral drawn by radiance alone, another sampler with another density, whose own tests hold closed forms.
TEST(SkyLobe, GivesTheIrradianceThatSamplingByRadianceGives) {
  for (const Environment& environment : environments()) {
    for (const Vec3 normal : {Vec3(0.0F, 1.0F, 0.0F), Vec3(0.36F, 0.48F, -0.8F), Vec3(-0.8F, -0.6F, 0.0F)}) {
      const Estimate found = by_lobe(environment, normal).irradiance;
      const Estimate expected = testing::irradiance(environment, Vec3d(normal), 2 * testing::kSamples);
      const double error = std::hypot(found.standard_error, expected.standard_error);
      const double tolerance = 4.0 * error + 2e-5 * std::abs(expected.mean);
      EXPECT_LE(std::abs(found.mean - expected.mean), tolerance)
          << environment.name << " " << environment.sky.index() << ": " << found.mean << " against "
          << expected.mean;
      EXPECT_GT(std::abs(1.1 * found.mean - expected.mean), tolerance) << "ten per cent would not show";
    }
  }
}

// Where nothing is in the way nearly nothing is left to chance; by radiance alone it is the whole cosine (and half the
// samples go below the horizon).
TEST(SkyLobe, LeavesLittleToChanceWhereNothingBlocks) {
  const Environment environment = testing::lat_long_environment(gray_photograph(512, 256));
  for (const Vec3 normal : {Vec3(0.0F, 1.0F, 0.0F), Vec3(0.36F, 0.48F, -0.8F), Vec3(-0.8F, 0.6F, 0.0F)}) {
    const LobeEstimate found = by_lobe(environment, normal, 50000);
    EXPECT_LE(found.relative_deviation, 0.3) << normal.x;
    const Estimate radiance_alone = testing::irradiance(environment, Vec3d(normal), 50000);
    EXPECT_GT(radiance_alone.standard_error * std::sqrt(50000.0) / radiance_alone.mean, 0.5) << normal.x;
  }
}

TEST(SkyLobe, GivesTheSameSamplesTogetherAsOneByOne) {
  for (const Environment& environment : environments()) {
    const EnvironmentSampler sampler(environment);
    const auto lobe = sampler.lobe(Vec3(0.0F, 0.6F, 0.8F));
    Numbers numbers;
    std::array<Vec2, EnvironmentSampler::kMostTogether> points;
    std::array<LobeSample, EnvironmentSampler::kMostTogether> together;
    for (Vec2& u : points) u = numbers.next_pair();
    sampler.sample(lobe, points, together);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto alone = sampler.sample(lobe, points[i]);
      EXPECT_EQ(alone.has_value(), together[i].pdf > 0.0);
      if (!alone) continue;
      EXPECT_EQ(alone->pdf, together[i].pdf);
      EXPECT_EQ(alone->direction, together[i].direction);
      EXPECT_EQ(alone->radiance, together[i].radiance());
    }
  }
}

TEST(SkyLobe, OfWhatLiesBelowTheHorizonIsEmpty) {
  const Environment environment = testing::sun_environment({Vec3(0.0F, 1.0F, 0.0F), 0.1, Rgb(1.0F)});
  const EnvironmentSampler sampler(environment);
  const auto lobe = sampler.lobe(Vec3(0.0F, -1.0F, 0.0F));
  Numbers numbers;
  for (int i = 0; i < 1000; ++i) EXPECT_FALSE(sampler.sample(lobe, numbers.next_pair()).has_value());
}

}  // namespace
}  // namespace plumbline::light
