#include "validation/app/machine.hpp"

#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <fstream>
#include <thread>

#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"

namespace plumbline::app {
namespace {

std::string read_line_after(const char* file, const std::string& key) {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(key)) continue;
    const std::size_t value = line.find_first_not_of(" \t:=\"", key.size());
    std::string text = value == std::string::npos ? "" : line.substr(value);
    if (!text.empty() && text.back() == '"') text.pop_back();
    return text;
  }
  return "unknown";
}

}  // namespace

std::map<std::string, std::string> machine() {
  return {{"cpu", read_line_after("/proc/cpuinfo", "model name")},
          {"threads", std::to_string(std::thread::hardware_concurrency())},
          {"memory", read_line_after("/proc/meminfo", "MemTotal")},
          {"os", read_line_after("/etc/os-release", "PRETTY_NAME")},
          {"compiler", __VERSION__}};
}

std::string now_utc() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

void make_folder(const std::filesystem::path& folder, const std::string& page) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!std::filesystem::is_directory(folder)) {
    throw InputError(fmt::format("{}: cannot make this folder: {}", folder.string(),
                                 error ? error.message() : "it is a file"));
  }
  require_writable(folder / page);
}

}  // namespace plumbline::app
