// prt/relight/gl/object.hpp: what lives on the OpenGL side, as values that clean up after themselves.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "prt/relight/gl/context.hpp"

namespace plumbline::relight::gl {

/// An OpenGL name. Must not outlive its context.
class Object {
 public:
  Object() = default;
  Object(GLuint name, std::function<void(GLuint)> destroy) : name_(name), destroy_(std::move(destroy)) {}
  ~Object() { reset(); }
  Object(Object&& other) noexcept
      : name_(std::exchange(other.name_, 0)), destroy_(std::move(other.destroy_)) {}
  Object& operator=(Object&& other) noexcept {
    if (this != &other) {
      reset();
      name_ = std::exchange(other.name_, 0);
      destroy_ = std::move(other.destroy_);
    }
    return *this;
  }
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;

  [[nodiscard]] GLuint name() const { return name_; }

 private:
  void reset() {
    if (name_ != 0) destroy_(name_);
    name_ = 0;
  }
  GLuint name_ = 0;
  std::function<void(GLuint)> destroy_;
};

[[nodiscard]] Object make_buffer(const Context& context);
[[nodiscard]] Object make_vertex_array(const Context& context);
[[nodiscard]] Object make_texture(const Context& context);
[[nodiscard]] Object make_framebuffer(const Context& context);
/// Storage of the format, bound to nothing.
[[nodiscard]] Object make_renderbuffer(const Context& context, GLenum format, int width, int height);

/// @throws DeviceError "OpenGL: <name>: <first line of the compiler's or linker's log>".
struct ProgramSource {
  std::string name;
  std::string vertex;
  std::string fragment;               // empty: none, for programs that only feed back
  std::vector<std::string> feedback;  // outputs to capture, interleaved
};
[[nodiscard]] Object make_program(const Context& context, const ProgramSource& source);

/// A buffer that shaders read as a one-dimensional array of texels.
struct TextureBuffer {
  Object buffer;
  Object texture;
};
/// `bytes` may be empty with `size` set: storage to be written to later.
/// @throws InputError "OpenGL: <what>: …" when the context's texture buffers do not hold as many texels.
[[nodiscard]] TextureBuffer make_texture_buffer(const Context& context, std::string_view what, GLenum format,
                                                std::size_t texel_bytes, std::span<const std::byte> bytes,
                                                std::size_t size = 0);

/// Binds a texture buffer to a unit and a program's sampler to that unit. The program is in use.
void bind(const Context& context, const Object& program, const char* sampler, int unit,
          const TextureBuffer& buffer);

/// Runs the program in use for `points` points without drawing any, and captures its outputs in a buffer.
/// @throws DeviceError "OpenGL: <what>: …" when the driver reports an error
void feed_back(const Context& context, const TextureBuffer& into, std::size_t points, std::string_view what);

}  // namespace plumbline::relight::gl
