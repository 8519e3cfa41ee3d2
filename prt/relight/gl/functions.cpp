#include "prt/relight/gl/functions.hpp"

#include <fmt/format.h>

#include "reference/base/error.hpp"

namespace plumbline::relight::gl {

Functions load_functions(const std::function<void*(const char*)>& address) {
  Functions table;
  const auto load = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(address(name));
    if (function == nullptr) throw DeviceError(fmt::format("OpenGL: the driver has no function {}", name));
  };
#define PLUMBLINE_GL_LOAD(name, type) load(table.name, "gl" #name);
  PLUMBLINE_GL_FUNCTIONS(PLUMBLINE_GL_LOAD)
#undef PLUMBLINE_GL_LOAD
  return table;
}

}  // namespace plumbline::relight::gl
