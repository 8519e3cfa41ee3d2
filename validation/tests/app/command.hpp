// validation/tests/app/command.hpp: runs the plumbline command as its users do, in a folder of the test's own.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "reference/image/image.hpp"

namespace plumbline::app {

using Arguments = std::vector<std::string>;

struct Outcome {
  int code = -1;  // what the command returned; -1 when a signal ended it
  std::string out;
  std::string err;
};

/// What the command's standard output is.
enum class StandardOutput { captured, closed, broken_pipe, full_disk };

/// File name -> bytes of every file in a folder, hidden ones included.
using Contents = std::map<std::string, std::string>;

/// Why an outcome is not a refusal of bad input as the command promises it: exit code 2, nothing on standard
/// output, one line on standard error that has all of `words`, no file changed. Empty when it is one.
[[nodiscard]] std::string fault_of_refusal(const Outcome& outcome, const std::vector<std::string>& words,
                                           const Contents& before, const Contents& after);

class CommandTest : public testing::Test {
 protected:
  CommandTest();
  ~CommandTest() override;

  [[nodiscard]] std::filesystem::path path(const std::string& name) const { return folder_ / name; }
  void write(const std::string& name, std::string_view bytes) const;
  [[nodiscard]] std::string read(const std::string& name) const;
  /// Channels R, G, B of one value each.
  void write_image(const std::string& name, int width, int height, float value) const;
  [[nodiscard]] image::LayeredImage read_image(const std::string& name) const;
  [[nodiscard]] nlohmann::json read_json(const std::string& name) const;
  [[nodiscard]] Contents contents() const;

  /// Runs `plumbline arguments…` in the folder.
  [[nodiscard]] Outcome run(const Arguments& arguments,
                            StandardOutput standard_output = StandardOutput::captured) const;
  /// Runs another program in the folder.
  [[nodiscard]] Outcome run_program(const std::string& program, const Arguments& arguments,
                                    StandardOutput standard_output = StandardOutput::captured) const;
  /// Runs `plumbline arguments…`, expects exit code 0 and a silent standard error, and returns standard output.
  std::string succeed(const Arguments& arguments) const;
  /// Runs it and expects a refusal; see fault_of_refusal.
  void expect_refused(const Arguments& arguments, const std::vector<std::string>& words) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace plumbline::app
