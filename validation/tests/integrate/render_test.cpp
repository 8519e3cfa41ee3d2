#include "reference/integrate/render.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "pieces.hpp"
#include "reference/base/error.hpp"
#include "reference/image/exr.hpp"
#include "reference/integrate/shards.hpp"
#include "reference/scene/builtin.hpp"
#include "reference/scene/load.hpp"
#include "validation/metrics/statistics.hpp"

namespace plumbline::integrate {
namespace {

const World& cornell() {
  static const World world(scene::make_builtin_scene("cornell"), test::no_sky());
  return world;
}

RenderSettings small(std::uint64_t seed) {
  RenderSettings settings;
  settings.width = 40;
  settings.height = 36;
  settings.samples_per_pixel = 32;
  settings.seed = seed;
  return settings;
}

bool is_bit_identical(const image::LayeredImage& a, const image::LayeredImage& b) {
  if (a.channels.size() != b.channels.size()) return false;
  for (const auto& [name, values] : a.channels) {
    const auto other = b.channels.find(name);
    if (other == b.channels.end() || other->second.size() != values.size()) return false;
    if (std::memcmp(values.data(), other->second.data(), values.size() * sizeof(float)) != 0) return false;
  }
  return true;
}

TEST(Render, IsBitIdenticalForAnyNumberOfThreads) {
  RenderSettings settings = small(1);
  settings.layers = {true, true, true, true, true, true, true, true, true};
  settings.threads = 1;
  const RenderResult one = render(cornell(), cornell().scene.cameras[0], settings);
  for (const int threads : {2, 7}) {
    settings.threads = threads;
    EXPECT_TRUE(is_bit_identical(one.image, render(cornell(), cornell().scene.cameras[0], settings).image))
        << threads;
  }
  settings.seed = 2;
  EXPECT_FALSE(is_bit_identical(one.image, render(cornell(), cornell().scene.cameras[0], settings).image));
}

TEST(Render, ShardsMergeToTheSameBits) {
  RenderSettings settings = small(4);
  settings.layers.bounces = true;
  const RenderResult whole = render(cornell(), cornell().scene.cameras[0], settings);
  for (const int count : {1, 3, 16}) {
    std::vector<image::LayeredImage> parts;
    std::vector<std::string> names;
    for (int i = count - 1; i >= 0; --i) {
      settings.shard = {i, count};
      parts.push_back(render(cornell(), cornell().scene.cameras[0], settings).image);
      parts.back().attributes[kShardAttribute] = std::to_string(i) + "/" + std::to_string(count);
      names.push_back("part" + std::to_string(i));
    }
    EXPECT_TRUE(is_bit_identical(whole.image, merge_shards(parts, names))) << count;
    if (count == 1) continue;
    std::vector<image::LayeredImage> missing(parts.begin() + 1, parts.end());
    EXPECT_THROW((void)merge_shards(missing, names), InputError);
    std::vector<image::LayeredImage> twice = parts;
    twice[0] = twice[1];
    EXPECT_THROW((void)merge_shards(twice, names), InputError);
    std::vector<image::LayeredImage> other = parts;
    other[0].attributes["plumbline.seed"] = "9";
    EXPECT_THROW((void)merge_shards(other, names), InputError);
  }
}

// Two images of different seeds: the differences of 6 x 6 blocks in units of their standard errors are
// standard normal.
TEST(Render, TwoSeedsDifferByWhatTheirStandardErrorsSay) {
  std::vector<double> p;
  for (std::uint64_t pair = 0; pair < 6; ++pair) {
    const RenderResult a = render(cornell(), cornell().scene.cameras[0], small(100 + 2 * pair));
    const RenderResult b = render(cornell(), cornell().scene.cameras[0], small(101 + 2 * pair));
    const auto& mean_a = a.image.channels.at("G");
    const auto& mean_b = b.image.channels.at("G");
    const auto& se_a = a.image.channels.at("stderr.G");
    const auto& se_b = b.image.channels.at("stderr.G");
    for (int by = 0; by < 36; by += 6) {
      for (int bx = 0; bx < 36; bx += 6) {
        double difference = 0.0;
        double variance = 0.0;
        for (int k = 0; k < 36; ++k) {
          const auto i = static_cast<std::size_t>((by + k / 6) * 40 + bx + k % 6);
          difference += static_cast<double>(mean_a[i]) - static_cast<double>(mean_b[i]);
          variance += std::pow(static_cast<double>(se_a[i]), 2) + std::pow(static_cast<double>(se_b[i]), 2);
        }
        if (variance > 0.0) p.push_back(metrics::two_sided_p(difference / std::sqrt(variance)));
      }
    }
  }
  EXPECT_GE(p.size(), 180U);
  EXPECT_GE(metrics::kolmogorov_smirnov_uniform(p).p, 1e-3);
  // The same scores with standard errors 1.5 times too small are caught.
  std::vector<double> wrong;
  for (const double value : p) wrong.push_back(metrics::two_sided_p(1.5 * metrics::two_sided_z(value)));
  EXPECT_LE(metrics::kolmogorov_smirnov_uniform(wrong).p, 1e-3);
}

TEST(Render, LayersAddUpToTheMean) {
  RenderSettings settings = small(3);
  settings.layers.bounces = true;
  settings.layers.emission = true;
  for (const int bounces : {0, 2, kAllBounces}) {
    settings.max_bounces = bounces;
    const image::LayeredImage image = render(cornell(), cornell().scene.cameras[0], settings).image;
    EXPECT_EQ(image.channels.contains("bounce1.R"), bounces != 0);
    for (std::size_t p = 0; p < image.channels.at("G").size(); ++p) {
      double sum = image.channels.at("emission.G")[p];
      for (const auto& [name, values] : image.channels) {
        if (name.starts_with("bounce") && name.ends_with(".G")) sum += values[p];
      }
      const double mean = image.channels.at("G")[p];
      EXPECT_LE(std::abs(sum - mean), 1e-6 * 20 * (1.0 + mean));  // 20 layers rounded to float
    }
  }
}

TEST(Render, DirectAndIndirectAddUpToTheMean) {
  RenderSettings settings = small(3);
  settings.layers.bounces = settings.layers.emission = true;
  settings.layers.direct = settings.layers.indirect = true;
  const image::LayeredImage image = render(cornell(), cornell().scene.cameras[0], settings).image;
  double most_indirect = 0.0;
  for (std::size_t p = 0; p < image.channels.at("G").size(); ++p) {
    const auto value = [&](const char* channel) {
      return static_cast<double>(image.channels.at(channel)[p]);
    };
    const double mean = value("G");
    // Four layers rounded to float.
    EXPECT_LE(std::abs(value("direct.G") + value("indirect.G") + value("emission.G") - mean),
              2.4e-7 * (1.0 + mean));
    EXPECT_EQ(value("direct.G"), value("bounce0.G"));
    most_indirect = std::max(most_indirect, value("indirect.G"));
  }
  EXPECT_GT(most_indirect, 0.01);
  settings.max_bounces = 0;
  const image::LayeredImage direct = render(cornell(), cornell().scene.cameras[0], settings).image;
  for (const float v : direct.channels.at("indirect.G")) EXPECT_EQ(v, 0.0F);
}

TEST(Render, HalvesAverageToTheMean) {
  RenderSettings settings = small(3);
  settings.layers.halves = true;
  for (const int samples : {2, 6, 16, 38}) {
    settings.samples_per_pixel = samples;
    const image::LayeredImage image = render(cornell(), cornell().scene.cameras[0], settings).image;
    bool is_any_different = false;
    for (std::size_t p = 0; p < image.channels.at("G").size(); ++p) {
      const double a = image.channels.at("a.G")[p];
      const double b = image.channels.at("b.G")[p];
      const double mean = image.channels.at("G")[p];
      EXPECT_LE(std::abs(0.5 * (a + b) - mean), 1.2e-7 * (a + b));  // three floats
      is_any_different |= a != b;
    }
    EXPECT_TRUE(is_any_different);
  }
  settings.samples_per_pixel = 1;
  EXPECT_THROW((void)render(cornell(), cornell().scene.cameras[0], settings), InputError);
}

/// Correlation of two channels over renders of different seeds, one value a pixel that varies.
std::vector<double> correlations(const std::vector<image::LayeredImage>& images, const char* first,
                                 const char* second) {
  std::vector<double> result;
  const double n = static_cast<double>(images.size());
  for (std::size_t p = 0; p < images[0].channels.at("G").size(); ++p) {
    double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
    for (const auto& image : images) {
      x += static_cast<double>(image.channels.at(first)[p]) / n;
      y += static_cast<double>(image.channels.at(second)[p]) / n;
    }
    for (const auto& image : images) {
      const double dx = static_cast<double>(image.channels.at(first)[p]) - x;
      const double dy = static_cast<double>(image.channels.at(second)[p]) - y;
      xx += dx * dx;
      xy += dx * dy;
      yy += dy * dy;
    }
    if (xx > 0.0 && yy > 0.0) result.push_back(xy / std::sqrt(xx * yy));
  }
  return result;
}

// The sample correlation of independent values has mean 0 whatever their distribution, and pixels are
// independent of each other: its mean over pixels in standard errors is standard normal. That of a half and the
// mean is about 0.7.
TEST(Render, HalvesAreIndependent) {
  RenderSettings settings = small(0);
  settings.width = 24;
  settings.height = 20;
  settings.layers.halves = true;
  std::vector<image::LayeredImage> images;
  for (std::uint64_t seed = 1000; seed < 1024; ++seed) {
    settings.seed = seed;
    images.push_back(render(cornell(), cornell().scene.cameras[0], settings).image);
  }
  const metrics::Estimate halves = metrics::estimate(correlations(images, "a.G", "b.G"));
  EXPECT_LE(std::abs(halves.mean), 4.0 * halves.standard_error);
  EXPECT_LE(halves.standard_error, 0.0125);  // a correlation of 0.1 would be seen
  const metrics::Estimate with_mean = metrics::estimate(correlations(images, "a.G", "G"));
  EXPECT_GE(with_mean.mean, 0.5);
}

TEST(Render, TargetErrorIsReachedAndSaid) {
  RenderSettings settings = small(5);
  settings.target_error = 0.05;
  const RenderResult result = render(cornell(), cornell().scene.cameras[0], settings);
  EXPECT_EQ(result.stop, StopReason::target_error);
  EXPECT_LE(result.relative_error, 0.05);
  EXPECT_GT(result.relative_error, 0.01);  // and not wildly overdone
  double variance = 0.0;
  double mean = 0.0;
  for (const char* c : {"R", "G", "B"}) {
    for (const float v : result.image.channels.at(c)) mean += static_cast<double>(v);
    for (const float v : result.image.channels.at(std::string("stderr.") + c))
      variance += static_cast<double>(v) * static_cast<double>(v);
  }
  const double n = 3.0 * 40 * 36;
  EXPECT_LE(std::abs(std::sqrt(variance / n) / (mean / n) - result.relative_error), 1e-5);
}

// Samples go where the noise is: to the box, not to the black around it.
TEST(Render, TargetErrorSpendsSamplesWhereTheNoiseIs) {
  RenderSettings settings = small(8);
  settings.target_error = 0.01;
  const RenderResult result = render(cornell(), cornell().scene.cameras[0], settings);
  const std::vector<float>& samples = result.image.channels.at("samples");
  const auto [fewest, most] = std::minmax_element(samples.begin(), samples.end());
  EXPECT_GE(*most, 2.0F * *fewest);
  EXPECT_GE(*fewest, 2.0F);
}

// Means over 40 seeds of images made towards a target against one long even run: were the pilot part of the image, or a
// pixel's own noise to decide when it stops, dark pixels would be left early and the mean would be low.
TEST(Render, TargetErrorLeavesTheMeanUnbiased) {
  const World& world = cornell();
  RenderSettings settings = small(9);
  settings.width = settings.height = 12;
  settings.samples_per_pixel = 4096;
  const RenderResult truth = render(world, world.scene.cameras[0], settings);
  settings.target_error = 0.08;
  std::vector<double> means;
  for (std::uint64_t seed = 100; seed < 140; ++seed) {
    settings.seed = seed;
    means.push_back(render(world, world.scene.cameras[0], settings).mean_radiance);
  }
  double sum = 0.0;
  double squares = 0.0;
  for (const double mean : means) sum += mean;
  const double mean = sum / static_cast<double>(means.size());
  for (const double value : means) squares += (value - mean) * (value - mean);
  const double n = static_cast<double>(means.size());
  const double error =
      std::hypot(std::sqrt(squares / (n * (n - 1.0))), truth.relative_error * truth.mean_radiance / 12.0);
  EXPECT_LE(std::abs(mean - truth.mean_radiance), 4.0 * error);
  EXPECT_LE(4.0 * error, 0.02 * mean) << "two per cent would not show";
}

// Two randomisations leave one degree of freedom a pixel; over 24 seeds the claimed variance and the spread from seed to seed
// must be the same. Each pixel's ratio is known to 0.3 (23 degrees of freedom), 576 of them to 0.0125, a few times that
// for the heavy tails at the lamp's edge: 0.8 and 1.25 are about five deviations. An error 1.5 times too small gives 2.25.
TEST(Render, FewRandomisationsGiveAnHonestErrorToo) {
  const World& world = cornell();
  RenderSettings settings = small(0);
  settings.width = settings.height = 24;
  settings.samples_per_pixel = 64;
  settings.randomisations = 2;
  constexpr int kSeeds = 24;
  const auto pixels = static_cast<std::size_t>(settings.width * settings.height);
  std::vector<double> sums(pixels);
  std::vector<double> squares(pixels);
  std::vector<double> claimed(pixels);
  for (int seed = 0; seed < kSeeds; ++seed) {
    settings.seed = static_cast<std::uint64_t>(seed);
    const RenderResult result = render(world, world.scene.cameras[0], settings);
    for (std::size_t p = 0; p < pixels; ++p) {
      const double value = static_cast<double>(result.image.channels.at("G")[p]);
      const double error = static_cast<double>(result.image.channels.at("stderr.G")[p]);
      sums[p] += value;
      squares[p] += value * value;
      claimed[p] += error * error / kSeeds;
    }
  }
  double spread_sum = 0.0;
  double claimed_sum = 0.0;
  for (std::size_t p = 0; p < pixels; ++p) {
    const double mean = sums[p] / kSeeds;
    const double weight = 1.0 / (mean * mean + 0.01);
    spread_sum += weight * (squares[p] - kSeeds * mean * mean) / (kSeeds - 1);
    claimed_sum += weight * claimed[p];
  }
  EXPECT_GE(spread_sum / claimed_sum, 0.8);
  EXPECT_LE(spread_sum / claimed_sum, 1.25);
}

// Whatever time there is, and so whatever the last round's size, the error that is reported is known.
TEST(Render, EveryTimeLimitGivesAKnownError) {
  RenderSettings settings = small(6);
  for (int i = 1; i <= 12; ++i) {
    settings.max_seconds = 0.003 * i;
    const RenderResult result = render(cornell(), cornell().scene.cameras[0], settings);
    EXPECT_EQ(result.stop, StopReason::max_seconds);
    EXPECT_GE(result.samples_per_pixel, 2);
    EXPECT_TRUE(std::isfinite(result.relative_error)) << result.samples_per_pixel << " samples";
    EXPECT_GT(result.relative_error, 0.0);
  }
}

TEST(Render, SilhouetteOfASphereHasItsClosedForm) {
  // D23: the fraction of a square image a sphere covers is pi R^2 / (D^2 - R^2) / (4 tan^2(f / 2)).
  scene::Scene scene;
  test::add_sphere(scene, Vec3(0.0F), 1.0, 256, false, test::add_material(scene, Rgb(1.0F)));
  scene.cameras.push_back(scene::look_at({0, 0, 3}, Vec3(0.0F), {0, 1, 0}, 60.0F));
  const World world(scene, test::no_sky());
  RenderSettings settings;
  settings.width = settings.height = 128;
  settings.layers.albedo = true;
  const image::LayeredImage image = render(world, scene.cameras[0], settings).image;
  double covered = 0.0;
  for (const float a : image.channels.at("albedo.G")) covered += static_cast<double>(a);
  // About 128 * 1.9 edge pixels with a stratified error of at most 1/8 each.
  const double sigma = std::sqrt(128.0 * 1.9) / 8.0 / (128.0 * 128.0);
  EXPECT_LE(std::abs(covered / (128.0 * 128.0) - 0.294524311274), 4.0 * sigma + 8e-5);
}

TEST(Render, IsNotMirroredOrUpsideDown) {
  scene::Scene scene;  // a red quad at the right, a green one at the top, seen along -z
  test::add_quad(scene, {1, -0.2F, 0}, {0.4F, 0, 0}, {0, 0.4F, 0},
                 test::add_material(scene, Rgb(0.0F), Rgb(1, 0, 0)));
  test::add_quad(scene, {-0.2F, 1, 0}, {0.4F, 0, 0}, {0, 0.4F, 0},
                 test::add_material(scene, Rgb(0.0F), Rgb(0, 1, 0)));
  scene.cameras.push_back(scene::look_at({0, 0, 3}, Vec3(0.0F), {0, 1, 0}, 60.0F));
  RenderSettings settings;
  settings.width = settings.height = 60;
  const auto image =
      *image::rgb_layer(render(World(scene, test::no_sky()), scene.cameras[0], settings).image, "");
  const auto column = static_cast<int>(30 + 30 * 1.2 / (3 * std::tan(kPi / 6)));
  EXPECT_EQ(image.at(column, 30), Rgb(1, 0, 0));
  EXPECT_EQ(image.at(30, 60 - column), Rgb(0, 1, 0));
  EXPECT_EQ(image.at(60 - column, 30), Rgb(0.0F));
}

TEST(Render, BackFacesAreDarkAndBlock) {
  scene::Scene scene;  // seen from behind: no emission; the same quad hides an emitter behind it
  test::add_quad(scene, {-5, -5, 0}, {0, 10, 0}, {10, 0, 0}, test::add_material(scene, Rgb(1.0F), Rgb(1.0F)));
  test::add_quad(scene, {-5, -5, -1}, {10, 0, 0}, {0, 10, 0},
                 test::add_material(scene, Rgb(1.0F), Rgb(1.0F)));
  scene.cameras.push_back(scene::look_at({0, 0, 3}, Vec3(0.0F), {0, 1, 0}, 60.0F));
  const RenderResult result = render(World(scene, test::white_sky()), scene.cameras[0], small(1));
  EXPECT_EQ(result.mean_radiance, 0.0);
}

TEST(Render, RefusesAbsurdSettings) {
  const auto refuses = [](auto change) {
    RenderSettings settings = small(0);
    change(settings);
    EXPECT_THROW((void)render(cornell(), cornell().scene.cameras[0], settings), InputError);
  };
  refuses([](RenderSettings& s) { s.width = 0; });
  refuses([](RenderSettings& s) { s.height = -1; });
  refuses([](RenderSettings& s) { s.samples_per_pixel = 0; });
  refuses([](RenderSettings& s) { s.max_bounces = -1; });
  refuses([](RenderSettings& s) { s.target_error = NAN; });
  refuses([](RenderSettings& s) { s.max_seconds = -1.0; });
  refuses([](RenderSettings& s) { s.randomisations = 1; });
  refuses([](RenderSettings& s) { s.randomisations = 33; });
  refuses([](RenderSettings& s) { s.shard = {2, 2}; });
  refuses([](RenderSettings& s) {
    s.shard = {0, 2};
    s.target_error = 0.1;
  });
}

}  // namespace
}  // namespace plumbline::integrate
