#include "reference/image/picture_library.hpp"

#include <gtest/gtest.h>

#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/image/exr.hpp"
#include "reference/image/file.hpp"
#include "validation/tests/app/command.hpp"

namespace fs = std::filesystem;
using namespace std::string_literals;

namespace plumbline::image {
namespace {

constexpr const char* kCity = "/usr/share/blender/datafiles/studiolights/world/city.exr";

Image coloured(int width, int height) {
  Image result = make_image(width, height);
  for (std::size_t i = 0; i < result.pixels.size(); ++i) {
    const auto value = static_cast<float>(i);
    result.pixels[i] = Rgb(value, 0.5F - value, 1.0F / (1.0F + value));
  }
  return result;
}

class PictureLibraryTest : public app::CommandTest {
 protected:
  // The command somewhere else, without the module that lies beside it.
  std::string lonely_command() const {
    fs::create_directory(path("elsewhere"));
    fs::copy_file(PLUMBLINE_COMMAND, path("elsewhere/plumbline"));
    return path("elsewhere/plumbline").string();
  }
};

// Two readers, one answer: OpenEXR's alone, and OpenImageIO's.
TEST(PlainExr, AgreesWithOpenImageIoBitForBit) {
  const std::string bytes = read_file(kCity);  // channels of half, written by others
  const std::optional<Image> image = read_plain_exr(bytes, kCity);
  ASSERT_TRUE(image);
  const RawPicture raw = picture_library().decode(bytes, kCity);
  ASSERT_EQ(raw.width, image->width);
  ASSERT_EQ(raw.height, image->height);
  ASSERT_GE(raw.channels, 3);
  EXPECT_FALSE(raw.is_srgb_encoded);
  std::size_t different = 0;
  for (std::size_t i = 0; i < image->pixels.size(); ++i) {
    const float* texel = &raw.values[i * static_cast<std::size_t>(raw.channels)];
    for (int c = 0; c < 3; ++c) different += image->pixels[i][c] == texel[c] ? 0U : 1U;
  }
  EXPECT_EQ(different, 0U);
}

TEST_F(PictureLibraryTest, LeavesTheOtherLayersOfAFileAlone) {
  const Image image = coloured(5, 3);
  LayeredImage layers{
      5, 3, {{"A", std::vector<float>(15, 0.5F)}, {"depth", std::vector<float>(15, 9.0F)}}, {}};
  set_rgb_layer(layers, "", image);
  write_exr(path("layers.exr"), layers);
  const std::optional<Image> read = read_plain_exr(this->read("layers.exr"), "layers.exr");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->pixels, image.pixels);
}

TEST_F(PictureLibraryTest, LeavesFilesWithoutColoursToOpenImageIo) {
  const LayeredImage depth{4, 2, {{"Y", std::vector<float>(8, 3.0F)}}, {}};
  write_exr(path("gray.exr"), depth);
  EXPECT_FALSE(read_plain_exr(read("gray.exr"), "gray.exr"));
  EXPECT_EQ(image::read_image(path("gray.exr")).pixels, std::vector<Rgb>(8, Rgb(3.0F)));
}

TEST_F(PictureLibraryTest, OpenExrNeedsNoModule) {
  write_image("sky.exr", 4, 2, 1.0F);
  const app::Outcome outcome =
      run_program(lonely_command(), {"project", "sky.exr", "--bands", "1", "-o", "a.json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(fs::exists(path("a.json")));
}

TEST_F(PictureLibraryTest, AMissingModuleIsOneClearLine) {
  write("sky.png", encode_png({2, 1, std::vector<std::uint8_t>(6, 128)}));
  const std::string command = lonely_command();
  const app::Contents before = contents();
  const app::Outcome outcome = run_program(command, {"project", "sky.png", "--bands", "1", "-o", "a.json"});
  EXPECT_EQ(app::fault_of_refusal(outcome, {"sky.png", "plumbline_pictures.so", "cannot be loaded"}, before,
                                  contents()),
            "")
      << outcome.err;
}

// A header that asks for ten million texels in a file of some hundred bytes.
TEST_F(PictureLibraryTest, ASizeThatTheBytesCannotHoldIsRefused) {
  write_image("a.exr", 4, 2, 1.0F);
  std::string bytes = read("a.exr");
  const std::size_t window =
      bytes.find("dataWindow\0box2i"s) + 10 + 1 + 5 + 1 + 4;          // names, zeros, the box's size
  bytes.replace(window + 8, 8, "\xff\xff\x00\x00\x9f\x00\x00\x00"s);  // the last column and row
  write("large.exr", bytes);
  for (const bool is_layered : {false, true}) {
    try {
      is_layered ? (void)read_exr(path("large.exr")) : (void)image::read_image(path("large.exr"));
      FAIL() << "not refused";
    } catch (const InputError& error) {
      EXPECT_TRUE(std::string(error.what()).starts_with(path("large.exr").string() + ": ")) << error.what();
    }
  }
}

TEST(PictureLibrary, TellsSizesThatNoFileOfSoFewBytesHolds) {
  EXPECT_TRUE(is_plausible(1U << 20U, 0));
  EXPECT_TRUE(is_plausible(8192U * 4096U, 4096));
  EXPECT_FALSE(is_plausible(65536ULL * 65536ULL, 100000));
}

TEST(PictureLibrary, ATruncatedPictureIsRefusedByName) {
  const std::string bytes = encode_png({8, 8, std::vector<std::uint8_t>(192, 77)});
  EXPECT_EQ(read_image(bytes, "whole.png").pixels.size(), 64U);
  try {
    (void)read_image(std::string_view(bytes).substr(0, bytes.size() / 2), "half.png");
    FAIL() << "not refused";
  } catch (const InputError& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("half.png: cannot read as an image: ")) << error.what();
  }
}

}  // namespace
}  // namespace plumbline::image
