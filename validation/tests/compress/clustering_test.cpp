#include "prt/compress/clustering.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "prt/compress/distances.hpp"
#include "prt/compress/seeding.hpp"
#include "reference/base/error.hpp"
#include "validation/tests/compress/planted.hpp"

namespace plumbline::compress {
namespace {

std::vector<std::uint32_t> everybody(const Vectors& vectors) {
  std::vector<std::uint32_t> all(vectors.count());
  std::iota(all.begin(), all.end(), 0U);
  return all;
}

ClusterSettings settings_of(int clusters, int components) {
  ClusterSettings settings;
  settings.clusters = clusters;
  settings.components = components;
  settings.least_gain = 0.0;
  return settings;
}

double squared_error(const Vectors& vectors, const Affine& affine) {
  double sum = 0.0;
  for (std::size_t i = 0; i < vectors.count(); ++i) sum += squared_distance(affine, vectors[i]);
  return sum;
}

double dropped(const Affine& affine, std::size_t components) {
  return std::accumulate(affine.eigenvalues.begin() + static_cast<std::ptrdiff_t>(components),
                         affine.eigenvalues.end(), 0.0);
}

/// Rounding of a float, squared: what vectors on an exact subspace lie off it once they are stored, with 4 as the largest coordinate's
/// bound in units of the root mean square.
double storage_bound(const Vectors& vectors) {
  return 16.0 * 0x1p-48 * sum_of_squares(vectors);
}

/// The error may rise by no more than rounding: of n additions in double.
void expect_never_rises(const Clustering& clustering, std::size_t additions) {
  for (std::size_t i = 1; i < clustering.history.size(); ++i) {
    EXPECT_LE(clustering.history[i],
              clustering.history[i - 1] * (1.0 + static_cast<double>(additions) * 0x1p-53))
        << i;
  }
}

TEST(CompressAffine, ErrorIsTheSumOfDroppedEigenvalues) {
  const Planted planted = plant(20, 1, 20, 500, 3.0);
  for (const std::size_t components : {0U, 1U, 5U, 19U, 20U}) {
    const Affine affine = fit_affine(planted.vectors(), everybody(planted.vectors()), components);
    const double total = squared_error(planted.vectors(), affine);
    const Affine none = fit_affine(planted.vectors(), everybody(planted.vectors()), 1);
    // 500 * 20 terms in double, of at most the total scatter.
    EXPECT_NEAR(total, dropped(components == 0 ? none : affine, components), 1e4 * 0x1p-53 * dropped(none, 0))
        << components;
  }
}

TEST(CompressAffine, FewVectorsGiveTheSameAsTheFullScatterMatrix) {
  // 12 vectors of 30 numbers go through the Gram matrix; the same ones five times over through the scatter matrix, whose eigenvalues
  // are five times as large.
  const Planted planted = plant(30, 1, 30, 12, 1.0);
  Planted repeated = planted;
  for (int i = 1; i < 5; ++i)
    repeated.values.insert(repeated.values.end(), planted.values.begin(), planted.values.end());
  const Affine small = fit_affine(planted.vectors(), everybody(planted.vectors()), 6);
  const Affine large = fit_affine(repeated.vectors(), everybody(repeated.vectors()), 6);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(5.0 * small.eigenvalues[k], large.eigenvalues[k], 1e-12 * large.eigenvalues[0]) << k;
    const double cosine =
        std::inner_product(small.axis(k).begin(), small.axis(k).end(), large.axis(k).begin(), 0.0);
    EXPECT_NEAR(std::abs(cosine), 1.0, 1e-9) << k;
  }
}

TEST(CompressAffine, AxesAreOrthonormalAndUnusedOnesZero) {
  const Planted planted = plant(20, 1, 3, 100, 1.0);
  // Rank 3 but for the rounding of the floats, which an exact rank needs to be without.
  std::vector<float> exact(planted.values.size(), 0.0F);
  for (std::size_t i = 0; i < 100; ++i) {
    exact[i * 20 + 4] = static_cast<float>(i % 7);
    exact[i * 20 + 9] = static_cast<float>(i % 3);
  }
  const Vectors vectors{exact, 20};
  const Affine affine = fit_affine(vectors, everybody(vectors), 4);
  for (std::size_t j = 0; j < 4; ++j) {
    for (std::size_t k = 0; k < 4; ++k) {
      const double dot =
          std::inner_product(affine.axis(j).begin(), affine.axis(j).end(), affine.axis(k).begin(), 0.0);
      EXPECT_NEAR(dot, j == k && j < 2 ? 1.0 : 0.0, 1e-13) << j << " " << k;
    }
  }
}

TEST(CompressAffine, ForgettingTheMeanIsSeen) {
  // The planted fault: axes through the origin. The first axis then runs to the mean and one is lost.
  const Planted planted = plant(20, 1, 2, 200, 5.0);
  const Affine right = fit_affine(planted.vectors(), everybody(planted.vectors()), 2);
  EXPECT_LE(squared_error(planted.vectors(), right), storage_bound(planted.vectors()));
  Planted mirrored = planted;  // with x also -x: the mean is 0, and the scatter about the origin the same
  for (const float x : planted.values) mirrored.values.push_back(-x);
  const Affine wrong = fit_affine(mirrored.vectors(), everybody(mirrored.vectors()), 2);
  EXPECT_GT(squared_error(planted.vectors(), wrong), 1e6 * storage_bound(planted.vectors()));
}

TEST(CompressDistances, FloatKernelGivesTheDistancesOfTheDefinition) {
  for (const int components : {0, 1, 2, 5, 8}) {
    const Planted planted = plant(19, 21, static_cast<std::size_t>(components), 6, 2.0, 0.3);
    std::vector<Affine> subspaces;
    for (std::uint32_t s = 0; s < 21; ++s) {
      std::vector<std::uint32_t> members(6);
      std::iota(members.begin(), members.end(), 6 * s);
      subspaces.push_back(fit_affine(planted.vectors(), members, static_cast<std::size_t>(components)));
    }
    const SubspaceTable table = make_table(subspaces, std::vector<double>(19, 0.0));
    const std::size_t stride = table.groups * kGroup;
    std::vector<float> distances(planted.vectors().count() * stride);
    relative_distances(table, planted.values.data(), planted.vectors().count(), distances.data());
    for (std::size_t i = 0; i < planted.vectors().count(); ++i) {
      const double square = sum_of_squares({planted.vectors()[i], 19});
      for (std::size_t s = 0; s < stride; ++s) {
        const double found = static_cast<double>(distances[i * stride + s]) + square;
        if (s >= 21) {
          EXPECT_FALSE(std::isfinite(found));
          continue;
        }
        // 19 + 2 terms of relative rounding 2^-24 in each of 2 + 2 sqrt(components) products of norms of at most 20.
        const double scale = square + sum_of_squares({planted.vectors()[6 * s], 19}) + 100.0;
        EXPECT_NEAR(found, squared_distance(subspaces[s], planted.vectors()[i]),
                    21.0 * 8.0 * 0x1p-24 * 2.0 * scale)
            << components << " " << i << " " << s;
      }
    }
  }
}

TEST(CompressSeeding, SeedsDifferAndFarOnesAreTaken) {
  const Planted planted = plant(10, 8, 0, 50, 10.0, 0.01);
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const std::vector<std::uint32_t> seeds = choose_seeds(planted.vectors(), 8, seed, 0);
    std::vector<bool> is_hit(8, false);
    for (const std::uint32_t s : seeds) is_hit[planted.truth[s]] = true;
    // Within a blob squared distances are 1e-6 of those between: missing one of 8 has a chance below 1e-4.
    EXPECT_EQ(std::count(is_hit.begin(), is_hit.end(), true), 8) << seed;
  }
}

