// A library with OSMesa's functions that misbehaves in one way, chosen by the build. Its OpenGL does nothing.
#include <GL/glcorearb.h>
#include <string.h>

#define EXPORT __attribute__((visibility("default")))
typedef void (*Function)(void);

#ifndef HOSTILE_LACKS_ENTRY
EXPORT void* OSMesaCreateContextAttribs(const int* attributes, void* shared) {
  (void)attributes;
  (void)shared;
#ifdef HOSTILE_NO_CONTEXT
  return 0;
#else
  static int context;
  return &context;
#endif
}
#endif

EXPORT unsigned char OSMesaMakeCurrent(void* context, void* buffer, unsigned type, int width, int height) {
  (void)context;
  (void)buffer;
  (void)type;
  (void)width;
  (void)height;
#ifdef HOSTILE_NOT_CURRENT
  return 0;
#else
  return 1;
#endif
}

EXPORT void OSMesaDestroyContext(void* context) { (void)context; }

static void nothing(void) {}
static GLuint one(void) { return 1; }
static GLuint complete(GLenum target) {
  (void)target;
  return GL_FRAMEBUFFER_COMPLETE;
}
static GLenum no_error(void) { return GL_NO_ERROR; }
static const GLubyte* text(GLenum name) {
  (void)name;
  return (const GLubyte*)"hostile";
}
static void integers(GLenum name, GLint* values) { values[0] = name == GL_NUM_EXTENSIONS ? 0 : 1 << 20; }
static void succeeds(GLuint object, GLenum name, GLint* value) {
  (void)object;
  (void)name;
  *value = GL_TRUE;
}
static void link_status(GLuint object, GLenum name, GLint* value) {
  (void)object;
#ifdef HOSTILE_LINK_ERROR
  *value = name == GL_LINK_STATUS ? GL_FALSE : GL_TRUE;
#else
  (void)name;
  *value = GL_TRUE;
#endif
}
static void log_text(GLuint object, GLsizei size, GLsizei* length, GLchar* log) {
  (void)object;
  static const char kLog[] = "error: the stages do not fit\nand a second line\n";
  if (size < (GLsizei)sizeof kLog) return;
  memcpy(log, kLog, sizeof kLog);
  *length = (GLsizei)sizeof kLog - 1;
}

EXPORT Function OSMesaGetProcAddress(const char* name) {
#ifdef HOSTILE_LACKS_FUNCTION
  if (strcmp(name, "glTexBuffer") == 0) return 0;
#endif
  if (strcmp(name, "glCreateShader") == 0 || strcmp(name, "glCreateProgram") == 0) return (Function)one;
  if (strcmp(name, "glCheckFramebufferStatus") == 0) return (Function)complete;
  if (strcmp(name, "glGetError") == 0) return (Function)no_error;
  if (strcmp(name, "glGetString") == 0 || strcmp(name, "glGetStringi") == 0) return (Function)text;
  if (strcmp(name, "glGetIntegerv") == 0) return (Function)integers;
  if (strcmp(name, "glGetShaderiv") == 0) return (Function)succeeds;
  if (strcmp(name, "glGetProgramiv") == 0) return (Function)link_status;
  if (strcmp(name, "glGetProgramInfoLog") == 0) return (Function)log_text;
  return nothing;
}
