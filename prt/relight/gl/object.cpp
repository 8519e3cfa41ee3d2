#include "prt/relight/gl/object.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "reference/base/error.hpp"

namespace plumbline::relight::gl {
namespace {

using Generate = void(APIENTRYP)(GLsizei, GLuint*);
using Delete = void(APIENTRYP)(GLsizei, const GLuint*);

Object make(Generate generate, Delete destroy) {
  GLuint name = 0;
  generate(1, &name);
  return {name, [destroy](GLuint n) { destroy(1, &n); }};
}

std::string first_line(const std::string& log) {
  const std::size_t begin = log.find_first_not_of(" \t\r\n");
  if (begin == std::string::npos) return "the driver does not say why";
  return log.substr(begin, log.find_first_of("\r\n", begin) - begin);
}

template <class GetValue, class GetLog>
void require_success(GLuint object, GLenum status, const std::string& name, GetValue get_value,
                     GetLog get_log) {
  GLint succeeded = GL_FALSE;
  get_value(object, status, &succeeded);
  if (succeeded == GL_TRUE) return;
  std::string log(4096, '\0');
  GLsizei length = 0;
  get_log(object, static_cast<GLsizei>(log.size()), &length, log.data());
  log.resize(static_cast<std::size_t>(std::max(0, length)));
  throw DeviceError(fmt::format("OpenGL: {}: {}", name, first_line(log)));
}

Object make_shader(const Context& context, GLenum kind, const std::string& name, const std::string& text) {
  const Functions& gl = context.gl();
  Object shader(gl.CreateShader(kind), gl.DeleteShader);
  const char* source = text.c_str();
  gl.ShaderSource(shader.name(), 1, &source, nullptr);
  gl.CompileShader(shader.name());
  require_success(shader.name(), GL_COMPILE_STATUS, name, gl.GetShaderiv, gl.GetShaderInfoLog);
  return shader;
}

}  // namespace

Object make_buffer(const Context& context) {
  return make(context.gl().GenBuffers, context.gl().DeleteBuffers);
}

Object make_vertex_array(const Context& context) {
  return make(context.gl().GenVertexArrays, context.gl().DeleteVertexArrays);
}

Object make_texture(const Context& context) {
  return make(context.gl().GenTextures, context.gl().DeleteTextures);
}

Object make_framebuffer(const Context& context) {
  return make(context.gl().GenFramebuffers, context.gl().DeleteFramebuffers);
}

Object make_renderbuffer(const Context& context, GLenum format, int width, int height) {
  const Functions& gl = context.gl();
  Object result = make(gl.GenRenderbuffers, gl.DeleteRenderbuffers);
  gl.BindRenderbuffer(GL_RENDERBUFFER, result.name());
  gl.RenderbufferStorage(GL_RENDERBUFFER, format, width, height);
  context.require_no_error(fmt::format("frame buffer of {}x{}", width, height));
  return result;
}

Object make_program(const Context& context, const ProgramSource& source) {
  const Functions& gl = context.gl();
  Object program(gl.CreateProgram(), gl.DeleteProgram);
  const Object vertex = make_shader(context, GL_VERTEX_SHADER, source.name + " vertex shader", source.vertex);
  gl.AttachShader(program.name(), vertex.name());
  Object fragment;
  if (!source.fragment.empty()) {
    fragment = make_shader(context, GL_FRAGMENT_SHADER, source.name + " fragment shader", source.fragment);
    gl.AttachShader(program.name(), fragment.name());
  }
  if (!source.feedback.empty()) {
    std::vector<const char*> names;
    for (const std::string& name : source.feedback) names.push_back(name.c_str());
    gl.TransformFeedbackVaryings(program.name(), static_cast<GLsizei>(names.size()), names.data(),
                                 GL_INTERLEAVED_ATTRIBS);
  }
  gl.LinkProgram(program.name());
  require_success(program.name(), GL_LINK_STATUS, source.name + " program", gl.GetProgramiv,
                  gl.GetProgramInfoLog);
  return program;
}

TextureBuffer make_texture_buffer(const Context& context, std::string_view what, GLenum format,
                                  std::size_t texel_bytes, std::span<const std::byte> bytes,
                                  std::size_t size) {
  const Functions& gl = context.gl();
  size = std::max({size, bytes.size(), texel_bytes});  // never empty: shaders may name what a scene lacks
  const auto largest = static_cast<std::size_t>(std::max(0, context.integer(GL_MAX_TEXTURE_BUFFER_SIZE)));
  if (size / texel_bytes > largest) {
    throw InputError(fmt::format("OpenGL: {}: {} texels, a texture buffer of this driver holds {}", what,
                                 size / texel_bytes, largest));
  }
  TextureBuffer result{make_buffer(context), make_texture(context)};
  gl.BindBuffer(GL_TEXTURE_BUFFER, result.buffer.name());
  gl.BufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(size),
                bytes.size() == size ? bytes.data() : nullptr, GL_DYNAMIC_DRAW);
  gl.BindTexture(GL_TEXTURE_BUFFER, result.texture.name());
  gl.TexBuffer(GL_TEXTURE_BUFFER, format, result.buffer.name());
  context.require_no_error(what);
  return result;
}

void bind(const Context& context, const Object& program, const char* sampler, int unit,
          const TextureBuffer& buffer) {
  const Functions& gl = context.gl();
  gl.ActiveTexture(static_cast<GLenum>(GL_TEXTURE0 + unit));
  gl.BindTexture(GL_TEXTURE_BUFFER, buffer.texture.name());
  gl.Uniform1i(gl.GetUniformLocation(program.name(), sampler), unit);
}

void feed_back(const Context& context, const TextureBuffer& into, std::size_t points, std::string_view what) {
  const auto& gl = context.gl();
  gl.BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, into.buffer.name());
  gl.Enable(GL_RASTERIZER_DISCARD);
  gl.BeginTransformFeedback(GL_POINTS);
  gl.DrawArrays(GL_POINTS, 0, static_cast<GLsizei>(points));
  gl.EndTransformFeedback();
  gl.Disable(GL_RASTERIZER_DISCARD);
  gl.BindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, 0);
  context.require_no_error(what);
}

}  // namespace plumbline::relight::gl
