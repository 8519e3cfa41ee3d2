#include "reference/base/atomic_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <system_error>

#include "reference/base/error.hpp"

namespace plumbline {
namespace fs = std::filesystem;
namespace {

// Same folder, so that the rename cannot cross file systems; same extension, because image writers go by it.
fs::path temporary_beside(const fs::path& destination) {
  const std::string stem = "." + destination.stem().string() + ".partial-" + std::to_string(::getpid());
  return destination.parent_path() / (stem + destination.extension().string());
}

struct RemoveOnExit {
  const fs::path& path;
  ~RemoveOnExit() {
    std::error_code ignored;
    fs::remove(path, ignored);
  }
};

}  // namespace

void require_writable(const fs::path& destination) {
  const fs::path folder = destination.has_parent_path() ? destination.parent_path() : fs::path(".");
  std::error_code error;
  if (fs::is_directory(destination, error)) {
    throw InputError(destination.string() + ": cannot write: it is a folder");
  }
  if (!fs::is_directory(folder, error)) {
    throw InputError(destination.string() + ": cannot write: the folder " + folder.string() +
                     " does not exist");
  }
  if (::access(folder.c_str(), W_OK) != 0) {
    throw InputError(destination.string() + ": cannot write: " + std::strerror(errno));
  }
}

void write_atomically(const fs::path& destination, const std::function<void(const fs::path&)>& write) {
  require_writable(destination);
  const fs::path temporary = temporary_beside(destination);
  const RemoveOnExit cleanup{temporary};
  write(temporary);
  std::error_code error;
  fs::rename(temporary, destination, error);
  if (error) throw InputError(destination.string() + ": cannot write: " + error.message());
}

void write_text_atomically(const fs::path& destination, std::string_view text) {
  write_atomically(destination, [&](const fs::path& temporary) {
    std::ofstream file(temporary, std::ios::binary);
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
    file.close();
    if (!file) throw InputError(destination.string() + ": cannot write: " + std::strerror(errno));
  });
}

std::string read_file(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) throw InputError(path.string() + ": no such file");
  if (fs::is_directory(path, error)) throw InputError(path.string() + ": is a folder, expected a file");
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  if (!file) throw InputError(path.string() + ": cannot read: " + std::strerror(errno));
  return std::move(bytes).str();
}

}  // namespace plumbline
