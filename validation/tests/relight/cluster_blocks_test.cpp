#include "prt/relight/cluster_blocks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "prt/compress/quantise.hpp"
#include "reference/base/error.hpp"
#include "validation/tests/compress/planted.hpp"

namespace plumbline::relight {
namespace {

transfer::Transfer as_transfer(const compress::Planted& planted, int bands, int channels) {
  transfer::Transfer transfer;
  transfer.bands = bands;
  transfer.channels = channels;
  transfer.vertices = planted.vectors().count();
  transfer.coefficients = planted.values;
  return transfer;
}

compress::Compressed compressed_of(const transfer::Transfer& transfer, compress::Method method,
                                   int components, std::vector<int> bits) {
  compress::CompressSettings settings;
  settings.method = method;
  settings.clusters.clusters = 7;
  settings.clusters.components = components;
  settings.bits = std::move(bits);
  return compress::compress(transfer, settings);
}

sh::ShRgb light_of(int bands) {
  sh::ShRgb light{bands, {}};
  for (int i = 0; i < bands * bands; ++i)
    light.coefficients.emplace_back(std::cos(i), std::sin(2 * i), 1.0 / (1 + i));
  return light;
}

/// sum_k |code_k e_ck| + |e_c| <= (K + 1) times the largest |T_v . l| that a code of full scale gives; here a bound of it that needs no
/// decoding: every vector within 30 in length, the light within 4, codes' sums within K + 1 such vectors; 2^-24 for each of K + 2
/// roundings, and the decoded vector's own rounding.
double bound(std::size_t components) {
  const double k = static_cast<double>(components);
  return (k + 4.0) * 0x1p-24 * (k + 1.0) * 30.0 * 4.0;
}

void expect_equals_decoded(const compress::Compressed& compressed, const transfer::Transfer& like) {
  transfer::Transfer decoded = like;
  decoded.coefficients = compress::decode(compressed);
  const sh::ShRgb light = light_of(like.bands);
  const std::vector<Rgb> expected = unit_albedo_exit_radiance(decoded, light);
  const std::vector<Rgb> found = unit_albedo_exit_radiance(make_cluster_blocks(compressed, like), light);
  for (std::size_t v = 0; v < expected.size(); ++v) {
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(found[v][c], expected[v][c], bound(compressed.components())) << v << " " << c;
  }
}

TEST(RelightClusters, EqualsTheDecodedTransferForEveryForm) {
  const transfer::Transfer rgb = as_transfer(compress::bent_sheet(27, 403), 3, 3);
  const transfer::Transfer gray = as_transfer(compress::bent_sheet(16, 403), 4, 1);
  for (const compress::Method method :
       {compress::Method::vq, compress::Method::pca, compress::Method::cpca}) {
    for (const std::vector<int>& bits : {std::vector<int>{4}, {8}, {16}, {32}, {32, 16, 8, 4}}) {
      expect_equals_decoded(compressed_of(rgb, method, 5, bits), rgb);
      expect_equals_decoded(compressed_of(gray, method, 4, bits), gray);
    }
  }
}

TEST(RelightClusters, DroppedComponentIsSeen) {
  // The planted fault: the last component's codes read as 0.
  const transfer::Transfer rgb = as_transfer(compress::bent_sheet(27, 403), 3, 3);
  compress::Compressed compressed = compressed_of(rgb, compress::Method::cpca, 5, {8});
  const std::vector<Rgb> right = unit_albedo_exit_radiance(make_cluster_blocks(compressed, rgb), light_of(3));
  std::fill(compressed.codes.end() - 403, compressed.codes.end(), std::uint8_t{0});
  const std::vector<Rgb> wrong = unit_albedo_exit_radiance(make_cluster_blocks(compressed, rgb), light_of(3));
  double largest = 0.0;
  for (std::size_t v = 0; v < right.size(); ++v)
    largest = std::max(largest, std::abs(static_cast<double>(right[v].x - wrong[v].x)));
  EXPECT_GT(largest, 10.0 * bound(5));
}

TEST(RelightClusters, IsTheSameForAnyNumberOfThreads) {
  const transfer::Transfer rgb = as_transfer(compress::bent_sheet(27, 20000), 3, 3);
  const ClusterBlocks blocks = make_cluster_blocks(compressed_of(rgb, compress::Method::cpca, 4, {8}), rgb);
  const std::vector<Rgb> one = unit_albedo_exit_radiance(blocks, light_of(3), 1);
  EXPECT_EQ(one, unit_albedo_exit_radiance(blocks, light_of(3), 3));
}

TEST(RelightClusters, RefusesShapesThatDisagree) {
  const transfer::Transfer rgb = as_transfer(compress::bent_sheet(27, 100), 3, 3);
  const compress::Compressed compressed = compressed_of(rgb, compress::Method::cpca, 4, {8});
  transfer::Transfer other = rgb;
  other.bands = 4;
  EXPECT_THROW((void)make_cluster_blocks(compressed, other), InputError);
  const ClusterBlocks blocks = make_cluster_blocks(compressed, rgb);
  EXPECT_THROW((void)unit_albedo_exit_radiance(blocks, light_of(2)), InputError);
  std::vector<Rgb> few(99);
  EXPECT_THROW(unit_albedo_exit_radiance(blocks, light_of(3), few), InputError);
}

}  // namespace
}  // namespace plumbline::relight
