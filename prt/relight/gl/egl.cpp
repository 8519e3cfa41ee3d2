// EGL without a surface: Mesa's surfaceless platform, or else the first device that gives a context (a GPU's driver).
#define EGL_NO_X11  // no window system: X11.h need not be there
#define MESA_EGL_NO_X11_HEADERS
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "prt/relight/gl/library.hpp"
#include "prt/relight/gl/platform.hpp"
#include "reference/base/error.hpp"

namespace plumbline::relight::gl {
namespace {

constexpr EGLint kMostDevices = 16;

struct EglFunctions {
  decltype(&eglBindAPI) bind_api;
  decltype(&eglCreateContext) create_context;
  decltype(&eglDestroyContext) destroy_context;
  decltype(&eglGetError) get_error;
  decltype(&eglGetProcAddress) get_proc_address;
  decltype(&eglInitialize) initialize;
  decltype(&eglMakeCurrent) make_current;
  decltype(&eglQueryString) query_string;
  PFNEGLGETPLATFORMDISPLAYEXTPROC get_platform_display = nullptr;  // null: this EGL has no platforms
  PFNEGLQUERYDEVICESEXTPROC query_devices = nullptr;               // null: it does not list devices

  explicit EglFunctions(const Library& library)
      : bind_api(library.require<decltype(bind_api)>("eglBindAPI")),
        create_context(library.require<decltype(create_context)>("eglCreateContext")),
        destroy_context(library.require<decltype(destroy_context)>("eglDestroyContext")),
        get_error(library.require<decltype(get_error)>("eglGetError")),
        get_proc_address(library.require<decltype(get_proc_address)>("eglGetProcAddress")),
        initialize(library.require<decltype(initialize)>("eglInitialize")),
        make_current(library.require<decltype(make_current)>("eglMakeCurrent")),
        query_string(library.require<decltype(query_string)>("eglQueryString")) {
    get_platform_display =
        reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(get_proc_address("eglGetPlatformDisplayEXT"));
    query_devices = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(get_proc_address("eglQueryDevicesEXT"));
  }
};

class Egl final : public Platform {
 public:
  Egl(const std::string& libraries, Version version) : library_("EGL", libraries), egl_(library_) {
    std::string reason = "EGL: it has no display without a window system";
    for (const EGLDisplay display : displays()) {
      reason = try_display(display, version);
      if (reason.empty()) return;
    }
    throw DeviceError(reason);
  }
  ~Egl() override {
    egl_.make_current(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    egl_.destroy_context(display_, context_);
  }
  [[nodiscard]] void* address(const char* function) const override {
    return reinterpret_cast<void*>(egl_.get_proc_address(function));
  }

 private:
  [[nodiscard]] std::vector<EGLDisplay> displays() const {
    std::vector<EGLDisplay> result;
    if (egl_.get_platform_display == nullptr) return result;
    const char* extensions = egl_.query_string(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    const std::string_view known = extensions == nullptr ? "" : extensions;
    const auto add = [&](EGLenum platform, void* native) {
      const EGLDisplay display = egl_.get_platform_display(platform, native, nullptr);
      if (display != EGL_NO_DISPLAY) result.push_back(display);
    };
    if (known.find("EGL_MESA_platform_surfaceless") != std::string_view::npos)
      add(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY);
    if (known.find("EGL_EXT_platform_device") != std::string_view::npos && egl_.query_devices != nullptr) {
      EGLDeviceEXT devices[kMostDevices];
      EGLint count = 0;
      if (egl_.query_devices(kMostDevices, devices, &count) == EGL_TRUE) {
        for (EGLint i = 0; i < count; ++i) add(EGL_PLATFORM_DEVICE_EXT, devices[i]);
      }
    }
    return result;
  }

  // Empty when there is a context now, else the reason why not.
  [[nodiscard]] std::string try_display(EGLDisplay display, Version version) {
    EGLint major = 0;
    EGLint minor = 0;
    if (egl_.initialize(display, &major, &minor) != EGL_TRUE)
      return fmt::format("EGL: the display cannot be initialised (error 0x{:x})", egl_.get_error());
    if (egl_.bind_api(EGL_OPENGL_API) != EGL_TRUE) return "EGL: it knows OpenGL ES only";
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 version.major,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 version.minor,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_NONE};
    const EGLContext context = egl_.create_context(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    if (context == EGL_NO_CONTEXT) {
      return fmt::format("EGL: it gives no context of OpenGL {}.{} core profile (error 0x{:x})",
                         version.major, version.minor, egl_.get_error());
    }
    if (egl_.make_current(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) != EGL_TRUE) {
      egl_.destroy_context(display, context);
      return "EGL: the context cannot be made current without a surface";
    }
    display_ = display;
    context_ = context;
    return "";
  }

  Library library_;
  EglFunctions egl_;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

std::unique_ptr<Platform> make_egl(const std::string& libraries, Version version) {
  return std::make_unique<Egl>(libraries, version);
}

}  // namespace plumbline::relight::gl
