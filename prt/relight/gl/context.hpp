// prt/relight/gl/context.hpp: OpenGL without a window.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "prt/relight/gl/functions.hpp"
#include "prt/relight/gl/platform.hpp"

namespace plumbline::relight::gl {

/// automatic: OSMesa where there is one, else EGL.
enum class Provider { automatic, osmesa, egl };
[[nodiscard]] std::string_view to_string(Provider provider);
/// @throws InputError listing the providers there are.
[[nodiscard]] Provider provider_from_string(std::string_view text);

struct ContextSettings {
  Provider provider = Provider::automatic;
  Version version;
  // File names separated by spaces, tried in turn.
  std::string osmesa_libraries = "libOSMesa.so.8 libOSMesa.so.6 libOSMesa.so";
  std::string egl_libraries = "libEGL.so.1 libEGL.so";
};

/// `provider`, with the libraries that the environment variables PLUMBLINE_OSMESA and PLUMBLINE_EGL name, where they are set.
[[nodiscard]] ContextSettings settings_from_environment(Provider provider);

/// A context and its functions. Current on the thread that made it; belongs to that thread. One at a time on a thread.
class Context {
 public:
  /// @throws DeviceError, one line saying what is missing: the library, the context, or a function.
  explicit Context(const ContextSettings& settings);

  [[nodiscard]] const Functions& gl() const { return functions_; }
  [[nodiscard]] Provider provider() const { return provider_; }
  /// "osmesa: llvmpipe (…), 4.5 (Core Profile) Mesa …"
  [[nodiscard]] std::string description() const;
  [[nodiscard]] bool has_extension(std::string_view name) const;
  [[nodiscard]] int integer(GLenum what) const;
  /// @throws DeviceError "OpenGL: <where>: <error>" when an error is pending.
  void require_no_error(std::string_view where) const;

 private:
  Provider provider_;
  std::unique_ptr<Platform> platform_;
  Functions functions_;
};

}  // namespace plumbline::relight::gl
