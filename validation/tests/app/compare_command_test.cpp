// compare through the executable: metrics, verdicts and exit codes.
#include <cmath>
#include <limits>

#include "reference/image/exr.hpp"
#include "reference/image/file.hpp"
#include "validation/tests/app/command.hpp"

namespace plumbline::app {
namespace {

constexpr int kPassed = 0;
constexpr int kFailed = 1;

class CompareCommand : public CommandTest {
 protected:
  CompareCommand() {
    write_image("one.exr", 8, 6, 1.0F);
    write_image("more.exr", 8, 6, 1.5F);
  }

  // One pixel of eight by six is NaN.
  void write_with_nan(const std::string& name) const {
    image::LayeredImage layers = read_image("one.exr");
    layers.channels["G"][5] = std::numeric_limits<float>::quiet_NaN();
    image::write_exr(path(name), layers);
  }

  [[nodiscard]] int verdict(const std::string& test, const Arguments& limits,
                            const std::string& failed) const {
    Arguments arguments = {"compare", "one.exr", test, "--json", "-"};
    arguments.insert(arguments.end(), limits.begin(), limits.end());
    const Outcome outcome = run(arguments);
    EXPECT_EQ(nlohmann::json::parse(outcome.out)["failed"].dump(), failed);
    EXPECT_EQ(outcome.err.empty(), outcome.code == 0) << outcome.err;
    return outcome.code;
  }
};

TEST_F(CompareCommand, GivesEveryMetric) {
  const auto json = nlohmann::json::parse(succeed({"compare", "one.exr", "more.exr", "--json", "-"}));
  for (const char* name : {"rmse", "relative_rmse", "mse_unbiased", "max_abs", "mean_signed", "bias_z",
                           "psnr", "flip_mean", "ssim", "pixels", "nonfinite"}) {
    EXPECT_TRUE(json.contains(name)) << name;
  }
  EXPECT_EQ(json["rmse"], 0.5);
  EXPECT_EQ(json["mean_signed"], 0.5);
  EXPECT_EQ(json["pixels"], 48);
  EXPECT_EQ(json["nonfinite"], 0);
  const std::string text = succeed({"compare", "one.exr", "more.exr"});
  EXPECT_NE(text.find("relative_rmse        0.5\n"), std::string::npos) << text;
}

TEST_F(CompareCommand, FailsWhereAMetricIsAboveItsLimit) {
  EXPECT_EQ(verdict("more.exr", {"--fail-above", "rmse=0.4"}, R"(["rmse"])"), kFailed);
  EXPECT_EQ(verdict("more.exr", {"--fail-above", "rmse=0.6"}, "[]"), kPassed);
  EXPECT_EQ(
      verdict("more.exr", {"--fail-above", "rmse=0.6", "--fail-above", "max_abs=0.1"}, R"(["max_abs"])"),
      kFailed);
}

TEST_F(CompareCommand, TakesLimitsBeforeTheImages) {
  const Outcome outcome = run({"compare", "--fail-above", "rmse=0.4", "one.exr", "more.exr"});
  EXPECT_EQ(outcome.code, kFailed);
  EXPECT_EQ(outcome.err, "plumbline: failed: rmse: expected at most 0.4, got 0.5\n");
  EXPECT_EQ(run({"compare", "--fail-above", "rmse=0.6", "one.exr", "more.exr"}).code, kPassed);
}

TEST_F(CompareCommand, FailsBelowForMetricsThatAreBetterWhenLarger) {
  EXPECT_EQ(verdict("one.exr", {"--fail-below", "ssim=0.9"}, "[]"), kPassed);
  EXPECT_EQ(verdict("one.exr", {"--fail-below", "ssim=1.1"}, R"(["ssim"])"), kFailed);
}

TEST_F(CompareCommand, FailsOnPixelsThatAreNotFiniteWhateverTheLimit) {
  write_with_nan("nan.exr");
  EXPECT_EQ(verdict("nan.exr", {"--fail-above", "rmse=1"}, R"(["nonfinite"])"), kFailed);
  EXPECT_EQ(verdict("nan.exr", {"--fail-above", "nonfinite=0"}, R"(["nonfinite"])"), kFailed);
  EXPECT_EQ(verdict("nan.exr", {"--fail-below", "psnr=1"}, R"(["nonfinite"])"), kFailed);
}

TEST_F(CompareCommand, CountsPixelsThatAreNotFinite) {
  write_with_nan("nan.exr");
  const auto json = nlohmann::json::parse(succeed({"compare", "one.exr", "nan.exr", "--json", "-"}));
  EXPECT_EQ(json["nonfinite"], 1);
  EXPECT_EQ(json["pixels"], 47);
  write_image("all.exr", 8, 6, std::numeric_limits<float>::quiet_NaN());
  const Outcome outcome =
      run({"compare", "one.exr", "all.exr", "--fail-above", "rmse=inf", "--json", "a.json"});
  EXPECT_EQ(outcome.code, kFailed);
  EXPECT_EQ(read_json("a.json")["pixels"], 0);
  EXPECT_EQ(read_json("a.json")["rmse"], "nan");
}

TEST_F(CompareCommand, KeepsItsVerdictWhenNobodyReads) {
  const Arguments arguments = {"compare", "one.exr", "more.exr", "--fail-above", "rmse=0.4"};
  EXPECT_EQ(run(arguments, StandardOutput::broken_pipe).code, kFailed);
}

TEST_F(CompareCommand, DrawsAHeatMap) {
  (void)succeed({"compare", "one.exr", "more.exr", "--heatmap", "heat.png"});
  const image::Image heat = image::read_image(path("heat.png"));
  EXPECT_EQ(heat.width, 8);
  EXPECT_EQ(heat.height, 6);
}

TEST_F(CompareCommand, ReadsImagesThatAreNoExr) {
  image::write_png(path("a.png"), image::tone_map(image::make_image(8, 6, Rgb(1.0F))));
  const auto json = nlohmann::json::parse(succeed({"compare", "one.exr", "a.png", "--json", "-"}));
  EXPECT_EQ(json["rmse"], 0.0);  // white is 1 in both
}

}  // namespace
}  // namespace plumbline::app
