// compress, and what the other verbs make of its files.
#include <cmath>

#include "validation/tests/app/command.hpp"

namespace plumbline::app {
namespace {

class CompressCommand : public CommandTest {
 protected:
  CompressCommand() {
    succeed({"bake", "builtin:convex", "--bands", "3", "--samples", "1024", "--no-skip", "-o", "a.prt.glb"});
  }
  [[nodiscard]] nlohmann::json compress(const Arguments& further) const {
    Arguments arguments = {"compress", "a.prt.glb", "-o", "b.prt.glb", "--json", "-"};
    arguments.insert(arguments.end(), further.begin(), further.end());
    return nlohmann::json::parse(succeed(arguments));
  }
};

TEST_F(CompressCommand, InspectSaysWhatCompressDid) {
  const auto json = compress({"--method", "cpca", "--clusters", "8", "--components", "4", "--bits", "16,8"});
  EXPECT_EQ(json["clusters"], 8);
  EXPECT_EQ(json["components"], 4);
  EXPECT_EQ(json["clustering"], "iterative");
  EXPECT_EQ(json["bits"], nlohmann::json({16, 8, 8, 8}));
  EXPECT_EQ(json["uncompressed_bytes_per_vertex"], 36);
  EXPECT_GT(json["error"], 0.0);
  EXPECT_GT(json["bake_error"], 0.0);
  EXPECT_GT(json["seams"]["inner_edges"], 0);  // facets apart: no edge crosses a border
  const auto inspected =
      nlohmann::json::parse(succeed({"inspect", "b.prt.glb", "--vertices", "3", "--json", "-"}));
  EXPECT_EQ(inspected["compression"], "cpca");
  for (const char* key :
       {"clusters", "components", "bits", "error", "bake_error", "bytes_per_vertex", "clustering"}) {
    EXPECT_EQ(inspected[key], json[key]) << key;
  }
  EXPECT_EQ(inspected["transfer_vectors"]["3"][0].size(), 9U);
  EXPECT_NE(succeed({"inspect", "b.prt.glb"}).find("cpca"), std::string::npos);
}

TEST_F(CompressCommand, RelightsLikeTheOriginalToTheStatedError) {
  const auto json = compress({"--clusters", "4", "--components", "6", "--bits", "32"});
  const std::vector<std::string> light = {"--env", "builtin:overcast", "--size", "24x24", "--spp", "1", "-o"};
  Arguments before = {"relight", "a.prt.glb"};
  Arguments after = {"relight", "b.prt.glb"};
  before.insert(before.end(), light.begin(), light.end());
  after.insert(after.end(), light.begin(), light.end());
  before.push_back("a.exr");
  after.push_back("b.exr");
  succeed(before);
  succeed(after);
  // A vertex' radiance errs by at most |T - T'||l|; with all of the error in one of 60 vertices, that is sqrt(60) times the root mean square.
  // |T||l| over T.l is below 4 for this light.
  const auto difference = nlohmann::json::parse(succeed({"compare", "a.exr", "b.exr", "--json", "-"}));
  EXPECT_LE(difference["relative_rmse"].get<double>(), 30.0 * json["error"].get<double>());
  EXPECT_GT(difference["max_abs"].get<double>(), 0.0);  // the comparison can fail
}

TEST_F(CompressCommand, TargetErrorIsKept) {
  const auto coarse = compress({"--target-error", "0.3"});
  const auto fine = compress({"--target-error", "0.02"});
  EXPECT_LE(coarse["error"], 0.3);
  EXPECT_LE(fine["error"], 0.02);
  EXPECT_LT(coarse["bytes_per_vertex"], fine["bytes_per_vertex"]);
  EXPECT_LT(fine["bytes_per_vertex"], 36.0);
  EXPECT_GE(fine["tried"], 1);
}

TEST_F(CompressCommand, GivesTheSameFileForAnyNumberOfThreads) {
  (void)compress({"--clusters", "9", "--components", "2", "--threads", "1"});
  const std::string one = read("b.prt.glb");
  (void)compress({"--clusters", "9", "--components", "2", "--threads", "2"});
  EXPECT_EQ(one, read("b.prt.glb"));
  (void)compress({"--clusters", "9", "--components", "2", "--seed", "5"});
  EXPECT_NE(one, read("b.prt.glb"));  // the comparison can fail
}

TEST_F(CompressCommand, RefusesWhatCannotBe) {
  const Arguments verb = {"compress", "a.prt.glb", "-o", "c.prt.glb"};
  const auto refused = [&](const Arguments& further, const std::vector<std::string>& words) {
    Arguments arguments = verb;
    arguments.insert(arguments.end(), further.begin(), further.end());
    expect_refused(arguments, words);
  };
  refused({"--bits", "7"}, {"--bits"});
  refused({"--bits", "8,x"}, {"--bits"});
  refused({"--clusters", "0"}, {"--clusters"});
  refused({"--clusters", "61"}, {"clusters"});
  refused({"--components", "10"}, {"components", "9"});
  refused({"--method", "jpeg"}, {"--method"});
  refused({"--method", "pca", "--clusters", "3"}, {"pca"});
  refused({"--method", "vq", "--components", "3"}, {"vq"});
  refused({"--target-error", "0"}, {"--target-error"});
  refused({"--target-error", "0.1", "--clusters", "3"}, {"--target-error"});
  refused({"--method", "vq", "--target-error", "1e-12"}, {"--target-error", "vq"});
  (void)compress({"--clusters", "4"});
  expect_refused({"compress", "b.prt.glb", "-o", "c.prt.glb"}, {"b.prt.glb", "compressed already"});
}

}  // namespace
}  // namespace plumbline::app
