// `relight --backend gl` through the executable.
#include <fmt/format.h>

#include <cstdlib>

#include "validation/tests/app/command.hpp"

namespace plumbline::app {
namespace {

/// Set while it lives.
class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) { setenv(name, value.c_str(), 1); }
  ~Variable() { unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
};

std::string hostile(const std::string& misdeed) {
  return fmt::format("{}/lib{}_osmesa.so", PLUMBLINE_CONFORMANCE, misdeed);
}

class GlCommand : public CommandTest {
 protected:
  GlCommand() {
    (void)succeed({"bake", "builtin:convex", "--bands", "3", "--transfer", "unshadowed", "-o", "a.prt.glb"});
  }
  [[nodiscard]] static Arguments relight(const Arguments& further = {}) {
    Arguments arguments = {"relight", "a.prt.glb", "--env", "builtin:sun-sky",
                           "--size",  "40x30",     "-o",    "a.exr"};
    arguments.insert(arguments.end(), further.begin(), further.end());
    return arguments;
  }
};

TEST_F(GlCommand, MissingOrBrokenOpenGlIsOneLineAndTheCpuStillWorks) {
  const Variable no_egl("PLUMBLINE_EGL", "/none/libEGL.so");
  {
    const Variable none("PLUMBLINE_OSMESA", "/none/libOSMesa.so");
    expect_refused(relight({"--backend", "gl"}), {"no context", "/none/libOSMesa.so", "/none/libEGL.so"});
    expect_refused(relight({"--backend", "gl", "--gl-context", "egl"}), {"EGL", "/none/libEGL.so"});
    (void)succeed(relight({"--backend", "cpu"}));
    std::filesystem::remove(path("a.exr"));
  }
  const std::pair<const char*, Arguments> misdeeds[] = {{"lacks_entry", {"OSMesaCreateContextAttribs"}},
                                                        {"lacks_function", {"glTexBuffer"}},
                                                        {"no_context", {"no context of OpenGL 3.3"}},
                                                        {"not_current", {"cannot be made current"}},
                                                        {"link_error", {"program", "the stages do not fit"}}};
  for (const auto& [misdeed, words] : misdeeds) {
    const Variable library("PLUMBLINE_OSMESA", hostile(misdeed));
    expect_refused(relight({"--backend", "gl", "--gl-context", "osmesa"}), words);
  }
}

// Each provider gives the CPU's image, or says in one line that it is not there.
TEST_F(GlCommand, GivesTheCpusImage) {
  (void)succeed(relight({"--backend", "cpu"}));
  const image::LayeredImage cpu = read_image("a.exr");
  int present = 0;
  for (const std::string context : {"osmesa", "egl"}) {
    const Arguments arguments = relight({"--backend", "gl", "--gl-context", context, "--json", "a.json"});
    const Outcome outcome = run(arguments);
    if (outcome.code == 2) {
      EXPECT_EQ(fault_of_refusal(outcome, {context == "egl" ? "EGL" : "OSMesa"}, {}, {}), "");
      continue;
    }
    ++present;
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const image::LayeredImage gl = read_image("a.exr");
    ASSERT_EQ(gl.channels.size(), cpu.channels.size());
    for (const auto& [name, values] : cpu.channels) {
      const std::vector<float>& found = gl.channels.at(name);
      ASSERT_EQ(found.size(), values.size());
      // A silhouette's sample that falls to the other side is a 16th of its pixel.
      std::size_t apart = 0;
      for (std::size_t i = 0; i < values.size(); ++i)
        apart += std::abs(found[i] - values[i]) <= 1e-5F * std::abs(values[i]) ? 0U : 1U;
      EXPECT_LE(apart, values.size() / 100) << name;
    }
    const nlohmann::json summary = read_json("a.json");
    EXPECT_EQ(summary["backend"], "gl");
    EXPECT_TRUE(summary["gl"]["driver"].get<std::string>().starts_with(context));
    for (const char* step : {"context", "upload", "vertices", "image", "frame"})
      EXPECT_GE(summary["gl"][std::string("seconds_") + step].get<double>(), 0.0) << step;
  }
  fmt::print("{} of 2 providers are here\n", present);
}

TEST_F(GlCommand, NoOtherWorkLoadsOpenGl) {
  const Variable debug("LD_DEBUG", "files");
  const Outcome cpu = run(relight({"--backend", "cpu"}));
  EXPECT_EQ(cpu.code, 0);
  ASSERT_NE(cpu.err.find("libembree"), std::string::npos);  // the loader's report is there
  EXPECT_EQ(cpu.err.find("libOSMesa"), std::string::npos);
  EXPECT_EQ(cpu.err.find("libEGL"), std::string::npos);
  const Outcome gl = run(relight({"--backend", "gl", "--gl-context", "osmesa"}));
  EXPECT_NE(gl.err.find("libOSMesa"), std::string::npos);  // tried at least
}

TEST_F(GlCommand, RefusesUnknownChoices) {
  expect_refused(relight({"--backend", "vulkan"}), {"--backend", "vulkan"});
  expect_refused(relight({"--backend", "gl", "--gl-context", "glx"}), {"--gl-context", "glx"});
  expect_refused(relight({"--backend", "gl", "--gl-storage", "f8"}), {"--gl-storage", "f8"});
  expect_refused(relight({"--backend", "gl", "--gl-target", "unorm8"}), {"--gl-target", "unorm8"});
}

}  // namespace
}  // namespace plumbline::app
