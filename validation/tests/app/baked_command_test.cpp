// bake, inspect and relight through the executable.
#include <algorithm>
#include <cmath>

#include "reference/base/vector.hpp"
#include "validation/tests/app/command.hpp"

namespace plumbline::app {
namespace {

class BakedCommand : public CommandTest {
 protected:
  [[nodiscard]] std::string bake(const Arguments& further = {}) const {
    Arguments arguments = {"bake", "builtin:convex", "--bands", "3", "--samples", "64", "-o", "a.prt.glb"};
    arguments.insert(arguments.end(), further.begin(), further.end());
    return succeed(arguments);
  }
};

TEST_F(BakedCommand, BakeDescribesWhatItWrote) {
  const auto json = nlohmann::json::parse(bake({"--json", "-", "--seed", "7"}));
  EXPECT_EQ(json["output"], "a.prt.glb");
  EXPECT_EQ(json["transfer"], "shadowed");
  EXPECT_EQ(json["bands"], 3);
  EXPECT_EQ(json["vertices"], 60);
  EXPECT_EQ(json["samples"], 64);
  EXPECT_EQ(json["seed"], 7);
}

TEST_F(BakedCommand, BakeGivesTheSameFileForAnyNumberOfThreads) {
  (void)bake({"--threads", "1"});
  const std::string one = read("a.prt.glb");
  (void)bake({"--threads", "2"});
  EXPECT_EQ(one, read("a.prt.glb"));
  (void)bake({"--seed", "1"});
  EXPECT_NE(one, read("a.prt.glb"));  // the comparison can fail
}

TEST_F(BakedCommand, BakeWarnsOfTheScenesOwnLights) {
  const Outcome outcome =
      run({"bake", "builtin:cornell", "--bands", "1", "--transfer", "unshadowed", "-o", "a.glb"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.err.find("warning: the scene's own lights"), std::string::npos) << outcome.err;
}

TEST_F(BakedCommand, KeepsBouncesApart) {
  (void)succeed({"bake", "builtin:corner", "--bands", "2", "--samples", "64", "--transfer", "interreflected",
                 "--bounces", "2", "--keep-terms", "3", "--solver", "iterative", "-o", "b.prt.glb"});
  const auto json =
      nlohmann::json::parse(succeed({"inspect", "b.prt.glb", "--vertices", "1", "--json", "-"}));
  EXPECT_EQ(json["bounces"], 2);
  EXPECT_EQ(json["terms"], 3);
  EXPECT_EQ(json["solver"], "iterative");
  const auto& terms = json["term_vectors"]["1"];
  ASSERT_EQ(terms.size(), 3U);
  for (std::size_t i = 0; i < 4; ++i) {
    double sum = 0.0;
    for (const auto& term : terms) sum += term[0][i].get<double>();
    EXPECT_LE(std::abs(sum - json["transfer_vectors"]["1"][0][i].get<double>()), 1e-6);
  }
  const auto endless =
      nlohmann::json::parse(succeed({"bake", "builtin:corner", "--bands", "1", "--samples", "64",
                                     "--transfer", "interreflected", "-o", "c.prt.glb", "--json", "-"}));
  EXPECT_EQ(endless["bounces"], "all");
  EXPECT_EQ(endless["solver"], "traced");
}

TEST_F(BakedCommand, BakeExplainsWhatItSkips) {
  const std::string text = bake({"--explain"});
  EXPECT_NE(text.find("60 of 60 vertices"), std::string::npos) << text;
  EXPECT_EQ(nlohmann::json::parse(bake({"--json", "-", "--explain"}))["plan"].size(), 1U);
  EXPECT_EQ(nlohmann::json::parse(bake({"--json", "-", "--no-skip"}))["plan"].size(), 0U);
}

TEST_F(BakedCommand, BakeRefusesInOneLine) {
  const std::vector<std::pair<Arguments, std::string>> cases = {
      {{"--bounces", "2"}, "--transfer interreflected"},
      {{"--transfer", "interreflected", "--bounces", "some"}, "--bounces"},
      {{"--sampling", "sobol"}, "--sampling"},
      {{"--target-error", "0"}, "--target-error"},
      {{"--keep-terms", "-1"}, "--keep-terms"},
      {{"--samples", "8"}, "samples"}};
  for (const auto& [further, word] : cases) {
    Arguments arguments = {"bake", "builtin:convex", "--bands", "3", "-o", "d.prt.glb"};
    arguments.insert(arguments.end(), further.begin(), further.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 2) << word;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
  EXPECT_TRUE(contents().empty());
}

TEST_F(BakedCommand, InspectGivesTransferVectors) {
  (void)bake({"--transfer", "unshadowed"});
  const auto json =
      nlohmann::json::parse(succeed({"inspect", "a.prt.glb", "--vertices", "0,17", "--json", "-"}));
  EXPECT_EQ(json["bands"], 3);
  EXPECT_EQ(json["transfer"], "unshadowed");
  EXPECT_EQ(json["bounces"], 0);
  EXPECT_EQ(json["vertices"], 60);
  EXPECT_EQ(json["compression"], "none");
  EXPECT_EQ(json["bytes_per_vertex"], 9 * 4);
  const auto& vectors = json["transfer_vectors"];
  ASSERT_EQ(vectors.size(), 2U);
  for (const char* vertex : {"0", "17"}) {
    ASSERT_EQ(vectors[vertex].size(), 3U);
    for (const auto& row : vectors[vertex]) {
      ASSERT_EQ(row.size(), 9U);
      // (1/pi) integral of y_00 times the clamped cosine = y_00, rounded to float.
      EXPECT_LE(std::abs(row[0].get<double>() - 1.0 / std::sqrt(4.0 * kPi)), 2e-8);
    }
  }
}

TEST_F(BakedCommand, InspectTellsPeopleTheSame) {
  (void)bake({"--transfer", "unshadowed"});
  const std::string text = succeed({"inspect", "a.prt.glb", "--vertices", "17", "--json", "a.json"});
  for (const char* word : {"a.prt.glb", "bands", "unshadowed", "vertex 17", "0.28209"}) {
    EXPECT_NE(text.find(word), std::string::npos) << word << "\n" << text;
  }
  EXPECT_EQ(read_json("a.json")["transfer_vectors"].size(), 1U);
  EXPECT_EQ(
      nlohmann::json::parse(succeed({"inspect", "a.prt.glb", "--json", "-"}))["transfer_vectors"].size(), 0U);
}

TEST_F(BakedCommand, RelightsAnImageAndVertices) {
  (void)bake({"--transfer", "unshadowed"});
  const std::string csv = succeed({"relight", "a.prt.glb", "--env", "builtin:white", "-o", "a.exr", "--size",
                                   "9x9", "--spp", "4", "--vertices", "-"});
  EXPECT_EQ(csv.substr(0, csv.find('\n')), "x,y,z,nx,ny,nz,E_r,E_g,E_b,L_r,L_g,L_b");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 61);
  const image::LayeredImage image = read_image("a.exr");
  EXPECT_EQ(image.width, 9);
  // A white furnace: albedo 1 under radiance 1, whether the pixel shows the body or the sky. Nine terms in float.
  for (const char* channel : {"R", "G", "B"}) {
    for (const float value : image.channels.at(channel)) EXPECT_LE(std::abs(value - 1.0F), 1e-5F);
  }
  EXPECT_EQ(image.attributes.at("plumbline.bands"), "3");
  EXPECT_TRUE(image.attributes.contains("plumbline.command"));
}

TEST_F(BakedCommand, RelightWritesVerticesAlone) {
  (void)bake();
  const std::string out = succeed({"relight", "a.prt.glb", "--env", "builtin:white", "--vertices", "a.csv",
                                   "--rotate-env", "-30,0,0", "--json", "-"});
  EXPECT_EQ(nlohmann::json::parse(out)["vertices"], 60);
  EXPECT_FALSE(read("a.csv").empty());
  EXPECT_EQ(contents().size(), 2U);
}

}  // namespace
}  // namespace plumbline::app
