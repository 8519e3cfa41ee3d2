// plumbline bench through the executable, with this renderer alone; `ci/nightly` runs it with Blender.
#include <stdlib.h>

#include <string>

#include "validation/tests/app/command.hpp"

namespace plumbline::app {
namespace {

class BenchCommand : public CommandTest {
 protected:
  BenchCommand() : path_(::getenv("PATH") == nullptr ? "" : ::getenv("PATH")) {}
  ~BenchCommand() override { ::setenv("PATH", path_.c_str(), 1); }
  /// No program can be found.
  static void hide_blender() { ::setenv("PATH", "/nonexistent", 1); }

  [[nodiscard]] static Arguments tiny(const Arguments& further = {}) {
    Arguments result = {"bench", "builtin:cornell", "--size", "16x16", "--spp", "2,4", "--reference-spp",
                        "16",    "--repeat",        "2",      "-o",    "study"};
    result.insert(result.end(), further.begin(), further.end());
    return result;
  }

 private:
  std::string path_;
};

TEST_F(BenchCommand, WritesRunsBudgetsAndAPage) {
  const std::string out = succeed(tiny({"--methods", "path"}));
  EXPECT_NE(out.find("4 runs on builtin:cornell"), std::string::npos) << out;
  const nlohmann::json study = read_json("study/bench.json");
  ASSERT_EQ(study.at("runs").size(), 4U);
  for (const nlohmann::json& run : study.at("runs")) {
    EXPECT_EQ(run.at("method"), "path");
    EXPECT_EQ(run.at("scene"), "builtin:cornell");
    EXPECT_GT(run.at("seconds").get<double>(), 0.0);
    EXPECT_GT(run.at("relmse").get<double>(), 0.0);
    EXPECT_DOUBLE_EQ(
        run.at("efficiency").get<double>() * run.at("relmse").get<double>() * run.at("seconds").get<double>(),
        1.0);
    for (const char* key : {"spp", "seed", "width", "height", "threads", "repetition", "bounces"})
      EXPECT_TRUE(run.contains(key)) << key;
  }
  EXPECT_EQ(study.at("budgets").size(), 2U);
  EXPECT_TRUE(study.at("ratios").empty());
  EXPECT_TRUE(study.at("skipped").empty());
  const std::string page = read("study/bench.html");
  EXPECT_NE(page.find("Error against time"), std::string::npos);
  EXPECT_EQ(page.find("src=\"http"), std::string::npos);
  EXPECT_TRUE(read_image("study/reference.exr").channels.contains("path.a.R"));
}

TEST_F(BenchCommand, TakesAnEarlierReference) {
  (void)succeed(tiny({"--methods", "path"}));
  const Arguments again = {
      "bench",       "builtin:cornell",    "--size", "16x16", "--spp", "2",      "--repeat",
      "1",           "--methods",          "path",   "-o",    "again", "--json", "-",
      "--reference", "study/reference.exr"};
  const nlohmann::json study = nlohmann::json::parse(succeed(again));
  EXPECT_EQ(study.at("runs").size(), 1U);
  EXPECT_TRUE(study.at("reference").at("has_halves").get<bool>());
  Arguments other = again;
  other[1] = "builtin:corner";
  expect_refused(other, {"study/reference.exr", "another task"});
  other = again;
  other[3] = "16x8";
  expect_refused(other, {"study/reference.exr", "16x8"});
}

TEST_F(BenchCommand, CountsWhatBlenderWouldHaveRun) {
  hide_blender();
  const std::string out = succeed(tiny({"--methods", "path,cycles"}));
  EXPECT_NE(out.find("skipped: cycles: 4 runs not made: no program `blender`"), std::string::npos) << out;
  const nlohmann::json study = read_json("study/bench.json");
  EXPECT_EQ(study.at("runs").size(), 4U);
  ASSERT_EQ(study.at("skipped").size(), 1U);
  EXPECT_EQ(study.at("skipped")[0].at("method"), "cycles");
  EXPECT_EQ(study.at("skipped")[0].at("runs"), 4);
}

TEST_F(BenchCommand, RefusesCyclesAloneWithoutBlender) {
  hide_blender();
  expect_refused(tiny({"--methods", "cycles"}), {"cycles", "blender"});
}

TEST_F(BenchCommand, RefusesWrongOptions) {
  expect_refused(tiny({"--methods", "path,mitsuba"}), {"mitsuba", "path", "cycles"});
  for (const char* list : {"0", "4,0", "x", "4,,8", "-1"})
    expect_refused({"bench", "--spp", list, "-o", "study"}, {"--spp", "expected whole numbers from 1", list});
  expect_refused({"bench", "nothing.gltf", "-o", "study"}, {"nothing.gltf"});
  expect_refused({"bench", "--preset", "teapot", "-o", "study"}, {"teapot", "cornell", "bunny"});
  expect_refused({"bench", "builtin:corner", "--preset", "cornell", "-o", "study"}, {"SCENE", "--preset"});
  expect_refused({"bench", "--reference", "no.exr", "--methods", "path", "-o", "study"}, {"no.exr"});
  expect_refused({"bench", "--reference", "no.exr", "--reference-spp", "4", "-o", "study"},
                 {"--reference", "--reference-spp"});
  expect_refused({"bench", "--repeat", "0", "-o", "study"}, {"--repeat"});
}

}  // namespace
}  // namespace plumbline::app
