#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <map>

#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/image/exr.hpp"
#include "reference/image/file.hpp"
#include "validation/tests/light/support.hpp"

namespace fs = std::filesystem;
namespace plumbline::light {
namespace {

using image::Image;

// One a test: tests may run at the same time.
fs::path folder() {
  const std::string test = ::testing::UnitTest::GetInstance()->current_test_info()->name();
  const fs::path result = fs::path(::testing::TempDir()) / ("plumbline_environment_file_" + test);
  fs::create_directories(result);
  return result;
}

std::string written(const std::string& name, const Image& image) {
  image::LayeredImage layers{image.width, image.height, {}, {}};
  image::set_rgb_layer(layers, "", image);
  const fs::path path = folder() / name;
  image::write_exr(path, layers);
  return path.string();
}

// The message of the refusal; empty when there was none.
std::string refusal(const std::string& source, EnvironmentLayout layout = EnvironmentLayout::automatic) {
  try {
    (void)load_environment(source, layout);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

void expect_one_line_naming(const std::string& message, const std::string& file) {
  EXPECT_TRUE(message.starts_with(file + ": ")) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

// Where the faces +X -X +Y -Y +Z -Z lie in each layout, in units of a face.
struct Layout {
  const char* name;
  int columns, rows;
  std::array<glm::ivec2, 6> cells;
  bool is_last_turned;
};
const std::array<Layout, 4> kCubeLayouts{
    Layout{"cross43.exr", 4, 3, {{{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {3, 1}}}, false},
    Layout{"cross34.exr", 3, 4, {{{2, 1}, {0, 1}, {1, 0}, {1, 2}, {1, 1}, {1, 3}}}, true},
    Layout{"strip61.exr", 6, 1, {{{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {5, 0}}}, false},
    Layout{"strip16.exr", 1, 6, {{{0, 0}, {0, 1}, {0, 2}, {0, 3}, {0, 4}, {0, 5}}}, false}};
constexpr int kSide = 4;
const std::array<Rgb, 6> kColours{Rgb(1, 0, 0), Rgb(0, 1, 1), Rgb(0, 1, 0),
                                  Rgb(1, 0, 1), Rgb(0, 0, 1), Rgb(1, 1, 0)};
const std::array<Vec3, 6> kAxes{Vec3(1, 0, 0),  Vec3(-1, 0, 0), Vec3(0, 1, 0),
                                Vec3(0, -1, 0), Vec3(0, 0, 1),  Vec3(0, 0, -1)};

Image six_coloured(const Layout& layout) {
  Image result = image::make_image(kSide * layout.columns, kSide * layout.rows, Rgb(0.25F));
  for (std::size_t face = 0; face < 6; ++face) {
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        result.at(layout.cells[face].x * kSide + x, layout.cells[face].y * kSide + y) = kColours[face];
      }
    }
  }
  return result;
}

TEST(EnvironmentFile, PutsSixColouredFacesOnTheirAxes) {
  for (const Layout& layout : kCubeLayouts) {
    const Environment environment = load_environment(written(layout.name, six_coloured(layout)));
    for (std::size_t face = 0; face < 6; ++face) {
      EXPECT_EQ(radiance(environment, kAxes[face]), kColours[face]) << layout.name << " face " << face;
    }
  }
}

// The top right texel of each 4x4 face, at (s, t) = (3/4, -3/4), in the directions that OpenGL gives it.
const std::array<Vec3, 6> kTopRight{Vec3(1, .75F, -.75F), Vec3(-1, .75F, .75F), Vec3(.75F, 1, -.75F),
                                    Vec3(.75F, -1, .75F), Vec3(.75F, .75F, 1),  Vec3(-.75F, .75F, -1)};

TEST(EnvironmentFile, KeepsEveryFaceUpright) {
  for (const Layout& layout : kCubeLayouts) {
    for (std::size_t face = 0; face < 6; ++face) {
      Image image = six_coloured(layout);
      const bool is_turned = layout.is_last_turned && face == 5;
      const glm::ivec2 inside = is_turned ? glm::ivec2(0, 3) : glm::ivec2(3, 0);
      const glm::ivec2 texel = layout.cells[face] * kSide + inside;
      image.at(texel.x, texel.y) = Rgb(9.0F);
      const Environment environment = load_environment(written(layout.name, image));
      for (std::size_t other = 0; other < 6; ++other) {
        const Rgb expected = other == face ? Rgb(9.0F) : kColours[other];
        EXPECT_EQ(radiance(environment, glm::normalize(kTopRight[other])), expected)
            << layout.name << " texel on face " << face << ", seen on " << other;
      }
    }
  }
}

// Folded up, texels that touch in a cross touch on the sphere: an independent check of all faces' turns.
TEST(EnvironmentFile, FoldsCrossesWithoutTears) {
  for (std::size_t k = 0; k < 2; ++k) {
    const Layout& layout = kCubeLayouts[k];
    Image image = image::make_image(kSide * layout.columns, kSide * layout.rows);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = Rgb(static_cast<float>(i));
    const Environment environment = load_environment(written(layout.name, image));
    std::map<std::pair<int, int>, Vec3> directions;  // of the texels in the cross
    for (int i = 0; i < 6 * kSide * kSide; ++i) {
      const Vec2 uv((static_cast<float>(i % kSide) + 0.5F) / kSide,
                    (static_cast<float>(i / kSide % kSide) + 0.5F) / kSide);
      const Vec3 direction = direction_from_cube({i / (kSide * kSide), uv});
      const int pixel = static_cast<int>(radiance(environment, direction).x);
      directions[{pixel % image.width, pixel / image.width}] = direction;
    }
    ASSERT_EQ(directions.size(), std::size_t{6 * kSide * kSide});
    for (const auto& [at, direction] : directions) {
      for (const auto& next : {std::pair(at.first + 1, at.second), std::pair(at.first, at.second + 1)}) {
        const auto neighbour = directions.find(next);
        if (neighbour == directions.end()) continue;
        // Centres of neighbours are at most 2 / side apart on the face, less on the sphere.
        EXPECT_LE(glm::length(neighbour->second - direction), 2.0F / kSide)
            << layout.name << " texel " << at.first << " " << at.second;
      }
    }
  }
}

TEST(EnvironmentFile, PutsOneLatLongTexelInItsDirection) {
  Image image = image::make_image(8, 4, Rgb(0.5F));
  image.at(6, 1) = Rgb(7.0F);  // u = 13/16, v = 3/8
  const Environment environment = load_environment(written("latlong.exr", image));
  ASSERT_TRUE(std::holds_alternative<LatLongSky>(environment.sky));
  EXPECT_EQ(environment.texels, 32U);
  const float phi = glm::radians(112.5F);
  const float theta = glm::radians(67.5F);
  const Vec3 there(std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi));
  EXPECT_EQ(radiance(environment, there), Rgb(7.0F));
  EXPECT_EQ(radiance(environment, there * Vec3(-1, 1, 1)), Rgb(0.5F));
  EXPECT_EQ(radiance(environment, there * Vec3(1, 1, -1)), Rgb(0.5F));
  EXPECT_EQ(radiance(environment, there * Vec3(1, -1, 1)), Rgb(0.5F));
}

TEST(EnvironmentFile, PutsOneAngularMapTexelInItsDirection) {
  Image image = image::make_image(8, 8, Rgb(0.5F));
  image.at(5, 2) = Rgb(7.0F);  // (3/8, 3/8) of the radius right and up: 0.5303 pi = 95.5 degrees from +Z
  const Environment environment = load_environment(written("angular.exr", image));
  ASSERT_TRUE(std::holds_alternative<AngularMapSky>(environment.sky));
  const float theta = glm::radians(180.0F * 0.53033F);
  const float side = std::sin(theta) * std::sqrt(0.5F);
  const Vec3 there(side, side, std::cos(theta));
  EXPECT_EQ(radiance(environment, there), Rgb(7.0F));
  EXPECT_EQ(radiance(environment, there * Vec3(-1, 1, 1)), Rgb(0.5F));
  EXPECT_EQ(radiance(environment, there * Vec3(1, -1, 1)), Rgb(0.5F));
}

TEST(EnvironmentFile, DecodesSrgbPictures) {
  image::Image8 gray{4, 2, std::vector<std::uint8_t>(24, 128)};
  const fs::path path = folder() / "gray.png";
  image::write_png(path, gray);
  const Environment environment = load_environment(path.string());
  // ((128/255 + 0.055) / 1.055)^2.4
  EXPECT_LE(std::abs(radiance(environment, {1, 0, 0}).x - 0.2158605F), 1e-7F);
}

TEST(EnvironmentFile, SetsNegativeComponentsToZeroAndCountsTexels) {
  Image image = image::make_image(4, 2, Rgb(1.0F));
  image.at(0, 0) = Rgb(-1, -2, 3);
  image.at(3, 1) = Rgb(4, 5, -1e-6F);
  const Environment environment = load_environment(written("negative.exr", image));
  EXPECT_EQ(environment.negative_texels, 2U);
  EXPECT_EQ(radiance(environment, testing::texel_centre(0, 0, 4, 2)), Rgb(0, 0, 3));
  EXPECT_EQ(radiance(environment, testing::texel_centre(3, 1, 4, 2)), Rgb(4, 5, 0));
}

TEST(EnvironmentFile, RefusesNonFiniteTexelsByPosition) {
  Image image = image::make_image(4, 2, Rgb(1.0F));
  image.at(2, 1).y = std::numeric_limits<float>::quiet_NaN();
  const std::string nan = written("nan.exr", image);
  expect_one_line_naming(refusal(nan), nan);
  EXPECT_NE(refusal(nan).find("texel (2, 1) channel G is nan"), std::string::npos) << refusal(nan);
  image.at(2, 1).y = 1.0F;
  image.at(3, 0).z = -std::numeric_limits<float>::infinity();
  const std::string infinite = written("inf.exr", image);
  EXPECT_NE(refusal(infinite).find("texel (3, 0) channel B is -inf"), std::string::npos) << refusal(infinite);
}

TEST(EnvironmentFile, RefusesWhatIsNoPicture) {
  const std::string missing = (folder() / "missing.exr").string();
  expect_one_line_naming(refusal(missing), missing);
  const std::string text = (folder() / "text.exr").string();
  write_text_atomically(text, "no picture\nat all\n");
  expect_one_line_naming(refusal(text), text);
  const std::string empty = (folder() / "empty.exr").string();
  write_text_atomically(empty, "");
  expect_one_line_naming(refusal(empty), empty);
  expect_one_line_naming(refusal(folder().string()), folder().string());
}

TEST(EnvironmentFile, RefusesATruncatedPicture) {
  Image image = image::make_image(64, 32);
  testing::Numbers numbers;
  for (Rgb& texel : image.pixels) texel = Rgb(numbers.next(), numbers.next(), numbers.next());
  const std::string whole = read_file(written("whole.exr", image));
  const std::string cut = (folder() / "cut.exr").string();
  write_text_atomically(cut, std::string_view(whole).substr(0, whole.size() / 2));
  expect_one_line_naming(refusal(cut), cut);
}

TEST(EnvironmentFile, RefusesAspectRatiosThatNoLayoutHas) {
  const std::string odd = written("odd.exr", image::make_image(3, 5, Rgb(1.0F)));
  expect_one_line_naming(refusal(odd), odd);
  EXPECT_NE(refusal(odd).find("3x5"), std::string::npos);
  EXPECT_NE(refusal(odd, EnvironmentLayout::cube), "");
  EXPECT_NE(refusal(odd, EnvironmentLayout::angular_map), "");
  EXPECT_EQ(refusal(odd, EnvironmentLayout::lat_long), "");  // forced: stretched over the sphere
}

TEST(EnvironmentFile, ForcesALayout) {
  const std::string square = written("square.exr", image::make_image(4, 4, Rgb(1.0F)));
  EXPECT_TRUE(std::holds_alternative<AngularMapSky>(load_environment(square).sky));
  const Environment forced = load_environment(square, EnvironmentLayout::lat_long);
  EXPECT_TRUE(std::holds_alternative<LatLongSky>(forced.sky));
  EXPECT_NE(refusal(square, EnvironmentLayout::cube).find("4x4"), std::string::npos);
}

// A public HDR photograph, where Debian's blender-data has put it.
TEST(EnvironmentFile, ReadsAPublicPhotograph) {
  const fs::path city = "/usr/share/blender/datafiles/studiolights/world/city.exr";
  ASSERT_TRUE(fs::exists(city)) << city << " is missing: `ci/install data` brings it";
  const Environment environment = load_environment(city.string());
  ASSERT_TRUE(std::holds_alternative<LatLongSky>(environment.sky));
  const Image& image = std::get<LatLongSky>(environment.sky).image;
  ASSERT_EQ(image.width, 1024);
  ASSERT_EQ(image.height, 512);
  double sum = 0.0;
  float largest = 0.0F;
  for (int y = 0; y < image.height; ++y) {
    const double omega = testing::texel_solid_angle(y, image.width, image.height);
    for (int x = 0; x < image.width; ++x) {
      const Rgb texel = image.at(x, y);
      ASSERT_GE(std::min(texel.x, std::min(texel.y, texel.z)), 0.0F);
      sum += omega * (static_cast<double>(texel.x) + texel.y + texel.z) / 3.0;
      largest = std::max(largest, max_component(texel));
    }
  }
  EXPECT_LE(std::abs(sum / (4.0 * kPi) - 0.96), 0.01);  // known to two figures
  EXPECT_LE(std::abs(largest / 3.4e4F - 1.0F), 0.01F);
}

}  // namespace
}  // namespace plumbline::light
