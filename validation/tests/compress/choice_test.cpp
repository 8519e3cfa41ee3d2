#include "prt/compress/choice.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "reference/base/error.hpp"
#include "validation/tests/compress/planted.hpp"

namespace plumbline::compress {
namespace {

transfer::Transfer as_transfer(const Planted& planted) {
  transfer::Transfer transfer;
  transfer.bands = 3;
  transfer.channels = 3;
  transfer.vertices = planted.vectors().count();
  transfer.coefficients = planted.values;
  return transfer;
}

ChoiceSettings settings_of(Method method, double target) {
  ChoiceSettings settings;
  settings.method = method;
  settings.target_error = target;
  return settings;
}

TEST(CompressChoice, KeepsTheErrorAndGrowsAsItFalls) {
  const transfer::Transfer transfer = as_transfer(bent_sheet(27, 1000, 1.5));
  for (const Method method : {Method::pca, Method::cpca}) {
    double last = 0.0;
    for (const double target : {0.2, 0.05, 0.01, 0.002}) {
      const std::optional<Choice> choice = choose(transfer, settings_of(method, target));
      ASSERT_TRUE(choice.has_value()) << target;
      EXPECT_LE(choice->compressed.relative_error, target);
      EXPECT_GT(bytes_per_vertex(choice->compressed), last) << target;
      last = bytes_per_vertex(choice->compressed);
    }
  }
}

TEST(CompressChoice, NoSmallerCandidateIsExpectedToHold) {
  const transfer::Transfer transfer = as_transfer(bent_sheet(27, 1000, 1.5));
  ChoiceSettings settings = settings_of(Method::cpca, 0.02);
  settings.is_iterative = false;
  const std::optional<Choice> choice = choose(transfer, settings);
  ASSERT_TRUE(choice.has_value());
  const double size = bytes_per_vertex(choice->compressed);
  int smaller = 0;
  for (const Candidate& candidate : choice->candidates) {
    if (candidate.bytes_per_vertex >= size) break;
    ++smaller;
    // The expected error is exact but for how weights lie within a step.
    EXPECT_GT(candidate.expected_error, 0.02 * 0.99);
  }
  EXPECT_GT(smaller, 0);
  settings.is_iterative = true;
  const std::optional<Choice> iterative = choose(transfer, settings);
  ASSERT_TRUE(iterative.has_value());
  EXPECT_LE(bytes_per_vertex(iterative->compressed), size);
}

TEST(CompressChoice, ExpectsWhatIsMeasured) {
  const transfer::Transfer transfer = as_transfer(bent_sheet(27, 1000, 1.5));
  const std::optional<Choice> choice = choose(transfer, settings_of(Method::pca, 0.02));
  ASSERT_TRUE(choice.has_value());
  for (const Candidate& candidate : choice->candidates) {
    if (candidate.bits.size() % 5 != 1) continue;
    CompressSettings settings;
    settings.method = Method::pca;
    settings.clusters.components = static_cast<int>(candidate.bits.size());
    settings.bits = candidate.bits;
    // A few per cent for the weights' places within steps, and float rounding where nothing else is left.
    EXPECT_NEAR(compress(transfer, settings).relative_error, candidate.expected_error,
                0.03 * candidate.expected_error + 1e-6);
  }
}

TEST(CompressChoice, SaysSoWhenNothingGetsThere) {
  const transfer::Transfer transfer = as_transfer(bent_sheet(27, 1000));
  EXPECT_FALSE(choose(transfer, settings_of(Method::vq, 1e-3)).has_value());
  EXPECT_THROW((void)choose(transfer, settings_of(Method::vq, 0.0)), InputError);
  EXPECT_THROW((void)choose(transfer, settings_of(Method::vq, NAN)), InputError);
}

}  // namespace
}  // namespace plumbline::compress
