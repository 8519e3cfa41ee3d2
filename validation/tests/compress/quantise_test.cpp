#include "prt/compress/quantise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "reference/base/error.hpp"
#include "validation/tests/compress/planted.hpp"

namespace plumbline::compress {
namespace {

transfer::Transfer as_transfer(const Planted& planted, int bands, int channels) {
  transfer::Transfer transfer;
  transfer.bands = bands;
  transfer.channels = channels;
  transfer.vertices = planted.vectors().count();
  transfer.coefficients = planted.values;
  return transfer;
}

CompressSettings settings_of(Method method, int clusters, int components, std::vector<int> bits) {
  CompressSettings settings;
  settings.method = method;
  settings.clusters.clusters = clusters;
  settings.clusters.components = components;
  settings.bits = std::move(bits);
  return settings;
}

TEST(CompressQuantise, LevelsCoverTheRangeWithHalfAStepOfError) {
  for (const int bits : {4, 8, 16}) {
    const Levels levels = levels_for(-0.3, 1.7, bits);
    const int half = 1 << (bits - 1);
    EXPECT_EQ(levels.code(-0.3, bits), -half);
    EXPECT_EQ(levels.code(1.7, bits), half - 1);
    EXPECT_NEAR(levels.value(half - 1, bits), 1.7, 1e-14);
    for (int i = 0; i <= 1000; ++i) {
      const double weight = -0.3 + 0.002 * i;
      EXPECT_LE(std::abs(levels.value(levels.code(weight, bits), bits) - weight), levels.step * (0.5 + 1e-9));
    }
  }
  const Levels same = levels_for(0.5, 0.5, 8);
  EXPECT_EQ(same.value(same.code(0.5, 8), 8), 0.5);
}

TEST(CompressQuantise, MeanSquaredErrorIsStepSquaredOverTwelve) {
  // Weights uniform in [0, 1]: the rounding error is uniform in +-step/2, variance step^2/12, that of its square step^4/180.
  constexpr int kCount = 200000;
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (const int bits : {4, 8, 16}) {
    const Levels levels = levels_for(0.0, 1.0, bits);
    double sum = 0.0;
    double of_wrong = 0.0;  // the planted fault: truncated instead of rounded
    for (int i = 0; i < kCount; ++i) {
      const double weight = uniform(random);
      sum += std::pow(levels.value(levels.code(weight, bits), bits) - weight, 2.0);
      of_wrong += std::pow(std::floor(weight / levels.step) * levels.step - weight, 2.0);
    }
    const double expected = levels.step * levels.step / 12.0;
    const double allowed =
        4.5 * levels.step * levels.step / std::sqrt(180.0 * kCount);  // 4.5 standard errors: 1 in 100,000
    EXPECT_NEAR(sum / kCount, expected, allowed) << bits;
    EXPECT_GT(std::abs(of_wrong / kCount - expected), allowed) << bits;
  }
}

TEST(CompressQuantise, ErrorsOfSubspaceAndWeightsAddUp) {
  // A bent sheet: the subspace leaves an error that quantisation's is orthogonal to.
  const Planted sheet = bent_sheet(27, 4000);
  ClusterSettings settings;
  settings.clusters = 8;
  settings.components = 3;
  const Clustering clustering = cluster_static(sheet.vectors(), settings);
  const std::vector<float> weights = all_weights(sheet.vectors(), clustering, 0);
  const WeightRanges ranges = weight_ranges(clustering, weights, 3);
  const double total = sum_of_squares(sheet.vectors());
  for (const std::vector<int>& bits : {std::vector<int>{4, 4, 4}, {8, 4, 4}, {8, 8, 8}, {16, 8, 4}}) {
    const Compressed compressed = quantise(sheet.vectors(), clustering, bits, 0);
    const double added = expected_squared_error(ranges, bits);
    const double measured =
        compressed.relative_error * compressed.relative_error * total - clustering.squared_error;
    // 4000 errors with squares of relative spread sqrt(144 / 180): 4.5 standard errors of the largest component's mean, and
    // weights that are not spread evenly within a step where steps are coarse.
    EXPECT_NEAR(measured, added, added * 0.1 + 1e-6 * clustering.squared_error)
        << bits[0] << bits[1] << bits[2];
    EXPECT_LE(measured, 3.0 * added * (1.0 + 1e-3) +
                            1e-6 * clustering.squared_error);  // step^2/4, whatever the weights
  }
}

TEST(CompressQuantise, ThirtyTwoBitsLoseNothingButRounding) {
  const Planted planted = plant(27, 5, 4, 60, 40.0);
  const Compressed compressed = compress(as_transfer(planted, 3, 3), settings_of(Method::cpca, 5, 4, {32}));
  // Constants and weights are floats: each of 1 + 4 products errs by 2^-24 relative, of terms within 4 times the vector.
  EXPECT_LE(compressed.relative_error, 5.0 * 4.0 * 2.0 * 0x1p-24);
  EXPECT_EQ(compressed.bits, std::vector<int>(4, 32));
  EXPECT_EQ(decode(compressed).size(), planted.values.size());
}

TEST(CompressQuantise, ErrorFallsAsBitsRise) {
  const Planted planted = plant(27, 5, 4, 200, 40.0);
  const transfer::Transfer transfer = as_transfer(planted, 3, 3);
  double last = INFINITY;
  for (const int bits : {4, 8, 16, 32}) {
    const Compressed compressed = compress(transfer, settings_of(Method::cpca, 5, 4, {bits}));
    EXPECT_LT(compressed.relative_error, last / 8.0) << bits;
    last = compressed.relative_error;
    EXPECT_NO_THROW(validate(compressed, "test"));
  }
}

TEST(CompressQuantise, FallingBitsKeepEachComponentBelowTheFirst) {
  const Planted sheet = bent_sheet(27, 4000, 0.7);
  CompressSettings settings = settings_of(Method::pca, 1, 12, {8});
  const Compressed all = compress(as_transfer(sheet, 3, 3), settings);
  settings.has_falling_bits = true;
  const Compressed falling = compress(as_transfer(sheet, 3, 3), settings);
  EXPECT_EQ(falling.bits.front(), 8);
  EXPECT_EQ(falling.bits.back(), 4);
  EXPECT_LT(bytes_per_vertex(falling), bytes_per_vertex(all));
  // Each component adds no more than the first: the squared error that quantisation adds is at most 12 times the first's.
  const double total = sum_of_squares(sheet.vectors());
  const double added =
      std::pow(falling.relative_error, 2.0) - std::pow(falling.clustering_relative_error, 2.0);
  ClusterSettings pca;
  pca.clusters = 1;
  pca.components = 12;
  const Clustering clustering = cluster_static(sheet.vectors(), pca);
  const WeightRanges ranges = weight_ranges(clustering, all_weights(sheet.vectors(), clustering, 0), 12);
  EXPECT_LE(added * total, 12.0 * expected_squared_error(ranges, {8}) * 1.1);
}

TEST(CompressQuantise, VectorQuantisationGivesClusterMeans) {
  const Planted planted = plant(9, 6, 0, 40, 5.0);  // 6 different vectors
  const Compressed compressed = compress(as_transfer(planted, 3, 1), settings_of(Method::vq, 6, 12, {8}));
  EXPECT_EQ(compressed.components(), 0U);
  EXPECT_EQ(decode(compressed), planted.values);
  EXPECT_EQ(bytes_per_vertex(compressed), (6.0 * 9.0 * 4.0 + 240.0) / 240.0);
}

TEST(CompressQuantise, BytesCountConstantsLabelsAndCodes) {
  EXPECT_EQ(bytes_per_vertex(1000, 75, 256, std::vector<int>(12, 8)),
            (256.0 * 13.0 * 300.0 + 1000.0 * 13.0) / 1000.0);
  EXPECT_EQ(bytes_per_vertex(1000, 75, 257, {32, 16, 4}),
            (257.0 * 4.0 * 300.0 + 1000.0 * (2.0 + 4.0 + 2.0 + 0.5)) / 1000.0);
  EXPECT_EQ(bytes_per_vertex(3, 75, 1, {4}), (2.0 * 300.0 + 2.0) / 3.0);
}

TEST(CompressQuantise, RefusesBitsThatAreNone) {
  const transfer::Transfer transfer = as_transfer(plant(9, 2, 1, 20, 1.0), 3, 1);
  EXPECT_THROW((void)compress(transfer, settings_of(Method::cpca, 2, 1, {7})), InputError);
  EXPECT_THROW((void)compress(transfer, settings_of(Method::cpca, 2, 1, {})), InputError);
  EXPECT_THROW((void)compress(transfer, settings_of(Method::cpca, 2, 1, {8, 8})), InputError);
  CompressSettings falling = settings_of(Method::cpca, 2, 2, {32});
  falling.has_falling_bits = true;
  EXPECT_THROW((void)compress(transfer, falling), InputError);
}

TEST(CompressQuantise, ValidateRefusesDamage) {
  const transfer::Transfer transfer = as_transfer(plant(9, 2, 2, 20, 1.0), 3, 1);
  const Compressed good = compress(transfer, settings_of(Method::cpca, 2, 2, {8}));
  const auto refused = [&](auto&& damage) {
    Compressed bad = good;
    damage(bad);
    EXPECT_THROW(validate(bad, "test"), InputError);
  };
  refused([](Compressed& c) { c.labels[3] = 2; });
  refused([](Compressed& c) { c.means[0] = NAN; });
  refused([](Compressed& c) { c.axes[0] = INFINITY; });
  refused([](Compressed& c) { c.codes.pop_back(); });
  refused([](Compressed& c) { c.bits[0] = 12; });
  refused([](Compressed& c) { c.clusters = 3; });
}

}  // namespace
}  // namespace plumbline::compress
