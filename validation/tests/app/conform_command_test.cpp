// plumbline conform, on libraries that are right, lossy, and hostile.
#include <fmt/format.h>

#include <cstdio>
#include <string>

#include "validation/tests/app/command.hpp"

namespace plumbline::app {
namespace {

class ConformCommand : public CommandTest {
 protected:
  static std::string library(const std::string& name) {
    return std::string(PLUMBLINE_CONFORMANCE) + "/lib" + name + "_conformance.so";
  }
  [[nodiscard]] Outcome conform(const std::string& name, const Arguments& more = {}) const {
    Arguments arguments{"conform", library(name)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  /// Exit code 1, the words on standard output, nothing on standard error.
  void expect_finding(const std::string& name, const std::string& words, const Arguments& more = {}) const {
    const Outcome outcome = conform(name, more);
    EXPECT_EQ(outcome.code, 1) << name;
    EXPECT_NE(outcome.out.find(words), std::string::npos) << name << ":\n" << outcome.out;
    EXPECT_EQ(outcome.err, "") << name;
  }
};

TEST_F(ConformCommand, OurOwnLibraryPasses) {
  const Outcome outcome =
      conform("plumbline_sh", {"--json", "ours.json", "--html", "ours.html", "--junit", "ours.xml"});
  EXPECT_EQ(outcome.code, 0) << outcome.out;
  const nlohmann::json json = read_json("ours.json");
  EXPECT_EQ(json.at("verdict"), "pass");
  EXPECT_GE(json.at("findings").size(), 55U);
  EXPECT_NE(read("ours.html").find("evaluate basis"), std::string::npos);
  EXPECT_NE(read("ours.xml").find("failures=\"0\""), std::string::npos);
  EXPECT_NE(outcome.out.find("x ours"), std::string::npos);
}

TEST_F(ConformCommand, TheExampleOfTheReadmePasses) {
  const Outcome outcome = conform("example");
  EXPECT_EQ(outcome.code, 0) << outcome.out;
}

// GSL is given z alone and takes sin theta from it.
TEST_F(ConformCommand, GslLosesDigitsNearThePolesAndNothingElse) {
  const Outcome outcome = conform("gsl", {"--json", "gsl.json"});
  EXPECT_EQ(outcome.code, 1);
  for (const nlohmann::json& finding : read_json("gsl.json").at("findings")) {
    if (finding.at("verdict") == "pass") continue;
    EXPECT_NE(finding.at("detail").get<std::string>().find("lost near the poles"), std::string::npos)
        << finding.dump();
  }
}

// Boost is given the angle theta, which close to pi holds 16 digits of pi and few of pi - theta.
TEST_F(ConformCommand, BoostLosesDigitsAtTheSouthPoleAlone) {
  const Outcome outcome = conform("boost", {"--json", "boost.json"});
  EXPECT_EQ(outcome.code, 1);
  for (const nlohmann::json& finding : read_json("boost.json").at("findings")) {
    if (finding.at("verdict") == "pass") continue;
    EXPECT_EQ(finding.at("name"), "digits near the poles / 6 bands") << finding.dump();
    EXPECT_NE(finding.at("detail").get<std::string>().find("rad from -z"), std::string::npos);
  }
}

TEST_F(ConformCommand, WhatALibraryDoesToTheProcessIsAFinding) {
  expect_finding("crashes", "crashes (SIGSEGV)");
  expect_finding("hangs", "hangs: no answer within 0.5 s", {"--seconds", "0.5"});
  expect_finding("exits", "ends the process with exit code 0");
  expect_finding("aborts", "crashes (SIGABRT)");
  expect_finding("crashes_on_load", "crashes (SIGABRT)");
  expect_finding("writes_outside", "relight writes outside its output");
}

TEST_F(ConformCommand, LiesAboutTheStructAreFindings) {
  expect_finding("wrong_size", "struct_size is");
  expect_finding("wrong_version", "abi_version is 99, expected 1");
  expect_finding("null", "plumbline_conformance_entry returns NULL for version 1");
  expect_finding("no_entry", "does not export plumbline_conformance_entry");
  expect_finding("lies", "max_bands is -5");
}

TEST_F(ConformCommand, RefusesWhatIsNoLibrary) {
  write("text.so", "hello");
  expect_refused({"conform", "text.so"}, {"text.so", "cannot be loaded"});
  expect_refused({"conform", "missing.so"}, {"missing.so", "no such file"});
  expect_refused({"conform", "."}, {"not a file"});
  expect_refused({"conform"}, {"LIBRARY", "--export", "--import", "--faults"});
  expect_refused({"conform", library("gsl"), "--bands", "21"}, {"--bands", "1 to 20"});
  expect_refused({"conform", library("gsl"), "--faults"}, {"one of"});
}

// ---------------------------------------------------------------- files
TEST_F(ConformCommand, MissingAnswersAreCountedNotPassed) {
  succeed({"conform", "--export", "questions", "--bands", "3"});
  const Outcome outcome = run({"conform", "--import", "questions"});
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.out.find("6 checks: 0 passed, 0 failed, 6 inconclusive"), std::string::npos)
      << outcome.out;
}

/// The rows of a CSV file, each mapped to another row.
template <class Map>
std::string answered(const std::string& csv, const Map& map) {
  std::string result;
  for (std::size_t begin = 0; begin < csv.size();) {
    const std::size_t end = csv.find('\n', begin);
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;
    std::sscanf(csv.substr(begin, end - begin).c_str(), "%lf,%lf,%lf", &x, &y, &z);
    result += map(x, y, z) + "\n";
    begin = end + 1;
  }
  return result;
}

TEST_F(ConformCommand, JudgesAnswersFromFiles) {
  succeed({"conform", "--export", "questions", "--bands", "2"});
  write("questions/convention.json",
        R"({"index_order": 1, "sign": 2, "norm": 1, "axes": [1, 2, 3], "quantity": 1})");
  const auto basis = [](double factor) {
    return [factor](double x, double y, double z) {
      return fmt::format("{:.9g},{:.9g},{:.9g},{:.9g}", factor * 0.28209479, factor * 0.48860251 * y,
                         factor * 0.48860251 * z, factor * 0.48860251 * x);
    };
  };
  write("questions/answer-basis.csv", answered(read("questions/directions.csv"), basis(1.0)));
  const Outcome right = run({"conform", "--import", "questions"});
  EXPECT_EQ(right.code, 0) << right.out;
  EXPECT_NE(right.out.find("1 passed, 0 failed, 5 inconclusive"), std::string::npos) << right.out;
  write("questions/answer-basis.csv", answered(read("questions/directions.csv"), basis(3.14159265)));
  const Outcome wrong = run({"conform", "--import", "questions"});
  EXPECT_EQ(wrong.code, 1);
  EXPECT_NE(wrong.out.find("all values are pi times too large"), std::string::npos) << wrong.out;
}

TEST_F(ConformCommand, RefusesFilesThatAreNoAnswers) {
  expect_refused({"conform", "--import", "nowhere"}, {"nowhere/manifest.json", "no such file"});
  succeed({"conform", "--export", "questions", "--bands", "2"});
  write("questions/answer-basis.csv", "1,2,3,four\n");
  expect_refused({"conform", "--import", "questions"}, {"answer-basis.csv:1", "numbers"});
  write("questions/answer-basis.csv", "1,2,3,4\n");
  expect_refused({"conform", "--import", "questions"}, {"answer-basis.csv", "rows"});
  write("questions/answer-basis.csv", "");
  write("questions/convention.json", "{}");
  expect_refused({"conform", "--import", "questions"}, {"convention.json"});
}

}  // namespace
}  // namespace plumbline::app