TEST(CompressClustering, FindsPlantedSubspacesToRounding) {
  const Planted planted = plant(24, 7, 3, 80, 6.0);
  const Clustering found = cluster_iteratively(planted.vectors(), settings_of(7, 3));
  EXPECT_LE(found.squared_error, storage_bound(planted.vectors()));
  for (std::size_t i = 1; i < planted.truth.size(); ++i) {
    EXPECT_EQ(planted.truth[i] == planted.truth[i - 1], found.labels[i] == found.labels[i - 1]) << i;
  }
  // Planted faults: an axis too few, a cluster dropped.
  EXPECT_GT(cluster_iteratively(planted.vectors(), settings_of(7, 2)).squared_error,
            1e6 * storage_bound(planted.vectors()));
  EXPECT_GT(cluster_iteratively(planted.vectors(), settings_of(6, 3)).squared_error,
            1e6 * storage_bound(planted.vectors()));
}

TEST(CompressClustering, LongSubspacesNeedTheDistanceToTheSubspace) {
  // Two parallel lines 1 apart and 40 long: clusters by mean cut them across, clusters by subspace find them.
  Planted planted{2, {}, {}};
  for (int i = 0; i < 200; ++i) {
    planted.values.push_back(0.2F * static_cast<float>(i));
    planted.values.push_back(i % 2 == 0 ? 0.0F : 1.0F);
  }
  const Clustering by_mean =
      cluster_static(planted.vectors(), settings_of(2, 1));  // the planted fault: never by subspace
  EXPECT_GT(by_mean.squared_error, 10.0);
  // Lloyd's iteration ends at what is nearest, which from the two halves is where it is: the right lines are held, not found.
  Clustering lines = by_mean;
  for (std::size_t i = 0; i < 200; ++i) lines.labels[i] = i % 2;
  lines = with_components(planted.vectors(), lines, 1, 0);
  const Clustering kept = improve(planted.vectors(), lines, settings_of(2, 1));
  EXPECT_LE(kept.squared_error, storage_bound(planted.vectors()));
  EXPECT_EQ(kept.labels, lines.labels);
}

