// render and merge through the executable: what the image holds, and that its bits depend on the inputs and the
// seed alone.
#include <fmt/format.h>

#include <iterator>
#include <set>
#include <sstream>

#include "validation/tests/app/command.hpp"

namespace plumbline::app {
namespace {

class RenderCommand : public CommandTest {
 protected:
  // 40 x 24 pixels are six tiles, of which three are cut by the border.
  [[nodiscard]] static Arguments cornell(const std::string& output, const Arguments& further = {}) {
    Arguments result = {"render", "builtin:cornell", "--size", "40x24", "--spp",
                        "4",      "--layers",        "all",    "-o",    output};
    result.insert(result.end(), further.begin(), further.end());
    return result;
  }
};

TEST_F(RenderCommand, WritesTheChannelsOfTheConventions) {
  (void)succeed(cornell("a.exr", {"--bounces", "1"}));
  const image::LayeredImage image = read_image("a.exr");
  EXPECT_EQ(image.width, 40);
  EXPECT_EQ(image.height, 24);
  std::set<std::string> expected = {"R", "G", "B", "samples", "depth"};
  for (const char* layer :
       {"stderr", "emission", "bounce0", "bounce1", "direct", "indirect", "a", "b", "albedo"}) {
    for (const char component : {'R', 'G', 'B'}) expected.insert(fmt::format("{}.{}", layer, component));
  }
  for (const char* layer : {"normal", "position"}) {
    for (const char component : {'X', 'Y', 'Z'}) expected.insert(fmt::format("{}.{}", layer, component));
  }
  std::set<std::string> found;
  for (const auto& [name, values] : image.channels) found.insert(name);
  EXPECT_EQ(found, expected);
  for (const float samples : image.channels.at("samples")) EXPECT_EQ(samples, 4.0F);
}

TEST_F(RenderCommand, WritesOnlyTheUsualChannelsUnlessAsked) {
  (void)succeed({"render", "builtin:cornell", "--size", "4x4", "--spp", "2", "-o", "a.exr"});
  EXPECT_EQ(read_image("a.exr").channels.size(), 7U);  // R G B, their standard errors, samples
  (void)succeed(
      {"render", "builtin:cornell", "--size", "4x4", "--spp", "2", "-o", "a.exr", "--layers", "depth"});
  EXPECT_EQ(read_image("a.exr").channels.size(), 8U);
}

TEST_F(RenderCommand, WritesTheAttributesThatMakeTheImageAgain) {
  const Arguments settings = {"--seed", "18446744073709551615", "--env",    "builtin:overcast", "--bounces",
                              "2",      "--rotate-env",         "-30,0,0.5"};
  (void)succeed(cornell("a.exr", settings));
  const auto attributes = read_image("a.exr").attributes;
  for (const char* name : {"version", "scene", "sceneHash", "environment", "camera", "command"}) {
    EXPECT_TRUE(attributes.contains(std::string("plumbline.") + name)) << name;
  }
  EXPECT_EQ(attributes.at("plumbline.seed"), settings[1]);
  EXPECT_EQ(attributes.at("plumbline.samplesPerPixel"), "4");
  EXPECT_EQ(attributes.at("plumbline.bounces"), "2");
  // No word of the command needs quotes here.
  std::stringstream words(attributes.at("plumbline.command"));
  Arguments again(std::istream_iterator<std::string>(words), {});
  EXPECT_EQ(again.front(), "plumbline");
  again.erase(again.begin());
  again.insert(again.end(), {"-o", "b.exr"});
  (void)succeed(again);
  EXPECT_EQ(read("a.exr"), read("b.exr"));
}

TEST_F(RenderCommand, GivesTheSameFileForAnyNumberOfThreads) {
  (void)succeed(cornell("one.exr", {"--threads", "1"}));
  (void)succeed(cornell("two.exr", {"--threads", "2"}));
  EXPECT_EQ(read("one.exr"), read("two.exr"));
  (void)succeed(cornell("seed.exr", {"--seed", "1"}));
  EXPECT_NE(read("one.exr"), read("seed.exr"));  // the comparison can fail
}

TEST_F(RenderCommand, GivesTheSameFileFromShards) {
  (void)succeed(cornell("whole.exr"));
  Arguments merge = {"merge", "-o", "merged.exr"};
  for (const int index : {2, 0, 1}) {
    const std::string name = fmt::format("part{}.exr", index);
    (void)succeed(cornell(name, {"--shard", fmt::format("{}/3", index)}));
    EXPECT_NE(read(name), read("whole.exr"));
    merge.push_back(name);
  }
  (void)succeed(merge);
  EXPECT_EQ(read("whole.exr"), read("merged.exr"));
}

TEST_F(RenderCommand, WritesPureJsonToStandardOutput) {
  const auto json = nlohmann::json::parse(succeed(cornell("a.exr", {"--json", "-"})));
  EXPECT_EQ(json["output"], "a.exr");
  EXPECT_EQ(json["samples_per_pixel"], 4);
  EXPECT_EQ(json["bounces"], "all");
  EXPECT_EQ(json["stop"], "samples");
  EXPECT_EQ(json["scene_hash"], read_image("a.exr").attributes.at("plumbline.sceneHash"));
  EXPECT_GT(json["mean_radiance"].get<double>(), 0.0);
}

TEST_F(RenderCommand, StopsAtATargetErrorOrATime) {
  const Arguments base = {
      "render", "builtin:corner", "--env", "builtin:white", "--size", "4x4", "--json", "-", "-o", "a.exr"};
  Arguments to_target = base;
  to_target.insert(to_target.end(), {"--target-error", "0.2"});
  const auto by_error = nlohmann::json::parse(succeed(to_target));
  EXPECT_EQ(by_error["stop"], "target-error");
  EXPECT_LE(by_error["relative_error"].get<double>(), 0.2);
  Arguments to_time = base;
  to_time.insert(to_time.end(), {"--max-seconds", "0.01"});
  EXPECT_EQ(nlohmann::json::parse(succeed(to_time))["stop"], "max-seconds");
}

TEST_F(RenderCommand, WarnsOfABlackImageAndOfASingleSample) {
  const Outcome dark = run({"render", "builtin:corner", "--size", "2x2", "--spp", "2", "-o", "a.exr"});
  EXPECT_EQ(dark.code, 0);
  EXPECT_NE(dark.err.find("warning: no light"), std::string::npos) << dark.err;
  const Outcome single = run({"render", "builtin:cornell", "--size", "2x2", "--spp", "1", "-o", "a.exr"});
  EXPECT_EQ(single.code, 0);
  EXPECT_NE(single.err.find("warning: a single sample"), std::string::npos) << single.err;
}

TEST_F(RenderCommand, ReplacesWhatALinkPointsTo) {
  write("file.exr", "old");
  std::filesystem::create_symlink("file.exr", path("link.exr"));
  (void)succeed({"render", "builtin:cornell", "--size", "2x2", "--spp", "2", "-o", "link.exr"});
  EXPECT_TRUE(std::filesystem::is_symlink(path("link.exr")));
  EXPECT_EQ(read_image("file.exr").width, 2);
}

TEST_F(RenderCommand, TakesFileNamesOfAnyBytes) {
  const std::string latin1 = "caf\xE9 1.obj";
  write(latin1, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Arguments arguments = {"render", latin1, "--env", "builtin:white", "--size", "2x2", "--spp", "2",
                               "--json", "-",    "-o",    "a.exr"};
  EXPECT_EQ(nlohmann::json::parse(succeed(arguments))["width"], 2);
}

}  // namespace
}  // namespace plumbline::app
