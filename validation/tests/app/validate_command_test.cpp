// validate through the executable: the files it writes and its exit code.
#include "validation/tests/app/command.hpp"

namespace plumbline::app {
namespace {

class ValidateCommand : public CommandTest {};

TEST_F(ValidateCommand, WritesAPageJsonAndJunit) {
  const Outcome outcome = run({"validate", "builtin:convex", "--env", "builtin:two-lobes", "--bands", "2,3",
                               "--size", "64x48", "--spp", "16", "--samples", "64", "--gather-samples", "32",
                               "-o", "report", "--junit", "tests.xml"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json json = read_json("report/report.json");
  EXPECT_GE(json["findings"].size(), 15U);
  EXPECT_NE(json["verdict"], "fail");
  EXPECT_EQ(json["tables"][0]["rows"].size(), 2U);
  EXPECT_NE(json["command"].get<std::string>().find("--bands 2 3"), std::string::npos);
  EXPECT_NE(read("report/report.html").find("</html>"), std::string::npos);
  EXPECT_NE(read("tests.xml").find("<testsuites"), std::string::npos);
  EXPECT_EQ(read("tests.xml"), read("report/junit.xml"));
}

TEST_F(ValidateCommand, RunsOnlyTheFamiliesAskedFor) {
  EXPECT_EQ(run({"validate", "builtin:convex", "--checks", "basis", "-o", "report"}).code, 0);
  const nlohmann::json json = read_json("report/report.json");
  for (const nlohmann::json& finding : json["findings"]) EXPECT_EQ(finding["family"], "basis");
}

// ---------------------------------------------------------------- baselines

constexpr const char* kGrayPyramid =
    "mtllib p.mtl\nusemtl gray\nv -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv 0 1 0\n"
    "f 2 1 5\nf 3 2 5\nf 4 3 5\nf 1 4 5\nf 1 2 3 4\n";

class BaselineCommand : public CommandTest {
 protected:
  BaselineCommand() {
    write("p.obj", kGrayPyramid);
    write_albedo("0.500");
    write_light("0.2");
  }
  void write_albedo(const std::string& albedo) const {
    write("p.mtl", "newmtl gray\nKd " + albedo + " 0.5 0.5\n");
  }
  void write_light(const std::string& coefficient) const {
    write("light.json",
          R"({"bands": 2, "convention": "orthonormal, Condon-Shortley, index l(l+1)+m, z-polar", )"
          R"("coefficients": [[2, 2, 2], [)" +
              coefficient + ", 0.1, 0.1], [0, 0, 0], [0.3, 0, 0]]}");
  }
  [[nodiscard]] Outcome validate(const Arguments& more) const {
    Arguments arguments = {"validate", "p.obj",  "--env",      "light.json", "--checks",  "basis",
                           "--bands",  "2",      "--spp",      "256",        "--samples", "4096",
                           "-o",       "report", "--baseline", "b.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
};

TEST_F(BaselineCommand, PassesAgainOnAnotherSeedAndFailsForHalfAPercent) {
  EXPECT_EQ(validate({"--update-baseline", "--reason", "first"}).code, 0);
  EXPECT_EQ(read_json("b.json")["history"][0]["reason"], "first");
  const std::string kept = read("b.json");
  EXPECT_EQ(validate({"--seed", "7"}).code, 0);
  write_light("0.201");
  const Outcome light = validate({});
  EXPECT_EQ(light.code, 1);
  EXPECT_NE(light.out.find("coefficient 1 r"), std::string::npos) << light.out;
  write_light("0.2");
  write_albedo("0.4975");
  const Outcome albedo = validate({"--seed", "7"});
  EXPECT_EQ(albedo.code, 1);
  EXPECT_NE(albedo.out.find("path traced / mean r"), std::string::npos) << albedo.out;
  EXPECT_NE(read("report/junit.xml").find("<failure"), std::string::npos);
  EXPECT_EQ(read("b.json"), kept);
  EXPECT_EQ(validate({"--update-baseline", "--reason", "darker paint"}).code, 0);
  EXPECT_EQ(read_json("b.json")["history"].size(), 2U);
  EXPECT_EQ(validate({}).code, 0);
}

TEST_F(BaselineCommand, RefusesBadInput) {
  expect_refused({"validate", "p.obj", "-o", "report", "--update-baseline"},
                 {"--update-baseline", "--baseline"});
  expect_refused({"validate", "p.obj", "-o", "report", "--baseline", "b.json", "--update-baseline"},
                 {"--reason"});
  expect_refused({"validate", "p.obj", "-o", "report", "--baseline", "none.json"},
                 {"none.json", "no such file"});
  write("b.json", "{}");
  expect_refused({"validate", "p.obj", "-o", "report", "--baseline", "b.json"}, {"b.json", "no baseline"});
  write("b.json",
        R"({"format": "plumbline baseline 1", "command": "plumbline validate x", "seed": 0, "machine": {},
                      "findings": [], "quantities": [], "times": [], "history": []})");
  expect_refused({"validate", "p.obj", "-o", "report", "--baseline", "b.json"},
                 {"b.json", "plumbline validate x"});
}

TEST_F(ValidateCommand, RefusesBadInput) {
  write("file", "x");
  expect_refused({"validate", "none.obj", "-o", "report"}, {"none.obj"});
  expect_refused({"validate", "builtin:convex", "--bands", "0", "-o", "report"}, {"--bands"});
  expect_refused({"validate", "--checks", "nonsense", "-o", "report"}, {"--checks"});
  expect_refused({"validate", "builtin:convex", "--checks", "basis", "-o", "file"}, {"file"});
  expect_refused({"validate"}, {"--output"});
}

}  // namespace
}  // namespace plumbline::app
