#include "validation/checks/compression_study.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "validation/tests/compress/planted.hpp"

namespace plumbline::checks {
namespace {

std::vector<SizedError> points() {
  return {{"VQ", 16, 0, 32, 10.0, 0.3, 0.3},
          {"VQ", 64, 0, 32, 20.0, 0.2, 0.2},
          {"static CPCA", 4, 2, 8, 15.0, 0.1, 0.08},
          {"iterative CPCA", 4, 2, 8, 15.0, 0.05, 0.049},
          {"static CPCA", 8, 2, 8, 30.0, 0.01, 0.01}};
}

TEST(CompressionStudy, RatiosCompareEqualSizes) {
  EXPECT_DOUBLE_EQ(largest_ratio(points(), "iterative CPCA", "static CPCA"), 0.5);
  // 15 bytes lie between the VQs of 10 and of 20, at ln 1.5/ln 2 of the way; no VQ is as large as 30.
  const double vq = 0.3 * std::pow(0.2 / 0.3, std::log2(1.5));
  EXPECT_NEAR(largest_ratio_to_vq(points(), "static CPCA", 8), 0.1 / vq, 1e-12);
  EXPECT_DOUBLE_EQ(largest_increase(points(), "static CPCA", 8), 0.25);
}

TEST(CompressionStudy, NothingToCompareIsNoPass) {
  EXPECT_TRUE(std::isnan(largest_ratio({}, "iterative CPCA", "static CPCA")));
  EXPECT_TRUE(std::isnan(largest_ratio_to_vq({}, "static CPCA", 8)));
  EXPECT_TRUE(std::isnan(largest_increase(points(), "static CPCA", 16)));
}

TEST(CompressionStudy, FindsTheKnownRankingOfMethods) {
  const compress::Planted sheet = compress::bent_sheet(27, 2000, 1.0);
  transfer::Transfer transfer;
  transfer.bands = 3;
  transfer.channels = 3;
  transfer.vertices = 2000;
  transfer.coefficients = sheet.values;
  CompressionGrid grid;
  // With one for every few vertices VQ learns them by heart, and is no smaller than they are.
  grid.vq_clusters = {16, 64, 128, 256};
  grid.pca_components = {1, 4};
  grid.clusters = {8, 16};
  grid.components = {2, 4};
  grid.bits = {8, 32};
  const std::vector<SizedError> found = compression_study(transfer, grid);
  EXPECT_EQ(found.size(), 4U + 2U * 2U + 2U * 2U * 2U * 2U);
  EXPECT_LE(largest_ratio(found, "iterative CPCA", "static CPCA"), 1.0);
  EXPECT_LE(largest_ratio_to_vq(found, "static CPCA", 8), 1.0);
  EXPECT_GT(largest_ratio(found, "static CPCA", "iterative CPCA"), 1.0);  // the comparison can fail
  EXPECT_LE(largest_increase(found, "iterative CPCA", 32), 1e-3);
}

}  // namespace
}  // namespace plumbline::checks
