#include "prt/relight/gl/library.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <sstream>

#include "reference/base/error.hpp"

namespace plumbline::relight::gl {

Library::Library(const std::string& what, const std::string& names) : what_(what) {
  std::istringstream words(names);
  std::string reason = "no library named";
  for (std::string name; handle_ == nullptr && words >> name;) {
    handle_ = dlopen(name.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (handle_ != nullptr) {
      name_ = name;
    } else if (name_.empty()) {
      reason = dlerror();
      name_ = name;
    }
  }
  if (handle_ == nullptr) throw DeviceError(fmt::format("{}: {}", what_, reason));
}

void* Library::find(const char* symbol) const {
  return dlsym(handle_, symbol);
}

void* Library::require_address(const char* symbol) const {
  void* address = find(symbol);
  if (address == nullptr) throw DeviceError(fmt::format("{}: {} has no {}", what_, name_, symbol));
  return address;
}

}  // namespace plumbline::relight::gl
