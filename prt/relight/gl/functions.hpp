// prt/relight/gl/functions.hpp: the OpenGL 3.3 functions in use, as one table a context.
// Not libepoxy: that finds the current context by GLX or EGL, and a context of OSMesa's is neither (with libglvnd it crashes
// there). OSMesa and EGL each say themselves where a function is, and nothing is linked.
#pragma once

#include <GL/glcorearb.h>

#include <functional>

namespace plumbline::relight::gl {

// name in the table, type in glcorearb.h
#define PLUMBLINE_GL_FUNCTIONS(X)                         \
  X(ActiveTexture, ACTIVETEXTURE)                         \
  X(AttachShader, ATTACHSHADER)                           \
  X(BeginTransformFeedback, BEGINTRANSFORMFEEDBACK)       \
  X(BindBuffer, BINDBUFFER)                               \
  X(BindBufferBase, BINDBUFFERBASE)                       \
  X(BindFramebuffer, BINDFRAMEBUFFER)                     \
  X(BindRenderbuffer, BINDRENDERBUFFER)                   \
  X(BindTexture, BINDTEXTURE)                             \
  X(BindVertexArray, BINDVERTEXARRAY)                     \
  X(BufferData, BUFFERDATA)                               \
  X(CheckFramebufferStatus, CHECKFRAMEBUFFERSTATUS)       \
  X(Clear, CLEAR)                                         \
  X(ClearBufferfv, CLEARBUFFERFV)                         \
  X(ClearBufferuiv, CLEARBUFFERUIV)                       \
  X(ClearDepth, CLEARDEPTH)                               \
  X(CompileShader, COMPILESHADER)                         \
  X(CreateProgram, CREATEPROGRAM)                         \
  X(CreateShader, CREATESHADER)                           \
  X(DeleteBuffers, DELETEBUFFERS)                         \
  X(DeleteFramebuffers, DELETEFRAMEBUFFERS)               \
  X(DeleteProgram, DELETEPROGRAM)                         \
  X(DeleteRenderbuffers, DELETERENDERBUFFERS)             \
  X(DeleteShader, DELETESHADER)                           \
  X(DeleteTextures, DELETETEXTURES)                       \
  X(DeleteVertexArrays, DELETEVERTEXARRAYS)               \
  X(DepthFunc, DEPTHFUNC)                                 \
  X(Disable, DISABLE)                                     \
  X(DrawArrays, DRAWARRAYS)                               \
  X(DrawBuffers, DRAWBUFFERS)                             \
  X(DrawElements, DRAWELEMENTS)                           \
  X(Enable, ENABLE)                                       \
  X(EnableVertexAttribArray, ENABLEVERTEXATTRIBARRAY)     \
  X(EndTransformFeedback, ENDTRANSFORMFEEDBACK)           \
  X(Finish, FINISH)                                       \
  X(FramebufferRenderbuffer, FRAMEBUFFERRENDERBUFFER)     \
  X(FramebufferTextureLayer, FRAMEBUFFERTEXTURELAYER)     \
  X(GenBuffers, GENBUFFERS)                               \
  X(GenFramebuffers, GENFRAMEBUFFERS)                     \
  X(GenRenderbuffers, GENRENDERBUFFERS)                   \
  X(GenTextures, GENTEXTURES)                             \
  X(GenVertexArrays, GENVERTEXARRAYS)                     \
  X(GetBufferSubData, GETBUFFERSUBDATA)                   \
  X(GetError, GETERROR)                                   \
  X(GetIntegerv, GETINTEGERV)                             \
  X(GetProgramInfoLog, GETPROGRAMINFOLOG)                 \
  X(GetProgramiv, GETPROGRAMIV)                           \
  X(GetShaderInfoLog, GETSHADERINFOLOG)                   \
  X(GetShaderiv, GETSHADERIV)                             \
  X(GetString, GETSTRING)                                 \
  X(GetStringi, GETSTRINGI)                               \
  X(GetUniformLocation, GETUNIFORMLOCATION)               \
  X(LinkProgram, LINKPROGRAM)                             \
  X(PixelStorei, PIXELSTOREI)                             \
  X(ReadBuffer, READBUFFER)                               \
  X(ReadPixels, READPIXELS)                               \
  X(RenderbufferStorage, RENDERBUFFERSTORAGE)             \
  X(ShaderSource, SHADERSOURCE)                           \
  X(TexBuffer, TEXBUFFER)                                 \
  X(TexImage3D, TEXIMAGE3D)                               \
  X(TexParameteri, TEXPARAMETERI)                         \
  X(TransformFeedbackVaryings, TRANSFORMFEEDBACKVARYINGS) \
  X(Uniform1f, UNIFORM1F)                                 \
  X(Uniform1i, UNIFORM1I)                                 \
  X(Uniform2i, UNIFORM2I)                                 \
  X(Uniform3f, UNIFORM3F)                                 \
  X(Uniform4fv, UNIFORM4FV)                               \
  X(UniformMatrix4fv, UNIFORMMATRIX4FV)                   \
  X(UseProgram, USEPROGRAM)                               \
  X(VertexAttribPointer, VERTEXATTRIBPOINTER)             \
  X(Viewport, VIEWPORT)

struct Functions {
#define PLUMBLINE_GL_MEMBER(name, type) PFNGL##type##PROC name = nullptr;
  PLUMBLINE_GL_FUNCTIONS(PLUMBLINE_GL_MEMBER)
#undef PLUMBLINE_GL_MEMBER
};

/// `address` gives a function by its name ("glClear"), or nullptr.
/// @throws DeviceError naming the first function there is none of.
[[nodiscard]] Functions load_functions(const std::function<void*(const char* name)>& address);

}  // namespace plumbline::relight::gl
