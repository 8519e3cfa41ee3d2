#include "reference/light/texel_table.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "validation/tests/light/support.hpp"

namespace plumbline::light {
namespace {

using testing::Numbers;

TexelTable table_of(const std::vector<std::vector<double>>& weights) {
  return {static_cast<int>(weights.size()), static_cast<int>(weights.front().size()),
          [&](int row, std::span<double> out) {
            std::copy(weights[static_cast<std::size_t>(row)].begin(),
                      weights[static_cast<std::size_t>(row)].end(), out.begin());
          }};
}

std::vector<std::vector<double>> random_weights(int rows, int columns) {
  Numbers numbers;
  std::vector<std::vector<double>> result(static_cast<std::size_t>(rows));
  for (auto& row : result) {
    for (int i = 0; i < columns; ++i) {
      const double number = static_cast<double>(numbers.next());
      row.push_back(number < 0.3 ? 0.0 : std::pow(number, 20.0));  // over ten orders of magnitude
    }
  }
  return result;
}

TEST(TexelTable, HasTheWeightsAsProbabilities) {
  const auto weights = random_weights(37, 101);
  const TexelTable table = table_of(weights);
  double total = 0.0;
  for (const auto& row : weights) total = std::accumulate(row.begin(), row.end(), total);
  EXPECT_LE(std::abs(table.total() / total - 1.0), 1e-12);
  double sum = 0.0;
  for (int row = 0; row < 37; ++row) {
    const auto& values = weights[static_cast<std::size_t>(row)];
    const double row_share = std::accumulate(values.begin(), values.end(), 0.0) / total;
    for (int column = 0; column < 101; ++column) {
      const double expected = values[static_cast<std::size_t>(column)] / total;
      const double found = table.probability(row, column);
      // Each bound is off by at most 101 or 37 units (one for each entry) of 2^-32.
      EXPECT_LE(std::abs(found - expected),
                102.0 * 0x1p-32 * row_share + 38.0 * 0x1p-32 * expected / row_share);
      EXPECT_EQ(found > 0.0, values[static_cast<std::size_t>(column)] > 0.0);
      sum += found;
    }
  }
  EXPECT_LE(std::abs(sum - 1.0), 1e-12);
}

// The probability is how long a stretch of [0, 1) leads to an entry: walk both ends of every stretch.
TEST(TexelTable, PicksExactlyByTheProbabilities) {
  for (const int columns : {1, 2, 3, 7, 64, 101}) {
    const TexelTable table = table_of(random_weights(1, columns));
    if (table.total() == 0.0) continue;
    double begin = 0.0;
    for (int column = 0; column < columns; ++column) {
      const double width = table.probability(0, column);
      if (width == 0.0) continue;
      EXPECT_EQ(table.pick(begin + 1e-3 * width, 0.5).column, column);
      const TexelTable::Pick last = table.pick(begin + 0.999 * width, 0.5);
      EXPECT_EQ(last.column, column);
      EXPECT_LE(std::abs(last.x - 0.999), 1e-5 + 1e-15 / width);
      begin += width;
    }
    EXPECT_LE(std::abs(begin - 1.0), 1e-12);
  }
}

TEST(TexelTable, NeverPicksWhatHasNoWeight) {
  const TexelTable table = table_of({{0, 0, 0}, {0, 1e-30, 0}, {0, 0, 0}, {1, 0, 0}, {0, 0, 0}});
  for (const double x : {0.0, 0x1p-40, 0.5, 1.0 - 0x1p-53}) {
    for (const double y : {0.0, 0.25, 0.75, 1.0 - 0x1p-53}) {
      const TexelTable::Pick pick = table.pick(x, y);
      ASSERT_GT(table.probability(pick.row, pick.column), 0.0);
      ASSERT_GE(pick.x, 0.0);
      ASSERT_LT(pick.x, 1.0);
      ASSERT_GE(pick.y, 0.0);
      ASSERT_LT(pick.y, 1.0);
    }
  }
  EXPECT_GT(table.probability(1, 1), 0.0);  // 30 orders below, and still in reach
}

TEST(TexelTable, OfNothingHasNoTotal) {
  const TexelTable table = table_of({{0, 0}, {0, 0}});
  EXPECT_EQ(table.total(), 0.0);
  EXPECT_EQ(table.probability(1, 1), 0.0);
}

}  // namespace
}  // namespace plumbline::light
