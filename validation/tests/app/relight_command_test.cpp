// relight through the executable: lights that turn and mix, numbered pictures.
#include <cmath>

#include "reference/image/file.hpp"
#include "validation/tests/app/command.hpp"

namespace plumbline::app {
namespace {

class RelightCommand : public CommandTest {
 protected:
  RelightCommand() {
    (void)succeed({"bake", "builtin:convex", "--bands", "4", "--transfer", "unshadowed", "-o", "a.prt.glb"});
  }

  Arguments relight(const Arguments& further) const {
    Arguments all = {"relight", "a.prt.glb", "--env", "builtin:two-lobes", "--size", "12x8", "--spp", "4"};
    all.insert(all.end(), further.begin(), further.end());
    return all;
  }

  [[nodiscard]] Outcome run_relight(const Arguments& further) const { return run(relight(further)); }
  void expect_relight_refused(const Arguments& further, const std::vector<std::string>& words) const {
    expect_refused(relight(further), words);
  }

  /// Largest difference of the R, G and B of two pictures.
  [[nodiscard]] float difference(const std::string& a, const std::string& b) const {
    float largest = 0.0F;
    const image::LayeredImage first = read_image(a);
    const image::LayeredImage second = read_image(b);
    for (const char* channel : {"R", "G", "B"}) {
      const std::vector<float>& x = first.channels.at(channel);
      const std::vector<float>& y = second.channels.at(channel);
      EXPECT_EQ(x.size(), y.size());
      for (std::size_t i = 0; i < x.size(); ++i) {
        const float d = std::abs(x[i] - y.at(i));
        largest = d <= largest ? largest : d;
      }
    }
    return largest;
  }
};

// Coefficients turned against the turned environment projected anew. The environment is evaluated along directions in
// float: 1e-6 of its largest radiance 1, as ProjectWindowsAndRotates has it; 16 terms of it.
TEST_F(RelightCommand, TurningCoefficientsIsTurningTheLight) {
  (void)succeed(
      {"project", "builtin:two-lobes", "--bands", "4", "--rotate-env", "20,-50,110", "-o", "turned.json"});
  (void)succeed({"relight", "a.prt.glb", "--env", "turned.json", "--vertices", "anew.csv"});
  (void)succeed(relight({"--rotate-env", "20,-50,110", "--vertices", "turned.csv"}));
  (void)succeed(relight({"--vertices", "still.csv"}));
  const auto numbers = [&](const std::string& name) {
    std::vector<double> all;
    std::string text = read(name);
    for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find_first_of(",\n", at + 1)) {
      if (at + 1 < text.size()) all.push_back(std::stod(text.substr(at + 1)));
    }
    return all;
  };
  const std::vector<double> anew = numbers("anew.csv");
  const std::vector<double> turned = numbers("turned.csv");
  const std::vector<double> still = numbers("still.csv");
  ASSERT_EQ(anew.size(), 60U * 12U);
  ASSERT_EQ(turned.size(), anew.size());
  double error = 0.0;
  double moved = 0.0;
  for (std::size_t i = 0; i < anew.size(); ++i) {
    const double e = std::abs(turned[i] - anew[i]);
    error = e <= error ? error : e;
    moved = std::max(moved, std::abs(still[i] - anew[i]));
  }
  EXPECT_LE(error, 3e-5);
  EXPECT_GT(moved, 0.1);
}

TEST_F(RelightCommand, FramesAreTheSinglePicturesOfTheirAngles) {
  const auto json = nlohmann::json::parse(
      succeed(relight({"--rotate-env", "0,360,0", "--frames", "4", "-o", "out.exr", "--json", "-"})));
  EXPECT_EQ(json["frames"], 4);
  EXPECT_GT(json["seconds_frame"].get<double>(), json["seconds_relight"].get<double>());
  EXPECT_EQ(contents().size(), 5U);  // and nothing else is left
  (void)succeed(relight({"--rotate-env", "0,270,0", "-o", "single.exr"}));
  EXPECT_EQ(difference("out_0003.exr", "single.exr"), 0.0F);
  (void)succeed(relight({"-o", "unturned.exr"}));
  EXPECT_EQ(difference("out_0000.exr", "unturned.exr"), 0.0F);
  EXPECT_GT(difference("out_0001.exr", "out_0003.exr"), 0.1F);
}

TEST_F(RelightCommand, MixesLightsAndTurnsTheFirst) {
  (void)succeed(relight({"-o", "a.exr"}));
  (void)succeed(
      {"relight", "a.prt.glb", "--env", "builtin:white", "--size", "12x8", "--spp", "4", "-o", "b.exr"});
  (void)succeed(relight({"--mix", "builtin:white,0.25", "-o", "mixed.exr"}));
  const image::LayeredImage a = read_image("a.exr");
  const image::LayeredImage b = read_image("b.exr");
  const image::LayeredImage mixed = read_image("mixed.exr");
  for (std::size_t i = 0; i < 12 * 8; ++i) {
    const float expected = 0.75F * a.channels.at("G")[i] + 0.25F * b.channels.at("G")[i];
    EXPECT_LE(std::abs(mixed.channels.at("G")[i] - expected), 1e-5F) << i;  // 16 terms below 1 in float
  }
  (void)succeed(relight({"--mix", "builtin:white,1", "--rotate-env", "30,0,0", "-o", "white.exr"}));
  EXPECT_LE(difference("white.exr", "b.exr"), 1e-5F);
  EXPECT_GT(difference("mixed.exr", "a.exr"), 0.01F);
  EXPECT_NE(mixed.attributes.at("plumbline.command").find("--mix builtin:white,0.25"), std::string::npos);
}

TEST_F(RelightCommand, WritesPngAndAStripOfAllFrames) {
  (void)succeed(relight({"--rotate-env", "0,360,0", "--frames", "3", "-o", "out.png", "--strip", "strip.png",
                         "--exposure", "1"}));
  const image::Image strip = image::read_image(path("strip.png"));
  ASSERT_EQ(strip.width, 36);
  ASSERT_EQ(strip.height, 8);
  for (int frame = 0; frame < 3; ++frame) {
    const image::Image one = image::read_image(path("out_000" + std::to_string(frame) + ".png"));
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 12; ++x) ASSERT_EQ(one.at(x, y), strip.at(12 * frame + x, y)) << frame;
  }
  (void)succeed(relight({"-o", "darker.png"}));
  EXPECT_NE(read("darker.png"), read("out_0000.png"));
}

