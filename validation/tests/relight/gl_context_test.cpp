// OpenGL that is missing or broken: one clear line each time, and what it takes to have none at all.
#include "gl_context.hpp"

#include <fmt/format.h>

#include <functional>

#include "prt/relight/gl/object.hpp"
#include "prt/relight/gl/shaders.hpp"
#include "reference/base/error.hpp"

namespace plumbline::relight::gl {
namespace {

constexpr Provider kProviders[] = {Provider::osmesa, Provider::egl};

std::string hostile(const std::string& misdeed) {
  return fmt::format("{}/lib{}_osmesa.so", PLUMBLINE_CONFORMANCE, misdeed);
}

/// What a context of OSMesa in the library says when it is made; empty when there is nothing to say.
std::string fault_of(const ContextSettings& settings, const std::function<void(const Context&)>& use = {}) {
  try {
    const Context context(settings);
    if (use) use(context);
    return "";
  } catch (const DeviceError& error) {
    return error.what();
  }
}

ContextSettings osmesa_in(const std::string& libraries) {
  ContextSettings settings;
  settings.provider = Provider::osmesa;
  settings.osmesa_libraries = libraries;
  return settings;
}

TEST(GlContext, SaysWhichLibraryIsMissing) {
  EXPECT_EQ(fault_of(osmesa_in("/none/libOSMesa.so.8 /none/second.so")),
            "OSMesa: /none/libOSMesa.so.8: cannot open shared object file: No such file or directory");
  EXPECT_EQ(fault_of(osmesa_in("")), "OSMesa: no library named");
  ContextSettings neither = osmesa_in("/none/a.so");
  neither.provider = Provider::automatic;
  neither.egl_libraries = "/none/b.so";
  EXPECT_EQ(
      fault_of(neither),
      "OpenGL: no context: OSMesa: /none/a.so: cannot open shared object file: No such file or directory; "
      "EGL: /none/b.so: cannot open shared object file: No such file or directory");
}

TEST(GlContext, SaysWhatALibraryLacks) {
  const std::string library = hostile("lacks_entry");
  EXPECT_EQ(fault_of(osmesa_in(library)), "OSMesa: " + library + " has no OSMesaCreateContextAttribs");
  EXPECT_EQ(fault_of(osmesa_in(hostile("lacks_function"))), "OpenGL: the driver has no function glTexBuffer");
  ContextSettings egl;
  egl.provider = Provider::egl;
  egl.egl_libraries = library;
  EXPECT_EQ(fault_of(egl), "EGL: " + library + " has no eglBindAPI");
}

TEST(GlContext, SaysThatThereIsNoContext) {
  EXPECT_EQ(fault_of(osmesa_in(hostile("no_context"))),
            "OSMesa: it gives no context of OpenGL 3.3 core profile");
  EXPECT_EQ(fault_of(osmesa_in(hostile("not_current"))), "OSMesa: the context cannot be made current");
}

TEST(GlContext, SaysThatAProgramDoesNotLink) {
  EXPECT_EQ(fault_of(osmesa_in(hostile("link_error")),
                     [](const Context& context) { (void)make_program(context, view_source()); }),
            "OpenGL: view program: error: the stages do not fit");
  // The library that does nothing else wrong gets past that.
  EXPECT_EQ(fault_of(osmesa_in(hostile("idle")),
                     [](const Context& context) { (void)make_program(context, view_source()); }),
            "");
}

TEST(GlContext, NamesAreReadBack) {
  for (const Provider provider : {Provider::automatic, Provider::osmesa, Provider::egl})
    EXPECT_EQ(provider_from_string(to_string(provider)), provider);
  EXPECT_THROW((void)provider_from_string("glx"), InputError);
}

TEST(GlContext, ProvidersGiveWhatTheySayOrSayWhatTheyLack) {
  int present = 0;
  for (const Provider provider : kProviders) {
    const auto context = test::context_of(provider);
    if (!context) continue;
    ++present;
    EXPECT_EQ(context->provider(), provider);
    EXPECT_TRUE(context->description().starts_with(to_string(provider)));
    EXPECT_GE(context->integer(GL_MAX_TEXTURE_BUFFER_SIZE), 65536);  // what OpenGL 3.3 promises
    EXPECT_FALSE(context->has_extension("GL_PLUMBLINE_nothing"));
    EXPECT_NO_THROW(context->require_no_error("nothing done"));
    context->gl().Enable(GL_INVALID_ENUM);
    EXPECT_THROW(context->require_no_error("nonsense"), DeviceError);
  }
  fmt::print("{} of {} providers are here\n", present, std::size(kProviders));
}

TEST(GlContext, AnUnknownVersionIsRefusedByEachProvider) {
  for (const Provider provider : kProviders) {
    ContextSettings settings = settings_from_environment(provider);
    settings.version = {9, 9};
    const std::string fault = fault_of(settings);
    EXPECT_NE(fault, "");
    EXPECT_EQ(fault.find('\n'), std::string::npos) << fault;
    if (test::context_of(provider)) {
      EXPECT_NE(fault.find("no context of OpenGL 9.9"), std::string::npos) << fault;
    }
  }
}

TEST(GlContext, ABadShaderIsRefusedWithTheCompilersFirstLine) {
  for (const Provider provider : kProviders) {
    const auto context = test::context_of(provider);
    if (!context) continue;
    ProgramSource source = view_source();
    source.vertex = "#version 330 core\nvoid main() { gl_Position = nonsense; }\n";
    const auto link = [&] { (void)make_program(*context, source); };
    EXPECT_THROW(link(), DeviceError);
    try {
      link();
    } catch (const DeviceError& error) {
      const std::string reason = error.what();
      EXPECT_TRUE(reason.starts_with("OpenGL: view vertex shader: ")) << reason;
      EXPECT_NE(reason.find("nonsense"), std::string::npos) << reason;
      EXPECT_EQ(reason.find('\n'), std::string::npos) << reason;
    }
    // Both compile, but the fragment shader's input is written by nobody with that type.
    source.vertex =
        "#version 330 core\nout vec2 a;\nvoid main() { gl_Position = vec4(0.0); a = vec2(1.0); }\n";
    source.fragment = "#version 330 core\nin vec3 a;\nout vec4 c;\nvoid main() { c = vec4(a, 1.0); }\n";
    try {
      link();
      ADD_FAILURE() << "linked";
    } catch (const DeviceError& error) {
      const std::string reason = error.what();
      EXPECT_TRUE(reason.starts_with("OpenGL: view program: ")) << reason;
      EXPECT_EQ(reason.find('\n'), std::string::npos) << reason;
    }
  }
}

}  // namespace
}  // namespace plumbline::relight::gl