TEST(CompressClustering, ErrorNeverRisesAndFallsFromMeansToStaticToIterative) {
  const Planted sheet = bent_sheet(12, 1500);
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    ClusterSettings settings = settings_of(12, 2);
    settings.seed = seed;
    const Clustering means = cluster_by_mean(sheet.vectors(), settings);
    const Clustering fixed = cluster_static(sheet.vectors(), settings);
    const Clustering iterative = cluster_iteratively(sheet.vectors(), settings);
    expect_never_rises(means, 1500 * 12);
    expect_never_rises(iterative, 1500 * 12);
    EXPECT_EQ(fixed.labels, means.labels);
    EXPECT_LT(fixed.squared_error, means.squared_error);
    EXPECT_LT(iterative.squared_error, fixed.squared_error);
    EXPECT_GT(iterative.history.size(), 2U);
  }
}

TEST(CompressClustering, EveryVectorEndsInItsNearestSubspace) {
  const Planted sheet = bent_sheet(12, 800);
  const Clustering found = cluster_iteratively(sheet.vectors(), settings_of(9, 2));
  for (std::size_t i = 0; i < found.labels.size(); ++i) {
    const double own = squared_distance(found.clusters[found.labels[i]], sheet.vectors()[i]);
    for (const Affine& other : found.clusters) {
      // Float picks the candidates: what it cannot tell apart may stay.
      EXPECT_LE(own, squared_distance(other, sheet.vectors()[i]) + 1e-4) << i;
    }
  }
}

TEST(CompressClustering, IsTheSameForAnyNumberOfThreads) {
  const Planted sheet = bent_sheet(12, 3000);
  ClusterSettings settings = settings_of(20, 3);
  settings.threads = 1;
  const Clustering one = cluster_iteratively(sheet.vectors(), settings);
  settings.threads = 3;
  const Clustering three = cluster_iteratively(sheet.vectors(), settings);
  EXPECT_EQ(one.labels, three.labels);
  EXPECT_EQ(one.squared_error, three.squared_error);
  EXPECT_EQ(one.history, three.history);
  for (std::size_t c = 0; c < one.clusters.size(); ++c)
    EXPECT_EQ(one.clusters[c].axes, three.clusters[c].axes) << c;
  settings.seed = 1;
  EXPECT_NE(cluster_iteratively(sheet.vectors(), settings).labels, one.labels);
}

TEST(CompressClustering, EmptyClustersGetTheFarthestVectors) {
  // 30 copies of one vector, 30 of another and two outliers: a start that leaves clusters empty is repaired.
  Planted planted{1, {}, {}};
  for (int i = 0; i < 60; ++i) planted.values.push_back(i < 30 ? 0.0F : 1.0F);
  planted.values.insert(planted.values.end(), {50.0F, -70.0F});
  Clustering start;
  start.clusters.assign(4, Affine{{0.0}, {}, {}});
  start.labels.assign(62, 0);
  start.squared_error = 1e9;
  const Clustering found = improve(planted.vectors(), start, settings_of(4, 0));
  EXPECT_EQ(found.squared_error, 0.0);
  for (const auto& members : members_of(found.labels, 4)) EXPECT_FALSE(members.empty());
  // More clusters than different vectors: some stay empty and nothing breaks.
  EXPECT_EQ(cluster_iteratively(planted.vectors(), settings_of(9, 1)).squared_error, 0.0);
}

TEST(CompressClustering, OneClusterIsPlainPca) {
  const Planted planted = plant(15, 3, 4, 60, 1.0);
  const Clustering found = cluster_iteratively(planted.vectors(), settings_of(1, 5));
  const Affine affine = fit_affine(planted.vectors(), everybody(planted.vectors()), 5);
  EXPECT_NEAR(found.squared_error, dropped(affine, 5), 1e-12 * dropped(affine, 0));
}

TEST(CompressClustering, RefusesWhatCannotBe) {
  const Planted planted = plant(5, 1, 1, 10, 1.0);
  EXPECT_THROW((void)cluster_by_mean(planted.vectors(), settings_of(0, 0)), InputError);
  EXPECT_THROW((void)cluster_by_mean(planted.vectors(), settings_of(11, 0)), InputError);
  EXPECT_THROW((void)cluster_static(planted.vectors(), settings_of(2, 6)), InputError);
  EXPECT_THROW((void)cluster_static(planted.vectors(), settings_of(2, -1)), InputError);
}

}  // namespace
}  // namespace plumbline::compress
