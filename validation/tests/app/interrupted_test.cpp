// What `plumbline render` leaves behind when it is killed, and what it says when its time is up.
#include <gtest/gtest.h>
#include <stdlib.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "validation/tests/app/processes.hpp"

namespace plumbline::test {
namespace {

using Words = std::vector<std::string>;
using Clock = std::chrono::steady_clock;

/// A terminal whose other end we read.
struct Terminal {
  Terminal() : ours(::posix_openpt(O_RDWR | O_NOCTTY)) {
    if (ours < 0 || ::grantpt(ours) != 0 || ::unlockpt(ours) != 0) return;
    theirs = ::open(::ptsname(ours), O_RDWR | O_NOCTTY);
  }
  ~Terminal() {
    hand_over();
    ::close(ours);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;
  /// Once a child has the other end: reading ends when the child does.
  void hand_over() {
    if (theirs >= 0) ::close(theirs);
    theirs = -1;
  }
  int ours = -1;
  int theirs = -1;
};

/// Kills a render of half a minute as soon as its progress bar says that tiles are being traced.
int kill_in_the_middle(const std::string& output) {
  Terminal terminal;
  if (terminal.theirs < 0) return -1;
  const pid_t child = start({PLUMBLINE_COMMAND, "render", "builtin:cornell", "-o", output, "--size",
                             "256x256", "--spp", "1024", "--bounces", "0", "--threads", "1"},
                            terminal.theirs, terminal.theirs);
  terminal.hand_over();
  std::string shown;
  char byte = 0;
  while (shown.find("s left") == std::string::npos && ::read(terminal.ours, &byte, 1) == 1) shown += byte;
  ::kill(child, SIGKILL);
  return finish(child);
}

TEST(Interrupted, KilledRenderLeavesNothing) {
  const ScratchFolder folder("killed");
  ASSERT_EQ(kill_in_the_middle(folder / "out.exr"), 128 + SIGKILL);
  EXPECT_TRUE(folder.names().empty()) << folder.names().front();
}

TEST(Interrupted, KilledRenderLeavesTheOldOutput) {
  const ScratchFolder folder("killed");
  write_text_atomically(folder / "out.exr", "yesterday's image");
  ASSERT_EQ(kill_in_the_middle(folder / "out.exr"), 128 + SIGKILL);
  EXPECT_EQ(folder.names(), Words{"out.exr"});
  EXPECT_EQ(read_file(folder / "out.exr"), "yesterday's image");
}

// Whenever the kill comes, also while the image is written: the name holds the old bytes or all of the new ones.
TEST(Interrupted, OutputIsOldOrNewWheneverTheKillComes) {
  const ScratchFolder logs("killed-logs");
  const ScratchFolder folder("killed");
  const Words render = {PLUMBLINE_COMMAND, "render", "builtin:cornell", "--size", "256x256", "--spp", "1",
                        "--bounces",       "0",      "--layers",        "all",    "-o"};
  const auto with_output = [&](const std::string& name) {
    Words words = render;
    words.push_back(folder / name);
    return words;
  };
  const Clock::time_point begin = Clock::now();
  ASSERT_EQ(run(logs, with_output("whole.exr")).code, 0);
  const Clock::duration length = Clock::now() - begin;
  const std::string whole = read_file(folder / "whole.exr");
  const int nowhere = ::open("/dev/null", O_WRONLY);
  constexpr int kKills = 5;
  for (int k = 1; k <= kKills; ++k) {
    write_text_atomically(folder / "out.exr", "old");
    const pid_t child = start(with_output("out.exr"), nowhere, nowhere);
    std::this_thread::sleep_for(length * k / kKills);
    ::kill(child, SIGKILL);
    (void)finish(child);  // killed or already done
    const std::string left = read_file(folder / "out.exr");
    EXPECT_TRUE(left == "old" || left == whole) << left.size() << " bytes, kill " << k;
  }
  ::close(nowhere);
}

// Only a run that does not look at the clock is caught by this bound; how closely time is kept is for benchmarks.
TEST(Interrupted, MaxSecondsEndsARenderWithItsError) {
  const ScratchFolder folder("max-seconds");
  const Clock::time_point begin = Clock::now();
  const Finished render = run(folder, {PLUMBLINE_COMMAND, "render", "builtin:cornell", "--size", "64x64",
                                       "--max-seconds", "1", "-o", folder / "out.exr", "--json", "-"});
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
  ASSERT_EQ(render.code, 0) << render.err;
  EXPECT_LE(seconds, 10.0);
  const nlohmann::json summary = nlohmann::json::parse(render.out);
  EXPECT_EQ(summary.at("stop"), "max-seconds");
  ASSERT_TRUE(summary.at("relative_error").is_number()) << summary.at("relative_error");
  EXPECT_TRUE(std::isfinite(summary.at("relative_error").get<double>()));
  EXPECT_GT(summary.at("relative_error").get<double>(), 0.0);
  EXPECT_GE(summary.at("samples_per_pixel").get<int>(), 2);
  EXPECT_TRUE(std::filesystem::exists(folder / "out.exr"));
}

}  // namespace
}  // namespace plumbline::test
