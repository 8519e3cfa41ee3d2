// What every verb shares: help, usage errors, standard streams.
#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "validation/tests/app/command.hpp"

namespace plumbline::app {
namespace {

class Command : public CommandTest {
 protected:
  // The command names its verbs where it refuses one.
  [[nodiscard]] std::vector<std::string> verbs() const {
    const std::string line = run({"no-such-verb"}).err;
    const std::string_view kBefore = "there are: ";
    std::stringstream names(line.substr(line.find(kBefore) + kBefore.size()));
    std::vector<std::string> result;
    for (std::string name; names >> name;) {
      if (name.ends_with(',')) name.pop_back();
      result.push_back(name);
    }
    return result;
  }

  void expect_help(const Arguments& arguments) const {
    const std::string text = succeed(arguments);
    EXPECT_NE(text.find("Example: plumbline"), std::string::npos) << text;
  }
};

TEST_F(Command, RefusalCheckSeesEveryFault) {
  const Outcome good{2, "", "plumbline: a.exr: no such file\n"};
  EXPECT_EQ(fault_of_refusal(good, {"a.exr", "no such file"}, {}, {}), "");
  EXPECT_NE(fault_of_refusal({0, "", good.err}, {}, {}, {}), "");
  EXPECT_NE(fault_of_refusal({-1, "", good.err}, {}, {}, {}), "");
  EXPECT_NE(fault_of_refusal({2, "text", good.err}, {}, {}, {}), "");
  EXPECT_NE(fault_of_refusal({2, "", ""}, {}, {}, {}), "");
  EXPECT_NE(fault_of_refusal({2, "", "plumbline: a\nb\n"}, {}, {}, {}), "");
  EXPECT_NE(fault_of_refusal({2, "", "a.exr: no such file\n"}, {}, {}, {}), "");
  EXPECT_NE(fault_of_refusal({2, "", "plumbline: .a.partial-1.exr\n"}, {}, {}, {}), "");
  EXPECT_NE(fault_of_refusal(good, {"b.exr"}, {}, {}), "");
  EXPECT_NE(fault_of_refusal(good, {"a.exr"}, {}, {{"a.exr", ""}}), "");
  EXPECT_NE(fault_of_refusal(good, {"a.exr"}, {{"a.exr", "old"}}, {{"a.exr", "new"}}), "");
}

TEST_F(Command, HelpShowsAnExample) {
  expect_help({"--help"});
  EXPECT_NE(succeed({"--version"}).find("plumbline "), std::string::npos);
}

TEST_F(Command, HelpOfVerbsThatTraceShowsAnExample) {
  for (const char* verb : {"render", "merge", "gather"}) expect_help({verb, "--help"});
}

TEST_F(Command, HelpOfVerbsThatBakeShowsAnExample) {
  for (const char* verb : {"project", "bake", "relight"}) expect_help({verb, "--help"});
}

TEST_F(Command, HelpOfAllOtherVerbsShowsAnExample) {
  const std::vector<std::string> tested = {"render", "merge", "gather", "project", "bake", "relight"};
  const std::vector<std::string> names = verbs();
  EXPECT_GE(names.size(), 9U);
  for (const std::string& verb : names) {
    if (std::find(tested.begin(), tested.end(), verb) == tested.end()) expect_help({verb, "--help"});
  }
}

TEST_F(Command, ScenesListsWhatIsBuiltIn) {
  const std::string text = succeed({"scenes"});
  EXPECT_NE(text.find("builtin:cornell"), std::string::npos);
  EXPECT_NE(text.find("builtin:two-lobes"), std::string::npos);
  const auto json = nlohmann::json::parse(succeed({"scenes", "--json", "-"}));
  EXPECT_EQ(json["scenes"][0].size(), 2U);
  EXPECT_EQ(json["environments"][0]["name"], "white");
}

// ---------------------------------------------------------------- usage

TEST_F(Command, RefusesWrongVerbs) {
  expect_refused({}, {"no verb given", "render, merge"});
  expect_refused({"foo"}, {"unknown verb foo", "render, merge, gather"});
  expect_refused({""}, {"unknown verb ''"});
  expect_refused({"--foo", "render"}, {"--foo", "unknown option"});
}

TEST_F(Command, RefusesWrongUsageOfAVerb) {
  expect_refused({"scenes", "--foo"}, {"--foo", "not expected", "plumbline scenes --help"});
  expect_refused({"render"}, {"SCENE is required"});
  expect_refused({"render", "builtin:cornell"}, {"--output is required"});
  expect_refused({"render", "builtin:cornell", "extra", "-o", "a.exr"}, {"extra", "not expected"});
}

TEST_F(Command, RefusesOptionsWithoutOrWithTwoValues) {
  expect_refused({"render", "builtin:cornell", "-o"}, {"--output"});
  expect_refused({"render", "builtin:cornell", "-o", "a.exr", "--spp", "1", "--spp", "2"}, {"--spp"});
  expect_refused({"render", "builtin:cornell", "-o", ""}, {"--output", "expected the name of a file"});
  expect_refused({"project", "builtin:white"}, {"--bands is required"});
}

// ---------------------------------------------------------------- standard streams

TEST_F(Command, AReaderThatStopsReadingIsNoError) {
  for (const Arguments& arguments : {Arguments{"scenes"}, Arguments{"scenes", "--help"}}) {
    const Outcome outcome = run(arguments, StandardOutput::broken_pipe);
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.err, "");
  }
}

TEST_F(Command, SaysWhenStandardOutputCannotBeWritten) {
  for (const StandardOutput kind : {StandardOutput::full_disk, StandardOutput::closed}) {
    const Outcome outcome = run({"project", "builtin:white", "--bands", "2"}, kind);
    EXPECT_EQ(fault_of_refusal(outcome, {"standard output: cannot write"}, {}, {}), "") << outcome.err;
  }
}

TEST_F(Command, WritesTheSameFileWithStandardOutputClosed) {
  const Arguments render = {
      "render", "builtin:corner", "--env", "builtin:white", "--size", "4x4", "--spp", "2", "-o", "a.exr"};
  EXPECT_EQ(run(render, StandardOutput::closed).code, 0);
  const std::string file = read("a.exr");
  (void)succeed(render);
  EXPECT_EQ(file, read("a.exr"));
}

}  // namespace
}  // namespace plumbline::app
