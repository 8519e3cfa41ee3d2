#include "validation/tests/app/command.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>

#include "reference/base/atomic_file.hpp"
#include "reference/image/exr.hpp"

namespace fs = std::filesystem;

namespace plumbline::app {
namespace {

// A folder that no other test and no other run of this one uses.
fs::path make_folder(const std::string& kind) {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  const std::string name =
      fmt::format("plumbline_{}_{}_{}_{}", kind, test->test_suite_name(), test->name(), ::getpid());
  const fs::path folder = fs::path(testing::TempDir()) / name;
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

// Where the streams of the command go: beside its folder, not into it.
struct Streams {
  fs::path folder = make_folder("streams");
  fs::path out = folder / "out";
  fs::path err = folder / "err";

  Streams() = default;
  Streams(const Streams&) = delete;
  Streams& operator=(const Streams&) = delete;
  ~Streams() { fs::remove_all(folder); }
};

int open_for_writing(const char* name) {
  constexpr int kOwnerOnly = 0600;
  return ::open(name, O_WRONLY | O_CREAT, kOwnerOnly);
}

// In the child, between fork and exec: system calls only.
void redirect(StandardOutput kind, const char* out, const char* err) {
  ::dup2(open_for_writing(err), STDERR_FILENO);
  switch (kind) {
    case StandardOutput::captured:
      ::dup2(open_for_writing(out), STDOUT_FILENO);
      return;
    case StandardOutput::closed:
      ::close(STDOUT_FILENO);
      return;
    case StandardOutput::full_disk:
      ::dup2(::open("/dev/full", O_WRONLY), STDOUT_FILENO);
      return;
    case StandardOutput::broken_pipe:
      int ends[2] = {-1, -1};
      if (::pipe(ends) != 0) ::_exit(127);
      ::close(ends[0]);
      ::dup2(ends[1], STDOUT_FILENO);
      return;
  }
}

}  // namespace

CommandTest::CommandTest() : folder_(make_folder("command")) {}

CommandTest::~CommandTest() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

void CommandTest::write(const std::string& name, std::string_view bytes) const {
  write_text_atomically(path(name), bytes);
}

std::string CommandTest::read(const std::string& name) const {
  return read_file(path(name));
}

void CommandTest::write_image(const std::string& name, int width, int height, float value) const {
  image::LayeredImage layers{width, height, {}, {}};
  image::set_rgb_layer(layers, "", image::make_image(width, height, Rgb(value)));
  image::write_exr(path(name), layers);
}

image::LayeredImage CommandTest::read_image(const std::string& name) const {
  return image::read_exr(path(name));
}

nlohmann::json CommandTest::read_json(const std::string& name) const {
  return nlohmann::json::parse(read(name));
}

Contents CommandTest::contents() const {
  Contents result;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_)) {
    const std::string name = fs::relative(entry.path(), folder_).string();
    result[name] = entry.is_regular_file() ? read_file(entry.path()) : "(no file)";
  }
  return result;
}

Outcome CommandTest::run(const Arguments& arguments, StandardOutput standard_output) const {
  return run_program(PLUMBLINE_COMMAND, arguments, standard_output);
}

Outcome CommandTest::run_program(const std::string& program, const Arguments& arguments,
                                 StandardOutput standard_output) const {
  const Streams streams;
  std::vector<std::string> words = {program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    redirect(standard_output, streams.out.c_str(), streams.err.c_str());
    if (::chdir(folder_.c_str()) == 0) ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  int status = 0;
  if (child < 0 || ::waitpid(child, &status, 0) != child) throw std::runtime_error("cannot run the command");
  const bool is_captured = standard_output == StandardOutput::captured;
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, is_captured ? read_file(streams.out) : "",
          read_file(streams.err)};
}

std::string fault_of_refusal(const Outcome& outcome, const std::vector<std::string>& words,
                             const Contents& before, const Contents& after) {
  if (outcome.code != 2) return fmt::format("exit code {}, expected 2", outcome.code);
  if (!outcome.out.empty()) return "standard output is not empty: " + outcome.out;
  const std::string& line = outcome.err;
  if (std::count(line.begin(), line.end(), '\n') != 1 || !line.ends_with('\n')) return "not one line";
  if (!line.starts_with("plumbline: ")) return "does not start with \"plumbline: \"";
  for (const std::string& word : words) {
    if (line.find(word) == std::string::npos) return fmt::format("does not contain \"{}\"", word);
  }
  if (line.find(".partial") != std::string::npos) return "names a temporary file";
  if (before != after) return "files were changed";
  return "";
}

std::string CommandTest::succeed(const Arguments& arguments) const {
  const Outcome outcome = run(arguments);
  EXPECT_EQ(outcome.code, 0) << fmt::format("plumbline {}\n", fmt::join(arguments, " ")) << outcome.err;
  EXPECT_EQ(outcome.err, "") << fmt::format("plumbline {}", fmt::join(arguments, " "));
  return outcome.out;
}

void CommandTest::expect_refused(const Arguments& arguments, const std::vector<std::string>& words) const {
  const Contents before = contents();
  const Outcome outcome = run(arguments);
  EXPECT_EQ(fault_of_refusal(outcome, words, before, contents()), "")
      << fmt::format("plumbline {}\n", fmt::join(arguments, " ")) << outcome.err;
}

}  // namespace plumbline::app
