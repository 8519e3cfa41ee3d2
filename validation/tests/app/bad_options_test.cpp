// Values of options that make no sense: each is refused in one line that names the option, and a file that was
// there stays as it was.
#include "validation/tests/app/command.hpp"

namespace plumbline::app {
namespace {

class BadOptions : public CommandTest {
 protected:
  BadOptions() { write("out.exr", "old"); }

  void expect_render_refused(const std::string& option, const std::vector<std::string>& values,
                             const std::string& reason) const {
    for (const std::string& value : values) {
      expect_refused({"render", "builtin:corner", "-o", "out.exr", option, value}, {option, reason, value});
    }
  }
};

TEST_F(BadOptions, RefusesSizes) {
  expect_render_refused("--size", {"0x10", "-5x5", "10", "1000000x1000000"}, "expected WIDTHxHEIGHT");
}

TEST_F(BadOptions, RefusesMoreSizes) {
  expect_render_refused("--size", {"99999999999x1", "4x4x4", "4.5x4"}, "expected WIDTHxHEIGHT");
}

TEST_F(BadOptions, RefusesSampleCounts) {
  expect_render_refused("--spp", {"0", "-3", "x", "99999999999"}, "expected a whole number from 1");
}

TEST_F(BadOptions, RefusesBounces) {
  expect_render_refused("--bounces", {"-1", "x", "99999999999"}, "expected 0, 1, 2, ... or all");
}

TEST_F(BadOptions, RefusesErrorTargets) {
  expect_render_refused("--target-error", {"0", "nan", "-1", "x"}, "expected a number above 0");
}

TEST_F(BadOptions, RefusesTimes) {
  expect_render_refused("--max-seconds", {"0", "-1", "inf"}, "expected a number above 0");
}

TEST_F(BadOptions, RefusesShards) {
  expect_render_refused("--shard", {"2/2", "x", "0/0", "-1/2"}, "expected i/N");
}

TEST_F(BadOptions, RefusesThreadsAndSeeds) {
  expect_render_refused("--threads", {"-1"}, "expected a whole number from 0");
  expect_render_refused("--seed", {"x", "-1", "18446744073709551616"}, "expected a whole number from 0");
}

TEST_F(BadOptions, RefusesCameraLayerCreaseAndRotation) {
  expect_render_refused("--camera", {"none-of-this-name"}, "no camera");
  expect_render_refused("--layers", {"colour"}, "expected emission");
  expect_render_refused("--crease", {"nan"}, "expected an angle");
}

TEST_F(BadOptions, RefusesRotationsThatAreNotThreeAngles) {
  expect_render_refused("--rotate-env", {"1,2", "x,0,0", "0,nan,0", "1,2,3,4"},
                        "expected three angles X,Y,Z");
}

TEST_F(BadOptions, RefusesOptionsThatExcludeEachOther) {
  const Arguments render = {"render", "builtin:corner", "-o", "out.exr", "--target-error", "0.1"};
  Arguments with_samples = render;
  with_samples.insert(with_samples.end(), {"--spp", "4"});
  expect_refused(with_samples, {"--spp", "--target-error"});
  Arguments with_shard = render;
  with_shard.insert(with_shard.end(), {"--shard", "0/2"});
  expect_refused(with_shard, {"--shard", "--target-error"});
}

TEST_F(BadOptions, RefusesBands) {
  for (const char* value : {"0", "-1", "100000", "x"}) {
    expect_refused({"project", "builtin:white", "--bands", value, "-o", "out.exr"},
                   {"--bands", "expected a whole number from 1 to 1000", value});
  }
}

TEST_F(BadOptions, RefusesTheSameOfBake) {
  expect_refused({"bake", "builtin:convex", "--bands", "0", "-o", "a.glb"}, {"--bands", "got 0"});
  expect_refused({"bake", "builtin:convex", "--bands", "2", "--samples", "0", "-o", "a.glb"}, {"--samples"});
  expect_refused({"bake", "builtin:convex", "--bands", "2", "--samples", "3", "-o", "a.glb"}, {"samples"});
  expect_refused({"bake", "builtin:convex", "--bands", "2", "--transfer", "x", "-o", "a.glb"},
                 {"--transfer"});
}

TEST_F(BadOptions, RefusesUnknownBuiltins) {
  expect_refused({"render", "builtin:none", "-o", "out.exr"}, {"builtin:none", "cornell"});
  expect_refused({"render", "builtin:corner", "--env", "builtin:none", "-o", "out.exr"},
                 {"builtin:none", "two-lobes"});
  expect_refused({"project", "builtin:none", "--bands", "2"}, {"builtin:none", "two-lobes"});
}

TEST_F(BadOptions, GatherWantsEitherPointsOrVertices) {
  write("points.csv", "0,0,0,0,1,0\n");
  expect_refused({"gather", "builtin:corner", "-o", "out.csv"}, {"--points", "--vertices"});
  expect_refused({"gather", "builtin:corner", "-o", "out.csv", "--vertices", "--points", "points.csv"},
                 {"--points", "--vertices"});
}

TEST_F(BadOptions, RefusesLimitsOfCompare) {
  write_image("a.exr", 2, 2, 1.0F);
  expect_refused({"compare", "a.exr", "a.exr", "--fail-above", "nonsense"}, {"--fail-above", "nonsense"});
  expect_refused({"compare", "a.exr", "a.exr", "--fail-above", "rmse=x"}, {"--fail-above", "rmse=x"});
  expect_refused({"compare", "a.exr", "a.exr", "--fail-above", "rmse=nan"}, {"--fail-above", "rmse=nan"});
  expect_refused({"compare", "a.exr", "a.exr", "--fail-below", "wrong=1"}, {"--fail-below", "wrong", "ssim"});
}

}  // namespace
}  // namespace plumbline::app
