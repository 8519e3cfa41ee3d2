#include "validation/checks/gl_storage.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "gl_context.hpp"
#include "gl_scenes.hpp"
#include "reference/base/error.hpp"

namespace plumbline::checks {
namespace {

using relight::gl::Provider;
using relight::gl::Storage;
using relight::gl::Target;

transfer::Transfer of(std::vector<float> coefficients) {
  transfer::Transfer transfer;
  transfer.bands = 1;
  transfer.vertices = coefficients.size();
  transfer.coefficients = std::move(coefficients);
  return transfer;
}

template <class Stored>
Stored stored_at(const relight::gl::PackedTransfer& packed, std::size_t place) {
  Stored value{};
  std::memcpy(&value, packed.bytes.data() + place * sizeof(Stored), sizeof(Stored));
  return value;
}

TEST(GlStorage, VectorsArePaddedToWholeTexels) {
  const auto packed = relight::gl::pack(of({1.0F, 2.0F}), Storage::f32);
  EXPECT_EQ(packed.texels, 1U);
  ASSERT_EQ(packed.bytes.size(), 32U);
  EXPECT_EQ(stored_at<float>(packed, 0), 1.0F);
  EXPECT_EQ(stored_at<float>(packed, 1), 0.0F);
  EXPECT_EQ(stored_at<float>(packed, 4), 2.0F);
}

TEST(GlStorage, UnormSpansItsRangeExactly) {
  const auto packed = relight::gl::pack(of({-1.0F, 0.0F, 3.0F}), Storage::unorm8);
  EXPECT_EQ(packed.offsets[0], -1.0F);
  EXPECT_EQ(packed.scales[0], 4.0F);
  EXPECT_EQ(stored_at<std::uint8_t>(packed, 0), 0);
  EXPECT_EQ(stored_at<std::uint8_t>(packed, 4), 64);  // 63.75
  EXPECT_EQ(stored_at<std::uint8_t>(packed, 8), 255);
  const auto constant = relight::gl::pack(of({0.5F, 0.5F}), Storage::unorm16);
  EXPECT_EQ(constant.offsets[0], 0.5F);
  EXPECT_EQ(constant.scales[0], 0.0F);
  EXPECT_EQ(stored_at<std::uint16_t>(constant, 4), 0);
}

TEST(GlStorage, HalfRoundsToNearestAndRefusesWhatItCannotHold) {
  const auto packed = relight::gl::pack(of({1.0F, 65504.0F, 65519.0F, 1.0F + 0x1p-11F}), Storage::f16);
  EXPECT_EQ(stored_at<std::uint16_t>(packed, 0), 0x3C00);
  EXPECT_EQ(stored_at<std::uint16_t>(packed, 4), 0x7BFF);
  EXPECT_EQ(stored_at<std::uint16_t>(packed, 8), 0x7BFF);
  EXPECT_EQ(stored_at<std::uint16_t>(packed, 12), 0x3C00);  // half way: to even
  EXPECT_THROW((void)relight::gl::pack(of({65520.0F}), Storage::f16), InputError);
}

TEST(GlStorage, NamesAreReadBack) {
  for (const Storage storage : relight::gl::kStorages)
    EXPECT_EQ(relight::gl::storage_from_string(relight::gl::to_string(storage)), storage);
  EXPECT_THROW((void)relight::gl::storage_from_string("f8"), InputError);
  for (const Target target : {Target::f32, Target::f16})
    EXPECT_EQ(relight::gl::target_from_string(relight::gl::to_string(target)), target);
  EXPECT_THROW((void)relight::gl::target_from_string("f8"), InputError);
}

class GlStorageOn : public test::OnEachProvider {};
INSTANTIATE_TEST_SUITE_P(Providers, GlStorageOn, testing::Values(Provider::osmesa, Provider::egl),
                         test::name_of);

// A stored coefficient is off by half a step at most: 2^-11 of itself as a half (above its least normal number), 1/510 or
// 1/131070 of its range as a unorm, and sums cannot add more than that of each term.
TEST_P(GlStorageOn, ErrorsStayWithinHalfAStep) {
  const auto context = test::context_of(GetParam());
  if (!context) return;
  const test::RelitScene s = test::textures();
  const std::vector<StorageError> errors = storage_errors(*context, s.baked, s.lighting);
  ASSERT_EQ(errors.size(), 4U);
  EXPECT_EQ(errors[0].relative_rmse, 0.0);
  EXPECT_EQ(errors[0].bytes_per_vertex, 3U * 12U * 4U);
  EXPECT_EQ(errors[1].bytes_per_vertex, 3U * 12U * 2U);
  EXPECT_EQ(errors[3].bytes_per_vertex, 3U * 12U);
  EXPECT_LE(errors[1].of_terms, std::ldexp(1.0, -11) * (1.0 + 1e-3));
  EXPECT_GT(errors[1].of_terms, 0.0);
  // Whole steps of 16 and of 8 bits are 257 times apart, and so are their errors, up to chance.
  EXPECT_GT(errors[3].relative_rmse, 50.0 * errors[2].relative_rmse);
  EXPECT_GT(errors[2].relative_rmse, 0.0);

  std::vector<double> steps(27, 0.0);  // half of each coefficient's unorm8 step, [channel][coefficient]
  const transfer::Transfer& transfer = s.baked.transfer;
  for (std::size_t k = 0; k < 27; ++k) {
    float low = transfer.coefficients[k];
    float high = low;
    for (std::size_t v = 0; v < transfer.vertices; ++v) {
      low = std::min(low, transfer.coefficients[v * 27 + k]);
      high = std::max(high, transfer.coefficients[v * 27 + k]);
    }
    steps[k] = (static_cast<double>(high) - static_cast<double>(low)) / 510.0;
  }
  relight::gl::Renderer exact(*context, s.baked.scene, transfer, {});
  relight::gl::Renderer stored(*context, s.baked.scene, transfer, {Storage::unorm8});
  exact.set_light(s.lighting);
  stored.set_light(s.lighting);
  const std::vector<Rgb> a = exact.unit_albedo_exit_radiance();
  const std::vector<Rgb> b = stored.unit_albedo_exit_radiance();
  for (int c = 0; c < 3; ++c) {
    double bound = 0.0;
    for (std::size_t i = 0; i < 9; ++i)
      bound += steps[static_cast<std::size_t>(c) * 9 + i] * std::abs(s.lighting.coefficients[i][c]);
    double worst = 0.0;
    for (std::size_t v = 0; v < a.size(); ++v)
      worst = std::max(worst, std::abs(static_cast<double>(a[v][c]) - static_cast<double>(b[v][c])));
    EXPECT_LE(worst, bound * (1.0 + 1e-4));  // and float rounding
    EXPECT_GT(worst, 0.05 * bound);
  }
}

TEST_P(GlStorageOn, RadianceEndsWhereTheTargetEnds) {
  const auto context = test::context_of(GetParam());
  if (!context) return;
  const test::RelitScene s = test::textures();
  const std::vector<TargetRange> ranges =
      target_ranges(*context, s.baked, s.lighting, s.baked.scene.cameras.front());
  ASSERT_EQ(ranges.size(), 2U);
  // Vertices reach the end of floats first, and are then dimmed by the albedo and turned by interpolation.
  EXPECT_LE(ranges[0].largest_radiance, static_cast<double>(std::numeric_limits<float>::max()));
  EXPECT_GE(ranges[0].largest_radiance, 1e36);
  EXPECT_LE(ranges[1].largest_radiance, 65504.0);
  EXPECT_GE(ranges[1].largest_radiance, 65504.0 * (1.0 - std::ldexp(1.0, -10)));
  EXPECT_LT(ranges[1].light_scale, 1e-30 * ranges[0].light_scale);
  sh::ShRgb black = s.lighting;
  for (RgbD& l : black.coefficients) l = RgbD(0.0);
  EXPECT_THROW((void)target_ranges(*context, s.baked, black, s.baked.scene.cameras.front()), InputError);
}

}  // namespace
}  // namespace plumbline::checks
