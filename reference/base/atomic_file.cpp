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

[[noreturn]] void refuse(const fs::path& destination, const std::string& reason) {
  const std::string name = destination.empty() ? "\"\"" : destination.string();
  throw InputError(name + ": cannot write: " + reason);
}

// A link stays, and what it points to is replaced.
fs::path without_links(const fs::path& destination) {
  std::error_code error;
  if (!fs::is_symlink(destination, error)) return destination;
  return fs::weakly_canonical(destination, error);
}

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

// Permissions alone do not tell (a read-only or full disk, a name too long, /proc): make the file.
void require_temporary(const fs::path& destination) {
  const fs::path temporary = temporary_beside(without_links(destination));
  const RemoveOnExit cleanup{temporary};
  if (!std::ofstream(temporary, std::ios::binary)) refuse(destination, std::strerror(errno));
}

}  // namespace

void require_writable(const fs::path& destination) {
  const fs::path folder = destination.has_parent_path() ? destination.parent_path() : fs::path(".");
  std::error_code error;
  if (destination.empty()) refuse(destination, "the name is empty");
  if (fs::is_directory(destination, error)) refuse(destination, "it is a folder");
  if (fs::exists(destination, error) && !fs::is_regular_file(destination, error)) {
    refuse(destination, "it is not a regular file");
  }
  if (!fs::exists(folder, error)) refuse(destination, "the folder " + folder.string() + " does not exist");
  if (!fs::is_directory(folder, error)) refuse(destination, folder.string() + " is not a folder");
  require_temporary(destination);
}

void write_atomically(const fs::path& destination, const std::function<void(const fs::path&)>& write) {
  require_writable(destination);
  const fs::path target = without_links(destination);
  const fs::path temporary = temporary_beside(target);
  const RemoveOnExit cleanup{temporary};
  write(temporary);
  std::error_code error;
  fs::rename(temporary, target, error);
  if (error) refuse(destination, error.message());
}

void write_text_atomically(const fs::path& destination, std::string_view text) {
  write_atomically(destination, [&](const fs::path& temporary) {
    std::ofstream file(temporary, std::ios::binary);
    file.write(text.data(), static_cast<std::streamsize>(text.size()));
    file.close();
    if (!file) refuse(destination, std::strerror(errno));
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
