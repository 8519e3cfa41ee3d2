#include "reference/image/picture_library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <filesystem>

#include "reference/base/error.hpp"
#include "reference/base/text.hpp"

namespace fs = std::filesystem;

namespace plumbline::image {
namespace {

constexpr const char* kModule = "plumbline_pictures.so";

// A path with a slash is opened as it is; a bare name is looked for along the program's run path and the system's folders.
std::vector<std::string> candidates() {
  std::vector<std::string> result;
  std::error_code failed;
  const fs::path program = fs::read_symlink("/proc/self/exe", failed);
  if (!failed) {
    const fs::path folder = program.parent_path();
    for (const fs::path& base : {folder, folder.parent_path()}) {
      const fs::path candidate = base / PLUMBLINE_LIBDIR / "plumbline" / kModule;
      if (fs::exists(candidate, failed)) result.push_back(candidate.string());
    }
  }
  result.emplace_back(kModule);
  return result;
}

// Never closed: what OpenImageIO registers with the process outlives any handle.
void* open_module() {
  std::string reason;
  for (const std::string& candidate : candidates()) {
    if (void* handle = ::dlopen(candidate.c_str(), RTLD_NOW | RTLD_LOCAL)) return handle;
    if (const char* text = ::dlerror()) reason = text;
  }
  throw InputError(fmt::format("{} (reads pictures other than OpenEXR, writes PNG) cannot be loaded: {}",
                               kModule, one_line(reason)));
}

const PictureLibrary& load() {
  auto* entry = reinterpret_cast<PictureLibraryEntry>(::dlsym(open_module(), kPictureLibraryEntry));
  if (entry == nullptr) {
    throw InputError(fmt::format("{} lacks {}: it belongs to another version of Plumbline", kModule,
                                 kPictureLibraryEntry));
  }
  return *entry();
}

}  // namespace

const PictureLibrary& picture_library() {
  static const PictureLibrary& library = load();
  return library;
}

}  // namespace plumbline::image