TEST_F(RelightCommand, RefusesWhatMakesNoSense) {
  write("old.exr", "old");
  expect_relight_refused({"-o", "old.exr", "--mix", "builtin:white"}, {"--mix", "ENV2,WEIGHT"});
  expect_relight_refused({"-o", "old.exr", "--mix", "builtin:white,1.5"}, {"--mix", "0 to 1"});
  expect_relight_refused({"-o", "old.exr", "--mix", "builtin:white,nan"}, {"--mix", "0 to 1"});
  expect_relight_refused({"-o", "old.exr", "--mix", "nowhere.exr,0.5"}, {"nowhere.exr"});
  expect_relight_refused({"-o", "old.exr", "--frames", "0"}, {"--frames", "1 to 100000"});
  expect_relight_refused({"-o", "old.exr", "--frames", "2.5"}, {"--frames"});
  expect_relight_refused({"-o", "old.jpg", "--frames", "2"}, {"old.jpg", ".exr or .png"});
  expect_relight_refused({"-o", "-", "--frames", "2"}, {"standard output"});
  expect_relight_refused({"--vertices", "-", "--frames", "2", "-o", "old.exr"}, {"--vertices", "--frames"});
  expect_relight_refused({"--strip", "strip.exr"}, {"--strip", ".png"});
  expect_relight_refused({"--strip", "strip.png", "--frames", "99999"}, {"--strip", "32768"});
  expect_relight_refused({"-o", "old.exr", "--exposure", "inf"}, {"--exposure"});
  expect_relight_refused({"-o", "nowhere/old.exr", "--frames", "2"}, {"nowhere"});
  std::filesystem::create_directory(path("out_0001.exr"));
  const Outcome late = run_relight({"-o", "out.exr", "--frames", "2"});
  EXPECT_EQ(late.code, 2);
  EXPECT_FALSE(std::filesystem::exists(path("out_0000.exr"))) << "refused before the first frame";
}

}  // namespace
}  // namespace plumbline::app
