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
