// identify, conventions, and project --convention through the executable.
#include <fmt/format.h>

#include <array>
#include <fstream>
#include <sstream>

#include "validation/tests/app/command.hpp"

namespace plumbline::app {
namespace {

using IdentifyCommand = CommandTest;

constexpr const char* kCity = "/usr/share/blender/datafiles/studiolights/world/city.exr";

TEST_F(IdentifyCommand, TellsWhatProjectWrote) {
  (void)succeed(
      {"project", "builtin:two-lobes", "--bands", "3", "--convention", "filament-shader", "-o", "a.json"});
  const Outcome outcome = run({"identify", "a.json", "--env", "builtin:two-lobes", "--json", "b.json"});
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_NE(outcome.out.find("identified"), std::string::npos);
  EXPECT_NE(outcome.out.find("mirrored"), std::string::npos);
  const nlohmann::json json = read_json("b.json");
  EXPECT_EQ(json["verdict"], "identified");
  EXPECT_EQ(json["ranking"].size(), 3U);
  EXPECT_EQ(json["ranking"][0]["known"][0], "filament-shader");
  EXPECT_GE(json["ranking"][1]["log10_odds_behind_best"].get<double>(), 4.0);
  EXPECT_EQ(json["ranking"][0]["readings"][0]["axes"], "-x, y, z");
}

TEST_F(IdentifyCommand, TakesAnyNestingAndDirections) {
  // One directional light of irradiance 1, 2, 3 from (2, 3, 6)/7, radiance, no Condon-Shortley sign, six digits.
  const std::array<double, 9> c{.282095, .209401, .418803, .139601, .133782,
                                .401345, .379757, .267564, -.055743};
  write("d.csv", "x,y,z,r,g,b\n2,3,6,1,2,3\n");
  std::string rows;
  std::string planes;
  for (const double v : c)
    rows += fmt::format("{}[{}, {}, {}]", rows.empty() ? "" : ",", v, 2.0 * v, 3.0 * v);
  for (int k = 1; k <= 3; ++k) {
    for (const double v : c) planes += (planes.empty() ? "" : ",") + std::to_string(v * k);
  }
  write("rows.json", "[" + rows + "]");
  write("planes.json", "[" + planes + "]");
  const auto answer = [&](const std::string& file) {
    const Outcome outcome = run({"identify", file, "--directions", "d.csv", "--json", "-"});
    EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
    return nlohmann::json::parse(outcome.out)["ranking"][0]["known"][0].get<std::string>();
  };
  EXPECT_EQ(answer("rows.json"), "threejs");
  EXPECT_EQ(answer("planes.json"), "arkit-radiance");
}

TEST_F(IdentifyCommand, SaysWhenTheLightCannotTell) {
  (void)succeed({"project", "builtin:white", "--bands", "3", "--convention", "unity", "-o", "a.json"});
  const Outcome outcome = run({"identify", "a.json", "--env", "builtin:white"});
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(outcome.out.find("cannot be decided"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("would decide"), std::string::npos) << outcome.out;
  const Outcome alone = run({"identify", "a.json"});
  EXPECT_EQ(alone.code, 1);
  EXPECT_NE(alone.out.find("possible: "), std::string::npos) << alone.out;
  const Outcome other = run({"identify", "a.json", "--env", "builtin:two-lobes"});
  EXPECT_EQ(other.code, 1);
  EXPECT_NE(other.out.find("no convention explains"), std::string::npos) << other.out;
}

TEST_F(IdentifyCommand, RefusesWhatIsNoSetOfNumbers) {
  const auto refused = [this](const char* text, const std::vector<std::string>& words) {
    write("a.json", text);
    expect_refused({"identify", "a.json"}, words);
  };
  expect_refused({"identify", "missing.json"}, {"missing.json"});
  refused("[1, 2", {"a.json", "not valid JSON"});
  refused("[1,2,3,4,5,6,7,8,9,10]", {"a.json", "10 numbers", "3 n^2"});
  refused("[1, 2, 3, NaN]", {"a.json", "not valid JSON"});
  refused("[[1, 2], [3, null]]", {"a.json", "[1][1]", "null"});
  refused("[1, 2, 1e999, 4]", {"a.json"});
  refused("{\"sh\": [1]}", {"a.json", "coefficients"});
  refused("{\"coefficients\": \"1\"}", {"a.json", "coefficients"});
  refused("[]", {"a.json", "no numbers"});
  refused("[[[[[[[[[[[[1]]]]]]]]]]]]", {"a.json", "expected finite numbers"});
}

TEST_F(IdentifyCommand, RefusesDirectionsThatAreNone) {
  write("a.json", "[1, 2, 3, 4]");
  const auto refused = [this](const char* text, const std::vector<std::string>& words) {
    write("d.csv", text);
    expect_refused({"identify", "a.json", "--directions", "d.csv"}, words);
  };
  refused("", {"d.csv", "no directions"});
  refused("1,2,3\n", {"d.csv: line 1", "x,y,z,r,g,b"});
  refused("0,0,0,1,1,1\n", {"d.csv: line 1", "no length"});
  refused("1,0,nan,1,1,1\n", {"d.csv: line 1: column 3"});
  expect_refused({"identify", "a.json", "--directions", "none.csv"}, {"none.csv"});
  expect_refused({"identify", "a.json", "--directions", "d.csv", "--env", "builtin:white"}, {"--env"});
}

TEST_F(IdentifyCommand, ProjectWritesOtherConventionsThatOnlyIdentifyReads) {
  const Arguments project = {"project", "builtin:white", "--bands", "3"};
  const auto with = [&](const std::string& name) {
    Arguments arguments = project;
    arguments.insert(arguments.end(), {"--convention", name});
    return arguments;
  };
  EXPECT_EQ(succeed(with("plumbline")), succeed(project));
  const auto unity = nlohmann::json::parse(succeed(with("unity")));
  EXPECT_EQ(unity["convention"], "unity");
  EXPECT_EQ(unity["coefficients"].size(), 3U);
  EXPECT_NEAR(unity["coefficients"][0][0].get<double>(), 1.0, 1e-14);
  write("unity.json", unity.dump());
  expect_refused({"project", "unity.json", "--bands", "3"}, {"unity.json", "convention"});
  expect_refused(with("nobody"), {"nobody", "plumbline conventions"});
  expect_refused({"project", "builtin:white", "--bands", "4", "--convention", "unity"},
                 {"unity", "3 bands", "4"});
  expect_refused({"project", "builtin:white", "--bands", "2", "--convention", "unity-shader"}, {"3 bands"});
}

/// The lines between two marks.
std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t first = text.find(begin);
  const std::size_t last = text.find(end);
  if (first == std::string::npos || last == std::string::npos) return "";
  return text.substr(first + begin.size(), last - first - begin.size());
}

TEST_F(IdentifyCommand, TheTableOfConventionsIsTheOneThatIsPrinted) {
  std::ifstream file(std::filesystem::path(PLUMBLINE_DATA).parent_path() / "CONVENTIONS.md");
  std::stringstream text;
  text << file.rdbuf();
  const std::string table =
      between(text.str(), "<!-- plumbline conventions --markdown -->\n", "<!-- end -->");
  const std::string printed = succeed({"conventions", "--markdown"});
  EXPECT_EQ(table, printed)
      << "run `plumbline conventions --markdown` and put its output into CONVENTIONS.md";
  EXPECT_NE(table + "x", printed);
  EXPECT_EQ(between("a<b>c", "<", ">"), "b");
  const auto json = nlohmann::json::parse(succeed({"conventions", "--json", "-"}));
  EXPECT_EQ(json["conventions"][0]["name"], "plumbline");
  EXPECT_NE(succeed({"conventions"}).find("filament-shader"), std::string::npos);
}

TEST_F(IdentifyCommand, RecognisesARealSkyThroughFiles) {
  for (const char* name : {"unity-shader", "godot-lightmap"}) {
    const std::string bands = std::string(name) == "godot-lightmap" ? "20" : "3";
    (void)run({"project", kCity, "--bands", bands, "--convention", name, "-o", "a.json"});
    const Outcome outcome = run({"identify", "a.json", "--env", kCity, "--json", "-"});
    EXPECT_EQ(outcome.code, 0) << outcome.out;
    const std::string known = nlohmann::json::parse(outcome.out)["ranking"][0]["known"].dump();
    EXPECT_NE(known.find(name), std::string::npos) << known;
  }
}

}  // namespace
}  // namespace plumbline::app
