#include "prt/compress/seams.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace plumbline::compress {
namespace {

TEST(CompressSeams, CountsEachEdgeOnceAndSplitsJumps) {
  // Two triangles share edge 1-2; vertex 3 is in a cluster of its own.
  const std::vector<glm::uvec3> triangles{{0, 1, 2}, {2, 1, 3}};
  const std::vector<std::uint16_t> labels{0, 0, 0, 1};
  const std::vector<float> exact{0.0F, 1.0F, 2.0F, 4.0F};
  const std::vector<float> changed{0.0F, 1.0F, 2.5F, 5.0F};
  const Seams seams = measure_seams(triangles, labels, {exact, 1}, {changed, 1});
  EXPECT_EQ(seams.inner_edges, 3U);
  EXPECT_EQ(seams.border_edges, 2U);
  EXPECT_DOUBLE_EQ(seams.exact_jump, std::sqrt((3.0 * 3.0 + 2.0 * 2.0) / 2.0));
  EXPECT_DOUBLE_EQ(seams.border_jump, std::sqrt((4.0 * 4.0 + 2.5 * 2.5) / 2.0));
  EXPECT_DOUBLE_EQ(seams.border_added, std::sqrt((1.0 + 0.25) / 2.0));
  EXPECT_DOUBLE_EQ(seams.inner_added, std::sqrt((0.25 + 0.25 + 0.0) / 3.0));
}

TEST(CompressSeams, ASharedErrorIsNoSeam) {
  const std::vector<glm::uvec3> triangles{{0, 1, 2}};
  const std::vector<std::uint16_t> labels{0, 1, 2};
  const std::vector<float> exact{0.0F, 1.0F, 2.0F};
  const std::vector<float> shifted{5.0F, 6.0F, 7.0F};
  const Seams seams = measure_seams(triangles, labels, {exact, 1}, {shifted, 1});
  EXPECT_EQ(seams.border_added, 0.0);
  EXPECT_EQ(seams.inner_edges, 0U);
  EXPECT_EQ(seams.inner_added, 0.0);
}

}  // namespace
}  // namespace plumbline::compress
