#include "validation/app/output.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <system_error>

#include "reference/base/atomic_file.hpp"
#include "reference/base/error.hpp"
#include "reference/base/text.hpp"

namespace fs = std::filesystem;

namespace plumbline::app {
namespace {

// Standard output, a device or a pipe: what is written to as it is.
bool is_stream(const std::string& path) {
  if (path == "-") return true;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::is_character_file(status) || fs::is_fifo(status);
}

void require_destination(const Destination& destination) {
  const auto& [option, path, extension] = destination;
  if (extension.empty() && is_stream(path)) return;
  if (path == "-") {
    throw InputError(fmt::format("{}: a {} file cannot go to standard output", option, extension));
  }
  if (!extension.empty() && lower_case_extension(path) != extension) {
    throw InputError(fmt::format("{}: {}: expected a name that ends in {}", option, path, extension));
  }
  require_writable(path);
}

// False when the reader has closed the pipe.
bool try_to_write(std::FILE* file, std::string_view text) {
  errno = 0;
  return std::fwrite(text.data(), 1, text.size(), file) == text.size() && std::fflush(file) == 0;
}

void write_stream(const std::string& name, std::FILE* file, std::string_view text) {
  if (file != nullptr && (try_to_write(file, text) || errno == EPIPE)) return;
  throw InputError(fmt::format("{}: cannot write: {}", name, std::strerror(errno)));
}

void write_special_file(const std::string& path, std::string_view text) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(
      std::fopen(path.c_str(), "w"), [](std::FILE* f) { return f == nullptr ? 0 : std::fclose(f); });
  write_stream(path, file.get(), text);
}

}  // namespace

void require_destinations(std::initializer_list<Destination> destinations) {
  std::map<fs::path, std::string> taken;
  std::error_code error;
  for (const Destination& destination : destinations) {
    if (destination.path.empty()) continue;
    require_destination(destination);
    const bool is_standard_output = destination.path == "-";
    if (is_stream(destination.path) && !is_standard_output) continue;
    const fs::path place = is_standard_output ? "-" : fs::weakly_canonical(destination.path, error);
    const auto [entry, is_new] = taken.try_emplace(place, destination.option);
    if (is_new) continue;
    throw InputError(fmt::format("{} and {}: both go to {}", entry->second, destination.option,
                                 is_standard_output ? "standard output" : destination.path));
  }
}

void write_output(const std::string& destination, std::string_view text) {
  if (destination == "-") {
    write_stream("standard output", stdout, text);
  } else if (is_stream(destination)) {
    write_special_file(destination, text);
  } else {
    write_text_atomically(destination, text);
  }
}

nlohmann::json number(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0.0 ? "inf" : "-inf";
  return value;
}

// File names may hold any bytes, JSON only UTF-8.
void write_json(const std::string& destination, const nlohmann::json& json) {
  if (destination.empty()) return;
  write_output(destination, json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

void say(const std::string& line) {
  try_to_write(stdout, line + "\n");
}

void complain(const std::string& line) {
  constexpr std::size_t kLongest = 4000;
  try_to_write(stderr, "plumbline: " + one_line(line, kLongest) + "\n");
}

void warn(const std::string& message) {
  complain("warning: " + message);
}

// A closed stream is replaced by /dev/null opened the wrong way round, so that using it still fails.
void prepare_standard_streams() {
  std::signal(SIGPIPE, SIG_IGN);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) != -1 || errno != EBADF) continue;
    const int direction = stream == STDIN_FILENO ? O_WRONLY : O_RDONLY;
    if (::open("/dev/null", direction) == -1) return;  // no /dev: nothing better can be done
  }
}

}  // namespace plumbline::app
