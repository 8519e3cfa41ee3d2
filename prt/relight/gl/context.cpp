#include "prt/relight/gl/context.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "reference/base/error.hpp"

namespace plumbline::relight::gl {
namespace {

struct Chosen {
  Provider provider;
  std::unique_ptr<Platform> platform;
};

Chosen choose(const ContextSettings& settings) {
  if (settings.provider == Provider::egl)
    return {Provider::egl, make_egl(settings.egl_libraries, settings.version)};
  std::string reason;
  try {
    return {Provider::osmesa, make_osmesa(settings.osmesa_libraries, settings.version)};
  } catch (const DeviceError& error) {
    if (settings.provider == Provider::osmesa) throw;
    reason = error.what();
  }
  try {
    return {Provider::egl, make_egl(settings.egl_libraries, settings.version)};
  } catch (const DeviceError& error) {
    throw DeviceError(fmt::format("OpenGL: no context: {}; {}", reason, error.what()));
  }
}

const char* name_of(GLenum error) {
  switch (error) {
    case GL_INVALID_ENUM:
      return "invalid enum";
    case GL_INVALID_VALUE:
      return "invalid value";
    case GL_INVALID_OPERATION:
      return "invalid operation";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
      return "invalid framebuffer operation";
    case GL_OUT_OF_MEMORY:
      return "out of memory";
    default:
      return "unknown error";
  }
}

}  // namespace

std::string_view to_string(Provider provider) {
  switch (provider) {
    case Provider::automatic:
      return "auto";
    case Provider::osmesa:
      return "osmesa";
    case Provider::egl:
      return "egl";
  }
  return "?";
}

Provider provider_from_string(std::string_view text) {
  for (const Provider provider : {Provider::automatic, Provider::osmesa, Provider::egl}) {
    if (text == to_string(provider)) return provider;
  }
  throw InputError(fmt::format("OpenGL context: expected auto, osmesa or egl, got {}", text));
}

ContextSettings settings_from_environment(Provider provider) {
  ContextSettings settings;
  settings.provider = provider;
  if (const char* names = std::getenv("PLUMBLINE_OSMESA")) settings.osmesa_libraries = names;
  if (const char* names = std::getenv("PLUMBLINE_EGL")) settings.egl_libraries = names;
  return settings;
}

Context::Context(const ContextSettings& settings) : provider_(settings.provider) {
  Chosen chosen = choose(settings);
  provider_ = chosen.provider;
  platform_ = std::move(chosen.platform);
  functions_ = load_functions([this](const char* name) { return platform_->address(name); });
}

std::string Context::description() const {
  const auto text = [&](GLenum what) {
    const GLubyte* found = functions_.GetString(what);
    return std::string(found == nullptr ? "?" : reinterpret_cast<const char*>(found));
  };
  return fmt::format("{}: {}, {}", to_string(provider_), text(GL_RENDERER), text(GL_VERSION));
}

bool Context::has_extension(std::string_view name) const {
  const int count = integer(GL_NUM_EXTENSIONS);
  for (int i = 0; i < count; ++i) {
    const GLubyte* found = functions_.GetStringi(GL_EXTENSIONS, static_cast<GLuint>(i));
    if (found != nullptr && name == reinterpret_cast<const char*>(found)) return true;
  }
  return false;
}

int Context::integer(GLenum what) const {
  GLint value = 0;
  functions_.GetIntegerv(what, &value);
  return value;
}

void Context::require_no_error(std::string_view where) const {
  const GLenum error = functions_.GetError();
  if (error == GL_NO_ERROR) return;
  while (functions_.GetError() != GL_NO_ERROR) {
  }
  throw DeviceError(fmt::format("OpenGL: {}: {}", where, name_of(error)));
}

}  // namespace plumbline::relight::gl
