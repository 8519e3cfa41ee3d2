// prt/relight/gl/platform.hpp: who makes OpenGL contexts without a window.
#pragma once

#include <memory>
#include <string>

namespace plumbline::relight::gl {

/// A core profile context, current on the thread that made it until it is destroyed.
class Platform {
 public:
  Platform() = default;
  virtual ~Platform() = default;
  Platform(const Platform&) = delete;
  Platform& operator=(const Platform&) = delete;
  [[nodiscard]] virtual void* address(const char* function) const = 0;
};

/// A version of OpenGL, core profile.
struct Version {
  int major = 3;
  int minor = 3;
};

/// `libraries`: names separated by spaces, tried in turn.
/// @throws DeviceError, one line: no library, no such function in it, no context of this version.
[[nodiscard]] std::unique_ptr<Platform> make_osmesa(const std::string& libraries, Version version);
[[nodiscard]] std::unique_ptr<Platform> make_egl(const std::string& libraries, Version version);

}  // namespace plumbline::relight::gl
